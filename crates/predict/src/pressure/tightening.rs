//! From the torque on a bolt to its preload, and back.

use std::f64::consts::PI;

use crate::number::{self, NumberError};

/// How a torque becomes a preload.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tightening {
    /// T = K d F with the nut factor K.
    NutFactor {
        /// K; about 0.2 for dry steel.
        factor: f64,
        /// Nominal diameter d of the bolt, in m.
        diameter_m: f64,
    },
    /// Friction in the thread and under the head.
    Friction(ThreadFriction),
}

/// A thread of ISO's basic profile (flanks at 60°) and a ring under the head or nut that is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThreadFriction {
    /// Nominal diameter d, in m.
    pub diameter_m: f64,
    /// Pitch, in m; see [`coarse_pitch_m`].
    pub pitch_m: f64,
    /// Coefficient of friction in the thread, μ_G.
    pub thread_coefficient: f64,
    /// Coefficient of friction under the head or nut, μ_K.
    pub head_coefficient: f64,
    /// Outer diameter of the ring under the head, in m.
    pub bearing_outer_diameter_m: f64,
    /// Its inner diameter, that of the hole, in m.
    pub bearing_inner_diameter_m: f64,
}

/// The coarse pitch of a metric bolt of nominal diameter `diameter_m`, in m; `None` if ISO 261 has no such size up to M64.
#[must_use]
pub fn coarse_pitch_m(diameter_m: f64) -> Option<f64> {
    let mut sizes_mm = include_str!("coarse-pitch.csv").lines().filter_map(|line| {
        let (diameter_mm, pitch_mm) = line.split_once(',')?;
        Some((
            diameter_mm.parse::<f64>().ok()?,
            pitch_mm.parse::<f64>().ok()?,
        ))
    });
    sizes_mm
        .find(|(diameter_mm, _)| (1e3 * diameter_m / diameter_mm - 1.0).abs() < 1e-6)
        .map(|(_, pitch_mm)| 1e-3 * pitch_mm)
}

impl Tightening {
    /// Preload from a torque (N·m), in N.
    ///
    /// # Errors
    /// [`NumberError`] if a length, a coefficient or the torque is negative or not finite.
    pub fn preload_n(&self, torque_n_m: f64) -> Result<f64, NumberError> {
        check(
            "the torque in N·m",
            torque_n_m,
            torque_n_m >= 0.0,
            "0 or more",
        )?;
        Ok(torque_n_m / self.torque_per_preload_m()?)
    }

    /// Torque for a preload (N), in N·m.
    ///
    /// # Errors
    /// [`NumberError`] if a length, a coefficient or the preload is negative or not finite.
    pub fn torque_n_m(&self, preload_n: f64) -> Result<f64, NumberError> {
        check("the preload in N", preload_n, preload_n >= 0.0, "0 or more")?;
        Ok(preload_n * self.torque_per_preload_m()?)
    }

    /// T/F, in m.
    fn torque_per_preload_m(&self) -> Result<f64, NumberError> {
        match self {
            Self::NutFactor { factor, diameter_m } => {
                check(
                    "the nut factor",
                    *factor,
                    *factor > 0.0,
                    "a positive number",
                )?;
                positive("the diameter in m", *diameter_m)?;
                Ok(factor * diameter_m)
            }
            Self::Friction(thread) => thread.torque_per_preload_m(),
        }
    }
}

impl ThreadFriction {
    /// Pitch diameter d₂ of the basic profile, in m.
    #[must_use]
    pub fn pitch_diameter_m(&self) -> f64 {
        // d₂ = d − 2 · (3/8) H with H = (√3/2) P (ISO 724)
        self.diameter_m - 0.375 * 3_f64.sqrt() * self.pitch_m
    }

    fn torque_per_preload_m(&self) -> Result<f64, NumberError> {
        positive("the diameter in m", self.diameter_m)?;
        positive("the pitch in m", self.pitch_m)?;
        for (quantity, found) in [
            (
                "the thread's coefficient of friction",
                self.thread_coefficient,
            ),
            ("the head's coefficient of friction", self.head_coefficient),
        ] {
            check(quantity, found, found >= 0.0, "0 or more")?;
        }
        let (outer_m, inner_m) = (self.bearing_outer_diameter_m, self.bearing_inner_diameter_m);
        check(
            "the bearing ring's inner diameter in m",
            inner_m,
            inner_m >= 0.0,
            "0 or more",
        )?;
        check(
            "the bearing ring's outer diameter in m",
            outer_m,
            outer_m > inner_m,
            "more than the inner one",
        )?;
        let pitch_diameter_m = self.pitch_diameter_m();
        positive("the pitch diameter in m", pitch_diameter_m)?;
        // Lead: tan φ = P/(π d₂). The flank's half angle of 30° lies in the plane through the axis; across the thread it is
        // tan α_n = tan 30° cos φ.
        let lead = (self.pitch_m / (PI * pitch_diameter_m)).atan();
        let flank = ((PI / 6.0).tan() * lead.cos()).atan();
        // T_G/F = (d₂/2) (sin φ cos α_n + μ_G cos φ)/(cos φ cos α_n − μ_G sin φ), the balance on the flank. To first order in φ
        // and μ_G it is P/2π + 0.577 d₂ μ_G, as VDI 2230 has it.
        let friction = self.thread_coefficient;
        let resisting = lead.cos() * flank.cos() - friction * lead.sin();
        check(
            "the thread's coefficient of friction",
            friction,
            resisting > 0.0,
            "one at which the thread can be turned",
        )?;
        let thread =
            0.5 * pitch_diameter_m * (lead.sin() * flank.cos() + friction * lead.cos()) / resisting;
        // T_K/F = μ_K D_Km/2, D_Km the mean diameter of the ring
        let head = 0.25 * self.head_coefficient * (outer_m + inner_m);
        check(
            "the torque per preload in m",
            thread + head,
            thread + head > 0.0,
            "a positive number",
        )?;
        Ok(thread + head)
    }
}

fn positive(quantity: &'static str, found: f64) -> Result<(), NumberError> {
    check(quantity, found, found > 0.0, "a positive length")
}

fn check(
    quantity: &str,
    found: f64,
    valid: bool,
    expected: &'static str,
) -> Result<(), NumberError> {
    let quantity = format!("tightening: {quantity}");
    number::check(valid && found.is_finite(), quantity, found, "", expected)
}
