//! A structure in coordinates with unit mass: what all kinds of structures become.

use bolted_joint_frf::Dof;
use nalgebra::{DMatrix, DVector, DVectorView, RowDVector};
use num_complex::Complex64;

/// A structure by its modes, and by what stands for those that were cut.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalForm {
    /// Its named degrees of freedom.
    pub points: Vec<Dof>,
    /// ω of each coordinate, rad/s; zero where the body moves freely.
    pub frequency_rad_per_s: DVector<f64>,
    /// Damping between the coordinates, 1/s: 2ζω on the diagonal where it is modal.
    pub damping_per_s: DMatrix<f64>,
    /// Shape of each coordinate (column) at each point (row): 1/√kg, 1/(m·√kg).
    pub shapes: DMatrix<f64>,
    /// How many coordinates are modes; those behind them stand for modes that were cut.
    pub modes: usize,
    /// How many modes were cut.
    pub cut: usize,
}

impl ModalForm {
    /// The shapes at a degree of freedom, if it is there, with its sign.
    #[must_use]
    pub fn row(&self, dof: Dof) -> Option<RowDVector<f64>> {
        let place = |wanted: Dof| self.points.iter().position(|&point| point == wanted);
        let own = |place: usize, sign: f64| self.shapes.row(place).into_owned() * sign;
        place(dof)
            .map(|place| own(place, 1.0))
            .or_else(|| place(dof.flipped()).map(|place| own(place, -1.0)))
    }

    /// Number of coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.frequency_rad_per_s.len()
    }

    /// Coordinates in which the body moves freely.
    #[must_use]
    pub fn rigid(&self) -> usize {
        let frequencies = self.frequency_rad_per_s.iter();
        frequencies.filter(|&&frequency| frequency == 0.0).count()
    }

    /// (Ω² + jω(C − c) − ω²)⁻¹ times loads on the coordinates; `None` at an undamped resonance.
    pub(crate) fn motion(
        &self,
        omega: f64,
        released_per_s: f64,
        loads: &DMatrix<Complex64>,
    ) -> Option<DMatrix<Complex64>> {
        let own = |i: usize| {
            let natural = self.frequency_rad_per_s[i];
            let damping = self.damping_per_s[(i, i)] - released_per_s;
            Complex64::new(natural * natural - omega * omega, omega * damping)
        };
        let mut motion = loads.clone();
        let coupled = self.coupled();
        if !coupled.is_empty() {
            let count = coupled.len();
            let dynamic = DMatrix::from_fn(count, count, |i, j| match i == j {
                true => own(coupled[i]),
                false => Complex64::new(0.0, omega * self.damping_per_s[(coupled[i], coupled[j])]),
            });
            let among_them = dynamic.lu().solve(&loads.select_rows(&coupled))?;
            for (&place, row) in coupled.iter().zip(among_them.row_iter()) {
                motion.row_mut(place).copy_from(&row);
            }
        }
        let mut others = coupled.into_iter().peekable();
        for (i, mut row) in motion.row_iter_mut().enumerate() {
            if others.next_if_eq(&i).is_some() {
                continue;
            }
            let own = own(i);
            if own == Complex64::ZERO {
                return None;
            }
            row /= own;
        }
        Some(motion)
    }

    /// The coordinates that are damped by others, ascending; none where damping is modal.
    fn coupled(&self) -> Vec<usize> {
        let count = |own: &f64| usize::from(*own != 0.0);
        let all: usize = self.damping_per_s.as_slice().iter().map(count).sum();
        let own: usize = self.damping_per_s.diagonal().iter().map(count).sum();
        if all == own {
            return Vec::new();
        }
        let columns = self.damping_per_s.column_iter().enumerate();
        let is_coupled = |(j, column): (usize, DVectorView<'_, f64>)| {
            let mut others = column.iter().enumerate();
            others.any(|(i, &own)| i != j && own != 0.0).then_some(j)
        };
        columns.filter_map(is_coupled).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_that_damp_each_other_are_solved_together() {
        const SIZE: usize = 5;
        let damping = DMatrix::from_fn(SIZE, SIZE, |i, j| match (i, j) {
            _ if i == j => 3.0 + i as f64,
            (1, 3) | (3, 1) => -2.0,
            (3, 4) | (4, 3) => 1.5,
            _ => 0.0,
        });
        let form = ModalForm {
            points: Vec::new(),
            frequency_rad_per_s: DVector::from_fn(SIZE, |i, _| 10.0 * i as f64),
            damping_per_s: damping.clone(),
            shapes: DMatrix::zeros(0, SIZE),
            modes: SIZE,
            cut: 0,
        };
        assert_eq!(form.coupled(), [1, 3, 4]);
        let loads = DMatrix::from_fn(SIZE, 2, |i, j| Complex64::new(1.0 + i as f64, j as f64));
        let (omega, released) = (17.0, 0.5);
        let found = form.motion(omega, released, &loads).unwrap();
        // all of it at once
        let dynamic = DMatrix::from_fn(SIZE, SIZE, |i, j| {
            let own = if i == j { 1.0 } else { 0.0 };
            let square = form.frequency_rad_per_s[i].powi(2) - omega * omega;
            Complex64::new(own * square, omega * (damping[(i, j)] - own * released))
        });
        assert!((dynamic * found - loads).norm() < 1e-12);
    }
}
