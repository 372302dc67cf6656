//! Parameters: when they are checked and take effect, and the warning where they make the model active.

use crate::{
    c,
    equations::{EQUATIONS, Equations, STATES, assert_close},
    importer::{Instance, Kind, Make as _, vr},
    raw::{Fmi2, Fmi3, Interface::CoSimulation, Raw},
    rows::{number, reference, rows},
    stepping::lap,
};

#[test]
fn parameters_are_checked_when_they_take_effect() {
    // ω² = (8e5 + 8e6)/2, ω = 2098 rad/s: RK4 diverges beyond 2.83/ω = 1.35 ms
    const REFUSED: &str = "
        a.m           | 0      | parameter a.m is 0 kg, expected a number greater than zero
        a.m           | -2     | parameter a.m is -2 kg
        step_size_max | 0      | parameter step_size_max is 0 s
        step_size_max | -1e-5  | parameter step_size_max is -0.00001 s
        step_size_max | 1.4e-3 | step_size_max = 0.0014 s diverge
    ";
    for [name, value, expected] in rows(REFUSED) {
        let (reference, value) = (reference(name), number(value));
        for (version, prefix) in [(Fmi2, "fmi2"), (Fmi3, "fmi3")] {
            let mut instance = version.instance(CoSimulation, Kind::Lap, 1, &[]);
            c::ok(instance.set(&[reference], &[value]));
            c::ok(instance.enter_initialization(0.0, None));
            let message = instance.refused(Raw::exit_initialization);
            let function = format!("{prefix}ExitInitializationMode: ");
            c::tells(&message, &function, expected);

            let mut instance = version.stepping(Kind::Lap, 1, &[]);
            let [good] = instance.get([reference]);
            c::ok(instance.step(0.0, 1e-3));
            c::ok(instance.set(&[reference], &[value]));
            let message = instance.refused(|i| {
                let (status, last) = i.step_to(1e-3, 1e-3);
                assert_eq!(last, 1e-3);
                status
            });
            let function = format!("{prefix}DoStep: ");
            c::tells(&message, &function, expected);
            // with the parameter as it was, the simulation goes on as if nothing had been
            c::ok(instance.set(&[reference], &[good]));
            assert_eq!(instance.step_to(1e-3, 1e-3), (c::OK, 2e-3));
        }
    }
    let instance = Instance::new(Kind::Lap, 1, &[("step_size_max", 1.3e-3)]);
    instance.initialize(0.0, None);
}

#[test]
fn a_tuned_parameter_acts_from_the_next_step_on() {
    let instance = lap(2e-5);
    c::ok(instance.step(0.0, 1e-3));
    let reached = instance.get(STATES);
    c::ok(instance.set(&[vr::K_YY, vr::C_YY], &[2e6, 30.0]));
    c::ok(instance.step(1e-3, 1e-3));
    let tuned = Equations {
        k12: 2e6,
        c12: 30.0,
        ..EQUATIONS
    };
    assert_close(
        &instance.get(STATES),
        &tuned.runge_kutta(reached, 2e-5, 50),
        1e-11,
    );
}

#[test]
fn active_models_give_a_warning_and_work() {
    const ACTIVE: &str = "
        lap     | joint.c_yy | -1   | the joint's damping matrix is not positive semidefinite
        element | joint.k_yy | -1   | the joint's stiffness matrix is not positive semidefinite
        lap     | b.c_y      | -0.5 | a support has negative stiffness or damping
    ";
    for [model, name, value, expected] in rows(ACTIVE) {
        let kind = if model == "lap" {
            Kind::Lap
        } else {
            Kind::Element
        };
        let mut instance = Instance::new(kind, 1, &[(name, number(value))]);
        c::ok(instance.enter_initialization(0.0, None));
        assert_eq!(instance.exit_initialization(), c::WARNING);
        let log = instance.take_log();
        let warning = log
            .iter()
            .find(|message| message.status == c::WARNING)
            .unwrap();
        assert_eq!(warning.category, "logStatusWarning");
        assert!(warning.text.contains(expected), "{warning:?}");
        c::ok(instance.step(0.0, 1e-3));
    }
    // tuned later, the next step warns once
    let instance = Instance::stepping(Kind::Lap, 1, &[]);
    c::ok(instance.set(&[vr::B_C_Y], &[-0.5]));
    assert_eq!(instance.step_to(0.0, 1e-3), (c::WARNING, 1e-3));
    assert_eq!(instance.step_to(1e-3, 1e-3), (c::OK, 2e-3));
    // a step that is refused for another reason does not swallow the warning
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    c::ok(instance.set(&[vr::B_C_Y], &[-0.5]));
    instance.refused(|i| i.step(0.0, 1e5));
    assert_eq!(instance.step_to(0.0, 1e-3), (c::WARNING, 1e-3));
}
