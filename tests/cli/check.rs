//! `check`: what is sound is said to be, and every tampering with an FMU is found.

use bolted_joint_testing::has;
use std::fs::{self, File};
use std::io::{Cursor, Read as _, Write as _};

use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::bench::{Bench, PNG, replaced};
use crate::joint_file::JOINT;

/// A bench with a joint file and its FMUs.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    for interface in ["element", "lap"] {
        let fmu = format!("{interface}.fmu");
        bench.done(&format!("export j.joint.json -o {fmu} --as {interface}"));
    }
    bench
}

/// Packs `from` again as `to` with each entry as `change` leaves it; an entry that becomes `None` is left out.
pub(crate) fn repacked(
    bench: &Bench,
    from: &str,
    to: &str,
    change: impl Fn(&str, Vec<u8>) -> Option<Vec<u8>>,
) {
    let mut old = ZipArchive::new(File::open(bench.path(from)).unwrap()).unwrap();
    let mut new = ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..old.len() {
        let mut entry = old.by_index(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        if let Some(bytes) = change(&name, bytes) {
            new.start_file(name, SimpleFileOptions::default()).unwrap();
            new.write_all(&bytes).unwrap();
        }
    }
    bench.write(to, new.finish().unwrap().into_inner());
}

/// Makes `edited.fmu` of the lap FMU with another text of one entry.
fn with_entry(bench: &Bench, entry: &str, change: impl Fn(String) -> String) {
    repacked(bench, "lap.fmu", "edited.fmu", |name, bytes| {
        Some(if name == entry {
            change(String::from_utf8(bytes).unwrap()).into()
        } else {
            bytes
        })
    });
}

#[test]
fn sound_files_are_said_to_be_sound() {
    let bench = bench();
    let fmu = "FMU (FMI 3.0, Co-Simulation and Model Exchange)";
    for (file, kind) in [
        ("j.joint.json", "joint file"),
        ("element.fmu", fmu),
        ("lap.fmu", fmu),
    ] {
        let outcome = bench.done(&format!("check {file}"));
        assert!(outcome.stdout.starts_with(&format!("{file}: {kind}\n")));
        has(&outcome.stdout, &["no problem found"]);
        assert_eq!(outcome.stderr, "");
    }
    // Packed anew and otherwise the same.
    repacked(&bench, "lap.fmu", "again.fmu", |_, bytes| Some(bytes));
    bench.done("check again.fmu");
}

#[test]
fn an_active_joint_is_found() {
    let bench = Bench::new();
    let (passive, active) = ("[[6, 0.05], [0.05, 0.02]]", "[[6, 5], [5, 0.02]]");
    bench.write("j.joint.json", replaced(JOINT, passive, active));
    bench.done("export j.joint.json -o o.fmu --allow-active");
    for file in ["j.joint.json", "o.fmu"] {
        let outcome = bench.fails(&format!("check {file}"), &["joint.damping is active"]);
        let stderr = &outcome.stderr;
        assert!(stderr.starts_with(&format!("error: {file}:")), "{stderr}");
        assert!(!outcome.stdout.contains("no problem found"));
    }
}

#[test]
fn every_edit_of_an_fmu_is_found() {
    let bench = bench();
    let start = "resources/start.txt";
    let description = "modelDescription.xml";
    let text = bench.member("lap.fmu", start);
    let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap();
    let (token_line, step_line) = (line("token "), line("step_size_max "));
    let token = token_line.strip_prefix("token ").unwrap();
    #[rustfmt::skip]
    let cases = [
        (start, "joint.k_yy 80000.0", "joint.k_yy 80001.0", "found joint.k_yy = 80001.0"),
        (start, "joint.k_yy 80000.0\n", "", "start values differ from resources/start.txt"),
        (start, "dofs 2", "dofs 1", "found dofs 1, expected 2"),
        (start, "model lap", "model element", "found variable a.y as output 1 in m, expected input 1 in m"),
        (start, token_line, "token 0", "expected \"0\" as in resources/start.txt"),
        (start, step_line, "step_size_max 1.0", "found 1.0 s, with which RK4 is unstable"),
        (description, token, "0", "found instantiationToken \"0\""),
        (description, "start=\"80000\"", "start=\"80001\"", "start values differ from resources/start.txt"),
        (description, "name=\"joint.F\"", "name=\"joint.load\"", "variable joint.F not found"),
        ("resources/joint.json", "8e4, 600", "9e4, 600", "found joint.k_yy = 80000.0, expected 90000.0"),
    ];
    for (entry, from, to, fragment) in cases {
        with_entry(&bench, entry, |text| replaced(&text, from, to));
        bench.fails("check edited.fmu", &["edited.fmu", fragment]);
    }
}

#[test]
fn entries_that_are_missing_or_broken_are_named() {
    let bench = bench();
    for entry in [
        "modelDescription.xml",
        "resources/start.txt",
        "resources/joint.json",
    ] {
        repacked(&bench, "lap.fmu", "less.fmu", |name, bytes| {
            (name != entry).then_some(bytes)
        });
        bench.refused("check less.fmu", &["less.fmu: ", entry, "export it again"]);
    }
    repacked(&bench, "lap.fmu", "less.fmu", |name, bytes| {
        (!name.starts_with("binaries/")).then_some(bytes)
    });
    bench.fails("check less.fmu", &["binaries: found no library"]);
    let ends = "resources/joint.json:1:1: the file ends too early";
    for (entry, contents, fragment) in [
        ("resources/start.txt", "hello", "resources/start.txt"),
        ("resources/joint.json", "{", ends),
    ] {
        with_entry(&bench, entry, |_| contents.to_owned());
        bench.refused("check edited.fmu", &["edited.fmu: ", fragment]);
    }
    with_entry(&bench, "modelDescription.xml", |_| "<fmi".to_owned());
    bench.fails("check edited.fmu", &["modelDescription.xml"]);
}

#[test]
#[rustfmt::skip]
fn what_is_no_fmu_is_said_to_be_none() {
    let bench = bench();
    let whole = fs::read(bench.path("lap.fmu")).unwrap();
    bench.write("cut.fmu", &whole[..whole.len() / 2]);
    bench.refused("check cut.fmu", &["cut.fmu: found no readable zip archive", "copy or export it again"]);
    let mut other = ZipWriter::new(Cursor::new(Vec::new()));
    other
        .start_file("notes.txt", SimpleFileOptions::default())
        .unwrap();
    bench.write("other.zip", other.finish().unwrap().into_inner());
    bench.refused("check other.zip", &["other.zip: `modelDescription.xml` is missing", "expected an FMU"]);
    bench.write("picture.png", PNG);
    bench.refused("check picture.png", &["picture.png: found bytes that are no text", "expected a joint file"]);
    for name in ["missing.fmu", "missing.toml", "missing"] {
        let expected = "give the path of a joint file (JSON), an assembly file (TOML), an FMU or an SSP";
        bench.refused(
            &format!("check {name}"),
            &[&format!("{name}: cannot be read"), expected],
        );
    }
    bench.refused("export lap.fmu -o o.fmu", &["lap.fmu: found an FMU, expected a joint file (JSON)", "`bolted-joint check lap.fmu`"]);
}

#[test]
fn a_library_with_a_flipped_bit_is_found() {
    let bench = bench();
    let whole = fs::read(bench.path("lap.fmu")).unwrap();
    let mut archive = ZipArchive::new(Cursor::new(&whole)).unwrap();
    let names: Vec<String> = archive
        .file_names()
        .map(|name| name.unwrap().into_owned())
        .collect();
    let library = names.iter().find(|name| name.starts_with("binaries/"));
    let entry = archive.by_name(library.unwrap()).unwrap();
    let (start, size) = (entry.data_start().unwrap(), entry.compressed_size());
    let mut damaged = whole.clone();
    damaged[usize::try_from(start + size / 2).unwrap()] ^= 0x10;
    bench.write("damaged.fmu", damaged);
    bench.fails("check damaged.fmu", &["binaries/", "damaged"]);
}

#[test]
fn what_no_validator_sees_is_found() {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    for (version, capability, misspelt) in [
        ("2", "canGetAndSetFMUstate", "canGetAndSetFMUState"),
        ("3", "canGetAndSetFMUState", "canGetAndSetFMUstate"),
    ] {
        bench.done(&format!(
            "export j.joint.json -o lap.fmu --as lap --fmi {version}"
        ));
        #[rustfmt::skip]
        let cases = [
            (format!("{capability}=\"true\""), format!("{misspelt}=\"true\""),
             format!("found attribute {misspelt} of <CoSimulation>, which the standard does not have; did you mean {capability}?")),
            (format!("{capability}=\"true\""), format!("{capability}=\"yes\""),
             format!("found {capability}=\"yes\" of <CoSimulation>, expected true or false")),
            ("start=\"0.5\"".to_owned(), "start=\"-0.5\"".to_owned(), "found start = -0.5 of b.m, expected a value from ".to_owned()),
            (format!("fmiVersion=\"{version}.0\""), "fmiVersion=\"1.0\"".to_owned(),
             "found fmiVersion \"1.0\", expected \"2.0\" or \"3.0\"".to_owned()),
        ];
        for (from, to, fragment) in cases {
            with_entry(&bench, "modelDescription.xml", |text| {
                assert!(text.contains(&from), "{from}");
                text.replace(&from, &to)
            });
            bench.fails("check edited.fmu --no-run", &[&fragment]);
        }
    }
    with_entry(&bench, "terminalsAndIcons/terminalsAndIcons.xml", |text| {
        text.replace("\"b.F\"", "\"b.G\"")
    });
    repacked(&bench, "edited.fmu", "less.fmu", |name, bytes| {
        (!name.ends_with("flange_a.png")).then_some(bytes)
    });
    let outcome = bench.run("check less.fmu");
    let expected = ["found member \"b.G\"", "found icon \"flange_a\""];
    has(&outcome.stderr, &expected);
}

#[test]
fn an_assembly_without_joints_is_checked() {
    let bench = Bench::new();
    let beam = "length = 0.3, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, damping_ratio = 0.005";
    bench.write(
        "apart.toml",
        format!(
            "name = \"apart\"\n[structures.one]\nbeam = {{ {beam}, boundary = \"fixed-free\" }}\npoints = {{ \"1:+Y\" = 0.3 }}\n\
             modes = 4\n[inputs]\npush = \"one/1:+Y\"\n[outputs]\ntip = \"one/1:+Y\"\n[response]\nkind = \"modes\"\n"
        ),
    );
    let outcome = bench.done("check apart.toml");
    has(
        &outcome.stdout,
        &["joints: none", "there is no joint to couple"],
    );
}
