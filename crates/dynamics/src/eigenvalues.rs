//! Eigenvalues of small real matrices: Hessenberg form, then the shifted QR iteration in complex arithmetic
//! (Golub and Van Loan, *Matrix Computations*, chapter 7).

use crate::complex::Complex;
use crate::dof::SPACE_COUNT;
use crate::elementary::hypotenuse;
use crate::spectrum::Eigenvalue;

/// Largest order that [`eigenvalues`] takes: four states for each DOF of a side.
pub(crate) const MAX_ORDER: usize = 4 * SPACE_COUNT;

/// Storage for a matrix of an order up to [`MAX_ORDER`].
pub(crate) type Square = [[f64; MAX_ORDER]; MAX_ORDER];

/// Iterations for one eigenvalue after which the matrix is given up; a handful is usual.
const MAX_ITERATIONS: u32 = 120;

/// Eigenvalues of the leading `order`×`order` block; the rest of the result is zero.
///
/// `None` if an entry is not finite, the order is too large or the iteration does not converge.
pub(crate) fn eigenvalues(matrix: &Square, order: usize) -> Option<[Eigenvalue; MAX_ORDER]> {
    if order > MAX_ORDER || matrix.iter().flatten().any(|entry| !entry.is_finite()) {
        return None;
    }
    let mut real = *matrix;
    reduce_to_hessenberg(&mut real, order);
    let mut h = real.map(|row| row.map(|re| Complex { re, im: 0.0 }));
    let norm = real.iter().flatten().fold(0.0, |sum, x| sum + x * x);
    let negligible = f64::EPSILON * f64::sqrt(norm);

    let mut found = [Eigenvalue::ZERO; MAX_ORDER];
    let mut end = order;
    let mut iterations = 0;
    while end > 0 {
        let last = end - 1;
        let mut start = last;
        while start > 0 {
            let neighbours = h[start][start].modulus() + h[start - 1][start - 1].modulus();
            let below = h[start][start - 1].modulus();
            if below <= f64::EPSILON * neighbours || below <= 1e-3 * negligible {
                break;
            }
            start -= 1;
        }
        if start == last {
            found[last] = Eigenvalue {
                real: h[last][last].re,
                imaginary: h[last][last].im,
            };
            end -= 1;
            iterations = 0;
            continue;
        }
        iterations += 1;
        if iterations > MAX_ITERATIONS {
            return None;
        }
        let shift = if iterations % 11 == 10 {
            // An exceptional shift breaks a cycle of the iteration.
            h[last][last].plus(Complex {
                re: h[last][last - 1].modulus(),
                im: 0.0,
            })
        } else {
            wilkinson_shift(&h, last)
        };
        qr_step(&mut h, start, last, shift);
    }
    Some(found)
}

/// Similarity by stabilised elimination: zeros below the first subdiagonal.
fn reduce_to_hessenberg(a: &mut Square, order: usize) {
    for column in 0..order.saturating_sub(2) {
        let target = column + 1;
        let mut pivot = target;
        for row in target + 1..order {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        if a[pivot][column] == 0.0 {
            continue;
        }
        a.swap(pivot, target);
        for row in a.iter_mut() {
            row.swap(pivot, target);
        }
        for row in target + 1..order {
            let factor = a[row][column] / a[target][column];
            for k in 0..order {
                a[row][k] -= factor * a[target][k];
            }
            for line in a.iter_mut() {
                line[target] += factor * line[row];
            }
            a[row][column] = 0.0;
        }
    }
}

/// The eigenvalue of the trailing 2×2 block that lies closer to its last entry.
fn wilkinson_shift(h: &[[Complex; MAX_ORDER]; MAX_ORDER], last: usize) -> Complex {
    let (a, b) = (h[last - 1][last - 1], h[last - 1][last]);
    let (c, d) = (h[last][last - 1], h[last][last]);
    let half_difference = a.minus(d).scaled(0.5);
    let root = half_difference
        .times(half_difference)
        .plus(b.times(c))
        .square_root();
    let plus = half_difference.plus(root);
    let minus = half_difference.minus(root);
    let nearer = if plus.modulus() < minus.modulus() {
        plus
    } else {
        minus
    };
    d.plus(nearer)
}

/// H − μI = QR, then H ← RQ + μI on the block from `start` to `last`, by Givens rotations.
fn qr_step(h: &mut [[Complex; MAX_ORDER]; MAX_ORDER], start: usize, last: usize, shift: Complex) {
    for (i, row) in h.iter_mut().enumerate().take(last + 1).skip(start) {
        row[i] = row[i].minus(shift);
    }
    let mut rotations = [(Complex::ZERO, Complex::ZERO); MAX_ORDER];
    for k in start..last {
        let (upper, lower) = (h[k][k], h[k + 1][k]);
        let length = hypotenuse(upper.modulus(), lower.modulus());
        if length == 0.0 {
            rotations[k] = (Complex { re: 1.0, im: 0.0 }, Complex::ZERO);
            continue;
        }
        let cos = upper.scaled(1.0 / length);
        let sin = lower.scaled(1.0 / length);
        rotations[k] = (cos, sin);
        for column in k..=last {
            let (x, y) = (h[k][column], h[k + 1][column]);
            h[k][column] = cos.conjugate().times(x).plus(sin.conjugate().times(y));
            h[k + 1][column] = cos.times(y).minus(sin.times(x));
        }
    }
    for k in start..last {
        let (cos, sin) = rotations[k];
        for row in h.iter_mut().take(last + 1).skip(start) {
            let (x, y) = (row[k], row[k + 1]);
            row[k] = x.times(cos).plus(y.times(sin));
            row[k + 1] = y.times(cos.conjugate()).minus(x.times(sin.conjugate()));
        }
    }
    for (i, row) in h.iter_mut().enumerate().take(last + 1).skip(start) {
        row[i] = row[i].plus(shift);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use nalgebra::DMatrix;

    fn compare(matrix: &Square, order: usize, tolerance: f64) {
        let reference = DMatrix::from_fn(order, order, |i, j| matrix[i][j]).complex_eigenvalues();
        let found = eigenvalues(matrix, order).unwrap();
        let scale = reference.iter().fold(0.0, |m: f64, z| m.max(z.norm()));
        for expected in reference.iter() {
            let nearest = found[..order]
                .iter()
                .map(|z| (z.real - expected.re).hypot(z.imaginary - expected.im))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest <= tolerance * scale,
                "{expected} is off by {nearest}"
            );
        }
    }

    #[test]
    fn random_matrices_agree_with_nalgebra() {
        let mut random = Random(1);
        let mut uniform = || random.unit() - 0.5;
        for order in [1, 2, 3, 4, 8] {
            for _ in 0..200 {
                let matrix = std::array::from_fn(|_| std::array::from_fn(|_| uniform()));
                compare(&matrix, order, 1e-11);
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_finite_is_refused() {
        let mut matrix = [[0.0; MAX_ORDER]; MAX_ORDER];
        matrix[0][0] = f64::NAN;
        assert!(eigenvalues(&matrix, 2).is_none());
    }

    #[test]
    fn a_cyclic_permutation_has_the_roots_of_unity() {
        let mut matrix = [[0.0; MAX_ORDER]; MAX_ORDER];
        for i in 0..MAX_ORDER {
            matrix[i][(i + 1) % MAX_ORDER] = 1.0;
        }
        let found = eigenvalues(&matrix, MAX_ORDER).unwrap();
        for k in 0..MAX_ORDER {
            let angle = std::f64::consts::TAU * k as f64 / MAX_ORDER as f64;
            let nearest = found
                .iter()
                .map(|z| (z.real - angle.cos()).hypot(z.imaginary - angle.sin()))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{angle}: {nearest}");
        }
    }
}
