//! Noise of measured functions: what a study states of it, and its level from residuals where a study does not.

use super::group::Side;

/// Standard deviation of a measured receptance: σ² = (relative·|H|)² + floor².
///
/// σ is that of the complex error: the variances of its real and imaginary part add up to σ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLevel {
    /// Standard deviation as a fraction of |H|.
    pub relative: f64,
    /// Standard deviation that does not depend on |H|, in each function's SI unit (m/N, rad/N, rad/(N·m)).
    pub floor: f64,
}

/// Floors of functions of each kind, of which some may not be known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedFloor {
    /// Of a translation by a force, m/N.
    pub yy: Option<f64>,
    /// Of a rotation by a force, rad/N, and of a translation by a moment, m/(N·m).
    pub ytheta: Option<f64>,
    /// Of a rotation by a moment, rad/(N·m).
    pub thetatheta: Option<f64>,
}

impl StatedFloor {
    /// The same number for each kind, in its unit.
    #[must_use]
    pub fn all(value: f64) -> Self {
        Self {
            yy: Some(value),
            ytheta: Some(value),
            thetatheta: Some(value),
        }
    }

    fn of(self, [response, reference]: [bool; 2]) -> Option<f64> {
        match (response, reference) {
            (false, false) => self.yy,
            (true, true) => self.thetatheta,
            _ => self.ytheta,
        }
    }

    /// With those of another one where there are none.
    fn or(self, other: Self) -> Self {
        Self {
            yy: self.yy.or(other.yy),
            ytheta: self.ytheta.or(other.ytheta),
            thetatheta: self.thetatheta.or(other.thetatheta),
        }
    }
}

/// A level of which parts may not be known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedLevel {
    /// Standard deviation as a fraction of |H|, where it is stated.
    pub relative: Option<f64>,
    /// Standard deviation that does not depend on |H|, where it is stated.
    pub floor: StatedFloor,
}

impl StatedLevel {
    /// No noise at all.
    const EXACT: Self = Self {
        relative: Some(0.0),
        floor: StatedFloor {
            yy: Some(0.0),
            ytheta: Some(0.0),
            thetatheta: Some(0.0),
        },
    };

    /// With those parts of another one that it does not state.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            relative: self.relative.or(other.relative),
            floor: self.floor.or(other.floor),
        }
    }

    /// Whether both parts are stated, as of functions between translations.
    pub(super) fn is_stated(&self) -> bool {
        self.relative.is_some() && self.floor.yy.is_some()
    }
}

impl From<NoiseLevel> for StatedLevel {
    fn from(level: NoiseLevel) -> Self {
        Self {
            relative: Some(level.relative),
            floor: StatedFloor::all(level.floor),
        }
    }
}

/// Whose functions noise is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    Assembly,
    Substructure(Side),
}

/// Noise of every measured function of a study.
///
/// What is not stated of the assembly is estimated from the residual. What is not stated of a substructure is as the assembly's.
/// A floor that is not stated is estimated from each function by itself.
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

    /// No noise anywhere.
    pub(super) fn none() -> Self {
        Self::of_the_assembly(StatedLevel::EXACT)
    }

    /// Noise of the assembly alone: the substructures are exact.
    #[must_use]
    pub fn of_the_assembly(assembly: StatedLevel) -> Self {
        Self {
            assembly,
            a: StatedLevel::EXACT,
            b: StatedLevel::EXACT,
        }
    }

    /// Whether nothing is left to estimate.
    #[must_use]
    pub fn is_stated(&self) -> bool {
        self.assembly.is_stated()
    }

    fn stated_of(&self, side: Side) -> StatedLevel {
        match side {
            Side::A => self.a,
            Side::B => self.b,
        }
    }

    /// Whether measured functions of that substructure have errors.
    pub(super) fn acts_on(&self, side: Side) -> bool {
        self.stated_of(side) != StatedLevel::EXACT
    }

    pub(super) fn levels(&self, estimated: Size) -> Levels {
        let of = |stated: StatedLevel, otherwise: Size| Size {
            relative: stated.relative.unwrap_or(otherwise.relative),
            ..otherwise
        };
        let assembly = of(self.assembly, estimated);
        Levels {
            assembly,
            a: of(self.a, assembly),
            b: of(self.b, assembly),
        }
    }

    /// The floor of a function; `rotations` says of response and reference whether they are rotations, `own` what the function
    /// says itself.
    pub(super) fn floor(&self, of: Of, rotations: [bool; 2], own: impl FnOnce() -> f64) -> Floor {
        let assembly = self.assembly.floor.of(rotations);
        let stated = match of {
            Of::Assembly => assembly,
            Of::Substructure(side) => self.stated_of(side).floor.of(rotations).or(assembly),
        };
        match stated {
            Some(floor) => Floor {
                stated: floor * floor,
                own: 0.0,
            },
            None => Floor {
                stated: 0.0,
                own: own().powi(2),
            },
        }
    }
}

/// The part of a function's variance that does not depend on |H|, in its own unit: stated, or else a multiple, common to all
/// functions, of what the function itself says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Floor {
    pub(super) stated: f64,
    pub(super) own: f64,
}

impl Floor {
    /// At this level.
    pub(super) fn variance(self, level: Size) -> f64 {
        self.stated + level.floor * level.floor * self.own
    }
}

/// How much noise there is: σ² = (relative·|H|)² + [floor](Floor)².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    /// Standard deviation as a fraction of |H|.
    pub(super) relative: f64,
    /// What multiple of its own floor each function has.
    pub(super) floor: f64,
}

impl Size {
    const NONE: Self = Self {
        relative: 0.0,
        floor: 0.0,
    };

    /// Both parts multiplied by a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            relative: self.relative * factor,
            floor: self.floor * factor,
        }
    }

    pub(super) fn variance(self, magnitude_squared: f64, floor: Floor) -> f64 {
        self.relative * self.relative * magnitude_squared + floor.variance(self)
    }
}

/// Levels with every part known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Levels {
    pub(super) assembly: Size,
    pub(super) a: Size,
    pub(super) b: Size,
}

impl Levels {
    /// No noise.
    pub(super) const EXACT: Self = Self {
        assembly: Size::NONE,
        a: Size::NONE,
        b: Size::NONE,
    };

    pub(super) fn of(self, of: Of) -> Size {
        match of {
            Of::Assembly => self.assembly,
            Of::Substructure(Side::A) => self.a,
            Of::Substructure(Side::B) => self.b,
        }
    }
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

/// Level under which the residuals are most likely; a part that is stated stays.
///
/// |r|² of a complex circular residual is exponentially distributed about its variance v, so Σ ln v + |r|²/v is
/// minimised over v = relative²·α + floor²·β + known, by scoring, neither part below zero.
pub(super) fn most_likely_level(samples: &[Sample], relative: Option<f64>) -> Size {
    let fixed = relative.map(|relative| relative * relative);
    let mut parts = [
        fixed.unwrap_or_else(|| first_guess(samples, |s| s.by_relative)),
        0.1 * first_guess(samples, |s| s.by_floor),
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
        parts = match fixed {
            Some(a) => [a, (bp - a * ab) / bb],
            None => {
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
    Size {
        relative: parts[0].sqrt().max(if fixed.is_none() && parts[1] == 0.0 {
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
                    let level = Size { relative, floor };
                    let unit = Floor {
                        stated: 0.0,
                        own: 1.0,
                    };
                    let draw: f64 = Exp1.sample(&mut generator);
                    Sample {
                        power: draw * level.variance(magnitude * magnitude, unit),
                        by_relative: magnitude * magnitude,
                        by_floor: 1.0,
                        known: 0.0,
                        count: 1.0,
                    }
                })
                .collect();
            let found = most_likely_level(&samples, None);
            // A standard deviation from 20 000 exponential draws is known to about 0.5 %, a part of it to a few times that.
            assert!(
                (found.relative - relative).abs() < 0.03 * relative + 1e-4,
                "{found:?}"
            );
            assert!(
                (found.floor - floor).abs() < 0.05 * floor + 1e-10,
                "{found:?}"
            );
            let known = most_likely_level(&samples, Some(relative));
            assert_eq!(known.relative, relative);
            assert!(
                (known.floor - floor).abs() < 0.05 * floor + 1e-10,
                "{known:?}"
            );
        }
    }
}
