//! What is read, and what was measured, stays whatever an output is called.

use std::fs;
use std::path::Path;

use crate::bench::Bench;
use crate::joint_file::JOINT;
use crate::rig;

const LOST: &str =
    "is one of the files that are read, and would be lost; give the output a name of its own";

/// A copy of the files of an example.
fn example(name: &str) -> Bench {
    let bench = Bench::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("examples")
        .join(name);
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        bench.write(&file, fs::read(&path).unwrap());
    }
    bench
}

#[test]
fn files_that_a_study_names_are_not_replaced() {
    let bench = rig::ready();
    bench.write("measured", fs::read(bench.path("c.uff")).unwrap());
    bench.edit("study.toml", "c.uff", "measured");
    bench.refused(
        "identify study.toml -o measured",
        &["measured: found it to be the file that `assembly.frf` of study.toml names"],
    );

    let bench = example("predict-four-bolts");
    let command = "predict study.toml -o j.joint.json --field-csv a-1.csv";
    let says = ["a-1.csv: found it to be the file that `surface.a.profiles` of study.toml names"];
    bench.refused(command, &says);
}

#[test]
fn joint_files_of_an_assembly_are_not_replaced() {
    let bench = example("two-beams");
    let says =
        ["lap.joint.json: found it to be the file that `joints[0].file` of beams.toml names"];
    bench.refused("export beams.toml -o lap.joint.json", &says);
    bench.refused("convert beams.toml --to modelica -o lap.joint.json", &says);
}

#[test]
fn a_draft_takes_no_place_of_a_measurement() {
    let bench = rig::ready();
    let measured = fs::read(bench.path("c.uff")).unwrap();
    fs::create_dir(bench.path("f")).unwrap();
    for name in ["a", "b", "c"] {
        bench.write(&format!("f/{name}.uff"), &measured);
    }
    bench.refused("init f -o f/a.uff", &["f/a.uff: cannot be written", LOST]);
}

#[test]
fn computed_functions_take_no_place_of_measured_ones() {
    let bench = rig::ready();
    bench.write("j.joint.json", JOINT);
    let respond = "respond study.toml --joint j.joint.json -o";
    let says = [
        "--output: found",
        "c.uff",
        "the study says that this one was measured",
    ];
    bench.refused(&format!("{respond} c.uff"), &says);
    // what was computed before may be computed anew
    fs::remove_file(bench.path("c.uff")).unwrap();
    for _ in 0..2 {
        bench.done(&format!("{respond} c.uff --step 3"));
    }
}

#[test]
fn a_demo_takes_no_place_of_other_files() {
    let bench = Bench::new();
    fs::create_dir(bench.path("d")).unwrap();
    bench.write("d/assembly.uff", "measured yesterday");
    bench.refused(
        "demo -o d",
        &["--output: found d/assembly.uff", "would be lost"],
    );
    bench.refused("demo -o -", &["expected a folder"]);
    fs::remove_file(bench.path("d/assembly.uff")).unwrap();
    for _ in 0..2 {
        bench.done("demo -o d");
    }
    // each of the files that it writes is kept, where it is another's
    let written = fs::read_dir(bench.path("d")).unwrap();
    let written = written.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    for name in written {
        let other = Bench::new();
        other.write(&name, "another's");
        other.refused("demo -o .", &[&name, "would be lost"]);
    }
    bench.edit("d/study.toml", "M10x16 A2-70 on", "another on");
    bench.refused(
        "demo -o d",
        &["--output: found d/study.toml", "would be lost"],
    );
}
