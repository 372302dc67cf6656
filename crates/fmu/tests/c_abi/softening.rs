//! A softening joint tells how far it holds, warns once before that, and gives way beyond.

use crate::{
    c,
    importer::{Instance, Kind, vr},
};

/// k = 8e5, k12 = 4e6, k3 = −1e12: the joint holds up to √((k + 2 k12)/(−2 k3)) = 2.0976 mm apart.
const SOFTENING: [(&str, f64); 1] = [("joint.k3_y", -1e12)];

fn amplitude() -> f64 {
    f64::sqrt(8.8e6 / 2e12)
}

#[test]
fn the_escape_amplitude_follows_the_parameters() {
    let mut instance = Instance::new(Kind::Lap, 1, &SOFTENING);
    assert_eq!(instance.get([vr::ESCAPE_Y]), [amplitude()]);
    c::ok(instance.enter_initialization(0.0, None));
    c::ok(instance.set(&[vr::K3_Y], &[-4e12]));
    let halved = instance.get([vr::ESCAPE_Y])[0];
    assert!((halved / amplitude() - 0.5).abs() < 1e-15);
    // what the fifth order holds never lets go: the largest double
    c::ok(instance.set(&[vr::K5_Y], &[1e19]));
    assert_eq!(instance.get([vr::ESCAPE_Y]), [f64::MAX]);
    // 4.4e6 − 4e12 u + 5e17 u² = 0
    c::ok(instance.set(&[vr::K5_Y], &[5e17]));
    let [found] = instance.get([vr::ESCAPE_Y]);
    let squared = (4e12 - f64::sqrt(16e24 - 4.0 * 5e17 * 4.4e6)) / (2.0 * 5e17);
    assert!((found / squared.sqrt() - 1.0).abs() < 1e-12);
    instance.refuses(
        |i| i.set(&[vr::ESCAPE_Y], &[1.0]),
        "joint.escape_amplitude_y is a calculated parameter",
    );
    c::ok(instance.exit_initialization());
    assert_eq!(instance.get([vr::ESCAPE_Y]), [found]);

    let linear = Instance::stepping(Kind::Lap, 2, &[]);
    assert_eq!(
        linear.get([vr::ESCAPE_Y, vr::ESCAPE_THETA]),
        [f64::MAX, f64::MAX]
    );
    // without supports, the joint's own springs: √(k12/(−k3)) = 2 mm
    let element = Instance::stepping(Kind::Element, 1, &SOFTENING);
    assert!((element.get([vr::ESCAPE_Y])[0] - 2e-3).abs() < 1e-18);
}

#[test]
fn the_escape_amplitude_is_an_unknown_of_the_initialization() {
    let instance = Instance::new(Kind::Lap, 1, &SOFTENING);
    c::ok(instance.enter_initialization(0.0, None));
    // r = √((k12 + k/2)/(−k3)) with equal supports k: dr/dk12 = r/(2 (k12 + k/2)), dr/dk_a = that/4, dr/dk3 = −r/(2 k3)
    let r = amplitude();
    const A_K_Y: u32 = 27;
    for (known, expected) in [
        (vr::K_YY, r / (2.0 * 4.4e6)),
        (A_K_Y, r / (8.0 * 4.4e6)),
        (vr::K3_Y, r / 2e12),
        (vr::K5_Y, r.powi(3) / 2e12),
        (vr::C_YY, 0.0),
        (vr::A_Y, 0.0),
    ] {
        let found = instance.directional(&[vr::ESCAPE_Y], &[known], &[1.0]);
        let found = found.unwrap()[0];
        assert!(
            (found - expected).abs() <= 1e-14 * expected,
            "{known}: {found:e} {expected:e}"
        );
        let adjoint = instance.adjoint(&[vr::ESCAPE_Y, vr::JOINT_F], &[known], &[1.0, 0.0]);
        assert_eq!(adjoint, Ok(vec![found]));
    }
    c::ok(instance.exit_initialization());
    let refused = instance.directional(&[vr::ESCAPE_Y], &[vr::K_YY], &[1.0]);
    assert_eq!(refused, Err(c::ERROR));
}

/// A lap that starts from rest with the bodies moving apart, so fast that they come to 90 % of the amplitude.
fn swinging(instance: &mut Instance) {
    // ½ μ v² = ½ k r² − ¼ k3 r⁴ with μ = m/2 = 1 and k = k12 + k/2
    let r = 0.9 * amplitude();
    let speed = f64::sqrt(4.4e6 * r.powi(2) - 0.5e12 * r.powi(4));
    c::ok(instance.set(&[vr::A_V, vr::B_V], &[0.5 * speed, -0.5 * speed]));
    instance.initialize(0.0, None);
}

/// Steps until a load tears the joint; status of each, and |a.y − b.y| after it.
fn torn(instance: &mut Instance, substeps: u32) -> Vec<(i32, f64)> {
    let h = 2e-5 * f64::from(substeps);
    let mut seen = Vec::new();
    for n in 0..5000 / substeps {
        if n == 4500 / substeps {
            c::ok(instance.set(&[vr::A_F, vr::B_F], &[1e5, -1e5]));
        }
        let (status, _) = instance.step_to(h * f64::from(n), h);
        let [a, b] = instance.get([vr::A_Y, vr::B_Y]);
        seen.push((status, (a - b).abs()));
        if status == c::ERROR {
            break;
        }
    }
    seen
}

#[test]
fn a_lap_warns_once_at_eighty_per_cent_and_fails_beyond() {
    // a single Runge–Kutta step, few, and so many that the joint is checked on the way
    let mut undamped = SOFTENING.to_vec();
    undamped.extend([("joint.c_yy", 0.0), ("a.c_y", 0.0), ("b.c_y", 0.0)]);
    for substeps in [1, 5, 50] {
        let mut instance = Instance::new(Kind::Lap, 1, &undamped);
        for round in 0..2 {
            swinging(&mut instance);
            instance.take_log();
            let seen = torn(&mut instance, substeps);
            // past 80 % many times
            let past = |(_, r): &(i32, f64)| *r > 0.8 * amplitude();
            assert!(seen.iter().filter(|step| past(step)).count() > 10);
            let warned: Vec<usize> = (0..seen.len())
                .filter(|&n| seen[n].0 == c::WARNING)
                .collect();
            let first = seen.iter().position(past).unwrap();
            assert_eq!(warned, [first], "{substeps} substeps, {round}");
            let failed = seen.iter().filter(|(status, _)| *status == c::ERROR);
            assert_eq!(failed.count(), 1);
            assert!(seen.iter().all(|(_, r)| *r <= amplitude()));
            let log = instance.take_log();
            let warnings: Vec<&str> = log
                .iter()
                .filter(|message| message.category == "logStatusWarning")
                .map(|message| message.text.as_str())
                .collect();
            assert_eq!(warnings.len(), 1);
            assert!(
                warnings[0].starts_with("fmi3DoStep: a.y - b.y = ")
                    && warnings[0].contains(&format!(
                        "is past 80 per cent of joint.escape_amplitude_y = {:e} m",
                        amplitude()
                    )),
                "{warnings:?}"
            );
            // after a reset it warns again
            c::ok(instance.reset());
        }
    }
}

#[test]
fn tuning_a_parameter_does_not_warn_again() {
    let mut instance = Instance::new(Kind::Lap, 1, &SOFTENING);
    swinging(&mut instance);
    let mut warnings = 0;
    for n in 0..200 {
        c::ok(instance.set(&[vr::C_YY], &[8.0 + 0.001 * f64::from(n)]));
        let (status, _) = instance.step_to(1e-4 * f64::from(n), 1e-4);
        assert!(status == c::OK || status == c::WARNING);
        warnings += i32::from(status == c::WARNING);
    }
    assert_eq!(warnings, 1);
}

#[test]
fn an_element_warns_once_and_goes_on() {
    // nothing is integrated that could run away: beyond 2 mm the load pulls the sides apart
    let mut instance = Instance::stepping(Kind::Element, 1, &SOFTENING);
    let mut statuses = Vec::new();
    for (n, r) in [1.0e-3, 1.7e-3, 1.9e-3, 2.5e-3, 0.0, 1.9e-3]
        .into_iter()
        .enumerate()
    {
        c::ok(instance.set(&[vr::B_Y], &[r]));
        statuses.push(instance.step(1e-3 * n as f64, 1e-3));
        let load = instance.get([vr::JOINT_F])[0];
        let expected = -4e6 * r + 1e12 * r.powi(3);
        assert!((load - expected).abs() <= 1e-15 * 4e6 * r);
    }
    assert_eq!(statuses, [c::OK, c::WARNING, c::OK, c::OK, c::OK, c::OK]);
    let log = instance.take_log();
    assert_eq!(
        log.iter()
            .filter(|message| message
                .text
                .contains("80 per cent of joint.escape_amplitude_y = 2e-3 m"))
            .count(),
        1,
        "{log:?}"
    );
}

#[test]
fn damping_that_turns_negative_is_told_once() {
    // 8 − 2e6 u: past 2 mm
    let mut instance = Instance::stepping(Kind::Element, 1, &[("joint.c2_y", -2e6)]);
    let mut statuses = Vec::new();
    for (n, r) in [1.9e-3, 2.1e-3, -2.5e-3].into_iter().enumerate() {
        c::ok(instance.set(&[vr::A_Y, vr::A_V], &[r, 1.0]));
        statuses.push(instance.step(1e-3 * n as f64, 1e-3));
        let power = instance.get([vr::POWER])[0];
        assert!((power - (8.0 - 2e6 * r * r)).abs() < 1e-13);
    }
    assert_eq!(statuses, [c::OK, c::WARNING, c::OK]);
    let log = instance.take_log();
    assert!(
        log.iter().any(|message| message.text.contains(
            "is past 2e-3 m, beyond which the joint's damping is not positive semidefinite"
        )),
        "{log:?}"
    );
}
