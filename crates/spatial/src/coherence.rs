//! Noise of measured functions as their coherence tells it, line by line.
//!
//! The variance that γ² and n averages give is what is left of the response, and has 2 (n − 1) degrees of freedom: it does not
//! depend on the error of the function, so that it biases nothing, but it scatters. An estimate that is weighed by it leans on the
//! lines where it happens to be small, and deviations are too short: by √((n − 3)/n), so that of three averages they say nothing.
//! Noise of neighbouring lines is alike, so that as many of them are taken together as tell it well enough.

use bolted_joint_frf::{Dof, FrfSet};
use bolted_joint_identify::variances_by_coherence;

use crate::level::root_mean_square;
use crate::problem::{Level, Observed};

/// Pairs of degrees of freedom N that tell a variance well enough: deviations are short by √((N − 2)/(N − 1)), 3 % at most.
const ENOUGH: f64 = 20.0;
/// Those without which it is not told at all.
const FEWEST: f64 = 4.0;

/// A set of functions whose coherence tells noise.
#[derive(Clone, Debug)]
pub(crate) struct Told {
    /// At all lines of its range: those beside a line tell of it, too, where they are not used themselves.
    set: FrfSet,
    averages: f64,
    /// The lines that are used.
    lines: Vec<usize>,
}

impl Told {
    /// Of a set of which these lines are used, with what is to be known of it; `None` without coherence, or where that tells nothing.
    pub(crate) fn of(set: FrfSet, used_hz: &[f64]) -> (Option<Self>, Option<String>) {
        let has_coherence = |(response, reference, _)| set.coherence(response, reference).is_some();
        let Some(averages) = set
            .averages()
            .filter(|_| set.functions().any(has_coherence))
        else {
            return (None, None);
        };
        let lines = set.line_count();
        if window(lines, averages).is_none() {
            let remark = format!(
                "coherence does not tell how large the noise is, and is not used: it is that of {lines} lines with averages = {averages}"
            );
            return (None, Some(remark));
        }
        let mut wanted = used_hz.iter().peekable();
        let is_used = |&line: &usize| wanted.next_if_eq(&&set.frequency_hz()[line]).is_some();
        let lines = (0..lines).filter(is_used).collect();
        let own = Self {
            lines,
            averages,
            set,
        };
        (Some(own), None)
    }

    /// Deviation of a function's noise at each line that is used, E|ε|² = σ²; `None` where it has no coherence.
    pub(crate) fn deviations(&self, response: Dof, reference: Dof) -> Option<Vec<f64>> {
        let relative = self.set.relative_variance(response, reference)?;
        let function = self.set.receptance(response, reference).ok()?;
        let power = |line: usize| function.values()[line].norm_sqr();
        let own = variances_by_coherence(&relative, power);
        let variances = pooled(&own, self.averages)?;
        let deviations = self.lines.iter().map(|&line| variances[line].sqrt());
        Some(deviations.collect())
    }
}

impl Observed {
    /// With noise of these deviations at each line.
    pub(crate) fn with_noise(mut self, deviations: &[f64]) -> Self {
        let level = root_mean_square(deviations.iter().map(|own| own * own));
        if level > 0.0 && deviations.iter().all(|own| *own > 0.0) {
            self.uneven = deviations.iter().map(|own| own / level).collect();
            self.told = Some(level);
        }
        self
    }
}

/// The level of the assembly's noise: as the coherence of all functions tells it, else as it is `stated`; and what is to be known of
/// that. Coherence of some of them tells nothing of the others, and is left out.
pub(crate) fn level_of(stated: Level, observed: &mut [Observed]) -> (Level, Option<String>) {
    let told = observed.iter().filter(|one| one.told.is_some()).count();
    let all = observed.len();
    if told == all {
        let remark = matches!(stated, Level::Relative(_)).then(|| {
            "noise.relative is not used: the coherence of the assembly's functions tells their noise"
                .to_owned()
        });
        return (Level::OfCoherence, remark);
    }
    for one in observed {
        one.uneven.clear();
        one.told = None;
    }
    let remark = (told > 0).then(|| {
        format!(
            "assembly: {told} of {all} functions have coherence, and that is not used: it takes the place of noise.relative where all \
             of them have it"
        )
    });
    (stated, remark)
}

/// How many lines are taken together, an odd number where there are so many; `None` where all of them are too few.
fn window(lines: usize, averages: f64) -> Option<usize> {
    let of_one = averages - 1.0;
    let wanted = (ENOUGH / of_one).ceil().clamp(1.0, lines as f64) as usize;
    let wanted = (wanted | 1).min(lines);
    (wanted as f64 * of_one >= FEWEST).then_some(wanted)
}

/// Variances of lines that are taken together with their neighbours.
fn pooled(own: &[f64], averages: f64) -> Option<Vec<f64>> {
    let wide = window(own.len(), averages)?;
    // n v̂ is v times a gamma variable of n − 1, and that of lines together of N = lines (n − 1). With v = n Σ v̂/(N − 1) is
    // E(1/v) that of the true variance, and so is E χ²
    let factor = averages / (wide as f64 * (averages - 1.0) - 1.0);
    let of_line = |line: usize| {
        let first = line.saturating_sub(wide / 2).min(own.len() - wide);
        factor * own[first..first + wide].iter().sum::<f64>()
    };
    Some((0..own.len()).map(of_line).collect())
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    #[test]
    fn few_averages_take_neighbours_along() {
        assert_eq!(window(100, 21.0), Some(1));
        assert_eq!(window(100, 10.0), Some(3));
        assert_eq!(window(100, 5.0), Some(5));
        assert_eq!(window(100, 2.0), Some(21));
        assert_eq!(window(6, 2.0), Some(6));
        assert_eq!((window(3, 2.0), window(100, 1.0)), (None, None));
    }

    /// Of n v̂ = v g with g of a gamma distribution of N, E 1/g = 1/(N − 1).
    #[test]
    fn the_mean_of_chi_squared_is_1() {
        // 5 averages, 5 lines of the same variance 3: N = 20
        let averages = 5.0;
        let mean_of_own = 3.0 * (averages - 1.0) / averages;
        let found = pooled(&[mean_of_own; 9], averages).unwrap();
        for own in found {
            assert!((own - 3.0 * 20.0 / 19.0).abs() < 1e-12, "{own}");
        }
        // at an end those that there are
        let found = pooled(&[1.0, 2.0, 3.0, 4.0], 10.0).unwrap();
        let expected = [6.0, 6.0, 9.0, 9.0].map(|sum: f64| sum * 10.0 / 26.0);
        for (own, expected) in found.iter().zip(expected) {
            assert!((own - expected).abs() < 1e-12, "{own} {expected}");
        }
    }

    #[test]
    fn coherence_of_some_functions_is_left_out() {
        let one = || Observed::new([0, 0], vec![Complex64::from(1.0); 2]);
        let mut all = vec![one().with_noise(&[0.1, 0.3]), one()];
        let (level, remark) = level_of(Level::OfResiduals, &mut all);
        assert_eq!(level, Level::OfResiduals);
        assert!(remark.is_some_and(|text| text.contains("1 of 2 functions")));
        assert!(
            all.iter()
                .all(|one| one.uneven.is_empty() && one.told.is_none())
        );
        let mut all = vec![one().with_noise(&[0.1, 0.3]); 2];
        let (level, remark) = level_of(Level::Relative(0.02), &mut all);
        assert_eq!(level, Level::OfCoherence);
        assert!(remark.is_some());
        let told = all[0].told.unwrap();
        assert!(
            (told - 0.05_f64.sqrt()).abs() < 1e-15 && (told * all[0].uneven(1) - 0.3).abs() < 1e-15
        );
    }
}
