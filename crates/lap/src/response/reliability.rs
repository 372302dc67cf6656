//! Whether a lap model may be relied on at all: whether the search came to an end, whether the data determine the joint's
//! stiffness, and whether the law has anything to do with what was measured. What is merely worse than it could be is warned of
//! instead.

use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

use super::model::ResponseUnknown;
use super::prediction::Expected;
use super::result::LapResponse;
use super::study::{LapResponseStudy, NoiseIs};

/// Standard deviations that the estimate may still move when the search ends: added to its error, √(1 + 0.3²), they widen it
/// by less than a twentieth.
const TOLERABLE_UNREST: f64 = 0.3;
/// χ² per degree of freedom below which a residual is rounding.
const ROUNDING: f64 = 1e-12;
/// χ² per degree of freedom beyond which the residual, ten times the stated noise, is another thing than noise. Where none is
/// stated it is ten times the nominal one of sines: good data of beams with friction leave six times that.
pub(super) const ABSURD: f64 = 100.0;
/// χ² per degree of freedom up to which known noise accounts for a residual, however large.
const NOISE: f64 = 1.5;
/// Relative differences that half of the values must stay below: of receptances and damping ratios, and of frequencies.
const MISFIT: f64 = 0.5;
const MISFIT_OF_FREQUENCIES: f64 = 0.05;
/// Relative errors (root mean square) of damping ratios and of frequencies along curves whose noise is not stated, beyond which
/// the law is wrong, if neighbouring points err alike: a good law leaves 12 % and 0.1 % of a published curve with friction.
const WRONG: f64 = 0.2;
const WRONG_OF_FREQUENCIES: f64 = 5e-3;
/// Searches beside which one alone that came to its estimate says nothing of whether there is a better one.
pub(super) const FEW_STARTS: usize = 3;

impl LapResponse {
    /// What speaks against the estimate, a line each; empty if nothing does.
    #[must_use]
    pub fn reasons_against(&self, study: &LapResponseStudy) -> Vec<String> {
        let mut reasons = Vec::new();
        reasons.extend(self.because_of_the_search(study));
        reasons.extend(self.because_nothing_is_told());
        reasons.extend(self.because_of_the_noise(study));
        reasons.extend(self.because_of_a_run(study));
        reasons.extend(self.because_of_misfit(study));
        reasons
    }

    fn because_of_the_search(&self, study: &LapResponseStudy) -> Option<String> {
        // χ² falls by the square of the deviations that the estimate still moves by
        let noise = (self.inflation * self.inflation).max(ROUNDING);
        let steps = (self.fit.left.max(0.0) / noise).sqrt();
        let left = steps.max(self.unrest);
        if left > TOLERABLE_UNREST {
            let by = match left.is_finite() {
                true => format!(": it still moved by {left:.1} standard deviations"),
                // nothing tells how far
                false => String::new(),
            };
            return Some(format!("the search for the estimate has not converged{by}"));
        }
        let (followed, agreeing) = self.starts;
        // where noise is all that is left no other estimate can be much better
        let is_alone = followed >= FEW_STARTS && agreeing < 2;
        (is_alone && !self.is_explained(study)).then(|| {
            format!(
                "{agreeing} of {followed} searches came to this estimate, the others to worse ones: there may be a better one; take \
                 fewer terms, or state what is known in [known]"
            )
        })
    }

    fn because_nothing_is_told(&self) -> Option<String> {
        let is_open = |unknown: ResponseUnknown| {
            let mut estimates = self.estimates.iter();
            estimates.any(|own| own.unknown == unknown && !own.is_identified)
        };
        let all_open = self.estimates.iter().all(|own| !own.is_identified);
        let of_mass = match is_open(ResponseUnknown::Mass) {
            true => ": nothing tells the mass; state m in [known], or give the forces",
            false => "",
        };
        if !self.estimates.is_empty() && all_open {
            return Some(format!("the data determine none of the unknowns{of_mass}"));
        }
        let joint = ResponseUnknown::JointStiffness;
        is_open(joint).then(|| format!("the data do not determine {}{of_mass}", joint.symbol()))
    }

    /// Whether the estimate leaves no more than noise: as much as is known, or where none is known not much more than is taken, and
    /// that without a pattern.
    fn is_explained(&self, study: &LapResponseStudy) -> bool {
        let reduced = self.free_chi_squared();
        match study.knows_noise() {
            true => reduced <= NOISE,
            false => !self.is_far_from_noise(study) && self.leaves_noise(study),
        }
    }

    fn because_of_the_noise(&self, study: &LapResponseStudy) -> Option<String> {
        let reduced = self.free_chi_squared();
        let law = &self.model.terms;
        match study.noise_is() {
            NoiseIs::Stated => (reduced > ABSURD).then(|| {
                format!(
                    "the residual is {:.0} times the stated noise: the law \"{law}\" is not that of the data, or the noise is larger than \
                     [noise] states",
                    reduced.sqrt(),
                )
            }),
            _ if self.leaves_noise(study) => None,
            NoiseIs::Nominal if self.backbones.iter().all(|run| run.left_out) => {
                (reduced > ABSURD).then(|| {
                    format!(
                        "the residual is {:.0} times the noise of 1 % that is taken where none is stated, and not that of noise: the law \
                         \"{law}\" is not that of the data, or a run has another unit or convention; else state [noise]",
                        reduced.sqrt(),
                    )
                })
            }
            // decays tell their noise
            NoiseIs::OfRecords if reduced <= ABSURD => None,
            NoiseIs::Nominal | NoiseIs::OfRecords => self.because_of_curves(),
        }
    }

    /// Curves that the law misses by far.
    fn because_of_curves(&self) -> Option<String> {
        let mean = |of: &dyn Fn(&super::PointPrediction) -> Option<Expected>| {
            let fitted = self.backbones.iter().filter(|run| !run.left_out);
            let points = fitted.flat_map(|run| run.points.iter().filter_map(of));
            let squares: Vec<f64> = points
                .map(|own| (own.measured / own.predicted - 1.0).powi(2))
                .collect();
            (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
        };
        let kinds = [
            ("damping ratios", mean(&|point| point.damping_ratio), WRONG),
            (
                "frequencies",
                mean(&|point| Some(point.frequency_hz)),
                WRONG_OF_FREQUENCIES,
            ),
        ];
        let mut kinds = kinds.into_iter();
        let (what, off, most) = kinds.find(|(_, off, most)| off > most)?;
        Some(format!(
            "the {what} are {:.1} % (root mean square) off the model, where {:.1} % is the most, and not by chance: the law \"{}\" is not \
             that of the data, or they are another quantity; else state [noise]",
            100.0 * off,
            100.0 * most,
            self.model.terms
        ))
    }

    /// A run of which half is another thing than the model's: beside better ones it is a minority of all lines.
    fn because_of_a_run(&self, study: &LapResponseStudy) -> Option<String> {
        if study.knows_noise() && self.free_chi_squared() <= NOISE {
            return None;
        }
        let runs = self.receptance_misfits(study).into_iter();
        let (runs, off): (Vec<&str>, Vec<f64>) = runs.filter(|(_, off)| *off > MISFIT).unzip();
        let off = off.into_iter().reduce(f64::min)?;
        let runs = runs.join(", ");
        Some(format!(
            "half of the receptances of {runs} are more than {:.0} % off the model: the study does not describe what was measured (units, \
             phases, places), or the law \"{}\" has nothing to do with it",
            100.0 * off,
            self.model.terms
        ))
    }

    fn because_of_misfit(&self, study: &LapResponseStudy) -> Option<String> {
        if study.knows_noise() && self.free_chi_squared() <= NOISE {
            return None;
        }
        let of_curves = |of: &dyn Fn(&[super::PointPrediction]) -> Vec<Expected>| {
            let fitted = self.backbones.iter().filter(|run| !run.left_out);
            let all = fitted.flat_map(|run| of(&run.points));
            let off = all.map(|own| (own.measured / own.predicted - 1.0).abs());
            upper_median(off.filter(|off| off.is_finite()))
        };
        let frequencies =
            of_curves(&|points| points.iter().map(|point| point.frequency_hz).collect());
        let ratios = of_curves(&|points| {
            let ratios = points.iter().filter_map(|point| point.damping_ratio);
            ratios.collect()
        });
        let kinds = [
            ("frequencies", frequencies, MISFIT_OF_FREQUENCIES),
            ("damping ratios", ratios, MISFIT),
        ];
        let mut kinds = kinds.into_iter();
        let (what, off) =
            kinds.find_map(|(what, off, most)| Some((what, off.filter(|off| *off > most)?)))?;
        Some(format!(
            "half of the {what} are more than {:.0} % off the model: the study does not describe what was measured (units, phases, \
             places), or the law \"{}\" has nothing to do with it",
            100.0 * off,
            self.model.terms
        ))
    }

    /// Median of |measured − computed|/max(|measured|, |computed|) over the lines of each sine that was fitted.
    fn receptance_misfits<'s>(&self, study: &'s LapResponseStudy) -> Vec<(&'s str, f64)> {
        let mut amplitudes_m = self.fit.amplitudes_m.iter();
        let fitted = study
            .sines
            .iter()
            .filter(|run| run.used_for == super::Use::Fit);
        let misfits = fitted.filter_map(|run| {
            let values = run.lines.iter().zip(amplitudes_m.by_ref());
            let off = values.map(|(line, &amplitude_m)| {
                let (computed, _) =
                    self.model
                        .receptance(&self.fit.values, amplitude_m, line.omega);
                let measured =
                    Complex64::from_polar(line.displacement_m / line.force_n, line.phase_rad);
                (measured - computed).norm() / measured.norm().max(computed.norm())
            });
            Some((
                run.name.as_str(),
                upper_median(off.filter(|off| off.is_finite()))?,
            ))
        });
        misfits.collect()
    }
}
