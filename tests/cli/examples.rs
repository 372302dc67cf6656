//! Studies of laps, layered beams and planned tests, from the study to what is made of its joint.

use std::path::{Path, PathBuf};

use bolted_joint::study::StudyText;
use bolted_joint_testing::{close, has};

use crate::bench::{Bench, IDENTIFY};

/// A bench with the files of an example.
pub(crate) fn files_of(name: &str) -> Bench {
    let bench = Bench::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("examples")
        .join(name);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let file = path.file_name().unwrap().to_str().unwrap();
        bench.write(file, std::fs::read(&path).unwrap());
    }
    bench
}

#[test]
fn each_torque_with_its_own_bodies_gets_a_file_that_exports() {
    let bench = files_of("pirdayr-update");
    let outcome = bench.unusable(
        "identify study.toml -o x.joint.json --report x.html --figure x.svg",
        &["at 2 N·m: the frequencies do not determine k12 (at its bound)"],
    );
    let unknown = "not identified: k, m, k12, c, c12, kN";
    has(&outcome.stdout, &["wrote x.8Nm.joint.json", unknown]);
    let cannot = "c, c12, kN cannot be identified";
    has(
        &outcome.stderr,
        &["no parameters within the bounds", cannot],
    );
    let prior = "not identifiable, at its prior";
    has(
        &bench.text("x.html"),
        &["Convergence of the fireflies", prior],
    );
    for torque in [2, 4, 6, 8] {
        let export = format!("export x.{torque}Nm.joint.json -o x.fmu --as lap");
        bench.refused(&export, &["the frequencies do not determine k12"]);
        bench.done(&format!("{export} --unusable"));
    }
    bench.fails("identify study.toml -o y.joint.json --bootstrap 9", &[]);
}

/// Six parameters of two searches at four torques, of which kN alone stays unknown where bodies are stated.
#[test]
fn report_and_terminal_bracket_the_same_values() {
    let bench = files_of("pirdayr-update");
    let in_brackets = |text: &str| {
        let after = text.split('(').skip(1);
        after
            .filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
            .count()
    };
    for (study, expected) in [("study.toml", 48), ("with-a-mass.toml", 8)] {
        let command = format!("identify {study} -o x.joint.json --report x.html");
        let outcome = bench.run(&command);
        let is_known = study == "with-a-mass.toml";
        assert_eq!(outcome.code, Some(if is_known { 0 } else { 3 }), "{study}");
        let printed = in_brackets(&outcome.stdout);
        assert_eq!(printed, expected, "{study}");
        let page = bench.text("x.html").replace("faint\">(", "(");
        let (_, page) = page.split_once("<h2>Parameters</h2>").unwrap();
        let (page, _) = page.split_once("<h2>Frequencies</h2>").unwrap();
        assert_eq!(in_brackets(page), printed, "{study}");
    }
}

#[test]
fn a_layered_beam_becomes_an_fmu() {
    let bench = files_of("kavi-layered-beam");
    let files = "--damping-csv damping.csv --figure damping.svg";
    let outcome = bench.done(&format!("predict study.toml -o beam.joint.json {files}"));
    let damping = "mode 1 at 1.000e-4 m: damping ratio 0.01200";
    has(&outcome.stdout, &[damping]);
    assert_eq!(bench.text("damping.csv").lines().count(), 1 + 5 * 21);
    has(
        &bench.done("show damping.csv").stdout,
        &["table of a layered beam's damping (CSV)"],
    );
    let figure = bench.text("damping.svg");
    assert!(figure.starts_with("<svg") && figure.contains("joint file"));
    bench.done("check beam.joint.json");
    for interface in ["lap", "element"] {
        bench.done(&format!(
            "export beam.joint.json -o beam.fmu --as {interface}"
        ));
        has(&bench.done("check beam.fmu").stdout, &["no problem found"]);
    }
}

#[test]
fn a_layered_beam_over_torques_loosens() {
    let bench = Bench::new();
    bench.write(
        "study.toml",
        include_str!("../data/studies/two-layers.toml"),
    );
    bench.edit("study.toml", "torque = 4", "torque = [2, 4, 8]");
    bench.edit(
        "study.toml",
        "[motion]",
        "[joint]\ndamping = \"linear\"\n[motion]",
    );
    bench.done("predict study.toml -o beam.joint.json");
    bench.done("export beam.joint.json -o beam.fmu --as lap");
    has(&bench.done("check beam.fmu").stdout, &["no problem found"]);
}

#[test]
fn a_planned_test_identifies_the_joint_that_it_was_planned_with() {
    let bench = files_of("tol-m10x16");
    bench.edit("study.toml", "\"assembly.uff\"", "\"plan.uff\"");
    let joint = r#"{"format":"bolted-joint/1","name":"presumed","joint":{"dofs":["y","theta"],
        "stiffness":[[5.73e5,5.82e3],[5.82e3,1.29e3]],"damping":[[10.83,-0.83],[-0.83,0.083]]}}"#;
    bench.write("presumed.joint.json", joint);
    let respond = "respond study.toml --joint presumed.joint.json --step 1";
    let planned = bench.done(&format!("{respond} -o plan.uff noise frf --level 0.01"));
    // The study names bands; they stay.
    has(&planned.stdout, &["yy = [[330, 360]]  # as in the study"]);
    bench.done(IDENTIFY);
    let found = &bench.json("o.joint.json")["joint"]["stiffness"];
    close(found[0][0].as_f64().unwrap(), 5.73e5, 0.01);

    bench.done(&format!("{respond} -o plan.csv"));
    let table = bench.text("plan.csv");
    let lines: Vec<&str> = table.lines().collect();
    // 5 to 512 Hz in steps of 1 Hz, nine functions of two columns.
    assert_eq!(lines.len(), 1 + 508);
    assert_eq!(lines[0].split(',').count(), 1 + 18);
    assert!(lines[0].starts_with("frequency [Hz],11:+Y/11:+Y receptance real [m/N]"));
    bench.fails(
        &format!("{respond} -o plan.csv noise response --samples 2"),
        &[],
    );
    bench.fails(
        &format!("{respond} -o plan.csv noise frf --level 5"),
        &["noise level: found 5", "0.01 for 1 %"],
    );
}

/// A longer tool is the softer one: 70 and 90 mm.
#[test]
fn a_tool_s_point_answers_with_bands() {
    let bench = files_of("tool-point");
    let files = "-o tool.csv --report tool.svg --deviations deviations.csv";
    let answered = bench.done(&format!("respond study.toml --step 50 {files}"));
    has(&answered.stdout, &["tool point: 2 functions of 79 lines"]);
    has(&bench.text("tool.svg"), &["31:+Y/31:+Y", "upper end"]);
    let at_100_hz = |bench: &Bench| -> f64 {
        let table = bench.text("tool.csv");
        let row = table.lines().nth(1).unwrap().split(',');
        row.map(|cell| cell.parse().unwrap()).nth(3).unwrap()
    };
    assert_eq!(bench.text("deviations.csv").lines().count(), 1 + 79);
    let short = at_100_hz(&bench);
    let study = bench.text("study.toml");
    bench.write("study.toml", study.replace("[0.07, 0, 0]", "[0.09, 0, 0]"));
    bench.done("respond study.toml --step 50 -o tool.csv");
    assert!(at_100_hz(&bench) > 1.5 * short);
}

#[test]
fn a_test_in_space_is_planned_and_answers_beforehand() {
    let bench = files_of("plan-in-space");
    let planned = bench.done("respond study.toml --plan --step 60 --add 2 -o plan.csv");
    let expected = [
        "expected of 288 functions of the assembly at 30 lines",
        "add next: ",
        "then: ",
    ];
    has(&planned.stdout, &expected);
    let table = bench.text("plan.csv");
    assert_eq!(table.lines().count(), 1 + 42);
    has(&table, &["joint,k_x,2e7,2e7,"]);
    bench.done("respond study.toml --step 60 -o test.csv");
    let functions = bench.text("test.csv");
    let header = functions.lines().next().unwrap();
    assert_eq!(header.split(',').count(), 1 + 2 * 18 * 16);
    bench.fails("respond study.toml --plan", &["`frequency`", "--step"]);
    bench.fails(
        "respond study.toml --plan --step 60 --for k_q",
        &["--for", "k_q", "k_x_ry"],
    );
}

#[test]
fn two_beams_become_one_fmu() {
    let bench = files_of("two-beams");
    bench.done("respond beams.toml -o history.csv");
    let written = bench.done("export beams.toml -o beams.fmu").stdout;
    has(&written, &["2 structures with", "1 joints between them"]);
    let told = bench.done("check beams.fmu").stdout;
    has(&told, &["no problem found", "reference run: met"]);
}

/// A key of a path that `StudyText::named_files` does not know would be told of late, and without its name.
#[test]
fn every_file_that_an_example_names_is_told_by_its_key() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let folders = std::fs::read_dir(examples).unwrap();
    let mut count = 0;
    for folder in folders.map(|entry| entry.unwrap().path()) {
        let files = std::fs::read_dir(&folder).into_iter().flatten();
        let studies = files.map(|entry| entry.unwrap().path());
        for path in studies.filter(|path| path.extension().is_some_and(|own| own == "toml")) {
            let study = StudyText::read(&path).unwrap();
            let known: Vec<PathBuf> = (study.named_files().into_iter())
                .map(|file| file.path)
                .collect();
            let mut texts = Vec::new();
            collect(&toml::from_str(study.text()).unwrap(), &mut texts);
            let named = texts.iter().map(|text| folder.join(text));
            for file in named.filter(|file| file.is_file()) {
                assert!(
                    known.contains(&file),
                    "{}: {}",
                    path.display(),
                    file.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}

fn collect(value: &toml::Value, texts: &mut Vec<String>) {
    match value {
        toml::Value::String(text) => texts.push(text.clone()),
        toml::Value::Array(all) => all.iter().for_each(|own| collect(own, texts)),
        toml::Value::Table(all) => all.iter().for_each(|(_, own)| collect(own, texts)),
        _ => {}
    }
}
