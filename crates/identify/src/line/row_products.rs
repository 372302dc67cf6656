//! Products of the whitened rows of one line: what the line adds to the normal equations.

use num_complex::Complex64;

use super::super::normal::Normal;
use super::super::strip::{ENTRIES_OF_ONE, MOST_ENTRIES};

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// Sums over the entries of one whitened line, for E unknown entries of K* at most.
pub(super) struct RowProducts<const E: usize> {
    /// Σ conj(∂H/∂K*_i) ∂H/∂K*_j for j ≤ i
    products: [[Complex64; E]; E],
    /// Σ conj(∂H/∂K*_i) r
    right: [Complex64; E],
}

impl<const E: usize> RowProducts<E> {
    pub(super) fn new() -> Self {
        Self {
            products: [[ZERO; E]; E],
            right: [ZERO; E],
        }
    }

    #[inline]
    pub(super) fn add(&mut self, residual: Complex64, row: &[Complex64; E], count: usize) {
        // Rows beyond `count` are zero, so that the loops of one joint can be unrolled.
        debug_assert!(count <= E);
        let count = if E > ENTRIES_OF_ONE { count } else { E };
        for i in 0..count {
            let conjugate = row[i].conj();
            self.right[i] += conjugate * residual;
            for j in 0..=i {
                self.products[i][j] += conjugate * row[j];
            }
        }
    }

    /// ∂K*/∂k = E, ∂K*/∂c = jωE, of the joint whose unknowns begin at `first`.
    pub(super) fn add_to(&self, normal: &mut Normal, omega: f64, count: usize, first: usize) {
        let (k, c) = (first, first + count);
        for i in 0..count {
            normal.gradient[k + i] += self.right[i].re;
            normal.gradient[c + i] += omega * self.right[i].im;
            for j in 0..=i {
                let product = self.products[i][j];
                normal.matrix[(k + i, k + j)] += product.re;
                normal.matrix[(c + i, c + j)] += omega * omega * product.re;
                normal.matrix[(c + i, k + j)] += omega * product.im;
                if i != j {
                    normal.matrix[(c + j, k + i)] -= omega * product.im;
                }
            }
        }
    }
}

/// What one line adds to the normal equations between the unknowns of two joints, which begin at `first` and at `other`
/// before it.
pub(super) fn add_coupling<'r>(
    normal: &mut Normal,
    omega: f64,
    count: usize,
    (first, other): (usize, usize),
    rows: impl Iterator<Item = (&'r [Complex64; MOST_ENTRIES], &'r [Complex64; MOST_ENTRIES])>,
) {
    let mut products = [[ZERO; MOST_ENTRIES]; MOST_ENTRIES];
    for (row, other) in rows {
        for i in 0..count {
            for j in 0..count {
                products[i][j] += row[i].conj() * other[j];
            }
        }
    }
    for (i, products) in products.iter().enumerate().take(count) {
        for (j, product) in products.iter().enumerate().take(count) {
            // Re((∂r/∂p)* ∂r/∂q) with ∂r/∂k = ∂r/∂K* and ∂r/∂c = jω ∂r/∂K*
            let (k, c) = (first + i, first + count + i);
            let (other_k, other_c) = (other + j, other + count + j);
            normal.matrix[(k, other_k)] += product.re;
            normal.matrix[(k, other_c)] -= omega * product.im;
            normal.matrix[(c, other_k)] += omega * product.im;
            normal.matrix[(c, other_c)] += omega * omega * product.re;
        }
    }
}
