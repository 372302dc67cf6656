//! Event Mode in Co-Simulation: what may be set where, and what it changes.

use crate::{
    c,
    importer::{Folder, Instance, Kind, Request, start_text, vr},
    raw::Raw,
};

/// Instance for Co-Simulation whose importer handles events, in state Instantiated.
fn handling_events(kind: Kind, changes: &[(&str, f64)]) -> Instance {
    let folder = Folder::with_start(&start_text(kind, 1, changes));
    let request = Request {
        event_mode: true,
        ..Request::of(&folder)
    };
    request.instantiate().unwrap()
}

#[test]
fn an_importer_that_does_not_handle_events_has_no_event_mode() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    for call in [Raw::enter_event, Raw::enter_step, Raw::update] {
        instance.refuses(call, "the instance was made with eventModeUsed = fmi3False");
    }
    // it tunes parameters between steps
    c::ok(instance.set(&[vr::K_YY], &[3e6]));
}

#[test]
fn parameters_are_tuned_at_events() {
    let mut instance = handling_events(Kind::Lap, &[]);
    instance.initialize(0.0, None);
    c::ok(instance.update());
    c::ok(instance.enter_step());
    instance.refuses(|i| i.set(&[vr::A_MASS], &[3.0]), "enter Event Mode first");
    c::ok(instance.enter_event());
    // checked when they take effect; until then they can be mended
    c::ok(instance.set(&[vr::A_MASS], &[-3.0]));
    let message = instance.refused(Raw::enter_step);
    c::tells(&message, "fmi3EnterStepMode: ", "parameter a.m is -3 kg");
    c::ok(instance.set(&[vr::A_MASS], &[3.0]));
    c::ok(instance.enter_step());
    c::ok(instance.enter_event());
    c::ok(instance.set(&[vr::B_C_Y], &[-0.5]));
    assert_eq!(instance.enter_step(), c::WARNING);
    assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
}

#[test]
fn events_change_nothing_by_themselves() {
    // the same loads and parameters, set at events or between steps: the same numbers to the last bit
    let run = |events: bool| {
        let instance = if events {
            handling_events(Kind::Lap, &[("joint.k3_y", 1e12)])
        } else {
            Instance::new(Kind::Lap, 1, &[("joint.k3_y", 1e12)])
        };
        instance.initialize(0.0, None);
        let mut found = Vec::new();
        for n in 0..50 {
            if events {
                if n > 0 {
                    c::ok(instance.enter_event());
                }
                c::ok(instance.update());
            }
            let load = 100.0 * f64::from(n).sin();
            let stiffness = 4e6 + 1e3 * f64::from(n);
            c::ok(instance.set(&[vr::A_F, vr::K_YY], &[load, stiffness]));
            if events {
                c::ok(instance.enter_step());
            }
            let t = 1e-3 * f64::from(n);
            c::ok(instance.step(t, 1e-3));
            found.push(
                instance
                    .get([vr::A_Y, vr::B_V, vr::JOINT_F])
                    .map(f64::to_bits),
            );
        }
        found
    };
    assert_eq!(run(true), run(false));
}
