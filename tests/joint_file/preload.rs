//! Joints over the preload: taken at one, with their deviations, and tables that do not fit.

use bolted_joint::joint::{JointFile, LawError};
use bolted_joint_dynamics::Beyond;
use bolted_joint_testing::{begins, close, has};

use crate::{GOOD, refused};

/// K, C and k₃ of two DOFs at three preloads, with their standard deviations.
const OVER_PRELOAD: &str = include_str!("../data/joint/torques.joint.json");

/// K, C and k₃ of it at 17 N·m, from SciPy's `PchipInterpolator`; no slope takes K or C out of the semidefinite matrices.
#[rustfmt::skip]
const STIFFNESS: [f64; 4] = [632342.8571428572, 5323.428571428572, 5323.428571428572, 1261.4588235294116];
#[rustfmt::skip]
const DAMPING: [f64; 4] = [7.646918918918919, -0.2676571428571428, -0.2676571428571428, 0.05646918918918919];
const CUBIC: [f64; 2] = [-1400000000.0, 1.0133333333333334];

#[test]
fn a_joint_over_preload_is_taken_at_one_between_those_of_its_table() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    // 17 N·m is a fifth of the way from 15 to 25 N·m.
    let file = table.at_preload(Some(17.0)).unwrap();
    assert_eq!(file.validate(), []);
    assert_eq!(file.name, "table, at 17 N·m");
    let law = file.joint.law::<2>().unwrap();
    let near = |found: &[f64], expected: &[f64]| {
        for (found, expected) in found.iter().zip(expected) {
            close(*found, *expected, 1e-13);
        }
    };
    near(law.linear.stiffness.as_flattened(), &STIFFNESS);
    near(law.linear.damping.as_flattened(), &DAMPING);
    near(&law.polynomials().map(|terms| terms.springs[0]), &CUBIC);
    let uncertainty = file.uncertainty.unwrap();
    near(&uncertainty.standard_deviation.stiffness[0], &[240.0, 2.4]);
    near(&uncertainty.standard_deviation.damping[1], &[0.024, 0.0024]);
    let basis = "test; between 15 and 25 N·m interpolated";
    begins(&uncertainty.basis, basis);
    // The free estimate of 25 N·m is the joint itself.
    let free = uncertainty.free_estimate.unwrap();
    near(&free.damping[0], &[7.8, 0.8 * -0.4 + 0.2 * -0.2]);
    assert_eq!(uncertainty.over_preload, None);
    assert_eq!(file.validity.unwrap().torque_n_m, Some([15.0, 25.0]));
    let notes = file.provenance.unwrap().notes;
    assert!(notes[0].contains("17 N·m, interpolated between 15 and 25 N·m"));
}

#[test]
fn a_joint_over_preload_is_at_its_own_preloads_what_the_table_says() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    let over_preload = table.joint.over_preload.clone().unwrap();
    for (place, preload) in [10.0, 15.0, 25.0].into_iter().enumerate() {
        let file = table.at_preload(Some(preload)).unwrap();
        assert_eq!(file.joint.stiffness, over_preload.stiffness[place]);
        assert_eq!(file.joint.damping, over_preload.damping[place]);
        assert_eq!(file.joint.cubic, over_preload.cubic[place]);
        assert_eq!(file.validity.unwrap().torque_n_m, Some([preload; 2]));
        let of_all = table.uncertainty.as_ref().unwrap();
        let own = &of_all.over_preload.as_ref().unwrap().at[place];
        let uncertainty = file.uncertainty.unwrap();
        assert_eq!(uncertainty.standard_deviation, own.standard_deviation);
        // The nominal preload's interval stands beside the table.
        assert_eq!(uncertainty.interval_95.is_some(), preload == 15.0);
    }
    assert_eq!(table.at_preload(None), table.at_preload(Some(15.0)));
    let constant = JointFile::from_json(GOOD, "").unwrap();
    assert_eq!(constant.at_preload(None), Ok(constant.clone()));
    let at_ten = constant.at_preload(Some(10.0));
    assert_eq!(at_ten, Err(LawError::ConstantJoint { found_n_m: 10.0 }));
    for found_n_m in [9.9, 25.1, -1.0, f64::INFINITY] {
        let outside = LawError::OutsideTable {
            found_n_m,
            first_n_m: 10.0,
            last_n_m: 25.0,
        };
        assert_eq!(table.at_preload(Some(found_n_m)), Err(outside));
    }
    assert!(table.at_preload(Some(f64::NAN)).is_err());
}

#[test]
fn interpolation_between_passive_joints_is_passive() {
    let table = JointFile::from_json(OVER_PRELOAD, "").unwrap();
    for step in 0..=150 {
        let preload_n_m = 10.0 + 0.1 * f64::from(step);
        let file = table.at_preload(Some(preload_n_m)).unwrap();
        assert!(file.passivity().is_passive(), "{}", file.name);
    }
}

#[test]
fn deviations_over_preload_that_do_not_fit_the_joint() {
    #[rustfmt::skip]
    let cases = [
        ("{ \"preload\": 10,", "{ \"preload\": 11,",
         "uncertainty.over_preload.at[0].preload: found 11.0 N·m, expected 10.0 N·m as in joint.over_preload.preload"),
        ("[[100, 1], [1, 0.1]]", "[[-100, 1], [1, 0.1]]",
         "uncertainty.over_preload.at[0].standard_deviation.stiffness[0][0]: found -100.0"),
        ("[[8, -0.4], [-0.4, 0.05]]", "[[8, -0.4], [-0.5, 0.05]]",
         "uncertainty.over_preload.at[1].free_estimate.damping: found -0.4 at [0][1]"),
        ("\"preload\": [10, 15, 25]", "\"preload\": [10, 15, 20, 25]",
         "uncertainty.over_preload.at: found 3 entries, expected 4, one for each of joint.over_preload.preload"),
    ];
    for (from, to, fragment) in cases {
        assert!(OVER_PRELOAD.contains(from), "{from}");
        let text = OVER_PRELOAD.replacen(from, to, 1);
        has(&refused(&text, ""), &[fragment]);
    }
}

/// `OVER_PRELOAD` with a slider on y at each preload.
fn with_sliders(entries: &str) -> String {
    let cubic = "\"cubic\": [[0, 0], [-1e9, 0], [-3e9, 20]]";
    assert!(OVER_PRELOAD.contains(cubic));
    OVER_PRELOAD.replacen(cubic, &format!("{cubic}, \"friction\": [{entries}]"), 1)
}

fn slider(stiffness: f64, slip_force: f64) -> String {
    format!(
        "[{{ \"dof\": \"y\", \"law\": \"jenkins\", \"stiffness\": {stiffness}, \"slip_force\": {slip_force} }}]"
    )
}

#[test]
fn friction_with_a_table_of_its_own_has_its_stiffness_from_it() {
    let sliders = [(1e6, 20.0), (1.5e6, 30.0), (2.2e6, 50.0)];
    let entries = sliders.map(|(k, h)| slider(k, h)).join(", ");
    let text = with_sliders(&entries);
    let table = JointFile::from_json(&text, "").unwrap();
    assert_eq!(table.validate(), []);
    // a fifth of the way from 15 to 25 N·m
    let at = |preload: Option<f64>| table.at_preload(preload).unwrap().joint.friction[0].clone();
    close(
        at(Some(17.0)).parameters[0],
        0.8 * 1.5e6 + 0.2 * 2.2e6,
        1e-14,
    );
    close(at(Some(17.0)).parameters[1], 0.8 * 30.0 + 0.2 * 50.0, 1e-14);
    for (preload, (stiffness, slip_force)) in [10.0, 15.0, 25.0].into_iter().zip(sliders) {
        assert_eq!(at(Some(preload)).parameters, [stiffness, slip_force]);
    }
    assert_eq!(at(None), at(Some(15.0)));
    // a preload that moves has the same laws
    let moving = table.joint.law_over_preload::<2>(Beyond::Refused).unwrap();
    for preload in [10.0, 12.0, 17.0, 25.0] {
        let slider = moving.law(preload).on[0].jenkins();
        let alone = at(Some(preload)).parameters;
        close(slider.stiffness, alone[0], 1e-15);
        close(slider.slip_force, alone[1], 1e-15);
    }
    // read again as it was written
    let again = JointFile::from_json(&table.to_json().unwrap(), "").unwrap();
    assert_eq!(again, table);
}

/// Bouc–Wen's load is a state of the importer's, and LuGre's passive range is not convex.
#[test]
fn laws_that_cannot_follow_a_preload_are_told() {
    let bouc_wen = |stiffness: f64, slip_force: f64| {
        format!(
            "[{{ \"dof\": \"y\", \"law\": \"bouc-wen\", \"stiffness\": {stiffness}, \"slip_force\": {slip_force}, \
             \"exponent\": 1.5, \"beta\": 0.7, \"gamma\": 0.3 }}]"
        )
    };
    let of = |entries: [String; 3]| {
        let file = JointFile::from_json(&with_sliders(&entries.join(", ")), "").unwrap();
        assert_eq!(file.validate(), []);
        file.joint.law_over_preload::<2>(Beyond::Refused)
    };
    assert!(
        of([
            bouc_wen(1e6, 20.0),
            bouc_wen(1e6, 30.0),
            bouc_wen(1e6, 50.0)
        ])
        .is_ok()
    );
    let found = of([
        bouc_wen(1e6, 20.0),
        bouc_wen(1.5e6, 30.0),
        bouc_wen(2e6, 50.0),
    ]);
    assert_eq!(found, Err(LawError::StateOverPreload { law: "bouc-wen" }));
    let lugre = |bristle_damping: f64, static_force: f64| {
        format!(
            "[{{ \"dof\": \"y\", \"law\": \"lugre\", \"stiffness\": 1e6, \"bristle_damping\": {bristle_damping}, \
             \"damping\": 0.0, \"slip_force\": 10.0, \"static_force\": {static_force}, \"stribeck_velocity\": 1e-3 }}]"
        )
    };
    let entries = [lugre(10.0, 10.0), lugre(10.0, 10.0), lugre(0.0, 30.0)].join(", ");
    // σ₁ (F_s − F_c)/F_c at 20 N·m, half the way: 5 · 10/10
    has(
        &refused(&with_sliders(&entries), ""),
        &[
            "joint.over_preload.friction[1][0].damping",
            "15.0 to 25.0 N·m and at 20.0 N·m",
            "expected 5.0 or more",
        ],
    );
}

#[test]
fn a_table_of_friction_that_does_not_fit_is_refused() {
    let one = slider(1e6, 20.0);
    let rotation = one.replace("\"y\"", "\"theta\"");
    #[rustfmt::skip]
    let cases = [
        (format!("{one}, {one}"), "joint.over_preload.friction: found 2 entries, expected 3, one for each of joint.over_preload.preload"),
        (format!("{one}, {one}, {rotation}"), "joint.over_preload.friction[2]: found \"jenkins on theta\", expected \"jenkins on y\""),
        (format!("{one}, [], {one}"), "joint.over_preload.friction[1]: found \"\", expected \"jenkins on y\""),
        (format!("{one}, {}, {one}", slider(1e6, -1.0)), "joint.over_preload.friction[1][0].slip_force: found -1.0"),
    ];
    for (entries, fragment) in cases {
        has(&refused(&with_sliders(&entries), ""), &[fragment]);
    }
    let both = with_sliders(&[one.as_str(); 3].join(", "));
    let both = both.replacen(
        "\"over_preload\": {",
        &format!("\"friction\": {one}, \"over_preload\": {{"),
        1,
    );
    has(
        &refused(&both, ""),
        &["joint.friction: found beside joint.over_preload.friction"],
    );
}
