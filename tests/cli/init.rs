//! `init`: a first study from what is in a folder.

use bolted_joint_testing::has;

use crate::bench::Bench;

const MODES: &str = include_str!("../../examples/tol-m10x16/a-modes.toml");
const ASSEMBLY: &[u8] = include_bytes!("../../examples/tol-m10x16/assembly.uff");

#[test]
fn a_study_is_made_of_the_files_that_are_there() {
    let bench = Bench::new();
    bench.write("a-modes.toml", MODES);
    bench.write("b.uff", ASSEMBLY);
    bench.write("joined.uff", ASSEMBLY);
    bench.write("notes.md", "nothing");
    bench.write("zz.uff", b"    -1\n    58\nbroken");
    let outcome = bench.done("init");
    has(
        &outcome.stdout,
        &[
            "part a is taken to be a-modes.toml, part b b.uff, the assembly joined.uff",
            "not read: ./zz.uff",
            "look for CHECK",
            "wrote ./study.toml",
            "wrote ./bolted-joint.schema.json",
        ],
    );
    let text = bench.text("study.toml");
    assert!(text.starts_with("#:schema ./bolted-joint.schema.json\n"));
    let schema = bench.json("bolted-joint.schema.json");
    assert_eq!(
        schema["oneOf"][0]["properties"]["method"]["const"],
        "frf-decoupling"
    );
    assert_eq!(
        bench.done("init --schema").stdout,
        bench.text("bolted-joint.schema.json")
    );
    has(
        &text,
        &[
            "modal = \"a-modes.toml\"",
            "frf = \"b.uff\"",
            "frf = \"joined.uff\"",
            "points = [\"11:+Y\", \"12:+Y\", \"13:+Y\"]",
            "points: 1:+Y 2:+Y 3:+Y",
            // no rotation of b was measured
            "model = \"translation\"",
            // b and the assembly go to 512 Hz
            "\nto = 288.3   # CHECK: the highest mode in a-modes.toml\n",
        ],
    );
    // it is a study that every command understands
    let shown = bench.done("show study.toml").stdout;
    has(
        &shown,
        &[
            "study of method \"frf-decoupling\"",
            "assembly.frf = joined.uff: a universal file",
            "frequency.from",
        ],
    );
    let refused = bench.run("identify study.toml -o o.joint.json");
    assert!(
        !refused.stderr.contains("unknown field") && !refused.stderr.contains("TOML parse"),
        "{}",
        refused.stderr
    );
    bench.refused(
        "init",
        &["--output: found ./study.toml", "there is one already"],
    );
    bench.refused(
        "init b.uff",
        &["b.uff: found a file, expected the folder with the measurements"],
    );
    bench.done("init -o other.toml");
    let told = "--output: found study.txt, expected a name that ends in .toml";
    bench.refused("init -o study.txt", &[told]);
    has(
        &bench.done("init -o -").stdout,
        &["method = \"frf-decoupling\""],
    );
    assert!(!bench.done("init -o -").stdout.contains("#:schema"));
}

/// A table of functions between these points, of three lines.
fn table(responses: &str, references: &str) -> String {
    let mut head = "frequency [Hz]".to_owned();
    let mut count = 0;
    for response in responses.split(' ') {
        for reference in references.split(' ') {
            head += &format!(
                ",{response}/{reference} receptance real [m/N],{response}/{reference} imaginary"
            );
            count += 1;
        }
    }
    let line = |hz: usize| format!("{hz}{}\n", ",1e-6,-1e-8".repeat(count));
    format!("{head}\n{}{}{}", line(20), line(21), line(22))
}

#[test]
fn sensors_and_impacts_in_space_have_places_to_be_filled_in() {
    let bench = Bench::new();
    let of = |node: u32| format!("{node}:+X {node}:+Y {node}:+Z");
    let a = [of(101), of(102)].join(" ");
    let (hits_a, hits_b) = ("151:-Z 154:+X", "251:-Z 254:+Y");
    bench.write("a.csv", table(&a, hits_a));
    bench.write("b.csv", table(&of(201), hits_b));
    bench.write(
        "c.csv",
        table(&format!("{a} {}", of(201)), &format!("{hits_a} {hits_b}")),
    );
    let outcome = bench.done("init");
    has(
        &outcome.stdout,
        &[
            "part a is taken to be a.csv, part b b.csv, the assembly c.csv",
            "places near the joint are to be filled in",
        ],
    );
    has(
        &bench.text("study.toml"),
        &[
            "method = \"frf-space\"",
            "[a]\nfrf = \"a.csv\"\n# CHECK: positions in m",
            "{ node = 101, position = [0.0, 0.0, 0.0] }",
            "{ node = 102, position",
            "{ dof = \"151:-Z\", position",
            "{ dof = \"254:+Y\", position",
            "[assembly]",
            "[joint]",
            "length = 0.03",
        ],
    );
    // its keys are those of its method; what is missing are the places
    bench.refused(
        "identify study.toml -o o.joint.json",
        &["`a`: channels: found rank 3, expected 6"],
    );
}

#[test]
fn what_has_the_points_of_all_is_the_assembly_of_a_chain() {
    let bench = Bench::new();
    let six = |node: u32| {
        ["X", "Y", "Z", "RX", "RY", "RZ"]
            .map(|axis| format!("{node}:+{axis}"))
            .join(" ")
    };
    let square = |points: &str| table(points, points).replace(" [m/N]", "");
    let parts = [
        six(14),
        [six(20), six(23)].join(" "),
        six(30) + " 33:+X 33:+Y",
    ];
    for (name, points) in ["a.csv", "b.csv", "c.csv"].into_iter().zip(&parts) {
        bench.write(name, square(points));
    }
    bench.write("whole.csv", square(&parts.join(" ")));
    has(
        &bench.done("init").stdout,
        &["part a is taken to be a.csv, part b b.csv, part c c.csv, the assembly whole.csv"],
    );
    has(
        &bench.text("study.toml"),
        &[
            "[a]\nfrf = \"a.csv\"\ninterface = 14 ",
            "[b]\nfrf = \"b.csv\"\ninterface = 20 ",
            "far = { interface = 23 }",
            "interface = 30 ",
            "responses = [\"33:+X\", \"33:+Y\"]\nreferences = [\"33:+X\", \"33:+Y\"]",
            "[[joint]]                             # a to b",
            "[[joint]]                             # b to c",
            "budget = \"none\"",
        ],
    );
    let shown = bench.done("show study.toml").stdout;
    has(&shown, &["study of method \"frf-space\""]);
}

#[test]
fn a_measurement_may_have_a_file_for_each_reference() {
    let bench = Bench::new();
    let three = "11:+Y 12:+Y 13:+Y";
    bench.write("a.csv", table("1:+Y", "1:+Y"));
    bench.write("b.csv", table(&format!("10:+Y {three}"), "10:+Y"));
    for (number, reference) in three.split(' ').enumerate() {
        bench.write(&format!("c_ref{number}.csv"), table(three, reference));
    }
    let outcome = bench.done("init");
    has(
        &outcome.stdout,
        &["part b b.csv, the assembly c_ref0.csv with c_ref1.csv with c_ref2.csv"],
    );
    assert!(!outcome.stdout.contains("not used"), "{}", outcome.stdout);
    has(
        &bench.text("study.toml"),
        &[
            "frf = [\"c_ref0.csv\", \"c_ref1.csv\", \"c_ref2.csv\"]",
            "points = [\"11:+Y\", \"12:+Y\", \"13:+Y\"]",
        ],
    );
    has(
        &bench.done("show study.toml").stdout,
        &["study of method \"frf-decoupling\""],
    );
}

#[test]
fn the_rotation_of_a_first_study_is_not_about_its_translation() {
    let bench = Bench::new();
    for name in ["a.csv", "b.csv", "joined.csv"] {
        bench.write(
            name,
            table("2:+X 2:+RX 2:+RY", "2:+X").replace(" [m/N]", ""),
        );
    }
    bench.done("init");
    has(
        &bench.text("study.toml"),
        &["joint = { y = \"2:+X\", theta = \"2:+RY\" }"],
    );
}

#[test]
fn a_folder_without_measurements_is_said_to_be_one() {
    let bench = Bench::new();
    bench.refused(
        "init",
        &[
            "found no file of functions or modes in it",
            "expected measured functions",
        ],
    );
    bench.write("decay.csv", "time_s,displacement_m\n0,1e-6\n");
    bench.refused(
        "init",
        &[
            "decay.csv is a table of a free decay",
            "of a study of method \"lap-response\"",
        ],
    );
    bench.write("a.uff", b"    -1\n    58\nbroken");
    bench.write("b.uff", ASSEMBLY);
    bench.refused(
        "init",
        &[
            "found b.uff, which are parts by their names",
            "expected functions of both parts together as well",
            "a.uff",
        ],
    );
    bench.refused(
        "init missing",
        &["missing: cannot be read", "give the folder"],
    );
}

#[test]
fn a_file_called_by_both_parts_is_the_assembly() {
    let bench = Bench::new();
    let few = table("1:+Y", "1:+Y");
    bench.write("a.csv", &few);
    bench.write("ab.csv", &few);
    bench.write("b.csv", table("11:+Y 12:+Y 13:+Y", "11:+Y 12:+Y"));
    has(
        &bench.done("init").stdout,
        &["part a is taken to be a.csv, part b b.csv, the assembly ab.csv"],
    );
    assert!(!bench.text("study.toml").contains("Guessed"));
    let other = Bench::new();
    for name in ["one.csv", "three.csv", "two.csv"] {
        other.write(name, &few);
    }
    has(
        &other.done("init").stdout,
        &["guessed by the order of their names"],
    );
    has(
        &other.text("study.toml"),
        &["CHECK: both, bolted together? Guessed"],
    );
    // magnitudes alone
    other.write("two.csv", few.replace("-1e-8", "0"));
    has(
        &other.done("init -o next.toml").stdout,
        &[
            "two.csv: no function has an imaginary part",
            "magnitudes alone?",
        ],
    );
    let shown = other.done("show two.csv");
    has(&shown.stdout, &["without a phase nothing tells"]);
    has(&shown.stderr, &["magnitudes alone?"]);
}

/// Files with their points, what is told of them, and what stands in the study.
type Case<'a> = (&'a [(&'a str, &'a str)], &'a str, &'a [&'a str]);

#[test]
fn a_part_without_a_file_is_a_beam_to_be_filled_in() {
    let three = "11:+Y 12:+Y 13:+Y";
    #[rustfmt::skip]
    let cases: [Case<'_>; 4] = [
        (&[("a.csv", "1:+Y 2:+Y 2:+RZ"), ("assembly.csv", three)], "part a is taken to be a.csv, part b a beam, the assembly assembly.csv",
         &["[a]                                   # the first part\nfrf = \"a.csv\"\njoint = { y = \"1:+Y\"", "[b]                                   # CHECK: the second part, of which there is no file",
           "points = { \"11:+Y\" = 0.0, \"12:+Y\" = 0.0, \"13:+Y\" = 0.0 }", "points = [\"11:+Y\", \"12:+Y\", \"13:+Y\"]   # CHECK: points of part b", "model = \"full\""]),
        (&[("b.csv", &format!("10:+Y {three}")), ("joined.csv", three)], "part a is taken to be a beam, part b b.csv, the assembly joined.csv",
         &["[a]                                   # CHECK: the first part, of which there is no file", "frf = \"b.csv\"\njoint = { y = \"10:+Y\" }", "points = [\"11:+Y\", \"12:+Y\", \"13:+Y\"]"]),
        (&[("assembly.csv", three)], "part a is taken to be a beam, part b a beam, the assembly assembly.csv",
         &["name = \"joint of two beams\"", "points = { \"11:+Y\" = 0.0"]),
        // points of A alone
        (&[("a.csv", "1:+Y 2:+Y 3:+Y"), ("assembly.csv", "1:+Y 2:+Y")], "part b a beam",
         &["joint = { y = \"3:+Y\" }", "points_on_a = [\"1:+Y\", \"2:+Y\"]   # CHECK: points of part a"]),
    ];
    for (files, told, written) in cases {
        let bench = Bench::new();
        for (name, points) in files {
            bench.write(name, table(points, points).replace(" [m/N]", ""));
        }
        let outcome = bench.done("init");

        has(
            &outcome.stdout,
            &[told, "fill in its numbers, which are 0 in the study"],
        );
        has(&bench.text("study.toml"), written);
        // nobody takes zeros for a beam
        bench.refused("identify study.toml -o o.joint.json", &["beam", "length"]);
    }
}

#[test]
fn one_file_may_have_everything() {
    let both = |first: &str, second: &str| {
        let (one, other) = (table(first, first), table(second, second));
        let lines = one.lines().zip(other.lines());
        let lines = lines.map(|(one, other)| {
            let behind = other.split_once(',').unwrap().1;
            format!("{one},{behind}\n")
        });
        lines.collect::<String>()
    };
    let bench = Bench::new();
    bench.write("all.csv", both("1:+Y 2:+Y", "11:+Y 12:+Y"));
    bench.done("init");
    has(
        &bench.text("study.toml"),
        &[
            "[a]                                   # CHECK: the first part? Guessed",
            "points: 1:+Y 2:+Y\n",
            "frf = \"all.csv\"\npoints = [\"11:+Y\", \"12:+Y\"]",
        ],
    );
    let three = Bench::new();
    let third = table("21:+Y", "21:+Y");
    let two = both("1:+Y", "11:+Y");
    let lines = two.lines().zip(third.lines());
    let lines = lines.map(|(one, other)| format!("{one},{}\n", other.split_once(',').unwrap().1));
    three.write("all.csv", lines.collect::<String>());
    three.refused(
        "init",
        &[
            "found all.csv, with 3 groups of functions that nothing connects (1:+Y; 11:+Y; 21:+Y)",
            "write each group into a file of its own",
        ],
    );
}

#[test]
fn two_tests_of_one_assembly_are_not_taken_for_a_part_and_an_assembly() {
    let bench = Bench::new();
    for name in ["after.csv", "new.csv"] {
        bench.write(name, table("11:+Y 12:+Y", "11:+Y"));
    }
    bench.refused(
        "init",
        &[
            "found after.csv and new.csv, which have the same functions",
            "give each test a folder of its own",
        ],
    );
}

#[test]
fn modes_of_a_measured_part_stand_beside_its_functions() {
    let bench = Bench::new();
    bench.write("a.csv", table("2:+Y", "2:+Y"));
    bench.write("a-modes.toml", MODES);
    bench.write("b.csv", table("10:+Y 11:+Y", "10:+Y 11:+Y"));
    bench.write("assembly.csv", table("11:+Y", "11:+Y"));
    bench.done("init");
    has(
        &bench.text("study.toml"),
        &[
            "[a]                                   # the first part\nfrf = \"a.csv\"\nmodal = \"a-modes.toml\"   # gives what was not measured\n",
        ],
    );
}
