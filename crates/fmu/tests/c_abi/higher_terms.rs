//! Stiffness of fifth and seventh order, and damping that depends on the amplitude.

use crate::{
    c,
    equations::assert_close_at,
    importer::{Instance, Kind, vr},
};

/// k3 = 5e12 and these, with k = 4e6, c = 8.
const TERMS: [(&str, f64); 5] = [
    ("joint.k3_y", 5e12),
    ("joint.k5_y", -2e19),
    ("joint.k7_y", 6e25),
    ("joint.c2_y", 3e7),
    ("joint.c4_y", -4e14),
];

#[test]
fn an_element_has_the_load_the_energy_and_the_derivatives_of_its_law() {
    let [k3, k5, k7, c2, c4] = TERMS.map(|(_, value)| value);
    let instance = Instance::stepping(Kind::Element, 1, &TERMS);
    let (y_a, y_b, v_a, v_b) = (4e-4, 1e-4, 0.2, 0.05);
    let motion = [vr::A_Y, vr::B_Y, vr::A_V, vr::B_V];
    c::ok(instance.set(&motion, &[y_a, y_b, v_a, v_b]));
    let (r, v): (f64, f64) = (y_a - y_b, v_a - v_b);
    let spring = 4e6 * r + k3 * r.powi(3) + k5 * r.powi(5) + k7 * r.powi(7);
    let damper = 8.0 + c2 * r.powi(2) + c4 * r.powi(4);
    let energy =
        4e6 * r.powi(2) / 2.0 + k3 * r.powi(4) / 4.0 + k5 * r.powi(6) / 6.0 + k7 * r.powi(8) / 8.0;
    let outputs = [vr::A_F, vr::B_F, vr::JOINT_F, vr::ENERGY, vr::POWER];
    let found = instance.get(outputs);
    let on_b = spring + damper * v;
    let expected = [-on_b, on_b, on_b, energy, damper * v * v];
    assert_close_at("outputs", &found, &expected, 4e-15);
    // every term has its share
    assert!((spring / (4e6 * r) - 1.0).abs() > 0.05 && (damper / 8.0 - 1.0).abs() > 0.05);

    let tangent = 4e6
        + 3.0 * k3 * r.powi(2)
        + 5.0 * k5 * r.powi(4)
        + 7.0 * k7 * r.powi(6)
        + (2.0 * c2 * r + 4.0 * c4 * r.powi(3)) * v;
    let by_displacement = (2.0 * c2 * r + 4.0 * c4 * r.powi(3)) * v * v;
    for (known, on_b, energy, power) in [
        (vr::A_Y, tangent, spring, by_displacement),
        (vr::B_Y, -tangent, -spring, -by_displacement),
        (vr::A_V, damper, 0.0, 2.0 * damper * v),
        (vr::B_V, -damper, 0.0, -2.0 * damper * v),
        (vr::K5_Y, r.powi(5), r.powi(6) / 6.0, 0.0),
        (vr::K7_Y, r.powi(7), r.powi(8) / 8.0, 0.0),
        (vr::C2_Y, r.powi(2) * v, 0.0, r.powi(2) * v * v),
        (vr::C4_Y, r.powi(4) * v, 0.0, r.powi(4) * v * v),
    ] {
        let found = instance.directional(&outputs, &[known], &[1.0]).unwrap();
        let expected = [-on_b, on_b, on_b, energy, power];
        assert_close_at(format!("derivative by {known}"), &found, &expected, 4e-15);
    }
}

#[test]
fn terms_of_higher_order_are_tuned_between_steps() {
    let mut instance = Instance::stepping(Kind::Lap, 1, &[]);
    let mut other = Instance::stepping(Kind::Lap, 1, &TERMS);
    let names = [vr::K3_Y, vr::K5_Y, vr::K7_Y, vr::C2_Y, vr::C4_Y];
    let values = TERMS.map(|(_, value)| value);
    c::ok(instance.set(&names, &values));
    let mut plain = Instance::stepping(Kind::Lap, 1, &TERMS[..1]);
    let loads = [vr::A_F, vr::B_F];
    for n in 0..200 {
        let t = 1e-4 * f64::from(n);
        let load = 500.0 * (3000.0 * t).sin();
        for instance in [&mut instance, &mut other, &mut plain] {
            c::ok(instance.set(&loads, &[load, -load]));
            c::ok(instance.step(t, 1e-4));
        }
    }
    let state = [vr::A_Y, vr::A_V, vr::B_Y, vr::B_V];
    assert_eq!(instance.get(state), other.get(state));
    let [with, without] = [other.get([vr::A_Y]), plain.get([vr::A_Y])];
    assert!((with[0] / without[0] - 1.0).abs() > 1e-3);
}
