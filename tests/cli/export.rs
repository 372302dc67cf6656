//! `export`: joints and options that do not make an FMU, and what they leave behind, which is nothing.

use bolted_joint_testing::has;
use std::fs;

use crate::bench::Bench;
use crate::joint_file::JOINT;

fn bench(joint: &str) -> Bench {
    let bench = Bench::new();
    bench.write("j.joint.json", joint);
    bench
}

const EXPORT: &str = "export j.joint.json -o o.fmu";

#[test]
fn an_active_joint_needs_to_be_insisted_on() {
    let bench = bench(JOINT);
    let (passive, active) = ("[[6, 0.05], [0.05, 0.02]]", "[[6, 5], [5, 0.02]]");
    bench.edit("j.joint.json", passive, active);
    let found = "j.joint.json: joint.damping is active";
    bench.refused(EXPORT, &[found, "positive semidefinite", "--allow-active"]);
    let outcome = bench.done(&format!("{EXPORT} --allow-active"));
    has(&outcome.stderr, &["warning: joint.damping is active"]);
}

#[test]
fn a_joint_over_preload_needs_a_preload_of_its_table() {
    let preload = r#""over_preload": { "preload": [10, 25], "nominal": 10,
      "stiffness": [[[6e5]], [[9e5]]], "damping": [[[12]], [[8]]] }"#;
    let bench = bench(&format!(
        r#"{{ "format": "bolted-joint/1", "name": "M8", "joint": {{ "dofs": ["y"], {preload} }} }}"#
    ));
    let member = |name: &str| bench.member("o.fmu", name);
    // without one it has the preload as an input, which starts at the nominal one and ends with the table
    let outcome = bench.done(EXPORT);
    has(&outcome.stdout, &["model: M8, bolted joint"]);
    let start = member("resources/start.txt");
    let lines = "\ntable 2 refused\n10.0 600000.0 12.0 0.0\n25.0 900000.0 8.0 0.0\npreload 10.0\n";
    assert!(start.ends_with(lines), "{start}");
    let description = member("modelDescription.xml");
    assert!(description.contains("name=\"preload\""));
    has(&description, &["start=\"10\" min=\"10\" max=\"25\""]);
    assert!(!description.contains("joint.k_yy") && !description.contains("energy.dissipated"));
    let checked = bench.done("check o.fmu");
    has(&checked.stdout, &["no problem found"]);
    // told to extrapolate, it does not end there
    bench.done(&format!("{EXPORT} --extrapolate"));
    assert!(member("resources/start.txt").contains("\ntable 2 held\n"));
    assert!(!member("modelDescription.xml").contains("max=\"25\""));
    let checked = bench.done("check o.fmu");
    has(&checked.stdout, &["no problem found"]);
    let both = bench.run(&format!("{EXPORT} --extrapolate --preload 12"));
    assert_eq!(both.code, Some(2));
    // with one it is constant
    let outcome = bench.done(&format!("{EXPORT} --preload 10"));
    has(&outcome.stdout, &["model: M8, at 10 N·m"]);
    assert!(member("modelDescription.xml").contains("joint.k_yy"));
    let found = "j.joint.json: preload: found 30.0 N·m";
    let expected = [found, "expected 10.0 to 25.0 N·m"];
    bench.refused(&format!("{EXPORT} --preload 30"), &expected);
}

#[test]
fn a_lap_needs_bodies() {
    let end = JOINT.find(",\n  \"bodies\"").unwrap();
    let bench = bench(&format!("{}\n}}\n", &JOINT[..end]));
    let expected = ["j.joint.json: bodies: not found", "export as element"];
    bench.refused(&format!("{EXPORT} --as lap"), &expected);
    bench.done(EXPORT);
}

#[test]
fn step_sizes_that_cannot_be_are_refused() {
    let bench = bench(JOINT);
    #[rustfmt::skip]
    let cases = [
        ("--step-size-max 1e-5", ["found 1e-5 s for the element", "export as lap"]),
        ("--as lap --step-size-max 0", ["found 0.0 s", "greater than zero"]),
        ("--as lap --step-size-max -1e-5", ["found -1e-5 s", "greater than zero"]),
        ("--as lap --step-size-max nan", ["found NaN s", "finite number of seconds"]),
        ("--as lap --step-size-max inf", ["found inf s", "finite number of seconds"]),
        ("--as lap --step-size-max 1", ["found 1.0 s, with which RK4 is unstable", "expected at most"]),
    ];
    for (options, [one, two]) in cases {
        bench.refused(&format!("{EXPORT} {options}"), &["step size: ", one, two]);
    }
    #[rustfmt::skip]
    let errors = [
        ("--step-error 1e-5", ["found 1e-5 for the element", "export as lap"]),
        ("--as lap --step-error 0", ["found 0.0", "from 1e-12 to 0.1"]),
        ("--as lap --step-error nan", ["found NaN", "from 1e-12 to 0.1"]),
        ("--as lap --step-error 2", ["found 2.0", "leave it out for an accurate step"]),
    ];
    for (options, [one, two]) in errors {
        bench.refused(
            &format!("{EXPORT} {options}"),
            &["--step-error: ", one, two],
        );
    }
}

#[test]
fn the_step_of_a_lap_follows_from_the_error_that_is_allowed() {
    let bench = bench(JOINT);
    let steps = ["1e-5", "1e-7", "1e-9"].map(|error| {
        let command = format!("{EXPORT} --as lap --step-error {error} --json");
        let exported = bench.done(&command).json();
        exported["step_size_max_s"].as_f64().unwrap()
    });
    // of fourth order: a hundredth of the error takes steps of 0.316 times the length, and the search is as fine as 1/16
    for pair in steps.windows(2) {
        let ratio = pair[1] / pair[0];
        assert!((0.28..0.36).contains(&ratio), "{steps:?}");
    }
    let said = bench.done(&format!("{EXPORT} --as lap --step-error 1e-6"));
    assert!(said.stdout.contains(", error "), "{}", said.stdout);
    let json = bench.done(&format!("{EXPORT} --as lap --step-error 1e-6 --json"));
    let reached = json.json()["step_error"].as_f64().unwrap();
    assert!((1e-8..=1e-6).contains(&reached), "{reached}");
}

#[test]
#[rustfmt::skip]
fn a_folder_of_platforms_must_hold_platforms() {
    let bench = bench(JOINT);
    let command = format!("{EXPORT} --platforms p");
    bench.refused(&command, &["p: cannot be read", "such as x86_64-windows"]);
    fs::create_dir(bench.path("p")).unwrap();
    bench.write("p/README.md", "libraries");
    bench.refused(&command, &["p: found no platform's folder", "such as x86_64-windows"]);
    fs::create_dir(bench.path("p/win64")).unwrap();
    bench.refused(&command, &["win64: is not the name of a platform", "rename or remove"]);
    fs::rename(bench.path("p/win64"), bench.path("p/x86_64-windows")).unwrap();
    bench.refused(&command, &["bolted_joint.dll: not found", "build it, or remove the folder"]);
    bench.write("p/x86_64-windows/bolted_joint.dll", "text");
    bench.refused(&command, &["bolted_joint.dll: is not a shared library", "PE format"]);
    bench.write("p/x86_64-windows/bolted_joint.dll", "MZ and so on");
    let outcome = bench.done(&format!("{command} --json"));
    let platforms = outcome.json()["platforms"].clone();
    assert!(platforms.as_array().unwrap().contains(&"x86_64-windows".into()));
}

#[test]
fn a_date_that_is_none_is_refused() {
    let bench = bench(JOINT);
    for date in ["", "today", "-1", "1.5", "253402300800"] {
        let mut command = bench.command(EXPORT);
        let found = format!("SOURCE_DATE_EPOCH: found {date:?}");
        let fragments = [&found, "whole number", "unset it"];
        bench.refused_by(command.env("SOURCE_DATE_EPOCH", date), &fragments);
    }
}

#[test]
fn the_same_date_gives_the_same_bytes() {
    let bench = bench(JOINT);
    for name in ["one.fmu", "two.fmu"] {
        let mut command = bench.command(&format!("export j.joint.json -o {name}"));
        let output = command.env("SOURCE_DATE_EPOCH", "0").output().unwrap();
        assert!(output.status.success());
    }
    assert!(fs::read(bench.path("one.fmu")).unwrap() == fs::read(bench.path("two.fmu")).unwrap());
}

#[test]
fn five_lines_say_what_was_written_and_for_which_version() {
    let bench = bench(JOINT);
    for (version, number, platforms) in [
        ("3", "3.0", "platforms: x86_64-linux"),
        ("2", "2.0", "platforms: linux64"),
    ] {
        let arguments = format!("{EXPORT} --fmi {version} --as lap");
        let outcome = bench.done(&arguments);
        let lines: Vec<&str> = outcome.stdout.lines().collect();
        assert_eq!(lines.len(), 5, "{}", outcome.stdout);
        let wrote = format!("wrote o.fmu (FMI {number}, ");
        let starts = [&wrote, "model: ", "steps: ", "platforms: ", "token: "];
        for (line, start) in lines.iter().zip(starts) {
            assert!(line.starts_with(start), "{line}");
        }
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            assert_eq!(lines[3], platforms);
        }
        let json = bench.done(&format!("{arguments} --json")).json();
        assert_eq!(json["fmi_version"], number);
    }
}

#[test]
fn a_system_is_of_an_assembly() {
    let says = ["--output: found o.ssp", "an SSP is of an assembly"];
    bench(JOINT).refused("export j.joint.json -o o.ssp", &says);
}

#[test]
fn that_no_step_is_known_to_be_accurate_where_a_joint_slips_is_said() {
    // the motion grows beyond all bounds, and no run of it tells the error of a step
    let active = r#"{ "format": "bolted-joint/1", "name": "active", "joint": { "dofs": ["y"], "stiffness": [[-3e6]],
        "damping": [[20]], "friction": [{ "dof": "y", "law": "jenkins", "stiffness": 1e5, "slip_force": 10 }] },
        "bodies": { "a": { "inertia": [0.5], "stiffness": [2e5], "damping": [3] },
                    "b": { "inertia": [0.3], "stiffness": [1e5], "damping": [2] } } }"#;
    let insisted = format!("{EXPORT} --as lap --allow-active");
    let outcome = bench(active).done(&insisted);
    has(
        &outcome.stdout,
        &["at rest; how accurate it is where the joint slips is not known (--step-error)"],
    );
    let bench = bench(&active.replace("-3e6", "3e6"));
    assert!(!bench.done(&insisted).stdout.contains("not known"));
}
