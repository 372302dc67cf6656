//! The shortest step at which a loop becomes unstable.

use std::cmp::Ordering;

use nalgebra::{DMatrix, Schur};

/// How long the communication step may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepBound {
    /// Stable for every step shorter than this, s.
    Below(f64),
    /// Unstable however short the step.
    Never,
    /// Stable for every step up to the longest that was looked at, s.
    NotBelow(f64),
    /// Nothing moves against the joint, so that no step matters.
    Nothing,
}

impl StepBound {
    /// The bound in seconds: zero where every step is unstable, infinite where none was found to be.
    #[must_use]
    pub fn seconds(self) -> f64 {
        match self {
            Self::Below(seconds) => seconds,
            Self::Never => 0.0,
            Self::NotBelow(_) | Self::Nothing => f64::INFINITY,
        }
    }

    /// The shorter of two; what was looked at in vain is shorter than where nothing moves.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        // what is known to be stable, where nothing unstable was found
        let looked_at = |bound: Self| match bound {
            Self::NotBelow(seconds) => seconds,
            Self::Below(_) | Self::Never | Self::Nothing => f64::INFINITY,
        };
        let order = self.seconds().total_cmp(&other.seconds());
        match order.then(looked_at(self).total_cmp(&looked_at(other))) {
            Ordering::Greater => other,
            Ordering::Less | Ordering::Equal => self,
        }
    }
}

/// Where and how closely to look.
pub(super) struct Search {
    /// Fastest rate of the loop, 1/s; steps are looked at in multiples of its reciprocal.
    pub(super) rate: f64,
    /// Shortest and longest step, by 1/rate.
    pub(super) range: [f64; 2],
    /// Growth, by rate, below which motion counts as held; depends on the step by 1/rate.
    pub(super) slack: fn(f64) -> f64,
}

/// Ratio of neighbouring steps in the search.
const RATIO: f64 = 1.01;
/// Relative width at which the bisection stops.
const WIDTH: f64 = 1e-12;

impl Search {
    /// The shortest unstable step of the loop x ← x + H G(H) x.
    ///
    /// Without the identity, short steps keep their digits: with λ = 1 + Hμ, |λ| > 1 is 2 Re μ + H|μ|² > 0.
    pub(super) fn bound(&self, generator: impl Fn(f64) -> DMatrix<f64>) -> StepBound {
        let is_stable = |step: f64| {
            let step_s = step / self.rate;
            growth(&generator(step_s), step_s)
                .is_some_and(|growth| growth <= (self.slack)(step) * self.rate)
        };
        let [shortest, longest] = self.range;
        if !is_stable(shortest) {
            return StepBound::Never;
        }
        let mut stable = shortest;
        let mut unstable = loop {
            let next = stable * RATIO;
            if next > longest {
                return StepBound::NotBelow(stable / self.rate);
            }
            if !is_stable(next) {
                break next;
            }
            stable = next;
        };
        while unstable - stable > WIDTH * stable {
            let middle = 0.5 * (stable + unstable);
            if is_stable(middle) {
                stable = middle;
            } else {
                unstable = middle;
            }
        }
        StepBound::Below(stable / self.rate)
    }
}

/// Largest 2 Re μ + H|μ|² over the eigenvalues μ of G, 1/s; `None` if they cannot be computed.
fn growth(generator: &DMatrix<f64>, step_s: f64) -> Option<f64> {
    if generator.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let schur = Schur::try_new(generator.clone(), f64::EPSILON, 10_000)?;
    let growth = schur
        .complex_eigenvalues()
        .iter()
        .map(|mu| 2.0 * mu.re + step_s * mu.norm_sqr())
        .fold(f64::NEG_INFINITY, f64::max);
    Some(growth)
}

#[cfg(test)]
mod tests {
    use super::StepBound::{Below, Never, NotBelow, Nothing};

    #[test]
    fn the_shorter_bound_is_the_one_that_says_more() {
        let by_length = [
            Never,
            Below(1e-6),
            Below(1e-3),
            NotBelow(1e-6),
            NotBelow(1.0),
            Nothing,
        ];
        for (place, shorter) in by_length.iter().enumerate() {
            for longer in &by_length[place..] {
                assert_eq!(shorter.min(*longer), *shorter);
                assert_eq!(longer.min(*shorter), *shorter);
            }
        }
    }
}
