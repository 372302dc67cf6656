//! Energy that goes in, is stored and becomes heat, and how far quadrature can be trusted to tell.

/// Energy balance of a run: work put in = change of the stored energy + heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BalanceReport {
    /// Work of the external loads (lap), of the sides' motion (element), J.
    pub work_j: f64,
    /// Change of `energy.stored`, J.
    pub stored_j: f64,
    /// Integral of `power.dissipated`, J.
    pub dissipated_j: f64,
    /// Largest energy that was stored, or went in, J: what the others are compared with.
    pub scale_j: f64,
    /// What quadrature and step are found to be off, J.
    pub uncertainty_j: f64,
    /// How far the balance may be off, J: that, with a margin where it may be more than is found of it.
    pub tolerance_j: f64,
}

impl BalanceReport {
    /// Work − change of the stored energy − heat, J.
    #[must_use]
    pub fn imbalance_j(&self) -> f64 {
        self.work_j - self.stored_j - self.dissipated_j
    }

    /// Whether the imbalance is within the tolerance.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        // false for NaN
        self.imbalance_j().abs() <= self.tolerance_j
    }
}

/// An integral, and an estimate of its error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Integral {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Integral {
    /// Intervals that one application of the rule spans.
    pub(super) const SPAN: usize = 4;

    /// Integral over equal intervals `step`, a multiple of [`Integral::SPAN`], from the values at their ends.
    ///
    /// Boole's rule, and as its error the difference from Simpson's on the same points, which is larger by two orders.
    pub(super) fn of(values: &[f64], step: f64) -> Self {
        let mut sum = Self::default();
        for start in (0..values.len().saturating_sub(Self::SPAN)).step_by(Self::SPAN) {
            let &[a, b, c, d, e] = &values[start..=start + Self::SPAN] else {
                continue;
            };
            // ∫f ≈ 2h/45 (7f₀ + 32f₁ + 12f₂ + 32f₃ + 7f₄)   (Abramowitz and Stegun 25.4.14)
            let boole = 2.0 * step / 45.0 * (7.0 * (a + e) + 32.0 * (b + d) + 12.0 * c);
            // ∫f ≈ h/3 (f₀ + 4f₁ + 2f₂ + 4f₃ + f₄)   (Abramowitz and Stegun 25.4.6)
            let simpson = step / 3.0 * (a + e + 4.0 * (b + d) + 2.0 * c);
            sum.value += boole;
            sum.error += (boole - simpson).abs();
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_up_to_the_fifth_power_and_its_error_is_overestimated() {
        let points = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..=8).map(|i| f(f64::from(i) / 8.0)).collect()
        };
        let fifth = Integral::of(&points(&|x| x.powi(5)), 0.125);
        assert!((fifth.value - 1.0 / 6.0).abs() < 1e-16);
        let wave = Integral::of(&points(&|x| (4.0 * x).sin()), 0.125);
        let exact = (1.0 - 4.0_f64.cos()) / 4.0;
        let error = (wave.value - exact).abs();
        assert!(error > 1e-7 && error < wave.error, "{error} {wave:?}");
        assert!(wave.error < 1e-3);
    }
}
