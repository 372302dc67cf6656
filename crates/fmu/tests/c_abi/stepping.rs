//! Communication steps: what they compute, how they end, and what they refuse.

use crate::{
    c,
    equations::Equations,
    importer::{Instance, Kind, vr},
};

const EQUATIONS: Equations = Equations {
    m: 2.0,
    k: 8e5,
    c: 1.0,
    k12: 4e6,
    c12: 8.0,
    k3: 5e12,
    force: [30.0, -20.0],
};
const START: [f64; 4] = [1e-4, 0.1, -2e-4, 0.0];
const STATES: [u32; 4] = [vr::A_Y, vr::A_V, vr::B_Y, vr::B_V];

fn lap(step_size_max: f64) -> Instance {
    let mut instance = Instance::new(
        Kind::Lap,
        1,
        &[("joint.k3_y", 5e12), ("step_size_max", step_size_max)],
    );
    assert_eq!(instance.set(&STATES, &START), c::OK);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.set(&[vr::A_F, vr::B_F], &EQUATIONS.force), c::OK);
    instance
}

fn assert_close(found: [f64; 4], expected: [f64; 4], tolerance: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= tolerance * expected.abs(),
            "{found} {expected}"
        );
    }
}

#[test]
fn a_step_is_the_right_number_of_runge_kutta_steps() {
    // steps so long that one more or less shows: ω h ≈ 0.4
    for (interval, step_size_max, count) in [
        (1e-2, 2e-4, 50),
        (0.1 * (0.1 + 0.2) - 0.02, 2e-4, 50), // 0.010000000000000002 s
        (1.0e-2 + 1e-8, 2e-4, 51),
        (1e-4, 2e-4, 1),
        (2e-4, 2e-4, 1),
        (3e-4, 2e-4, 2),
    ] {
        let mut instance = lap(step_size_max);
        assert_eq!(instance.step(0.0, interval), (c::OK, interval));
        let expected = EQUATIONS.runge_kutta(START, interval / f64::from(count), count as usize);
        assert_close(instance.get(STATES), expected, 1e-11);
        let other =
            EQUATIONS.runge_kutta(START, interval / f64::from(count + 1), count as usize + 1);
        let [found, ..] = instance.get(STATES);
        assert!((found - other[0]).abs() > 1e-8 * other[0].abs());
    }
}

#[test]
fn a_linear_lap_follows_the_runge_kutta_steps_however_long_they_stay_equal() {
    for count in [1_u32, 50, 1000] {
        let equations = Equations {
            k3: 0.0,
            ..EQUATIONS
        };
        let mut instance = Instance::new(Kind::Lap, 1, &[("step_size_max", 2e-5)]);
        assert_eq!(instance.set(&STATES, &START), c::OK);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        let mut expected = START;
        let mut t = 0.0;
        for n in 0..100_u32 {
            // a step of another length and a tuned parameter on the way
            let substeps = if n == 40 { 2 * count } else { count };
            let h = 2e-5 * f64::from(substeps);
            let equations = Equations {
                force: [30.0 * f64::from(n).sin(), -20.0],
                c12: if n < 70 { 8.0 } else { 30.0 },
                ..equations
            };
            if n == 70 {
                assert_eq!(instance.set(&[vr::C_YY], &[30.0]), c::OK);
            }
            let references = [vr::A_F, vr::B_F];
            assert_eq!(instance.set(&references, &equations.force), c::OK);
            assert_eq!(instance.step(t, h).0, c::OK);
            t += h;
            expected = equations.runge_kutta(expected, 2e-5, substeps as usize);
            let found = instance.get(STATES);
            // against the amplitudes of displacement and velocity
            for ((found, expected), scale) in found.iter().zip(expected).zip([1e-4, 0.1, 1e-4, 0.1])
            {
                assert!(
                    (found - expected).abs() < 1e-10 * scale,
                    "{count} {n}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn a_mode_that_grows_past_all_bounds_leaves_rest_at_rest() {
    // e^(ωH) overflows, but what starts at rest without a load stays there
    let mut instance = Instance::new(Kind::Lap, 1, &[("a.k_y", -1e9), ("b.k_y", -1e9)]);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::WARNING);
    for n in 0..20 {
        assert_eq!(instance.step(f64::from(n) * 0.1, 0.1).0, c::OK);
        assert_eq!(instance.get(STATES), [0.0; 4]);
    }
}

#[test]
fn free_vibration_follows_the_closed_form() {
    // both bodies in phase, no damping: y = y0 cos ωt, ω² = k/m; the joint carries nothing
    let mut instance = Instance::new(
        Kind::Lap,
        1,
        &[("a.c_y", 0.0), ("b.c_y", 0.0), ("step_size_max", 1e-6)],
    );
    assert_eq!(instance.set(&[vr::A_Y, vr::B_Y], &[1e-3, 1e-3]), c::OK);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    let omega = f64::sqrt(8e5 / 2.0);
    for n in 0..100 {
        let t = f64::from(n) * 1e-4;
        let [y, v, time, force, energy] =
            instance.get([vr::A_Y, vr::A_V, vr::TIME, vr::JOINT_F, vr::ENERGY]);
        assert_eq!((instance.get([vr::B_Y, vr::B_V]), force), ([y, v], 0.0));
        assert!((time - t).abs() < 1e-15);
        assert!((y - 1e-3 * (omega * t).cos()).abs() < 1e-14, "{y}");
        assert!((v + 1e-3 * omega * (omega * t).sin()).abs() < 1e-11, "{v}");
        // ½ k y0² for each body
        assert!((energy / 0.8 - 1.0).abs() < 1e-11, "{energy}");
        assert_eq!(instance.step(t, 1e-4).0, c::OK);
    }
}

#[test]
fn dissipation_balances_the_energy() {
    let mut instance = lap(1e-6);
    assert_eq!(instance.set(&[vr::A_F, vr::B_F], &[0.0, 0.0]), c::OK);
    let [start] = instance.get([vr::ENERGY]);
    let h = 1e-6;
    let mut t = 0.0;
    let mut dissipated = 0.0;
    let [mut power] = instance.get([vr::POWER]);
    for _ in 0..20_000 {
        assert_eq!(instance.step(t, h).0, c::OK);
        t += h;
        let [next] = instance.get([vr::POWER]);
        dissipated += 0.5 * h * (power + next);
        power = next;
    }
    let [end] = instance.get([vr::ENERGY]);
    assert!(dissipated > 0.05 * start);
    assert!(
        ((start - end) / dissipated - 1.0).abs() < 1e-5,
        "{start} {end} {dissipated}"
    );
}

#[test]
fn halves_of_a_step_make_the_whole() {
    let (mut whole, mut halves) = (lap(2e-5), lap(2e-5));
    assert_eq!(whole.step(0.0, 1e-3).0, c::OK);
    assert_eq!(halves.step(0.0, 5e-4).0, c::OK);
    assert_eq!(halves.step(5e-4, 5e-4).0, c::OK);
    assert_close(halves.get(STATES), whole.get(STATES), 1e-12);
}

#[test]
fn time_does_not_drift() {
    // the importer computes t0 + n·h, or adds h: both are accepted to the last step before the stop time, whatever the
    // rounding, and the FMU ends where the importer does
    const STEPS: u32 = 1_000_000;
    for (start, h) in [
        (0.0, 1e-4),
        (1.0, 1e-3),
        (-37.3, 1.0 / 3.0),
        (1e6 + 0.1, 1e-5),
    ] {
        for multiply in [true, false] {
            let mut instance = Instance::new(Kind::Element, 1, &[]);
            let stop = start + h * f64::from(STEPS);
            assert_eq!(instance.enter_initialization(start, Some(stop)), c::OK);
            assert_eq!(instance.exit_initialization(), c::OK);
            let mut t = start;
            for n in 1..=STEPS {
                let (status, last) = instance.step(t, h);
                assert_eq!(
                    (status, last),
                    (c::OK, t + h),
                    "{n} {:?}",
                    instance.take_log()
                );
                t = if multiply {
                    start + f64::from(n) * h
                } else {
                    t + h
                };
            }
            let [time] = instance.get([vr::TIME]);
            let rounding = f64::EPSILON * time.abs().max(start.abs());
            let drift = if multiply { 2.0 } else { f64::from(STEPS) } * rounding;
            assert!((time - stop).abs() <= drift, "{start} {h}: {time} {stop}");
            if multiply {
                let message = instance.refused(|i| i.step(t, h).0);
                assert!(message.contains("after stopTime"), "{message}");
            }
        }
    }
    // a lap, with steps that are no multiple of its internal ones
    let mut instance = lap(3e-5);
    let mut t = 0.0;
    for n in 1..=100_000_u32 {
        assert_eq!(instance.step(t, 1e-4), (c::OK, t + 1e-4));
        t = f64::from(n) * 1e-4;
    }
}

#[test]
fn a_stop_time_that_rounding_has_moved_is_reached() {
    for ulps in -8_i64..=8 {
        let mut instance = Instance::new(Kind::Lap, 1, &[]);
        let stop = f64::from_bits((0.7_f64.to_bits() as i64 + ulps) as u64);
        assert_eq!(instance.enter_initialization(0.0, Some(stop)), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        let mut t = 0.0;
        for n in 1..=7 {
            assert_eq!(instance.step(t, 0.1).0, c::OK, "{ulps}");
            t = 0.1 * f64::from(n);
        }
    }
}

#[test]
fn no_step_passes_a_late_stop_time() {
    // 10⁻⁹ of this stop time is a hundred steps long
    let (start, h, steps) = (1e6, 1e-5, 50_u32);
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    let stop = start + h * f64::from(steps);
    assert_eq!(instance.enter_initialization(start, Some(stop)), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    let time = |n: u32| start + h * f64::from(n);
    for n in 0..steps {
        assert_eq!(instance.step(time(n), h).0, c::OK, "{n}");
    }
    for longer in [h, 0.1 * h] {
        let message = instance.refused(|i| i.step(time(steps), longer).0);
        assert!(message.contains("after stopTime"), "{message}");
    }
    // nor does one that begins in time
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    assert_eq!(instance.enter_initialization(start, Some(stop)), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(start, h * f64::from(steps - 1)).0, c::OK);
    let message = instance.refused(|i| i.step(time(steps - 1), 1.02 * h).0);
    assert!(message.contains("after stopTime"), "{message}");
    assert_eq!(instance.step(time(steps - 1), h).0, c::OK);
}

#[test]
fn inputs_that_are_set_before_initialisation_act_from_the_first_step_on() {
    let run = |early: bool| {
        let mut instance = Instance::new(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
        let set = |i: &mut Instance| i.set(&[vr::A_F, vr::B_F], &EQUATIONS.force);
        if early {
            assert_eq!(set(&mut instance), c::OK);
        }
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        if !early {
            assert_eq!(set(&mut instance), c::OK);
        }
        assert_eq!(instance.step(0.0, 1e-3).0, c::OK);
        instance.get(STATES)
    };
    assert_eq!(run(true), run(false));
    assert_close(run(true), EQUATIONS.runge_kutta([0.0; 4], 2e-5, 50), 1e-11);
}

#[test]
fn steps_that_cannot_be_are_refused_and_nothing_moves() {
    for (t, h, expected) in [
        (0.0, 0.0, "communicationStepSize is 0"),
        (0.0, -1e-3, "communicationStepSize is -0.001"),
        (0.0, f64::NAN, "communicationStepSize is NaN"),
        (0.0, f64::INFINITY, "communicationStepSize is inf"),
        (
            1e-3,
            1e-3,
            "currentCommunicationPoint is 0.001 s, but the FMU is at t = 0 s",
        ),
        (-1e-3, 1e-3, "but the FMU is at t = 0 s"),
        (f64::NAN, 1e-3, "currentCommunicationPoint is NaN"),
        (0.0, 1e5, "more than 1000000000 Runge-Kutta steps"),
        (0.0, 1e300, "more than 1000000000 Runge-Kutta steps"),
    ] {
        let mut instance = lap(2e-5);
        let message = instance.refused(|i| {
            let (status, last) = i.step(t, h);
            assert_eq!(last, 0.0);
            status
        });
        assert!(
            message.starts_with("fmi3DoStep: ") && message.contains(expected),
            "{message}"
        );
        // mended, the step is taken
        assert_eq!(instance.step(0.0, 1e-3), (c::OK, 1e-3));
    }
}

#[test]
fn a_step_that_rounding_swallows_is_refused() {
    let mut instance = Instance::new(Kind::Element, 1, &[]);
    assert_eq!(instance.enter_initialization(1e6, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    let message = instance.refused(|i| i.step(1e6, 1e-12).0);
    assert!(
        message.contains("is lost to rounding at t = 1000000 s"),
        "{message}"
    );
}

#[test]
fn the_stop_time_is_kept_but_for_rounding() {
    let started = || {
        let mut instance = Instance::new(Kind::Lap, 1, &[]);
        assert_eq!(instance.enter_initialization(0.0, Some(0.3)), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        instance
    };
    let mut instance = started();
    // 0.1 + 0.1 + 0.1 > 0.3 by one bit
    let mut t = 0.0;
    for _ in 0..3 {
        assert_eq!(instance.step(t, 0.1).0, c::OK);
        t += 0.1;
    }
    assert!(t > 0.3);
    let message = instance.refused(|i| i.step(t, 1e-3).0);
    assert!(message.contains("after stopTime = 0.3 s"), "{message}");
    assert_eq!(instance.terminate(), c::OK);
    let mut instance = started();
    let message = instance.refused(|i| i.step(0.0, 0.31).0);
    assert!(
        message.contains("the step would end at t = 0.31 s, after stopTime = 0.3 s"),
        "{message}"
    );
    assert_eq!(instance.step(0.0, 0.3), (c::OK, 0.3));
}

#[test]
fn null_results_are_refused() {
    use std::ptr::null_mut;
    let (mut flag, mut time) = (false, 0.0);
    let (flag, time) = (&raw mut flag, &raw mut time);
    for (event, terminate, early, last, expected) in [
        (null_mut(), flag, flag, time, "eventHandlingNeeded"),
        (flag, null_mut(), flag, time, "terminateSimulation"),
        (flag, flag, null_mut(), time, "earlyReturn"),
        (flag, flag, flag, null_mut(), "lastSuccessfulTime"),
    ] {
        let mut instance = lap(2e-5);
        // SAFETY: all pointers are null or to locals
        let message = instance.refused(|i| unsafe {
            c::fmi3DoStep(i.handle, 0.0, 1e-3, true, event, terminate, early, last)
        });
        assert!(
            message.contains(&format!("argument {expected} is a null pointer")),
            "{message}"
        );
    }
}

#[test]
fn parameters_are_checked_when_they_take_effect() {
    for (reference, value, expected) in [
        (
            vr::A_MASS,
            0.0,
            "parameter a.m is 0 kg, expected a number greater than zero",
        ),
        (vr::A_MASS, -2.0, "parameter a.m is -2 kg"),
        (vr::STEP_SIZE_MAX, 0.0, "parameter step_size_max is 0 s"),
        (
            vr::STEP_SIZE_MAX,
            -1e-5,
            "parameter step_size_max is -0.00001 s",
        ),
        // ω² = (8e5 + 8e6)/2, ω = 2098 rad/s: RK4 diverges beyond 2.83/ω = 1.35 ms
        (
            vr::STEP_SIZE_MAX,
            1.4e-3,
            "step_size_max = 0.0014 s diverge",
        ),
    ] {
        let mut instance = Instance::new(Kind::Lap, 1, &[]);
        assert_eq!(instance.set(&[reference], &[value]), c::OK);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        let message = instance.refused(Instance::exit_initialization);
        assert!(
            message.starts_with("fmi3ExitInitializationMode: "),
            "{message}"
        );
        assert!(message.contains(expected), "{message}");

        let mut start = Instance::new(Kind::Lap, 1, &[]);
        let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
        assert_eq!(instance.step(0.0, 1e-3).0, c::OK);
        assert_eq!(instance.set(&[reference], &[value]), c::OK);
        let [good] = start.get([reference]);
        let message = instance.refused(|i| i.step(1e-3, 1e-3).0);
        assert!(
            message.starts_with("fmi3DoStep: ") && message.contains(expected),
            "{message}"
        );
        // with the parameter as it was, the simulation goes on as if nothing had been
        assert_eq!(instance.set(&[reference], &[good]), c::OK);
        assert_eq!(instance.step(1e-3, 1e-3), (c::OK, 2e-3));
    }
    let mut instance = Instance::new(Kind::Lap, 1, &[("step_size_max", 1.3e-3)]);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
}

#[test]
fn a_tuned_parameter_acts_from_the_next_step_on() {
    let mut instance = lap(2e-5);
    assert_eq!(instance.step(0.0, 1e-3).0, c::OK);
    let reached = instance.get(STATES);
    assert_eq!(instance.set(&[vr::K_YY, vr::C_YY], &[2e6, 30.0]), c::OK);
    assert_eq!(instance.step(1e-3, 1e-3).0, c::OK);
    let tuned = Equations {
        k12: 2e6,
        c12: 30.0,
        ..EQUATIONS
    };
    assert_close(
        instance.get(STATES),
        tuned.runge_kutta(reached, 2e-5, 50),
        1e-11,
    );
}

#[test]
fn active_models_give_a_warning_and_work() {
    for (kind, changes, expected) in [
        (
            Kind::Lap,
            ("joint.c_yy", -1.0),
            "the joint's damping matrix is not positive semidefinite",
        ),
        (
            Kind::Element,
            ("joint.k_yy", -1.0),
            "the joint's stiffness matrix is not positive semidefinite",
        ),
        (
            Kind::Lap,
            ("b.c_y", -0.5),
            "a support has negative stiffness or damping",
        ),
    ] {
        let mut instance = Instance::new(kind, 1, &[changes]);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::WARNING);
        let log = instance.take_log();
        let warning = log
            .iter()
            .find(|message| message.status == c::WARNING)
            .unwrap();
        assert_eq!(warning.category, "logStatusWarning");
        assert!(warning.text.contains(expected), "{warning:?}");
        assert_eq!(instance.step(0.0, 1e-3).0, c::OK);
    }
    // tuned later, the next step warns once
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    assert_eq!(instance.set(&[vr::B_C_Y], &[-0.5]), c::OK);
    assert_eq!(instance.step(0.0, 1e-3), (c::WARNING, 1e-3));
    assert_eq!(instance.step(1e-3, 1e-3), (c::OK, 2e-3));
    // a step that is refused for another reason does not swallow the warning
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    assert_eq!(instance.set(&[vr::B_C_Y], &[-0.5]), c::OK);
    instance.refused(|i| i.step(0.0, 1e5).0);
    assert_eq!(instance.step(0.0, 1e-3), (c::WARNING, 1e-3));
}

#[test]
fn escape_from_a_softening_joint_is_reported_and_the_last_point_kept() {
    // k = 8e5, k12 = 4e6, k3 = −1e12: the joint holds up to √((k + 2 k12)/(−2 k3)) = 2.0976 mm apart
    let mut instance = Instance::stepping(Kind::Lap, 1, &[("joint.k3_y", -1e12)]);
    let amplitude = f64::sqrt(8.8e6 / 2e12);
    // load the joint slowly: its static limit is reached somewhere on the way
    let mut t = 0.0;
    let mut force = 0.0;
    let before = loop {
        assert!(force < 1e5, "the joint never gave way");
        let before = instance.get([vr::TIME, vr::A_Y, vr::B_Y, vr::A_V, vr::B_V]);
        let (status, last) = instance.step(t, 1e-3);
        if status == c::ERROR {
            assert_eq!(last, t);
            break before;
        }
        t += 1e-3;
        force += 10.0;
        assert_eq!(instance.set(&[vr::A_F, vr::B_F], &[force, -force]), c::OK);
    };
    let message = instance.error();
    assert!(
        message.starts_with("fmi3DoStep: a.y - b.y = ") && message.contains("softening joint"),
        "{message}"
    );
    assert!(
        message.contains(&format!("is past {amplitude:e} m")),
        "{message}"
    );
    // told within the step that failed
    let time: f64 = message
        .split("t = ")
        .nth(1)
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((t..=t + 1e-3).contains(&time), "{time}");
    assert_eq!(
        instance.get([vr::TIME, vr::A_Y, vr::B_Y, vr::A_V, vr::B_V]),
        before
    );
    assert!((before[1] - before[2]).abs() <= amplitude);
}

#[test]
fn a_joint_that_was_torn_within_a_step_is_not_whole_again_at_its_end() {
    // the relative motion passes the amplitude, and a load brings it back before the communication step ends
    let changes = [
        ("joint.k3_y", -1e12),
        ("joint.k_yy", 1e6),
        ("a.k_y", 1e6),
        ("b.k_y", 1e6),
        ("step_size_max", 1e-5),
    ];
    // in balance up to √((k + 2 k12)/(−2 k3))
    let amplitude = f64::sqrt((1e6 + 2.0 * 1e6) / 2e12);
    let equations = Equations {
        k: 1e6,
        k12: 1e6,
        k3: -1e12,
        force: [0.0; 2],
        ..EQUATIONS
    };
    // just below the amplitude, moving apart: it is passed, and the load that begins then brings the bodies back
    let start = [0.4999 * amplitude, 0.3, -0.4999 * amplitude, -0.3];
    let back = Equations {
        force: [-6000.0, 6000.0],
        ..equations
    };
    let apart = |[ya, _, yb, _]: [f64; 4]| ya - yb;
    let duration = 4e-4;
    let path: Vec<f64> = (1..=40)
        .map(|n| apart(back.runge_kutta(start, 1e-5, n)))
        .collect();
    assert!(path.iter().any(|&r| r > 1.01 * amplitude));
    assert!(path[39].abs() < 0.9 * amplitude);
    let passed = path.iter().position(|&r| r > amplitude).unwrap() + 1;

    let mut instance = Instance::new(Kind::Lap, 1, &changes);
    assert_eq!(instance.set(&STATES, &start), c::OK);
    assert_eq!(instance.set(&[vr::A_F, vr::B_F], &back.force), c::OK);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(0.0, duration), (c::ERROR, 0.0));
    let message = instance.error();
    assert!(message.contains("softening joint"), "{message}");
    let time = 1e-5 * passed as f64;
    let told: f64 = message
        .split("t = ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .unwrap()
        .parse()
        .unwrap();
    assert!((told - time).abs() < 1e-12, "{message}");
}

#[test]
fn motion_that_overflows_is_reported_by_state_and_time() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[]);
    assert_eq!(instance.set(&[vr::B_M], &[f64::MAX]), c::OK);
    assert_eq!(instance.step(0.0, 1e-3), (c::ERROR, 0.0));
    let message = instance.error();
    assert!(
        message.contains("state ") && message.contains("is no finite number at t = 0.000"),
        "{message}"
    );
    assert_eq!(instance.get([vr::B_THETA, vr::B_OMEGA, vr::TIME]), [0.0; 3]);

    // a hardening joint under an absurd load
    let mut instance = Instance::stepping(Kind::Lap, 1, &[("joint.k3_y", 1e20)]);
    assert_eq!(instance.set(&[vr::B_F], &[1e12]), c::OK);
    let mut t = 0.0;
    while instance.step(t, 1e-3).0 == c::OK {
        t += 1e-3;
        assert!(t < 1.0, "never diverged");
    }
    assert!(instance.error().contains("the motion diverges"));
    assert!(
        instance
            .try_get(&STATES)
            .unwrap()
            .iter()
            .all(|value| value.is_finite())
    );
}

#[test]
fn coupled_translation_and_rotation_are_symmetric() {
    // a static check of every coupling: with K, r = x_a − x_b in balance under constant loads, heavily damped
    let mut instance = Instance::new(
        Kind::Lap,
        2,
        &[
            ("a.c_y", 4e3),
            ("b.c_y", 4e3),
            ("a.c_theta", 2.0),
            ("b.c_theta", 2.0),
            ("step_size_max", 1e-4),
        ],
    );
    assert_eq!(instance.set(&[vr::A_F, vr::B_M], &[100.0, 3.0]), c::OK);
    assert_eq!(instance.enter_initialization(0.0, None), c::OK);
    assert_eq!(instance.exit_initialization(), c::OK);
    assert_eq!(instance.step(0.0, 0.5).0, c::OK);
    let [ya, ta, yb, tb, force, moment] = instance.get([
        vr::A_Y,
        vr::A_THETA,
        vr::B_Y,
        vr::B_THETA,
        vr::JOINT_F,
        vr::JOINT_M,
    ]);
    let close =
        |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    close(force, 4e6 * (ya - yb) + 1e4 * (ta - tb));
    close(moment, 1e4 * (ya - yb) + 2e3 * (ta - tb));
    close(8e5 * ya, 100.0 - force);
    close(8e5 * yb, force);
    close(1e3 * ta, -moment);
    close(1e3 * tb, 3.0 + moment);
}
