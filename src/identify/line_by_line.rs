//! K* of each line of an assembly by (3.21), as `decoupling` computes it, in matrices of fixed size: there are many lines.

use num_complex::Complex64;

use crate::structure::{ComplexMatrix, Partition};

use super::block::Small;
use super::decoupling;
use super::kernel::inverse;
use super::lines::Lines;

/// A column of unit length of which less than this is left beside those before it depends on them.
const DEPENDENT: f64 = 1e-10;

/// Whether every pair of points was measured, at least as its transpose.
pub(super) fn is_complete(lines: &Lines) -> bool {
    let count = lines.points.len();
    let has = |place: (usize, usize)| {
        lines.measured.contains(&place) || lines.measured.contains(&(place.1, place.0))
    };
    (0..count).all(|p| (0..count).all(|q| has((p, q))))
}

/// K* of each line by (3.21); `None` where it cannot be had.
pub(super) fn decouple<const N: usize>(lines: &Lines) -> Vec<Option<ComplexMatrix>> {
    let count = lines.frequency_hz.len();
    if !is_complete(lines) {
        return vec![None; count];
    }
    let mut least_squares = LeastSquares::<N>::default();
    (0..count)
        .map(|line| {
            let (a_joint, b) = (&lines.a_joint[line], &lines.b[line]);
            let assembly = &lines.assembly[line];
            let is_fixed = a_joint.nrows() == N && lines.points.len() > N;
            let found = is_fixed.then(|| least_squares.from_ss(a_joint, b, assembly));
            match found.flatten() {
                Some(found) => Some(ComplexMatrix::from_fn(N, N, |i, j| found[i][j])),
                // Equation (3.21) needs nothing of A but H_jj.
                None => {
                    let a = Partition::of(a_joint, a_joint.nrows());
                    decoupling::from_ss(&a, b, assembly)
                }
            }
        })
        .collect()
}

/// The least-squares solution of (3.21) from more points than joint DOFs.
#[derive(Default)]
struct LeastSquares<const N: usize> {
    left: PseudoInverse<N>,
    right: PseudoInverse<N>,
}

impl<const N: usize> LeastSquares<N> {
    /// `None` where columns depend on each other, or a matrix is singular.
    fn from_ss(
        &mut self,
        a_joint: &ComplexMatrix,
        b: &Partition,
        assembly: &ComplexMatrix,
    ) -> Option<Small<N>> {
        let points = b.points.nrows();
        self.left
            .of(points, |point, i| b.points_joint[(point, i)])?;
        self.right
            .of(points, |point, i| b.joint_points[(i, point)])?;
        // Z⁻¹ = H_sk⁺ (H_ss − H^C_ss) H_ks⁺
        let mut z_inverse = [[Complex64::ZERO; N]; N];
        for (q, right) in self.right.columns.iter().enumerate() {
            let mut product = [Complex64::ZERO; N];
            for (p, left) in self.left.columns.iter().enumerate() {
                let difference = b.points[(p, q)] - assembly[(p, q)];
                for i in 0..N {
                    product[i] += left[i] * difference;
                }
            }
            for i in 0..N {
                for j in 0..N {
                    z_inverse[i][j] += product[i] * right[j];
                }
            }
        }
        // K* = (Z − H_jj − H_kk)⁻¹
        let mut z = inverse(z_inverse)?;
        for i in 0..N {
            for j in 0..N {
                z[i][j] -= a_joint[(i, j)] + b.joint[(i, j)];
            }
        }
        let stiffness = inverse(z)?;
        let mut values = stiffness.iter().flatten();
        values
            .all(|value| value.re.is_finite() && value.im.is_finite())
            .then_some(stiffness)
    }
}

/// M⁺ of a matrix with N columns, as many rows as there are points.
#[derive(Default)]
struct PseudoInverse<const N: usize> {
    /// M by rows, then its orthonormal basis.
    rows: Vec<[Complex64; N]>,
    /// M⁺, a column for each point.
    columns: Vec<[Complex64; N]>,
}

impl<const N: usize> PseudoInverse<N> {
    /// M = Q R by Gram and Schmidt, twice over, from columns of unit length; M⁺ = R⁻¹ Qᴴ.
    fn of(&mut self, points: usize, entry: impl Fn(usize, usize) -> Complex64) -> Option<()> {
        self.rows.clear();
        let row = |point| std::array::from_fn(|i| entry(point, i));
        self.rows.extend((0..points).map(row));
        let mut lengths = [0.0; N];
        for (i, length) in lengths.iter_mut().enumerate() {
            *length = self.length(i);
            self.scale(i, length.recip());
        }
        // Q = M A: A takes the part of every operation that R⁻¹ is made of.
        let mut factor = [[0.0.into(); N]; N];
        for (i, factor) in factor.iter_mut().enumerate() {
            factor[i] = Complex64::from(lengths[i].recip());
        }
        for i in 0..N {
            for _ in 0..2 {
                for before in 0..i {
                    let pairs = self.rows.iter().map(|row| row[before].conj() * row[i]);
                    let part: Complex64 = pairs.sum();
                    for row in &mut self.rows {
                        let other = row[before];
                        row[i] -= other * part;
                    }
                    for row in &mut factor {
                        let other = row[before];
                        row[i] -= other * part;
                    }
                }
            }
            let left = self.length(i);
            if !(left > DEPENDENT && left.is_finite()) {
                return None;
            }
            self.scale(i, left.recip());
            for row in &mut factor {
                row[i] *= left.recip();
            }
        }
        // M⁺ = A Qᴴ
        self.columns.clear();
        self.columns.extend(self.rows.iter().map(|row| {
            std::array::from_fn(|i| {
                let products = (0..N).map(|k| factor[i][k] * row[k].conj());
                products.sum()
            })
        }));
        Some(())
    }

    fn length(&self, column: usize) -> f64 {
        let squares: f64 = self.rows.iter().map(|row| row[column].norm_sqr()).sum();
        squares.sqrt()
    }

    fn scale(&mut self, column: usize, factor: f64) {
        for row in &mut self.rows {
            row[column] *= factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pseudo_inverse_obeys_its_definition_for_columns_of_any_size() {
        let c = Complex64::new;
        let matrix = [
            [c(1.0, 2.0), c(1e-6, 3e-6)],
            [c(-1.0, 0.5), c(2e-6, 0.0)],
            [c(0.25, -2.0), c(-1e-6, 5e-6)],
        ];
        let mut inverse = PseudoInverse::<2>::default();
        inverse.of(3, |point, i| matrix[point][i]).unwrap();
        for i in 0..2 {
            for j in 0..2 {
                let products = (0..3).map(|p| inverse.columns[p][i] * matrix[p][j]);
                let product: Complex64 = products.sum();
                let scale = [1.0, 1e-6][j] / [1.0, 1e-6][i];
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((product - unit).norm() < 1e-14 * scale, "{i} {j} {product}");
            }
        }
    }

    #[test]
    fn columns_that_depend_on_each_other_are_refused() {
        let mut inverse = PseudoInverse::<2>::default();
        let of = inverse.of(3, |point, i| {
            Complex64::from((point * 7 + 1) as f64 * [1.0, 3.0][i])
        });
        assert_eq!(of, None);
    }
}
