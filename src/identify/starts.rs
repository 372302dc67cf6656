//! Starting values of the estimator: the linearised problem solved as it is, and joints from soft to stiff beside the
//! substructures.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::block::Block;
use super::group::Group;
use super::kernel::{Kernel, complex_stiffness, inverse};

/// Stiffness of a start as a multiple of the substructures' own dynamic stiffness at the joint.
const MULTIPLES: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// The same for a start that all but leaves the substructures apart: a loose joint has minima of its own beside zero, in
/// which a single spring acts where the measured points hardly move.
const LOOSE: f64 = 1e-6;

/// Stride through the grid; it shares no divisor with 5 or 17, the starts of one and of two DOFs.
const FAR_APART: usize = 6;

/// Loss of a start's joint at the middle of the frequency range, ωc/k.
const LOSS: f64 = 1e-2;

/// Rounds of the linear estimate, each weighted by the joint of the one before.
const LINEAR_ROUNDS: usize = 6;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// A grid of diagonal joints, each DOF from soft to stiff, and one that all but does not join; neighbours in the list are
/// far apart in the grid.
pub(super) fn grid<const N: usize>(
    groups: &[Group<N>],
    entries: &[(usize, usize)],
) -> Vec<DVector<f64>> {
    let blocks: Vec<&Block<N>> = groups.iter().flat_map(|group| &group.blocks).collect();
    let typical = blocks
        .first()
        .map_or([1.0; N], |block| block.dynamic_stiffness);
    let omega = blocks
        .first()
        .map_or(1.0, |block| block.omega[block.lines() / 2]);
    let diagonal: Vec<usize> = (0..N)
        .filter(|&dof| entries.contains(&(dof, dof)))
        .collect();
    let mut starts = Vec::new();
    let mut push = |multiple: &dyn Fn(usize) -> f64| {
        let mut start = DVector::zeros(2 * entries.len());
        for (index, &(i, j)) in entries.iter().enumerate() {
            if i == j {
                let stiffness = typical[i] * multiple(i);
                start[index] = stiffness;
                start[entries.len() + index] = stiffness * LOSS / omega;
            }
        }
        starts.push(start);
    };
    for combination in 0..MULTIPLES.len().pow(diagonal.len() as u32) {
        push(&|dof| MULTIPLES[combination / MULTIPLES.len().pow(dof as u32) % MULTIPLES.len()]);
    }
    push(&|_| LOOSE);
    let count = starts.len();
    let order = (0..count).map(|index| index * FAR_APART % count);
    order.map(|index| starts[index].clone()).collect()
}

/// Estimate by linear least squares, refined by weights from the one before; `None` if no column of H^C_ss was measured at
/// enough points.
///
/// With D = H_ss − H^C_ss measured, X = H_sk⁺ D is Z⁻¹ H_ks as measured, and X = K* (H_ks − F X) is linear in K*. Its
/// error times Qᵀ of the joint before is that of H^C, to first order. Exact data give the joint in one round; noise
/// biases the result, so that it is a start only.
pub(super) fn linear<const N: usize>(
    groups: &[Group<N>],
    entries: &[(usize, usize)],
    first: Option<&DVector<f64>>,
) -> Option<DVector<f64>> {
    let mut unknowns = first
        .cloned()
        .unwrap_or_else(|| DVector::zeros(2 * entries.len()));
    for _ in 0..LINEAR_ROUNDS {
        let mut normal = LinearNormal::new(entries);
        for block in groups.iter().flat_map(|group| &group.blocks) {
            normal.add(block, &unknowns);
        }
        unknowns = normal.solution()?;
    }
    Some(unknowns)
}

struct LinearNormal<'e> {
    entries: &'e [(usize, usize)],
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    rows: usize,
}

impl<'e> LinearNormal<'e> {
    fn new(entries: &'e [(usize, usize)]) -> Self {
        let size = 2 * entries.len();
        Self {
            entries,
            matrix: DMatrix::zeros(size, size),
            right: DVector::zeros(size),
            rows: 0,
        }
    }

    fn add<const N: usize>(&mut self, block: &Block<N>, weights_from: &DVector<f64>) {
        if block.points < N {
            return;
        }
        let columns: Vec<(usize, Vec<usize>)> = (0..block.points)
            .filter_map(|column| Some((column, whole_column(block, column)?)))
            .collect();
        let mut kernel = Kernel::new();
        for line in 0..block.lines() {
            let omega = block.omega[line];
            let before = complex_stiffness::<N>(self.entries, weights_from.as_slice(), omega);
            let transfer = &block.transfer[line * block.points..(line + 1) * block.points];
            let free = &block.free[line];
            if kernel.solve(free, transfer, &before).is_none() {
                continue;
            }
            let at = line * block.entries.len();
            for (column, places) in &columns {
                let measured = |row: usize| block.measured[at + places[row]];
                let difference = |row: usize| block.own[at + places[row]] - measured(row);
                let Some(x) = transmitted(transfer, measured, difference) else {
                    continue;
                };
                // W = H_ks − F X
                let w: [Complex64; N] = std::array::from_fn(|i| {
                    transfer[*column][i] - (0..N).map(|j| free[i][j] * x[j]).sum::<Complex64>()
                });
                for row in 0..block.points {
                    let weight = measured(row).norm_sqr().recip();
                    if weight.is_finite() {
                        self.add_row(omega, weight, kernel.q(row), &x, &w);
                    }
                }
            }
        }
    }

    /// One row: Qᵀ_p X = Σ K*_ij (Q_i W_j + Q_j W_i).
    fn add_row<const N: usize>(
        &mut self,
        omega: f64,
        weight: f64,
        q: &[Complex64; N],
        x: &[Complex64; N],
        w: &[Complex64; N],
    ) {
        let count = self.entries.len();
        let target: Complex64 = (0..N).map(|i| q[i] * x[i]).sum();
        let mut row = vec![ZERO; 2 * count];
        for (index, &(i, j)) in self.entries.iter().enumerate() {
            let coefficient = if i == j {
                q[i] * w[i]
            } else {
                q[i] * w[j] + q[j] * w[i]
            };
            row[index] = coefficient;
            row[count + index] = Complex64::new(0.0, omega) * coefficient;
        }
        for i in 0..2 * count {
            self.right[i] += weight * (row[i].conj() * target).re;
            for j in 0..2 * count {
                self.matrix[(i, j)] += weight * (row[i].conj() * row[j]).re;
            }
        }
        self.rows += 1;
    }

    fn solution(&self) -> Option<DVector<f64>> {
        let scale = self
            .matrix
            .diagonal()
            .map(|entry| entry.max(f64::MIN_POSITIVE).sqrt().recip());
        let scaled = super::normal::scaled_by(&self.matrix, &scale);
        let right = self.right.component_mul(&scale);
        let solution = scaled.cholesky()?.solve(&right).component_mul(&scale);
        (self.rows > 0 && solution.iter().all(|value| value.is_finite())).then_some(solution)
    }
}

/// Entries of one column of H^C_ss by row, if all were measured.
fn whole_column<const N: usize>(block: &Block<N>, column: usize) -> Option<Vec<usize>> {
    (0..block.points)
        .map(|row| {
            let place = (row.min(column), row.max(column));
            let entries = block.entries.iter();
            entries
                .map(|entry| (entry.row, entry.column))
                .position(|entry| entry == place)
        })
        .collect()
}

/// X = H_sk⁺ D of one column, each row as good as its measured receptance.
fn transmitted<const N: usize>(
    transfer: &[[Complex64; N]],
    measured: impl Fn(usize) -> Complex64,
    difference: impl Fn(usize) -> Complex64,
) -> Option<[Complex64; N]> {
    let mut matrix = [[ZERO; N]; N];
    let mut right = [ZERO; N];
    let mut lengths = [0.0; N];
    for (row, h) in transfer.iter().enumerate() {
        let weight = measured(row).norm_sqr().recip();
        for i in 0..N {
            lengths[i] += weight * h[i].norm_sqr();
            right[i] += weight * h[i].conj() * difference(row);
            for j in 0..N {
                matrix[i][j] += weight * h[i].conj() * h[j];
            }
        }
    }
    let scale = lengths.map(|length: f64| length.sqrt().recip());
    for i in 0..N {
        for j in 0..N {
            matrix[i][j] *= scale[i] * scale[j];
        }
    }
    let inverse = inverse(matrix)?;
    Some(std::array::from_fn(|i| {
        let row = (0..N).map(|j| inverse[i][j] * right[j] * scale[j]);
        row.sum::<Complex64>() * scale[i]
    }))
}
