//! Communication steps: what they compute.

use crate::{
    c,
    equations::{EQUATIONS, Equations, START, STATES, assert_close},
    importer::{Instance, Kind, Make as _, vr},
    raw::{Fmi3, FmiVersion, Interface::CoSimulation},
};

pub(crate) fn lap(step_size_max: f64) -> Instance {
    lap_of(Fmi3, step_size_max)
}

pub(crate) fn lap_of(version: FmiVersion, step_size_max: f64) -> Instance {
    let changes = [("joint.k3_y", 5e12), ("step_size_max", step_size_max)];
    let instance = version.instance(CoSimulation, Kind::Lap, 1, &changes);
    c::ok(instance.set(&STATES, &START));
    instance.initialize(0.0, None);
    c::ok(instance.set(&[vr::A_F, vr::B_F], &EQUATIONS.force));
    instance
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
        let instance = lap(step_size_max);
        assert_eq!(instance.step_to(0.0, interval), (c::OK, interval));
        let expected = EQUATIONS.runge_kutta(START, interval / f64::from(count), count as usize);
        assert_close(&instance.get(STATES), &expected, 1e-11);
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
        let instance = Instance::new(Kind::Lap, 1, &[("step_size_max", 2e-5)]);
        c::ok(instance.set(&STATES, &START));
        instance.initialize(0.0, None);
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
                c::ok(instance.set(&[vr::C_YY], &[30.0]));
            }
            let references = [vr::A_F, vr::B_F];
            c::ok(instance.set(&references, &equations.force));
            c::ok(instance.step(t, h));
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
    let instance = Instance::new(Kind::Lap, 1, &[("a.k_y", -1e9), ("b.k_y", -1e9)]);
    c::ok(instance.enter_initialization(0.0, None));
    assert_eq!(instance.exit_initialization(), c::WARNING);
    for n in 0..20 {
        c::ok(instance.step(f64::from(n) * 0.1, 0.1));
        assert_eq!(instance.get(STATES), [0.0; 4]);
    }
}

#[test]
fn free_vibration_follows_the_closed_form() {
    // both bodies in phase, no damping: y = y0 cos ωt, ω² = k/m; the joint carries nothing
    let instance = Instance::new(
        Kind::Lap,
        1,
        &[("a.c_y", 0.0), ("b.c_y", 0.0), ("step_size_max", 1e-6)],
    );
    c::ok(instance.set(&[vr::A_Y, vr::B_Y], &[1e-3, 1e-3]));
    instance.initialize(0.0, None);
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
        c::ok(instance.step(t, 1e-4));
    }
}

#[test]
fn dissipation_balances_the_energy() {
    let instance = lap(1e-6);
    c::ok(instance.set(&[vr::A_F, vr::B_F], &[0.0, 0.0]));
    let [start] = instance.get([vr::ENERGY]);
    let h = 1e-6;
    let mut t = 0.0;
    let mut dissipated = 0.0;
    let [mut power] = instance.get([vr::POWER]);
    for _ in 0..20_000 {
        c::ok(instance.step(t, h));
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
    let (whole, halves) = (lap(2e-5), lap(2e-5));
    c::ok(whole.step(0.0, 1e-3));
    c::ok(halves.step(0.0, 5e-4));
    c::ok(halves.step(5e-4, 5e-4));
    assert_close(&halves.get(STATES), &whole.get(STATES), 1e-12);
}

#[test]
fn inputs_that_are_set_before_initialisation_act_from_the_first_step_on() {
    let run = |early: bool| {
        let mut instance = Instance::new(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
        let set = |i: &mut Instance| i.set(&[vr::A_F, vr::B_F], &EQUATIONS.force);
        if early {
            c::ok(set(&mut instance));
        }
        instance.initialize(0.0, None);
        if !early {
            c::ok(set(&mut instance));
        }
        c::ok(instance.step(0.0, 1e-3));
        instance.get(STATES)
    };
    assert_eq!(run(true), run(false));
    assert_close(
        &run(true),
        &EQUATIONS.runge_kutta([0.0; 4], 2e-5, 50),
        1e-11,
    );
}

#[test]
fn coupled_translation_and_rotation_are_symmetric() {
    // a static check of every coupling: with K, r = x_a − x_b in balance under constant loads, heavily damped
    let instance = Instance::new(
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
    c::ok(instance.set(&[vr::A_F, vr::B_M], &[100.0, 3.0]));
    instance.initialize(0.0, None);
    c::ok(instance.step(0.0, 0.5));
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
