//! One finite element: its matrices, and the motion between its nodes.
//!
//! Between two nodes the beam takes the static shape that belongs to their motion. Without load there the shear force Q is
//! the same everywhere, and so is the shear ∂w/∂x − θ = Q/κGA. Without shear (Φ = 0) these are the cubic Hermite functions.
//! Source: J. S. Przemieniecki, Theory of Matrix Structural Analysis, McGraw-Hill 1968, beam elements with shear.

use super::{Beam, Motion};

/// Of the DOFs w₁, θ₁, w₂, θ₂; θ is the rotation of the cross-section.
pub(in crate::structure) struct Element {
    l: f64,
    /// Φ = 12EI/(κGA l²)
    shear: f64,
    /// EI, N·m²
    bending: f64,
    /// ρA, kg/m
    mass_per_length: f64,
    /// ρI, kg·m
    rotary_inertia: f64,
}

type Matrix = [[f64; 4]; 4];

impl Element {
    pub(in crate::structure) fn new(beam: &Beam, length_m: f64) -> Self {
        let mass_per_length = beam.density_kg_per_m3 * beam.width_m * beam.height_m;
        // I/A = h²/12
        let gyration_m2 = beam.height_m * beam.height_m / 12.0;
        Self {
            l: length_m,
            shear: 12.0 * beam.theory.moduli_ratio() * gyration_m2 / (length_m * length_m),
            bending: beam.youngs_modulus_pa * beam.width_m * beam.height_m.powi(3) / 12.0,
            mass_per_length,
            rotary_inertia: beam.theory.rotary_inertia() * mass_per_length * gyration_m2,
        }
    }

    /// [k_e] = EI/((1 + Φ) l³) [12 6l −12 6l; …]   (Tol 4.4 and Kavi 4.10 for Φ = 0)
    pub(in crate::structure) fn stiffness(&self) -> Matrix {
        let (l, phi) = (self.l, self.shear);
        let k = self.bending / l.powi(3) / (1.0 + phi);
        let near = (4.0 + phi) * l * l;
        let far = (2.0 - phi) * l * l;
        let rows = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, near, -6.0 * l, far],
            [-12.0, -6.0 * l, 12.0, -6.0 * l],
            [6.0 * l, far, -6.0 * l, near],
        ];
        rows.map(|row| row.map(|entry| k * entry))
    }

    /// ∫ρA w² dx + ∫ρI θ² dx over the static shapes   (Tol 4.3 and Kavi 4.11 for Φ = 0 and without the second)
    pub(in crate::structure) fn mass(&self) -> Matrix {
        let (l, phi) = (self.l, self.shear);
        let square = phi * phi;
        let m = self.mass_per_length * l / 420.0 / (1.0 + phi).powi(2);
        let w = 156.0 + 294.0 * phi + 140.0 * square;
        let w_theta = (22.0 + 38.5 * phi + 17.5 * square) * l;
        let theta = (4.0 + 7.0 * phi + 3.5 * square) * l * l;
        let far_w = 54.0 + 126.0 * phi + 70.0 * square;
        let far_w_theta = (13.0 + 31.5 * phi + 17.5 * square) * l;
        let far_theta = (3.0 + 7.0 * phi + 3.5 * square) * l * l;
        let translation = [
            [w, w_theta, far_w, -far_w_theta],
            [w_theta, theta, far_w_theta, -far_theta],
            [far_w, far_w_theta, w, -w_theta],
            [-far_w_theta, -far_theta, -w_theta, theta],
        ];
        let r = self.rotary_inertia / (30.0 * l) / (1.0 + phi).powi(2);
        let w_theta = (3.0 - 15.0 * phi) * l;
        let theta = (4.0 + 5.0 * phi + 10.0 * square) * l * l;
        let far_theta = (1.0 + 5.0 * phi - 5.0 * square) * l * l;
        let rotation = [
            [36.0, w_theta, -36.0, w_theta],
            [w_theta, theta, -w_theta, -far_theta],
            [-36.0, -w_theta, 36.0, -w_theta],
            [w_theta, -far_theta, -w_theta, theta],
        ];
        std::array::from_fn(|i| std::array::from_fn(|j| m * translation[i][j] + r * rotation[i][j]))
    }

    /// Weights of w₁, θ₁, w₂, θ₂ in the motion at the part x of the length.
    pub(super) fn shape(&self, motion: Motion, x: f64) -> [f64; 4] {
        let (l, phi) = (self.l, self.shear);
        let weights = match motion {
            // (1 + Φ) w = (1 − 3x² + 2x³ + Φ(1 − x)) w₁ + l(x − 2x² + x³ + Φ(x − x²)/2) θ₁
            //           + (3x² − 2x³ + Φx) w₂ + l(x³ − x² − Φ(x − x²)/2) θ₂
            Motion::Translation => [
                1.0 - 3.0 * x * x + 2.0 * x.powi(3) + phi * (1.0 - x),
                l * (x - 2.0 * x * x + x.powi(3) + phi * (x - x * x) / 2.0),
                3.0 * x * x - 2.0 * x.powi(3) + phi * x,
                l * (x.powi(3) - x * x - phi * (x - x * x) / 2.0),
            ],
            // θ = ∂w/∂x − Q/κGA
            Motion::Rotation => [
                (6.0 * x * x - 6.0 * x) / l,
                1.0 - 4.0 * x + 3.0 * x * x + phi * (1.0 - x),
                (6.0 * x - 6.0 * x * x) / l,
                3.0 * x * x - 2.0 * x + phi * x,
            ],
        };
        weights.map(|weight| weight / (1.0 + phi))
    }
}
