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
        resources: folder.0.to_str(),
        event_mode: true,
        ..Request::default()
    };
    request.instantiate().unwrap()
}

#[test]
fn an_importer_that_does_not_handle_events_has_no_event_mode() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    for call in [Raw::enter_event, Raw::enter_step, Raw::update] {
        let message = instance.refused(call);
        assert!(
            message.contains("the instance was made with eventModeUsed = fmi3False"),
            "{message}"
        );
    }
    // it tunes parameters between steps
    assert_eq!(instance.set(&[vr::K_YY], &[3e6]), c::OK);
}

#[test]
fn parameters_are_tuned_at_events() {
    let mut instance = handling_events(Kind::Lap, &[]);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.update(), c::OK);
    assert_eq!(instance.enter_step(), c::OK);
    let message = instance.refused(|i| i.set(&[vr::A_MASS], &[3.0]));
    assert!(message.contains("enter Event Mode first"), "{message}");
    assert_eq!(instance.enter_event(), c::OK);
    // checked when they take effect; until then they can be mended
    assert_eq!(instance.set(&[vr::A_MASS], &[-3.0]), c::OK);
    let message = instance.refused(Raw::enter_step);
    assert!(
        message.starts_with("fmi3EnterStepMode: ") && message.contains("parameter a.m is -3 kg"),
        "{message}"
    );
    assert_eq!(instance.set(&[vr::A_MASS], &[3.0]), c::OK);
    assert_eq!(instance.enter_step(), c::OK);
    assert_eq!(instance.enter_event(), c::OK);
    assert_eq!(instance.set(&[vr::B_C_Y], &[-0.5]), c::OK);
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
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        let mut found = Vec::new();
        for n in 0..50 {
            if events {
                if n > 0 {
                    assert_eq!(instance.enter_event(), c::OK);
                }
                assert_eq!(instance.update(), c::OK);
            }
            let load = 100.0 * f64::from(n).sin();
            let stiffness = 4e6 + 1e3 * f64::from(n);
            assert_eq!(
                instance.set(&[vr::A_F, vr::K_YY], &[load, stiffness]),
                c::OK
            );
            if events {
                assert_eq!(instance.enter_step(), c::OK);
            }
            let t = 1e-3 * f64::from(n);
            assert_eq!(instance.step(t, 1e-3), c::OK);
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
