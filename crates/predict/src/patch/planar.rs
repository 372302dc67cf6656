//! The part of an interface that a joint file holds: one translation, and with it one rotation.

use thiserror::Error;

use bolted_joint_joint::DofSet;

use super::axis::SignedAxis;
use super::interface::{InterfaceJoint, Matrix6};
use crate::NumberError;

/// Which relative motions become the joint file's `y` and `theta`.
///
/// The others are held at zero: the part is a submatrix. In a beam along x that bends in the x–z plane of its interface, `y` is
/// the deflection along z and θ = dw/dx, a rotation about −y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Planar {
    translation: SignedAxis,
    rotation: Option<SignedAxis>,
}

/// A rotation that leaves the plane of the translation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "found a rotation about the axis of the translation, {0}: expected one about another axis, so that both motions lie in a plane"
)]
pub struct PlanarError(SignedAxis);

/// Matrices of the part of an interface, over `y` or over `y` and `theta`.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarJoint {
    /// K, in N/m, N/rad; N·m/m, N·m/rad.
    pub stiffness: Vec<Vec<f64>>,
    /// C at the frequency of conversion, in the units of K times s.
    pub damping: Vec<Vec<f64>>,
}

impl Planar {
    /// A translation, and with it a rotation about another axis or none.
    ///
    /// # Errors
    /// The rotation is about the axis of the translation.
    pub fn new(translation: SignedAxis, rotation: Option<SignedAxis>) -> Result<Self, PlanarError> {
        match rotation {
            Some(rotation) if rotation.axis == translation.axis => Err(PlanarError(rotation)),
            _ => Ok(Self {
                translation,
                rotation,
            }),
        }
    }

    /// The relative motions that the joint resists.
    #[must_use]
    pub fn dofs(self) -> DofSet {
        match self.rotation {
            Some(_) => DofSet::TRANSLATION_ROTATION,
            None => DofSet::TRANSLATION,
        }
    }

    /// The translation that is `y`.
    #[must_use]
    pub fn translation(self) -> SignedAxis {
        self.translation
    }

    /// The rotation that is `theta`.
    #[must_use]
    pub fn rotation(self) -> Option<SignedAxis> {
        self.rotation
    }

    /// The joint at the frequency (Hz) at which hysteretic damping is converted.
    ///
    /// # Errors
    /// The frequency is not positive.
    pub fn of(
        self,
        interface: &InterfaceJoint,
        frequency_hz: f64,
    ) -> Result<PlanarJoint, NumberError> {
        Ok(PlanarJoint {
            stiffness: self.part(&interface.stiffness),
            damping: self.part(&interface.viscous_at(frequency_hz)?),
        })
    }

    /// The part of a matrix.
    #[must_use]
    pub fn part(self, matrix: &Matrix6) -> Vec<Vec<f64>> {
        let rotation = self
            .rotation
            .map(|axis| (3 + axis.axis.index(), axis.sign()));
        let translation = (self.translation.axis.index(), self.translation.sign());
        let chosen: Vec<(usize, f64)> = std::iter::once(translation).chain(rotation).collect();
        chosen
            .iter()
            .map(|&(i, sign)| {
                let row = chosen.iter();
                row.map(|&(j, other)| match matrix[i][j] {
                    // no −0
                    0.0 => 0.0,
                    entry if i == j => entry,
                    entry => sign * other * entry,
                })
                .collect()
            })
            .collect()
    }
}
