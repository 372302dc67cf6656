//! The structures' functions as measured, freed of what causes have done to them: what the true receptances would have to be.

use num_complex::Complex64;

use super::budget::Prior;
use super::cause::{Cause, MeasuredSet, Side};
use super::effect::At;
use super::experiment::{ComplexMatrix, MeasuredFunctions, Structure};
use super::line::{Labelled, Point, Task, variance};
use super::structures::value_of;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

impl Task<'_> {
    /// Receptances of the labels without their noise, where a fit gives them.
    pub(crate) fn smooth(&self, line: usize, point: &Point, labelled: &Labelled) -> Labelled {
        [Side::A, Side::B].map(|side| {
            let now = &labelled[side as usize];
            let needed = !self.priors.is_empty();
            let Some(fit) = needed.then(|| self.experiment.fit(side)).flatten() else {
                return now.clone();
            };
            let pairs = fit.values(line).iter().zip(now);
            let fitted: Vec<Complex64> = pairs.map(|(fit, now)| fit.unwrap_or(*now)).collect();
            let unloaded = self.unloaded(side, line, point, &fitted);
            self.freed(side, line, point, &unloaded, |entry| fitted[entry])
        })
    }

    /// What was measured of a structure at a line, without the masses of accelerometers as far as the drive points tell.
    pub(crate) fn unloaded(
        &self,
        side: Side,
        line: usize,
        point: &Point,
        raw: &[Complex64],
    ) -> Vec<Complex64> {
        let Structure::Measured(measured) = self.experiment.side(side) else {
            return Vec::new();
        };
        let mass_kg = value_of(
            Cause::Accelerometer(MeasuredSet::Of(side)),
            self.priors,
            &point.causes,
        );
        if mass_kg == 0.0 {
            return raw.to_vec();
        }
        let measured_matrix = measured.functions.matrix(raw);
        let at = self.at_structure(side, &measured.functions, &measured_matrix, line);
        at.unloaded(mass_kg)
    }

    /// What was measured of a structure at a line, without the causes.
    pub(crate) fn without_causes(
        &self,
        side: Side,
        line: usize,
        point: &Point,
        labelled: &[Complex64],
    ) -> Vec<Complex64> {
        let Structure::Measured(measured) = self.experiment.side(side) else {
            return Vec::new();
        };
        self.freed(side, line, point, labelled, |entry| {
            measured.functions.entries[entry].values[line]
        })
    }

    /// h₀ = R z/φ − a, a following from the true receptances.
    fn freed(
        &self,
        side: Side,
        line: usize,
        point: &Point,
        truth: &[Complex64],
        measured_at: impl Fn(usize) -> Complex64,
    ) -> Vec<Complex64> {
        let Structure::Measured(measured) = self.experiment.side(side) else {
            return Vec::new();
        };
        let functions = &measured.functions;
        let epsilon = value_of(Cause::Frequency(side), self.priors, &point.causes);
        let ratios = self.ratios(side, line, epsilon);
        let entries = || functions.entries.iter().enumerate();
        // as they were in the structure's own test
        let now: Vec<Complex64> = entries()
            .zip(truth)
            .map(|((number, _), truth)| truth / ratios[number])
            .collect();
        let truth = functions.matrix(&now);
        let at = self.at_structure(side, functions, &truth, line);
        let beside = at.beside(self.priors, &point.causes);
        let factors = at.factors(self.priors, &point.causes);
        let left: Vec<Complex64> = entries()
            .map(|(number, entry)| {
                if entry.measurements.is_empty() {
                    return ZERO;
                }
                let clean = measured_at(number) / factors[number];
                clean - now[number] - beside[number]
            })
            .collect();
        let change = match at.by_truth(self.priors, &point.causes) {
            Some(by_truth) => at.by_loaded(&by_truth, &left),
            None => left,
        };
        entries()
            .map(|(number, entry)| {
                if entry.measurements.is_empty() {
                    measured_at(number)
                } else {
                    ratios[number] * (now[number] + change[number])
                }
            })
            .collect()
    }

    /// How [`Self::without_causes`] moves with each cause; `None` where it does not.
    pub(crate) fn by_causes(
        &self,
        side: Side,
        line: usize,
        point: &Point,
        labelled: &[Complex64],
    ) -> Vec<Option<Vec<Complex64>>> {
        let Structure::Measured(measured) = self.experiment.side(side) else {
            return vec![None; self.priors.len()];
        };
        let functions = &measured.functions;
        let truth = functions.matrix(labelled);
        let at = self.at_structure(side, functions, &truth, line);
        let by_truth = at.by_truth(self.priors, &point.causes);
        let of = |(prior, value): (&Prior, &f64)| match prior.cause {
            Cause::Frequency(of) if of == side => {
                let step = 1e-3 * prior.standard_deviation;
                let [here, above, below] = [*value, value + step, value - step]
                    .map(|epsilon| self.ratios(side, line, epsilon));
                let entries = functions.entries.iter().zip(labelled).enumerate();
                let change = entries.map(|(number, (entry, value_here))| {
                    if entry.measurements.is_empty() {
                        return ZERO;
                    }
                    let slope = (above[number] - below[number]) / (2.0 * step);
                    value_here * slope / here[number]
                });
                Some(change.collect())
            }
            cause => {
                let by_cause = at.by_cause(cause, *value)?.into_iter();
                let change: Vec<Complex64> = by_cause.map(|change| -change).collect();
                Some(match &by_truth {
                    Some(by_truth) => at.by_loaded(by_truth, &change),
                    None => change,
                })
            }
        };
        self.priors.iter().zip(&point.causes).map(of).collect()
    }

    pub(crate) fn at_structure<'r>(
        &self,
        side: Side,
        functions: &'r MeasuredFunctions,
        truth: &'r ComplexMatrix,
        line: usize,
    ) -> At<'r> {
        At {
            set: MeasuredSet::Of(side),
            functions,
            truth,
            omega: self.experiment.omega[line],
            slopes: None,
        }
    }

    /// Variance of each labelled receptance of A, then of B, at a line.
    pub(crate) fn labelled_variance(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
    ) -> Vec<f64> {
        let of = |side: Side| {
            let Structure::Measured(measured) = self.experiment.side(side) else {
                return Vec::new();
            };
            let functions = &measured.functions;
            let entries = functions.entries.iter();
            let mut variances: Vec<f64> = entries.map(|entry| variance(entry, line)).collect();
            let truth = functions.matrix(&labelled[side as usize]);
            let at = self.at_structure(side, functions, &truth, line);
            if let Some(by_truth) = at.by_truth(self.priors, &point.causes) {
                at.variance_of_truth(&by_truth, &mut variances);
            }
            variances
        };
        [of(Side::A), of(Side::B)].concat()
    }
}
