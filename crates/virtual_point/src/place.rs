//! Where a sensor sits or the hammer hits, so that a row of R has one origin.

use std::fmt;

use bolted_joint_space::{Axes, Dof};
use nalgebra::{Rotation3, RowVector6, Vector3};

use crate::VirtualPointError;

/// How far the length of a direction may be from one; it is made one within this.
const UNIT: f64 = 1e-6;

/// What a row of R stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A channel of a sensor: a row of the functions
    Channel,
    /// An impact of the hammer: a column of the functions
    Impact,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Channel => "channel",
            Self::Impact => "impact",
        })
    }
}

/// A sensor as a whole, or an impact, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// A sensor with all of its channels, counted from 0
    Sensor(usize),
    /// One channel, counted from 0 through all sensors
    Channel(usize),
    /// An impact, counted from 0
    Impact(usize),
}

impl fmt::Display for Place {
    /// Counted from 1, as people do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sensor(number) => write!(f, "sensor {}", number + 1),
            Self::Channel(number) => write!(f, "channel {}", number + 1),
            Self::Impact(number) => write!(f, "impact {}", number + 1),
        }
    }
}

/// A sensor near the interface, with one channel or three.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor(pub(crate) Body);

impl Sensor {
    /// A sensor with one channel: position from the virtual point (m), unit direction of what it counts as positive,
    /// gain as indicated motion over true motion.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::NotUnit`] (1e-6), [`VirtualPointError::NotFinite`], [`VirtualPointError::Gain`] for 0.
    pub fn uniaxial(
        position_m: Vector3<f64>,
        direction: Vector3<f64>,
        gain: f64,
    ) -> Result<Self, VirtualPointError> {
        Body::new(position_m, vec![direction], vec![gain]).map(Self)
    }

    /// A sensor with three channels that share position and orientation, one along each of its axes. A channel that
    /// reads inverted has a negative gain; mirrored axes are refused where [`Axes`] are made.
    ///
    /// # Errors
    ///
    /// As [`Self::uniaxial`].
    pub fn triaxial(
        position_m: Vector3<f64>,
        axes: &Axes,
        gains: [f64; 3],
    ) -> Result<Self, VirtualPointError> {
        let rows = axes.matrix().row_iter();
        let directions = rows.map(|row| row.transpose()).collect();
        Body::new(position_m, directions, gains.to_vec()).map(Self)
    }

    /// How many channels it has: 1 or 3.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.0.gains.len()
    }

    /// Where it sits, from the virtual point, m.
    #[must_use]
    pub fn position_m(&self) -> Vector3<f64> {
        self.0.position_m
    }
}

/// A hit of the hammer near the interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact(pub(crate) Body);

impl Impact {
    /// Position from the virtual point (m), unit direction of the force, gain as true force over indicated force.
    ///
    /// # Errors
    ///
    /// As [`Sensor::uniaxial`].
    pub fn new(
        position_m: Vector3<f64>,
        direction: Vector3<f64>,
        gain: f64,
    ) -> Result<Self, VirtualPointError> {
        Body::new(position_m, vec![direction], vec![gain]).map(Self)
    }

    /// Where it hits, from the virtual point, m.
    #[must_use]
    pub fn position_m(&self) -> Vector3<f64> {
        self.0.position_m
    }
}

/// What can be wrong with a sensor or an impact, and is the same for all of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Change {
    /// It is elsewhere (m), or turned (rad), as a rigid body with its own point.
    Pose(Dof),
    /// The gain of one of its channels, counted from 0.
    Gain(usize),
}

/// What has rows: a point with one direction or three.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Body {
    position_m: Vector3<f64>,
    directions: Vec<Vector3<f64>>,
    gains: Vec<f64>,
}

impl Body {
    /// The same on the other side of the virtual point along one of its axes.
    pub(crate) fn mirrored(&self, axis: usize) -> Self {
        let mut mirrored = self.clone();
        mirrored.position_m[axis] = -mirrored.position_m[axis];
        mirrored
    }

    fn new(
        position_m: Vector3<f64>,
        directions: Vec<Vector3<f64>>,
        gains: Vec<f64>,
    ) -> Result<Self, VirtualPointError> {
        if !position_m.iter().all(|component| component.is_finite()) {
            let what = "position";
            return Err(VirtualPointError::NotFinite { what });
        }
        for direction in &directions {
            if !direction.iter().all(|component| component.is_finite()) {
                let what = "direction";
                return Err(VirtualPointError::NotFinite { what });
            }
            let length = direction.norm();
            if (length - 1.0).abs() > UNIT {
                let found = (*direction).into();
                return Err(VirtualPointError::NotUnit { found, length });
            }
        }
        for &found in &gains {
            if found == 0.0 || !found.is_finite() {
                return Err(VirtualPointError::Gain { found });
            }
        }
        let directions = directions.iter().map(Vector3::normalize).collect();
        Ok(Self {
            position_m,
            directions,
            gains,
        })
    }

    pub(crate) fn position_m(&self) -> &Vector3<f64> {
        &self.position_m
    }

    /// How many rows it has.
    pub(crate) fn count(&self) -> usize {
        self.gains.len()
    }

    /// Its rows of R: g [dᵀ, (r × d)ᵀ], from d · (u + θ × r) = d · u + (r × d) · θ (van der Seijs et al. 2013).
    pub(crate) fn rows(&self) -> impl Iterator<Item = RowVector6<f64>> {
        let pairs = self.directions.iter().zip(&self.gains);
        pairs.map(|(direction, gain)| row(direction, &self.position_m.cross(direction)) * *gain)
    }

    /// What can be wrong with it: six changes of its pose, then a gain for each row.
    pub(crate) fn changes(&self) -> impl Iterator<Item = Change> {
        let gains = (0..self.count()).map(Change::Gain);
        Dof::ALL.into_iter().map(Change::Pose).chain(gains)
    }

    /// Derivatives of its rows by a change.
    ///
    /// ∂/∂r_k: g [0, (e_k × d)ᵀ]; ∂/∂φ_k, with d′ = e_k × d: g [d′ᵀ, (r × d′)ᵀ]; ∂/∂g: [dᵀ, (r × d)ᵀ].
    pub(crate) fn derivatives(&self, change: Change) -> impl Iterator<Item = RowVector6<f64>> {
        let r = &self.position_m;
        let rows = self.directions.iter().zip(&self.gains).enumerate();
        rows.map(move |(channel, (d, gain))| match change {
            Change::Pose(dof) => {
                let turned = unit_vector(dof).cross(d);
                if dof.is_rotation() {
                    row(&turned, &r.cross(&turned)) * *gain
                } else {
                    row(&Vector3::zeros(), &turned) * *gain
                }
            }
            Change::Gain(changed) if changed == channel => row(d, &r.cross(d)),
            Change::Gain(_) => RowVector6::zeros(),
        })
    }

    /// The body after changes in the order of [`Self::changes`]: shifted, turned by a rotation vector, with other
    /// gains. None for changes that are not as many.
    pub(crate) fn changed(&self, by: &[f64]) -> Option<Self> {
        let (&[x, y, z, rx, ry, rz], gains) = by.split_first_chunk::<6>()?;
        if gains.len() != self.gains.len() {
            return None;
        }
        let turn = Rotation3::from_scaled_axis(Vector3::new(rx, ry, rz));
        let with_changes = self.gains.iter().zip(gains);
        Some(Self {
            position_m: self.position_m + Vector3::new(x, y, z),
            directions: self.directions.iter().map(|d| turn * d).collect(),
            gains: with_changes.map(|(gain, change)| gain + change).collect(),
        })
    }

    /// The first gain that loses the signal.
    pub(crate) fn lost_gain(&self) -> Option<f64> {
        let gains = self.gains.iter().copied();
        gains
            .into_iter()
            .find(|&gain| gain == 0.0 || !gain.is_finite())
    }
}

fn row(translation: &Vector3<f64>, rotation: &Vector3<f64>) -> RowVector6<f64> {
    let (u, t) = (translation, rotation);
    RowVector6::new(u.x, u.y, u.z, t.x, t.y, t.z)
}

/// e_k of the axis along which or about which a motion goes.
fn unit_vector(dof: Dof) -> Vector3<f64> {
    Vector3::ith(dof.index() % 3, 1.0)
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::has;

    use super::*;

    #[test]
    fn what_is_no_place_is_refused() {
        let position = Vector3::new(0.01, 0.02, 0.03);
        let long = Impact::new(position, Vector3::new(0.6, 0.1, 0.8), 1.0).unwrap_err();
        has(
            &long.to_string(),
            &[
                "found (0.6, 0.1, 0.8) of length 1.00498",
                "expected a unit vector",
            ],
        );
        for direction in [Vector3::zeros(), Vector3::x() * 1.00001] {
            let error = Sensor::uniaxial(position, direction, 1.0).unwrap_err();
            assert!(matches!(error, VirtualPointError::NotUnit { .. }));
        }
        for gain in [0.0, f64::NAN, f64::INFINITY] {
            let error = Sensor::triaxial(position, &Axes::identity(), [1.0, gain, 1.0]);
            assert!(
                matches!(error, Err(VirtualPointError::Gain { .. })),
                "{error:?}"
            );
        }
        let nowhere = Vector3::new(0.0, f64::NAN, 0.0);
        for (position, direction, what) in [
            (nowhere, Vector3::x(), "position"),
            (position, nowhere, "direction"),
        ] {
            let error = Sensor::uniaxial(position, direction, 1.0).unwrap_err();
            assert_eq!(error, VirtualPointError::NotFinite { what });
        }
        // a direction of a few digits is made one
        let nearly = Sensor::uniaxial(position, Vector3::new(0.600_000_2, 0.8, 0.0), 1.0);
        assert!((nearly.unwrap().0.directions[0].norm() - 1.0).abs() < 1e-15);
    }
}
