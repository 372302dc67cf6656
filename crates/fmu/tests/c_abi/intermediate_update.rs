//! Communication steps in which the importer takes part: what it is told, what it may do, and what its inputs do.

use std::{cell::RefCell, ptr, rc::Rc};

use bolted_joint_importer::header::fmi3::fmi3DoStep;

use crate::{
    c,
    equations::{EQUATIONS, Equations, START, STATES, assert_close},
    importer::{Folder, Instance, Kind, Request, Update, start_text, vr},
    raw::{Raw, call, status_of},
};

/// Instance in Step Mode at t = 0 whose importer takes part in steps with these variables.
pub(crate) fn taking_part(
    kind: Kind,
    changes: &[(&str, f64)],
    intermediate: &[u32],
    early_return: bool,
) -> Instance {
    let folder = Folder::with_start(&start_text(kind, 1, changes));
    let request = Request {
        early_return,
        updated: true,
        intermediate,
        ..Request::of(&folder)
    };
    let mut instance = request.instantiate().unwrap();
    c::ok(instance.enter_initialization(0.0, None));
    if kind == Kind::Lap {
        c::ok(instance.set(&STATES, &START));
        c::ok(instance.set(&[vr::A_F, vr::B_F], &EQUATIONS.force));
    }
    c::ok(instance.exit_initialization());
    instance.take_log();
    instance
}

const CHANGES: [(&str, f64); 2] = [("joint.k3_y", 5e12), ("step_size_max", 2e-4)];

pub(crate) fn lap(intermediate: &[u32], early_return: bool) -> Instance {
    taking_part(Kind::Lap, &CHANGES, intermediate, early_return)
}

#[test]
fn the_importer_sees_every_internal_step() {
    // registered, or, as the FMI project's own example does, without a word before
    for required in [&STATES[..], &[]] {
        let mut instance = lap(required, false);
        let seen = Rc::new(RefCell::new(Vec::<(Update, [f64; 4])>::new()));
        let log = Rc::clone(&seen);
        instance.on_update(move |i, update| {
            log.borrow_mut().push((update, i.get(STATES)));
            None
        });
        assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
        let seen = seen.take();
        assert_eq!(seen.len(), 5);
        for (n, (update, state)) in (1..).zip(&seen) {
            let time = if n == 5 { 1e-3 } else { 2e-4 * n as f64 };
            assert!((update.time - time).abs() < 1e-18);
            let expected = Update {
                time: update.time,
                set: false,
                get: true,
                finished: true,
                can_return_early: false,
            };
            assert_eq!(*update, expected);
            assert_close(state, &EQUATIONS.runge_kutta(START, 2e-4, n), 1e-12);
        }
        assert_eq!(seen[4].0.time, 1e-3);
        // the end is the same as without a callback, to the last bit
        let alone = Instance::new(Kind::Lap, 1, &CHANGES);
        c::ok(alone.set(&STATES, &START));
        c::ok(alone.set(&[vr::A_F, vr::B_F], &EQUATIONS.force));
        alone.initialize(0.0, None);
        c::ok(alone.step(0.0, 1e-3));
        assert_eq!(
            instance.get(STATES).map(f64::to_bits),
            alone.get(STATES).map(f64::to_bits)
        );
        assert_eq!(instance.state_bytes(), alone.state_bytes());
    }
}

#[test]
fn inputs_that_the_importer_knows_between_the_points_are_followed_with_fourth_order() {
    // both bodies under the same load, without damping: m ẍ + k x = F sin Ωt from rest,
    // x = F/(m (ω² − Ω²)) (sin Ωt − Ω/ω sin ωt); one communication step over all of it
    let (omega, forcing, duration): (f64, f64, f64) = (f64::sqrt(8e5 / 2.0), 900.0, 0.02);
    let load = move |t: f64| 1e3 * (forcing * t).sin();
    let amplitude = 1e3 / (2.0 * (omega * omega - forcing * forcing));
    let expected =
        amplitude * ((forcing * duration).sin() - forcing / omega * (omega * duration).sin());
    let error = |count: u32| {
        let changes = [
            ("a.c_y", 0.0),
            ("b.c_y", 0.0),
            ("step_size_max", duration / f64::from(count)),
        ];
        let mut instance = taking_part(Kind::Lap, &changes, &[vr::A_F, vr::B_F], false);
        c::ok(instance.reset());
        instance.initialize(0.0, None);
        let calls = Rc::new(RefCell::new(0));
        let counted = Rc::clone(&calls);
        instance.on_update(move |i, update| {
            assert!(update.set);
            *counted.borrow_mut() += 1;
            c::ok(i.set(&[vr::A_F, vr::B_F], &[load(update.time); 2]));
            None
        });
        assert_eq!(instance.step_to(0.0, duration), (c::OK, duration));
        // asked for the middle and the end of each internal step, and told of its end
        assert_eq!(*calls.borrow(), 3 * count);
        assert_eq!(instance.get([vr::A_F]), [load(duration)]);
        let [y] = instance.get([vr::A_Y]);
        (y - expected).abs() / amplitude.abs()
    };
    for count in [100, 200, 400] {
        let order = (error(count) / error(2 * count)).log2();
        assert!((3.9..4.1).contains(&order), "{count} steps: order {order}");
    }
    assert!(error(1600) < 1e-8, "{:e}", error(1600));
}

#[test]
fn inputs_that_are_set_after_an_internal_step_act_from_there_on() {
    let mut instance = lap(&[vr::A_F], false);
    instance.on_update(|i, update| {
        if update.finished {
            c::ok(i.set(&[vr::A_F], &[1e5 * update.time]));
        }
        None
    });
    assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
    let mut expected = START;
    for n in 0..5 {
        let load = if n == 0 {
            30.0
        } else {
            1e5 * 2e-4 * f64::from(n)
        };
        let equations = Equations {
            force: [load, -20.0],
            ..EQUATIONS
        };
        expected = equations.runge_kutta(expected, 2e-4, 1);
    }
    assert_close(&instance.get(STATES), &expected, 1e-12);
    assert_eq!(instance.get([vr::A_F, vr::B_F]), [1e5 * 1e-3, -20.0]);
}

#[test]
fn derivatives_of_outputs_know_how_the_inputs_go() {
    // F_a = 3 + 2000 t + 10⁶ t²; the energy does not see it, the acceleration is no output, so look at an element:
    // F_b = k (y_a − y_b) + c (v_a − v_b), with v_a a polynomial in time and v_b held
    let mut instance = taking_part(Kind::Element, &[], &[vr::A_V, vr::B_F, vr::JOINT_F], false);
    let velocity = |t: f64| 3.0 + 2e3 * t + 1e6 * t * t;
    c::ok(instance.set(&[vr::A_V], &[velocity(0.0)]));
    let seen = Rc::new(RefCell::new(Vec::new()));
    let log = Rc::clone(&seen);
    instance.on_update(move |i, update| {
        if update.finished {
            let rates = i.output_derivatives(&[vr::B_F, vr::JOINT_F]).unwrap();
            log.borrow_mut()
                .push((update.time, i.get([vr::A_V]), rates));
        } else {
            c::ok(i.set(&[vr::A_V], &[velocity(update.time)]));
        }
        None
    });
    for n in 0..3 {
        c::ok(instance.step(1e-3 * f64::from(n), 1e-3));
    }
    let seen = seen.take();
    assert_eq!(seen.len(), 3);
    for (t, [v], rates) in seen {
        assert_eq!(v, velocity(t));
        // Ḟ = k v + c v̇, v̇ = 2000 + 2·10⁶ t
        let expected = 4e6 * v + 8.0 * (2e3 + 2e6 * t);
        assert_close(&rates, &[expected; 2], 1e-12);
    }
    // also at the communication point; an input that jumps there forgets how it went before
    let last = velocity(3e-3);
    let rates = instance.output_derivatives(&[vr::B_F]).unwrap();
    assert_close(&rates, &[4e6 * last + 8.0 * (2e3 + 2e6 * 3e-3)], 1e-12);
    c::ok(instance.set(&[vr::A_V], &[1.0]));
    let rates = instance.output_derivatives(&[vr::B_F]).unwrap();
    assert_eq!(rates, [4e6]);
}

#[test]
fn an_element_is_asked_once() {
    let mut instance = taking_part(Kind::Element, &[], &[vr::A_Y, vr::A_F], true);
    let seen = Rc::new(RefCell::new(Vec::new()));
    let log = Rc::clone(&seen);
    instance.on_update(move |i, update| {
        if update.finished {
            assert_eq!(i.get([vr::A_F]), [-4e6 * 1e-3]);
        } else {
            c::ok(i.set(&[vr::A_Y], &[update.time]));
        }
        log.borrow_mut().push((update.time, update.set, update.get));
        None
    });
    assert_eq!(instance.step_to(0.0, 1e-3), (c::OK, 1e-3));
    assert_eq!(
        *seen.borrow(),
        [(5e-4, true, false), (1e-3, true, false), (1e-3, true, true)]
    );
}

fn step_within(i: Raw) -> i32 {
    let (mut flag, mut time) = (0, 0.0);
    let (flag, time) = (&raw mut flag, &raw mut time);
    call!(@one i, fmi3DoStep(0.0, 1e-3, 1, flag, flag, flag, time))
}

fn free_within(i: Raw) -> i32 {
    // it must go on living
    i.free();
    c::ERROR
}

#[test]
fn only_what_the_standard_allows_reaches_the_instance() {
    type Call = fn(Raw) -> i32;
    const INSIDE: &str = "is not allowed in state Intermediate Update Mode";
    macro_rules! table {
        ($($function:ident: $call:expr, $expected:expr;)*) => {
            [$((stringify!($function), $call, $expected)),*]
        };
    }
    let refused: [(&str, Call, &str); 16] = table! {
        fmi3DoStep: step_within, INSIDE;
        fmi3Reset: Raw::reset, INSIDE;
        fmi3Terminate: Raw::terminate, INSIDE;
        fmi3EnterInitializationMode: |i| i.enter_initialization(0.0, None), INSIDE;
        fmi3ExitInitializationMode: Raw::exit_initialization, INSIDE;
        fmi3GetFMUState: |i| i.save_in(&mut ptr::null_mut()), INSIDE;
        fmi3SetFMUState: |i| i.restore(ptr::null_mut()), INSIDE;
        fmi3EnterEventMode: Raw::enter_event, INSIDE;
        fmi3GetDirectionalDerivative: |i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[1.0])), INSIDE;
        fmi3GetAdjointDerivative: |i| status_of(i.adjoint(&[vr::JOINT_F], &[vr::A_Y], &[1.0])), INSIDE;
        fmi3FreeInstance: free_within, INSIDE;
        fmi3SetFloat64: |i| i.set(&[vr::K_YY], &[1e6]),
            "variable joint.k_yy is a parameter and cannot be set in state Intermediate Update Mode";
        fmi3SetFloat64: |i| i.set(&[vr::A_F, vr::JOINT_F], &[1.0; 2]),
            "variable joint.F is a calculated output and cannot be set in state Intermediate Update Mode";
        fmi3SetFloat64: |i| i.set(&[vr::B_F], &[1.0]),
            "variable b.F cannot be accessed within a communication step: it is not among the requiredIntermediateVariables";
        fmi3GetFloat64: |i| status_of(i.try_get(&[vr::A_F, vr::ENERGY])),
            "variable energy.stored cannot be accessed within a communication step";
        fmi3GetOutputDerivatives: |i| status_of(i.output_derivatives(&[vr::A_Y])),
            "variable a.y cannot be accessed within a communication step";
    };
    for (function, call, expected) in refused {
        let required = [vr::A_F, vr::JOINT_F];
        let (mut careless, careful) = (lap(&required, true), lap(&required, true));
        let messages = Rc::new(RefCell::new(Vec::new()));
        let log = Rc::clone(&messages);
        careless.on_update(move |i, update| {
            // what is allowed at one time is not at another
            let allowed = if update.finished {
                assert_eq!(i.get([vr::A_F]), [30.0]);
                c::ok(status_of(i.output_derivatives(&[vr::JOINT_F])));
                i.set(&[vr::A_F], &[30.0])
            } else {
                assert_eq!(status_of(i.try_get(&[vr::JOINT_F])), c::ERROR);
                let message = i.error();
                c::tells(&message, "", "variable joint.F cannot be read now");
                i.set(&[vr::A_F], &[30.0])
            };
            c::ok(allowed);
            c::ok(i.switch_logging(true, &[]));
            if update.finished {
                assert_eq!(call(i.raw), c::ERROR, "{function}");
                log.borrow_mut().push(i.error());
            }
            None
        });
        assert_eq!(careless.step_to(0.0, 1e-3), (c::OK, 1e-3));
        assert_eq!(careful.step_to(0.0, 1e-3), (c::OK, 1e-3));
        let messages = messages.take();
        assert_eq!(messages.len(), 5);
        for message in &messages {
            assert!(message.starts_with(&format!("{function}: ")), "{message}");
            assert!(message.contains(expected), "{message}");
        }
        // and nothing of it has left a trace
        assert_eq!(careless.state_bytes(), careful.state_bytes());
    }
}
