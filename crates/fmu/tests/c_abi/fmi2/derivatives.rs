//! Directional derivatives, derivatives of inputs and of outputs with respect to time.

use super::{
    c,
    importer::{Instance, State, status_of},
};
use crate::importer::{Kind, vr};

#[test]
fn derivatives_of_states_are_those_of_the_equations_of_motion() {
    // m = 2, k = 8e5, c = 1 of both bodies; k12 = 4e6, c12 = 8, k3 = 5e12
    let mut instance = Instance::continuous(Kind::Lap, 1, &[("joint.k3_y", 5e12)]);
    let [ya, va, yb, vb]: [f64; 4] = [3e-4, 0.2, 1e-4, -0.1];
    assert_eq!(instance.set(&[vr::A_F, vr::B_F], &[30.0, -20.0]), c::OK);
    assert_eq!(instance.set_states(&[ya, va, yb, vb]), c::OK);
    let joint = 4e6 * (ya - yb) + 8.0 * (va - vb) + 5e12 * (ya - yb).powi(3);
    let of_a = (30.0 - 8e5 * ya - va - joint) / 2.0;
    let of_b = (-20.0 - 8e5 * yb - vb + joint) / 2.0;
    let found = instance.read(c::fmi2GetDerivatives, 4).unwrap();
    for (found, expected) in found.iter().zip([va, of_a, vb, of_b]) {
        assert!(
            (found - expected).abs() <= 1e-13 * expected.abs(),
            "{found} {expected}"
        );
    }
    assert_eq!(
        instance.read(c::fmi2GetContinuousStates, 4),
        Ok(vec![ya, va, yb, vb])
    );
    assert_eq!(
        instance.read(c::fmi2GetNominalsOfContinuousStates, 4),
        Ok(vec![1e-4, 0.1, 1e-4, 0.1])
    );
    // a state can be set as a variable, too
    assert_eq!(instance.set(&[vr::B_V, vr::A_Y], &[7.0, 2e-4]), c::OK);
    assert_eq!(
        instance.read(c::fmi2GetContinuousStates, 4),
        Ok(vec![2e-4, va, yb, 7.0])
    );
    assert_eq!(instance.read(c::fmi2GetDerivatives, 4).unwrap()[2], 7.0);
}

#[test]
fn the_jacobian_can_be_built_column_by_column() {
    // the example of FMI 2.0, 2.1.9: ∂ẋ/∂x of the linear lap, by hand
    let mut instance = Instance::continuous(Kind::Lap, 1, &[]);
    let derivatives = [vr::A_ACCELERATION, vr::B_ACCELERATION];
    let outputs = [vr::A_Y, vr::JOINT_F];
    for (known, of_a, of_b, joint) in [
        (vr::A_Y, -4.8e6 / 2.0, 4e6 / 2.0, 4e6),
        (vr::B_Y, 4e6 / 2.0, -4.8e6 / 2.0, -4e6),
        (vr::A_V, -9.0 / 2.0, 8.0 / 2.0, 8.0),
        (vr::B_V, 8.0 / 2.0, -9.0 / 2.0, -8.0),
        (vr::A_F, 0.5, 0.0, 0.0),
        (vr::B_F, 0.0, 0.5, 0.0),
        (vr::TIME, 0.0, 0.0, 0.0),
    ] {
        let column = instance.directional(&derivatives, &[known], &[1.0]);
        assert_eq!(column, Ok(vec![of_a, of_b]), "{known}");
        let own = f64::from(u8::from(known == vr::A_Y));
        let of_outputs = instance.directional(&outputs, &[known], &[2.0]);
        assert_eq!(of_outputs, Ok(vec![2.0 * own, 2.0 * joint]), "{known}");
    }
    // a linear combination
    let both = instance.directional(&[vr::JOINT_F], &[vr::A_Y, vr::B_V], &[1e-4, 0.5]);
    assert_eq!(both, Ok(vec![4e6 * 1e-4 - 8.0 * 0.5]));
    let message = instance.refused(|i| status_of(i.directional(&[vr::A_F], &[vr::A_Y], &[1.0])));
    assert!(
        message.contains("a.F is an input and no unknown"),
        "{message}"
    );
    let message =
        instance.refused(|i| status_of(i.directional(&[vr::JOINT_F], &[vr::POWER], &[1.0])));
    assert!(
        message.contains("power.dissipated is a calculated output and no known"),
        "{message}"
    );
    let message =
        instance.refused(|i| status_of(i.directional(&[vr::JOINT_F], &[vr::A_Y], &[f64::NAN])));
    assert!(
        message.contains("the seed of variable a.y is NaN"),
        "{message}"
    );
}

#[test]
fn derivatives_of_inputs_carry_the_inputs_through_the_step() {
    // the element follows its inputs: after the step they are where their Taylor polynomials lead
    let mut instance = Instance::stepping(Kind::Element, 1, &[]);
    assert_eq!(instance.set(&[vr::A_Y, vr::B_Y], &[1e-4, 5e-5]), c::OK);
    assert_eq!(
        instance.set_input_derivatives(
            &[vr::A_Y, vr::A_Y, vr::B_Y, vr::A_Y],
            &[1, 2, 1, 3],
            &[0.25, 4.0, -0.5, 12.0]
        ),
        c::OK
    );
    let h: f64 = 0.5;
    assert_eq!(instance.step(0.0, h), c::OK);
    let a = 1e-4 + 0.25 * h + 4.0 * h * h / 2.0 + 12.0 * h * h * h / 6.0;
    let b = 5e-5 - 0.5 * h;
    let [found_a, found_b, force] = instance.get([vr::A_Y, vr::B_Y, vr::JOINT_F]);
    assert!((found_a - a).abs() < 1e-15 && (found_b - b).abs() < 1e-15);
    assert!((force - 4e6 * (a - b)).abs() < 1e-8);
    // they are for one step only
    assert_eq!(instance.step(h, h), c::OK);
    assert_eq!(instance.get([vr::A_Y, vr::B_Y]), [found_a, found_b]);
}

#[test]
fn a_lap_under_a_ramp_follows_the_equations_of_motion() {
    // a ramp of the load given as derivative, against the same ramp in steps of one hundredth
    let ramp = 2e5;
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let mut fine = Instance::stepping(Kind::Lap, 1, &[]);
    let (h, parts) = (1e-3, 100);
    for n in 0..20 {
        let t = f64::from(n) * h;
        assert_eq!(instance.set(&[vr::A_F], &[ramp * t]), c::OK);
        assert_eq!(
            instance.set_input_derivatives(&[vr::A_F], &[1], &[ramp]),
            c::OK
        );
        assert_eq!(instance.step(t, h), c::OK);
        for part in 0..parts {
            let (t, h) = (
                t + f64::from(part) * h / f64::from(parts),
                h / f64::from(parts),
            );
            assert_eq!(fine.set(&[vr::A_F], &[ramp * (t + h / 2.0)]), c::OK);
            assert_eq!(fine.step(t, h), c::OK);
        }
    }
    let [y, held] = [&mut instance, &mut fine].map(|i| i.get([vr::A_Y])[0]);
    assert!(
        y.abs() > 1e-4 && (y - held).abs() < 1e-5 * y.abs(),
        "{y} {held}"
    );
}

#[test]
fn each_derivative_of_a_load_gains_an_order() {
    const OMEGA: f64 = 300.0;
    /// Displacement of body b under a sine of which the importer tells this many derivatives.
    fn displacement(orders: usize, steps: u32) -> f64 {
        let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
        let h = 0.02 / f64::from(steps);
        for n in 0..steps {
            let t = f64::from(n) * h;
            let (sin, cos) = (OMEGA * t).sin_cos();
            let load = 1e3;
            let derivatives = [
                load * OMEGA * cos,
                -load * OMEGA.powi(2) * sin,
                -load * OMEGA.powi(3) * cos,
            ];
            assert_eq!(instance.set(&[vr::B_F], &[load * sin]), c::OK);
            assert_eq!(
                instance.set_input_derivatives(
                    &[vr::B_F; 3][..orders],
                    &[1, 2, 3][..orders],
                    &derivatives[..orders],
                ),
                c::OK
            );
            assert_eq!(instance.step(t, h), c::OK);
        }
        instance.get([vr::B_Y])[0]
    }
    let exact = displacement(3, 4000);
    for orders in 0..=3 {
        let [coarse, fine] = [40, 80].map(|steps| (displacement(orders, steps) - exact).abs());
        // the load is followed to the order n, which leaves an error of the order n + 1
        let gain = f64::from(2_u32.pow(orders as u32 + 1));
        assert!(
            coarse / fine > 0.8 * gain && coarse < 0.1 * exact.abs(),
            "{orders}: {coarse:e} {fine:e} of {exact:e}"
        );
    }
}

#[test]
fn derivatives_of_outputs_are_rates_of_change() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    assert_eq!(instance.set(&[vr::A_F], &[50.0]), c::OK);
    assert_eq!(instance.step(0.0, 1e-3), c::OK);
    let [v_a, v_b, acceleration_a, acceleration_b] =
        instance.get([vr::A_V, vr::B_V, vr::A_ACCELERATION, vr::B_ACCELERATION]);
    let rates = instance
        .output_derivatives(&[vr::A_Y, vr::A_V, vr::JOINT_F], &[1, 1, 1])
        .unwrap();
    assert_eq!(rates[..2], [v_a, acceleration_a]);
    let of_joint = 4e6 * (v_a - v_b) + 8.0 * (acceleration_a - acceleration_b);
    assert!((rates[2] - of_joint).abs() <= 1e-13 * of_joint.abs());
    // FMI 2.0, 4.2.1: what is of higher order than the slave knows is zero
    assert_eq!(
        instance.output_derivatives(&[vr::A_Y, vr::A_Y, vr::A_V], &[2, 1, 7]),
        Ok(vec![0.0, v_a, 0.0])
    );
    for (reference, order, expected) in [
        (
            vr::A_Y,
            0,
            "order of the derivative of variable a.y is 0, expected 1",
        ),
        (
            vr::A_Y,
            -1,
            "order of the derivative of variable a.y is -1, expected 1",
        ),
        (vr::A_F, 1, "variable a.F is an input and no output"),
        (vr::A_F, 2, "variable a.F is an input and no output"),
        (vr::NONE, 1, "value reference 52 does not exist"),
    ] {
        let message = instance
            .refused(|i| status_of(i.output_derivatives(&[vr::A_V, reference], &[1, order])));
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn derivatives_of_anything_but_inputs_are_refused() {
    let mut instance = Instance::new(c::CO_SIMULATION, Kind::Lap, 1, &[]);
    instance.go_to(State::Step);
    for (reference, order, value, expected) in [
        (vr::A_Y, 1, 1.0, "variable a.y is a state and no input"),
        (
            vr::K_YY,
            1,
            1.0,
            "variable joint.k_yy is a parameter and no input",
        ),
        (vr::NONE, 1, 1.0, "value reference 52 does not exist"),
        (
            vr::B_F,
            0,
            1.0,
            "order of the derivative of variable b.F is 0, expected 1 to 3",
        ),
        (
            vr::B_F,
            4,
            1.0,
            "order of the derivative of variable b.F is 4, expected 1 to 3",
        ),
        (vr::B_F, 1, f64::NAN, "variable b.F cannot be set to NaN"),
    ] {
        let message = instance.refused(|i| {
            i.set_input_derivatives(&[vr::A_F, reference], &[1, order], &[3.0, value])
        });
        assert!(message.contains(expected), "{message}");
    }
    // an input that would overflow on the way: the step is refused, not the derivative
    assert_eq!(
        instance.set_input_derivatives(&[vr::A_F], &[1], &[f64::MAX]),
        c::OK
    );
    let message = instance.refused(|i| i.step(0.0, 1e3));
    assert!(message.contains("input a.F overflows"), "{message}");
}
