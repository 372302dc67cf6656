//! Starting values of the estimator: the linearised problem solved as it is, and joints from soft to stiff beside the
//! substructures.

use nalgebra::DVector;
use num_complex::Complex64;

use super::block::Block;
use super::group::Group;
use super::kernel::{dot, filled, for_dofs, inverse, through, vector};
use super::lanes::{Complexes, LANES, Reals};
use super::layout::Place;
use super::normal::Normal;
use super::strip::{
    ENTRIES_OF_FOUR, ENTRIES_OF_ONE, InCommon, MOST_ENTRIES, Products, Strip, Sums, Vector,
    are_of_one, for_strips,
};

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

/// A grid of diagonal joints, each DOF from soft to stiff and the same at every bolt, and one that all but does not join;
/// neighbours in the list are far apart in the grid.
pub(super) fn grid(groups: &[Group], entries: &[Place]) -> Vec<DVector<f64>> {
    let blocks: Vec<&Block> = groups.iter().flat_map(|group| &group.blocks).collect();
    let typical = blocks
        .first()
        .map_or(&[][..], |block| &block.dynamic_stiffness);
    let omega = blocks
        .first()
        .map_or(1.0, |block| block.omega[block.lines() / 2]);
    let diagonal = (0..typical.len()).filter(|&dof| {
        let mut places = entries.iter();
        places.any(|place| place.diagonal_dof() == Some(dof))
    });
    let mut starts = Vec::new();
    let mut push = |multiple: &dyn Fn(usize) -> f64| {
        let mut start = DVector::zeros(2 * entries.len());
        for (index, place) in entries.iter().enumerate() {
            if let Some(dof) = place.diagonal_dof() {
                let stiffness = typical[place.first().0] * multiple(dof);
                start[index] = stiffness;
                start[entries.len() + index] = stiffness * LOSS / omega;
            }
        }
        starts.push(start);
    };
    for combination in 0..MULTIPLES.len().pow(diagonal.count() as u32) {
        push(&|dof| MULTIPLES[combination / MULTIPLES.len().pow(dof as u32) % MULTIPLES.len()]);
    }
    push(&|_| LOOSE);
    let count = starts.len();
    let order = (0..count).map(|index| index * FAR_APART % count);
    order.map(|index| starts[index].clone()).collect()
}

/// Estimate by linear least squares, refined by weights from the one before.
///
/// With D = H_ss − H^C_ss measured, X = H_sk⁺ D is Z⁻¹ H_ks as measured, and X = K* (H_ks − F X) is linear in K*. Its
/// error times Qᵀ of the joint before is that of H^C, to first order. Exact data give the joint in one round; noise
/// biases the result, so that it is a start only.
pub(super) struct Linear<'b>(Vec<Transmitted<'b>>);

impl<'b> Linear<'b> {
    /// The data in the form that it needs.
    pub(super) fn of(groups: &'b [Group]) -> Self {
        let blocks = groups.iter().flat_map(|group| &group.blocks);
        let usable = blocks
            .filter(|block| block.points >= block.dofs)
            .map(Transmitted::of)
            .filter(Transmitted::is_measured);
        Self(usable.collect())
    }

    /// The estimate whose first weights are those of `first`, or of no joint; `None` if no column of H^C_ss was measured at
    /// enough points.
    pub(super) fn from(
        &self,
        entries: &[Place],
        first: Option<&DVector<f64>>,
    ) -> Option<DVector<f64>> {
        if self.0.is_empty() {
            return None;
        }
        let none = || DVector::zeros(2 * entries.len());
        let mut unknowns = first.cloned().unwrap_or_else(none);
        for _ in 0..LINEAR_ROUNDS {
            let mut normal = Normal::zero(unknowns.len());
            for transmitted in &self.0 {
                let dofs = transmitted.block.dofs;
                let add: Option<Add> = for_strips!(dofs, entries, add_to);
                add?(transmitted, &mut normal, entries, unknowns.as_slice())?;
            }
            normal.matrix.fill_upper_triangle_with_lower_triangle();
            unknowns = normal.step(0.0)?;
            if unknowns.iter().any(|value| !value.is_finite()) {
                return None;
            }
        }
        Some(unknowns)
    }
}

/// What the joint of one assembly transmits as measured, for each line and each complete column of H^C_ss.
struct Transmitted<'b> {
    block: &'b Block,
    /// Complete columns of H^C_ss.
    columns: usize,
    /// X, an entry for each DOF
    x: Vec<Complex64>,
    /// W = H_ks − F X
    w: Vec<Complex64>,
    /// Weight of each point, zero where a value cannot be used.
    weight: Vec<f64>,
}

impl<'b> Transmitted<'b> {
    fn of(block: &'b Block) -> Self {
        let complete: Vec<(usize, Vec<usize>)> = (0..block.points)
            .filter_map(|column| Some((column, whole_column(block, column)?)))
            .collect();
        let mut all = Self {
            block,
            columns: complete.len(),
            x: Vec::new(),
            w: Vec::new(),
            weight: Vec::new(),
        };
        let of_column: Option<OfColumn> = for_dofs!(block.dofs, transmitted);
        let dofs = block.dofs;
        let none = vec![ZERO; dofs];
        for line in 0..block.lines() {
            let (free, transfer) = (block.free_at(line), block.transfer_at(line));
            let at = line * block.entries.len();
            for (column, places) in &complete {
                let measured = |row: usize| block.measured[at + places[row]];
                let difference = |row: usize| block.own[at + places[row]] - measured(row);
                let found = of_column.and_then(|of| of(dofs, transfer, &measured, &difference));
                let x = found.as_ref().unwrap_or(&none);
                all.x.extend_from_slice(x);
                all.w.extend((0..dofs).map(|i| {
                    transfer[column * dofs + i] - dot(&free[i * dofs..(i + 1) * dofs], x)
                }));
                all.weight.extend((0..block.points).map(|row| {
                    let weight = measured(row).norm_sqr().recip();
                    let is_usable = found.is_some() && weight.is_finite();
                    if is_usable { weight } else { 0.0 }
                }));
            }
        }
        all
    }

    fn is_measured(&self) -> bool {
        self.weight.iter().any(|weight| *weight > 0.0)
    }
}

type Add = fn(&Transmitted<'_>, &mut Normal, &[Place], &[f64]) -> Option<()>;

/// Rows of all lines: Qᵀ_p X = Σ K*_ij (Q_i W_j + Q_j W_i), with Q of the joint before.
fn add_to<const N: usize, const E: usize>(
    transmitted: &Transmitted<'_>,
    normal: &mut Normal,
    entries: &[Place],
    before: &[f64],
) -> Option<()> {
    let block = transmitted.block;
    let mut sums = Sums::<E>::new();
    let dofs = filled::<N>(block.dofs);
    let mut strip = Strip::<N>::new(block);
    let mut points = vec![Vector::NONE; block.points];
    for first in (0..block.lines()).step_by(LANES) {
        strip.solve(first, entries, before)?;
        let mut products = Products::<E>::NONE;
        for (point, vector) in points.iter_mut().enumerate() {
            *vector = Vector::new(&strip.q[point]);
        }
        for column in 0..transmitted.columns {
            let at = strip.index.map(|line| line * transmitted.columns + column);
            let of = |values: &[Complex64]| -> [Complexes; N] {
                vector(dofs, |i| Complexes::of(|lane| values[at[lane] * dofs + i]))
            };
            let (x, w) = (of(&transmitted.x), of(&transmitted.w));
            let mut rows = InCommon::NONE;
            for (point, q) in points.iter().enumerate() {
                let weight = Reals::of(|lane| transmitted.weight[at[lane] * block.points + point]);
                let weight = strip.used * weight;
                let target = dot(&q.value[..dofs], &x[..dofs]);
                if E == ENTRIES_OF_ONE {
                    rows.add(weight, q, target.scaled(weight));
                    continue;
                }
                let row = |i, j| through(&q.value, &w, (i, j));
                products.add(entries, weight, row, target);
            }
            if E == ENTRIES_OF_ONE {
                products.add_common(&Vector::new(&w), &rows);
            }
        }
        sums.add_products(strip.omega, &products, entries.len());
    }
    sums.add_to::<N>(normal, entries, 0);
    Some(())
}

/// Entries of one column of H^C_ss by row, if all were measured.
fn whole_column(block: &Block, column: usize) -> Option<Vec<usize>> {
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

type OfRow<'r> = &'r dyn Fn(usize) -> Complex64;
type OfColumn = fn(usize, &[Complex64], OfRow<'_>, OfRow<'_>) -> Option<Vec<Complex64>>;

/// X = H_sk⁺ D of one column, each row as good as its measured receptance.
fn transmitted<const N: usize>(
    dofs: usize,
    transfer: &[Complex64],
    measured: OfRow<'_>,
    difference: OfRow<'_>,
) -> Option<Vec<Complex64>> {
    let dofs = filled::<N>(dofs);
    let mut matrix = [[ZERO; N]; N];
    let mut right = [ZERO; N];
    let mut lengths = [0.0; N];
    for (row, h) in transfer.chunks_exact(dofs).enumerate() {
        let weight = measured(row).norm_sqr().recip();
        let difference = difference(row);
        for i in 0..dofs {
            lengths[i] += weight * h[i].norm_sqr();
            right[i] += weight * h[i].conj() * difference;
            for j in 0..dofs {
                matrix[i][j] += weight * h[i].conj() * h[j];
            }
        }
    }
    let scale = lengths.map(|length: f64| length.sqrt().recip());
    for i in 0..dofs {
        for j in 0..dofs {
            matrix[i][j] *= scale[i] * scale[j];
        }
    }
    let inverse = inverse(dofs, matrix)?;
    let of_dof = |i: usize| {
        let row = (0..dofs).map(|j| inverse[i][j] * right[j] * scale[j]);
        row.sum::<Complex64>() * scale[i]
    };
    Some((0..dofs).map(of_dof).collect())
}
