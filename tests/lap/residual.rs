//! A residual that is more than the noise: it is said, it widens the intervals, and where the law is wrong that does not help.

use bolted_joint_testing::{close, has};

use bolted_joint::identify::lap::{LapResponse, ResponseUnknown, SliderParameter};

use crate::loops::{
    C12, DAMPING, FREQUENCY, FirstLoading, K0, Measured, backbone, identified_of, iwan, study_of,
};

const STIFFNESS: f64 = 6e4;
const SLIP_FORCE: f64 = 6.0;
/// By how much the noise is understated: χ² per degree of freedom is 40.
const UNDERSTATED: f64 = 6.3;
const DRAWS: u64 = 60;

fn one_slider() -> Measured {
    let law: &FirstLoading = &|u| (STIFFNESS * u).min(SLIP_FORCE);
    Measured::Backbone(backbone(law, STIFFNESS))
}

/// What a study says of the noise, divided by a number.
fn understated(tables: String) -> String {
    let (frequency, damping) = (FREQUENCY / UNDERSTATED, DAMPING / UNDERSTATED);
    let (_, rest) = tables.split_once("[[backbone]]").unwrap();
    format!("[noise]\nfrequency = {frequency}\ndamping = {damping}\n[[backbone]]{rest}")
}

fn interval(found: &LapResponse, unknown: ResponseUnknown) -> [f64; 2] {
    let mut estimates = found.estimates.iter();
    estimates
        .find(|own| own.unknown == unknown)
        .unwrap()
        .interval_95
}

/// The law is right: then the widened intervals hold as often as they should.
#[test]
fn noise_that_is_understated_is_said_and_widens_the_intervals() {
    let measured = one_slider();
    let terms = "terms = [\"jenkins\"]\ncompare = false";
    let mut held = 0;
    for seed in 0..DRAWS {
        let (_folder, study) = study_of(&measured, terms, seed, understated);
        let (found, file) = identified_of(&study);
        let reduced = found.fit.reduced_chi_squared();
        assert!((20.0..70.0).contains(&reduced), "{reduced}");
        let [low, high] = interval(&found, ResponseUnknown::JointStiffness);
        held += u64::from((low..=high).contains(&K0));
        let warnings = found.warnings(&study).join("\n");
        has(
            &warnings,
            &[
                "times the stated noise",
                "times as wide",
                "no cure for a wrong law",
            ],
        );
        let (uncertainty, residual) = (file.uncertainty.unwrap(), file.residual.unwrap());
        close(residual.reduced_chi_squared.unwrap(), reduced, 1e-12);
        close(uncertainty.inflation.unwrap().powi(2), reduced, 1e-12);
        has(&uncertainty.basis, &["raised", "no cure for a wrong law"]);
        // as wide as with the right noise
        if seed == 0 {
            let (_folder, study) = study_of(&measured, terms, seed, |tables| tables);
            let (right, _) = identified_of(&study);
            let width = |found| {
                let [low, high] = interval(found, ResponseUnknown::JointStiffness);
                high - low
            };
            close(
                width(&found) / width(&right),
                reduced.sqrt() / UNDERSTATED,
                0.02,
            );
        }
    }
    let held = held as f64 / DRAWS as f64;
    println!("intervals hold {held:.3}");
    assert!((0.88..=1.0).contains(&held), "{held}");
}

/// The law is wrong: the same widening leaves the truth outside. Of many sliders there are some that slip at the least motion,
/// so that a polynomial is too soft at rest, and finds a damper where there is friction.
#[test]
fn a_wrong_law_is_said_and_its_intervals_do_not_hold() {
    let (density, exponent, span) = (1e7, -0.4, 2e-3_f64);
    let small = density * span.powf(exponent + 1.0) / (exponent + 1.0);
    let law = iwan(density, exponent, span, 0.0);
    let measured = Measured::Backbone(backbone(&law, small));
    let terms = "terms = [\"k3\", \"c2\"]\ncompare = false";
    let nominal = |tables: String| {
        let (_, rest) = tables.split_once("[[backbone]]").unwrap();
        format!("[[backbone]]{rest}")
    };
    let stated = study_of(&measured, terms, 1, |tables| tables);
    let not_stated = study_of(&measured, terms, 1, nominal);
    for (_folder, study) in [stated, not_stated] {
        let (found, file) = identified_of(&study);
        assert!(found.fit.reduced_chi_squared() > 40.0);
        has(
            &found.warnings(&study).join("\n"),
            &["no cure for a wrong law"],
        );
        let uncertainty = file.uncertainty.unwrap();
        has(&uncertainty.basis, &["no cure for a wrong law"]);
        for (unknown, truth) in [
            (ResponseUnknown::JointStiffness, K0),
            (ResponseUnknown::JointDamping, C12),
        ] {
            let [low, high] = interval(&found, unknown);
            println!(
                "χ²/ν {}: {low} to {high}, {truth}",
                found.fit.reduced_chi_squared()
            );
            assert!(!(low..=high).contains(&truth), "{low} {high}");
        }
    }
}

/// Without a stated noise no χ² tells a wrong law: what is left of neighbouring points does.
#[test]
fn a_pattern_in_the_residuals_is_told() {
    let unstated = |tables: String| {
        let (_, rest) = tables.split_once("[[backbone]]").unwrap();
        format!("[[backbone]]{rest}")
    };
    let measured = one_slider();
    for (terms, is_told) in [("jenkins", false), ("k3", true)] {
        let terms = format!("terms = [\"{terms}\"]\ncompare = false");
        for seed in 0..10 {
            let (_folder, study) = study_of(&measured, &terms, seed, unstated);
            let (found, _) = identified_of(&study);
            let warnings = found.warnings(&study).join("\n");
            let is_pattern = warnings.contains("residuals of neighbouring points are correlated");
            assert_eq!(is_pattern, is_told, "{terms}: {warnings}");
        }
    }
}

#[test]
fn deviations_of_friction_stand_in_the_file() {
    let terms = "terms = [\"jenkins\"]\ncompare = false";
    let (_folder, study) = study_of(&one_slider(), terms, 1, |tables| tables);
    let (found, file) = identified_of(&study);
    let friction = &file.uncertainty.unwrap().standard_deviation.friction;
    let of = |parameter| {
        let unknown = ResponseUnknown::Slider(parameter);
        let own = found.estimates.iter().find(|own| own.unknown == unknown);
        own.unwrap().standard_deviation
    };
    let expected = [SliderParameter::Stiffness, SliderParameter::SlipForce].map(of);
    assert_eq!(friction.len(), 1);
    assert_eq!(friction[0].parameters, expected);
    assert_eq!(friction[0].dof.name, file.joint.friction[0].dof.name);
}
