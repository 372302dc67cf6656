//! Ways from a start to the estimate with causes, and to what speaks against the one without.

use bolted_joint_systematic::{
    CONTRADICTED, Diagnosis, Estimate, Experiment, Prior, Settings, Start, diagnose, estimate,
    evaluated,
};

/// The estimate without causes, that with them, and what speaks against the first.
pub(super) type Explanation = (Estimate, Estimate, Diagnosis);

/// A way to an explanation from a start.
pub(super) type Find<'f> =
    dyn Fn(&Experiment<'_>, &[Prior], &Start, &Settings) -> Option<Explanation> + 'f;

/// Many errors, each within its limits, can lead an estimate without causes to no joint at all, or to one that says nothing: then
/// the one with them is found first. `None` where it does not explain the data, or contradicts a limit.
pub(super) fn explained(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    start: &Start,
    settings: &Settings,
) -> Option<Explanation> {
    let found = estimate(experiment, priors, start, settings)?;
    let is_it = found.fits(settings) && found.is_within_the_budget();
    is_it.then(|| beside(experiment, found, settings)).flatten()
}

/// An estimate with causes, with one without them at the same joint.
fn beside(
    experiment: &Experiment<'_>,
    found: Estimate,
    settings: &Settings,
) -> Option<Explanation> {
    let plain = evaluated(experiment, &found.unknowns, settings)?;
    let diagnosis = Diagnosis::of_scores(experiment, &plain, settings);
    Some((plain, found, diagnosis))
}

/// The estimate without causes first, and what speaks against it.
pub(super) fn diagnosed(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    start: &Start,
    settings: &Settings,
) -> Option<Explanation> {
    let Some(plain) = estimate(experiment, &[], start, settings) else {
        let found = estimate(experiment, priors, start, settings)?;
        return beside(experiment, found, settings);
    };
    let mut diagnosis = diagnose(experiment, &plain, settings);
    let mut found = with_first_suspect_free(experiment, priors, &diagnosis, settings);
    if !found.as_ref().is_some_and(|found| found.fits(settings))
        && let Some(other) = diagnosis.from_far(experiment, &plain, settings)
    {
        // from the same place it would come to the same end
        if other.start != diagnosis.start {
            let next = with_first_suspect_free(experiment, priors, &other, settings);
            let is_better = next.as_ref().is_some_and(|next| next.fits(settings));
            if is_better || found.is_none() {
                found = next;
            }
        }
        diagnosis = other;
    }
    let found = found?;
    let diagnosis = diagnosis.with_contradicted(experiment, &plain, &found, settings);
    Some((plain, found, diagnosis))
}

/// The estimate with all causes. One that stands out is let free from the beginning, as a search that it keeps from converging
/// finds nothing; if it turns out to be no larger than its prior allows, it is held again.
fn with_first_suspect_free(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    diagnosis: &Diagnosis,
    settings: &Settings,
) -> Option<Estimate> {
    let with = |priors: &[Prior], start: &Start| estimate(experiment, priors, start, settings);
    let first = diagnosis.suspects.first();
    let first = first.filter(|suspect| suspect.reduced_chi_squared.is_some());
    let held = first.and_then(|suspect| {
        let number = priors.iter().position(|of| of.cause == suspect.cause)?;
        let deviation = priors[number].standard_deviation;
        let contradicts = (suspect.value / deviation).abs() > CONTRADICTED;
        contradicts.then_some((number, deviation, suspect.value))
    });
    let Some((number, deviation, value)) = held else {
        return with(priors, &diagnosis.start);
    };
    let mut freed = priors.to_vec();
    freed[number].standard_deviation = value.abs();
    let mut found = with(&freed, &diagnosis.start)?;
    let cause = &mut found.causes[number];
    let pull = cause.value / deviation;
    if pull.abs() > CONTRADICTED {
        cause.contradicted = Some(pull);
        return Some(found);
    }
    let start = Start::without_causes(&found.unknowns);
    let again = with(priors, &start).filter(|again| again.converged || !found.converged);
    Some(again.unwrap_or(found))
}
