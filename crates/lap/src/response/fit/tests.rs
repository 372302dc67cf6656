//! A fit that goes on where another stopped.

use bolted_joint_dynamics::law::Term;

use super::*;
use crate::response::data::SineLine;
use crate::response::model::ResponseUnknown;
use crate::response::study::Place;
use crate::response::terms::TermSet;

/// Responses of one body, where the relative motion is not measured by itself: amplitudes that are guessed anew from the
/// numbers of a fit are others than those that it had come to.
#[test]
fn a_fit_goes_on_where_a_look_has_ended() {
    let terms = TermSet::of(&[Term::CUBIC]);
    let linear = [
        ResponseUnknown::Mass,
        ResponseUnknown::SupportStiffness,
        ResponseUnknown::SupportDamping,
        ResponseUnknown::JointStiffness,
        ResponseUnknown::JointDamping,
    ];
    let model = Model {
        drive: Place::B,
        response: Place::B,
        unknowns: linear.into_iter().chain(terms.unknowns()).collect(),
        terms,
        harmonics: 1,
    };
    let mut truth = Values {
        mass: 2.35,
        support_stiffness: 10.56e5,
        support_damping: 14.0,
        joint_stiffness: 4.56e6,
        joint_damping: 17.0,
        ..Values::default()
    };
    *truth.terms.coefficient_mut(Term::CUBIC) = 4e13;
    let amplitudes_m = [2e-5, 6e-5, 1.2e-4, 2e-4];
    let omegas = (0..12).map(|n| 2000.0 + 25.0 * f64::from(n));
    let lines: Vec<SineLine> = omegas
        .flat_map(|omega| amplitudes_m.map(|amplitude_m| (omega, amplitude_m)))
        .map(|(omega, amplitude_m)| {
            let (receptance, force_n) = model.receptance(&truth, amplitude_m, omega);
            SineLine {
                omega,
                force_n,
                displacement_m: receptance.norm() * force_n,
                phase_rad: receptance.arg(),
            }
        })
        .collect();
    let data = Data {
        lines: &lines,
        backbones: &[],
    };
    let noise = Noise::stated(0.01, 0.01);
    let mut start = truth;
    start.joint_stiffness *= 0.97;
    *start.terms.coefficient_mut(Term::CUBIC) = 0.0;
    let largest_m = Start::from(&start).largest_m(&model, data);
    let up_to = |from: Start<'_>, steps: usize| {
        fit_up_to(&model, data, &noise, from, (Kind::Free, largest_m, steps)).unwrap()
    };
    let look = up_to(Start::from(&start), 2);
    // amplitudes settle a little further, and nothing is lost
    let gone_on = up_to(Start::from(&look), 0).chi_squared;
    assert!(
        gone_on <= look.chi_squared * (1.0 + 1e-12),
        "{gone_on} {}",
        look.chi_squared
    );
    let end = up_to(Start::from(&look), STEPS).chi_squared;
    assert!(end <= gone_on, "{end} {gone_on}");
}
