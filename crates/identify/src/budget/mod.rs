//! The estimate with the error budget: what the set-up of the test leaves unknown takes part in it.

mod draws;
mod experiment;
mod explanation;
mod shifted;
mod together;

use bolted_joint_statistics::chi_squared_tail;
use bolted_joint_systematic::{
    BandConsistency, Budget, Cause, CauseEstimate, Diagnosis, FAR, Group, MeasuredSet, Score,
    Settings, Shares, Side, Start, Suspect, consistency, curvature, estimate, priors, refine,
};
use nalgebra::DMatrix;

use bolted_joint_frf::Dof;

use super::estimator::first_levels;
use super::layout::Layout;
use super::lines::Lines;
use super::lines_estimate::LinesEstimate;
use super::model::JointMatrices;
use super::noise::Levels;
use super::observed::Observed;
use super::study::Study;
use explanation::{Find, diagnosed, explained};
use together::together;
pub(super) use together::{Apart, are_together};

/// Bands that are asked whether they agree on the joint.
const BANDS: [usize; 2] = [2, 8];
/// Standard deviations by which a loss factor is below zero that no chance explains.
const FEEDS: f64 = 5.0;
/// A gain of all sets that is farther from 1 is another error.
const OUT_OF_SCALE: f64 = 0.5;
/// A p-value below this is no chance.
const CHANCE: f64 = 0.01;
/// Causes whose drops of χ² differ by less than this part cannot be told apart.
const ALIKE: f64 = 0.15;
/// Below this χ² per degree of freedom the noise is less than it was taken for.
const LESS_NOISE: f64 = 0.95;
/// Parts of the level that the residual shows, tried until an estimate is found.
const PARTS_OF_NOISE: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
/// Lines on which joint and causes are sought, …
const MOST_LINES_OF_A_SEARCH: usize = 300;
/// … and those on which what was found is refined.
const MOST_LINES: usize = 4000;
/// How often its level is corrected.
const ROUNDS: usize = 2;

/// What systematic errors do to an estimate.
#[derive(Clone, Debug)]
pub struct Systematic {
    /// How well the study says that its set-up is known.
    pub budget: Budget,
    /// The unknowns that are most likely together with the causes: stiffness of each entry, then damping, joint by joint.
    pub unknowns: Vec<f64>,
    /// Covariance of the unknowns, systematic errors included.
    pub covariance: DMatrix<f64>,
    /// Covariance of the unknowns in an estimate that takes the set-up as exact.
    pub noise_covariance: DMatrix<f64>,
    /// What each unknown's variance would fall by if a group of causes were exact.
    pub shares: Shares,
    /// What is known of each cause after the measurement, with its name.
    pub causes: Vec<(String, CauseEstimate)>,
    /// What speaks against the data without systematic errors, with its name, the most telling first.
    pub suspects: Vec<(String, Suspect)>,
    /// By how much each cause alone would lower χ² in one step from there, with its name, the most first: below about sixteen that
    /// is chance.
    pub scores: Vec<(String, Score)>,
    /// Whether bands agree on the joint, with the p-value.
    pub consistency: Vec<(BandConsistency, f64)>,
    /// χ² over degrees of freedom.
    pub reduced_chi_squared: Option<f64>,
    /// Lines that were used, of how many.
    pub lines: (usize, usize),
    /// Measured structures of which no smooth fit was found: their frequencies take no part.
    pub without_smooth_fit: Vec<Side>,
    /// Whether the search came to rest.
    pub converged: bool,
    /// How much of the information about bolts near each other is noise.
    pub(super) observed: Option<Observed>,
    /// Noise of everything measured.
    levels: Levels,
}

impl Systematic {
    /// What is said where no error of the set-up takes part although the study has a budget.
    pub(super) fn not_applied(apart: Option<Apart>) -> String {
        let why = match apart {
            None => "no estimate with them is found".to_owned(),
            Some(apart) => apart.to_string(),
        };
        format!(
            "errors of the set-up take no part in this estimate: {why}; its deviations are those of noise alone"
        )
    }

    /// Estimates joint and causes from the start that an estimate without causes gives. `None` where the budget is none, where
    /// several assemblies do not have structures, points and lines in common, or where no estimate is found.
    pub(super) fn of(study: &Study, all: &[Lines], estimate: &LinesEstimate) -> Option<Self> {
        if !study.has_causes() {
            return None;
        }
        let all = &together(study, all).ok()?;
        let start = free_unknowns(estimate);
        let data = (all.as_slice(), estimate.joint_numbers());
        let layout = study.layout();
        let mut levels = estimate.levels;
        let mut found = None;
        // Noise that a residual full of other errors shows can be so large that no line is linear in it.
        for part in PARTS_OF_NOISE {
            levels = study.noise.levels(estimate.levels.assembly.scaled(part));
            found = Self::at_levels(study, data, (&layout, levels), &start, &diagnosed);
            if found.is_some() || study.noise.is_stated() {
                break;
            }
        }
        let mut found = found?;
        // Errors of the set-up have raised the noise that the residual seemed to show.
        for _ in 0..ROUNDS {
            let Some(reduced) = found
                .reduced_chi_squared
                .filter(|&reduced| !study.noise.is_stated() && reduced < LESS_NOISE)
            else {
                break;
            };
            levels = study.noise.levels(levels.assembly.scaled(reduced.sqrt()));
            let next = Self::at_levels(study, data, (&layout, levels), &start, &diagnosed);
            let Some(next) = next else {
                break;
            };
            found = next;
        }
        Some(found)
    }

    /// As [`Self::of`], where the estimate without causes leaves much more than the noise that the study states and all causes
    /// together explain it within their limits. `None` where that is not so. They are sought from where that estimate ended, and
    /// `elsewhere` where that leads to nothing.
    pub(super) fn within_limits(
        study: &Study,
        all: &[Lines],
        estimate: &LinesEstimate,
        elsewhere: bool,
    ) -> Option<Self> {
        let reduced = estimate.assessment.reduced_chi_squared;
        let is_far = reduced.is_none_or(|reduced| reduced > FAR);
        if !study.has_causes() || !study.noise.is_stated() || !is_far {
            return None;
        }
        let all = &together(study, all).ok()?;
        let data = (all.as_slice(), estimate.joint_numbers());
        let layout = study.layout();
        let place = (&layout, estimate.levels);
        let from_there: &Find<'_> = &|experiment, priors, start, settings| {
            let settings = Settings {
                seeks_elsewhere: elsewhere,
                ..settings.clone()
            };
            explained(experiment, priors, start, &settings)
        };
        Self::at_levels(study, data, place, &free_unknowns(estimate), from_there)
    }

    /// A joint to start from where the data lead to none as long as the set-up is taken as exact: the first bolt's, with all causes.
    pub(super) fn start(study: &Study, all: &[Lines]) -> Option<JointMatrices> {
        if !study.has_causes() || !study.noise.is_stated() {
            return None;
        }
        let all = together(study, all).ok()?;
        let few: Vec<Lines> = all
            .iter()
            .map(|lines| lines.at_most(MOST_LINES_OF_A_SEARCH))
            .collect();
        let layout = study.layout();
        let levels = first_levels(&study.noise);
        let experiment = experiment::of(study, &few, &vec![0; few.len()], &layout, levels)?;
        let points = &few.first()?.points;
        let priors = priors(&experiment, |cause| study.deviation(cause, points));
        let settings = Settings::default();
        let found = estimate(
            &experiment,
            &priors,
            &Start::typical(&experiment)?,
            &settings,
        )?;
        layout.matrices(&found.unknowns).into_iter().next()
    }

    fn at_levels(
        study: &Study,
        (all, joints): (&[Lines], &[usize]),
        (layout, levels): (&Layout, Levels),
        start: &[f64],
        find: &Find<'_>,
    ) -> Option<Self> {
        let at_most = |most: usize| -> Vec<Lines> {
            let fewer = all.iter().map(|lines| lines.at_most(most));
            fewer.collect()
        };
        let lines = all.first()?;
        let few = at_most(MOST_LINES_OF_A_SEARCH);
        let experiment = experiment::of(study, &few, joints, layout, levels)?;
        let settings = Settings::default();
        let start = Start::without_causes(start);
        let priors = priors(&experiment, |cause| study.deviation(cause, &lines.points));
        let (plain, mut found, diagnosis) = find(&experiment, &priors, &start, &settings)?;
        let Diagnosis {
            suspects, scores, ..
        } = diagnosis;
        let mut noise_alone = plain.covariance.clone();
        // Bolts near each other move nearly alike, and noise passes for information.
        let mut observed = (layout.joints() > 1)
            .then(|| curvature(&experiment, &found))
            .flatten()
            .and_then(|curvature| Observed::of(&found.covariance, &curvature));
        let searched = few.first().map_or(0, |few| few.frequency_hz.len());
        if searched < lines.frequency_hz.len() {
            let many = at_most(MOST_LINES);
            let experiment = experiment::of(study, &many, joints, layout, levels)?;
            if let Some(refined) = refine(&experiment, &found, &settings) {
                found = refined;
                // derivatives at smooth fits have no noise
                observed = None;
            }
            if let Some(refined) = refine(&experiment, &plain, &settings) {
                noise_alone.clone_from(&refined.covariance);
            }
        }
        if let Some(observed) = &observed {
            found.covariance += &observed.added;
            noise_alone += &observed.added;
        }
        let name = |cause: Cause| name(cause, study, lines);
        let consistency = BANDS.iter().filter_map(|&bands| consistency(&plain, bands));
        // Noise that is larger than it is said to be widens everything.
        let widened = |covariance: DMatrix<f64>, reduced: Option<f64>| {
            covariance * reduced.unwrap_or(1.0).max(1.0)
        };
        let causes = found.causes.iter();
        let causes = causes.map(|cause| (name(cause.prior.cause), *cause));
        let is_possible =
            |cause: Cause, value: f64| value >= 0.0 || !study.is_never_negative(cause);
        let suspects = suspects
            .iter()
            .filter(|own| is_possible(own.cause, own.value));
        let suspects = suspects.map(|suspect| (name(suspect.cause), *suspect));
        let scores = scores
            .iter()
            .filter(|own| is_possible(own.cause, own.value));
        let scores = scores.map(|score| (name(score.cause), *score));
        let tested = consistency.map(|found| {
            let tail = chi_squared_tail(found.q, found.freedom);
            (found, tail)
        });
        Some(Self {
            budget: study.budget.clone(),
            causes: causes.collect(),
            suspects: suspects.collect(),
            scores: scores.collect(),
            consistency: tested.collect(),
            noise_covariance: widened(noise_alone, found.reduced_chi_squared),
            covariance: widened(found.covariance, found.reduced_chi_squared),
            unknowns: found.unknowns,
            shares: found.shares,
            reduced_chi_squared: found.reduced_chi_squared,
            lines: (found.lines.0, lines.frequency_hz.len()),
            without_smooth_fit: found.without_smooth_fit,
            converged: found.converged,
            observed,
            levels,
        })
    }

    /// The unknowns of joint number `joint` of several, with their covariance; each has `size` of them.
    pub(super) fn of_joint(&self, joint: usize, size: usize) -> (&[f64], DMatrix<f64>) {
        let first = joint * size;
        let values = self.unknowns.get(first..first + size).unwrap_or_default();
        let own = self.covariance.view((first, first), (size, size));
        (values, own.into_owned())
    }

    /// Parts of each unknown's standard deviation: groups by the part of the variance that they have in the worst unknown.
    #[must_use]
    pub fn largest_groups(&self) -> Vec<(Group, f64)> {
        let groups = self.shares.groups.iter();
        let mut groups: Vec<(Group, f64)> = groups
            .map(|(group, parts)| (*group, parts.iter().copied().fold(0.0, f64::max)))
            .collect();
        groups.sort_by(|one, other| other.1.total_cmp(&one.1));
        groups
    }

    /// Causes whose limits the data contradict, with their sizes.
    pub(super) fn contradicted(&self) -> Vec<String> {
        let contradicted = self
            .causes
            .iter()
            .filter(|(_, cause)| cause.contradicted.is_some());
        contradicted
            .map(|(name, cause)| {
                let ([value, deviation], unit) =
                    shown(cause.prior.cause, [cause.value, cause.standard_deviation]);
                format!("{name}: {value:.3} ± {deviation:.2} {unit}")
            })
            .collect()
    }

    /// That the joint's loss factor is negative beyond all doubt: what dissipates less than it is said to is another part.
    pub(super) fn feeding_energy(&self) -> Option<String> {
        let is_of_joint =
            |(_, own): &&(String, CauseEstimate)| own.prior.cause == Cause::LossFactor;
        let (_, own) = self.causes.iter().find(is_of_joint)?;
        (own.value < -FEEDS * own.standard_deviation).then(|| {
            let ([value, deviation], unit) =
                shown(own.prior.cause, [own.value, own.standard_deviation]);
            format!(
                "the joint would feed energy: its loss factor is {value:.3} ± {deviation:.2} {unit}; the damping of a structure is \
                 stated too high, or phases are wrong"
            )
        })
    }

    /// That all sets would have a gain in common that no calibration leaves: another cause took the search there.
    pub(super) fn out_of_scale(&self) -> Option<String> {
        let is_common = |(_, own): &&(String, CauseEstimate)| own.prior.cause == Cause::CommonGain;
        let (_, own) = self.causes.iter().find(is_common)?;
        (own.value.abs() > OUT_OF_SCALE).then(|| {
            let ([value, _], unit) = shown(own.prior.cause, [own.value, own.standard_deviation]);
            format!(
                "all sets would have a gain of {value:+.0} {unit} in common, which no calibration leaves: another cause is behind it; \
                 correct what the data contradict first"
            )
        })
    }

    /// Whether what it leaves is noise.
    pub(super) fn explains_the_data(&self) -> bool {
        let chi = self.reduced_chi_squared;
        self.converged && chi.is_some_and(|chi| chi <= Settings::default().most_reduced_chi_squared)
    }

    /// The suspects that lower χ² nearly as much as one of them, in words.
    fn not_told_from(&self, name: &str) -> String {
        let Some((_, own)) = self.suspects.iter().find(|(other, _)| other == name) else {
            return String::new();
        };
        let others = self.suspects.iter();
        let alike: Vec<&str> = others
            .filter(|(other, suspect)| {
                other != name && (suspect.drop - own.drop).abs() < ALIKE * own.drop
            })
            .map(|(other, _)| other.as_str())
            .collect();
        match alike.as_slice() {
            [] => String::new(),
            alike => format!(" (these data cannot tell it from: {})", alike.join(", ")),
        }
    }

    /// What a technician should know and do.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for (name, cause) in &self.causes {
            if let Some(pull) = cause.contradicted {
                let ([value, deviation], unit) =
                    shown(cause.prior.cause, [cause.value, cause.standard_deviation]);
                let alike = self.not_told_from(name);
                warnings.push(format!(
                    "the data contradict the error budget: {name} is {value:.3} ± {deviation:.2} {unit} once its limit is widened, \
                     {:.0} times the limit before{alike}; {}",
                    pull.abs(),
                    cause.prior.cause.group().remedy(),
                ));
            }
        }
        warnings.extend(shifted::warning(self));
        for (found, p) in &self.consistency {
            if *p < CHANCE {
                let suspect = match self.suspects.first() {
                    None if self.explains_the_data() => {
                        "the error budget as a whole explains it".to_owned()
                    }
                    None => "none of the known causes explains it".to_owned(),
                    Some((name, suspect)) => {
                        let ([value, _], unit) = shown(suspect.cause, [suspect.value, 0.0]);
                        format!(
                            "most likely: {name} {value:+.3} {unit}{}",
                            self.not_told_from(name)
                        )
                    }
                };
                warnings.push(format!(
                    "{} bands of the range do not agree on the joint (p = {p:.1e}) if the set-up is taken as exact; {suspect}",
                    found.bands.len(),
                ));
                break;
            }
        }
        if let Some(chi) = self
            .reduced_chi_squared
            .filter(|chi| *chi > Settings::default().most_reduced_chi_squared)
        {
            warnings.push(format!(
                "with the error budget χ² per degree of freedom is {chi:.2}: none of the causes in it explains what is left; the joint \
                 model or the study may be wrong, and the intervals are too short"
            ));
        }
        for side in &self.without_smooth_fit {
            warnings.push(format!(
                "no smooth modal fit of {side} was found: causes that need one, such as its frequencies, take no part; a resonance with \
                 fewer than three lines within its half-power bandwidth, which `bolted-joint show` names, is a frequent reason"
            ));
        }
        if !self.converged {
            warnings.push("the estimate with the error budget has not converged: do not rely on its deviations".to_owned());
        }
        warnings
    }
}

/// The unknowns of one joint after the other, free to be active.
fn free_unknowns(estimate: &LinesEstimate) -> Vec<f64> {
    let joints = estimate.joints.iter();
    let values = joints.flat_map(|joint| joint.covariance.values.iter().copied());
    values.collect()
}

/// Values of a cause in a unit for people.
pub(super) fn shown(cause: Cause, values: [f64; 2]) -> ([f64; 2], &'static str) {
    let unit = cause.shown(0.0).1;
    (values.map(|value| cause.shown(value).0), unit)
}

/// What a cause is, with the labels of the study.
fn name(cause: Cause, study: &Study, lines: &Lines) -> String {
    let label = |set: MeasuredSet, row: usize| -> String {
        let point = match set {
            MeasuredSet::Assembly(_) => lines.points.get(row).map(Dof::to_string),
            MeasuredSet::Of(side) => experiment::labels(study, side).get(row).map(Dof::to_string),
        };
        point.unwrap_or_else(|| format!("number {}", row + 1))
    };
    let bolt = |bolt: usize| match study.bolts.names().get(bolt) {
        Some(name) => format!(" at bolt {name}"),
        None => String::new(),
    };
    match cause {
        Cause::Gain(set) => format!("gain of {set}"),
        Cause::CommonGain => "gain of all sets".to_owned(),
        Cause::ChannelGain(set, row) => format!("gain of the channel {} of {set}", label(set, row)),
        Cause::CommonDelay => "delay of all sets".to_owned(),
        Cause::Delay(set) => format!("delay of {set}"),
        Cause::Phase(set) => format!("phase of {set}"),
        Cause::Accelerometer(set) => format!("mass of the accelerometer on {set}"),
        Cause::Position(point) => format!(
            "position of {} on the assembly",
            label(MeasuredSet::Assembly(0), point)
        ),
        Cause::JointPosition(side, of) => format!("position of the joint on {side}{}", bolt(of)),
        Cause::JointBending(side, of) => format!("bending beside the joint on {side}{}", bolt(of)),
        Cause::Frequency(side) => format!("frequencies of {side} in the assembly"),
        Cause::YoungsModulus(side) => format!("Young's modulus of {side}"),
        Cause::Density(side) => format!("density of {side}"),
        Cause::StructureDamping(side) => format!("damping of {side}"),
        Cause::JointMass(side, of) => format!("mass at the joint on {side}{}", bolt(of)),
        Cause::JointInertia(side, of) => {
            format!("moment of inertia at the joint on {side}{}", bolt(of))
        }
        Cause::LossFactor => "loss factor of the joint".to_owned(),
        Cause::DifferenceStiffness(side) => {
            format!("bending stiffness of {side} behind its rotation")
        }
        Cause::DifferenceSpacing(side) => {
            format!("spacing of the points of {side} that its rotation is of")
        }
    }
}
