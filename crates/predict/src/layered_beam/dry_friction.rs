//! Dry friction as a joint file has it: a slider on a stiff spring.

use std::f64::consts::{FRAC_PI_4, PI};

use bolted_joint_dynamics::law::Jenkins;

use super::error::{LayeredBeamError, value};

/// Part of the smallest amplitude at which the slider begins to slip: so much of friction's heat is missing there, and less at
/// larger amplitudes. A smaller part asks for a stiffer spring, and shorter steps in time.
const STICKS: f64 = 1e-3;

/// Amplitudes of a relative motion, m, from a smaller to a larger one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplitudeRange {
    /// Smallest, m.
    from_m: f64,
    /// Largest, m.
    to_m: f64,
}

impl AmplitudeRange {
    /// A range of amplitudes, m.
    ///
    /// # Errors
    /// They are not positive, or the second is not larger than the first.
    pub fn new(key: &'static str, from_m: f64, to_m: f64) -> Result<Self, LayeredBeamError> {
        if from_m > 0.0 && to_m > from_m && to_m.is_finite() {
            Ok(Self { from_m, to_m })
        } else {
            let expected = "positive amplitudes from a smaller to a larger one";
            Err(value(key, format_args!("{from_m} to {to_m} m"), expected))
        }
    }

    /// Smallest amplitude, m.
    #[must_use]
    pub fn from_m(&self) -> f64 {
        self.from_m
    }

    /// Largest amplitude, m.
    #[must_use]
    pub fn to_m(&self) -> f64 {
        self.to_m
    }
}

/// A slider on a spring whose heat in a cycle is that of dry friction in a range of amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrySlider {
    /// The slider: N/m, N.
    pub law: Jenkins,
    /// Largest |heat/heat by friction − 1| in the range, at its smallest amplitude.
    pub worst_error: f64,
    /// Angular frequency of the motion, rad/s.
    omega_rad_s: f64,
}

impl DrySlider {
    /// The slider for the viscous equivalent `coulomb`/R of dry friction at amplitude R (m) and this angular frequency (rad/s);
    /// `coulomb` in N·s.
    #[must_use]
    pub fn following(coulomb: f64, omega_rad_s: f64, range: &AmplitudeRange) -> Self {
        // π c_eq ω R² = 4 h R with c_eq R = coulomb
        let slip_force = FRAC_PI_4 * omega_rad_s * coulomb;
        Self {
            law: Jenkins {
                // h/k is a small part of the smallest amplitude
                stiffness: slip_force / (STICKS * range.from_m),
                slip_force,
            },
            worst_error: STICKS,
            omega_rad_s,
        }
    }

    /// Viscous damper with the same heat in a cycle of an amplitude at which it slips, N·s/m.
    #[must_use]
    pub fn equivalent_n_s_per_m(&self, amplitude_m: f64) -> f64 {
        // D = 4h(U − h/k) = π c_eq ω U²
        let Jenkins {
            stiffness,
            slip_force,
        } = self.law;
        let slips = (amplitude_m - slip_force / stiffness).max(0.0);
        4.0 * slip_force * slips / (PI * self.omega_rad_s * amplitude_m * amplitude_m)
    }

    /// Stiffness that it adds to a motion of an amplitude at which it slips, N/m: the load in phase over the amplitude.
    #[must_use]
    pub fn secant_n_per_m(&self, amplitude_m: f64) -> f64 {
        // a₁/U = (k/π)(θ_s − ½ sin 2θ_s), θ_s = arccos(1 − 2h/(kU))
        let Jenkins {
            stiffness,
            slip_force,
        } = self.law;
        let angle = (1.0 - 2.0 * slip_force / (stiffness * amplitude_m)).acos();
        stiffness / PI * (angle - 0.5 * (2.0 * angle).sin())
    }
}
