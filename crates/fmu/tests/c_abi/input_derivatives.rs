//! Inputs that change within a communication step along derivatives that were given for its beginning (FMI 2.0), and
//! what they do to motion and outputs.

use crate::{
    c,
    equations::{EQUATIONS, Equations, STATES, assert_close},
    importer::{Instance, Kind, Make as _, vr},
    raw::{Fmi2, Raw},
    rows::{number, reference, rows},
};

fn stepping(kind: Kind, changes: &[(&str, f64)]) -> Instance {
    Fmi2.stepping(kind, 1, changes)
}

/// F sin Ωt and its first three derivatives.
fn sine(t: f64) -> [f64; 4] {
    let (amplitude, forcing): (f64, f64) = (1e3, 900.0);
    let (sin, cos) = (forcing * t).sin_cos();
    [
        amplitude * sin,
        amplitude * forcing * cos,
        -amplitude * forcing.powi(2) * sin,
        -amplitude * forcing.powi(3) * cos,
    ]
}

#[test]
fn each_derivative_that_is_given_raises_the_order() {
    // both bodies under the same load, without damping: m ẍ + k x = F sin Ωt from rest,
    // x = F/(m (ω² − Ω²)) (sin Ωt − Ω/ω sin ωt), with internal steps short enough not to matter
    let (omega, forcing, duration): (f64, f64, f64) = (f64::sqrt(8e5 / 2.0), 900.0, 0.02);
    let amplitude = 1e3 / (2.0 * (omega * omega - forcing * forcing));
    let expected =
        amplitude * ((forcing * duration).sin() - forcing / omega * (omega * duration).sin());
    for orders in 0..=3_i32 {
        let error = |steps: u32| {
            let changes = [("a.c_y", 0.0), ("b.c_y", 0.0), ("step_size_max", 5e-6)];
            let instance = stepping(Kind::Lap, &changes);
            let h = duration / f64::from(steps);
            for n in 0..steps {
                let t = h * f64::from(n);
                let [load, derivatives @ ..] = sine(t);
                for input in [vr::A_F, vr::B_F] {
                    c::ok(instance.set(&[input], &[load]));
                    for order in 1..=orders {
                        let derivative = derivatives[order as usize - 1];
                        let status =
                            instance.set_input_derivatives(&[input], &[order], &[derivative]);
                        c::ok(status);
                    }
                }
                c::ok(instance.step(t, h));
            }
            let [y] = instance.get([vr::A_Y]);
            (y - expected).abs() / amplitude.abs()
        };
        // held loads are first order, and every derivative adds one
        let order = (error(160) / error(320)).log2();
        let found = f64::from(orders + 1);
        assert!((order - found).abs() < 0.15, "{orders}: order {order}");
    }
}

#[test]
fn a_cubic_load_is_integrated_as_such() {
    // one communication step of many internal ones: the stages see the polynomial at their own times
    let [f0, f1, f2, f3] = [20.0, 3e5, -4e8, 9e11];
    let load = |t: f64| f0 + t * (f1 + t / 2.0 * (f2 + t / 3.0 * f3));
    for k3 in [0.0, 5e12] {
        let instance = stepping(Kind::Lap, &[("joint.k3_y", k3), ("step_size_max", 1e-5)]);
        c::ok(instance.set(&[vr::A_F, vr::B_F], &[f0, -7.0]));
        let given = instance.set_input_derivatives(&[vr::A_F; 3], &[1, 3, 2], &[f1, f3, f2]);
        c::ok(given);
        c::ok(instance.step(0.0, 1e-3));
        // Runge–Kutta once more, with the load at the stages
        let equations = |t: f64| Equations {
            k3,
            force: [load(t), -7.0],
            ..EQUATIONS
        };
        let h = 1e-5;
        let x = (0..100).fold([0.0; 4], |x, n| {
            let t = h * f64::from(n);
            Equations::step([t, t + h / 2.0, t + h].map(equations), x, h)
        });
        assert_close(&instance.get(STATES), &x, 1e-11);
        // the input is where its polynomial has led
        let [at_end] = instance.get([vr::A_F]);
        assert!((at_end / load(1e-3) - 1.0).abs() < 1e-14);
        // what was given was for one step: the next one holds the inputs
        c::ok(instance.step(1e-3, 1e-3));
        assert_eq!(instance.get([vr::A_F]), [at_end]);
    }
}

#[test]
fn derivatives_of_outputs_follow_those_of_inputs() {
    // F_b = k r + c ṙ: Ḟ_b = k v_a + c v̇_a; with y_a's own derivative given, that one counts
    let mut instance = stepping(Kind::Element, &[]);
    c::ok(instance.set(&[vr::A_Y, vr::A_V], &[1e-4, 0.2]));
    let rate = |i: &mut Instance| i.output_derivatives(&[vr::B_F]).unwrap()[0];
    let close = |found: f64, expected: f64| assert_close(&[found], &[expected], 1e-13);
    close(rate(&mut instance), 4e6 * 0.2);
    c::ok(instance.set_input_derivatives(&[vr::A_V; 2], &[1, 2], &[3.0, 500.0]));
    close(rate(&mut instance), 4e6 * 0.2 + 8.0 * 3.0);
    c::ok(instance.step(0.0, 1e-2));
    // at the end of the step: v = 0.2 + 3·10⁻² + 500·10⁻⁴/2, v̇ = 3 + 500·10⁻²
    close(rate(&mut instance), 4e6 * 0.255 + 8.0 * 8.0);
    assert_eq!(instance.get([vr::A_Y]), [1e-4]);
    c::ok(instance.set_input_derivatives(&[vr::A_Y], &[1], &[0.0]));
    close(rate(&mut instance), 0.0);
    c::ok(instance.set_input_derivatives(&[vr::A_Y], &[1], &[0.25]));
    close(rate(&mut instance), 4e6 * 0.25);
    c::ok(instance.step(1e-2, 1e-2));
    let [y] = instance.get([vr::A_Y]);
    close(y, 1e-4 + 0.25e-2);
    close(rate(&mut instance), 4e6 * 0.25);
    c::ok(instance.step(2e-2, 1e-2));
    assert_eq!(instance.get([vr::A_Y]), [y]);
    close(rate(&mut instance), 4e6 * 0.255);
}

#[test]
fn a_load_that_would_overflow_is_refused_and_nothing_moves() {
    let mut instance = stepping(Kind::Lap, &[]);
    c::ok(instance.set_input_derivatives(&[vr::A_F], &[3], &[1e300]));
    assert_eq!(instance.step(0.0, 1e4), c::ERROR);
    assert_eq!(instance.get([vr::TIME, vr::A_F, vr::A_Y]), [0.0; 3]);
    let message = instance.message(c::ERROR);
    c::tells(&message, "", "input a.F overflows before t = 10000 s");
    c::ok(instance.set_input_derivatives(&[vr::A_F], &[3], &[0.0]));
    c::ok(instance.step(0.0, 1e-3));
}

#[test]
fn derivatives_of_inputs_carry_the_inputs_through_the_step() {
    // the element follows its inputs: after the step they are where their Taylor polynomials lead
    let instance = stepping(Kind::Element, &[]);
    c::ok(instance.set(&[vr::A_Y, vr::B_Y], &[1e-4, 5e-5]));
    c::ok(instance.set_input_derivatives(
        &[vr::A_Y, vr::A_Y, vr::B_Y, vr::A_Y],
        &[1, 2, 1, 3],
        &[0.25, 4.0, -0.5, 12.0],
    ));
    let h: f64 = 0.5;
    c::ok(instance.step(0.0, h));
    let a = 1e-4 + 0.25 * h + 4.0 * h * h / 2.0 + 12.0 * h * h * h / 6.0;
    let b = 5e-5 - 0.5 * h;
    let [found_a, found_b, force] = instance.get([vr::A_Y, vr::B_Y, vr::JOINT_F]);
    assert!((found_a - a).abs() < 1e-15 && (found_b - b).abs() < 1e-15);
    assert!((force - 4e6 * (a - b)).abs() < 1e-8);
    // they are for one step only
    c::ok(instance.step(h, h));
    assert_eq!(instance.get([vr::A_Y, vr::B_Y]), [found_a, found_b]);
}

#[test]
fn a_lap_under_a_ramp_follows_the_equations_of_motion() {
    // a ramp of the load given as derivative, against the same ramp in steps of one hundredth
    let ramp = 2e5;
    let mut instance = stepping(Kind::Lap, &[]);
    let mut fine = stepping(Kind::Lap, &[]);
    let (h, parts) = (1e-3, 100);
    for n in 0..20 {
        let t = f64::from(n) * h;
        c::ok(instance.set(&[vr::A_F], &[ramp * t]));
        c::ok(instance.set_input_derivatives(&[vr::A_F], &[1], &[ramp]));
        c::ok(instance.step(t, h));
        for part in 0..parts {
            let (t, h) = (
                t + f64::from(part) * h / f64::from(parts),
                h / f64::from(parts),
            );
            c::ok(fine.set(&[vr::A_F], &[ramp * (t + h / 2.0)]));
            c::ok(fine.step(t, h));
        }
    }
    let [y, held] = [&mut instance, &mut fine].map(|i| i.get([vr::A_Y])[0]);
    assert!(
        y.abs() > 1e-4 && (y - held).abs() < 1e-5 * y.abs(),
        "{y} {held}"
    );
}

#[test]
fn derivatives_of_anything_but_inputs_are_refused() {
    let mut instance = stepping(Kind::Lap, &[]);
    const REFUSED: &str = "
        a.y        | 1 | 1   | variable a.y is a state and no input
        joint.k_yy | 1 | 1   | variable joint.k_yy is a parameter and no input
        52         | 1 | 1   | value reference 52 does not exist
        b.F        | 0 | 1   | order of the derivative of variable b.F is 0, expected 1 to 3
        b.F        | 4 | 1   | order of the derivative of variable b.F is 4, expected 1 to 3
        b.F        | 1 | NaN | variable b.F cannot be set to NaN
    ";
    for [name, order, value, expected] in rows(REFUSED) {
        let (references, orders) = ([vr::A_F, reference(name)], [1, order.parse().unwrap()]);
        let values = [3.0, number(value)];
        let given = |i: Raw| i.set_input_derivatives(&references, &orders, &values);
        instance.refuses(given, expected);
    }
}
