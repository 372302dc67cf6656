//! The communication step and what can be asked after it.

use super::{c, importer::Instance};
use crate::importer::{Kind, vr};

fn last_successful_time(instance: &mut Instance) -> f64 {
    instance
        .status(c::fmi2GetRealStatus, c::LAST_SUCCESSFUL_TIME, f64::NAN)
        .unwrap()
}

fn has_terminated(instance: &mut Instance) -> bool {
    match instance
        .status(c::fmi2GetBooleanStatus, c::TERMINATED, 7)
        .unwrap()
    {
        0 => false,
        1 => true,
        other => panic!("{other}"),
    }
}

#[test]
fn communication_points_may_be_rounded() {
    // t0 + n·h as importers compute it, for steps that no binary fraction is equal to
    for h in [1e-3, 1e-4 / 3.0, 0.1] {
        let mut instance = Instance::stepping(Kind::Element, 1, &[]);
        assert_eq!(instance.reset(), c::OK);
        let (start, count) = (100.0, 1000);
        assert_eq!(
            instance.set_up(start, Some(start + f64::from(count) * h)),
            c::OK
        );
        assert_eq!(instance.enter_initialization(), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        for n in 0..count {
            assert_eq!(instance.step(start + f64::from(n) * h, h), c::OK, "{n}");
        }
        let end = start + f64::from(count) * h;
        assert!((last_successful_time(&mut instance) - end).abs() <= 4.0 * f64::EPSILON * end);
    }
}

#[test]
fn refused_steps_leave_the_instance_as_it_was() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    assert_eq!(instance.set(&[vr::A_F], &[100.0]), c::OK);
    assert_eq!(instance.step(0.0, 1e-3), c::OK);
    for (t, h, expected) in [
        (1e-3, 0.0, "communicationStepSize is 0"),
        (1e-3, -1.0, "communicationStepSize is -1"),
        (1e-3, f64::NAN, "communicationStepSize is NaN"),
        (1e-3, f64::INFINITY, "communicationStepSize is inf"),
        (1e-3, f64::MIN_POSITIVE, "is lost to rounding"),
        (
            2e-3,
            1e-3,
            "currentCommunicationPoint is 0.002 s, but the FMU is at t = 0.001 s",
        ),
        (f64::NAN, 1e-3, "currentCommunicationPoint is NaN"),
        (1e-3, 1e9, "takes more than 1000000000 Runge-Kutta steps"),
    ] {
        let message = instance.refused(|i| i.step(t, h));
        assert!(message.contains(expected), "{message}");
        assert_eq!(last_successful_time(&mut instance), 1e-3);
        assert!(!has_terminated(&mut instance));
    }
    assert_eq!(instance.set(&[vr::A_MASS], &[-1.0]), c::OK);
    let message = instance.refused(|i| i.step(1e-3, 1e-3));
    assert!(message.contains("parameter a.m is -1 kg"), "{message}");
    assert_eq!(instance.set(&[vr::A_MASS], &[2.0]), c::OK);
    assert_eq!(instance.step(1e-3, 1e-3), c::OK);
    assert_eq!(last_successful_time(&mut instance), 2e-3);
}

#[test]
fn a_failed_step_ends_the_simulation_and_a_restored_state_goes_on() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[("joint.k3_y", -1e12)]);
    assert_eq!(instance.set(&[vr::B_F], &[100.0]), c::OK);
    assert_eq!(instance.step(0.0, 1e-3), c::OK);
    let saved = instance.save();
    assert_eq!(instance.set(&[vr::B_F], &[1e8]), c::OK);
    instance.take_log();
    // nothing of the step was done: fmi2Error, not fmi2Discard (FMI 2.0, 4.2.2)
    assert_eq!(instance.step(1e-3, 1e-3), c::ERROR);
    assert!(
        instance
            .message(c::ERROR)
            .contains("where the softening joint no longer holds")
    );
    assert_eq!(last_successful_time(&mut instance), 1e-3);
    assert!(has_terminated(&mut instance));
    assert_eq!(instance.get([vr::TIME, vr::B_F]), [1e-3, 1e8]);
    // FMI 2.0, 2.1.6: no fmi2Terminate after an error
    let message = instance.refused(Instance::terminate);
    assert!(
        message.contains("in state Terminated, only in Step Mode"),
        "{message}"
    );
    // another input, as 4.2.2 proposes
    assert_eq!(instance.restore(saved), c::OK);
    assert!(!has_terminated(&mut instance));
    assert_eq!(instance.set(&[vr::B_F], &[50.0]), c::OK);
    assert_eq!(instance.step(1e-3, 1e-3), c::OK);
    assert_eq!(instance.terminate(), c::OK);
    assert!(has_terminated(&mut instance));
    instance.free_state(saved);
}

#[test]
fn outputs_of_an_element_follow_its_inputs_at_once() {
    let mut instance = Instance::stepping(Kind::Element, 1, &[]);
    assert_eq!(instance.set(&[vr::A_Y, vr::B_V], &[1e-4, 0.5]), c::OK);
    assert_eq!(
        instance.get([vr::B_F, vr::A_F]),
        [4e6 * 1e-4 - 8.0 * 0.5, 8.0 * 0.5 - 4e6 * 1e-4]
    );
}
