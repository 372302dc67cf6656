//! What causes do to measured functions: z = φ (h + a), with a factor φ and a part a beside the true receptances h.

use num_complex::Complex64;

use super::budget::Prior;
use super::cause::{Cause, MeasuredSet};
use super::experiment::{ComplexMatrix, Entry, MeasuredFunctions};
use super::slope::PointSlopes;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// The functions of one set at one line.
pub(crate) struct At<'f> {
    pub(crate) set: MeasuredSet,
    pub(crate) functions: &'f MeasuredFunctions,
    /// True receptances over the labels.
    pub(crate) truth: &'f ComplexMatrix,
    pub(crate) omega: f64,
    /// Slopes at the labels of an assembly, where positions are known.
    pub(crate) slopes: Option<Slopes<'f>>,
}

/// What slopes are made of.
#[derive(Clone, Copy)]
pub(crate) struct Slopes<'f> {
    pub(crate) of_points: &'f PointSlopes,
    /// Motions at the joint, A's and B's, by loads at the labels.
    pub(crate) at_joint: &'f ComplexMatrix,
}

impl At<'_> {
    fn is_of_assembly(&self) -> bool {
        matches!(self.set, MeasuredSet::Assembly(_))
    }

    /// φ of every entry with these values of the causes.
    pub(crate) fn factors(&self, priors: &[Prior], values: &[f64]) -> Vec<Complex64> {
        let entries = &self.functions.entries;
        let mut gain_of_all = 1.0;
        let mut gains = vec![0.0; entries.len()];
        let mut phase = 0.0;
        for (prior, &value) in priors.iter().zip(values) {
            match prior.cause {
                Cause::CommonGain => gain_of_all += value,
                Cause::Gain(set) if set == self.set => gain_of_all += value,
                Cause::ChannelGain(set, row) if set == self.set && value != 0.0 => {
                    for (gain, entry) in gains.iter_mut().zip(entries) {
                        *gain += value * share_of_row(entry, row);
                    }
                }
                Cause::CommonDelay => phase -= self.omega * value,
                Cause::Delay(set) if set == self.set => phase -= self.omega * value,
                Cause::Phase(set) if set == self.set => phase += value,
                _ => {}
            }
        }
        let turned = Complex64::cis(phase);
        let gains = gains.into_iter();
        gains.map(|gain| turned * (gain_of_all + gain)).collect()
    }

    /// a of every entry with these values of the causes.
    pub(crate) fn beside(&self, priors: &[Prior], values: &[f64]) -> Vec<Complex64> {
        let mut beside = vec![ZERO; self.functions.entries.len()];
        for (prior, &value) in priors.iter().zip(values) {
            if value == 0.0 {
                continue;
            }
            match prior.cause {
                Cause::Accelerometer(set) if set == self.set => {
                    for (sum, entry) in beside.iter_mut().zip(&self.functions.entries) {
                        *sum += self.loaded(entry, value);
                    }
                }
                Cause::Position(point) if self.is_of_assembly() => {
                    for (sum, entry) in beside.iter_mut().zip(&self.functions.entries) {
                        *sum += self.shifted(entry, point) * value;
                    }
                }
                _ => {}
            }
        }
        beside
    }

    /// ∂z/∂ν of every entry at a value of the cause; `None` where the cause does not act on what was measured.
    pub(crate) fn by_cause(&self, cause: Cause, value: f64) -> Option<Vec<Complex64>> {
        let truth = |entry: &Entry| self.truth[entry.place];
        let of: Box<dyn Fn(&Entry) -> Complex64> = match cause {
            Cause::CommonGain => Box::new(truth),
            Cause::Gain(set) if set == self.set => Box::new(truth),
            Cause::ChannelGain(set, row) if set == self.set => {
                Box::new(move |entry| truth(entry) * share_of_row(entry, row))
            }
            Cause::CommonDelay => {
                Box::new(move |entry| truth(entry) * Complex64::new(0.0, -self.omega))
            }
            Cause::Delay(set) if set == self.set => {
                Box::new(move |entry| truth(entry) * Complex64::new(0.0, -self.omega))
            }
            Cause::Phase(set) if set == self.set => {
                Box::new(move |entry| truth(entry) * Complex64::i())
            }
            Cause::Accelerometer(set) if set == self.set => {
                Box::new(move |entry| self.by_mass(entry, value))
            }
            Cause::Position(point) if self.is_of_assembly() && self.slopes.is_some() => {
                Box::new(move |entry| self.shifted(entry, point))
            }
            _ => return None,
        };
        // What is not measured has no error.
        let measured = |entry: &Entry| {
            if entry.measurements.is_empty() {
                ZERO
            } else {
                of(entry)
            }
        };
        Some(self.functions.entries.iter().map(measured).collect())
    }

    /// What a mass m at the response adds: h_ij ω² m h_ii/(1 − ω² m h_ii), over the measurements of an entry.
    fn loaded(&self, entry: &Entry, mass_kg: f64) -> Complex64 {
        let of = |row: usize| {
            let load = self.truth[(row, row)] * self.omega * self.omega * mass_kg;
            load / (1.0 - load)
        };
        self.truth[entry.place] * self.mean_over_translations(entry, of)
    }

    /// What would be measured without a mass m at the response, the matrix being what is: h_ii = z_ii/(1 + ω² m z_ii), and so
    /// z_ij = h_ij (1 + ω² m z_ii).
    pub(crate) fn unloaded(&self, mass_kg: f64) -> Vec<Complex64> {
        let load = |row: usize| self.truth[(row, row)] * self.omega * self.omega * mass_kg;
        let entries = self.functions.entries.iter();
        entries
            .map(|entry| {
                let loaded = self.truth[entry.place];
                loaded / (1.0 + self.mean_over_translations(entry, load))
            })
            .collect()
    }

    /// How h + a moves with the true receptances at the entries' places, and then with those at the drive points; `None` where
    /// that is h itself.
    pub(crate) fn by_truth(&self, priors: &[Prior], values: &[f64]) -> Option<ComplexMatrix> {
        let cause = Cause::Accelerometer(self.set);
        let mass_kg = super::structures::value_of(cause, priors, values);
        if mass_kg == 0.0 {
            return None;
        }
        let entries = &self.functions.entries;
        let count = entries.len();
        let squared = self.omega * self.omega * mass_kg;
        let mut chain = ComplexMatrix::identity(count, count + self.functions.labels());
        for (e, entry) in entries.iter().enumerate() {
            let share = 1.0 / entry.measurements.len().max(1) as f64;
            let rows = entry.measurements.iter().map(|&(row, _)| row);
            for row in rows.filter(|&row| self.functions.is_translation[row]) {
                let left = 1.0 - squared * self.truth[(row, row)];
                // L/(1 − L), and ω² m h_ij/(1 − L)²
                chain[(e, e)] += share * (left.inv() - 1.0);
                let by_drive_point = squared * self.truth[entry.place] / (left * left);
                chain[(e, count + row)] += share * by_drive_point;
            }
        }
        Some(chain)
    }

    /// The change of the true receptances that goes with a change of h + a, by [`Self::by_truth`]: drive points first.
    pub(crate) fn by_loaded(
        &self,
        by_truth: &ComplexMatrix,
        change: &[Complex64],
    ) -> Vec<Complex64> {
        let entries = &self.functions.entries;
        let count = entries.len();
        let mut of_drive_point = vec![ZERO; self.functions.labels()];
        for (e, entry) in entries.iter().enumerate() {
            if let (row, column) = entry.place
                && row == column
            {
                of_drive_point[row] = change[e] / (by_truth[(e, e)] + by_truth[(e, count + row)]);
            }
        }
        let of = |(e, entry): (usize, &Entry)| match entry.place {
            (row, column) if row == column => of_drive_point[row],
            _ => {
                let others = of_drive_point.iter().enumerate();
                let moved: Complex64 = others
                    .map(|(row, change)| by_truth[(e, count + row)] * change)
                    .sum();
                (change[e] - moved) / by_truth[(e, e)]
            }
        };
        entries.iter().enumerate().map(of).collect()
    }

    /// Variance of each true receptance by that of what is measured, a drive point's own noise beside another entry left out.
    pub(crate) fn variance_of_truth(&self, by_truth: &ComplexMatrix, variance: &mut [f64]) {
        let count = self.functions.entries.len();
        for (e, (entry, variance)) in self.functions.entries.iter().zip(variance).enumerate() {
            let (row, column) = entry.place;
            let mut slope = by_truth[(e, e)];
            if row == column {
                slope += by_truth[(e, count + row)];
            }
            *variance /= slope.norm_sqr();
        }
    }

    /// ω² h_ii h_ij/(1 − ω² m h_ii)²
    fn by_mass(&self, entry: &Entry, mass_kg: f64) -> Complex64 {
        let of = |row: usize| {
            let by_unit = self.truth[(row, row)] * self.omega * self.omega;
            by_unit / ((1.0 - by_unit * mass_kg) * (1.0 - by_unit * mass_kg))
        };
        self.truth[entry.place] * self.mean_over_translations(entry, of)
    }

    fn mean_over_translations(&self, entry: &Entry, of: impl Fn(usize) -> Complex64) -> Complex64 {
        let rows = entry.measurements.iter().map(|&(row, _)| row);
        let acting = rows.filter(|&row| self.functions.is_translation[row]);
        acting.map(of).sum::<Complex64>() / entry.measurements.len().max(1) as f64
    }

    /// e_i sᵀ + s e_iᵀ with the slope s at the point: a sensor that is not where it is said to be.
    fn shifted(&self, entry: &Entry, point: usize) -> Complex64 {
        let Some(slopes) = self.slopes else {
            return ZERO;
        };
        let (row, column) = entry.place;
        let labels = self.truth.nrows();
        let slope = |label: usize| -> Complex64 {
            let weights = slopes.of_points.weights.row(point);
            let of_all = weights
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0);
            let terms = of_all.map(|(other, &weight)| {
                let motion = match other.checked_sub(labels) {
                    None => self.truth[(other, label)],
                    Some(dof) => slopes.at_joint[(dof, label)],
                };
                motion * weight
            });
            terms.sum::<Complex64>() + slopes.of_points.by_loads[(point, label)]
        };
        let at_row = if row == point { slope(column) } else { ZERO };
        let at_column = if column == point { slope(row) } else { ZERO };
        at_row + at_column
    }
}

/// Part of an entry's measurements whose response is this row.
fn share_of_row(entry: &Entry, row: usize) -> f64 {
    let with = entry
        .measurements
        .iter()
        .filter(|measurement| measurement.0 == row);
    with.count() as f64 / entry.measurements.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::Side;

    const SET: MeasuredSet = MeasuredSet::Of(Side::B);

    fn functions() -> MeasuredFunctions {
        let entry = |place: (usize, usize)| Entry {
            place,
            measurements: vec![place, (place.1, place.0)],
            values: Vec::new(),
            variance: Vec::new(),
        };
        MeasuredFunctions {
            is_translation: vec![true, false, true],
            positions_m: Vec::new(),
            entries: vec![entry((0, 1)), entry((2, 2)), entry((0, 2))],
        }
    }

    #[test]
    fn derivatives_are_those_of_what_is_measured() {
        let functions = functions();
        let values = [2.0, -0.3, 0.5, -0.3, 4.0, 1.0, 0.5, 1.0, 3.0];
        let parts = values.iter().enumerate();
        let truth = ComplexMatrix::from_iterator(
            3,
            3,
            parts.map(|(i, v)| Complex64::new(*v, 0.1 * (i % 3 * (i / 3)) as f64)),
        );
        let at = At {
            set: SET,
            functions: &functions,
            truth: &truth,
            omega: 3.0,
            slopes: None,
        };
        let causes = [
            (Cause::Gain(SET), 0.0),
            (Cause::CommonGain, 0.0),
            (Cause::ChannelGain(SET, 2), 0.0),
            (Cause::CommonDelay, 0.0),
            (Cause::Delay(SET), 0.0),
            (Cause::Phase(SET), 0.0),
            (Cause::Accelerometer(SET), 0.004),
        ];
        for (cause, value) in causes {
            let prior = [Prior {
                cause,
                standard_deviation: 1.0,
                centre: 0.0,
            }];
            let measured = |value: f64| -> Vec<Complex64> {
                let factors = at.factors(&prior, &[value]).into_iter();
                let beside = factors.zip(at.beside(&prior, &[value]));
                let entries = functions.entries.iter().zip(beside);
                entries
                    .map(|(entry, (factor, a))| factor * (truth[entry.place] + a))
                    .collect()
            };
            let (above, below) = (measured(value + 1e-6), measured(value - 1e-6));
            for (e, slope) in at.by_cause(cause, value).unwrap().into_iter().enumerate() {
                let expected = (above[e] - below[e]) / 2e-6;
                assert!(
                    (slope - expected).norm() < 1e-7 * (1.0 + expected.norm()),
                    "{cause:?} {e}: {slope}, not {expected}"
                );
            }
        }
        assert_eq!(
            at.by_cause(Cause::Gain(MeasuredSet::Assembly(0)), 0.0),
            None
        );
    }
}
