//! `check` runs the library in an FMU: sound ones pass, and none that fails takes the report with it.

use bolted_joint_testing::has;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use bolted_joint::check::{RunVerdict, Runner, inspect, run};

use crate::bench::{Bench, Outcome, replaced};
use crate::check::repacked;
use crate::joint_file::JOINT;

/// A bench with one FMU.
fn bench(interface: &str, version: &str, joint: &str) -> Bench {
    let bench = Bench::new();
    bench.write("j.joint.json", joint);
    bench.done(&format!(
        "export j.joint.json -o x.fmu --as {interface} --fmi {version}"
    ));
    bench
}

/// The bench's FMU with a library in it that fails.
fn with_fault(bench: &Bench, fault: &str) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/faulty_library.rs");
    let library = bench.path("faulty");
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(compiler)
        .args(["--edition=2024", "--crate-type=cdylib", "--cap-lints=allow"])
        .arg(format!("--cfg=fault=\"{fault}\""))
        .arg(source)
        .arg("-o")
        .arg(&library)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let bytes = std::fs::read(library).unwrap();
    repacked(bench, "x.fmu", "faulty.fmu", |name, old| {
        let is_library = name.starts_with("binaries/");
        Some(if is_library { bytes.clone() } else { old })
    });
}

fn checked(bench: &Bench, file: &str) -> Outcome {
    bench.run(&format!("check {file} --json"))
}

#[test]
fn sound_fmus_run_and_their_energy_is_balanced() {
    let cubic = replaced(JOINT, "\"cubic\": [0, 0]", "\"cubic\": [3e10, -2e4]");
    let higher = replaced(
        JOINT,
        "\"cubic\": [0, 0]",
        "\"cubic\": [-3e9, 2e3], \"higher\": { \"quintic\": [8e13, -3e3], \"septic\": [-2e17, 4e4], \
         \"damping_quadratic\": [2e5, 1], \"damping_quartic\": [5e9, -10], \"amplitude\": [3e-3, 0.05] }",
    );
    for joint in [JOINT, &cubic, &higher] {
        for interface in ["element", "lap"] {
            for version in ["2", "3"] {
                let outcome = checked(&bench(interface, version, joint), "x.fmu");
                assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
                let report = outcome.json();
                assert_eq!(report["sound"], true);
                assert_eq!(report["run"]["verdict"], "ran");
                let energy = |key: &str| report["run"]["energy"][key].as_f64().unwrap();
                assert!(energy("imbalance").abs() <= energy("tolerance"));
                // a balance that could be off: energy went in and part of it became heat
                assert!(energy("tolerance") < 1e-5 * energy("work").abs());
                assert!(energy("dissipated") > 1e-3 * energy("work").abs());
                let facts = report["facts"].to_string();
                has(&facts, &["loads: those", "derivatives: those"]);
                has(&facts, &["last bit", "reference run: met"]);
                assert_eq!(report["messages"].as_array().unwrap().len(), 0);
            }
        }
    }
}

#[test]
fn a_library_that_fails_is_told_of_with_what_it_logged() {
    let bench = bench("lap", "3", JOINT);
    #[rustfmt::skip]
    let cases = [
        ("crashes", ["the library ended its process (signal 6, abort) during the step at t = 0.0 s", ""]),
        ("exits", ["(exit code 7) during the step", "it said: licence not found"]),
        ("refuses", ["fmi3InstantiateCoSimulation returned null; Warning [logStatusWarning]: about to fail", "during instantiation"]),
        ("lacks", ["found no function fmi3DeserializeFMUState", "during loading"]),
        ("prints", ["bytes on standard output", "as it was set"]),
        ("zeros", ["found the motion [0.0, 0.0", ""]),
    ];
    for (fault, fragments) in cases {
        if cfg!(not(unix)) && fault == "crashes" {
            continue;
        }
        with_fault(&bench, fault);
        let outcome = bench.fails("check faulty.fmu", &fragments);
        // the rest of the report is there
        has(&outcome.stdout, &["joint.stiffness is passive"]);
        let logged = "the FMU logged: Warning [logStatusWarning]: about to fail";
        assert_eq!(outcome.stdout.contains(logged), fault != "lacks");
        // left out: none of its code is run
        bench.done("check faulty.fmu --no-run");
    }
}

#[test]
fn a_library_that_hangs_is_ended() {
    let bench = bench("lap", "3", JOINT);
    with_fault(&bench, "hangs");
    let fmu = bench.path("faulty.fmu");
    let runner = Runner {
        program: env!("CARGO_BIN_EXE_bolted-joint").into(),
        arguments: vec!["run-library".to_owned()],
        time_limit: Duration::from_secs(1),
    };
    let began = Instant::now();
    let report = run(&fmu, &inspect(&fmu).unwrap(), &runner).unwrap();
    assert!(began.elapsed() < Duration::from_secs(10));
    assert_eq!(report.verdict, RunVerdict::Failed);
    let ended = "had not come to an end after 1 s, during the step at t = 0.0 s";
    has(&report.findings[0], &[ended]);
}

#[test]
fn without_a_library_for_this_platform_the_rest_is_checked() {
    let bench = bench("element", "3", JOINT);
    let mut archive =
        zip::ZipArchive::new(std::fs::File::open(bench.path("x.fmu")).unwrap()).unwrap();
    let mut other = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        let name = match name.strip_prefix("binaries/") {
            // the name stays that of the model identifier
            Some(own) => match own.split_once('/') {
                Some((_, file)) => format!("binaries/riscv32-linux/{file}"),
                None => name,
            },
            None => name,
        };
        other.raw_copy_file_rename(entry, name).unwrap();
    }
    bench.write("x.fmu", other.finish().unwrap().into_inner());
    let outcome = bench.done("check x.fmu");
    let left_out = "run: left out, as the FMU has no library for this platform";
    has(&outcome.stdout, &["platforms: riscv32-linux", left_out]);
}

#[test]
fn a_reference_run_that_is_not_met_is_found() {
    let bench = bench("lap", "3", JOINT);
    let outputs = "extra/org.fmi-standard.fmi-ls-ref/reference-run-out.csv";
    // the last column is power.dissipated
    let other_power = |text: &str| {
        let line = text.lines().nth(10).unwrap();
        let (others, _) = line.rsplit_once(',').unwrap();
        replaced(text, line, &format!("{others},1e3"))
    };
    let other_time = |text: &str| text.replacen("time,", "t,", 1);
    let other_name = |text: &str| text.replacen("a.y", "a.z", 1);
    type Change<'a> = &'a dyn Fn(&str) -> String;
    let changes: [(Change<'_>, &str); 3] = [
        (&other_power, "reference run: found power.dissipated = "),
        (&other_time, "expected one that begins with `time`"),
        (&other_name, "found variable a.z"),
    ];
    for (change, fragment) in changes {
        repacked(&bench, "x.fmu", "other.fmu", |name, bytes| {
            if name != outputs {
                return Some(bytes);
            }
            Some(change(&String::from_utf8(bytes).unwrap()).into_bytes())
        });
        bench.fails("check other.fmu", &[fragment]);
    }
}
