//! The zone around a bolt in which the parts press on each other.

use serde::Deserialize;

use super::radial::RadialPressure;
use super::{Bolt, PressureError};
use crate::number::{check, not_negative, positive};

/// How the pressure falls off around each bolt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// The polynomial of Kavi (3.32), fitted there to Minakuchi's measurements.
    Polynomial {
        /// Ratio of the thicknesses of the two layers.
        thickness_ratio: ThicknessRatio,
        /// How far the zone reaches.
        reach: Reach,
        /// What force the zone carries.
        force: ZoneForce,
    },
    /// Rötscher's cone: the load spreads from the head to the interface under a constant angle.
    Cone(Cone),
}

/// Ratio of the layers' thicknesses, thicker over thinner, for which Table 3.1 of Kavi has constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThicknessRatio {
    /// 1
    One,
    /// 1.5
    OneAndAHalf,
    /// 2
    Two,
}

/// How far a polynomial zone reaches.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reach {
    /// 3.5 diameters across, as the thesis says of bolts. It has no constants for them: the polynomial is compressed linearly
    /// between the hole's edge and the rim, so that it falls off to the same pressure there.
    #[default]
    Bolts,
    /// 4.125, 5.0 or 5.6 diameters across, as measured for rivets (Table 3.1).
    Rivets,
}

/// What force a polynomial zone carries.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ZoneForce {
    /// The preload: the pressure is scaled so.
    #[default]
    Preload,
    /// N of (3.34), which is 0.8952, 1.1338 or 1.2787 times the preload: the thesis's σ_s = P/(2.0625 π R_v²) is kept.
    AsPublished,
}

/// Rötscher's cone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Angle between the cone's side and the bolt's axis, in rad; about 30° for steel.
    pub half_angle_rad: f64,
    /// Diameter of the area that the head or washer presses on, in m.
    pub head_diameter_m: f64,
    /// Thickness of the part between the head and the interface, in m.
    pub depth_m: f64,
    /// How the pressure is spread over the cone's base.
    pub distribution: ConePressure,
}

/// How the pressure is spread over a cone's base.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConePressure {
    /// The same everywhere.
    Uniform,
    /// p ∝ 1 − (r/R)², zero at the rim R.
    #[default]
    Parabolic,
}

/// (R_M/R_v, N/P is computed) and A6 … A1 of Table 3.1.
struct Constants {
    rim: f64,
    by_power: [f64; 6],
}

/// A' = π[(1.75 R_v)² − R_v²] = 2.0625 π R_v² is the area under a rivet's head (Kavi, above 3.33).
const AREA_UNDER_HEAD: f64 = 2.0625;
/// Diameter of the zone of a bolt over that of the bolt (Kavi, chapter 3, introduction).
const BOLT_RIM: f64 = 3.5;

impl ThicknessRatio {
    /// The ratio of two layers' thicknesses (m), in any order.
    ///
    /// # Errors
    /// [`PressureError::ThicknessRatio`] if it is not within 1 % of 1, 1.5 or 2, for which there are constants.
    pub fn of(first_m: f64, second_m: f64) -> Result<Self, PressureError> {
        let ratio = first_m.max(second_m) / first_m.min(second_m);
        [(1.0, Self::One), (1.5, Self::OneAndAHalf), (2.0, Self::Two)]
            .into_iter()
            .find(|(known, _)| (ratio / known - 1.0).abs() <= 0.01)
            .map(|(_, known)| known)
            .ok_or(PressureError::ThicknessRatio { first_m, second_m })
    }

    fn constants(self) -> Constants {
        match self {
            Self::One => Constants {
                rim: 4.125,
                by_power: [5.38e-1, -9.58e-2, 3.09e-3, 6.04e-4, -5.80e-5, 1.45e-6],
            },
            Self::OneAndAHalf => Constants {
                rim: 5.0,
                by_power: [4.88e-1, -8.77e-2, 8.17e-3, -4.59e-4, 1.40e-5, -1.74e-7],
            },
            // Printed A2 = 7.45e-04: the pressure would be 713 σ_s at the rim. With 7.45e-06 it is 0.002 σ_s.
            Self::Two => Constants {
                rim: 5.6,
                by_power: [4.60e-1, -7.46e-2, 6.22e-3, -2.98e-4, 7.45e-6, -7.42e-8],
            },
        }
    }

    /// Radius of the zone of influence over that of the rivet, R_M/R_v: 4.125, 5.0 or 5.6.
    #[must_use]
    pub fn rim_over_rivet_radius(self) -> f64 {
        self.constants().rim
    }

    /// p/σ_s of (3.32) at R/R_v = `rho`, as printed but for the erratum in A2 of ratio 2; slightly negative near some rims.
    #[must_use]
    pub fn pressure_over_surface_stress(self, rho: f64) -> f64 {
        polynomial(&self.constants().by_power, rho * rho)
    }

    /// N/P of (3.34): the force between the layers over the rivet's tension.
    #[must_use]
    pub fn normal_force_over_preload(self) -> f64 {
        let Constants { rim, by_power } = self.constants();
        // N/P = Σ A_i (ρ_M^(2i+2) − 1)/(i+1)/2.0625, both lines of (3.34) divided by 2.0625
        let terms = (1..).zip(by_power).map(|(order, constant): (i32, f64)| {
            constant * (rim.powi(2 * order) - 1.0) / f64::from(order)
        });
        terms.sum::<f64>() / AREA_UNDER_HEAD
    }

    /// Where the pressure has fallen to zero, R/R_v: the rim, or the root of the polynomial before it.
    fn zero(self) -> f64 {
        let Constants { rim, .. } = self.constants();
        let pressure = |rho| self.pressure_over_surface_stress(rho);
        if pressure(rim) >= 0.0 {
            return rim;
        }
        // The polynomials fall monotonically, so that there is one root.
        let (mut positive, mut negative) = (1.0, rim);
        while negative - positive > 4.0 * f64::EPSILON * rim {
            let middle = 0.5 * (positive + negative);
            match pressure(middle) >= 0.0 {
                true => positive = middle,
                false => negative = middle,
            }
        }
        positive
    }
}

fn polynomial(by_power: &[f64], variable: f64) -> f64 {
    by_power
        .iter()
        .rev()
        .fold(0.0, |sum, constant| sum * variable + constant)
}

impl Zone {
    /// Radius of the zone around a bolt at the interface, in m; beyond it the parts do not touch.
    #[must_use]
    pub fn radius_m(&self, bolt: &Bolt) -> f64 {
        match self {
            Self::Polynomial {
                thickness_ratio,
                reach,
                ..
            } => {
                let rim = match reach {
                    Reach::Rivets => thickness_ratio.rim_over_rivet_radius(),
                    Reach::Bolts => BOLT_RIM,
                };
                0.5 * bolt.diameter_m * rim
            }
            // R = d_w/2 + t tan φ
            Self::Cone(cone) => {
                0.5 * cone.head_diameter_m + cone.depth_m * cone.half_angle_rad.tan()
            }
        }
    }

    /// Refuses angles and lengths that no cone has.
    pub(super) fn check(&self) -> Result<(), PressureError> {
        let Self::Cone(cone) = self else {
            return Ok(());
        };
        let angle = cone.half_angle_rad;
        let is_acute = (0.0..std::f64::consts::FRAC_PI_2).contains(&angle);
        let expected = "0 or more and less than π/2 rad";
        check(is_acute, "the cone's half angle", angle, "", expected)?;
        let expected = "a positive length in m";
        positive(
            "the cone's head diameter",
            cone.head_diameter_m,
            "",
            expected,
        )?;
        not_negative(
            "the cone's depth",
            cone.depth_m,
            "",
            "a length of 0 m or more",
        )?;
        Ok(())
    }

    /// The pressure around bolt `number` (from 1) with a hole of `hole_radius_m`, on a plate without end.
    pub(super) fn around(
        &self,
        number: usize,
        bolt: &Bolt,
        hole_radius_m: f64,
    ) -> Result<RadialPressure, PressureError> {
        let rim_m = self.radius_m(bolt);
        if rim_m <= hole_radius_m {
            return Err(PressureError::ZoneInHole {
                number,
                zone_m: rim_m,
                hole_m: hole_radius_m,
            });
        }
        match *self {
            Self::Polynomial {
                thickness_ratio,
                reach,
                force,
            } => {
                let radius_m = 0.5 * bolt.diameter_m;
                let Constants { rim, by_power } = thickness_ratio.constants();
                // ρ' = 1 + (ρ − 1) (ρ_M − 1)/(3.5 − 1) goes from 1 to ρ_M while ρ = R/R_v goes from 1 to 3.5.
                let squeeze = match reach {
                    Reach::Rivets => 1.0,
                    Reach::Bolts => (rim - 1.0) / (BOLT_RIM - 1.0),
                };
                let zero_m = radius_m * (1.0 + (thickness_ratio.zero() - 1.0) / squeeze);
                let shape = |inner_m: f64| {
                    let range = [inner_m, zero_m.max(inner_m)];
                    RadialPressure::new(range, by_power.to_vec(), radius_m / squeeze, 1.0 - squeeze)
                };
                let found = shape(hole_radius_m.max(radius_m));
                Ok(match force {
                    ZoneForce::Preload => found.with_force(bolt.preload_n),
                    ZoneForce::AsPublished => {
                        // The thesis integrates from the rivet's edge; a wider hole carries less.
                        let published_n =
                            thickness_ratio.normal_force_over_preload() * bolt.preload_n;
                        let part = found.force_n() / shape(radius_m).force_n();
                        found.with_force(published_n * part)
                    }
                })
            }
            Self::Cone(cone) => {
                let range = [hole_radius_m, rim_m];
                let coefficients = match cone.distribution {
                    ConePressure::Uniform => vec![1.0],
                    ConePressure::Parabolic => vec![1.0, -1.0],
                };
                let shape = RadialPressure::new(range, coefficients, rim_m, 0.0);
                Ok(shape.with_force(bolt.preload_n))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_forces_and_rims() {
        let all = [
            (ThicknessRatio::One, 0.8952, 0.016),
            (ThicknessRatio::OneAndAHalf, 1.1338, 0.001),
            (ThicknessRatio::Two, 1.2787, 0.002),
        ];
        for (ratio, force, at_rim) in all {
            assert!((ratio.normal_force_over_preload() - force).abs() < 5e-5);
            let rim = ratio.rim_over_rivet_radius();
            assert!(ratio.pressure_over_surface_stress(rim).abs() < at_rim);
            // Falls all the way.
            let pressures: Vec<f64> = (0..=100)
                .map(|k| 1.0 + (rim - 1.0) * f64::from(k) / 100.0)
                .map(|rho| ratio.pressure_over_surface_stress(rho))
                .collect();
            assert!(pressures.windows(2).all(|pair| pair[1] < pair[0]));
        }
    }
}
