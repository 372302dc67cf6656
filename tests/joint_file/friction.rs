//! Laws with parameters of their own: read, written, refused where they do not fit.

use bolted_joint::joint::{JointFile, JointProblem};
use bolted_joint_dynamics::{JointLaw, law::DOF_AT_REST};

use crate::GOOD;

const DAMPING: &str = "\"damping\": [[10.83, -0.83], [-0.83, 0.083]]\n";

/// `GOOD` with this text as `joint.friction`.
fn with(friction: &str) -> Result<JointFile, String> {
    assert!(GOOD.contains(DAMPING));
    let text = GOOD.replacen(
        DAMPING,
        &format!("{},\n\"friction\": {friction}\n", DAMPING.trim_end()),
        1,
    );
    JointFile::from_json(&text, "m10.joint.json").map_err(|refused| refused.to_string())
}

const ON_Y: &str = r#"{ "dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": 300.0 }"#;

#[test]
fn a_law_on_a_dof_is_part_of_the_joint() {
    let file = with(&format!("[{ON_Y}]")).unwrap();
    let law = file.joint.law::<2>().unwrap();
    assert!(law.has_memory() && law.on[0].have_memory() && !law.on[1].have_memory());
    assert!(!law.is_linear() && !file.joint.is_linear());
    // its keys may stand in any order
    let turned = r#"[{ "slip_force": 300, "stiffness": 1e6, "law": "jenkins", "dof": "y" }]"#;
    assert_eq!(with(turned).unwrap(), file);
    let written = file.to_json().unwrap();
    assert_eq!(JointFile::from_json(&written, "").unwrap(), file);
    let lines: Vec<&str> = written.lines().map(str::trim).collect();
    let place = lines.iter().position(|line| *line == "\"dof\": \"y\",");
    let entry = &lines[place.unwrap()..][..4];
    assert_eq!(
        entry[1..],
        [
            "\"law\": \"jenkins\",",
            "\"stiffness\": 1000000.0,",
            "\"slip_force\": 300.0"
        ]
    );
    // without any of them
    assert!(with("[]").unwrap().joint.is_linear());
    assert!(!with("[]").unwrap().to_json().unwrap().contains("friction"));
}

/// `GOOD` with a law on y, and these deviations of laws.
fn with_deviations(deviations: &str) -> Result<JointFile, String> {
    let text = with(&format!("[{ON_Y}]")).unwrap().to_json().unwrap();
    let known = format!(
        r#""uncertainty": {{ "basis": "made up", "standard_deviation": {{ "stiffness": [[1, 1], [1, 1]], "damping": [[1, 1], [1, 1]],
        "friction": {deviations} }} }}, "joint""#
    );
    let text = text.replacen("\"joint\"", &known, 1);
    JointFile::from_json(&text, "m10.joint.json").map_err(|refused| refused.to_string())
}

#[test]
fn numbers_of_laws_may_have_deviations() {
    let own = r#"[{ "dof": "y", "law": "jenkins", "stiffness": 2e4, "slip_force": 0 }]"#;
    let file = with_deviations(own).unwrap();
    let known = &file.uncertainty.as_ref().unwrap().standard_deviation;
    assert_eq!(known.friction[0].parameters, [2e4, 0.0]);
    let written = file.to_json().unwrap();
    assert_eq!(JointFile::from_json(&written, "").unwrap(), file);
    // of other laws than the joint has, or below zero
    for (from, to, says) in [
        (
            "\"y\"",
            "\"theta\"",
            "found \"jenkins on theta\", expected the laws of the joint in their order, \"jenkins on y\"",
        ),
        (
            "2e4",
            "-2e4",
            "uncertainty.standard_deviation.friction[0].stiffness: found -20000",
        ),
    ] {
        let refused = with_deviations(&own.replace(from, to)).unwrap_err();
        assert!(refused.contains(says), "{refused}");
    }
}

#[test]
fn laws_that_do_not_fit_are_refused_by_their_key() {
    for (friction, fragments) in [
        (
            r#"[{ "dof": "y", "law": "coulomb", "stiffness": 1e6, "slip_force": 300 }]"#,
            [
                "joint.friction[0].law: found \"coulomb\"",
                "expected one of jenkins, iwan",
            ],
        ),
        (
            r#"[{ "dof": "z", "law": "jenkins", "stiffness": 1e6, "slip_force": 300 }]"#,
            [
                "joint.friction[0].dof: found \"z\"",
                "expected one of joint.dofs = [\"y\", \"theta\"]",
            ],
        ),
        (
            r#"[{ "dof": "w", "law": "jenkins", "stiffness": 1e6, "slip_force": 300 }]"#,
            [
                "joint.friction[0].dof",
                "`w`, expected one of `y`, `theta`, `x`",
            ],
        ),
        (
            r#"[{ "dof": "y", "law": "jenkins", "stifness": 1e6, "slip_force": 300 }]"#,
            [
                "joint.friction[0].stifness: unknown key, did you mean \"stiffness\"?",
                "expected one of dof, law, stiffness, slip_force",
            ],
        ),
        (
            r#"[{ "dof": "y", "law": "jenkins", "stiffness": 1e6 }]"#,
            ["joint.friction[0].slip_force: not found", "add it"],
        ),
        (
            r#"[{ "law": "jenkins", "stiffness": 1e6, "slip_force": 300 }]"#,
            ["joint.friction[0].dof: not found", "add it"],
        ),
        (
            r#"[{ "dof": "y", "law": "jenkins", "stiffness": "1e6", "slip_force": 300 }]"#,
            ["joint.friction[0].stiffness", "expected a number"],
        ),
        (
            r#"[{ "dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": -3 }]"#,
            ["joint.friction[0].slip_force: found -3.0", "zero or more"],
        ),
        (
            r#"[{ "dof": "y", "dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": 3 }]"#,
            ["joint.friction[0].dof: found twice", "take one of them out"],
        ),
        (r#"{ "dof": "y" }"#, ["joint.friction", "expected a list"]),
        (r#"["y"]"#, ["joint.friction[0]", "expected an object"]),
    ] {
        let message = with(friction).unwrap_err();
        for fragment in fragments {
            assert!(message.contains(fragment), "{fragment}: {message}");
        }
    }
}

const IWAN: &str = r#""dof": "y", "law": "iwan", "slip_force": 4000, "stiffness": 1.5e7, "exponent": -0.3, "ratio": 0.5"#;

const VALANIS: &str = r#""dof": "y", "law": "valanis", "stiffness": 1000, "slip_stiffness": 100, "slip_force": 5, "kappa": 0.5"#;
const DAHL: &str = r#""dof": "y", "law": "dahl", "stiffness": 1e5, "slip_force": 2"#;
const LUGRE: &str = r#""dof": "y", "law": "lugre", "stiffness": 1e5, "bristle_damping": 300, "damping": 150,
    "slip_force": 10, "static_force": 15, "stribeck_velocity": 1e-3"#;
const BOUC_WEN: &str = r#""dof": "y", "law": "bouc-wen", "stiffness": 1e5, "slip_force": 2, "exponent": 1.5, "beta": 0.8,
    "gamma": -0.3"#;

/// Each law in its range, what of it is put in place of what, and what the refusal says.
#[rustfmt::skip]
const OUT_OF_RANGE: [(&str, &str, &str, [&str; 2]); 14] = [
    (IWAN, "4000", "0", ["joint.friction[0].slip_force: found 0.0", "above 0"]),
    (IWAN, "1.5e7", "0", ["joint.friction[0].stiffness: found 0.0", "above 0"]),
    (IWAN, "-0.3", "-1", ["joint.friction[0].exponent: found -1.0", "above -1"]),
    (IWAN, "0.5", "-0.5", ["joint.friction[0].ratio: found -0.5", "zero or more"]),
    (VALANIS, "0.5", "1.5", ["joint.friction[0].kappa: found 1.5", "0 to 1"]),
    (VALANIS, "100,", "1001,", ["joint.friction[0].slip_stiffness: found 1001.0", "0 to 1000.0, the stiffness"]),
    (VALANIS, "5,", "0,", ["joint.friction[0].slip_force: found 0.0", "above 0"]),
    (DAHL, "1e5", "0", ["joint.friction[0].stiffness: found 0.0", "above 0"]),
    (LUGRE, "150", "149", ["joint.friction[0].damping: found 149.0", "expected 150.0 or more"]),
    (LUGRE, "15,", "9,", ["joint.friction[0].static_force: found 9.0", "10.0, the slip force, or more"]),
    (LUGRE, "1e-3", "0", ["joint.friction[0].stribeck_velocity: found 0.0", "above 0"]),
    (BOUC_WEN, "-0.3", "-0.9", ["joint.friction[0].gamma: found -0.9", "-0.8 to 0.8, beta"]),
    (BOUC_WEN, "-0.3", "0.9", ["joint.friction[0].gamma: found 0.9", "-0.8 to 0.8, beta"]),
    (BOUC_WEN, "1.5", "0.5", ["joint.friction[0].exponent: found 0.5", "1 to 100"]),
];

#[test]
fn a_law_outside_of_its_range_is_refused_by_key_value_and_bound() {
    for (law, from, to, fragments) in OUT_OF_RANGE {
        assert!(with(&format!("[{{ {law} }}]")).is_ok(), "{law}");
        let message = with(&format!("[{{ {} }}]", law.replace(from, to))).unwrap_err();
        for fragment in fragments {
            assert!(message.contains(fragment), "{fragment}: {message}");
        }
    }
}

#[test]
fn a_dof_has_room_for_some_laws_of_a_kind() {
    let dahl = format!("{{ {DAHL} }}");
    for (law, name, at_most) in [(ON_Y, "jenkins", 4), (&dahl, "dahl", 2)] {
        let some = with(&format!("[{}]", vec![law; at_most].join(", "))).unwrap();
        let laws = some.joint.law::<2>().unwrap();
        // each of them bears its part
        let one = with(&format!("[{law}]")).unwrap().joint.law::<2>().unwrap();
        let load = |laws: &JointLaw<2>| laws.on[0].load(&DOF_AT_REST, 1e-4, 0.0);
        let ratio = load(&laws) / load(&one);
        assert!((ratio - at_most as f64).abs() < 1e-12, "{name}: {ratio}");
        let message = with(&format!("[{}]", vec![law; at_most + 1].join(", "))).unwrap_err();
        for expected in [
            format!(
                "joint.friction[{at_most}].law: found \"{name}\" number {}",
                at_most + 1
            ),
            format!("expected {at_most} of that kind at the most"),
            "take one of them out".to_owned(),
        ] {
            assert!(message.contains(&expected), "{expected}: {message}");
        }
    }
    let on_theta = ON_Y.replace("\"y\"", "\"theta\"");
    assert!(with(&format!("[{ON_Y}, {on_theta}]")).is_ok());
    // laws of several kinds on one DOF are
    let all = [IWAN, VALANIS, DAHL, LUGRE, BOUC_WEN].map(|law| format!("{{ {law} }}"));
    let several = with(&format!("[{ON_Y}, {}]", all.join(", "))).unwrap();
    assert_eq!(several.joint.friction.len(), 6);
    let written = several.to_json().unwrap();
    assert_eq!(JointFile::from_json(&written, "").unwrap(), several);
    let mut alone = with(&format!("[{on_theta}]")).unwrap();
    alone.joint.dofs = bolted_joint::joint::DofSet::TRANSLATION;
    assert!(alone.validate().iter().any(|problem| matches!(
        problem,
        JointProblem::OtherDof { path, found: "theta", .. } if path == "joint.friction[0].dof"
    )));
}

/// The good file with a table over the preload beside these laws.
fn over_preload(laws: &str, preloads: &str, nominal: f64) -> Result<JointFile, String> {
    let table = format!(
        r#""friction": [{laws}], "over_preload": {{ "preload": {preloads}, "nominal": {nominal},
           "stiffness": [[[1, 0], [0, 1]], [[1, 0], [0, 1]]], "damping": [[[1, 0], [0, 1]], [[1, 0], [0, 1]]] }},
           "stiffness""#
    );
    let text = GOOD.replacen("\"stiffness\"", &table, 1);
    JointFile::from_json(&text, "m10.joint.json").map_err(|refused| refused.to_string())
}

#[test]
fn over_the_preload_all_slips_in_proportion_to_it() {
    for (law, grows) in [
        (IWAN, &["slip_force"][..]),
        (VALANIS, &["slip_force"]),
        (DAHL, &["slip_force"]),
        (LUGRE, &["slip_force", "static_force"]),
        (BOUC_WEN, &["slip_force"]),
    ] {
        let law = format!("{{ {law} }}, {ON_Y}");
        let file = over_preload(&law, "[1, 2]", 1.0).unwrap();
        // h = h₀ p/p₀, and stiffness and shape are what they were
        let at = file.at_preload(Some(2.0)).unwrap();
        for (before, after) in file.joint.friction.iter().zip(&at.joint.friction) {
            for parameter in before.law.parameters {
                let [before, after] = [before, after].map(|own| own.value(parameter).unwrap());
                let factor = if grows.contains(&parameter.key) {
                    2.0
                } else {
                    1.0
                };
                assert_eq!(after, factor * before, "{}", parameter.key);
            }
        }
        assert_eq!(
            at.joint.law::<2>().unwrap().on[0].jenkins().slip_force,
            600.0
        );
    }
    let message = over_preload(ON_Y, "[0, 2]", 0.0).unwrap_err();
    let expected =
        "joint.over_preload.nominal: found 0 beside joint.friction, expected a preload above 0";
    assert!(message.contains(expected), "{message}");
}
