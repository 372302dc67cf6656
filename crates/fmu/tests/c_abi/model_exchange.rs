//! Model Exchange: states and derivatives, the state machine, saved states, what is refused.

use std::ptr::null_mut;

use crate::{
    c,
    importer::{Instance, Kind, vr},
};

#[test]
fn derivatives_are_those_of_the_equations_of_motion() {
    // m = 2, k = 8e5, c = 1 of both bodies; k12 = 4e6, c12 = 8, k3 = 5e12
    let mut instance = Instance::continuous(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
    let [ya, va, yb, vb]: [f64; 4] = [3e-4, 0.2, 1e-4, -0.1];
    assert_eq!(instance.set(&[vr::A_F, vr::B_F], &[30.0, -20.0]), c::OK);
    assert_eq!(instance.set_states(&[ya, va, yb, vb]), c::OK);
    assert_eq!(instance.states(4), [ya, va, yb, vb]);
    let joint = 4e6 * (ya - yb) + 8.0 * (va - vb) + 5e12 * (ya - yb).powi(3);
    let of_a = (30.0 - 8e5 * ya - va - joint) / 2.0;
    let of_b = (-20.0 - 8e5 * yb - vb + joint) / 2.0;
    let found = instance.derivatives(4);
    for (found, expected) in found.iter().zip([va, of_a, vb, of_b]) {
        assert!(
            (found - expected).abs() <= 1e-13 * expected.abs(),
            "{found} {expected}"
        );
    }
    assert_eq!(
        instance.get([vr::A_ACCELERATION, vr::B_ACCELERATION]),
        [found[1], found[3]]
    );
    assert_eq!(
        instance
            .read(c::fmi3GetNominalsOfContinuousStates, 4)
            .unwrap(),
        [1e-4, 0.1, 1e-4, 0.1]
    );
    // with rotation: accelerations stand where the model structure has them
    let mut instance = Instance::continuous(Kind::Lap, 2, &[]);
    assert_eq!(
        instance.set_states(&[1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0]),
        c::OK
    );
    let accelerations = [
        vr::A_ACCELERATION,
        vr::A_ALPHA,
        vr::B_ACCELERATION,
        vr::B_ALPHA,
    ];
    let [a, alpha_a, b, alpha_b] = instance.get(accelerations);
    assert_eq!(
        instance.derivatives(8),
        [0.1, 1.0, a, alpha_a, 0.2, 2.0, b, alpha_b]
    );
    assert!([a, alpha_a, b, alpha_b].iter().all(|&value| value != 0.0));
}

#[test]
fn derivatives_have_directional_derivatives() {
    // J of the linear lap: dv/dy, dv/dv and so on, by hand
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    let accelerations = [vr::A_ACCELERATION, vr::B_ACCELERATION];
    assert_eq!(instance.set_states(&[1e-4, 0.1, -2e-4, 0.3]), c::OK);
    assert_eq!(instance.set(&[vr::A_F], &[30.0]), c::OK);
    let [of_a, _] = instance.get(accelerations);
    for (known, expected) in [
        (vr::A_Y, [-4.8e6 / 2.0, 4e6 / 2.0]),
        (vr::B_Y, [4e6 / 2.0, -4.8e6 / 2.0]),
        (vr::A_V, [-9.0 / 2.0, 8.0 / 2.0]),
        (vr::B_V, [8.0 / 2.0, -9.0 / 2.0]),
        (vr::A_F, [0.5, 0.0]),
        (vr::K_YY, [-3e-4 / 2.0, 3e-4 / 2.0]),
        (vr::A_MASS, [-of_a / 2.0, 0.0]),
    ] {
        let found = instance
            .directional(&accelerations, &[known], &[1.0])
            .unwrap();
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-14 * expected.abs(),
                "{known}: {found} {expected}"
            );
        }
    }
    // the derivative of a displacement is the velocity, a state
    assert_eq!(
        instance.directional(&[vr::A_V], &[vr::A_V, vr::A_Y], &[1.0, 5.0]),
        Ok(vec![1.0])
    );
}

#[test]
fn calls_are_allowed_in_the_states_of_the_standard_only() {
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum State {
        Instantiated,
        Initialization,
        Event,
        Continuous,
        Terminated,
    }
    use State::{Continuous, Event, Initialization, Instantiated, Terminated};
    const ALL: [State; 5] = [Instantiated, Initialization, Event, Continuous, Terminated];
    let instance_in = |state: State| {
        let mut instance = Instance::exchanging(Kind::Lap, 1, &[]);
        if state != Instantiated {
            assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        }
        if matches!(state, Event | Continuous | Terminated) {
            assert_eq!(instance.exit_initialization(), c::OK);
        }
        if state == Continuous {
            assert_eq!(instance.enter_continuous(), c::OK);
        }
        if state == Terminated {
            assert_eq!(instance.terminate(), c::OK);
        }
        instance.take_log();
        instance
    };
    type Call = fn(&mut Instance) -> i32;
    let calls: [(&str, Call, &[State]); 14] = [
        (
            "fmi3EnterInitializationMode",
            |i| i.enter_initialization(0.0, None),
            &[Instantiated],
        ),
        (
            "fmi3ExitInitializationMode",
            Instance::exit_initialization,
            &[Initialization],
        ),
        ("fmi3UpdateDiscreteStates", Instance::update, &[Event]),
        (
            "fmi3EnterContinuousTimeMode",
            Instance::enter_continuous,
            &[Event],
        ),
        ("fmi3EnterEventMode", Instance::enter_event, &[Continuous]),
        (
            "fmi3CompletedIntegratorStep",
            Instance::complete_step,
            &[Continuous],
        ),
        ("fmi3SetTime", |i| i.set_time(0.5), &[Continuous]),
        (
            "fmi3SetContinuousStates",
            |i| i.set_states(&[0.0; 4]),
            &[Continuous],
        ),
        (
            "fmi3GetContinuousStateDerivatives",
            |i| {
                i.read(c::fmi3GetContinuousStateDerivatives, 4)
                    .err()
                    .unwrap_or(c::OK)
            },
            &[Initialization, Event, Continuous, Terminated],
        ),
        (
            "fmi3GetContinuousStates",
            |i| i.read(c::fmi3GetContinuousStates, 4).err().unwrap_or(c::OK),
            &[Initialization, Event, Continuous, Terminated],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_F], &[1.0]),
            &[Instantiated, Initialization, Event, Continuous],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::K_YY], &[3e6]),
            &[Instantiated, Initialization, Event],
        ),
        (
            "fmi3SetFloat64",
            |i| i.set(&[vr::A_Y], &[1e-5]),
            &[Instantiated, Initialization, Event, Continuous],
        ),
        ("fmi3Terminate", Instance::terminate, &[Event, Continuous]),
    ];
    for (function, call, allowed) in calls {
        for state in ALL {
            let mut instance = instance_in(state);
            if allowed.contains(&state) {
                assert_eq!(call(&mut instance), c::OK, "{function} in {state:?}");
            } else {
                let message = instance.refused(call);
                let name = match state {
                    Instantiated => "Instantiated",
                    Initialization => "Initialization Mode",
                    Event => "Event Mode",
                    Continuous => "Continuous-Time Mode",
                    Terminated => "Terminated",
                };
                assert!(message.starts_with(&format!("{function}: ")), "{message}");
                assert!(message.contains(&format!("in state {name}")), "{message}");
            }
        }
    }
}

#[test]
fn each_interface_type_has_its_own_functions() {
    let mut exchanging = Instance::continuous(Kind::Lap, 1, &[]);
    let message = exchanging.refused(|i| {
        let (mut flag, mut time) = (false, 0.0);
        let flag = &raw mut flag;
        // SAFETY: the instance lives, all pointers are to locals
        unsafe { c::fmi3DoStep(i.handle, 0.0, 1e-3, true, flag, flag, flag, &raw mut time) }
    });
    assert!(
        message.contains("it belongs to Co-Simulation, the instance is for Model Exchange"),
        "{message}"
    );
    let mut stepping = Instance::stepping(Kind::Lap, 1, &[]);
    let message = exchanging.refused(|i| {
        let rates = i.output_derivatives(&[vr::JOINT_F]);
        rates.err().unwrap_or(c::OK)
    });
    assert!(
        message.contains("it belongs to Co-Simulation, the instance is for Model Exchange"),
        "{message}"
    );
    for call in [Instance::enter_continuous, Instance::complete_step] {
        let message = stepping.refused(call);
        assert!(
            message.contains("it belongs to Model Exchange, the instance is for Co-Simulation"),
            "{message}"
        );
    }
    // neither takes the other's states
    let (of_exchanging, of_stepping) = (exchanging.save(), stepping.save());
    let message = exchanging.refused(|i| i.restore(of_stepping));
    assert!(
        message.contains("is that of \"lap with 1 DOF a side for Co-Simulation"),
        "{message}"
    );
    let bytes = exchanging.serialize(of_exchanging);
    let message = stepping.refused(|i| i.deserialize(&bytes).err().unwrap_or(c::OK));
    assert!(
        message.contains("is that of \"lap with 1 DOF a side for Model Exchange"),
        "{message}"
    );
    exchanging.free_state(of_exchanging);
    stepping.free_state(of_stepping);
}

#[test]
fn states_are_saved_and_restored() {
    let mut instance = Instance::continuous(Kind::Lap, 2, &[("joint.k3_y", 1e12)]);
    let states = [1e-4, 1e-3, 0.1, 1.0, 2e-4, 2e-3, 0.2, 2.0];
    assert_eq!(instance.set_time(0.25), c::OK);
    assert_eq!(instance.set_states(&states), c::OK);
    assert_eq!(instance.set(&[vr::B_M], &[3.0]), c::OK);
    let expected = instance.derivatives(8);
    let bytes = instance.state_bytes();
    let mut other = Instance::exchanging(Kind::Lap, 2, &[]);
    let state = other.deserialize(&bytes).unwrap();
    assert_eq!(other.restore(state), c::OK);
    assert_eq!(other.get([vr::TIME, vr::B_M]), [0.25, 3.0]);
    assert_eq!(
        (other.states(8), other.derivatives(8)),
        (states.to_vec(), expected)
    );
    // in the same mode, ready to go on
    assert_eq!(other.complete_step(), c::OK);
    assert_eq!(other.set_states(&[0.0; 8]), c::OK);
    other.free_state(state);
}

#[test]
fn a_parameter_takes_effect_when_continuous_time_goes_on() {
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    assert_eq!(instance.enter_event(), c::OK);
    assert_eq!(instance.set(&[vr::A_MASS], &[-1.0]), c::OK);
    let message = instance.refused(Instance::enter_continuous);
    assert!(message.contains("parameter a.m is -1 kg"), "{message}");
    assert_eq!(instance.set(&[vr::A_MASS, vr::B_C_Y], &[4.0, -1.0]), c::OK);
    assert_eq!(instance.enter_continuous(), c::WARNING);
    assert_eq!(instance.set(&[vr::A_F], &[8.0]), c::OK);
    assert_eq!(instance.derivatives(4), [0.0, 2.0, 0.0, 0.0]);
    // the longest Runge–Kutta step is none of the importer's business
    let mut instance = Instance::continuous(Kind::Lap, 1, &[("step_size_max", 1.0)]);
    assert_eq!(instance.complete_step(), c::OK);
}

#[test]
fn a_softening_joint_that_gives_way_ends_the_simulation() {
    // escape at √((k + 2 k12)/(−2 k3)) = 2.0976 mm
    let mut instance = Instance::continuous(Kind::Lap, 1, &[("joint.k3_y", -1e12)]);
    assert_eq!(instance.set_states(&[2.0e-3, 0.0, 0.0, 0.0]), c::OK);
    // past 80 % of it
    assert_eq!(instance.complete_step(), c::WARNING);
    assert_eq!(instance.complete_step(), c::OK);
    // a solver may try such states, but not accept them
    assert_eq!(instance.set_time(0.125), c::OK);
    assert_eq!(instance.set_states(&[2.2e-3, 0.0, 0.0, 0.0]), c::OK);
    assert!(
        instance
            .derivatives(4)
            .iter()
            .all(|value| value.is_finite())
    );
    assert_eq!(instance.complete_step(), c::ERROR);
    let message = instance.error();
    assert!(
        message.starts_with("fmi3CompletedIntegratorStep: a.y - b.y = ")
            && message.contains("t = 0.125 s"),
        "{message}"
    );
    assert_eq!(instance.complete_step(), c::ERROR);
    assert!(instance.error().contains("in state Terminated"));
}

#[test]
fn wrong_arguments_are_refused() {
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    for states in [&[0.0; 3][..], &[0.0; 5]] {
        let message = instance.refused(|i| i.set_states(states));
        let expected = format!("argument nContinuousStates is {}, expected 4", states.len());
        assert!(message.contains(&expected), "{message}");
    }
    let message = instance.refused(|i| i.set_states(&[0.0, f64::NAN, 0.0, 0.0]));
    assert!(
        message.contains("variable a.v cannot be set to NaN"),
        "{message}"
    );
    let message = instance.refused(|i| i.set_time(f64::INFINITY));
    assert!(message.contains("time is inf"), "{message}");
    for function in [
        c::fmi3GetContinuousStates as unsafe extern "C" fn(_, _, _) -> _,
        c::fmi3GetContinuousStateDerivatives,
        c::fmi3GetNominalsOfContinuousStates,
    ] {
        let message = instance.refused(|i| i.read(function, 8).err().unwrap_or(c::OK));
        assert!(message.contains("is 8, expected 4"), "{message}");
        // SAFETY: a null pointer is refused
        let message = instance.refused(|i| unsafe { function(i.handle, null_mut(), 4) });
        assert!(message.contains("is a null pointer"), "{message}");
    }
    let message = instance.refused(|i| i.read(c::fmi3GetEventIndicators, 1).err().unwrap_or(c::OK));
    assert!(
        message.contains("there are no event indicators"),
        "{message}"
    );
    // SAFETY: null pointers are refused
    let message =
        instance.refused(|i| unsafe { c::fmi3GetNumberOfContinuousStates(i.handle, null_mut()) });
    assert!(
        message.contains("argument nContinuousStates is a null pointer"),
        "{message}"
    );
}

#[test]
fn an_element_has_no_states() {
    for (kind, dofs, expected) in [(Kind::Element, 2, 0), (Kind::Lap, 1, 4), (Kind::Lap, 2, 8)] {
        let mut instance = Instance::continuous(kind, dofs, &[]);
        let (mut states, mut indicators) = (99, 99);
        // SAFETY: the instance lives, all pointers are to locals
        unsafe {
            assert_eq!(
                c::fmi3GetNumberOfContinuousStates(instance.handle, &raw mut states),
                c::OK
            );
            assert_eq!(
                c::fmi3GetNumberOfEventIndicators(instance.handle, &raw mut indicators),
                c::OK
            );
        }
        assert_eq!((states, indicators), (expected, 0));
        assert_eq!(instance.read(c::fmi3GetEventIndicators, 0), Ok(vec![]));
    }
    let mut element = Instance::continuous(Kind::Element, 1, &[]);
    assert_eq!(element.set(&[vr::A_Y], &[1e-4]), c::OK);
    assert_eq!(element.get([vr::B_F]), [400.0]);
    assert_eq!(
        (element.set_states(&[]), element.complete_step()),
        (c::OK, c::OK)
    );
}
