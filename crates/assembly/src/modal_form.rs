//! A structure in coordinates with unit mass: what all kinds of structures become.

use bolted_joint_frf::Dof;
use nalgebra::{DMatrix, DVector, RowDVector};
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
        if self.is_modal() {
            let mut motion = loads.clone();
            for (i, mut row) in motion.row_iter_mut().enumerate() {
                let own = own(i);
                if own == Complex64::ZERO {
                    return None;
                }
                row /= own;
            }
            return Some(motion);
        }
        let dynamic = DMatrix::from_fn(self.size(), self.size(), |i, j| match i == j {
            true => own(i),
            false => Complex64::new(0.0, omega * self.damping_per_s[(i, j)]),
        });
        dynamic.lu().solve(loads)
    }

    /// Whether no mode is damped by another.
    fn is_modal(&self) -> bool {
        let size = self.size();
        (0..size).all(|i| (0..i).all(|j| self.damping_per_s[(i, j)] == 0.0))
    }
}
