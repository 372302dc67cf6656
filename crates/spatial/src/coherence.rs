//! Noise of measured functions as their coherence tells it, line by line.

use crate::level::root_mean_square;
use crate::problem::{Level, Observed};

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

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

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
