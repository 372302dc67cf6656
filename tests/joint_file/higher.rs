//! Terms of higher order: read, written, refused where they do not fit.

use bolted_joint::joint::JointFile;
use bolted_joint_dynamics::Polynomial;
use bolted_joint_testing::has;

use crate::{GOOD, refusal};

const DAMPING: &str = "\"damping\": [[10.83, -0.83], [-0.83, 0.083]]\n";

/// `GOOD` with this text as `joint.higher`.
fn with(higher: &str) -> Result<JointFile, String> {
    assert!(GOOD.contains(DAMPING));
    let with = format!("{},\n\"higher\": {higher}\n", DAMPING.trim_end());
    let text = GOOD.replacen(DAMPING, &with, 1);
    JointFile::from_json(&text, "m10.joint.json").map_err(|refused| refused.to_string())
}

#[test]
fn terms_of_higher_order_are_part_of_the_law() {
    let file = with(
        r#"{ "quintic": [-1e16, 2e8], "damping_quartic": [3e12, 0], "amplitude": [1e-3, 0.01] }"#,
    )
    .unwrap();
    let terms = file.joint.law::<2>().unwrap().polynomials();
    let expected = [
        Polynomial::with(&[0.0, -1e16], &[0.0, 3e12]),
        Polynomial::with(&[0.0, 2e8], &[]),
    ];
    assert_eq!(terms, expected);
    let written = file.to_json().unwrap();
    assert_eq!(JointFile::from_json(&written, "").unwrap(), file);
    assert!(written.contains("\"damping_quartic\": [") && !written.contains("septic"));
    // without any of them
    let file = with("{}").unwrap();
    assert!(file.joint.law::<2>().unwrap().is_linear());
    assert!(!file.joint.has_terms_of_higher_order());
    assert!(file.passivity().is_passive() && file.passivity().matrices.len() == 2);
}

#[test]
fn terms_that_do_not_fit_are_refused_by_their_key() {
    #[rustfmt::skip]
    let cases = [
        (r#"{ "quintic": [1e16] }"#, ["joint.higher.quintic: found 1 entry", "expected 2"]),
        (r#"{ "septic": [1, 2, 3] }"#, ["joint.higher.septic: found 3 entries", "expected 2"]),
        (r#"{ "amplitude": [1e-3, 0] }"#, ["joint.higher.amplitude[1]: found 0.0", "greater than zero"]),
        (r#"{ "amplitude": [-1e-3, 1] }"#, ["joint.higher.amplitude[0]: found -0.001", "greater than zero"]),
        (r#"{ "quartic": [1, 1] }"#,
         ["joint.higher.quartic: unknown key", "quintic, septic, damping_quadratic, damping_quartic, amplitude"]),
        (r#"{ "damping_quadratic": 5 }"#, ["joint.higher.damping_quadratic", "found 5, expected a list"]),
    ];
    for (higher, fragments) in cases {
        has(&with(higher).unwrap_err(), &fragments);
    }
}

#[test]
fn a_table_over_the_preload_has_no_terms_of_higher_order() {
    let message = refusal(
        "\"stiffness\"",
        r#""higher": { "quintic": [1e16, 0] }, "over_preload": { "preload": [1, 2], "nominal": 1,
           "stiffness": [[[1, 0], [0, 1]], [[1, 0], [0, 1]]], "damping": [[[1, 0], [0, 1]], [[1, 0], [0, 1]]] },
           "stiffness""#,
    );
    let beside = "joint.higher: found beside joint.over_preload";
    has(&message, &[beside, "take one of them out"]);
}

#[test]
fn damping_that_turns_negative_within_its_amplitude_is_active() {
    // y alone: 10.83 − 0.83²/0.083 = 2.53 = 2.53e6 u at 1 mm
    let passive = with(r#"{ "damping_quadratic": [-2.53e6, 0], "amplitude": [0.99e-3, 0.1] }"#);
    assert!(passive.unwrap().passivity().is_passive());
    for higher in [
        r#"{ "damping_quadratic": [-2.53e6, 0], "amplitude": [1.01e-3, 0.1] }"#,
        r#"{ "damping_quadratic": [-2.53e6, 0] }"#,
    ] {
        let passivity = with(higher).unwrap().passivity();
        let active: Vec<String> = passivity.active().map(ToString::to_string).collect();
        assert_eq!(active.len(), 1, "{active:?}");
        has(
            &active[0],
            &["joint.higher beyond y = 1.0000e-3 m is active"],
        );
    }
}
