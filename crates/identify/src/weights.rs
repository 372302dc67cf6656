//! Variances of everything measured, and the noise level that the residuals show.
//!
//! Those of the assembly come from the model: with the measured |H| a line on which noise happens to reduce the receptance would
//! get more weight, which biases the damping. Those of the substructures come from what was measured, so that they stay as they
//! are while the corrections change.

use nalgebra::DVector;

use super::group::{Group, Side, Source};
use super::independent;
use super::lanes::{Complexes, LANES, Reals};
use super::line::Line;
use super::noise::{Floor, Levels, Noise, Of, Sample, Size, most_likely_level};
use super::normal::Normal;
use super::objective::{Objective, State, Weights};

/// No measured receptance of an assembly is taken for better than this fraction of itself.
const LEAST_RELATIVE: f64 = 1e-14;

impl Objective<'_> {
    /// Variances at `state`; `None` where one is not a number above zero.
    pub(super) fn weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>> {
        let mut all: Vec<Weights> = self
            .groups
            .iter()
            .map(|group| Weights {
                entries: vec![0.0; group.lines() * group.entries()],
                levels,
                scatter: 0.0,
            })
            .collect();
        let mut usable = true;
        self.visit(state, &mut |number, line| {
            let group = &self.groups[number];
            let weights = &mut all[number];
            let size = group.entries();
            let scatter = line_variances(
                group,
                line,
                levels,
                &mut weights.entries[line.index * size..(line.index + 1) * size],
            );
            usable &= scatter.is_some();
            weights.scatter += scatter.unwrap_or(0.0);
        })?;
        usable.then_some(all)
    }

    /// Variances of y − H^C with the substructures as measured, the errors of these included, one group for each block.
    pub(super) fn marginal_weights(
        &self,
        levels: Levels,
        unknowns: &DVector<f64>,
    ) -> Option<Vec<Weights>> {
        let mut all: Vec<Weights> = Vec::new();
        for group in self.groups {
            let of_group = if group.sources.is_empty() {
                let mut normal = Normal::zero(unknowns.len());
                let unknowns = unknowns.as_slice();
                independent::renew(group, self.entries, unknowns, levels, &mut normal)?.entries
            } else {
                self.marginal_variances(group, levels, unknowns)?
            };
            let mut of_blocks: Vec<Vec<f64>> = vec![Vec::new(); group.blocks.len()];
            for mut of_line in of_group.chunks_exact(group.entries()) {
                for (block, own) in group.blocks.iter().zip(&mut of_blocks) {
                    let (of_block, rest) = of_line.split_at(block.entries.len());
                    own.extend_from_slice(of_block);
                    of_line = rest;
                }
            }
            all.extend(of_blocks.into_iter().map(|entries| Weights {
                entries,
                levels,
                scatter: 0.0,
            }));
        }
        Some(all)
    }

    /// The level that makes the residuals at `state` most likely, where `noise` does not state it.
    ///
    /// `shrinkage` is what fitting has left of the residuals' variance.
    pub(super) fn level(&self, noise: &Noise, state: &State, shrinkage: f64) -> Option<Size> {
        let mut samples = Vec::new();
        self.visit(state, &mut |number, line| {
            let group = &self.groups[number];
            let size = line.computed.len();
            for_each_entry(group, line, |entry| {
                if !entry.takes_part {
                    return;
                }
                let count = f64::from(entry.count);
                let of_one = |known: Option<f64>| Sample {
                    power: 0.0,
                    by_relative: if known.is_some() { 0.0 } else { entry.power },
                    by_floor: if known.is_some() {
                        0.0
                    } else {
                        entry.floor.own
                    },
                    known: known.unwrap_or(entry.floor.stated),
                    count: 1.0,
                };
                let one = of_one(entry.known);
                if entry.count > 1 {
                    samples.push(Sample {
                        power: entry.scatter / (count - 1.0),
                        count: count - 1.0,
                        ..one
                    });
                }
                let mut sample = Sample {
                    power: line.residual[entry.index].norm_sqr() / shrinkage,
                    by_relative: one.by_relative / count,
                    by_floor: one.by_floor / count,
                    known: one.known / count,
                    count: 1.0,
                };
                for (s, source) in group.sources.iter().enumerate() {
                    let gain =
                        line.by_source[s * size + entry.index].norm_sqr() / f64::from(source.count);
                    let power = source.value_at(line.index).norm_sqr();
                    add_source(&mut sample, source, noise, gain, power, line.index);
                }
                samples.push(sample);
            });
        })?;
        Some(most_likely_level(&samples, noise.assembly.relative))
    }
}

/// Variance of one measurement of the assembly from its computed |H^C|², or what is `known` of it.
#[inline]
pub(super) fn of_one(level: Size, floor: Floor, known: Option<f64>, power: f64) -> f64 {
    let least = LEAST_RELATIVE * LEAST_RELATIVE * power;
    let variance = match known {
        Some(known) => known,
        None => level.variance(power, floor),
    };
    if variance < least { least } else { variance }
}

/// The same at lines side by side.
#[inline(always)]
pub(super) fn of_lanes(level: Size, floor: Floor, known: Option<Reals>, power: Reals) -> Reals {
    let least = Reals::all(LEAST_RELATIVE * LEAST_RELATIVE) * power;
    let variance = match known {
        Some(known) => known,
        None => {
            Reals::all(level.relative * level.relative) * power + Reals::all(floor.variance(level))
        }
    };
    variance.at_least(least)
}

fn add_source(
    sample: &mut Sample,
    source: &Source,
    noise: &Noise,
    gain: f64,
    power: f64,
    line: usize,
) {
    if let Some(known) = source.known.get(line) {
        sample.known += known * gain * power;
        return;
    }
    let stated = match source.side {
        Side::A => noise.a,
        Side::B => noise.b,
    };
    // What is not stated of a substructure is as the assembly's.
    match stated.relative.or(noise.assembly.relative) {
        Some(relative) => sample.known += relative * relative * gain * power,
        None => sample.by_relative += gain * power,
    }
    sample.known += source.floor.stated * gain;
    sample.by_floor += source.floor.own * gain;
}

/// Variances of one computed line: of the mean of each entry, from the computed receptances, infinite where it is left out, and of
/// each source, from the measured ones. Returns Σ|y − mean|²/σ² over repeated measurements; `None` where a variance is not a number above zero.
pub(super) fn line_variances(
    group: &Group,
    line: &Line<'_>,
    levels: Levels,
    entries: &mut [f64],
) -> Option<f64> {
    let mut usable = true;
    let mut scatter = 0.0;
    for_each_entry(group, line, |entry| {
        if !entry.takes_part {
            entries[entry.index] = f64::INFINITY;
            return;
        }
        let power = if group.sources.is_empty() {
            entry.power
        } else {
            held_power(entry.power, entry.measured)
        };
        let variance = of_one(levels.assembly, entry.floor, entry.known, power);
        usable &= variance.is_finite() && variance > 0.0;
        entries[entry.index] = variance / f64::from(entry.count);
        scatter += entry.scatter / variance;
    });
    usable.then_some(scatter)
}

/// Variances of all sources at a line.
pub(super) fn source_variances(
    group: &Group,
    levels: Levels,
    line: usize,
    variances: &mut Vec<f64>,
) {
    variances.clear();
    let sources = group.sources.iter();
    variances.extend(sources.map(|source| source_variance(source, levels, line)));
}

/// Variance of a source at a line, from its measured value.
pub(super) fn source_variance(source: &Source, levels: Levels, line: usize) -> f64 {
    let power = source.value_at(line).norm_sqr();
    let variance = match source.known.get(line) {
        Some(known) => known * power,
        None => levels
            .of(Of::Substructure(source.side))
            .variance(power, source.floor),
    };
    variance / f64::from(source.count)
}

/// The same at lines side by side, whose values stand at these places.
#[inline(always)]
pub(super) fn source_variance_of_lanes(
    source: &Source,
    levels: Levels,
    (lines, places): ([usize; LANES], [usize; LANES]),
) -> Reals {
    let values = source.value.as_slice();
    let power = Complexes::of(|lane| values[places[lane]]).norm_sqr();
    let variance = if source.known.is_empty() {
        let level = levels.of(Of::Substructure(source.side));
        let relative = Reals::all(level.relative * level.relative);
        relative * power + Reals::all(source.floor.variance(level))
    } else {
        Reals::of(|lane| source.known[lines[lane]]) * power
    };
    variance / Reals::all(f64::from(source.count))
}

/// One entry of one block at one line.
struct EntryView {
    /// Index among the entries of all blocks of the group.
    index: usize,
    count: u32,
    /// |H^C|² as computed.
    power: f64,
    /// |y|² as measured.
    measured: f64,
    scatter: f64,
    known: Option<f64>,
    floor: Floor,
    takes_part: bool,
}

/// A computed |H^C|² that corrections of the substructures move is taken for at most so many times the measured one, and for
/// no less than its reciprocal: while they are on their way it can be next to nothing.
const MOST_APART: f64 = 4.0;

/// |H^C|² as computed, held near what was measured.
pub(super) fn held_power(power: f64, measured: f64) -> f64 {
    if measured > 0.0 {
        power.clamp(measured / MOST_APART, measured * MOST_APART)
    } else {
        power
    }
}

/// The same at lines side by side.
#[inline(always)]
pub(super) fn held_powers(computed: Complexes, measured: Complexes) -> Reals {
    let (power, measured) = (computed.norm_sqr(), measured.norm_sqr());
    let most_apart = Reals::all(MOST_APART);
    let held = (measured / most_apart).at_least(power);
    let held = (measured * most_apart).at_most(held);
    measured.where_positive(held, power)
}

fn for_each_entry(group: &Group, line: &Line<'_>, mut visit: impl FnMut(EntryView)) {
    let mut index = 0;
    for block in &group.blocks {
        let count = block.entries.len();
        for (e, entry) in block.entries.iter().enumerate() {
            visit(EntryView {
                index,
                count: entry.count,
                power: line.computed[index].norm_sqr(),
                measured: block.measured[line.index * count + e].norm_sqr(),
                scatter: block.scatter[line.index * count + e],
                known: block.known.get(line.index * count + e).copied(),
                floor: entry.floor,
                takes_part: block.takes_part(line.index),
            });
            index += 1;
        }
    }
}
