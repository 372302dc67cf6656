//! Contents that contradict each other or no joint can have.

use bolted_joint_testing::has;
use std::fs;

use bolted_joint::joint::{JointFile, LawError};
use bolted_joint_dynamics::Polynomial;

use crate::{data, refusal, refusal_with, refused};

#[test]
fn contents_that_do_not_fit_together() {
    let of_dofs = "one for each of joint.dofs = [\"y\", \"theta\"]";
    assert_eq!(
        refusal("[5.82e3, 1.29e3]", "[5.82e3, 1.29e3, 7]"),
        format!("m10.joint.json: joint.stiffness[1]: found 3 entries, expected 2, {of_dofs}")
    );
    assert_eq!(
        refusal(", [-0.83, 0.083]", ""),
        format!("m10.joint.json: joint.damping: found 1 entry, expected 2, {of_dofs}")
    );
    assert_eq!(
        refusal("[5.82e3, 1.29e3]", "[5.81e3, 1.29e3]"),
        "m10.joint.json: joint.stiffness: found 5820.0 at [0][1] and 5810.0 at [1][0], \
         expected a symmetric matrix; give both entries the same value"
    );
    #[rustfmt::skip]
    let cases = [
        ("\"dofs\": [\"y\", \"theta\"]", "\"dofs\": [\"y\"]", "joint.stiffness: found 2 entries, expected 1"),
        ("\"dofs\": [\"y\", \"theta\"]", "\"dofs\": [\"y\"]", "joint.damping: found 2 entries, expected 1"),
        ("\"bad\"", "\"a\\uffff\"", "expected one line of text"),
        ("\"bad\"", "\" \"", "name: found \" \", expected one line of text"),
        ("\"bad\"", "\"a\\nb\"", "name: found \"a\\nb\", expected one line of text"),
    ];
    for (from, to, fragment) in cases {
        has(&refusal(from, to), &[fragment]);
    }
}

#[test]
fn bodies_that_do_not_fit() {
    let body = |inertia: &str, stiffness: &str| {
        format!("{{ \"inertia\": {inertia}, \"stiffness\": {stiffness}, \"damping\": [0, 0] }}")
    };
    let b = body("[1, 1]", "[1, 1]");
    let bodies = |a: String| format!("\"bodies\": {{ \"a\": {a}, \"b\": {b} }}");
    #[rustfmt::skip]
    let cases = [
        (body("[1.41, -0.1]", "[1, 1]"), "bodies.a.inertia[1]: found -0.1, expected an inertia greater than zero"),
        (body("[0, 1]", "[1, 1]"), "bodies.a.inertia[0]: found 0.0, expected an inertia greater than zero"),
        (body("[1.41]", "[1, 1]"), "bodies.a.inertia: found 1 entry, expected 2, one for each of joint.dofs"),
        (body("[1, 1]", "[1, -1]"), "bodies.a.stiffness[1]: found -1.0, expected a support stiffness of zero or more"),
    ];
    for (a, fragment) in cases {
        has(&refusal_with(&bodies(a)), &[fragment]);
    }
}

#[test]
fn other_records_that_do_not_fit() {
    #[rustfmt::skip]
    let cases = [
        ("\"validity\": { \"frequency_hz\": [512, 5] }",
         "validity.frequency_hz: found 512.0 to 5.0 Hz, expected the lower frequency first"),
        ("\"residual\": { \"relative_rms\": -1, \"lines\": 3 }",
         "residual.relative_rms: found -1.0, expected a root mean square of zero or more"),
        ("\"residual\": { \"relative_rms\": 1, \"lines\": -3 }", "residual.lines: found -3, expected a whole number"),
        (
            "\"uncertainty\": { \"basis\": \"\", \"standard_deviation\": \
             { \"stiffness\": [[1, 2], [2, -1]], \"damping\": [[1, 2], [2, 1]] } }",
            "uncertainty.standard_deviation.stiffness[1][1]: found -1.0, expected a standard deviation of zero or more",
        ),
        (
            "\"provenance\": { \"tool\": \"t\", \"version\": \"1\", \"method\": \"m\", \"model\": \"full\", \
             \"inputs\": [{ \"role\": \"a\", \"file\": \"a.uff\", \"sha256\": \"E3B0\" }] }",
            "provenance.inputs[0].sha256: found \"E3B0\", expected 64 lower-case hexadecimal digits",
        ),
    ];
    for (more, fragment) in cases {
        has(&refusal_with(more), &[fragment]);
    }
}

#[test]
fn preload_tables_that_do_not_fit() {
    let good = fs::read_to_string(data("over-preload.joint.json")).unwrap();
    #[rustfmt::skip]
    let cases = [
        ("[10.0, 25.0]", "[25.0, 10.0]", "joint.over_preload.preload[1]: found 10.0 N·m after 25.0 N·m, expected strictly increasing"),
        ("\"nominal\": 10.0", "\"nominal\": 26.0",
         "joint.over_preload.nominal: found 26.0 N·m, expected a preload within the table, from 10.0 to 25.0 N·m"),
        ("[10.0, 25.0]", "[10.0, 15.0, 25.0]",
         "joint.over_preload.stiffness: found 2 entries, expected 3, one for each of joint.over_preload.preload"),
        ("[10.0, 25.0]", "[10.0]", "joint.over_preload.preload: found 1, expected at least 2 preloads"),
        ("[600000.0]", "[600000.0, 1.0]", "joint.over_preload.stiffness[0][0]: found 2 entries, expected 1"),
    ];
    for (from, to, fragment) in cases {
        assert!(good.contains(from));
        has(&refused(&good.replacen(from, to, 1), ""), &[fragment]);
    }
    let file = JointFile::from_json(&good, "").unwrap();
    assert_eq!(file.joint.law::<1>(), Err(LawError::OverPreload));
    assert!(file.passivity().is_passive());
    assert_eq!(file.passivity().matrices.len(), 4);
}

#[test]
fn equations_come_only_in_the_size_of_the_joint() {
    let lap = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let equations = lap.lap::<1>().unwrap();
    assert_eq!(equations.a.inertia, [2.35]);
    assert_eq!(equations.joint.polynomials(), [Polynomial::cubic(1670.0)]);
    assert_eq!(
        lap.lap::<2>().unwrap_err().to_string(),
        "joint.dofs: found [\"y\"], expected 2 degrees of freedom"
    );
    let element = JointFile::read(&data("m10-aluminium.joint.json")).unwrap();
    assert_eq!(element.lap::<2>(), Err(LawError::NoBodies));
}
