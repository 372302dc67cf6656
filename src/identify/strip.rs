//! Lines of one assembly side by side, and the normal equations summed over them lane by lane.

use num_complex::Complex64;

use super::block::{Block, Entry};
use super::kernel::Kernel;
use super::lanes::{Complexes, LANES, Number, Reals};
use super::normal::Normal;
use super::objective::MAX_ENTRIES;

/// A few lines of one assembly, computed with one joint.
pub(super) struct Strip<'b, const N: usize> {
    pub(super) block: &'b Block<N>,
    pub(super) kernel: Kernel<N, Complexes>,
    /// The line in each lane; the last one again where there are no more.
    pub(super) index: [usize; LANES],
    /// Lanes that are in use.
    pub(super) count: usize,
    /// One in lanes that are in use, else zero.
    pub(super) used: Reals,
    pub(super) omega: Reals,
}

impl<'b, const N: usize> Strip<'b, N> {
    pub(super) fn new(block: &'b Block<N>) -> Self {
        Self {
            block,
            kernel: Kernel::new(),
            index: [0; LANES],
            count: 0,
            used: Reals::ZERO,
            omega: Reals::ZERO,
        }
    }

    /// Solves the lines from `first` on; `None` where that cannot be done.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        first: usize,
        entries: &[(usize, usize)],
        unknowns: &[f64],
    ) -> Option<()> {
        let block = self.block;
        self.count = LANES.min(block.lines().checked_sub(first)?);
        let (count, last) = (self.count, self.count.checked_sub(1)?);
        let index: [usize; LANES] = std::array::from_fn(|lane| first + lane.min(last));
        self.index = index;
        self.used = Reals::of(|lane| if lane < count { 1.0 } else { 0.0 });
        self.omega = Reals::of(|lane| block.omega[index[lane]]);
        let mut stiffness = [[Complexes::ZERO; N]; N];
        for (t, &(i, j)) in entries.iter().enumerate() {
            // K* = K + jωC
            let value = Complexes {
                re: Reals::all(unknowns[t]),
                im: self.omega * Reals::all(unknowns[entries.len() + t]),
            };
            stiffness[i][j] = value;
            stiffness[j][i] = value;
        }
        let free = std::array::from_fn(|i| {
            std::array::from_fn(|j| Complexes::of(|lane| block.free[index[lane]][i][j]))
        });
        let transfer = (0..block.points).map(|point| {
            let column = index.map(|line| &block.transfer[line * block.points + point]);
            std::array::from_fn(|i| Complexes::of(|lane| column[lane][i]))
        });
        self.kernel.solve(&free, transfer, &stiffness)
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
        self.kernel.receptance(own, entry)
    }
}

/// Number of a place on or above the diagonal of a symmetric N × N matrix, row by row.
const fn place<const N: usize>(i: usize, j: usize) -> usize {
    i * N + j - i * (i + 1) / 2
}

/// Products of one strip's rows of the Jacobian, by all places of K*.
pub(super) struct Products {
    /// Σ conj(∂H/∂K*_i) ∂H/∂K*_j / σ² for j ≤ i
    rows: [[Complexes; MAX_ENTRIES]; MAX_ENTRIES],
    /// Σ conj(∂H/∂K*_i) r / σ²
    right: [Complexes; MAX_ENTRIES],
}

impl Products {
    /// The sums of no row.
    pub(super) const NONE: Self = Self {
        rows: [[Complexes::ZERO; MAX_ENTRIES]; MAX_ENTRIES],
        right: [Complexes::ZERO; MAX_ENTRIES],
    };

    /// Adds one row, given for each place of K*, with its right-hand side.
    #[inline(always)]
    pub(super) fn add<const N: usize>(
        &mut self,
        weight: Reals,
        row: impl Fn(usize, usize) -> Complexes,
        right: Complexes,
    ) {
        const { assert!(place::<N>(N - 1, N - 1) < MAX_ENTRIES) };
        let mut values = [Complexes::ZERO; MAX_ENTRIES];
        for i in 0..N {
            for j in i..N {
                values[place::<N>(i, j)] = row(i, j);
            }
        }
        for i in 0..=place::<N>(N - 1, N - 1) {
            let conjugate = values[i].conj().scaled(weight);
            self.right[i] += conjugate * right;
            for j in 0..i {
                self.rows[i][j] += conjugate * values[j];
            }
            self.rows[i][i].re += weight * values[i].norm_sqr();
        }
    }
}

/// Sums over lines, lane by lane, for all places of K*: what the normal equations are made of.
#[derive(Default)]
pub(super) struct Sums {
    cost: Reals,
    signal: Reals,
    /// Re Σ conj(∂H/∂K*_i) ∂H/∂K*_j / σ² for j ≤ i, the same times ω², and ω Im.
    stiffness: [[Reals; MAX_ENTRIES]; MAX_ENTRIES],
    damping: [[Reals; MAX_ENTRIES]; MAX_ENTRIES],
    mixed: [[Reals; MAX_ENTRIES]; MAX_ENTRIES],
    /// Re Σ conj(∂H/∂K*_i) r / σ², and ω Im.
    by_stiffness: [Reals; MAX_ENTRIES],
    by_damping: [Reals; MAX_ENTRIES],
}

impl Sums {
    /// Adds the entries of a strip, as measured and as computed; `variance` is asked for that of each, given |H^C|².
    #[inline(always)]
    pub(super) fn add_strip<const N: usize>(
        &mut self,
        strip: &Strip<'_, N>,
        mut variance: impl FnMut(usize, Reals) -> Reals,
    ) {
        let mut products = Products::NONE;
        for (e, &entry) in strip.block.entries.iter().enumerate() {
            let computed = strip.computed(e, entry);
            let measured = strip.complex(&strip.block.measured, e);
            let weight = strip.used / variance(e, computed.norm_sqr());
            let residual = computed - measured;
            self.signal += weight * measured.norm_sqr();
            self.cost += weight * residual.norm_sqr();
            // ∂H^C/∂K* = −Qᵀ E Q: both signs changed here.
            let row = |i, j| strip.kernel.through(entry, (i, j));
            products.add::<N>(weight, row, residual);
        }
        self.add_products(strip.omega, &products);
    }

    /// Adds rows by K*: ∂K*/∂k = E, ∂K*/∂c = jωE.
    #[inline(always)]
    pub(super) fn add_products(&mut self, omega: Reals, products: &Products) {
        for i in 0..MAX_ENTRIES {
            self.by_stiffness[i] += products.right[i].re;
            self.by_damping[i] += omega * products.right[i].im;
            for j in 0..=i {
                self.stiffness[i][j] += products.rows[i][j].re;
                self.damping[i][j] += omega * omega * products.rows[i][j].re;
                self.mixed[i][j] += omega * products.rows[i][j].im;
            }
        }
    }

    /// Adds the sums of those places that are `entries` to the lower triangle of the normal equations.
    pub(super) fn add_to<const N: usize>(&self, normal: &mut Normal, entries: &[(usize, usize)]) {
        let count = entries.len();
        let cost = self.cost.sum();
        normal.cost += cost;
        normal.linearised_cost += cost;
        normal.signal += self.signal.sum();
        for (t, &(i, j)) in entries.iter().enumerate() {
            let p = place::<N>(i, j);
            normal.gradient[t] += self.by_stiffness[p].sum();
            normal.gradient[count + t] += self.by_damping[p].sum();
            for (u, &(i, j)) in entries.iter().enumerate().take(t + 1) {
                let q = place::<N>(i, j);
                normal.matrix[(t, u)] += self.stiffness[p][q].sum();
                normal.matrix[(count + t, count + u)] += self.damping[p][q].sum();
                normal.matrix[(count + t, u)] += self.mixed[p][q].sum();
                if t != u {
                    normal.matrix[(count + u, t)] -= self.mixed[p][q].sum();
                }
            }
        }
    }
}
