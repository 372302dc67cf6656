//! Noise of a measured function by itself: how far each line is from a smooth curve through its neighbours.
//!
//! H over a few lines is a rational function, whatever the structure and however wrong the set-up (McKelvey and Guérin 2012).
//! So what it leaves is noise, and a value far off it is an outlier. No joint and no substructure takes part: errors of the
//! set-up, and joint models that are too simple, are smooth.

mod deviation;
mod fit;
mod shown_level;
mod shown_noise;

use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

pub use shown_level::ShownLevel;
pub use shown_noise::ShownNoise;

use super::noise::{Sample, Size, most_likely_level};

/// Lines of a window.
const WINDOW: usize = 9;
/// Coefficients of numerator and denominator, beside the leading 1 of this.
const NUMERATOR: usize = 4;
const DENOMINATOR: usize = 2;
const UNKNOWNS: usize = NUMERATOR + DENOMINATOR;
/// A fit: lines of its window, coefficients of numerator and denominator beside the leading 1 of this.
#[derive(Clone, Copy)]
struct Order {
    length: usize,
    numerator: usize,
    denominator: usize,
}

const WHOLE: Order = Order {
    length: WINDOW,
    numerator: NUMERATOR,
    denominator: DENOMINATOR,
};
/// By which a value has to stand out, too.
const SHORTER: Order = Order {
    length: WINDOW - 2,
    numerator: NUMERATOR - 1,
    denominator: DENOMINATOR - 1,
};
/// Fewer lines show nothing.
const FEWEST_LINES: usize = 3 * WINDOW;
/// Windows that are enough to tell a level.
const WINDOWS_FOR_LEVEL: usize = 600;
/// Refinements of the level, each with the weights of the one before …
const ROUNDS: usize = 5;
/// … until they change it by less than this part of itself.
const AT_REST: f64 = 1e-3;
/// Squared deviation over its variance that noise does not reach: e⁻³⁰ of all values that are normal.
const FAR: f64 = 30.0;
/// Most rounds of leaving out.
const REMOVALS: usize = 60;
/// A value that is closer than this part of the size around it is no outlier, however exact the others are …
const NEAR: f64 = 0.05;
/// … nor one for which a shorter window shows another deviation: there the function is not smooth.
const AGREEMENT: f64 = 0.7;
/// A deviation of this part of the size around it is one in any case.
const OBVIOUS: f64 = 0.5;
/// The least squared value beside the smaller one of its neighbours.
const LEAST_OF_NEIGHBOURS: f64 = 0.1;
/// Lines on either side without which no value is judged.
const FEWEST_BESIDE: usize = 2;
/// Squared deviation over its variance that noise hardly reaches.
const SUSPICIOUS: f64 = 9.0;
/// Data with less noise than this part of the function are computed ones, without outliers: what is left is the fit's own error.
const LEAST_NOISE: f64 = 1e-4;
/// No floor is taken for less than this part of the function's median.
const LEAST_FLOOR: f64 = 1e-12;

/// Part of a value that its noise has where the lines are too few to show it.
const USUAL_NOISE: f64 = 0.05;

/// What a function says of its noise.
#[derive(Clone, Debug)]
pub(super) struct Roughness {
    /// Noise as a part of the function; not known of too few lines.
    pub(super) relative: Option<f64>,
    /// Floor of the noise, in the function's unit.
    pub(super) floor: f64,
    /// Lines whose value stands out, with how far it is from what its neighbours predict.
    pub(super) outliers: Vec<(usize, f64)>,
    /// Lines whose value may: where those of most functions may, a resonance is too sharp for the lines.
    pub(super) suspicious: Vec<usize>,
}

impl Roughness {
    /// Noise as a part of the function, and its floor in the function's unit; what is usual where too few lines show nothing.
    pub(super) fn level(&self) -> [f64; 2] {
        self.relative
            .map_or([USUAL_NOISE, 0.0], |relative| [relative, self.floor])
    }

    /// Of a function over ascending frequencies; `known` variances are fractions of |H|², as from coherence.
    pub(super) fn of(frequency_hz: &[f64], values: &[Complex64], known: Option<&[f64]>) -> Self {
        let mut sizes: Vec<f64> = values.iter().map(|value| value.norm()).collect();
        let middle = sizes.len() / 2;
        let median = match sizes.is_empty() {
            true => 0.0,
            false => *sizes.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        if values.len() < FEWEST_LINES || median == 0.0 {
            return Self {
                relative: None,
                floor: median,
                outliers: Vec::new(),
                suspicious: Vec::new(),
            };
        }
        let mut function = Function::new(frequency_hz, values, known, median);
        let distances = function.settle();
        let floor = function.level.floor * function.median;
        let is_measured = function.level.relative.hypot(floor / median) > LEAST_NOISE;
        let (outliers, suspicious) = match is_measured {
            true => (
                function.outliers(),
                function.suspicious(distances.as_deref()),
            ),
            false => (Vec::new(), Vec::new()),
        };
        Self {
            relative: Some(function.level.relative),
            suspicious,
            floor: floor.max(LEAST_FLOOR * median),
            outliers,
        }
    }
}

struct Function<'f> {
    frequency_hz: &'f [f64],
    values: &'f [Complex64],
    known: Option<&'f [f64]>,
    /// Lines that are taken for good.
    used: Vec<usize>,
    level: Size,
    /// What the level's floor is a multiple of.
    median: f64,
}

impl<'f> Function<'f> {
    /// All lines, and a level that is not known yet.
    fn new(
        frequency_hz: &'f [f64],
        values: &'f [Complex64],
        known: Option<&'f [f64]>,
        median: f64,
    ) -> Self {
        Self {
            frequency_hz,
            values,
            known,
            used: (0..values.len()).collect(),
            level: Size {
                relative: 1.0,
                floor: 1.0,
            },
            median: 0.3 * median,
        }
    }

    /// The level under which the deviations are most likely, weights and level in turn; values that stand out are left out.
    ///
    /// Returns the distances of the lines in use under that level, if they were needed.
    fn settle(&mut self) -> Option<Vec<f64>> {
        let mut is_at_rest = false;
        let mut last = None;
        for _ in 0..ROUNDS {
            is_at_rest = self.refine();
            if is_at_rest {
                break;
            }
        }
        for _ in 0..REMOVALS {
            let distances = self.distances();
            let far = self.farthest(&distances);
            if far.is_empty() {
                last = Some(distances);
                break;
            }
            self.used.retain(|line| !far.contains(line));
            if self.used.len() < FEWEST_LINES {
                break;
            }
            is_at_rest = self.refine();
        }
        if !is_at_rest {
            self.refine();
            last = None;
        }
        last
    }

    /// Squared deviations in so many windows, at most, evenly among the lines in use.
    fn samples(&self, order: Order, windows: usize) -> Vec<Sample> {
        let stride = self.used.len().div_ceil(windows).max(1);
        let places = (0..self.used.len()).step_by(stride);
        let sample = |place: usize| {
            let own = self.deviation(self.used[place], order)?;
            Some(Sample {
                power: own.power,
                by_relative: self.values[self.used[place]].norm_sqr(),
                by_floor: self.median.powi(2),
                known: 0.0,
                count: 1.0,
            })
        };
        places.filter_map(sample).collect()
    }

    /// Those that noise may have made, as large as it is at most lines.
    fn without_the_far(&self, samples: Vec<Sample>) -> Vec<Sample> {
        let of = |own: &Sample| {
            let Size { relative, floor } = self.level;
            own.power / (own.by_relative * relative.powi(2) + own.by_floor * floor.powi(2))
        };
        let Some(median) = upper_median(samples.iter().map(of)) else {
            return samples;
        };
        let limit = FAR * median / std::f64::consts::LN_2;
        samples.into_iter().filter(|own| of(own) <= limit).collect()
    }

    /// Says whether the level stays what it was.
    fn refine(&mut self) -> bool {
        let samples = self.samples(WHOLE, WINDOWS_FOR_LEVEL);
        let before = self.level;
        self.level = most_likely_level(&samples, None);
        let change =
            (self.level.relative - before.relative).abs() + (self.level.floor - before.floor).abs();
        change < AT_REST * (self.level.relative + self.level.floor)
    }

    /// Squared deviation of each line in use over its variance; zero where its neighbours say nothing of it.
    fn distances(&self) -> Vec<f64> {
        self.used.iter().map(|&line| self.distance(line)).collect()
    }

    fn distance(&self, line: usize) -> f64 {
        let own = self.deviation(line, WHOLE);
        own.map_or(0.0, |own| own.distance)
    }

    /// Lines in use that are far off, each farther than any of those around it.
    fn farthest(&self, distances: &[f64]) -> Vec<usize> {
        let Some(median) = upper_median(distances.iter().copied()) else {
            return Vec::new();
        };
        let limit = FAR * (median / std::f64::consts::LN_2).max(1.0);
        let is_highest = |place: usize| {
            let around =
                place.saturating_sub(WINDOW / 2)..(place + WINDOW / 2 + 1).min(distances.len());
            distances[around]
                .iter()
                .all(|other| *other <= distances[place])
        };
        let places =
            (0..distances.len()).filter(|&place| distances[place] > limit && is_highest(place));
        places
            .filter(|&place| self.outlying(self.used[place]).is_some())
            .map(|place| self.used[place])
            .collect()
    }

    /// Of the lines that were left out those that stand out beside the ones in use.
    fn outliers(&self) -> Vec<(usize, f64)> {
        let left_out = (0..self.values.len()).filter(|line| self.used.binary_search(line).is_err());
        left_out
            .filter_map(|line| Some((line, self.outlying(line)?)))
            .collect()
    }

    /// `distances` are those of the lines in use, if they are known.
    fn suspicious(&self, distances: Option<&[f64]>) -> Vec<usize> {
        let known = |line: usize| {
            let place = self.used.binary_search(&line).ok()?;
            distances?.get(place).copied()
        };
        let is_suspicious =
            |line: &usize| known(*line).unwrap_or_else(|| self.distance(*line)) > SUSPICIOUS;
        (0..self.values.len()).filter(is_suspicious).collect()
    }

    /// How far a value is from what its neighbours predict, if noise and a sharp resonance do not explain it.
    fn outlying(&self, line: usize) -> Option<f64> {
        // Beyond the ends a fit says little.
        let before = self.used.partition_point(|&other| other < line);
        let after = self.used.len() - self.used.partition_point(|&other| other <= line);
        if before.min(after) < FEWEST_BESIDE {
            return None;
        }
        let own = self.deviation(line, WHOLE)?;
        let shorter = self.deviation(line, SHORTER)?;
        let is_far = own.distance > FAR
            && shorter.distance > FAR
            && own.value.norm_sqr() > NEAR * NEAR * own.around
            && (own.value.norm_sqr() > OBVIOUS * OBVIOUS * own.around
                || (own.value - shorter.value).norm() < AGREEMENT * own.value.norm());
        is_far.then(|| own.value.norm())
    }
}
