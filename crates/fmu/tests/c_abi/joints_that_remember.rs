//! Model Exchange of joints that remember: events where they turn and slip, and inner states.

use crate::{
    c,
    importer::{Folder, Instance, Kind, Request, State, start_text, vr},
    raw::{BOTH, FmiVersion, Interface},
    rows::reference,
};

/// h/k of the slider, m.
const SPAN: f64 = 2e-5;

/// An element with a law beside its linear one, in Continuous-Time Mode.
fn element(version: FmiVersion, law: &str, parameters: &[(&str, f64)]) -> Instance {
    let mut text = start_text(Kind::Element, 1, &[]);
    let token = text.find("token").unwrap();
    let end = token + text[token..].find('\n').unwrap() + 1;
    text.insert_str(end, &format!("laws {law}\n"));
    for (name, value) in parameters {
        text += &format!("joint.{name}_y {value}\n");
    }
    let folder = Folder::with_start(&text);
    let request = Request {
        version,
        interface: Interface::ModelExchange,
        ..Request::of(&folder)
    };
    let mut instance = request.instantiate().unwrap();
    instance.go_to(State::Continuous);
    instance
}

fn assert_indicators(instance: &Instance, expected: [f64; 2]) {
    let found = instance.try_indicators(2).unwrap();
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs().max(1e-4),
            "{found:e} {expected:e}"
        );
    }
}

#[test]
fn an_indicator_that_has_fallen_stays_until_the_event() {
    for version in BOTH {
        let instance = element(
            version,
            "jenkins",
            &[("jenkins_k", 1e6), ("jenkins_h", 20.0)],
        );
        let margin = 1e-10 + 1e-7 * 0.1;
        let event = || {
            c::ok(instance.enter_event());
            c::ok(instance.update());
            c::ok(instance.enter_continuous());
        };
        // at rest none is zero
        assert_indicators(&instance, [1e-10, 1.0]);
        // away, and the slip is ahead
        c::ok(instance.set(&[vr::A_Y, vr::A_V], &[1e-5, 0.1]));
        c::ok(instance.complete_step());
        assert_indicators(&instance, [0.1 + margin, SPAN - 1e-5]);
        // beyond it
        c::ok(instance.set(&[vr::A_Y], &[3e-5]));
        for _ in 0..2 {
            assert_indicators(&instance, [0.1 + margin, SPAN - 3e-5]);
            c::ok(instance.complete_step());
        }
        event();
        assert_indicators(&instance, [0.1 + margin, 1.0]);
        // it slips on and turns
        c::ok(instance.set(&[vr::A_Y, vr::A_V], &[5e-5, -0.04]));
        for _ in 0..2 {
            assert_indicators(&instance, [margin - 0.04, 1.0]);
            c::ok(instance.complete_step());
        }
        event();
        assert_indicators(&instance, [0.04 + margin, 2.0 * SPAN]);
        assert_eq!(instance.try_indicators(1), Err(c::ERROR));
    }
}

#[test]
fn importers_without_events_commit_with_their_steps() {
    for version in BOTH {
        let instance = element(
            version,
            "jenkins",
            &[("jenkins_k", 1e6), ("jenkins_h", 20.0)],
        );
        let slider = reference("joint.jenkins_slider_y");
        // 2 h/k and more each way
        for (y, expected) in [(3e-5, 1e-5), (-3e-5, -1e-5), (1e-6, -1e-5), (5e-5, 3e-5)] {
            c::ok(instance.set(&[vr::A_Y, vr::A_V], &[y, y]));
            c::ok(instance.complete_step());
            let [found] = instance.get([slider]);
            assert!((found - expected).abs() < 1e-18, "{found:e} {expected:e}");
        }
    }
}

#[test]
fn bristles_are_a_state() {
    let parameters = [
        ("lugre_s0", 1e5),
        ("lugre_s1", 0.0),
        ("lugre_s2", 0.0),
        ("lugre_fc", 1.0),
        ("lugre_fs", 1.0),
        ("lugre_vs", 1e-3),
    ];
    for version in BOTH {
        let instance = element(version, "lugre", &parameters);
        assert_eq!(instance.try_indicators(0), Ok(vec![]));
        assert_eq!(instance.try_nominals(1), Ok(vec![1e-4]));
        assert_eq!(instance.states(1), [0.0]);
        c::ok(instance.set_states(&[4e-6]));
        c::ok(instance.set(&[vr::A_V], &[-0.02]));
        // ż = v − σ₀ |v| z/g with g = 1
        let rate = -0.02 - 1e5 * 0.02 * 4e-6;
        let [state, derivative] = ["joint.lugre_z_y", "joint.lugre_zdot_y"].map(reference);
        assert!((instance.derivatives(1)[0] - rate).abs() < 1e-16);
        assert_eq!(
            instance.get([state, derivative]),
            [4e-6, instance.derivatives(1)[0]]
        );
        // k = 4e6, c = 8 beside σ₀ z
        let [load] = instance.get([vr::B_F]);
        assert!((load - (1e5 * 4e-6 - 8.0 * 0.02)).abs() < 1e-13, "{load}");
        // a completed step leaves it where the importer has it
        c::ok(instance.complete_step());
        assert_eq!(instance.states(1), [4e-6]);
        assert_eq!(instance.get([vr::B_F]), [load]);
    }
}
