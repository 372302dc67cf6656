//! `show`: what is in a file of every kind; and commands that get another kind of file than they take.

use std::io::{Cursor, Write as _};

use bolted_joint_testing::has;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::bench::{Bench, PNG, replaced};
use crate::joint_file::JOINT;

const STUDY: &str = include_str!("../../examples/tol-m10x16/study.toml");
const MODES: &str = include_str!("../../examples/tol-m10x16/a-modes.toml");
const ASSEMBLY: &[u8] = include_bytes!("../../examples/tol-m10x16/assembly.uff");
const JENKINS: &str = include_str!("../../examples/friction/jenkins.joint.json");
const OVER_PRELOAD: &str = include_str!("../data/joint/over-preload.joint.json");
const ARCHIVE: &[u8] = include_bytes!("../data/arrays/square_with_axes.npz");
const MATLAB: &[u8] = include_bytes!("../data/arrays/cells.mat");
const COHERENCE: &[u8] = include_bytes!("../data/uff/coherence.uff");

const BEAMS: &str = "
name = \"two beams\"
[structures.a]
beam = { length = 0.3, width = 0.025, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = \"fixed-free\", damping_ratio = 0.002 }
points = { \"1:+Y\" = 0.285, \"1:+RZ\" = 0.285 }
[structures.b]
beam = { length = 0.22, width = 0.025, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = \"free-free\", damping_ratio = 0.002 }
points = { \"2:+Y\" = 0.015, \"2:+RZ\" = 0.015, \"3:+Y\" = 0.22 }
[[joints]]
file = \"j.joint.json\"
a = { structure = \"a\", y = \"1:+Y\", theta = \"1:+RZ\" }
b = { structure = \"b\", y = \"2:+Y\", theta = \"2:+RZ\" }
[inputs]
push = \"b/3:+Y\"
[outputs]
tip = \"b/3:+Y\"
";

/// Two oscillators' functions, of which the drive point at 2 is turned and the transposed pair differs by a tenth.
fn table() -> String {
    let mut text = "# quantity = receptance\n# unit = m/N\nfrequency,1:+Y/1:+Y real,1:+Y/1:+Y imaginary,2:+Y/2:+Y real,2:+Y/2:+Y imaginary,\
                    1:+Y/2:+Y real,1:+Y/2:+Y imaginary,2:+Y/1:+Y real,2:+Y/1:+Y imaginary\n"
        .to_owned();
    for line in 1..=200 {
        let hz = 0.5 * f64::from(line);
        // H = 1/(f₀² − f² + 2jζ f₀ f)
        let (re, im) = (40.0 * 40.0 - hz * hz, 2.0 * 0.03 * 40.0 * hz);
        let size = re * re + im * im;
        let (re, im) = (re / size, -im / size);
        text += &format!(
            "{hz},{re},{im},{},{},{re},{im},{},{}\n",
            -re,
            -im,
            1.25 * re,
            1.25 * im
        );
    }
    text
}

/// An archive of NumPy with matrices of two masses between three springs.
/// An FMU that this program did not write.
fn fmu_of_another_tool() -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    archive
        .start_file("modelDescription.xml", SimpleFileOptions::default())
        .unwrap();
    let description = r#"<fmiModelDescription fmiVersion="2.0" modelName="Bouncing Ball" guid="1" generationTool="a tool of theirs">
        <CoSimulation modelIdentifier="b"/><ModelVariables>
        <ScalarVariable name="push" valueReference="0" causality="input"><Real/></ScalarVariable>
        <ScalarVariable name="height" valueReference="1" causality="output"><Real/></ScalarVariable>
        </ModelVariables></fmiModelDescription>"#;
    archive.write_all(description.as_bytes()).unwrap();
    archive.finish().unwrap().into_inner()
}

/// A study in space before there is a measured assembly.
const PLAN: &str = "
method = \"frf-space\"
name = \"a plan\"
[a]
modal = \"a-modes.toml\"
interface = 2
[b]
modal = \"a-modes.toml\"
interface = 2
[joint]
model = \"free\"
";

fn matrices() -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let mut member = |name: &str, kind: &str, shape: &str, data: Vec<u8>| {
        archive
            .start_file(name, SimpleFileOptions::default())
            .unwrap();
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        let header = format!("{header:<117}\n");
        archive.write_all(b"\x93NUMPY\x01\x00").unwrap();
        archive
            .write_all(&u16::try_from(header.len()).unwrap().to_le_bytes())
            .unwrap();
        archive.write_all(header.as_bytes()).unwrap();
        archive.write_all(&data).unwrap();
    };
    let numbers = |all: [f64; 4]| {
        all.iter()
            .flat_map(|own| own.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let k = 4.0 * std::f64::consts::PI.powi(2) * 100.0;
    member("M.npy", "<f8", "(2, 2)", numbers([1.0, 0.0, 0.0, 1.0]));
    member(
        "K.npy",
        "<f8",
        "(2, 2)",
        numbers([2.0 * k, -k, -k, 2.0 * k]),
    );
    let points = "2:+Y\0\0\0\0"
        .chars()
        .flat_map(|own| u32::from(own).to_le_bytes());
    member("points.npy", "<U4", "(2,)", points.collect());
    archive.finish().unwrap().into_inner()
}

/// A bench with a file of each kind.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    bench.write("a-modes.toml", MODES);
    bench.write("assembly.uff", ASSEMBLY);
    bench.write("j.joint.json", JOINT);
    bench.write("beams.toml", BEAMS);
    bench
}

#[test]
fn measured_functions_are_described_and_checked() {
    let bench = bench();
    let text = bench.done("show assembly.uff").stdout;
    // 2048 lines 0.25 Hz apart between three points, as its header says
    has(
        &text,
        &[
            "assembly.uff: universal file, 58 (ASCII)",
            "9: 3 responses by 3 references, every pair",
            "11:+Y 12:+Y 13:+Y",
            "receptance, as the file says",
            "data set 164: m, N",
            "2048 from 0.25 to 512 Hz, 0.25 Hz apart",
            "none; averages not stated",
            "11:+Y 12:+Y 13:+Y: take energy, as they must",
            "11:+Y / 12:+Y: half of the lines within 1.",
        ],
    );
    let json = bench.done("show assembly.uff --json").json();
    assert_eq!(json[0]["details"]["lines"], 2048);
    assert_eq!(json[0]["details"]["frequency_hz"][1], 512.0);

    bench.write("t.csv", table());
    let outcome = bench.done("show t.csv");
    // |1 − 1.25| over the mean of 1 and 1.25
    has(
        &outcome.stdout,
        &[
            "1:+Y / 2:+Y: half of the lines within 22.22 %",
            "resonances    39.9",
        ],
    );
    has(
        &outcome.stderr,
        &[
            "drive point 2:+Y: 100 % of the imaginary part of the receptance is positive",
            "the sign of the response or of the load is turned",
            "between 1:+Y and 2:+Y differ by 22 % at half of the lines",
        ],
    );
}

#[test]
fn every_kind_of_file_is_described() {
    let bench = bench();
    bench.write("jenkins.joint.json", JENKINS);
    bench.write("over.joint.json", OVER_PRELOAD);
    bench.write("m.npz", matrices());
    bench.write("f.npz", ARCHIVE);
    bench.write("f.mat", MATLAB);
    bench.write("c.uff", COHERENCE);
    bench.done("export j.joint.json -o j.fmu");
    bench.done("export beams.toml -o beams.fmu");
    bench.write("ball.fmu", fmu_of_another_tool());
    bench.write("plan.toml", PLAN);
    bench.write(
        "known.toml",
        PLAN.replace("model = \"free\"", "known = \"j.joint.json\""),
    );
    #[rustfmt::skip]
    let cases = [
        ("c.uff", ["universal file", "coherence", "of 1 function: lowest"].as_slice()),
        ("f.npz", &["NumPy archive (npz)", "responses"]),
        ("f.mat", &["MATLAB file (mat)", "responses"]),
        // two masses of 1 kg between three springs: √(k/m)/2π and √(3k/m)/2π of k = 4π²·100 N/m
        ("m.npz", &["matrices of a structure", "2, 1 of them with names", "2:+Y", "10 17.321 Hz, the lowest, undamped"]),
        ("a-modes.toml", &["modes of a structure", "damping ratio", "residuals"]),
        ("study.toml", &["study of method \"frf-decoupling\"", "M10x16 A2-70", "a.modal = a-modes.toml: modes of a structure",
            "assembly.frf = assembly.uff: a universal file", "bolted-joint identify study.toml -o NAME.joint.json"]),
        ("beams.toml", &["assembly of structures and joints", "two bodies, between a/1:+Y a/1:+RZ and b/2:+Y b/2:+RZ", "push: b/3:+Y",
            "bolted-joint respond beams.toml -o NAME.csv"]),
        ("j.joint.json", &["joint file", "k_yy = 80000 N/m", "k_ytheta = 600 N/rad", "c_thetatheta = 0.02 N·m·s/rad"]),
        ("jenkins.joint.json", &["jenkins on y: stiffness", "slip_force"]),
        ("over.joint.json", &["nominal 10 N·m", "25 N·m: k_yy = 900000 N/m, c_yy = 8 N·s/m"]),
        ("j.fmu", &["FMU of this program", "linux", "k_yy = 80000 N/m", "bolted-joint check j.fmu"]),
        ("beams.fmu", &["FMU of a whole assembly", "linux", "1 load", "coordinates of the structures", "bolted-joint check beams.fmu"]),
        ("ball.fmu", &["FMU of another tool", "Bouncing Ball", "a tool of theirs", "FMI 2.0, Co-Simulation", "push", "height"]),
        ("plan.toml", &["frf-space", "next", "bolted-joint respond plan.toml --plan --step HZ"]),
        ("known.toml", &["frf-space", "bolted-joint respond known.toml -o NAME.csv --step HZ"]),
    ];
    for (file, fragments) in cases {
        let text = bench.done(&format!("show {file}")).stdout;
        has(&text, fragments);
        assert!(text.lines().count() <= 40, "more than a screen:\n{text}");
    }
    bench.refused(
        "check ball.fmu",
        &[
            "ball.fmu: found an FMU of another tool (it says \"a tool of theirs\")",
            "show",
            "fmpy validate",
        ],
    );
    let together = bench.done("show j.joint.json a-modes.toml").stdout;
    has(
        &together,
        &["j.joint.json: joint file", "\n\na-modes.toml: modes"],
    );
}

#[test]
fn files_are_drawn_on_a_page_and_as_svg() {
    let bench = bench();
    bench.write("jenkins.joint.json", JENKINS);
    bench.write("over.joint.json", OVER_PRELOAD);
    bench.write("c.uff", COHERENCE);
    let all = "assembly.uff c.uff a-modes.toml beams.toml j.joint.json jenkins.joint.json over.joint.json";
    has(
        &bench.done(&format!("show {all} --plot o.html")).stdout,
        &["wrote o.html"],
    );
    let page = bench.text("o.html");
    has(
        &page,
        &[
            "<h1>7 files</h1>",
            "Load at 11:+Y",
            ">magnitude, m/N</text>",
            ">coherence γ²</text>",
            "Computed, load on push",
            "Dynamic stiffness of the joint",
            "Load over a slow cycle",
            "Stiffness over the preload",
        ],
    );
    assert!(
        !page.contains("src=\"http") && !page.contains("href=\"http"),
        "no network"
    );
    for file in all.split_whitespace() {
        bench.done(&format!("show {file} --plot o.svg"));
        let svg = bench.text("o.svg");
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"), "{file}");
    }
    bench.refused(
        "show study.toml --plot s.svg",
        &["--plot: found s.svg", "something to draw"],
    );
    bench.refused(
        "show j.joint.json --plot s.pdf",
        &["--plot: found s.pdf", ".html or .svg"],
    );
    bench.refused("show o.svg --plot o.svg", &["same file"]);
}

#[test]
fn tables_and_systems_are_told_by_what_is_in_them() {
    let bench = bench();
    bench.write(
        "run.csv",
        "# level 1\nfrequency_hz;force_n;displacement_m;phase_rad\n80,5;1;1e-4;-1,5\n81;1;2e-4;-2\n",
    );
    has(
        &bench.done("show run.csv").stdout,
        &[
            "run.csv: table of stepped sines (CSV)",
            "frequency_hz from 80.5 to 81",
            "[[sine]] of a study of method \"lap-response\"",
        ],
    );
    bench.write("reference-run-in.csv", "time,b.F\n0,1\n0.5,2\n");
    let text = bench.done("show reference-run-in.csv").stdout;
    has(&text, &["table over time (CSV)", "b.F from 1 to 2"]);
    bench.refused(
        "identify run.csv -o o.joint.json",
        &[
            "found a table of stepped sines (CSV)",
            "`bolted-joint show run.csv`",
        ],
    );
    bench.done("export beams.toml -o o.ssp");
    has(
        &bench.done("show o.ssp").stdout,
        &["o.ssp: system of FMUs (SSP)", "resources/", "nominal.ssv"],
    );
}

#[test]
fn what_cannot_be_shown_is_said() {
    let bench = bench();
    bench.write("p.png", PNG);
    bench.write("o.json", "{\"a\": 1}");
    bench.write("e.toml", "");
    bench.write("l", "[1, 2]\n[3, 4]\n");
    bench.write("l.joint.json", format!("[{JOINT}]"));
    bench.write("h.joint.json", "[frequency]\nfrom = 1\n");
    bench.write("h", "[frequency]\nfrom = 1\n");
    bench.write("q.joint.json", "{'format': 'bolted-joint/1'}");
    bench.write("e.joint.json", "\n");
    bench.write(
        "v.mat",
        b"MATLAB 7.3 MAT-file, Platform: GLNXA64, HDF5 schema 1.00 .",
    );
    bench.write(
        "u.csv",
        table().replace("# unit = m/N\n", "# unit = furlong\n"),
    );
    bench.edit("beams.toml", "j.joint.json", "missing.json");
    #[rustfmt::skip]
    let cases = [
        ("show missing.uff", ["missing.uff", "cannot be read"]),
        ("show p.png", ["p.png: found a file of an unknown kind", "an FMU or an SSP"]),
        ("show o.json", ["o.json: found a JSON file", "expected measured functions"]),
        ("show l", ["l: found a list, as in JSON", "check the path"]),
        ("show l.joint.json", ["found a list, expected an object", "take the joint file that is in it out of the brackets"]),
        ("show h.joint.json", ["found the table header [frequency] of TOML", "give the NAME.joint.json"]),
        ("show h", ["h: `method`: found nothing", "such as method ="]),
        ("show q.joint.json", ["q.joint.json:1:2: is not JSON", "give the NAME.joint.json"]),
        ("show .", [".: found a folder", "check the path"]),
        ("show e.toml", ["e.toml: found an empty file", "a study, an assembly, a joint file"]),
        ("show e.joint.json", ["e.joint.json: found an empty file", "a study, an assembly, a joint file"]),
        ("show v.mat", ["v.mat", "7.3"]),
        ("show u.csv", ["the unit \"furlong\"", "state units in the study"]),
        ("show beams.toml", ["missing.json", "cannot be read"]),
    ];
    for (arguments, fragments) in cases {
        bench.refused(arguments, &fragments);
    }
    // as every command says of a joint that nobody should rely on
    let status =
        "\"status\": { \"usable\": false, \"reasons\": [\"has not converged\"] }, \"name\"";
    bench.write("bad.joint.json", JOINT.replacen("\"name\"", status, 1));
    bench.unusable("show bad.joint.json", &["has not converged"]);
}

#[test]
fn an_active_joint_is_told_as_by_check() {
    let bench = bench();
    let active = replaced(JOINT, "[[6, 0.05], [0.05, 0.02]]", "[[6, 5], [5, 0.02]]");
    bench.write("j.joint.json", active);
    bench.done("export j.joint.json -o j.fmu --allow-active");
    let said = "joint.damping is active: smallest eigenvalue ";
    let why = "expected it positive semidefinite: this joint can feed energy into a simulation";
    for file in ["j.joint.json", "j.fmu", "beams.toml"] {
        let shown = bench.done(&format!("show {file}"));
        assert_eq!(shown.stderr.matches(said).count(), 1, "{}", shown.stderr);
        has(&shown.stderr, &[why]);
        let fact = "  passive       no, it is active: it can feed energy into a simulation\n";
        let has_fact = shown.stdout.contains(fact);
        assert_eq!(has_fact, file != "beams.toml", "{}", shown.stdout);
        has(
            &bench.fails(&format!("check {file}"), &[said]).stderr,
            &[why],
        );
    }
    let json = bench.done("show j.joint.json --json").json();
    assert_eq!(json[0]["details"]["passive"], false);
    assert_eq!(json[0]["facts"]["passive"].as_array().unwrap().len(), 1);
}

#[test]
fn a_command_that_gets_another_kind_of_file_names_the_right_one() {
    let bench = bench();
    bench.write(
        "layers.toml",
        include_str!("../../examples/kavi-layered-beam/study.toml"),
    );
    bench.write(
        "loops.toml",
        include_str!("../../examples/friction/loops.toml"),
    );
    bench.done("export j.joint.json -o j.fmu");
    bench.write(
        "broken.toml",
        BEAMS.replacen("name = \"two beams\"", "name = \"two beams", 1),
    );
    bench.write("README.md", "# A title\n\nA sentence, and another.\n");
    #[rustfmt::skip]
    let cases = [
        ("identify README.md -o o.joint.json", "README.md: found a file of an unknown kind, expected a study (TOML); check the path"),
        ("export README.md -o o.fmu", "README.md: found a file of an unknown kind, expected a joint file (JSON) or an assembly file (TOML); check the path"),
        ("check assembly.uff", "found a universal file, expected a joint file (JSON), an assembly file (TOML), an FMU or an SSP; `bolted-joint show assembly.uff` takes it"),
        ("check study.toml", "found a study of method \"frf-decoupling\", expected a joint file (JSON), an assembly file (TOML), an FMU or an SSP; `bolted-joint identify study.toml -o NAME.joint.json` takes it"),
        ("check a-modes.toml", "found modes of a structure"),
        ("check .", "found a folder"),
        ("export study.toml -o o.fmu", "found a study of method"),
        ("export j.fmu -o o.fmu", "found an FMU, expected a joint file (JSON) or an assembly file (TOML); `bolted-joint check j.fmu` takes it"),
        ("identify layers.toml -o o.joint.json", "`bolted-joint predict` takes this study"),
        ("identify loops.toml -o o.joint.json", "`bolted-joint respond` takes this study"),
        ("identify beams.toml -o o.joint.json", "found an assembly file, expected a study (TOML); `bolted-joint respond beams.toml -o NAME.csv` takes it"),
        ("identify assembly.uff -o o.joint.json", "found a universal file, expected a study (TOML)"),
        ("identify j.joint.json -o o.json", "found a joint file, expected a study (TOML); `bolted-joint export j.joint.json -o NAME.fmu` takes it"),
        ("predict study.toml -o o.joint.json", "`bolted-joint identify` takes this study"),
        ("predict j.fmu -o o.joint.json", "found an FMU, expected a study"),
        ("respond j.joint.json -o o.csv", "found a joint file, expected a study or an assembly file (TOML)"),
        ("respond study.toml --joint study.toml -o o.csv", "study.toml: found a study of method"),
        // a mistake in an assembly file is told as one, and not as a study without a method
        ("respond broken.toml -o o.csv", "TOML parse error at line 2"),
    ];
    for (arguments, fragment) in cases {
        bench.refused(arguments, &[fragment]);
    }
}

#[test]
fn files_beside_one_that_cannot_be_read_are_shown() {
    let bench = crate::rig::ready();
    let outcome = bench.run("show c.uff nothing study.toml nobody");
    assert_eq!(outcome.code, Some(1));
    has(
        &outcome.stdout,
        &["c.uff: universal file", "study.toml: study of method"],
    );
    has(
        &outcome.stderr,
        &[
            "error: nothing: cannot be read",
            "error: nobody: cannot be read",
        ],
    );
    let outcome = bench.run("show nothing nobody");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(1), ""));
    has(
        &outcome.stderr,
        &[
            "error: nothing: cannot be read",
            "error: nobody: cannot be read",
        ],
    );
}

#[test]
fn a_universal_file_without_functions_is_told_by_its_data_sets() {
    let bench = crate::rig::ready();
    // function type 1 is a time response
    let functions = bench.text("c.uff");
    let of_time = functions
        .split("    -1\n    58\n")
        .map(|own| match own.lines().nth(5) {
            Some(record) => own.replacen(record, &record.replacen("   4", "   1", 1), 1),
            None => own.to_owned(),
        });
    let of_time = of_time.collect::<Vec<_>>().join("    -1\n    58\n");
    assert_ne!(of_time, functions);
    let mesh = "    -1\n  2411\n         1         1         1        11\n    -1\n";
    bench.write("c.uff", format!("{mesh}{of_time}"));
    let shown = bench.done("show c.uff").stdout;
    has(
        &shown,
        &[
            "c.uff: universal file without frequency response functions",
            "9 × time response (data set 58) at 21:+Y 22:+Y 23:+Y",
            "1 × data set 2411 (nodes)",
            "export the measurement as data sets 58 of function type 4",
        ],
    );
    let details = &bench.done("show --json c.uff").json()[0]["details"];
    assert_eq!(details["data_sets"].as_array().unwrap().len(), 2);
    bench.refused(
        crate::bench::IDENTIFY,
        &[
            "c.uff: found no frequency response function but 9 ",
            "× time response (data set 58)",
            "data sets 58 of function type 4",
        ],
    );
}
