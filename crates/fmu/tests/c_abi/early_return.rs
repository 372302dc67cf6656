//! Communication steps that the importer ends early, and steps that fail within.

use std::{cell::RefCell, rc::Rc};

use crate::{
    c,
    equations::{EQUATIONS, START, STATES, assert_close},
    importer::{Kind, vr},
    intermediate_update::{lap, taking_part},
    raw::Stepped,
    rows::{number, rows},
};

#[test]
fn an_early_return_ends_exactly_where_it_was_asked_for() {
    // asked for after the second internal step, or while inputs are asked for, and for a time within a later step
    for (required, asked_after, at) in [
        (&[vr::A_Y][..], 4e-4, 7.3e-4),
        (&[vr::A_Y], 4e-4, 4e-4),
        (&[vr::A_Y], 4e-4, 4.000_001e-4),
        (&[vr::A_F], 3e-4, 3e-4),
        (&[vr::A_F], 3e-4, 9.9e-4),
    ] {
        let mut instance = lap(required, true);
        let told = Rc::new(RefCell::new(Vec::new()));
        let log = Rc::clone(&told);
        instance.on_update(move |_, update| {
            assert!(update.can_return_early);
            log.borrow_mut().push(update.time);
            (update.time >= asked_after - 1e-12).then_some(at)
        });
        let expected = Stepped {
            status: c::OK,
            early: true,
            last: at,
        };
        assert_eq!(instance.do_step(0.0, 1e-3), expected);
        let told = told.take();
        assert_eq!(told.last(), Some(&at));
        assert_eq!(instance.get([vr::TIME]), [at]);
        let whole = (at / 2e-4).floor() as usize;
        let reached = EQUATIONS.runge_kutta(START, 2e-4, whole);
        let rest = at - 2e-4 * whole as f64;
        let reached = EQUATIONS.runge_kutta(reached, rest, 1);
        assert_close(&instance.get(STATES), &reached, 1e-11);
        // the simulation goes on from there
        instance.on_update(|_, _| None);
        assert_eq!(instance.step_to(at, 1e-3), (c::OK, at + 1e-3));
        let end = EQUATIONS.runge_kutta(reached, 2e-4, 5);
        assert_close(&instance.get(STATES), &end, 1e-11);
    }
    // at the end it is not early; and what has passed cannot be brought back
    let mut instance = lap(&[], true);
    instance.on_update(|_, update| (update.time > 9e-4).then_some(update.time));
    assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
    instance.on_update(|_, _| Some(1e-3));
    let stepped = instance.do_step(1e-3, 1e-3);
    assert!(
        stepped.early && (stepped.last - 1.2e-3).abs() < 1e-18,
        "{stepped:?}"
    );
}

#[test]
fn an_early_return_that_cannot_be_is_refused_and_nothing_moves() {
    const REFUSED: &str = "
        false | 4e-4  | earlyReturnRequested was set by the callback though canReturnEarly was fmi3False
        true  | 2e-3  | earlyReturnTime is 0.002 s, expected a time within the step from 0 s to 0.001 s
        true  | -1e-3 | earlyReturnTime is -0.001 s
        true  | NaN   | earlyReturnTime is NaN s
        true  | inf   | earlyReturnTime is inf s
    ";
    for [allowed, at, expected] in rows(REFUSED) {
        let (allowed, at) = (allowed == "true", number(at));
        let mut instance = lap(&[vr::A_F], allowed);
        instance.on_update(move |i, update| {
            assert_eq!(update.can_return_early, allowed);
            c::ok(i.set(&[vr::A_F], &[77.0]));
            (update.time > 3e-4).then_some(at)
        });
        let message = instance.refused(|i| {
            let stepped = i.do_step(0.0, 1e-3);
            assert_eq!((stepped.early, stepped.last), (false, 0.0));
            stepped.status
        });
        c::tells(&message, "fmi3DoStep: ", expected);
        instance.on_update(|_, _| None);
        assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
        let expected = EQUATIONS.runge_kutta(START, 2e-4, 5);
        assert_close(&instance.get(STATES), &expected, 1e-12);
    }
}

#[test]
fn a_step_that_fails_goes_back_to_its_beginning_with_its_inputs() {
    let mut instance = taking_part(Kind::Lap, &[("joint.k3_y", -1e12)], &[vr::B_F], false);
    let all = [
        vr::TIME,
        vr::A_Y,
        vr::B_Y,
        vr::A_V,
        vr::B_V,
        vr::A_F,
        vr::B_F,
    ];
    let before = instance.get(all);
    let last = Rc::new(RefCell::new(0.0));
    let seen = Rc::clone(&last);
    instance.on_update(move |i, update| {
        *seen.borrow_mut() = update.time;
        c::ok(i.set(&[vr::B_F], &[1e9 * update.time]));
        None
    });
    assert_eq!(instance.step_to(0.0, 1e-2), (c::ERROR, 0.0));
    let message = instance.error();
    assert!(message.contains("softening joint"), "{message}");
    // found at the very internal step, long before the communication step's end
    let last = *last.borrow();
    assert!(last < 5e-3, "{last}");
    assert_eq!(instance.get(all), before);
    assert_eq!(instance.step(0.0, 1e-3), c::ERROR);
    assert!(instance.error().contains("in state Terminated"));
}

#[test]
fn refused_steps_do_not_call_back() {
    let mut instance = lap(&[], true);
    instance.on_update(|_, _| panic!("called back"));
    for (t, h) in [(0.0, 0.0), (0.0, f64::NAN), (1.0, 1e-3), (0.0, 1e9)] {
        instance.refused(|i| i.do_step(t, h).status);
    }
    c::ok(instance.set(&[vr::A_MASS], &[-1.0]));
    instance.refused(|i| i.do_step(0.0, 1e-3).status);
}
