//! One assembly's receptances in the form in which the estimator runs through them: flat, by line, reciprocal pairs merged.
//!
//! With symmetric substructures and a symmetric joint H^C_pq and H^C_qp are one number. Two measurements of it enter as
//! their mean; their difference tells noise alone.

use std::ops::Range;

use bolted_joint_frf::absolute_variances;
use num_complex::Complex64;

use super::layout::Place;
use super::lines::Lines;
use super::noise::{Floor, Noise, Of};
use super::used::Chosen;

/// One entry of the symmetric H^C_ss, measured once or more often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) row: usize,
    pub(super) column: usize,
    /// Independent measurements of it.
    pub(super) count: u32,
    /// Floor of the noise of one measurement.
    pub(super) floor: Floor,
}

/// Receptances of one assembly and of what it was made from, over its lines.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Which of the joints that are sought is in this assembly.
    pub(super) joint: usize,
    /// DOFs of that joint.
    pub(super) dofs: usize,
    pub(super) points: usize,
    pub(super) entries: Vec<Entry>,
    /// ω of each line.
    pub(super) omega: Vec<f64>,
    /// H_jj + H_kk of each line, row by row.
    pub(super) free: Vec<Complex64>,
    /// Median over the lines of 1/|H_jj + H_kk| on each DOF.
    pub(super) dynamic_stiffness: Vec<f64>,
    /// H_ks: one column for each point, of each line.
    pub(super) transfer: Vec<Complex64>,
    /// H_ss at the entries, of each line.
    pub(super) own: Vec<Complex64>,
    /// Mean of the measured H^C_ss at the entries, of each line.
    pub(super) measured: Vec<Complex64>,
    /// Σ|y − mean|² over the measurements of each entry and line.
    pub(super) scatter: Vec<f64>,
    /// Variance of one measurement, in the square of its unit, where it is known line by line; else empty.
    pub(super) known: Vec<f64>,
    /// Whether what was measured of this assembly at a line is left out; empty if nothing is.
    pub(super) left_out: Vec<bool>,
}

/// No measurement is taken for better than that: its reciprocal is a number.
const LEAST_VARIANCE: f64 = 1e-300;

impl Block {
    /// The `chosen` ones of `lines`, whose joint is number `joint` of those that are sought.
    pub(super) fn new(lines: &Lines, joint: usize, chosen: &Chosen, noise: &Noise) -> Self {
        let repeats = lines.repeats.as_ref().map_or(1, |repeats| repeats.count);
        let measured = lines.independent();
        let is_rotation = |point: usize| lines.points[point].direction().is_rotation();
        let mut entries: Vec<Entry> = Vec::new();
        let mut places: Vec<Vec<(usize, usize)>> = Vec::new();
        for &(p, q) in &measured {
            let (row, column) = (p.min(q), p.max(q));
            let known = entries
                .iter()
                .position(|entry| (entry.row, entry.column) == (row, column));
            if let Some(known) = known {
                entries[known].count += repeats;
                places[known].push((p, q));
            } else {
                let count = repeats;
                entries.push(Entry {
                    row,
                    column,
                    count,
                    floor: Floor::default(),
                });
                places.push(vec![(p, q)]);
            }
        }
        for (entry, places) in entries.iter_mut().zip(&places) {
            let rotations = [entry.row, entry.column].map(is_rotation);
            let own = || {
                let floors = places.iter().map(|&place| lines.floor(place).powi(2));
                (floors.sum::<f64>() * f64::from(repeats) / places.len() as f64).sqrt()
            };
            entry.floor = noise.floor(Of::Assembly, rotations, own);
        }
        let dofs = lines.joint_dofs();
        let points = lines.points.len();
        let count = chosen.lines.len();
        let mut block = Self {
            joint,
            dofs,
            points,
            omega: chosen
                .lines
                .iter()
                .map(|&line| std::f64::consts::TAU * lines.frequency_hz[line])
                .collect(),
            free: Vec::new(),
            dynamic_stiffness: Vec::new(),
            transfer: Vec::new(),
            own: Vec::new(),
            measured: Vec::with_capacity(count * entries.len()),
            scatter: Vec::with_capacity(count * entries.len()),
            known: Vec::new(),
            left_out: chosen.left_out.clone(),
            entries,
        };
        let variances = variances(lines, &places);
        block.take_substructures(lines, &chosen.lines);
        for &line in &chosen.lines {
            block.push_assembly(lines, &places, variances.as_deref(), line);
        }
        let of_dof = |dof: usize| {
            let diagonal = block
                .free
                .iter()
                .skip(dof * (dofs + 1))
                .step_by(dofs * dofs);
            let mut sizes: Vec<f64> = diagonal.map(|value| value.norm_sqr()).collect();
            if sizes.is_empty() {
                return 1.0;
            }
            // The upper median of the reciprocals is the lower one of the receptances.
            let middle = (sizes.len() - 1) / 2;
            let (_, &mut median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
            median.sqrt().recip()
        };
        block.dynamic_stiffness = (0..dofs).map(of_dof).collect();
        block
    }

    /// H_jj + H_kk, H_ks and H_ss at the `chosen` lines.
    fn take_substructures(&mut self, lines: &Lines, chosen: &[usize]) {
        let (dofs, points) = (self.dofs, self.points);
        let of_b = |i, j| lines.b.function(i, j).over(chosen);
        let joint = (0..dofs).flat_map(|i| (0..dofs).map(move |j| (i, j)));
        let free = joint.map(|(i, j)| {
            let mut sums = lines.a.function(i, j).over(chosen);
            for (sum, b) in sums.iter_mut().zip(of_b(i, j)) {
                *sum += b;
            }
            sums
        });
        self.free = interleaved(free.collect(), chosen.len());
        let transfer = (dofs..dofs + points).flat_map(|point| (0..dofs).map(move |i| (i, point)));
        self.transfer = interleaved(transfer.map(|(i, j)| of_b(i, j)).collect(), chosen.len());
        let own = self.entries.iter();
        let own = own.map(|entry| of_b(dofs + entry.row, dofs + entry.column));
        self.own = interleaved(own.collect(), chosen.len());
    }

    /// `places` of each entry, and σ² of each of them over the lines where it is known.
    fn push_assembly(
        &mut self,
        lines: &Lines,
        places: &[Vec<(usize, usize)>],
        variances: Option<&[Vec<Vec<f64>>]>,
        line: usize,
    ) {
        let assembly = &lines.assembly[line];
        for (entry, places) in places.iter().enumerate() {
            let known = variances.map(|variances| &variances[entry]);
            if let ([place], None) = (&places[..], &lines.repeats) {
                self.measured.push(assembly[*place]);
                self.scatter.push(0.0);
                self.known.extend(known.map(|known| known[0][line]));
                continue;
            }
            if let ([one, other], None, None) = (&places[..], known, &lines.repeats) {
                let (one, other) = (assembly[*one], assembly[*other]);
                let mean = (one + other) / 2.0;
                self.measured.push(mean);
                self.scatter
                    .push((one - mean).norm_sqr() + (other - mean).norm_sqr());
                continue;
            }
            // Of two measurements of one number the one with the higher coherence counts for more: y = Σ yᵢ/vᵢ / Σ 1/vᵢ
            let weight =
                |index: usize| known.map_or(1.0, |k| k[index][line].max(LEAST_VARIANCE).recip());
            let weighted = || (0..places.len()).map(|index| (weight(index), places[index]));
            let total: f64 = weighted().map(|(weight, _)| weight).sum();
            let sum: Complex64 = weighted()
                .map(|(weight, place)| assembly[place] * weight)
                .sum();
            let mean = sum / total;
            self.measured.push(mean);
            let common = places.len() as f64 / total;
            self.known.extend(known.map(|_| common));
            let between: f64 = weighted()
                .map(|(weight, place)| common * weight * (assembly[place] - mean).norm_sqr())
                .sum();
            self.scatter.push(match &lines.repeats {
                Some(repeats) => {
                    let scatter = &repeats.scatter[line];
                    let within: f64 = places.iter().map(|&place| scatter[place]).sum();
                    within + f64::from(repeats.count) * between
                }
                None => between,
            });
        }
    }

    /// Where the unknowns of its joint are among those of all, each joint having these entries.
    pub(super) fn unknowns(&self, entries: &[Place]) -> Range<usize> {
        let size = 2 * entries.len();
        self.joint * size..(self.joint + 1) * size
    }

    /// H_jj + H_kk at one line.
    pub(super) fn free_at(&self, line: usize) -> &[Complex64] {
        let size = self.dofs * self.dofs;
        &self.free[line * size..(line + 1) * size]
    }

    /// H_ks at one line, a column for each point.
    pub(super) fn transfer_at(&self, line: usize) -> &[Complex64] {
        let size = self.points * self.dofs;
        &self.transfer[line * size..(line + 1) * size]
    }

    pub(super) fn lines(&self) -> usize {
        self.omega.len()
    }

    /// Whether what was measured at a line takes part.
    pub(super) fn takes_part(&self, line: usize) -> bool {
        !self.left_out.get(line).is_some_and(|left_out| *left_out)
    }

    /// Lines at which what was measured takes part.
    pub(super) fn used_lines(&self) -> usize {
        let left_out = self.left_out.iter().filter(|left_out| **left_out);
        self.lines() - left_out.count()
    }
}

/// All values of each line one after the other, from those of each function.
fn interleaved(functions: Vec<Vec<Complex64>>, lines: usize) -> Vec<Complex64> {
    let count = functions.len();
    let mut values = vec![Complex64::ZERO; count * lines];
    for (place, function) in functions.into_iter().enumerate() {
        for (of_line, value) in values.chunks_exact_mut(count).zip(function) {
            of_line[place] = value;
        }
    }
    values
}

/// σ² of each place of each entry over the lines, where it is known.
fn variances(lines: &Lines, places: &[Vec<(usize, usize)>]) -> Option<Vec<Vec<Vec<f64>>>> {
    let relative = lines.relative_variance.as_ref()?;
    let of_place = |&place: &(usize, usize)| {
        let index = lines.measured.iter().position(|&other| other == place)?;
        let power = |line: usize| lines.assembly[line][place].norm_sqr();
        Some(absolute_variances(relative.get(index)?, power))
    };
    let of_entry = |places: &Vec<(usize, usize)>| places.iter().map(of_place).collect();
    places.iter().map(of_entry).collect()
}
