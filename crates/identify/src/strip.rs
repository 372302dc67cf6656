//! Lines of one assembly side by side, and the normal equations summed over them lane by lane.

use num_complex::Complex64;

use super::block::{Block, Entry};
use super::factored::Factored;
use super::kernel::{Small, coupled, dot, filled, matrix, through, times, vector};
use super::lanes::{Complexes, LANES, Number, Reals};
use super::layout::Place;
use super::normal::Normal;

/// The instance of a generic function with room for so many joint DOFs and for these unknown entries; `None` where there is no
/// such joint.
macro_rules! for_strips {
    ($dofs:expr, $entries:expr, $function:ident) => {
        match $dofs {
            1 => Some($function::<1, ENTRIES_OF_ONE> as _),
            2 if are_of_one::<2>($entries) => Some($function::<2, ENTRIES_OF_ONE> as _),
            2 => Some($function::<2, ENTRIES_OF_FOUR> as _),
            3..=4 => Some($function::<4, ENTRIES_OF_FOUR> as _),
            5..=8 => Some($function::<8, ENTRIES_OF_FOUR> as _),
            9..=16 => Some($function::<16, MOST_ENTRIES> as _),
            _ => None,
        }
    };
}
pub(super) use for_strips;

/// Most unknown entries of K*: those of eight bolts with a joint of their own …
pub(super) const MOST_ENTRIES: usize = 24;
/// … those of four, most joints being of no more …
pub(super) const ENTRIES_OF_FOUR: usize = 12;
/// … and those of one joint.
pub(super) const ENTRIES_OF_ONE: usize = 3;

/// A few lines of one assembly, computed with one joint.
pub(super) struct Strip<'b, const N: usize> {
    pub(super) block: &'b Block,
    transfer: Vec<[Complexes; N]>,
    /// Q = (I + F K*)⁻¹ H_ks, a column for each point.
    pub(super) q: Vec<[Complexes; N]>,
    /// X = K* Q
    x: Vec<[Complexes; N]>,
    /// The line in each lane; the last one again where there are no more.
    pub(super) index: [usize; LANES],
    /// Lanes that are in use.
    pub(super) count: usize,
    /// One in lanes that are in use, else zero.
    pub(super) used: Reals,
    pub(super) omega: Reals,
}

/// The joint of a few lines between the substructures.
pub(super) struct Coupled<const N: usize> {
    /// (I + F K*)⁻¹
    pub(super) inverse: Small<N, Complexes>,
    /// K*
    pub(super) stiffness: Small<N, Complexes>,
}

/// K* = K + jωC of lines side by side, from the unknowns of one joint.
#[inline(always)]
pub(super) fn complex_stiffness<const N: usize>(
    entries: &[Place],
    unknowns: &[f64],
    omega: Reals,
) -> Small<N, Complexes> {
    let mut stiffness = [[Complexes::ZERO; N]; N];
    for (t, place) in entries.iter().enumerate() {
        let value = Complexes {
            re: Reals::all(unknowns[t]),
            im: omega * Reals::all(unknowns[entries.len() + t]),
        };
        for (i, j) in place.all() {
            stiffness[i][j] = value;
            stiffness[j][i] = value;
        }
    }
    stiffness
}

impl<'b, const N: usize> Strip<'b, N> {
    pub(super) fn new(block: &'b Block) -> Self {
        let columns = || vec![[Complexes::ZERO; N]; block.points];
        Self {
            block,
            transfer: columns(),
            q: columns(),
            x: columns(),
            index: [0; LANES],
            count: 0,
            used: Reals::ZERO,
            omega: Reals::ZERO,
        }
    }

    /// Takes the lines from `first` on with their joint; `None` where the assembly cannot be computed at one of them.
    #[inline(always)]
    pub(super) fn couple(
        &mut self,
        first: usize,
        entries: &[Place],
        unknowns: &[f64],
    ) -> Option<Coupled<N>> {
        self.begin(first)?;
        let stiffness = self.complex_stiffness(entries, unknowns);
        let inverse = coupled(filled::<N>(self.block.dofs), &self.free(), &stiffness)?;
        Some(Coupled { inverse, stiffness })
    }

    /// Takes the lines from `first` on; `None` if there are none.
    #[inline(always)]
    fn begin(&mut self, first: usize) -> Option<()> {
        let block = self.block;
        self.count = LANES.min(block.lines().checked_sub(first)?);
        let (count, last) = (self.count, self.count.checked_sub(1)?);
        let index: [usize; LANES] = std::array::from_fn(|lane| first + lane.min(last));
        self.index = index;
        self.used = Reals::of(|lane| if lane < count { 1.0 } else { 0.0 });
        self.omega = Reals::of(|lane| block.omega[index[lane]]);
        Some(())
    }

    /// F
    #[inline(always)]
    pub(super) fn free(&self) -> Small<N, Complexes> {
        let dofs = filled::<N>(self.block.dofs);
        let free = self.index.map(|line| self.block.free_at(line));
        matrix(dofs, |i, j| Complexes::of(|lane| free[lane][i * dofs + j]))
    }

    /// Solves the lines from `first` on; `None` where that cannot be done.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        first: usize,
        entries: &[Place],
        unknowns: &[f64],
    ) -> Option<Factored<N, Complexes>> {
        self.begin(first)?;
        let stiffness = self.complex_stiffness(entries, unknowns);
        let (block, index) = (self.block, self.index);
        let dofs = filled::<N>(block.dofs);
        let factored = Factored::of(dofs, &self.free(), &stiffness)?;
        let transfer = index.map(|line| block.transfer_at(line));
        let own = self.transfer.iter_mut().zip(&mut self.q).zip(&mut self.x);
        for (point, ((own, q), x)) in own.enumerate() {
            *own = vector(dofs, |i| {
                Complexes::of(|lane| transfer[lane][point * dofs + i])
            });
            *q = factored.solve(dofs, own);
            *x = times(dofs, &stiffness, q);
        }
        Some(factored)
    }

    /// K* = K + jωC of its lines, from the unknowns of one joint.
    #[inline(always)]
    pub(super) fn complex_stiffness(
        &self,
        entries: &[Place],
        unknowns: &[f64],
    ) -> Small<N, Complexes> {
        complex_stiffness(entries, unknowns, self.omega)
    }

    /// A number of each line that is stored line by line and entry by entry.
    #[inline(always)]
    pub(super) fn complex(&self, values: &[Complex64], e: usize) -> Complexes {
        let count = self.block.entries.len();
        Complexes::of(|lane| values[self.index[lane] * count + e])
    }

    #[inline(always)]
    pub(super) fn real(&self, values: &[f64], e: usize) -> Reals {
        let count = self.block.entries.len();
        Reals::of(|lane| values[self.index[lane] * count + e])
    }

    #[inline(always)]
    pub(super) fn computed(&self, e: usize, entry: Entry) -> Complexes {
        let own = self.complex(&self.block.own, e);
        let dofs = filled::<N>(self.block.dofs);
        let (transfer, x) = (&self.transfer[entry.row], &self.x[entry.column]);
        own - dot(&transfer[..dofs], &x[..dofs])
    }
}

/// Number of a place on or above the diagonal of a symmetric N × N matrix, row by row.
const fn place<const N: usize>(i: usize, j: usize) -> usize {
    i * N + j - i * (i + 1) / 2
}

/// Whether the unknown entries are those of one joint, so that a row of the Jacobian may hold all places of K*, in loops of
/// fixed length; else it holds the unknown entries.
pub(super) fn are_of_one<const N: usize>(entries: &[Place]) -> bool {
    N <= 2 && entries.iter().all(|place| place.is_single())
}

/// A vector v of one joint's DOFs, of which there are one or two, with the products of its entries.
#[derive(Clone, Copy)]
pub(super) struct Vector<const N: usize> {
    pub(super) value: [Complexes; N],
    /// |v_i|²
    power: [Reals; N],
    /// conj(v_0) v_1
    cross: Complexes,
}

impl<const N: usize> Vector<N> {
    /// No vector yet.
    pub(super) const NONE: Self = Self {
        value: [Complexes::ZERO; N],
        power: [Reals::ZERO; N],
        cross: Complexes::ZERO,
    };

    #[inline(always)]
    pub(super) fn new(value: &[Complexes; N]) -> Self {
        Self {
            value: *value,
            power: std::array::from_fn(|i| value[i].norm_sqr()),
            cross: if N == 2 {
                value[0].conj_times(value[1])
            } else {
                Complexes::ZERO
            },
        }
    }
}

/// Sums over the rows of the Jacobian that have one of their two vectors in common.
///
/// The row of a receptance by the places (i, j) of K* is u_i v_j + u_j v_i, or u_i v_i on the diagonal, u and v being Q of its
/// two points. The sums over v are formed first.
#[derive(Clone, Copy)]
pub(super) struct InCommon<const N: usize> {
    /// Σ w |v_i|²
    power: [Reals; N],
    /// Σ w conj(v_0) v_1
    cross: Complexes,
    /// Σ w conj(v) r
    right: [Complexes; N],
}

impl<const N: usize> InCommon<N> {
    /// The sums of no row.
    pub(super) const NONE: Self = Self {
        power: [Reals::ZERO; N],
        cross: Complexes::ZERO,
        right: [Complexes::ZERO; N],
    };

    /// Adds the row of `v` with its right-hand side times its weight.
    #[inline(always)]
    pub(super) fn add(&mut self, weight: Reals, v: &Vector<N>, weighted: Complexes) {
        for i in 0..N {
            self.power[i] += weight * v.power[i];
            self.right[i] += v.value[i].conj_times(weighted);
        }
        if N == 2 {
            self.cross += v.cross.scaled(weight);
        }
    }
}

/// Products of one strip's rows of the Jacobian: by the places (0, 0), (0, 1) and (1, 1) of one joint's K*, or by the unknown
/// entries of several bolts, up to E.
pub(super) struct Products<const E: usize> {
    /// Σ conj(∂H/∂K*_i) ∂H/∂K*_j / σ² for j ≤ i
    rows: [[Complexes; E]; E],
    /// Σ conj(∂H/∂K*_i) r / σ²
    right: [Complexes; E],
}

impl<const E: usize> Products<E> {
    /// The sums of no row.
    pub(super) const NONE: Self = Self {
        rows: [[Complexes::ZERO; E]; E],
        right: [Complexes::ZERO; E],
    };

    /// Adds one row, given for each place of K*, with its right-hand side.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        entries: &[Place],
        weight: Reals,
        row: impl Fn(usize, usize) -> Complexes,
        right: Complexes,
    ) {
        let mut values = [Complexes::ZERO; E];
        for (value, place) in values.iter_mut().zip(entries) {
            for (i, j) in place.all() {
                *value += row(i, j);
            }
        }
        for i in 0..entries.len().min(E) {
            let conjugate = values[i].conj().scaled(weight);
            self.right[i] += conjugate * right;
            for j in 0..i {
                self.rows[i][j] += conjugate * values[j];
            }
            self.rows[i][i].re += weight * values[i].norm_sqr();
        }
    }

    /// Adds all rows of one joint that have `u` in common.
    #[inline(always)]
    pub(super) fn add_common<const N: usize>(&mut self, u: &Vector<N>, v: &InCommon<N>) {
        const { assert!(E >= ENTRIES_OF_ONE) };
        self.right[0] += u.value[0].conj_times(v.right[0]);
        self.rows[0][0].re += u.power[0] * v.power[0];
        if N == 1 {
            return;
        }
        self.right[1] += u.value[0].conj_times(v.right[1]) + u.value[1].conj_times(v.right[0]);
        self.right[2] += u.value[1].conj_times(v.right[1]);
        let (u_cross, v_cross) = (u.cross.conj(), v.cross.conj());
        self.rows[1][0] += v_cross.scaled(u.power[0]) + u_cross.scaled(v.power[0]);
        let twice = u_cross.re * v_cross.re + u_cross.im * v_cross.im;
        self.rows[1][1].re += u.power[0] * v.power[1] + u.power[1] * v.power[0] + twice + twice;
        self.rows[2][0] += u_cross * v_cross;
        self.rows[2][1] += v_cross.scaled(u.power[1]) + u_cross.scaled(v.power[1]);
        self.rows[2][2].re += u.power[1] * v.power[1];
    }
}

/// Sums over lines, lane by lane: what the normal equations are made of.
pub(super) struct Sums<const E: usize> {
    cost: Reals,
    signal: Reals,
    /// Re Σ conj(∂H/∂K*_i) ∂H/∂K*_j / σ² for j ≤ i, the same times ω², and ω Im.
    stiffness: [[Reals; E]; E],
    damping: [[Reals; E]; E],
    mixed: [[Reals; E]; E],
    /// Re Σ conj(∂H/∂K*_i) r / σ², and ω Im.
    by_stiffness: [Reals; E],
    by_damping: [Reals; E],
}

impl<const E: usize> Sums<E> {
    pub(super) fn new() -> Self {
        Self {
            cost: Reals::ZERO,
            signal: Reals::ZERO,
            stiffness: [[Reals::ZERO; E]; E],
            damping: [[Reals::ZERO; E]; E],
            mixed: [[Reals::ZERO; E]; E],
            by_stiffness: [Reals::ZERO; E],
            by_damping: [Reals::ZERO; E],
        }
    }

    /// Adds the entries of a strip, as measured and as computed; `weight` is asked for 1/σ² of each, given |H^C|². Of each
    /// point `rows` are overwritten.
    #[inline(always)]
    pub(super) fn add_strip<const N: usize>(
        &mut self,
        strip: &Strip<'_, N>,
        entries: &[Place],
        rows: &mut [(Vector<N>, InCommon<N>)],
        mut weight: impl FnMut(usize, Reals) -> Reals,
    ) {
        let mut products = Products::<E>::NONE;
        if E == ENTRIES_OF_ONE {
            for (point, (vector, row)) in rows.iter_mut().enumerate() {
                *vector = Vector::new(&strip.q[point]);
                *row = InCommon::NONE;
            }
        }
        for (e, &entry) in strip.block.entries.iter().enumerate() {
            let computed = strip.computed(e, entry);
            let measured = strip.complex(&strip.block.measured, e);
            let weight = strip.used * weight(e, computed.norm_sqr());
            // ∂H^C/∂K* = −Qᵀ E Q: both signs changed here.
            let residual = computed - measured;
            self.signal += weight * measured.norm_sqr();
            self.cost += weight * residual.norm_sqr();
            if E == ENTRIES_OF_ONE {
                let (v, weighted) = (rows[entry.column].0, residual.scaled(weight));
                rows[entry.row].1.add(weight, &v, weighted);
            } else {
                let (p, q) = (&strip.q[entry.row], &strip.q[entry.column]);
                let row = |i, j| through(p, q, (i, j));
                products.add(entries, weight, row, residual);
            }
        }
        if E == ENTRIES_OF_ONE {
            for (u, sums) in rows.iter() {
                products.add_common(u, sums);
            }
        }
        self.add_products(strip.omega, &products, entries.len());
    }

    /// Adds rows by K*: ∂K*/∂k = E, ∂K*/∂c = jωE.
    #[inline(always)]
    pub(super) fn add_products(&mut self, omega: Reals, products: &Products<E>, entries: usize) {
        let rows = if E == ENTRIES_OF_ONE {
            E
        } else {
            entries.min(E)
        };
        for i in 0..rows {
            self.by_stiffness[i] += products.right[i].re;
            self.by_damping[i] += omega * products.right[i].im;
            for j in 0..=i {
                self.stiffness[i][j] += products.rows[i][j].re;
                self.damping[i][j] += omega * omega * products.rows[i][j].re;
                self.mixed[i][j] += omega * products.rows[i][j].im;
            }
        }
    }

    /// Adds the sums of the unknown `entries` to the lower triangle of the normal equations, in which the unknowns of this
    /// joint begin at `first`.
    pub(super) fn add_to<const N: usize>(
        &self,
        normal: &mut Normal,
        entries: &[Place],
        first: usize,
    ) {
        let (k, c) = (first, first + entries.len());
        let cost = self.cost.sum();
        normal.cost += cost;
        normal.signal += self.signal.sum();
        let row = |t: usize| match entries[t].first() {
            (i, j) if E == ENTRIES_OF_ONE => place::<N>(i, j),
            _ => t,
        };
        for t in 0..entries.len() {
            let p = row(t);
            normal.gradient[k + t] += self.by_stiffness[p].sum();
            normal.gradient[c + t] += self.by_damping[p].sum();
            for u in 0..=t {
                let q = row(u);
                normal.matrix[(k + t, k + u)] += self.stiffness[p][q].sum();
                normal.matrix[(c + t, c + u)] += self.damping[p][q].sum();
                normal.matrix[(c + t, k + u)] += self.mixed[p][q].sum();
                if t != u {
                    normal.matrix[(c + u, k + t)] -= self.mixed[p][q].sum();
                }
            }
        }
    }
}
