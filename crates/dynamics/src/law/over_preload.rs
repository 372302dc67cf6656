//! The joint over the preload of its bolt: a table, and what is between its preloads.
//!
//! Every coefficient runs through the table as a monotone cubic (Fritsch and Carlson 1980, with the slopes of Fritsch and
//! Butland 1984). Where such slopes would take K or C out of the positive semidefinite matrices, those of the whole matrix
//! are made smaller at that preload. So the joint is continuous with its first derivative, each coefficient is monotone between
//! two preloads of the table, and K and C are positive semidefinite everywhere if they are in the table.

use std::fmt;

use super::{DofLaws, JointLaw, JointMemory};
use crate::definiteness::is_positive_semidefinite;

/// Halvings that find how much of a slope a matrix bears: as many as a double has digits.
const HALVINGS: u32 = 53;

/// How far beyond its table, as a part of its range, a preload may come by rounding.
const ROUNDING: f64 = 1e-9;

/// What the joint is beyond the first and the last preload of its table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Nothing is known of it: such a preload is not covered.
    Refused,
    /// What it is at the nearest preload of the table.
    Held,
}

/// Why a table gives no joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableDefect {
    /// There are fewer than two preloads.
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// A preload is not above the one before it.
    NotIncreasing {
        /// Its place, from 0.
        index: usize,
    },
    /// A preload or a coefficient is NaN or infinite, or two are so far apart that their difference is.
    NotFinite {
        /// Its place, from 0.
        index: usize,
    },
}

impl fmt::Display for TableDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { found } => {
                write!(
                    f,
                    "found a table of {found} preloads, expected 2 at the least"
                )
            }
            Self::NotIncreasing { index } => write!(
                f,
                "preload {index} of the table, counted from 0, is not above the one before it"
            ),
            Self::NotFinite { index } => write!(
                f,
                "preload {index} of the table, counted from 0, or a coefficient there is not a finite number"
            ),
        }
    }
}

/// A joint law for each preload within a table.
#[derive(Clone, Debug, PartialEq)]
pub struct JointOverPreload<const D: usize> {
    knots: Box<[Knot<D>]>,
    beyond: Beyond,
    friction: Option<Friction<D>>,
}

/// Laws that remember, beside the springs of the table.
#[derive(Clone, Debug, PartialEq)]
enum Friction<const D: usize> {
    /// What grows with the preload does so in proportion.
    Proportional { on: [DofLaws; D], nominal_n_m: f64 },
    /// All parameters at each preload of the table; linear between them, as the ranges of laws are convex.
    Table(Box<[[DofLaws; D]]>),
}

/// The joint at one preload of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot<const D: usize> {
    preload_n_m: f64,
    law: JointLaw<D>,
    /// Its change per preload.
    slope: JointLaw<D>,
}

/// Where a preload lies: between two knots.
struct Place<'a, const D: usize> {
    lower: &'a Knot<D>,
    upper: &'a Knot<D>,
    /// Index of the upper one, 1 at the least.
    index: usize,
    /// Distance of the knots, N·m.
    width_n_m: f64,
    /// Share of the way from the lower to the upper one.
    share: f64,
    /// Whether the preload is within the table.
    is_within: bool,
}

impl<const D: usize> JointOverPreload<D> {
    /// The joint through `table`: preloads (tightening torques, N·m), strictly increasing, each with its law.
    ///
    /// # Errors
    ///
    /// [`TableDefect`] for a table of fewer than two preloads, or of preloads that do not increase, or not of numbers.
    pub fn new(table: &[(f64, JointLaw<D>)], beyond: Beyond) -> Result<Self, TableDefect> {
        let found = table.len();
        if found < 2 {
            return Err(TableDefect::TooFew { found });
        }
        for (index, (preload_n_m, law)) in table.iter().enumerate() {
            if !(preload_n_m.is_finite() && law.is_finite()) {
                return Err(TableDefect::NotFinite { index });
            }
        }
        for (index, pair) in table.windows(2).enumerate() {
            if let [(low, _), (high, _)] = pair {
                if high <= low {
                    return Err(TableDefect::NotIncreasing { index: index + 1 });
                }
                if !(high - low).is_finite() {
                    return Err(TableDefect::NotFinite { index: index + 1 });
                }
            }
        }
        let knots: Box<[Knot<D>]> = (0..found)
            .filter_map(|index| Knot::of(table, index))
            .collect();
        match knots.iter().position(|knot| !knot.slope.is_finite()) {
            Some(index) => Err(TableDefect::NotFinite { index }),
            None => Ok(Self {
                knots,
                beyond,
                friction: None,
            }),
        }
    }

    /// The joint with these laws beside the table's on each relative DOF, as they are at the preload `nominal_n_m` (N·m): what
    /// of them grows as the preload does is in proportion to it.
    #[must_use]
    pub fn with_friction(self, on: [DofLaws; D], nominal_n_m: f64) -> Self {
        let is_there = on.iter().any(|laws| !laws.are_none());
        Self {
            friction: is_there.then_some(Friction::Proportional { on, nominal_n_m }),
            ..self
        }
    }

    /// The joint with laws beside the springs of the table whose parameters are these at each preload of the table, and linear
    /// between two of them.
    ///
    /// # Errors
    ///
    /// [`TableDefect::NotFinite`] for a parameter that is no number, [`TableDefect::TooFew`] where there are not as many
    /// entries as the table has preloads.
    pub fn with_friction_table(self, entries: &[[DofLaws; D]]) -> Result<Self, TableDefect> {
        if entries.len() != self.knots.len() {
            let found = entries.len();
            return Err(TableDefect::TooFew { found });
        }
        let is_finite = |on: &[DofLaws; D]| {
            let mut parameters = on.iter().flat_map(DofLaws::parameters);
            parameters.all(|parameter| parameter.is_finite())
        };
        if let Some(index) = entries.iter().position(|on| !is_finite(on)) {
            return Err(TableDefect::NotFinite { index });
        }
        let is_there = entries.iter().flatten().any(|laws| !laws.are_none());
        Ok(Self {
            friction: is_there.then(|| Friction::Table(entries.into())),
            ..self
        })
    }

    /// The same of a joint with `W` degrees of freedom, of which the first ones are this joint's and the others have nothing.
    ///
    /// # Errors
    ///
    /// [`TableDefect`] as in [`Self::new`].
    pub fn widened<const W: usize>(&self) -> Result<JointOverPreload<W>, TableDefect> {
        let widened = |law: &JointLaw<D>| {
            let mut own = JointLaw::<W>::NONE;
            for i in 0..D.min(W) {
                own.on[i] = law.on[i];
                for j in 0..D.min(W) {
                    own.linear.stiffness[i][j] = law.linear.stiffness[i][j];
                    own.linear.damping[i][j] = law.linear.damping[i][j];
                }
            }
            own
        };
        let knots = self.knots.iter();
        let table: Vec<_> = knots
            .map(|knot| (knot.preload_n_m, widened(&knot.law)))
            .collect();
        let own = JointOverPreload::new(&table, self.beyond)?;
        let on_all = |on: &[DofLaws; D]| -> [DofLaws; W] {
            std::array::from_fn(|i| *on.get(i).unwrap_or(&DofLaws::NONE))
        };
        match &self.friction {
            Some(Friction::Proportional { on, nominal_n_m }) => {
                Ok(own.with_friction(on_all(on), *nominal_n_m))
            }
            Some(Friction::Table(entries)) => {
                let entries: Vec<_> = entries.iter().map(on_all).collect();
                own.with_friction_table(&entries)
            }
            None => Ok(own),
        }
    }

    /// Whether the joint remembers its motion.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        match &self.friction {
            None => false,
            Some(Friction::Proportional { on, .. }) => on.iter().any(DofLaws::have_memory),
            Some(Friction::Table(entries)) => entries.iter().flatten().any(DofLaws::have_memory),
        }
    }

    /// First and last preload of the table, N·m.
    #[must_use]
    pub fn range_n_m(&self) -> [f64; 2] {
        match &*self.knots {
            [first, .., last] => [first.preload_n_m, last.preload_n_m],
            // a table has two preloads
            _ => [f64::NAN; 2],
        }
    }

    /// What the joint is beyond the table.
    #[must_use]
    pub fn beyond(&self) -> Beyond {
        self.beyond
    }

    /// Whether there is a joint at this preload (N·m). Rounding, of a course that ends where the table does or of an importer that
    /// interpolates, leads to its end.
    #[inline]
    #[must_use]
    pub fn covers(&self, preload_n_m: f64) -> bool {
        let [first, last] = self.range_n_m();
        let rounding = ROUNDING * (last - first);
        (first - rounding..=last + rounding).contains(&preload_n_m)
            || self.beyond == Beyond::Held && preload_n_m.is_finite()
    }

    /// Preloads (N·m) from the first to the last of the table, its own among them, `between` more in each gap.
    pub fn samples_n_m(&self, between: u32) -> impl Iterator<Item = f64> {
        let inner = self.knots.windows(2).flat_map(move |pair| {
            let (low, high) = match pair {
                [low, high] => (low.preload_n_m, high.preload_n_m),
                _ => (f64::NAN, f64::NAN),
            };
            (0..=between)
                .map(move |part| low + (high - low) * f64::from(part) / (f64::from(between) + 1.0))
        });
        inner.chain(self.knots.last().map(|knot| knot.preload_n_m))
    }

    /// The law at a preload (N·m); beyond the table that of its end.
    #[must_use]
    pub fn law(&self, preload_n_m: f64) -> JointLaw<D> {
        let springs = self.springs(preload_n_m);
        let beside = |of: &dyn Fn(usize) -> DofLaws| JointLaw {
            on: std::array::from_fn(|i| springs.on[i].beside(&of(i))),
            ..springs
        };
        match &self.friction {
            None => springs,
            Some(Friction::Proportional { on, nominal_n_m }) => {
                let [first, last] = self.range_n_m();
                let share = preload_n_m.clamp(first, last) / nominal_n_m;
                beside(&|i| on[i].at_share_of_preload(share))
            }
            Some(Friction::Table(entries)) => {
                let place = self.place(preload_n_m);
                let [low, high] = place.entries(entries);
                beside(&|i| low[i].towards(&high[i], place.share))
            }
        }
    }

    /// The law of the table alone, without what remembers.
    #[must_use]
    pub fn springs(&self, preload_n_m: f64) -> JointLaw<D> {
        let place = self.place(preload_n_m);
        let (t, third) = (place.share, place.width_n_m / 3.0);
        let s = 1.0 - t;
        // Bernstein's form, Σ bᵢ Bᵢ with B₀ = K₀, B₁ = K₀ + h/3 K₀', B₂ = K₁ − h/3 K₁', B₃ = K₁ and weights bᵢ ≥ 0
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        place.combined(|[low, low_slope, high, high_slope]| {
            weights[0] * low
                + weights[1] * (low + third * low_slope)
                + weights[2] * (high - third * high_slope)
                + weights[3] * high
        })
    }

    /// Change of the table's springs with the preload, per N·m, at a preload (N·m); zero beyond the table. Those of friction
    /// have no part of it: [`JointOverPreload::spring_change`].
    #[must_use]
    pub fn slope(&self, preload_n_m: f64) -> JointLaw<D> {
        let place = self.place(preload_n_m);
        if !place.is_within {
            return JointLaw::NONE;
        }
        let (t, width) = (place.share, place.width_n_m);
        let s = 1.0 - t;
        // K' = s² K₀' + 2 s t (3Δ − K₀' − K₁') + t² K₁' with Δ = (K₁ − K₀)/h
        place.combined(|[low, low_slope, high, high_slope]| {
            let middle = 3.0 * ((high - low) / width) - low_slope - high_slope;
            s * s * low_slope + 2.0 * s * t * middle + t * t * high_slope
        })
    }

    /// The same with what remembers, for changes of loads.
    #[must_use]
    pub fn change(&self, preload_n_m: f64) -> JointLaw<D> {
        let springs = self.slope(preload_n_m);
        let [first, last] = self.range_n_m();
        let Some(friction) = &self.friction else {
            return springs;
        };
        if !(first..=last).contains(&preload_n_m) {
            return springs;
        }
        let beside = |of: &dyn Fn(usize) -> DofLaws| JointLaw {
            on: std::array::from_fn(|i| springs.on[i].beside(&of(i))),
            ..springs
        };
        match friction {
            Friction::Proportional { on, nominal_n_m } => beside(&|i| {
                let own = on[i].with_only(|parameter| parameter.grows_with_preload);
                own.at_share_of_preload(nominal_n_m.recip())
            }),
            Friction::Table(entries) => {
                let place = self.place(preload_n_m);
                let [low, high] = place.entries(entries);
                let per_n_m = place.width_n_m.recip();
                beside(&|i| low[i].secant(&high[i], per_n_m))
            }
        }
    }

    /// The same as far as springs change: what [`JointLaw::power_of_change`] takes. In proportion, friction changes no spring.
    #[must_use]
    pub fn spring_change(&self, preload_n_m: f64) -> JointLaw<D> {
        match &self.friction {
            Some(Friction::Table(_)) => self.change(preload_n_m),
            _ => self.slope(preload_n_m),
        }
    }

    /// Energy (J) that a preload which goes in place from one (N·m) to another puts into the springs, at the relative displacement
    /// r, with the elongations of laws that remember `memory` held. What slips then is heat of its own.
    #[must_use]
    pub fn work_of_preload(
        &self,
        [from_n_m, to_n_m]: [f64; 2],
        memory: &JointMemory<D>,
        r: &[f64; D],
    ) -> f64 {
        // U(r; p⁺) − U(r; p⁻)
        let springs =
            self.springs(to_n_m).stored_energy(r) - self.springs(from_n_m).stored_energy(r);
        match &self.friction {
            Some(Friction::Table(_)) => {
                let [from, to] = [from_n_m, to_n_m].map(|preload_n_m| self.law(preload_n_m));
                springs + (from.energy_in(&to, memory, r) - from.energy_in(&from, memory, r))
            }
            _ => springs,
        }
    }

    /// Second derivative of the table's law by the preload, per (N·m)², at a preload (N·m); zero beyond the table. At the table's own
    /// preloads it jumps: there it is that of the gap above.
    #[must_use]
    pub fn curvature(&self, preload_n_m: f64) -> JointLaw<D> {
        let place = self.place(preload_n_m);
        if !place.is_within {
            return JointLaw::NONE;
        }
        let (t, width) = (place.share, place.width_n_m);
        let s = 1.0 - t;
        // K'' = 2/h (s (m − K₀') + t (K₁' − m)) with m = 3Δ − K₀' − K₁'
        place.combined(|[low, low_slope, high, high_slope]| {
            let middle = 3.0 * ((high - low) / width) - low_slope - high_slope;
            2.0 / width * (s * (middle - low_slope) + t * (high_slope - middle))
        })
    }

    #[inline]
    fn place(&self, preload_n_m: f64) -> Place<'_, D> {
        let [first, last] = self.range_n_m();
        let preload = preload_n_m.clamp(first, last);
        let above = self
            .knots
            .partition_point(|knot| knot.preload_n_m <= preload);
        let index = above.clamp(1, self.knots.len() - 1);
        let (lower, upper) = (&self.knots[index - 1], &self.knots[index]);
        let width_n_m = upper.preload_n_m - lower.preload_n_m;
        Place {
            lower,
            upper,
            index,
            width_n_m,
            share: (preload - lower.preload_n_m) / width_n_m,
            is_within: preload == preload_n_m,
        }
    }
}

impl<const D: usize> Place<'_, D> {
    /// What a list beside the table has at the lower and at the upper knot.
    fn entries<'e>(&self, list: &'e [[DofLaws; D]]) -> [&'e [DofLaws; D]; 2] {
        [self.index - 1, self.index].map(|index| &list[index])
    }

    /// A function of value and slope at the lower, then at the upper knot, of each coefficient.
    #[inline]
    fn combined(&self, of: impl Fn([f64; 4]) -> f64) -> JointLaw<D> {
        let (low, high) = (self.lower, self.upper);
        JointLaw::each([&low.law, &low.slope, &high.law, &high.slope], of)
    }
}

impl<const D: usize> Knot<D> {
    /// The knot with this index, if the table has it.
    fn of(table: &[(f64, JointLaw<D>)], index: usize) -> Option<Self> {
        let &(preload_n_m, law) = table.get(index)?;
        let gap = |low: Option<usize>| {
            let low = low?;
            let (&(from, ref below), &(to, ref above)) = (table.get(low)?, table.get(low + 1)?);
            let width_n_m = to - from;
            let secant = JointLaw::each([below, above], |[b, a]| (a - b) / width_n_m);
            Some((width_n_m, secant))
        };
        let (before, after) = (gap(index.checked_sub(1)), gap(Some(index)));
        let mut slope = match (&before, &after) {
            (Some((h0, before)), Some((h1, after))) => {
                JointLaw::each([before, after], |[d0, d1]| {
                    inner_slope([*h0, *h1], [d0, d1])
                })
            }
            (Some(near), None) => end_slope_of(near, &gap(index.checked_sub(2))),
            (None, Some(near)) => end_slope_of(near, &gap(Some(index + 1))),
            (None, None) => JointLaw::NONE,
        };
        // what the law bears towards the knot before and towards the one after
        let thirds = [
            before.map(|(width_n_m, _)| -width_n_m / 3.0),
            after.map(|(width_n_m, _)| width_n_m / 3.0),
        ];
        limit(&law.linear.stiffness, &mut slope.linear.stiffness, thirds);
        limit(&law.linear.damping, &mut slope.linear.damping, thirds);
        Some(Self {
            preload_n_m,
            law,
            slope,
        })
    }
}

/// Slope at a knot between gaps of these widths and secants: their weighted harmonic mean, zero at an extremum.
fn inner_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    if !(d0 > 0.0 && d1 > 0.0 || d0 < 0.0 && d1 < 0.0) {
        return 0.0;
    }
    // 1/d = (w₀/d₀ + w₁/d₁)/(w₀ + w₁), w₀ = h₀ + 2h₁, w₁ = 2h₀ + h₁   (Fritsch and Butland)
    let (w0, w1) = (h0 + 2.0 * h1, 2.0 * h0 + h1);
    (w0 + w1) / (w0 / d0 + w1 / d1)
}

/// Slope at an end, with the gap beside it and the next one, where there is one.
fn end_slope_of<const D: usize>(
    (h0, near): &(f64, JointLaw<D>),
    next: &Option<(f64, JointLaw<D>)>,
) -> JointLaw<D> {
    match next {
        Some((h1, next)) => {
            JointLaw::each([near, next], |[d0, d1]| end_slope([*h0, *h1], [d0, d1]))
        }
        None => *near,
    }
}

/// That of the parabola through the three knots, as far as the curve stays monotone with it.
fn end_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    // d = ((2h₀ + h₁) d₀ − h₀ d₁)/(h₀ + h₁), between 0 and 3 d₀
    let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if d0 > 0.0 {
        slope.clamp(0.0, 3.0 * d0)
    } else {
        slope.clamp(3.0 * d0, 0.0)
    }
}

/// Makes `slope` smaller until the matrix moved by it over `thirds` (a third of the gap before, negative, and of that after)
/// is positive semidefinite, if the matrix itself is.
fn limit<const D: usize>(
    matrix: &[[f64; D]; D],
    slope: &mut [[f64; D]; D],
    thirds: [Option<f64>; 2],
) {
    if !is_positive_semidefinite(matrix) {
        return;
    }
    let bears = |part: f64| {
        thirds.iter().flatten().all(|third| {
            let moved: [[f64; D]; D] = std::array::from_fn(|i| {
                std::array::from_fn(|j| matrix[i][j] + part * third * slope[i][j])
            });
            is_positive_semidefinite(&moved)
        })
    };
    if bears(1.0) {
        return;
    }
    // the parts that it bears are an interval from 0, because the matrices are a convex cone
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if bears(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    for entry in slope.iter_mut().flatten() {
        *entry *= low;
    }
}

#[cfg(test)]
mod tests;
