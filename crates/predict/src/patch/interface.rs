//! The 6×6 matrices of the interface between two nodes at its reference point.

use std::f64::consts::TAU;

use crate::pressure::Element;

use super::axis::Axis;
use super::contact::{Contact, ContactMoments, PatchMoments};
use super::damping::NormalDamping;
use crate::number::{NumberError, positive};

/// Off the diagonal, what is at most this part of the diagonal is rounding.
const ROUNDING: f64 = 1e-13;

/// Names of the rows and columns of a [`Matrix6`].
pub const DOFS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// A matrix over x, y, z, rx, ry, rz.
pub type Matrix6 = [[f64; 6]; 6];

/// Stiffness and damping of the interface for the relative motion of its two sides at a reference point: translations along x,
/// y, z and small rotations about them, in this order, right-handed.
///
/// Each element resists with diag(k_t, k_t, k_n) ΔA the relative displacement d = u + θ × r at its lever arm r; the sum
/// K = Σ Bᵀ diag(k_t, k_t, k_n) B ΔA with d = B (u, θ) is symmetric and positive semidefinite, and so are the dampings.
#[derive(Debug, Clone, PartialEq)]
pub struct InterfaceJoint {
    /// Where the two nodes are, m.
    pub reference_m: [f64; 3],
    /// K: N/m, N/rad; N·m/m, N·m/rad.
    pub stiffness: Matrix6,
    /// Hysteretic (structural) damping D, in the units of K: the load is j D (u, θ) at every frequency.
    pub hysteretic: Matrix6,
    /// Viscous damping C, in the units of K times s.
    pub viscous: Matrix6,
    normal: [f64; 2],
    tangential: [f64; 2],
}

impl InterfaceJoint {
    /// The sum over the elements of an interface in the plane z = 0, each with what it has per area.
    ///
    /// # Errors
    /// The normal damping is viscous and its mass is not positive.
    pub fn new<'e>(
        parts: impl Iterator<Item = (&'e Element, Contact)>,
        reference_m: [f64; 3],
        normal_damping: NormalDamping,
    ) -> Result<Self, NumberError> {
        let moments = ContactMoments::of(parts, reference_m);
        // The interface lies at −z of the reference point.
        let height_m = -reference_m[2];
        let stiffness = sum(
            normal(&moments.normal_stiffness),
            tangential(&moments.tangential_stiffness, height_m),
        );
        let of_normal = normal(&moments.normal_damping);
        let of_tangential = tangential(&moments.tangential_damping, height_m);
        let (hysteretic, viscous) = match normal_damping {
            NormalDamping::Hysteretic => (sum(of_normal, of_tangential), [[0.0; 6]; 6]),
            NormalDamping::Viscous { mass_kg } => {
                let expected = "a positive number";
                positive("the mass of the structure", mass_kg, " kg", expected)?;
                // C_N = η_N √(M K_N) = D_N/ω_N with D_N = η_N K_N and ω_N = √(K_N/M): of the whole interface, so that it does
                // not depend on the number of elements
                let omega = (moments.normal_stiffness.sum / mass_kg).sqrt();
                let per_omega = if omega > 0.0 { 1.0 / omega } else { 0.0 };
                (of_tangential, scaled(of_normal, per_omega))
            }
        };
        Ok(Self {
            reference_m,
            stiffness: without_rounding(stiffness),
            hysteretic: without_rounding(hysteretic),
            viscous: without_rounding(viscous),
            normal: [moments.normal_stiffness.sum, moments.normal_damping.sum],
            tangential: [
                moments.tangential_stiffness.sum,
                moments.tangential_damping.sum,
            ],
        })
    }

    /// How far an element is displaced along the interface by a unit of a translation along an axis, or of a rotation about it:
    /// along x and y.
    pub(crate) fn tangential_arm(
        &self,
        element: &Element,
        axis: Axis,
        is_rotation: bool,
    ) -> [f64; 2] {
        let [x, y, z] = self.reference_m;
        // the interface lies at −z of the reference point
        let [x, y, z] = [element.x_m - x, element.y_m - y, -z];
        match (axis, is_rotation) {
            (Axis::X, false) => [1.0, 0.0],
            (Axis::Y, false) => [0.0, 1.0],
            (Axis::Z, false) => [0.0, 0.0],
            // θ × r
            (Axis::X, true) => [0.0, -z],
            (Axis::Y, true) => [z, 0.0],
            (Axis::Z, true) => [-y, x],
        }
    }

    /// All damping as a dashpot that dissipates the same at this frequency (Hz): C + D/ω.
    ///
    /// # Errors
    /// The frequency is not positive.
    pub fn viscous_at(&self, frequency_hz: f64) -> Result<Matrix6, NumberError> {
        let omega = omega(frequency_hz)?;
        Ok(sum(self.viscous, scaled(self.hysteretic, 1.0 / omega)))
    }

    /// All damping as hysteresis that dissipates the same at this frequency (Hz): D + ω C.
    ///
    /// # Errors
    /// The frequency is not positive.
    pub fn hysteretic_at(&self, frequency_hz: f64) -> Result<Matrix6, NumberError> {
        let omega = omega(frequency_hz)?;
        Ok(sum(self.hysteretic, scaled(self.viscous, omega)))
    }

    /// Loss factor along the normal, weighted by energy: Σ η k ΔA / Σ k ΔA. Zero where there is no stiffness.
    #[must_use]
    pub fn normal_loss_factor(&self) -> f64 {
        ratio(self.normal)
    }

    /// The same along the interface.
    #[must_use]
    pub fn tangential_loss_factor(&self) -> f64 {
        ratio(self.tangential)
    }

    /// The point in the interface, `[x, y]` in m, at which a normal translation goes without rotation: the centre of the
    /// normal stiffness. `None` where there is none.
    #[must_use]
    pub fn normal_centre_m(&self) -> Option<[f64; 2]> {
        // K_z,rx = Σ k_n r_y ΔA and K_z,ry = −Σ k_n r_x ΔA
        let k = &self.stiffness;
        (k[2][2] > 0.0).then(|| {
            [
                self.reference_m[0] - k[2][4] / k[2][2],
                self.reference_m[1] + k[2][3] / k[2][2],
            ]
        })
    }
}

fn omega(frequency_hz: f64) -> Result<f64, NumberError> {
    let expected = "a positive number, at which hysteretic and viscous damping are converted";
    positive("the frequency", frequency_hz, " Hz", expected)?;
    Ok(TAU * frequency_hz)
}

fn ratio([stiffness, damping]: [f64; 2]) -> f64 {
    match stiffness > 0.0 {
        true => damping / stiffness,
        false => 0.0,
    }
}

/// Σ s b bᵀ ΔA of the normal displacement d_z = b·(u, θ), b = (0, 0, 1, r_y, −r_x, 0).
fn normal(moments: &PatchMoments) -> Matrix6 {
    let PatchMoments {
        sum,
        first: [x, y],
        second: [xx, xy, yy],
    } = *moments;
    symmetric(&[
        (2, 2, sum),
        (2, 3, y),
        (2, 4, -x),
        (3, 3, yy),
        (3, 4, -xy),
        (4, 4, xx),
    ])
}

/// Σ s (b_x b_xᵀ + b_y b_yᵀ) ΔA of the displacements in the plane, b_x = (1, 0, 0, 0, r_z, −r_y) and b_y = (0, 1, 0, −r_z, 0, r_x).
fn tangential(moments: &PatchMoments, z: f64) -> Matrix6 {
    let PatchMoments {
        sum,
        first: [x, y],
        second: [xx, _, yy],
    } = *moments;
    symmetric(&[
        (0, 0, sum),
        (0, 4, z * sum),
        (0, 5, -y),
        (1, 1, sum),
        (1, 3, -z * sum),
        (1, 5, x),
        (3, 3, z * z * sum),
        (3, 5, -z * x),
        (4, 4, z * z * sum),
        (4, 5, -z * y),
        (5, 5, xx + yy),
    ])
}

fn symmetric(upper: &[(usize, usize, f64)]) -> Matrix6 {
    let mut matrix = [[0.0; 6]; 6];
    for &(i, j, value) in upper {
        matrix[i][j] = value;
        matrix[j][i] = value;
    }
    matrix
}

fn sum(mut a: Matrix6, b: Matrix6) -> Matrix6 {
    for (row, other) in a.iter_mut().zip(b) {
        for (value, other) in row.iter_mut().zip(other) {
            *value += other;
        }
    }
    a
}

/// The matrix with zeros where sums that cancel, as those of a symmetric interface, have left rounding.
fn without_rounding(matrix: Matrix6) -> Matrix6 {
    let size = |i: usize| matrix[i][i].sqrt();
    let mut cleaned = matrix;
    for (i, row) in cleaned.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            if entry.abs() <= ROUNDING * size(i) * size(j) {
                *entry = 0.0;
            }
        }
    }
    cleaned
}

fn scaled(matrix: Matrix6, by: f64) -> Matrix6 {
    matrix.map(|row| row.map(|value| value * by))
}
