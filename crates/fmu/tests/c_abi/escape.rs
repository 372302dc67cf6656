//! Motion that leaves what the model holds for: reported with variable and time, and the last point kept.

use crate::{
    c,
    equations::{EQUATIONS, Equations, STATES},
    importer::{Instance, Kind, vr},
};

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
        let (status, last) = instance.step_to(t, 1e-3);
        if status == c::ERROR {
            assert_eq!(last, t);
            break before;
        }
        t += 1e-3;
        force += 10.0;
        c::ok(instance.set(&[vr::A_F, vr::B_F], &[force, -force]));
    };
    let message = instance.error();
    c::tells(&message, "fmi3DoStep: a.y - b.y = ", "softening joint");
    c::tells(&message, "", &format!("is past {amplitude:e} m"));
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
    c::ok(instance.set(&STATES, &start));
    c::ok(instance.set(&[vr::A_F, vr::B_F], &back.force));
    instance.initialize(0.0, None);
    assert_eq!(instance.step_to(0.0, duration), (c::ERROR, 0.0));
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
    c::ok(instance.set(&[vr::B_M], &[f64::MAX]));
    assert_eq!(instance.step_to(0.0, 1e-3), (c::ERROR, 0.0));
    let message = instance.error();
    assert!(
        message.contains("state ") && message.contains("is no finite number at t = 0.000"),
        "{message}"
    );
    assert_eq!(instance.get([vr::B_THETA, vr::B_OMEGA, vr::TIME]), [0.0; 3]);

    // a hardening joint under an absurd load
    let mut instance = Instance::stepping(Kind::Lap, 1, &[("joint.k3_y", 1e20)]);
    c::ok(instance.set(&[vr::B_F], &[1e12]));
    let mut t = 0.0;
    while instance.step(t, 1e-3) == c::OK {
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
