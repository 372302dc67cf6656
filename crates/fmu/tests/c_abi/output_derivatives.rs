//! Derivatives of outputs with respect to time, against differences of an independent integration.

use crate::{
    c,
    equations::{EQUATIONS, Equations, STATES, assert_close},
    importer::{Instance, Kind, Make as _, vr},
    raw::{Fmi2, Raw, status_of},
    rows::{reference, rows},
};

const LOADED: Equations = Equations {
    force: [300.0, -200.0],
    ..EQUATIONS
};
const OUTPUTS: [u32; 3] = [vr::JOINT_F, vr::ENERGY, vr::POWER];

#[test]
fn a_lap_gives_those_of_all_its_outputs() {
    let instance = Instance::new(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
    c::ok(instance.set(&STATES, &[1e-4, 0.1, -2e-4, 0.0]));
    instance.initialize(0.0, None);
    c::ok(instance.set(&[vr::A_F, vr::B_F], &LOADED.force));
    let mut t = 0.0;
    for _ in 0..20 {
        let state = instance.get(STATES);
        let found = instance
            .output_derivatives(&[&OUTPUTS[..], &STATES].concat())
            .unwrap();
        // ẏ(t) ≈ (45 (y₁ − y₋₁) − 9 (y₂ − y₋₂) + (y₃ − y₋₃)) / 60 δ, with the motion from here to both sides
        let delta = 1e-5;
        let at = |n: i32| {
            let h = delta * f64::from(n) / 100.0;
            let x = LOADED.runge_kutta(state, h, 100);
            let [force, energy, power] = LOADED.outputs(x);
            let [ya, va, yb, vb] = x;
            [force, energy, power, ya, va, yb, vb]
        };
        let [y1, y2, y3] = [1, 2, 3].map(|n| [at(n), at(-n)]);
        let size = [1e3, 0.1, 1.0, 1e-4, 0.1, 1e-4, 0.1];
        for i in 0..7 {
            let difference = |y: &[[f64; 7]; 2]| y[0][i] - y[1][i];
            let expected =
                (45.0 * difference(&y1) - 9.0 * difference(&y2) + difference(&y3)) / (60.0 * delta);
            // against the amplitude times the frequency of the faster mode
            let tolerance = 1e-9 * size[i] * 2e3;
            assert!(
                (found[i] - expected).abs() < tolerance,
                "{i}: {} {expected}",
                found[i]
            );
        }
        // the derivative of the energy is what the loads bring less what the dampers take: exact
        let [power] = instance.get([vr::POWER]);
        let [_, va, _, vb] = state;
        let balance = LOADED.force[0] * va + LOADED.force[1] * vb - power;
        assert!((found[1] - balance).abs() < 1e-12 * (power.abs() + balance.abs() + 100.0));
        c::ok(instance.step(t, 3e-4));
        t += 3e-4;
    }
}

#[test]
fn an_element_takes_the_velocities_for_what_they_are() {
    // F_b = k r + c ṙ + k3 r³ with ṙ = v: Ḟ_b = (k + 3 k3 r²) v while v is held
    let instance = Instance::stepping(Kind::Element, 1, &[("joint.k3_y", 5e12)]);
    let motion = [vr::A_Y, vr::B_Y, vr::A_V, vr::B_V];
    c::ok(instance.set(&motion, &[3e-4, 1e-4, 0.2, 0.05]));
    let (r, v): (f64, f64) = (3e-4 - 1e-4, 0.2 - 0.05);
    let force = (4e6 + 3.0 * 5e12 * r * r) * v;
    let energy = (4e6 * r + 5e12 * r.powi(3)) * v;
    let found = instance
        .output_derivatives(&[vr::A_F, vr::B_F, vr::JOINT_F, vr::ENERGY, vr::POWER])
        .unwrap();
    assert_close(&found, &[-force, force, force, energy, 0.0], 1e-14);
}

#[test]
fn only_first_derivatives_of_outputs_are_given() {
    let mut instance = Instance::stepping(Kind::Lap, 2, &[]);
    const REFUSED: &str = "
        52             | 1  | value reference 52 does not exist
        a.F            | 1  | variable a.F is an input and no output
        joint.k_yy     | 1  | variable joint.k_yy is a parameter and no output
        time           | 1  | variable time is the independent variable and no output
        a.acceleration | 1  | variable a.acceleration is a calculated derivative and no output
        a.y            | 0  | the order of the derivative of variable a.y is 0, expected 1
        a.y            | 2  | the order of the derivative of variable a.y is 2, expected 1
        a.y            | -1 | is -1, expected 1
        a.y            | -2147483648 | is -2147483648, expected 1
    ";
    for [name, order, expected] in rows(REFUSED) {
        let (references, orders) = ([vr::JOINT_F, reference(name)], [1, order.parse().unwrap()]);
        let message = instance.refused(|i| status_of(i.derivatives_of_order(&references, &orders)));
        let told = message.strip_prefix("fmi3GetOutputDerivatives: ");
        assert!(told.unwrap().contains(expected), "{message}");
    }
    assert_eq!(instance.output_derivatives(&[]), Ok(vec![]));
    // a number that overflows is not handed on
    let mut instance = Instance::stepping(Kind::Element, 1, &[]);
    c::ok(instance.set(&[vr::A_V], &[1e305]));
    instance.refuses(
        |i| status_of(i.output_derivatives(&[vr::JOINT_F])),
        "variable joint.F overflows",
    );
}

#[test]
fn derivatives_of_outputs_are_rates_of_change() {
    let mut instance = Fmi2.stepping(Kind::Lap, 1, &[]);
    c::ok(instance.set(&[vr::A_F], &[50.0]));
    c::ok(instance.step(0.0, 1e-3));
    let [v_a, v_b, acceleration_a, acceleration_b] =
        instance.get([vr::A_V, vr::B_V, vr::A_ACCELERATION, vr::B_ACCELERATION]);
    let rates = instance
        .output_derivatives(&[vr::A_Y, vr::A_V, vr::JOINT_F])
        .unwrap();
    assert_eq!(rates[..2], [v_a, acceleration_a]);
    let of_joint = 4e6 * (v_a - v_b) + 8.0 * (acceleration_a - acceleration_b);
    assert_close(&rates[2..], &[of_joint], 1e-13);
    // FMI 2.0, 4.2.1: what is of higher order than the slave knows is zero
    assert_eq!(
        instance.derivatives_of_order(&[vr::A_Y, vr::A_Y, vr::A_V], &[2, 1, 7]),
        Ok(vec![0.0, v_a, 0.0])
    );
    const REFUSED: &str = "
        a.y | 0  | order of the derivative of variable a.y is 0, expected 1
        a.y | -1 | order of the derivative of variable a.y is -1, expected 1
        a.F | 1  | variable a.F is an input and no output
        a.F | 2  | variable a.F is an input and no output
        52  | 1  | value reference 52 does not exist
    ";
    for [name, order, expected] in rows(REFUSED) {
        let (references, orders) = ([vr::A_V, reference(name)], [1, order.parse().unwrap()]);
        let asked = |i: Raw| status_of(i.derivatives_of_order(&references, &orders));
        instance.refuses(asked, expected);
    }
}
