//! One assembly's receptances in the form in which the estimator runs through them: flat, by line, reciprocal pairs merged.
//!
//! With symmetric substructures and a symmetric joint H^C_pq and H^C_qp are one number. Two measurements of it enter as
//! their mean; their difference tells noise alone.

use num_complex::Complex64;

use crate::structure::ComplexMatrix;

use super::lines::Lines;

/// A symmetric matrix or a vector of the joint's DOFs at one line.
pub(super) type Small<const N: usize> = [[Complex64; N]; N];

/// One entry of the symmetric H^C_ss, measured once or more often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) row: usize,
    pub(super) column: usize,
    /// Independent measurements of it.
    pub(super) count: u32,
}

/// Receptances of one assembly and of what it was made from, over its lines.
#[derive(Clone, Debug)]
pub(super) struct Block<const N: usize> {
    pub(super) points: usize,
    pub(super) entries: Vec<Entry>,
    /// ω of each line.
    pub(super) omega: Vec<f64>,
    /// H_jj + H_kk of each line.
    pub(super) free: Vec<Small<N>>,
    /// Median over the lines of 1/|H_jj + H_kk| on each DOF.
    pub(super) dynamic_stiffness: [f64; N],
    /// H_ks: one column for each point, of each line.
    pub(super) transfer: Vec<[Complex64; N]>,
    /// H_ss at the entries, of each line.
    pub(super) own: Vec<Complex64>,
    /// Mean of the measured H^C_ss at the entries, of each line.
    pub(super) measured: Vec<Complex64>,
    /// Σ|y − mean|² over the measurements of each entry and line.
    pub(super) scatter: Vec<f64>,
    /// Variance of one measurement as a fraction of |H|², where it is known line by line; else empty.
    pub(super) known: Vec<f64>,
}

impl<const N: usize> Block<N> {
    /// Every `stride`th line of `lines`, whose joint has N DOFs.
    pub(super) fn new(lines: &Lines, stride: usize) -> Self {
        let measured = lines.independent();
        let repeats = lines.repeats.as_ref().map_or(1, |repeats| repeats.count);
        let mut entries: Vec<Entry> = Vec::new();
        for &(p, q) in &measured {
            let (row, column) = (p.min(q), p.max(q));
            match entries
                .iter_mut()
                .find(|entry| (entry.row, entry.column) == (row, column))
            {
                Some(entry) => entry.count += repeats,
                None => entries.push(Entry {
                    row,
                    column,
                    count: repeats,
                }),
            }
        }
        let points = lines.points.len();
        let chosen = || (0..lines.frequency_hz.len()).step_by(stride);
        let count = chosen().count();
        let mut block = Self {
            points,
            omega: Vec::with_capacity(count),
            free: Vec::with_capacity(count),
            dynamic_stiffness: [0.0; N],
            transfer: Vec::with_capacity(count * points),
            own: Vec::with_capacity(count * entries.len()),
            measured: Vec::with_capacity(count * entries.len()),
            scatter: Vec::with_capacity(count * entries.len()),
            known: Vec::new(),
            entries,
        };
        for line in chosen() {
            block.push(lines, &measured, line);
        }
        block.dynamic_stiffness = std::array::from_fn(|dof| {
            let diagonal = block.free.iter().map(|free| free[dof][dof]);
            let mut values: Vec<f64> = diagonal.map(|value| value.norm().recip()).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or(1.0)
        });
        block
    }

    fn push(&mut self, lines: &Lines, measured: &[(usize, usize)], line: usize) {
        let (a, b, assembly) = (&lines.a_joint[line], &lines.b[line], &lines.assembly[line]);
        self.omega
            .push(std::f64::consts::TAU * lines.frequency_hz[line]);
        let symmetric = |matrix: &ComplexMatrix, i, j| 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
        self.free.push(std::array::from_fn(|i| {
            std::array::from_fn(|j| symmetric(a, i, j) + symmetric(&b.joint, i, j))
        }));
        for point in 0..self.points {
            self.transfer.push(std::array::from_fn(|i| {
                0.5 * (b.joint_points[(i, point)] + b.points_joint[(point, i)])
            }));
        }
        for entry in &self.entries {
            let (row, column) = (entry.row, entry.column);
            self.own.push(symmetric(&b.points, row, column));
            let places = [(row, column), (column, row)];
            let distinct = if row == column { 1 } else { 2 };
            let own = || {
                places[..distinct]
                    .iter()
                    .filter(|place| measured.contains(place))
            };
            // Of two measurements of one number the one with the higher coherence counts for more: y = Σ yᵢ/vᵢ / Σ 1/vᵢ
            let weight = |place: (usize, usize)| lines.known_variance(place, line).recip();
            let total: f64 = own().map(|&place| weight(place)).sum();
            let mean = own()
                .map(|&place| assembly[place] * weight(place))
                .sum::<Complex64>()
                / total;
            self.measured.push(mean);
            let common = own().count() as f64 / total;
            let between: f64 = own()
                .map(|&place| common * weight(place) * (assembly[place] - mean).norm_sqr())
                .sum();
            self.scatter.push(match &lines.repeats {
                Some(repeats) => {
                    let within: f64 = own().map(|&place| repeats.scatter[line][place]).sum();
                    within + f64::from(repeats.count) * between
                }
                None => between,
            });
            if lines.relative_variance.is_some() {
                self.known.push(common);
            }
        }
    }

    pub(super) fn lines(&self) -> usize {
        self.omega.len()
    }
}
