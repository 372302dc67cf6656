//! Receptances of structures that joints connect, and what a change of a joint does to them.
//!
//! The joints may lack stiffness in any motion, or in all: nothing is divided by it.

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::{Selection, SpaceError};

/// The assembly at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupled {
    receptance: DMatrix<Complex64>,
    a: DMatrix<Complex64>,
    b: DMatrix<Complex64>,
}

impl Coupled {
    /// The assembly of structures with receptances Y (n × n, those of several structures on a diagonal of blocks),
    /// connected by joints of dynamic stiffness D (m × m) at the motions of a selection (m × n).
    ///
    /// `length_m` scales rotations, so that stiffnesses in N/m and N·m/rad become alike: about the size of the joint.
    /// The result depends on it by rounding alone.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Size`] for matrices that do not belong together, [`SpaceError::NotFinite`], [`SpaceError::Value`]
    /// for a length that is not positive, [`SpaceError::Resonance`] where the assembly resonates without damping.
    pub fn new(
        receptances: &DMatrix<Complex64>,
        selection: &Selection,
        dynamic: &DMatrix<Complex64>,
        length_m: f64,
    ) -> Result<Self, SpaceError> {
        Self::between(receptances, [selection, selection], dynamic, length_m)
    }

    /// The same for receptances with other rows than columns (p × q): as they are measured, where sensors and
    /// excitations are not at the same places. The first selection (m × p) takes the joints' motions of the rows, the
    /// second one (m × q) of the columns.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn between(
        receptances: &DMatrix<Complex64>,
        [motions, loads]: [&Selection; 2],
        dynamic: &DMatrix<Complex64>,
        length_m: f64,
    ) -> Result<Self, SpaceError> {
        let count = dynamic.nrows();
        for (what, found, expected) in [
            ("columns of D", dynamic.ncols(), count),
            (
                "rows of the motions' selection",
                motions.matrix().nrows(),
                count,
            ),
            (
                "rows of the loads' selection",
                loads.matrix().nrows(),
                count,
            ),
            (
                "columns of the motions' selection",
                motions.matrix().ncols(),
                receptances.nrows(),
            ),
            (
                "columns of the loads' selection",
                loads.matrix().ncols(),
                receptances.ncols(),
            ),
        ] {
            if found != expected {
                return Err(SpaceError::Size {
                    what,
                    found,
                    expected,
                });
            }
        }
        if !(length_m > 0.0 && length_m.is_finite()) {
            let (what, expected) = ("length that scales rotations, m", "a positive number");
            return Err(SpaceError::Value {
                what,
                found: length_m,
                expected,
            });
        }
        for (what, matrix) in [("the receptances", receptances), ("D", dynamic)] {
            if !matrix.iter().all(|number| number.is_finite()) {
                return Err(SpaceError::NotFinite { what });
            }
        }
        let [rows, columns] = [motions, loads].map(|selection| selection.lengths(length_m));
        let scaled = |selection: &Selection, lengths: &[f64]| {
            let matrix = selection.matrix();
            DMatrix::from_fn(count, matrix.ncols(), |i, j| {
                Complex64::from(matrix[(i, j)] * lengths[i])
            })
        };
        let (s, t) = (scaled(motions, &rows), scaled(loads, &columns));
        let d = DMatrix::from_fn(count, count, |i, j| {
            dynamic[(i, j)] / (columns[i] * rows[j])
        });
        // H = S Y Sᵀ; b = S Y_C = (I + H D)⁻¹ S Y; a = Y_C Sᵀ = Y Sᵀ (I + D H)⁻¹; Y_C = Y − Y Sᵀ D b
        let by_motions = &s * receptances;
        let by_loads = receptances * t.transpose();
        let h = &by_motions * t.transpose();
        let identity = DMatrix::<Complex64>::identity(count, count);
        let solved = |matrix: DMatrix<Complex64>, right: &DMatrix<Complex64>| {
            let solution = matrix.lu().solve(right).ok_or(SpaceError::Resonance)?;
            if solution.iter().all(|number| number.is_finite()) {
                Ok(solution)
            } else {
                Err(SpaceError::Resonance)
            }
        };
        let b = solved(&identity + &h * &d, &by_motions)?;
        let a = solved((identity + &d * &h).transpose(), &by_loads.transpose())?.transpose();
        let receptance = receptances - by_loads * (d * &b);
        let a = DMatrix::from_fn(a.nrows(), count, |i, j| a[(i, j)] / columns[j]);
        let b = DMatrix::from_fn(count, b.ncols(), |i, j| b[(i, j)] / rows[i]);
        Ok(Self { receptance, a, b })
    }

    /// Y_C, with the rows and columns of Y.
    #[must_use]
    pub fn receptance(&self) -> &DMatrix<Complex64> {
        &self.receptance
    }

    /// a = Y_C Sᵀ: motions by unit loads across the joints, a row for each motion.
    #[must_use]
    pub fn by_joint_loads(&self) -> &DMatrix<Complex64> {
        &self.a
    }

    /// b = S Y_C: relative motions in the joints by unit loads, a column for each load.
    #[must_use]
    pub fn joint_motions(&self) -> &DMatrix<Complex64> {
        &self.b
    }

    /// dY_C that a change dD (m × m) makes, to first order.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Size`] for a change that is not of the size of D.
    pub fn change(&self, dynamic: &DMatrix<Complex64>) -> Result<DMatrix<Complex64>, SpaceError> {
        for (what, found) in [
            ("rows of dD", dynamic.nrows()),
            ("columns of dD", dynamic.ncols()),
        ] {
            let expected = self.b.nrows();
            if found != expected {
                return Err(SpaceError::Size {
                    what,
                    found,
                    expected,
                });
            }
        }
        // dY_C = −(Y_C Sᵀ) dD (S Y_C)
        Ok(-(&self.a * dynamic * &self.b))
    }

    /// dY_C,oi/dk_pq of a number that stands at (p, q) and (q, p) of D, both counted through all joints; times jω it is
    /// that of a damping. None beyond the matrices.
    #[must_use]
    pub fn by_entry(&self, [output, input]: [usize; 2], [p, q]: [usize; 2]) -> Option<Complex64> {
        let a = |dof: usize| -> Option<Complex64> { self.a.get((output, dof)).copied() };
        let b = |dof: usize| -> Option<Complex64> { self.b.get((dof, input)).copied() };
        // −(a_p b_q + a_q b_p), and −a_p b_p on the diagonal
        let one = a(p)? * b(q)?;
        Some(if p == q { -one } else { -(one + a(q)? * b(p)?) })
    }

    /// dY_C,oi of a change of one joint by a matrix, such as one of
    /// [`Parametrisation::bases`](crate::Parametrisation::bases): `first` is the joint's first row in D. Times jω it is
    /// that of a damping. None beyond the matrices.
    #[must_use]
    pub fn by_matrix(
        &self,
        [output, input]: [usize; 2],
        first: usize,
        change: &Matrix6<f64>,
    ) -> Option<Complex64> {
        if output >= self.a.nrows() || input >= self.b.ncols() || first + 6 > self.b.nrows() {
            return None;
        }
        // −a dD b
        let a = self.a.fixed_view::<1, 6>(output, first);
        let b = self.b.fixed_view::<6, 1>(first, input);
        let sum: Complex64 = (0..6)
            .map(|p| (0..6).map(|q| b[q] * change[(p, q)]).sum::<Complex64>() * a[p])
            .sum();
        Some(-sum)
    }
}

#[cfg(test)]
mod tests;
