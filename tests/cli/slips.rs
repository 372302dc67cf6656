//! Slips that a first user makes: each is told with its place, and with what to do instead.

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY, replaced};
use crate::examples::files_of;
use crate::joint_file::JOINT;
use crate::rig;

#[test]
fn a_named_band_without_a_line_is_told() {
    let bench = rig::ready();
    let text = bench.text("study.toml");
    let with = |bands: &str| bench.write("study.toml", format!("{text}\n[bands]\n{bands}\n"));
    with("yy = [[20, 60], [3000, 4000]]");
    let told = "warning: `bands.yy`: found no line in [3000, 4000]: the lines that are used go from 2 to 200 Hz";
    has(&bench.done(IDENTIFY).stderr, &[told]);
    with("yy = [[20, 60]]\nthetatheta = [[0.5, 1]]");
    let told = "`bands.thetatheta`: found no line in [0.5, 1]: the lines that are used go from 2 to 200 Hz, so that it has no average";
    has(&bench.done(IDENTIFY).stderr, &[told]);
    with("yy = [[0.5, 1]]\nthetatheta = [[0.5, 1], [3000, 4000]]");
    let told = "`bands`: found no line in any band, expected bands with lines: the lines that are used go from 2 to 200 Hz";
    bench.refused(IDENTIFY, &[told]);
}

/// The lines of the rig are 2, 5, … 200 Hz.
#[test]
fn a_range_beyond_the_data_is_told_with_what_is_used() {
    let bench = rig::ready();
    let text = bench.text("study.toml");
    let of = |range: &str| bench.write("study.toml", replaced(&text, "from = 2\nto = 200", range));
    for range in [
        "from = 2\nto = 200",
        "from = 1\nto = 202.9",
        "from = 20",
        "every = 7\nto = 200",
        "bands = [[2, 50], [80, 200]]",
    ] {
        of(range);
        let stderr = bench.done(IDENTIFY).stderr;
        assert!(!stderr.contains("`frequency"), "{range}: {stderr}");
    }
    let used = "but the lines of c.uff that are used go from 2 to 200 Hz only";
    for (range, found) in [
        ("to = 3000", "`frequency`: found to 3000 Hz"),
        (
            "from = 1\nto = 3000",
            "`frequency`: found from 1 to 3000 Hz",
        ),
        (
            "bands = [[2, 50], [80, 3000]]",
            "`frequency.bands`: found from 2 to 3000 Hz",
        ),
    ] {
        of(range);
        let told = format!("{found}, {used}");
        let outcome = bench.done(&format!("{IDENTIFY} --json --report o.html"));
        has(&outcome.stderr, &[&told]);
        has(&outcome.json()["warnings"].to_string(), &[&told]);
        has(&bench.text("o.html"), &[used]);
    }
    // what is not stated is no number in the report
    of("to = 200");
    has(&bench.report(), &["<td>to 200 Hz</td>"]);
}

#[test]
fn a_range_beyond_the_data_of_a_chain_is_told() {
    let bench = files_of("tool-point");
    bench.done("respond study.toml --step 50 -o tool.csv");
    let text = bench.text("study.toml") + "[assembly]\nfrf = \"tool.csv\"\n";
    for (to, is_told) in [("to = 4049", false), ("to = 9000", true)] {
        bench.write("study.toml", replaced(&text, "to = 4000", to));
        let stderr = bench.done("respond study.toml -o o.csv").stderr;
        let told = "`frequency`: found from 100 to 9000 Hz, but the lines of all files that are used go from 100 to 4000 Hz only";
        assert_eq!(stderr.contains(told), is_told, "{stderr}");
        assert_eq!(stderr.contains("`frequency`"), is_told, "{stderr}");
    }
}

#[test]
fn options_without_effect_say_what_they_are_for() {
    let bench = files_of("tool-point");
    bench.write("j.json", JOINT);
    bench.write("y.json", JENKINS);
    let convert = "convert j.json -o o.m --to matlab";
    #[rustfmt::skip]
    let cases = [
        (format!("{convert} --nodes 5,6"), ["--nodes", "it is for Nastran"]),
        (format!("{convert} --first-number 7"), ["--first-number", "it is for Nastran"]),
        ("convert j.json -o o.bdf --to nastran --rotation-nodes 5,6".to_owned(), ["--rotation-nodes", "it is for CalculiX"]),
        ("convert y.json -o o.inp --to calculix --at-rest --rotation-nodes 5,6".to_owned(), ["--rotation-nodes", "no rotation"]),
        ("compare j.json j.json --preload 4".to_owned(), ["--preload: found 4", "none of the joints depends on the preload"]),
        ("respond study.toml -o o.csv --step 9 noise frf --samples 30".to_owned(), ["--samples: found 30", "`noise response`"]),
        ("reproduce pirdayr --samples 5".to_owned(), ["--samples", "nothing is drawn"]),
        ("reproduce tian --seed 5".to_owned(), ["--seed", "nothing is drawn"]),
    ];
    for (arguments, fragments) in cases {
        bench.refused(&arguments, &fragments);
    }
}

const JENKINS: &str = r#"{"format": "bolted-joint/1", "name": "y", "joint": {"dofs": ["y"], "stiffness": [[1e6]], "damping": [[2]]}}"#;

#[test]
fn a_study_without_functions_says_which_of_its_lines_are_missing() {
    let bench = files_of("tool-point");
    let told = [
        "Hz alone, and no part has a file of functions",
        "`--step 1`",
    ];
    bench.refused("respond study.toml -o o.csv", &told);
    let told = [
        "`assembly.frf`: found nothing",
        "`bolted-joint respond --plan`",
    ];
    bench.refused(IDENTIFY, &told);
}

#[test]
fn a_missing_file_is_told_with_its_key() {
    let bench = rig::ready();
    bench.edit("study.toml", "\"c.uff\"", "\"cc.uff\"");
    let told = ["error: study.toml: `assembly.frf`: found \"cc.uff\", which is not there"];
    bench.refused(IDENTIFY, &told);
    bench.edit("study.toml", "\"cc.uff\"", "\"C:\\new\\b.uff\"");
    bench.refused(IDENTIFY, &["`assembly.frf`", "write a path in '…'"]);
    bench.edit("study.toml", "\"C:\\new\\b.uff\"", "\"C:\\users\\c.uff\"");
    bench.refused(IDENTIFY, &["error: study.toml: ", "write a path in '…'"]);
    let bench = files_of("two-beams");
    bench.edit("beams.toml", "\"lap.joint.json\"", "\"lip.joint.json\"");
    for command in [
        "export beams.toml -o o.fmu",
        "respond beams.toml -o o.csv",
        "check beams.toml",
    ] {
        bench.refused(
            command,
            &[
                "beams.toml: `joints[0].file`",
                "did you mean `lap.joint.json`?",
            ],
        );
    }
}

#[test]
fn a_file_of_another_kind_is_told_with_its_key() {
    let bench = rig::ready();
    bench.write("j.json", JOINT);
    bench.edit("study.toml", "\"c.uff\"", "\"j.json\"");
    let told = [
        "study.toml: `assembly.frf`: found \"j.json\", a joint file, expected a file of measured functions",
    ];
    bench.refused(IDENTIFY, &told);
}

#[test]
fn an_fmu_has_the_name_of_one() {
    let bench = Bench::new();
    bench.write("j.json", JOINT);
    for name in ["o.txt", "o.json", "o.csv"] {
        let told = [&format!("--output: found {name}"), "such as NAME.fmu"];
        bench.refused(&format!("export j.json -o {name}"), &told);
    }
    let outcome = bench.done("export j.json -o o");
    has(
        &outcome.stderr,
        &["note: importers look for a name that ends in .fmu"],
    );
}

#[test]
fn an_output_that_a_study_names_is_refused_before_anything_is_computed() {
    let bench = files_of("predict-four-bolts");
    let told = ["a-2.csv: found it to be the file that `surface.a.profiles` of study.toml names"];
    bench.refused(
        "predict study.toml -o o.joint.json --field-csv a-2.csv",
        &told,
    );
}

#[test]
fn a_measurement_that_is_named_twice_is_refused() {
    let bench = rig::ready();
    let text = bench.text("study.toml");
    let (before, rest) = text.split_once("[assembly]\n").unwrap();
    let (assembly, after) = rest.split_once("\n[").unwrap();
    bench.write(
        "study.toml",
        format!("{before}[assembly]\n{assembly}\nrepeats = [\"./c.uff\"]\n[{after}"),
    );
    let told = [
        "`assembly`: found \"./c.uff\" twice",
        "it would count as two",
    ];
    bench.refused(IDENTIFY, &told);
    let one = format!("[[assembly]]\n{assembly}\n");
    bench.write("study.toml", format!("{before}{one}{one}[{after}"));
    let told = ["`assembly[1].frf`: found c.uff with the same points"];
    bench.refused(IDENTIFY, &told);
    let bench = files_of("predict-four-bolts");
    bench.edit("study.toml", "\"a-2.csv\"", "\"a-1.csv\"");
    let told = ["`surface.a.profiles`: found \"a-1.csv\" twice"];
    bench.refused("predict study.toml -o o.joint.json", &told);
}

#[test]
fn studies_in_another_encoding_are_told_from_binary_data() {
    let bench = rig::ready();
    let text = bench
        .text("study.toml")
        .replacen("name = \"", "name = \"Prüf", 1);
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let latin1: Vec<u8> = text.chars().map(|c| u8::try_from(c).unwrap()).collect();
    for (bytes, encoding) in [(utf16, "UTF-16"), (latin1, "Latin-1 or Windows-1252")] {
        bench.write("study.toml", bytes);
        for command in [IDENTIFY, "show study.toml"] {
            bench.refused(
                command,
                &["study.toml, line", encoding, "in UTF-8; save it"],
            );
        }
    }
}

#[test]
fn beams_and_points_of_an_assembly_are_checked() {
    let bench = files_of("two-beams");
    let text = bench.text("beams.toml");
    #[rustfmt::skip]
    let cases = [
        ("length = 0.335, width = 0.03, height = 0.006, youngs_modulus = 70e9", "length = 335, width = 0.03, height = 0.006, youngs_modulus = 70e9",
         ["`structures.free.beam.length`: found 335", "is it in millimetres?"]),
        ("length = 0.335, width = 0.03, height = 0.006, youngs_modulus = 70e9", "length = 0.335, width = 0.03, height = 0.006, youngs_modulus = 70",
         ["`structures.free.beam.youngs_modulus`: found 70", "is it in GPa or MPa?"]),
        ("\"12:+Y\" = 0.335 }\nmodes = 10", "\"12:+Y\" = 0.335 }\nmodes = 1",
         ["`structures.free.modes`: found 1", "2 or more: the structure moves freely"]),
        ("push = \"free/12:+Y\"", "push = \"free12:+Y\"", ["`inputs.push`: found \"free12:+Y\"", "did you mean \"free/12:+Y\"?"]),
        ("push = \"free/12:+Y\"", "push = \"free/13:+Y\"", ["`inputs.push`: found 13:+Y", "a point of structure free: 1:+Y, 1:+RZ, 12:+Y"]),
    ];
    bench.refused_edits("export beams.toml -o o.fmu", ("beams.toml", &text), &cases);
    // points of the clamped end do not move, and no load bends the beam there
    let clamped = text.replace(
        "\"1:+Y\" = 0.3, \"1:+RZ\" = 0.3",
        "\"1:+Y\" = 0.0, \"1:+RZ\" = 0.0",
    );
    bench.write("beams.toml", clamped);
    bench.done("export beams.toml -o o.fmu");
}

#[test]
fn layered_beams_in_other_units_are_told() {
    let bench = files_of("kavi-layered-beam");
    let text = bench.text("study.toml");
    #[rustfmt::skip]
    let cases = [
        ("length = 0.370 ", "length = 370 ", ["`beam.length`: found 370", "is it in millimetres?"]),
        ("width = 0.04125 ", "width = 41.25 ", ["`beam.width`: found 41.25", "is it in millimetres?"]),
        ("density = 7850 ", "density = 7.85 ", ["`beam.layer[0].density`: found 7.85", "is it in g/cm³"]),
    ];
    bench.refused_edits(
        "predict study.toml -o o.joint.json",
        ("study.toml", &text),
        &cases,
    );
}

#[test]
fn a_study_without_a_method_gets_a_list_of_them() {
    let bench = Bench::new();
    bench.write("study.toml", "name = \"x\"\n");
    for command in [IDENTIFY, "show study.toml"] {
        bench.refused(
            command,
            &[
                "`method`: found nothing",
                "\"frf-decoupling\"",
                "\"respond\"",
            ],
        );
    }
}
