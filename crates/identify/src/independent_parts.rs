//! How much of each column of a matrix no other column could do as well.

use num_complex::Complex64;

/// Sine of the angle between columns, below which they count as dependent.
const DEPENDENT: f64 = 1e-6;

/// 1/√[(JᴴJ)⁻¹]_ii of small matrices J, one after the other: the length of what column i has at right angles to all others.
pub(super) struct IndependentParts {
    /// Lengths of the columns, then of their parts.
    lengths: Vec<f64>,
    /// The lower triangle of L with L Lᴴ = JᴴJ, the columns of J being of unit length; row by row.
    factor: Vec<Complex64>,
    /// L⁻¹, row by row.
    inverse: Vec<Complex64>,
}

impl IndependentParts {
    /// Made ready for matrices with so many columns.
    pub(super) fn new(columns: usize) -> Self {
        Self {
            lengths: vec![0.0; columns],
            factor: vec![Complex64::ZERO; columns * columns],
            inverse: vec![Complex64::ZERO; columns * columns],
        }
    }

    /// The lengths, of a matrix given row by row; `None` where its columns depend on each other.
    pub(super) fn lengths(&mut self, matrix: &[Complex64]) -> Option<&[f64]> {
        let size = self.lengths.len();
        let Self {
            lengths,
            factor,
            inverse,
        } = self;
        // JᴴJ
        factor.fill(Complex64::ZERO);
        for row in matrix.chunks_exact(size) {
            for i in 0..size {
                let conjugate = row[i].conj();
                for j in 0..=i {
                    factor[i * size + j] += conjugate * row[j];
                }
            }
        }
        for (i, length) in lengths.iter_mut().enumerate() {
            *length = factor[i * size + i].re.sqrt();
            if !(length.is_finite() && *length > 0.0) {
                return None;
            }
        }
        for i in 0..size {
            for j in 0..=i {
                factor[i * size + j] /= lengths[i] * lengths[j];
            }
        }
        // Cholesky: L_ij = (G_ij − Σ_k L_ik L̄_jk)/L_jj
        for i in 0..size {
            for j in 0..=i {
                let mut left = factor[i * size + j];
                for k in 0..j {
                    left -= factor[i * size + k] * factor[j * size + k].conj();
                }
                factor[i * size + j] = if i == j {
                    let pivot = left.re.sqrt();
                    if pivot.is_nan() || pivot < DEPENDENT {
                        return None;
                    }
                    pivot.into()
                } else {
                    left / factor[j * size + j].re
                };
            }
        }
        // L⁻¹ by columns; (JᴴJ)⁻¹_ii = Σ_k |L⁻¹_ki|²
        for i in 0..size {
            let mut squares = 0.0;
            for k in i..size {
                let mut value = if k == i {
                    Complex64::ONE
                } else {
                    Complex64::ZERO
                };
                for m in i..k {
                    value -= factor[k * size + m] * inverse[m * size + i];
                }
                value /= factor[k * size + k].re;
                inverse[k * size + i] = value;
                squares += value.norm_sqr();
            }
            lengths[i] /= squares.sqrt();
        }
        Some(lengths)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_other_columns_could_do_as_well_does_not_count() {
        let c = |re| Complex64::new(re, 0.0);
        // Columns of length 2 and 1 at an angle of 60°: what is at right angles to the other is sin 60° of each.
        let matrix = [c(2.0), c(0.5), c(0.0), c(0.75_f64.sqrt())];
        let mut parts = IndependentParts::new(2);
        let found = parts.lengths(&matrix).unwrap();
        let sine = 0.75_f64.sqrt();
        assert!((found[0] - 2.0 * sine).abs() < 1e-12 && (found[1] - sine).abs() < 1e-12);
        assert_eq!(parts.lengths(&[c(2.0), c(1.0), c(4.0), c(2.0)]), None);
        assert_eq!(parts.lengths(&[c(2.0), c(1.0)]), None);
    }

    #[test]
    fn it_is_the_inverse_of_the_normal_matrix() {
        let c = Complex64::new;
        let rows = [
            [c(1.0, 2.0), c(-3.0, 0.5), c(0.1, 0.2)],
            [c(0.25, -1.0), c(2.0, 0.0), c(-0.5, 0.4)],
            [c(-1.5, 0.3), c(0.2, 1.0), c(0.7, -0.6)],
            [c(0.6, 0.6), c(-0.1, 2.0), c(0.3, 0.9)],
        ];
        let matrix = nalgebra::DMatrix::from_fn(4, 3, |i, j| rows[i][j]);
        let inverse = (matrix.adjoint() * matrix).try_inverse().unwrap();
        let mut parts = IndependentParts::new(3);
        let found = parts.lengths(rows.as_flattened()).unwrap();
        for i in 0..3 {
            let expected = inverse[(i, i)].re.sqrt().recip();
            assert!((found[i] / expected - 1.0).abs() < 1e-14);
        }
    }
}
