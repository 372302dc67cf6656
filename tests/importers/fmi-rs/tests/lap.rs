//! The crate fmi-rs, an importer of FMI 2.0 and 3.0 in Rust: its validator, and simulations against a closed form.
//!
//! `BOLTED_JOINT` names the executable that exports the FMUs.

use std::{env, fs, path::PathBuf, process::Command};

use fmi_rs::{
    fmi2::{builder::FMU2Builder, types::fmi2Status},
    fmi3::{builder::FMU3Builder, types::fmi3Status},
    model_description::{fmi2, fmi3, validation::validate_structured_variable_name},
    zip::extract_zip_archive,
};
use tempfile::TempDir;

/// Two equal bodies on equal supports with a linear joint.
const MASS_KG: f64 = 2.35;
const SUPPORT: [f64; 2] = [1.056e6, 1.39];
const JOINT: [f64; 2] = [4.56e6, 0.54];

const A_Y: u32 = 1;
const B_Y: u32 = 5;
const A_F: u32 = 9;
const B_F: u32 = 11;

const OPENING_M: f64 = 1e-5;
const LOAD_N: f64 = 10.0;
const STEP_S: f64 = 1e-4;
const STEPS: u32 = 100;

/// An exported FMU in a folder of its own.
struct Exported {
    _folder: TempDir,
    fmu: PathBuf,
}

fn export(interface: &str, version: &str, dofs: u8) -> Exported {
    let program = env::var_os("BOLTED_JOINT").expect("BOLTED_JOINT names the executable");
    let folder = TempDir::new().unwrap();
    let joint = folder.path().join("test.joint.json");
    let fmu = folder.path().join("test.fmu");
    let [k, c] = JOINT;
    let [k_a, c_a] = SUPPORT;
    let text = if dofs == 1 {
        let body = format!(r#"{{"inertia":[{MASS_KG}],"stiffness":[{k_a}],"damping":[{c_a}]}}"#);
        format!(
            r#"{{"format":"bolted-joint/1","name":"test","joint":{{"dofs":["y"],"stiffness":[[{k}]],"damping":[[{c}]],
            "cubic":[0.0]}},"bodies":{{"a":{body},"b":{body}}}}}"#
        )
    } else {
        let body = r#"{"inertia":[0.5,2e-4],"stiffness":[2e5,50.0],"damping":[3.0,0.004]}"#;
        format!(
            r#"{{"format":"bolted-joint/1","name":"test","joint":{{"dofs":["y","theta"],
            "stiffness":[[5.73e5,5.82e3],[5.82e3,1.29e3]],"damping":[[10.83,-0.83],[-0.83,0.083]],
            "cubic":[5e11,4e5]}},"bodies":{{"a":{body},"b":{body}}}}}"#
        )
    };
    fs::write(&joint, text).unwrap();
    let done = Command::new(program)
        .arg("export")
        .arg(&joint)
        .arg("-o")
        .arg(&fmu)
        .args(["--as", interface, "--fmi", version])
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{errors}");
    Exported {
        _folder: folder,
        fmu,
    }
}

/// m x'' + c x' + k x = f from x(0) = `start`, x'(0) = 0, underdamped.
fn oscillator([k, c]: [f64; 2], f: f64, start: f64, t: f64) -> f64 {
    let decay = c / (2.0 * MASS_KG);
    let omega = (k / MASS_KG - decay * decay).sqrt();
    let rest = f / k;
    let amplitude = start - rest;
    let (sin, cos) = (omega * t).sin_cos();
    rest + amplitude * (-decay * t).exp() * (cos + decay / omega * sin)
}

/// Displacements of the bodies, which start apart and carry the same load: in phase and in antiphase they are
/// oscillators of their own.
fn expected(t: f64) -> [f64; 2] {
    let stiff = [SUPPORT[0] + 2.0 * JOINT[0], SUPPORT[1] + 2.0 * JOINT[1]];
    let together = oscillator(SUPPORT, LOAD_N, 0.0, t);
    let apart = oscillator(stiff, 0.0, OPENING_M, t);
    [together + apart, together - apart]
}

/// Largest difference to the closed form, against the opening.
fn error(t: f64, found: [f64; 2]) -> f64 {
    let expected = expected(t);
    (0..2)
        .map(|side| (found[side] - expected[side]).abs() / OPENING_M)
        .fold(0.0, f64::max)
}

#[test]
fn the_validator_finds_no_problem() {
    for interface in ["element", "lap"] {
        for dofs in [1, 2] {
            for version in ["2", "3"] {
                let exported = export(interface, version, dofs);
                let folder = TempDir::new().unwrap();
                extract_zip_archive(&exported.fmu, folder.path()).unwrap();
                let path = folder.path().join("modelDescription.xml");
                let (problems, names): (_, Vec<String>) = if version == "2" {
                    let description = fmi2::ModelDescription::from_path(&path).unwrap();
                    let names = description.modelVariables.iter().map(|v| v.name.clone());
                    (messages(description.validate()), names.collect())
                } else {
                    let description = fmi3::ModelDescription::from_path(&path).unwrap();
                    let names = description.modelVariables.iter().map(|v| v.name.clone());
                    (messages(description.validate()), names.collect())
                };
                assert_eq!(problems, [""; 0], "{interface} {dofs} FMI {version}");
                for name in names {
                    assert_eq!(validate_structured_variable_name(&name), Ok(()), "{name}");
                }
            }
        }
    }
}

fn messages(problems: Vec<fmi_rs::model_description::ValidationError>) -> Vec<String> {
    problems
        .into_iter()
        .map(|problem| problem.message)
        .collect()
}

#[test]
fn the_validator_would_find_an_output_that_is_listed_nowhere() {
    let exported = export("lap", "3", 1);
    let folder = TempDir::new().unwrap();
    extract_zip_archive(&exported.fmu, folder.path()).unwrap();
    let text = fs::read_to_string(folder.path().join("modelDescription.xml")).unwrap();
    let (head, tail) = text.split_once("<Output ").unwrap();
    let (_, tail) = tail.split_once("/>").unwrap();
    let damaged = fmi3::ModelDescription::from_string(&format!("{head}{tail}")).unwrap();
    assert!(!damaged.validate().is_empty());
}

#[test]
fn co_simulation_of_fmi_2_follows_the_closed_form() {
    let exported = export("lap", "2", 1);
    let fmu = FMU2Builder::new(&exported.fmu)
        .unwrap()
        .instantiate_cs("lap")
        .unwrap();
    let done = fmi2Status::Ok;
    assert_eq!(fmu.setupExperiment(None, 0.0, None), done);
    assert_eq!(fmu.enterInitializationMode(), done);
    assert_eq!(fmu.setReal(&[A_Y, B_Y], &[OPENING_M, -OPENING_M]), done);
    assert_eq!(fmu.setReal(&[A_F, B_F], &[LOAD_N; 2]), done);
    assert_eq!(fmu.exitInitializationMode(), done);
    for step in 0..STEPS {
        assert_eq!(fmu.doStep(f64::from(step) * STEP_S, STEP_S, 1), done);
        let mut found = [0.0; 2];
        assert_eq!(fmu.getReal(&[A_Y, B_Y], &mut found), done);
        let t = f64::from(step + 1) * STEP_S;
        assert!(error(t, found) < 5e-6, "{t} s: {found:?} {:?}", expected(t));
    }
    assert_eq!(fmu.terminate(), done);
}

#[test]
fn co_simulation_of_fmi_3_with_event_mode_follows_the_closed_form() {
    let exported = export("lap", "3", 1);
    let builder = FMU3Builder::new(&exported.fmu).unwrap();
    assert!(builder.eventModeUsed && builder.earlyReturnAllowed);
    let fmu = builder.instantiate_cs("lap").unwrap();
    let done = fmi3Status::Ok;
    assert_eq!(fmu.enterInitializationMode(None, 0.0, None), done);
    assert_eq!(fmu.setFloat64(&[A_Y, B_Y], &[OPENING_M, -OPENING_M]), done);
    assert_eq!(fmu.setFloat64(&[A_F, B_F], &[LOAD_N; 2]), done);
    assert_eq!(fmu.exitInitializationMode(), done);
    let (mut flags, mut next) = ([true; 4], Some(0.0));
    let [again, terminate, nominals, states] = &mut flags;
    let status = fmu.updateDiscreteStates(again, terminate, nominals, states, &mut next);
    assert_eq!(status, done);
    assert_eq!((flags, next), ([false; 4], None));
    assert_eq!(fmu.enterStepMode(), done);
    for step in 0..STEPS {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        let from = f64::from(step) * STEP_S;
        #[rustfmt::skip]
        let status = fmu.doStep(from, STEP_S, true, &mut event, &mut terminate, &mut early, &mut last);
        assert_eq!(status, done);
        assert_eq!([event, terminate, early], [false; 3]);
        let mut found = [0.0; 2];
        assert_eq!(fmu.getFloat64(&[A_Y, B_Y], &mut found), done);
        let t = f64::from(step + 1) * STEP_S;
        assert!((last - t).abs() < 1e-12);
        assert!(error(t, found) < 5e-6, "{t} s: {found:?} {:?}", expected(t));
    }
    assert_eq!(fmu.terminate(), done);
}

/// Classical Runge–Kutta steps over derivatives that the FMU gives.
fn integrate(
    mut y: [f64; 4],
    h: f64,
    steps: u32,
    rate: impl Fn(f64, &[f64; 4]) -> [f64; 4],
) -> [f64; 4] {
    let along = |y: &[f64; 4], k: &[f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    for step in 0..steps {
        let t = f64::from(step) * h;
        let k1 = rate(t, &y);
        let k2 = rate(t + h / 2.0, &along(&y, &k1, h / 2.0));
        let k3 = rate(t + h / 2.0, &along(&y, &k2, h / 2.0));
        let k4 = rate(t + h, &along(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    y
}

/// Small enough for an error of the integration far below the tolerance.
const INTEGRATION_STEP_S: f64 = 2e-6;
const INTEGRATION_STEPS: u32 = 5000;

#[test]
fn model_exchange_of_fmi_2_follows_the_closed_form() {
    let exported = export("lap", "2", 1);
    let fmu = FMU2Builder::new(&exported.fmu)
        .unwrap()
        .instantiate_me("lap")
        .unwrap();
    let done = fmi2Status::Ok;
    assert_eq!(fmu.setupExperiment(None, 0.0, None), done);
    assert_eq!(fmu.enterInitializationMode(), done);
    assert_eq!(fmu.setReal(&[A_Y, B_Y], &[OPENING_M, -OPENING_M]), done);
    assert_eq!(fmu.setReal(&[A_F, B_F], &[LOAD_N; 2]), done);
    assert_eq!(fmu.exitInitializationMode(), done);
    let (mut flags, mut next) = ([true; 4], Some(0.0));
    let [again, terminate, nominals, states] = &mut flags;
    let status = fmu.newDiscreteStates(again, terminate, nominals, states, &mut next);
    assert_eq!(status, done);
    assert_eq!(flags, [false; 4]);
    assert_eq!(fmu.enterContinuousTimeMode(), done);
    let mut y = [0.0; 4];
    assert_eq!(fmu.getContinuousStates(&mut y), done);
    let end = integrate(y, INTEGRATION_STEP_S, INTEGRATION_STEPS, |t, y| {
        let mut rates = [0.0; 4];
        assert_eq!(fmu.setTime(t), done);
        assert_eq!(fmu.setContinuousStates(y), done);
        assert_eq!(fmu.getDerivatives(&mut rates), done);
        rates
    });
    assert_eq!(fmu.setContinuousStates(&end), done);
    let mut found = [0.0; 2];
    assert_eq!(fmu.getReal(&[A_Y, B_Y], &mut found), done);
    let t = f64::from(INTEGRATION_STEPS) * INTEGRATION_STEP_S;
    assert!(error(t, found) < 1e-8, "{found:?} {:?}", expected(t));
}

#[test]
fn model_exchange_of_fmi_3_follows_the_closed_form() {
    let exported = export("lap", "3", 1);
    let fmu = FMU3Builder::new(&exported.fmu)
        .unwrap()
        .instantiate_me("lap")
        .unwrap();
    let done = fmi3Status::Ok;
    assert_eq!(fmu.enterInitializationMode(None, 0.0, None), done);
    assert_eq!(fmu.setFloat64(&[A_Y, B_Y], &[OPENING_M, -OPENING_M]), done);
    assert_eq!(fmu.setFloat64(&[A_F, B_F], &[LOAD_N; 2]), done);
    assert_eq!(fmu.exitInitializationMode(), done);
    assert_eq!(fmu.enterContinuousTimeMode(), done);
    let mut y = [0.0; 4];
    assert_eq!(fmu.getContinuousStates(&mut y), done);
    let end = integrate(y, INTEGRATION_STEP_S, INTEGRATION_STEPS, |t, y| {
        let mut rates = [0.0; 4];
        assert_eq!(fmu.setTime(t), done);
        assert_eq!(fmu.setContinuousStates(y), done);
        assert_eq!(fmu.getContinuousStateDerivatives(&mut rates), done);
        rates
    });
    assert_eq!(fmu.setContinuousStates(&end), done);
    let mut found = [0.0; 2];
    assert_eq!(fmu.getFloat64(&[A_Y, B_Y], &mut found), done);
    let t = f64::from(INTEGRATION_STEPS) * INTEGRATION_STEP_S;
    assert!(error(t, found) < 1e-8, "{found:?} {:?}", expected(t));
}
