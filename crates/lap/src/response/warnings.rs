//! What the reader of a lap model identified from responses should know before using it.

use bolted_joint_frf::structure::large_damping_ratio;
use num_complex::Complex64;

use super::data::Use;
use super::decay::{InTime, NotInTime};
use super::kinks::of_few_beyond;
use super::plausible;
use super::prediction::BackbonePrediction;
use super::reliability::ABSURD;
use super::result::LapResponse;
use super::study::{LapResponseStudy, NoiseIs};

/// χ² per degree of freedom up to which a known noise may explain the residual, as it is seldom known better than by a seventh, and from
/// which on it does not; between them, where chance leads no farther than this many deviations.
const TOO_LARGE: [f64; 2] = [1.3, 1.5];
const BY_CHANCE: f64 = 5.0;
/// The same where no noise was stated, so that a nominal one is compared with: three times its deviations.
const FAR_TOO_LARGE: f64 = 9.0;
/// χ² per degree of freedom below which a stated noise is more than there is.
const TOO_SMALL: f64 = 0.3;
/// Difference of Schwarz's criterion that is strong evidence.
const STRONG: f64 = 10.0;
/// By how much −2 ln L of the passive estimate may be above the free one's by chance: five standard deviations.
const CHANCE: f64 = 25.0;
/// Errors of the resonance of a run left out that are worth a word: frequency in Hz, relative amplitude.
const FREQUENCY_HZ: f64 = 0.1;
const AMPLITUDE: f64 = 0.1;
/// Part of the numbers of a run left out that may lie outside of intervals of 95 %: those of neighbouring points go together.
const OUTSIDE: f64 = 0.25;
/// Part of a record's largest value below which the motion that is read of it is not that of its beginning.
const BEGINNING: f64 = 0.5;
/// Correlation of neighbouring residuals that is a pattern, and how many of its deviations it is by then.
const PATTERN: f64 = 0.3;
const CERTAIN: f64 = 5.0;
const FEWEST_PAIRS: usize = 20;
/// What wider intervals do not do.
pub(super) const NO_CURE: &str = "wider intervals are no cure for a wrong law: they hold only if the residual is noise; look at \
                                  what the model leaves out";

impl LapResponse {
    /// The warnings.
    #[must_use]
    pub fn warnings(&self, study: &LapResponseStudy) -> Vec<String> {
        let mut warnings = study.repeats.found.clone();
        warnings.extend(study.cut_back.clone());
        warnings.extend(of_damping(study));
        warnings.extend(plausible::of_data(study));
        warnings.extend(self.of_sizes(study));
        let open = self.not_identified();
        if !open.is_empty() {
            warnings.push(format!(
                "{} cannot be identified from these data",
                open.join(", ")
            ));
        }
        warnings.extend(of_few_beyond(study, &self.fit));
        warnings.extend(self.of_price());
        warnings.extend(self.of_residual(study));
        warnings.extend(self.misfit.told());
        warnings.extend(self.of_pattern(study));
        warnings.extend(self.of_lost_motion());
        if let InTime::Read(_) = self.in_time {
            warnings.extend(of_beginnings(study));
        }
        let is_of_one = self.fit.values.slider.is_none();
        if is_of_one && self.model.harmonics < study.harmonics && !study.sines.is_empty() {
            let why = match self.fit.reduced_chi_squared() > ABSURD {
                true => "the law is too far from the data for others to tell",
                false => "with others it did not converge",
            };
            warnings.push(format!(
                "the estimate is that of one harmonic, not of {}: {why}",
                study.harmonics
            ));
        }
        if let (Some(slider), Some(stated)) = (self.model.terms.slider(), study.stated_harmonics)
            && stated > 1
            && !study.sines.is_empty()
        {
            warnings.push(format!(
                "`model.harmonics = {stated}` has no effect with \"{}\": laws that slip are fitted by their closed loops of one harmonic",
                slider.name()
            ));
        }
        let own = self
            .comparison
            .iter()
            .find(|model| model.terms == self.model.terms);
        let best = self
            .comparison
            .iter()
            .find(|model| model.bic_difference == 0.0);
        // models are compared by what was read of decays; a fit to their samples is another one
        if self.in_time != InTime::Fitted
            && let (Some(own), Some(best)) = (own, best)
            && own.bic_difference > STRONG
        {
            warnings.push(format!(
                "the terms \"{}\" explain the data better than \"{}\": BIC {:.1} lower",
                best.terms, own.terms, own.bic_difference
            ));
        }
        for row in self.predictions.iter().filter(|row| row.left_out) {
            let missed_frequency = row
                .frequency_error_hz()
                .is_none_or(|error| error.abs() > FREQUENCY_HZ);
            let missed_amplitude = row
                .amplitude_error()
                .is_none_or(|error| error.abs() > AMPLITUDE);
            if missed_frequency || missed_amplitude {
                warnings.push(format!(
                    "the resonance of {}, which was left out, is missed by more than {FREQUENCY_HZ} Hz or {} %",
                    self.named(row),
                    100.0 * AMPLITUDE
                ));
            }
        }
        for row in self.backbones.iter().filter(|row| row.left_out) {
            let missed_damping = row.damping_error.is_some_and(|error| error > AMPLITUDE);
            if row.frequency_error_hz > FREQUENCY_HZ || missed_damping {
                warnings.push(format!(
                    "{}, which was left out, is missed by more than {FREQUENCY_HZ} Hz or {} % of its damping",
                    row.run,
                    100.0 * AMPLITUDE
                ));
            }
            let (all, outside) = row.outside();
            if outside as f64 > OUTSIDE * all as f64 {
                warnings.push(format!(
                    "{}, which was left out, has {outside} of {all} frequencies and damping ratios outside of what is expected with 95 %: \
                     the law is not that of this run{}",
                    row.run,
                    self.beyond(row)
                ));
            }
        }
        warnings
    }

    /// That neighbouring points of sines and backbones err alike, as noise does not.
    fn of_pattern(&self, study: &LapResponseStudy) -> Option<String> {
        // records of decays have a test of their own
        if study.noise_is() == NoiseIs::OfRecords {
            return None;
        }
        let (correlation, deviation) = self.pattern(study)?;
        (correlation > PATTERN.max(CERTAIN * deviation)).then(|| {
            format!(
                "what the law leaves is not noise: the residuals of neighbouring points are correlated ({correlation:.2}); the law, or \
                 something that the study states as known (a mass, a phase, a delay, other modes), is not that of the data, and the \
                 intervals do not hold it"
            )
        })
    }

    /// Correlation of neighbouring residuals, and its standard deviation by chance; `None` of too few.
    fn pattern(&self, study: &LapResponseStudy) -> Option<(f64, f64)> {
        neighbours(&self.residuals_by_run(study))
    }

    /// Whether neighbouring residuals are as independent as those of noise; not, where there are too few to tell.
    pub(super) fn leaves_noise(&self, study: &LapResponseStudy) -> bool {
        let pattern = self.pattern(study);
        pattern.is_some_and(|(correlation, _)| correlation <= PATTERN)
    }

    /// That the law's own motion does not follow the records that it is said to be of.
    fn of_lost_motion(&self) -> Option<String> {
        (self.in_time == InTime::Read(NotInTime::Lost)).then(|| {
            format!(
                "no motion of the law \"{}\" follows the records, though what was read of them fits: the law is not that of the joint, or \
                 the records have more in them than one mode",
                self.model.terms
            )
        })
    }

    /// Which amplitudes of a run lie beyond those that were fitted.
    fn beyond(&self, run: &BackbonePrediction) -> String {
        let ends = |runs: &mut dyn Iterator<Item = f64>| {
            runs.fold([f64::INFINITY, 0.0_f64], |[low, high], amplitude_m| {
                [low.min(amplitude_m), high.max(amplitude_m)]
            })
        };
        let of_points = |run: &BackbonePrediction| {
            let points = run.points.iter().map(|point| point.amplitude_m);
            points.collect::<Vec<f64>>()
        };
        let fitted = self.backbones.iter().filter(|run| !run.left_out);
        let of_sines = self.fit.amplitudes_m.iter().copied();
        let [from, to] = ends(&mut fitted.flat_map(of_points).chain(of_sines));
        let [least, largest] = ends(&mut of_points(run).into_iter());
        match least < from || largest > to {
            true => format!(
                ", which goes from {least:.2e} to {largest:.2e} m where {from:.2e} to {to:.2e} m were fitted"
            ),
            false => String::new(),
        }
    }

    /// What it costs that the joint is passive.
    fn of_price(&self) -> Option<String> {
        let free = self.free.as_ref()?;
        let limits: Vec<String> = self
            .fit
            .at_limits
            .iter()
            .map(|at| at.limit.to_string())
            .collect();
        let cause = match self.price > CHANCE {
            true => {
                ", far more than noise explains: the data themselves feed energy; look at the phase and its sign, at what else \
                 drives the structure, and at what the model leaves out"
            }
            false => "",
        };
        Some(format!(
            "the free estimate would feed energy; the joint is the passive one that fits best, which holds {} at zero: χ² per \
             degree of freedom {:.4} in place of {:.4}, −2 ln L higher by {:.1}{cause}",
            limits.join(" and "),
            self.fit.reduced_chi_squared(),
            free.reduced_chi_squared(),
            self.price
        ))
    }

    /// χ² per degree of freedom of the estimate that need not be passive: a joint that has to be may leave more.
    pub(super) fn free_chi_squared(&self) -> f64 {
        let free = self.free.as_ref().unwrap_or(&self.fit);
        free.reduced_chi_squared()
    }

    /// Whether the residual is so much more than the noise that the law is in doubt.
    pub(super) fn is_far_from_noise(&self, study: &LapResponseStudy) -> bool {
        let [least, most] = TOO_LARGE;
        let freedom = self.fit.degrees_of_freedom.max(1) as f64;
        self.free_chi_squared()
            > match study.knows_noise() {
                true => (1.0 + BY_CHANCE * (2.0 / freedom).sqrt()).clamp(least, most),
                false => FAR_TOO_LARGE,
            }
    }

    /// Whether the residual is what the noise should leave.
    fn of_residual(&self, study: &LapResponseStudy) -> Option<String> {
        let reduced = self.free_chi_squared();
        let is_far = self.is_far_from_noise(study);
        let (times, percent) = (reduced.sqrt(), 100.0 / reduced);
        let raised = |explained: &str, advice: &str| {
            format!(
                "the residual is {times:.1} times {explained}: χ² per degree of freedom {reduced:.3}, of which noise explains {percent:.0} %; \
                 all intervals were made {times:.1} times as wide, but {NO_CURE}{advice}"
            )
        };
        match study.noise_is() {
            NoiseIs::Stated if is_far => {
                Some(raised("the stated noise", ", and at the stated noise"))
            }
            NoiseIs::Stated if reduced < TOO_SMALL => Some(format!(
                "the residual is much less than the stated noise: χ² per degree of freedom {reduced:.3}; the standard deviations are \
                 those of the stated noise"
            )),
            NoiseIs::OfRecords if is_far => {
                Some(raised("what the noise of the decays' records explains", ""))
            }
            NoiseIs::Nominal if is_far => Some(raised(
                "the noise that is taken where none is stated",
                ", or state [noise]",
            )),
            _ => None,
        }
    }
}

/// Tables of damping ratios that hardly let a lap swing.
fn of_damping(study: &LapResponseStudy) -> Vec<String> {
    let tables = study.backbones.iter().filter(|run| run.recorded.is_none());
    let told = tables.filter_map(|run| {
        let ratios = run.lines.iter().filter_map(|line| line.damping_ratio);
        let told = large_damping_ratio(ratios.fold(0.0, f64::max))?;
        Some(format!("{}: {told}", run.name))
    });
    told.collect()
}

/// Records whose beginning is not read: a window as long as a narrow band asks for is over before a quick decay is.
fn of_beginnings(study: &LapResponseStudy) -> Vec<String> {
    let fitted = study.backbones.iter();
    let fitted = fitted.filter(|run| run.used_for == Use::Fit);
    let parts = fitted.filter_map(|run| Some((run, run.recorded.as_ref()?.read_part)));
    let late = parts.filter(|(_, part)| *part < BEGINNING);
    late.map(|(run, part)| {
        let largest_m = run.lines.iter().map(|line| line.amplitude_m);
        format!(
            "{}: the largest amplitude that is read, {:.2e} m, is {:.0} % of what the record begins with: nothing is known of larger ones, \
             and what slips only there is not told; {}",
            run.name,
            largest_m.fold(0.0, f64::max),
            100.0 * part,
            match run.recorded.as_ref().is_some_and(|own| own.has_band) {
                true => "make `band` as wide as the other modes allow, or filter these out and leave `band` out",
                false => "the window of the reading is longer than that lasted, or the table begins before the release",
            }
        )
    })
    .collect()
}

/// Lag-one correlation over all runs, and its standard deviation by chance; `None` of too few values.
fn neighbours(runs: &[Vec<Complex64>]) -> Option<(f64, f64)> {
    let (mut sum, mut pairs) = (0.0, 0);
    for run in runs {
        let power: f64 = run.iter().map(|own| own.norm_sqr()).sum::<f64>() / run.len() as f64;
        if power > 0.0 {
            let of_pair = |pair: &[Complex64]| (pair[0].conj() * pair[1]).re / power;
            sum += run.windows(2).map(of_pair).sum::<f64>();
            pairs += run.len() - 1;
        }
    }
    (pairs >= FEWEST_PAIRS).then(|| (sum / pairs as f64, (pairs as f64).sqrt().recip()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_alternates_and_what_goes_slowly_is_told_from_noise() {
        let run = |of: &dyn Fn(f64) -> f64| -> Vec<Complex64> {
            (0..100)
                .map(|i| Complex64::from(of(f64::from(i))))
                .collect()
        };
        let of = |run: Vec<Complex64>| neighbours(&[run]).unwrap().0;
        // cos(ω) of a sine, and −1 of what alternates
        assert!((of(run(&|i| (0.1 * i).sin())) - 0.1_f64.cos()).abs() < 0.02);
        assert!((of(run(&|i| (std::f64::consts::PI * i).cos())) + 1.0).abs() < 1e-12);
        assert_eq!(neighbours(&[vec![Complex64::ONE; 5]]), None);
    }
}
