//! Damping of one mode by dry friction between the layers.

use std::f64::consts::PI;

use serde::Serialize;

use super::beam::LayeredBeam;
use super::beam_mode::BeamMode;
use super::error::{LayeredBeamError, positive};
use super::fasteners::Fasteners;

/// One mode whose layers slip at the fasteners: energies over a period, and the damping ratio that they amount to.
///
/// Friction is Coulomb's, so the energy that it takes grows with the amplitude and the stored one with its square: the damping
/// ratio falls as 1/amplitude. There is no lower limit in the model; below some amplitude the layers of a real joint stick.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlipDamping {
    /// The mode.
    pub mode: BeamMode,
    /// Σ N (h₁ + h₂) over the interfaces, N·m.
    pub slip_moment_n_m: f64,
    /// α′μ: dynamic slip ratio times coefficient of friction.
    pub alpha_mu: f64,
}

impl SlipDamping {
    /// Damping of a mode with a known α′μ.
    ///
    /// # Errors
    /// α′μ is not positive, or the thickness ratio of two layers is beyond what the pressure is known for.
    pub fn new(
        beam: &LayeredBeam,
        fasteners: &Fasteners,
        mode: BeamMode,
        alpha_mu: f64,
    ) -> Result<Self, LayeredBeamError> {
        positive("friction.alpha_mu", alpha_mu, "")?;
        Ok(Self {
            mode,
            slip_moment_n_m: fasteners.slip_moment_n_m(beam)?,
            alpha_mu,
        })
    }

    /// Damping of a mode whose ratio ζ was measured at one amplitude of its drive point: α′μ is what makes it so.
    ///
    /// # Errors
    /// Ratio or amplitude are not positive, the mode has no slope at any fastener, and as [`SlipDamping::new`].
    pub fn calibrated(
        beam: &LayeredBeam,
        fasteners: &Fasteners,
        mode: BeamMode,
        damping_ratio: f64,
        amplitude_m: f64,
    ) -> Result<Self, LayeredBeamError> {
        positive("friction.calibration.damping_ratio", damping_ratio, "")?;
        positive("friction.calibration.amplitude", amplitude_m, "m")?;
        mode.check_slip()?;
        let unit = Self::new(beam, fasteners, mode, 1.0)?;
        // α′μ = k w δ/(N (h₁ + h₂) X α)   (Kavi 3.44): ζ is proportional to α′μ
        let alpha_mu = damping_ratio / unit.damping_ratio(amplitude_m);
        Ok(Self { alpha_mu, ..unit })
    }

    /// Energy that friction takes in a period at an amplitude of the drive point, J.
    #[must_use]
    pub fn dissipated_energy_j(&self, amplitude_m: f64) -> f64 {
        // E_f = 2 α′μ N (h₁ + h₂) Y   (Kavi 4.30)
        2.0 * self.alpha_mu * self.slip_moment_n_m * self.mode.slope_sum_per_m() * amplitude_m
    }

    /// Energy that is stored at an amplitude of the drive point, J.
    #[must_use]
    pub fn stored_energy_j(&self, amplitude_m: f64) -> f64 {
        // E_n = ½ k w²   (Kavi 3.39, 4.31)
        0.5 * self.mode.stiffness_n_per_m * amplitude_m.powi(2)
    }

    /// Logarithmic decrement δ at an amplitude of the drive point.
    #[must_use]
    pub fn logarithmic_decrement(&self, amplitude_m: f64) -> f64 {
        // δ = E_f/(2 E_n)   (Kavi 3.38)
        0.5 * self.dissipated_energy_j(amplitude_m) / self.stored_energy_j(amplitude_m)
    }

    /// Damping ratio ζ at an amplitude of the drive point.
    #[must_use]
    pub fn damping_ratio(&self, amplitude_m: f64) -> f64 {
        // ζ = δ/2π = E_f/(4π E_n)   (Kavi 3.43, 4.32)
        self.logarithmic_decrement(amplitude_m) / (2.0 * PI)
    }

    /// Viscous damper at the drive point that gives the mode this damping ratio at an amplitude, N·s/m.
    #[must_use]
    pub fn viscous_damping_n_s_per_m(&self, amplitude_m: f64) -> f64 {
        // c = 2 ζ ω m
        2.0 * self.damping_ratio(amplitude_m) * self.mode.angular_frequency * self.mode.mass_kg
    }
}
