//! A straight uniform beam by finite elements: the substructure that is computed instead of measured.

use std::num::NonZeroU16;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

mod element;
mod inner;
mod mesh;
mod modal;
mod theory;

use super::StructureError;
pub(in crate::structure) use element::Element;
use mesh::ELEMENTS;
pub use modal::ModalBeam;
pub(in crate::structure) use theory::SHEAR_COEFFICIENT;
pub use theory::Theory;

/// How the two ends of a beam are held; the first word is the end at x = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Boundary {
    /// Both ends free.
    FreeFree,
    /// Fixed at x = 0, free at the other end.
    FixedFree,
    /// Free at x = 0, fixed at the other end.
    FreeFixed,
    /// Both ends fixed.
    FixedFixed,
    /// Both ends pinned.
    PinnedPinned,
    /// Fixed at x = 0, pinned at the other end.
    FixedPinned,
}

/// Damping of the beam's elastic modes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Damping {
    /// ζ of each mode in ascending order, rigid-body modes included; the last one holds for all higher modes.
    Ratios(Vec<f64>),
    /// Structural loss factor η: K (1 + jη).
    LossFactor(f64),
}

impl Damping {
    /// So many times as much.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        match self {
            Self::Ratios(ratios) => Self::Ratios(ratios.iter().map(|own| factor * own).collect()),
            Self::LossFactor(own) => Self::LossFactor(factor * own),
        }
    }
}

/// A uniform beam of rectangular cross-section that bends about its width.
///
/// ```
/// use bolted_joint_frf::structure::{Beam, BeamPoint, Boundary, Damping, Motion, Theory};
///
/// let beam = Beam {
///     length_m: 0.4,
///     width_m: 0.04,
///     height_m: 0.01,
///     youngs_modulus_pa: 210e9,
///     density_kg_per_m3: 7850.0,
///     theory: Theory::default(),
///     boundary: Boundary::FixedFree,
///     damping: Damping::LossFactor(1e-3),
/// };
/// // Shear and rotary inertia leave little less than f₁ = (1.8751)²/(2π L²) √(EI/ρA) = 52.22 Hz.
/// assert!((beam.natural_frequencies_hz()?[0] - 52.20).abs() < 0.02);
/// let tip = BeamPoint { position_m: 0.4, motion: Motion::Translation };
/// let static_receptance = beam.receptances(&[tip], &[1e-3])?[0][(0, 0)];
/// // L³/3EI, and 1.2 L/GA by shear
/// assert!((static_receptance.re / (3.04762e-5 + 1.486e-8) - 1.0).abs() < 1e-4);
/// # Ok::<(), bolted_joint_frf::structure::StructureError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Length, m.
    pub length_m: f64,
    /// Width of the cross-section, m.
    pub width_m: f64,
    /// Height of the cross-section in the direction of bending, m.
    pub height_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
    /// Whether shear and rotary inertia count.
    pub theory: Theory,
    /// How the ends are held.
    pub boundary: Boundary,
    /// Damping.
    pub damping: Damping,
}

/// Which motion of a point on the beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Displacement w, m (and force, N).
    Translation,
    /// Rotation θ of the cross-section, rad (and moment, N·m). The axis has the slope ∂w/∂x = θ + Q/κGA: θ without shear.
    Rotation,
}

/// One degree of freedom of the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamPoint {
    /// Distance from the beam's first end, m.
    pub position_m: f64,
    /// Which motion there.
    pub motion: Motion,
}

/// Undamped mass-normalised modes of a beam at some of its points, in ascending order, rigid-body modes included.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamModes {
    /// ω_r, rad/s.
    pub angular_frequency: DVector<f64>,
    /// φ_r at each point, kg^−½ for a translation and m⁻¹·kg^−½ for a rotation: one row a point, one column a mode.
    pub amplitudes: DMatrix<f64>,
}

impl Beam {
    /// Receptances between all `points`, one matrix (points×points) for each frequency: every mode of the
    /// finite-element model is summed. All points are nodes of the mesh, save those within 1e-3 of the length
    /// of another.
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical, a point is not on it or a frequency is that of an undamped mode.
    pub fn receptances(
        &self,
        points: &[BeamPoint],
        frequency_hz: &[f64],
    ) -> Result<Vec<DMatrix<Complex64>>, StructureError> {
        self.modal(points)?.receptances(points, frequency_hz)
    }

    /// All modes of the finite-element model of which these points are nodes.
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical, or a point is not on it.
    pub fn modal(&self, nodes: &[BeamPoint]) -> Result<ModalBeam, StructureError> {
        ModalBeam::new(self, nodes, ELEMENTS)
    }

    /// Undamped modes of the finite-element model with about `elements` elements over the length, each point a node of the
    /// mesh as in [`Beam::receptances`].
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical, or a point is not on it.
    pub fn modes_at(
        &self,
        points: &[BeamPoint],
        elements: NonZeroU16,
    ) -> Result<BeamModes, StructureError> {
        let modal = ModalBeam::new(self, points, f64::from(elements.get()))?;
        let mut angular_frequency = modal.angular_frequency().clone();
        angular_frequency
            .rows_mut(0, self.rigid_body_modes())
            .fill(0.0);
        Ok(BeamModes {
            angular_frequency,
            amplitudes: modal.amplitudes(points)?,
        })
    }

    /// Natural frequencies in Hz, ascending, rigid-body modes (as zeros) included.
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical.
    pub fn natural_frequencies_hz(&self) -> Result<Vec<f64>, StructureError> {
        let nodes = self.mesh(&[], ELEMENTS)?;
        let mut frequencies = self.modes_on(&nodes)?.frequency_hz();
        frequencies[..self.rigid_body_modes()].fill(0.0);
        Ok(frequencies)
    }

    fn check(&self) -> Result<(), StructureError> {
        let check = |valid: bool, key, found: f64, expected| match valid {
            true => Ok(()),
            false => Err(StructureError::Beam {
                key,
                found: found.to_string(),
                expected,
            }),
        };
        for (key, found) in [
            ("length", self.length_m),
            ("width", self.width_m),
            ("height", self.height_m),
            ("youngs_modulus", self.youngs_modulus_pa),
            ("density", self.density_kg_per_m3),
        ] {
            let valid = found.is_finite() && found > 0.0;
            check(valid, key, found, "a positive number in SI units")?;
        }
        if let Theory::Timoshenko { poissons_ratio } = self.theory {
            check(
                (0.0..0.5).contains(&poissons_ratio),
                "poissons_ratio",
                poissons_ratio,
                "a number from 0 and below 0.5",
            )?;
        }
        let (key, values) = match &self.damping {
            Damping::Ratios(ratios) => ("damping_ratio", ratios.as_slice()),
            Damping::LossFactor(eta) => ("loss_factor", std::slice::from_ref(eta)),
        };
        if values.is_empty() {
            return Err(StructureError::Beam {
                key,
                found: "an empty list".to_owned(),
                expected: "one number or a number for each mode",
            });
        }
        values.iter().try_for_each(|&found| match &self.damping {
            Damping::Ratios(_) => check(
                (0.0..1.0).contains(&found),
                key,
                found,
                "a ratio from 0 to below 1 (not per cent)",
            ),
            Damping::LossFactor(_) => check(
                found.is_finite() && found >= 0.0,
                key,
                found,
                "a finite number that is not negative",
            ),
        })
    }
}

#[cfg(test)]
mod tests;
