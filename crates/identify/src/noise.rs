//! Noise of measured functions: what a study states of it, and its level from residuals where a study does not.

use super::group::Side;

/// Standard deviation of a measured receptance: σ² = (relative·|H|)² + floor².
///
/// σ is that of the complex error: the variances of its real and imaginary part add up to σ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLevel {
    /// Standard deviation as a fraction of |H|.
    pub relative: f64,
    /// Standard deviation that does not depend on |H|, in the receptance's SI unit (m/N).
    pub floor: f64,
}

impl NoiseLevel {
    /// Both parts multiplied by a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            relative: self.relative * factor,
            floor: self.floor * factor,
        }
    }

    pub(super) fn variance(self, magnitude_squared: f64) -> f64 {
        self.relative * self.relative * magnitude_squared + self.floor * self.floor
    }
}

/// A level of which parts may not be known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedLevel {
    /// Standard deviation as a fraction of |H|, where it is stated.
    pub relative: Option<f64>,
    /// Standard deviation that does not depend on |H|, m/N, where it is stated.
    pub floor: Option<f64>,
}

impl From<NoiseLevel> for StatedLevel {
    fn from(level: NoiseLevel) -> Self {
        Self {
            relative: Some(level.relative),
            floor: Some(level.floor),
        }
    }
}

/// Noise of every measured function of a study.
///
/// What is not stated of the assembly is estimated from the residual. What is not stated of a substructure is as the assembly's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Of the assembly's functions.
    pub assembly: StatedLevel,
    /// Of A's measured functions.
    pub a: StatedLevel,
    /// Of B's measured functions.
    pub b: StatedLevel,
}

impl Noise {
    /// The same stated level everywhere.
    #[must_use]
    pub fn stated(level: NoiseLevel) -> Self {
        Self {
            assembly: level.into(),
            ..Self::default()
        }
    }

    /// Noise of the assembly alone: the substructures are exact.
    #[must_use]
    pub fn of_the_assembly(assembly: StatedLevel) -> Self {
        let exact = StatedLevel {
            relative: Some(0.0),
            floor: Some(0.0),
        };
        Self {
            assembly,
            a: exact,
            b: exact,
        }
    }

    /// Whether nothing is left to estimate.
    #[must_use]
    pub fn is_stated(&self) -> bool {
        self.assembly.relative.is_some() && self.assembly.floor.is_some()
    }

    /// Whether measured functions of that substructure have errors.
    pub(super) fn acts_on(&self, side: Side) -> bool {
        let stated = match side {
            Side::A => self.a,
            Side::B => self.b,
        };
        let exact = StatedLevel {
            relative: Some(0.0),
            floor: Some(0.0),
        };
        stated != exact
    }

    pub(super) fn levels(&self, estimated: NoiseLevel) -> Levels {
        let of = |stated: StatedLevel, otherwise: NoiseLevel| NoiseLevel {
            relative: stated.relative.unwrap_or(otherwise.relative),
            floor: stated.floor.unwrap_or(otherwise.floor),
        };
        let assembly = of(self.assembly, estimated);
        Levels {
            assembly,
            a: of(self.a, assembly),
            b: of(self.b, assembly),
        }
    }
}

/// Levels with every part known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Levels {
    pub(super) assembly: NoiseLevel,
    pub(super) a: NoiseLevel,
    pub(super) b: NoiseLevel,
}

/// One squared residual and what its variance is made of: relative²·α + floor²·β + known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) power: f64,
    pub(super) by_relative: f64,
    pub(super) by_floor: f64,
    pub(super) known: f64,
    /// Independent residuals that `power` is the mean of.
    pub(super) count: f64,
}

/// Relative standard deviations below this are rounding.
const LEAST_RELATIVE: f64 = 1e-15;
const MAX_ROUNDS: usize = 60;
/// By how much a variance component may move in one round.
const LARGEST_FACTOR: f64 = 30.0;

/// Level under which the residuals are most likely; parts that are `stated` stay.
///
/// |r|² of a complex circular residual is exponentially distributed about its variance v, so Σ ln v + |r|²/v is
/// minimised over v = relative²·α + floor²·β + known, by scoring, neither part below zero.
pub(super) fn most_likely_level(samples: &[Sample], stated: StatedLevel) -> NoiseLevel {
    let fixed = [stated.relative, stated.floor].map(|part| part.map(|value| value * value));
    let mut parts = [
        fixed[0].unwrap_or_else(|| first_guess(samples, |s| s.by_relative)),
        fixed[1].unwrap_or_else(|| 0.1 * first_guess(samples, |s| s.by_floor)),
    ];
    let least = LEAST_RELATIVE * LEAST_RELATIVE;
    for _ in 0..MAX_ROUNDS {
        let before = parts;
        let (mut aa, mut ab, mut bb, mut ap, mut bp) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for sample in samples {
            let (a, b) = (sample.by_relative, sample.by_floor);
            let variance = parts[0] * a + parts[1] * b + sample.known + least * a;
            if !(variance > 0.0 && variance.is_finite()) {
                continue;
            }
            let (a, b) = (a / variance, b / variance);
            let power = (sample.power - sample.known) / variance;
            aa += sample.count * a * a;
            ab += sample.count * a * b;
            bb += sample.count * b * b;
            ap += sample.count * a * power;
            bp += sample.count * b * power;
        }
        let only_relative = [ap / aa, 0.0];
        let only_floor = [0.0, bp / bb];
        parts = match (fixed[0], fixed[1]) {
            (Some(a), Some(b)) => [a, b],
            (Some(a), None) => [a, (bp - a * ab) / bb],
            (None, Some(b)) => [(ap - b * ab) / aa, b],
            (None, None) => {
                let determinant = aa * bb - ab * ab;
                if determinant <= 1e-12 * aa * bb {
                    only_relative
                } else {
                    let both = [
                        (ap * bb - bp * ab) / determinant,
                        (bp * aa - ap * ab) / determinant,
                    ];
                    if both[0] < 0.0 {
                        only_floor
                    } else if both[1] < 0.0 {
                        only_relative
                    } else {
                        both
                    }
                }
            }
        };
        for (part, before) in parts.iter_mut().zip(before) {
            *part = if part.is_finite() {
                part.max(0.0)
            } else {
                before
            };
            if before > 0.0 {
                *part = part.clamp(before / LARGEST_FACTOR, before * LARGEST_FACTOR);
            }
        }
        let moved = |i: usize| (parts[i] - before[i]).abs() > 1e-7 * parts[i].max(before[i]);
        if !moved(0) && !moved(1) {
            break;
        }
    }
    NoiseLevel {
        relative: parts[0]
            .sqrt()
            .max(if fixed[0].is_none() && parts[1] == 0.0 {
                LEAST_RELATIVE
            } else {
                0.0
            }),
        floor: parts[1].sqrt(),
    }
}

/// Variance component that alone explains the median residual.
fn first_guess(samples: &[Sample], share: impl Fn(&Sample) -> f64) -> f64 {
    let mut ratios: Vec<f64> = samples
        .iter()
        .filter(|sample| share(sample) > 0.0)
        .map(|sample| sample.power / share(sample))
        .collect();
    if ratios.is_empty() {
        return 0.0;
    }
    let middle = ratios.len() / 2;
    let (_, median, _) = ratios.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of an exponential distribution is ln 2 of its mean.
    *median / std::f64::consts::LN_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, Exp1};

    #[test]
    fn both_parts_of_a_level_return_from_residuals() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        // |H| from 1e-8 to 1e-4 m/N, as between antiresonance and resonance.
        let count = 20_000;
        for (relative, floor) in [(0.01, 2e-8), (0.05, 1e-6), (0.0, 1e-7), (0.02, 0.0)] {
            let samples: Vec<Sample> = (0..count)
                .map(|i| {
                    let magnitude = 1e-8 * 1e4_f64.powf(f64::from(i) / f64::from(count));
                    let level = NoiseLevel { relative, floor };
                    let draw: f64 = Exp1.sample(&mut generator);
                    Sample {
                        power: draw * level.variance(magnitude * magnitude),
                        by_relative: magnitude * magnitude,
                        by_floor: 1.0,
                        known: 0.0,
                        count: 1.0,
                    }
                })
                .collect();
            let found = most_likely_level(&samples, StatedLevel::default());
            // A standard deviation from 20 000 exponential draws is known to about 0.5 %, a part of it to a few times that.
            assert!(
                (found.relative - relative).abs() < 0.03 * relative + 1e-4,
                "{found:?}"
            );
            assert!(
                (found.floor - floor).abs() < 0.05 * floor + 1e-10,
                "{found:?}"
            );
            let known = most_likely_level(
                &samples,
                StatedLevel {
                    relative: Some(relative),
                    floor: None,
                },
            );
            assert_eq!(known.relative, relative);
            assert!(
                (known.floor - floor).abs() < 0.05 * floor + 1e-10,
                "{known:?}"
            );
        }
    }
}
