//! Whether an estimate may be relied on at all: whether the search came to an end, whether the data determine the stiffness, and
//! whether the model has anything to do with the measurement. What is merely worse than it could be is warned of instead.

use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_statistics::upper_median;
use bolted_joint_study::overstated_noise;

use super::assessment::Assessment;
use super::identification::{AssemblyFit, Identification};
use super::joint_estimate::{JointEstimate, UNRELIABLE, UNRELIABLE_OF_SEVERAL};
use super::layout::Bolts;
use super::lines_estimate::LinesEstimate;
use super::model::JointModel;
use super::noise::{Noise, StatedLevel};
use super::observed::Observed;
use super::slips::{FoundSlip, are_certain};

/// Relative difference that half of the measured values must stay below. A joint model that is too simple leaves a few tens of per
/// cent around the resonances; beyond this the computed structure is another one than the measured one.
const MISFIT: f64 = 0.5;

/// Standard deviations between a stiffness and that of the free estimate beyond which they are not the same joint. Damping is not
/// asked: an error of the phase, as of a delay, makes it negative and leaves the stiffness.
const FAR_FROM_FREE: f64 = 10.0;

/// The same in parts of the stiffness: of data without noise every difference is many deviations.
const FAR_IN_PARTS: f64 = 0.02;

/// Standard deviations that an unknown may still move when the search ends: added to its error, √(1 + 0.3²), they widen it by less
/// than a twentieth. Where the noise follows from a residual that is none, renewed weights may go to and fro for ever.
pub(super) const TOLERABLE_UNREST: f64 = 0.3;

/// The same below which nobody has to know of it.
pub(super) const NOTABLE_UNREST: f64 = 0.05;

/// χ² per degree of freedom up to which coherence, an estimate of neighbouring lines together, accounts for a residual.
const MOST_OF_COHERENCE: f64 = 2.0;

/// χ² per degree of freedom beyond which a residual is more than noise of the stated size.
const MOST_WITHOUT_BUDGET: f64 = 1.3;

/// What slips that explain the residual, or a large part of it, say against the estimate.
pub(super) fn because_of(slips: &[FoundSlip], assessment: &Assessment) -> Option<String> {
    let words: Vec<String> = slips.iter().map(FoundSlip::to_string).collect();
    // without a stated noise nobody knows how much is left
    let is_all = assessment.reduced_chi_squared.is_none()
        || !assessment.noise_is_stated
        || are_certain(slips, assessment);
    let how = match is_all {
        true => "the data fit",
        false => "the data fit less badly, but not well,",
    };
    (!words.is_empty()).then(|| format!("{how} if {}", words.join(", or if ")))
}

/// What speaks against an estimate for which none with the errors of the set-up was found, where these would have to explain it.
pub(super) fn without_budget(assessment: &Assessment) -> Option<String> {
    let chi = assessment.reduced_chi_squared;
    let chi = chi.filter(|chi| assessment.noise_is_stated && *chi > MOST_WITHOUT_BUDGET)?;
    Some(format!(
        "no estimate with the errors of the set-up was found, and without them χ² per degree of freedom is {chi:.2}"
    ))
}

/// What speaks against the estimate, a line each; empty if nothing does.
pub(super) fn reasons_against(
    estimate: &LinesEstimate,
    bolts: &Bolts,
    median_difference: Option<f64>,
) -> Vec<String> {
    let mut reasons = Vec::new();
    if estimate.unrest > TOLERABLE_UNREST {
        reasons.push("the search for the estimate has not converged".to_owned());
    }
    if estimate.observed.as_ref().is_some_and(Observed::is_void) {
        reasons.push(
            "the noise of A and B is larger than what tells the bolts apart: measure A and B with less noise, or bolts that are \
             farther from each other, or let them have one joint (`bolts = \"alike\"`)"
                .to_owned(),
        );
    }
    let names = bolts.with_own_joint();
    for joint in &estimate.joints {
        let covariance = &joint.covariance;
        let unknowns = covariance.unknowns.iter().zip(&covariance.identified);
        let open: Vec<String> = unknowns
            .filter(|(unknown, identified)| unknown.is_direct_stiffness() && !**identified)
            .map(|(unknown, _)| unknown.label(names))
            .collect();
        if !open.is_empty() {
            reasons.push(format!(
                "the data do not determine {}{}",
                open.join(" and "),
                joint.place()
            ));
        }
        if open.is_empty() {
            let hardly = joint.hardly_determined().into_iter();
            let hardly: Vec<String> = hardly.map(|unknown| unknown.label(names)).collect();
            if !hardly.is_empty() {
                reasons.push(format!(
                    "the data hardly determine {}{}: {} more than {:.0} % of the value",
                    hardly.join(" and "),
                    joint.place(),
                    match hardly.len() {
                        1 => "its deviation is",
                        _ => "their deviations are",
                    },
                    100.0
                        * if joint.free.len() > 1 {
                            UNRELIABLE_OF_SEVERAL
                        } else {
                            UNRELIABLE
                        }
                ));
            }
        }
        reasons.extend(of_energy(joint, names));
        let diagonal = joint.free.iter().map(|free| free.stiffness.diagonal());
        for (bolt, _) in diagonal.enumerate().filter(|(_, k)| k.max() <= 0.0) {
            let bolt = names.get(bolt).map(|name| format!("{name}: "));
            reasons.push(format!(
                "{}the joint that fits best has no stiffness{}",
                bolt.unwrap_or_default(),
                joint.place()
            ));
        }
    }
    let misfit = median_difference.filter(|off| *off > MISFIT);
    if let Some(off) = misfit.filter(|_| !is_known_noise(&estimate.assessment)) {
        reasons.push(format!(
            "half of the measured values are more than {:.0} % off the model: substructures and assembly do not belong together \
             as the study says (lengths in mm, moduli in GPa, points, directions, units?)",
            100.0 * off
        ));
    }
    reasons
}

/// That the functions ask for a joint that feeds energy, and for another stiffness than that of the passive one: the nearest of these
/// is none of theirs.
fn of_energy(joint: &JointEstimate, names: &[String]) -> Option<String> {
    let deviations = joint.covariance.standard_deviation();
    let all = joint.covariance.unknowns.iter().zip(deviations);
    let moved = all.filter_map(|(unknown, deviation)| {
        let [found, free] = [joint.bolts(), &joint.free]
            .map(|own| own.get(unknown.joint).map(|own| unknown.value(own)));
        let (found, free) = (found?, free?);
        let by = (found - free).abs() / deviation;
        let is_far = by > FAR_FROM_FREE && (found - free).abs() > FAR_IN_PARTS * found.abs();
        (unknown.is_direct_stiffness() && is_far).then_some((unknown, by))
    });
    let (unknown, by) = moved.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    Some(format!(
        "the functions ask for a joint that feeds energy{}: {} of the passive one is {by:.0} standard deviations from theirs; check \
         signs, and whether phases are counted as in e^(+jωt)",
        joint.place(),
        unknown.label(names)
    ))
}

/// Whether the residual is noise of a size that somebody knows. Where its size follows from the residual, no test tells it from a
/// model that has nothing to do with the measurement.
fn is_known_noise(assessment: &Assessment) -> bool {
    let is_of_coherence = || {
        let chi = assessment.reduced_chi_squared;
        assessment.noise_is_known && chi.is_some_and(|chi| chi <= MOST_OF_COHERENCE)
    };
    assessment.is_certain() && (assessment.noise_is_stated || is_of_coherence())
}

/// A warning of a part of the values that is stated as noise and far above the residual; of a floor nobody knows its size. Where the
/// model has nothing to do with the measurement, what is left beside the noise of all that takes part says nothing of its size.
pub(super) fn of_stated_noise(
    noise: &Noise,
    assessment: &Assessment,
    median_difference: Option<f64>,
) -> Option<String> {
    if median_difference.is_some_and(|off| off > MISFIT) {
        return None;
    }
    let StatedLevel { relative, floor } = noise.assembly;
    let relative = relative.filter(|_| !assessment.noise_is_known)?;
    let has_floor = [floor.yy, floor.ytheta, floor.thetatheta]
        .into_iter()
        .flatten()
        .any(|floor| floor > 0.0);
    let chi = assessment.reduced_chi_squared.filter(|_| !has_floor)?;
    overstated_noise(relative, chi)
}

/// A warning of a residual that is large and not noise, though not so large that nothing is to be relied on.
pub(super) fn warning(
    estimate: &LinesEstimate,
    model: JointModel,
    relative_rms: f64,
    median_difference: Option<f64>,
) -> Option<String> {
    let typical = median_difference.filter(|off| *off <= MISFIT)?;
    let choice = estimate.model_choice();
    let fit = choice.and_then(|choice| choice.models.iter().find(|fit| fit.model == model));
    let is_noise = fit.map_or(estimate.assessment.fits(), |fit| fit.adequate);
    (relative_rms > MISFIT && !is_noise).then(|| {
        format!(
            "the residual is {:.0} % r.m.s. of the receptance and more than noise, though half of the values are within {:.1} %: the \
             joint model is too simple, or the study does not describe what was measured (lengths in mm, moduli in GPa, points, \
             directions, units?)",
            100.0 * relative_rms,
            100.0 * typical
        )
    })
}

impl Identification {
    /// What the relative residual is and what is called noise, where the two seem to contradict each other; a few sentences.
    #[must_use]
    pub fn about_the_residual(&self) -> Option<String> {
        let assessment = &self.estimate.assessment;
        let size = match (assessment.noise_is_known, assessment.noise_is_stated) {
            (true, _) => "as coherence tells it",
            (false, true) => "as the study states it",
            (false, false) => {
                "which here follows from the residual itself: what counts then is whether neighbouring lines agree, and whether \
                 another joint model fits better"
            }
        };
        (self.relative_rms > MISFIT).then(|| {
            format!(
                "The residual in % is relative to each computed value, so that small values, as near antiresonances, weigh most. \
                 Whether it is noise is judged beside the noise's standard deviation, {size}."
            )
        })
    }
}

/// Median of |measured − computed|/max(|measured|, |computed|) over all values.
pub(super) fn median_difference(fitted: &[AssemblyFit]) -> Option<f64> {
    upper_median(fitted.iter().flat_map(|assembly| {
        let lines = assembly.lines.assembly.iter().zip(&assembly.regenerated);
        lines.flat_map(|(measured, computed)| of_line(assembly, measured, computed))
    }))
}

fn of_line<'a>(
    assembly: &'a AssemblyFit,
    measured: &'a ComplexMatrix,
    computed: &'a ComplexMatrix,
) -> impl Iterator<Item = f64> {
    assembly.fits.iter().map(move |fit| {
        let (measured, computed) = (measured[fit.place], computed[fit.place]);
        let size = measured.norm().max(computed.norm());
        match size > 0.0 {
            true => (measured - computed).norm() / size,
            false => 0.0,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::StatedFloor;

    #[test]
    fn stated_noise_is_too_large_beside_a_fit_and_not_beside_none() {
        let noise = Noise::of_the_assembly(StatedLevel {
            relative: Some(0.01),
            floor: StatedFloor::default(),
        });
        let assessment = Assessment {
            // a quarter of the stated deviation
            reduced_chi_squared: Some(0.0625),
            noise_is_stated: false,
            noise_is_known: false,
            chi_squared_excess: 0.0,
            line_correlation: 0.0,
            line_correlation_excess: 0.0,
            has_power: true,
            is_exact: false,
        };
        let of = |off: f64| of_stated_noise(&noise, &assessment, Some(off));
        assert!(of(0.004).is_some_and(|told| told.contains("is 4 times as large")));
        assert_eq!(of(1.2), None);
    }
}
