//! The rivets or bolts: where they are, and with what force they press the layers together.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::super::pressure::{Bolt, Reach, ThicknessRatio, Zone, ZoneForce};
use super::beam::LayeredBeam;
use super::error::{LayeredBeamError, positive, value};
use super::normal_force::{normal_force_ratio, zone_radius_ratio};

/// Initial stress of power-driven rivets, Pa (Kavi section 3.5).
pub const RIVET_STRESS_PA: f64 = 100e6;

/// What holds the layers together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FastenerKind {
    /// Power-driven rivets.
    Rivet,
    /// Bolts.
    Bolt,
}

/// What normal force a fastener puts on an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NormalForceRule {
    /// The polynomial pressure of Kavi's (3.32), integrated: 0.895 to 1.279 times the tension.
    #[default]
    Polynomial,
    /// The tension itself: what equilibrium of the clamped layers asks for.
    Tension,
}

/// Equal fasteners along a beam, each through all layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Fasteners {
    kind: FastenerKind,
    diameter_m: f64,
    tension_n: f64,
    positions_m: Vec<f64>,
    rule: NormalForceRule,
}

impl Fasteners {
    /// Rivets of some diameter and initial stress σ₀ (Pa; [`RIVET_STRESS_PA`]) at `positions_m` from the first end.
    ///
    /// # Errors
    /// Diameter or stress are not positive.
    pub fn rivets(
        diameter_m: f64,
        stress_pa: f64,
        positions_m: Vec<f64>,
    ) -> Result<Self, LayeredBeamError> {
        positive("fasteners.diameter", diameter_m, "m")?;
        positive("fasteners.stress", stress_pa, "Pa")?;
        // P = σ₀ π R_v²
        let tension_n = stress_pa * PI * (0.5 * diameter_m).powi(2);
        Ok(Self {
            kind: FastenerKind::Rivet,
            ..Self::bolts(diameter_m, tension_n, positions_m)?
        })
    }

    /// Bolts of some diameter and preload (N) at `positions_m` from the first end.
    ///
    /// # Errors
    /// Diameter or preload are not positive.
    pub fn bolts(
        diameter_m: f64,
        preload_n: f64,
        positions_m: Vec<f64>,
    ) -> Result<Self, LayeredBeamError> {
        positive("fasteners.diameter", diameter_m, "m")?;
        positive("fasteners.preload", preload_n, "N")?;
        Ok(Self {
            kind: FastenerKind::Bolt,
            diameter_m,
            tension_n: preload_n,
            positions_m,
            rule: NormalForceRule::default(),
        })
    }

    /// The same fasteners with another rule for the normal force.
    #[must_use]
    pub fn with_rule(self, rule: NormalForceRule) -> Self {
        Self { rule, ..self }
    }

    /// `count` positions in the middle of as many equal parts of a length, m.
    #[must_use]
    pub fn equispaced(count: usize, length_m: f64) -> Vec<f64> {
        // x_i = L (i − ½)/q
        let at = |i: usize| length_m * (i as f64 + 0.5) / count as f64;
        (0..count).map(at).collect()
    }

    /// `count` positions `pitch_m` apart about the middle of a length, m.
    #[must_use]
    pub fn about_the_middle(count: usize, pitch_m: f64, length_m: f64) -> Vec<f64> {
        // x_i = L/2 + (i − (q + 1)/2) a
        let at = |i: usize| 0.5 * length_m + (i as f64 - 0.5 * (count as f64 - 1.0)) * pitch_m;
        (0..count).map(at).collect()
    }

    /// Rivets or bolts.
    #[must_use]
    pub fn kind(&self) -> FastenerKind {
        self.kind
    }

    /// Tension P in each, N.
    #[must_use]
    pub fn tension_n(&self) -> f64 {
        self.tension_n
    }

    /// Distances from the beam's first end, m.
    #[must_use]
    pub fn positions_m(&self) -> &[f64] {
        &self.positions_m
    }

    /// Normal force N of one fastener on each interface, N.
    ///
    /// # Errors
    /// The thickness ratio of two layers is beyond what the pressure is known for.
    pub fn normal_forces_n(&self, beam: &LayeredBeam) -> Result<Vec<f64>, LayeredBeamError> {
        let ratios = thickness_ratios(beam);
        let of = |(place, ratio): (usize, f64)| {
            let share = normal_force_ratio(ratio).ok_or_else(|| {
                let (first, second) = (place + 1, place + 2);
                value(
                    "beam.layer.thickness",
                    format_args!(
                        "layers {first} and {second} with a thickness ratio of {ratio:.4}"
                    ),
                    "1 to 2: the pressure is known between these ratios",
                )
            });
            Ok(share? * self.tension_n)
        };
        if self.rule == NormalForceRule::Tension {
            return Ok(vec![self.tension_n; ratios.len()]);
        }
        ratios.into_iter().enumerate().map(of).collect()
    }

    /// Σ N (h₁ + h₂) over the interfaces, N·m: what a unit of slope at a fastener slips against, over α′μ.
    ///
    /// # Errors
    /// As [`Fasteners::normal_forces_n`].
    pub fn slip_moment_n_m(&self, beam: &LayeredBeam) -> Result<f64, LayeredBeamError> {
        // h₁ + h₂ is the distance of the middles of two layers; m equal layers give 2h (m − 1) N   (Kavi 3.42, 4.34)
        let forces = self.normal_forces_n(beam)?;
        let pairs = beam.layers().windows(2).zip(forces);
        Ok(pairs
            .map(|(pair, force)| 0.5 * (pair[0].thickness_m + pair[1].thickness_m) * force)
            .sum())
    }

    /// Checks that the fasteners fit the beam.
    ///
    /// # Errors
    /// One is off the beam, or as wide as it, or there is none.
    pub fn check_on(&self, beam: &LayeredBeam) -> Result<(), LayeredBeamError> {
        let length_m = beam.length_m();
        let position = |found: String| {
            let expected = format!("positions between 0 and {length_m} m");
            value("fasteners.positions", found, expected)
        };
        if self.positions_m.is_empty() {
            return Err(position("none".to_owned()));
        }
        let rounding = 1e-9 * length_m;
        let on = |x: f64| x >= -rounding && x <= length_m + rounding;
        if let Some(x) = self.positions_m.iter().find(|&&x| !on(x)) {
            return Err(position(format!("{x} m")));
        }
        if self.diameter_m >= beam.width_m() {
            let (diameter_m, width_m) = (self.diameter_m, beam.width_m());
            let found = format!("{diameter_m} m on a beam {width_m} m wide");
            return Err(value("fasteners.diameter", found, "less than the width"));
        }
        Ok(())
    }

    /// Diameter of the widest zone of pressure, m: 4.125 to 5.6 diameters of a rivet, 3.5 of a bolt.
    #[must_use]
    pub fn zone_diameter_m(&self, beam: &LayeredBeam) -> f64 {
        if self.kind == FastenerKind::Bolt {
            let zone = Zone::Polynomial {
                thickness_ratio: ThicknessRatio::One,
                reach: Reach::Bolts,
                force: ZoneForce::AsPublished,
            };
            return 2.0
                * zone.radius_m(&Bolt {
                    x_m: 0.0,
                    y_m: 0.0,
                    diameter_m: self.diameter_m,
                    preload_n: self.tension_n,
                });
        }
        let ratios = thickness_ratios(beam).into_iter();
        let widest = ratios.filter_map(zone_radius_ratio).fold(0.0, f64::max);
        widest * self.diameter_m
    }
}

/// Thicker over thinner layer at each interface.
fn thickness_ratios(beam: &LayeredBeam) -> Vec<f64> {
    let ratio = |pair: &[super::Layer]| {
        let (a, b) = (pair[0].thickness_m, pair[1].thickness_m);
        a.max(b) / a.min(b)
    };
    beam.layers().windows(2).map(ratio).collect()
}
