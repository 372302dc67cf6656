//! The part of an interface that a joint file holds: one translation, and with it one rotation, or any motions in space.

use thiserror::Error;

use bolted_joint_dynamics::DofKind;
use bolted_joint_joint::DofSet;

use super::axis::{Axis, SignedAxis};
use super::interface::{InterfaceJoint, Matrix6};
use crate::NumberError;

/// Number of relative motions of an interface.
const COUNT: usize = 6;

/// Which relative motions of an interface become those of the joint file.
///
/// The others are held at zero: the part is a submatrix. In a beam along x that bends in the x–z plane of its interface, `y` is
/// the deflection along z and θ = dw/dx, a rotation about −y. In space the joint file has the interface's own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motions {
    chosen: [Motion; COUNT],
    dofs: DofSet,
}

/// One relative motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motion {
    /// Along which, or about which.
    pub axis: SignedAxis,
    /// Translation or rotation.
    pub kind: DofKind,
}

/// A rotation that leaves the plane of the translation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "found a rotation about the axis of the translation, {0}: expected one about another axis, so that both motions lie in a plane"
)]
pub struct PlanarError(SignedAxis);

/// Matrices of the part of an interface, over its motions.
#[derive(Debug, Clone, PartialEq)]
pub struct PartOfInterface {
    /// K, in N/m, N/rad; N·m/m, N·m/rad.
    pub stiffness: Vec<Vec<f64>>,
    /// C at the frequency of conversion, in the units of K times s.
    pub damping: Vec<Vec<f64>>,
}

impl Motion {
    const fn new(axis: SignedAxis, kind: DofKind) -> Self {
        Self { axis, kind }
    }

    /// Its row in the matrices of the interface.
    fn index(self) -> usize {
        match self.kind {
            DofKind::Translation => self.axis.axis.index(),
            DofKind::Rotation => COUNT / 2 + self.axis.axis.index(),
        }
    }
}

impl Motions {
    /// A translation, and with it a rotation about another axis or none: the joint file's `y` and `theta`.
    ///
    /// # Errors
    /// The rotation is about the axis of the translation.
    pub fn in_plane(
        translation: SignedAxis,
        rotation: Option<SignedAxis>,
    ) -> Result<Self, PlanarError> {
        let mut chosen = [Motion::new(translation, DofKind::Translation); COUNT];
        let dofs = match rotation {
            Some(rotation) if rotation.axis == translation.axis => {
                return Err(PlanarError(rotation));
            }
            Some(rotation) => {
                chosen[1] = Motion::new(rotation, DofKind::Rotation);
                DofSet::TRANSLATION_ROTATION
            }
            None => DofSet::TRANSLATION,
        };
        Ok(Self { chosen, dofs })
    }

    /// Motions in space; y along the interface's y where the set is that of a translation or a translation and a rotation in a
    /// plane.
    #[must_use]
    pub fn in_space(dofs: DofSet) -> Self {
        let all = [DofKind::Translation, DofKind::Rotation].map(|kind| {
            [Axis::X, Axis::Y, Axis::Z].map(|axis| {
                let axis = SignedAxis {
                    axis,
                    is_reversed: false,
                };
                Motion::new(axis, kind)
            })
        });
        let mut chosen = [all[0][0]; COUNT];
        let of_dofs = dofs.rows().filter_map(|dof| {
            let place = DofSet::SPACE.position(dof.name)?;
            all.as_flattened().get(place).copied()
        });
        for (own, motion) in chosen.iter_mut().zip(of_dofs) {
            *own = motion;
        }
        Self { chosen, dofs }
    }

    /// The relative motions that the joint resists.
    #[must_use]
    pub fn dofs(self) -> DofSet {
        self.dofs
    }

    /// Each of them, in the order of the joint's DOFs.
    #[must_use]
    pub fn each(&self) -> &[Motion] {
        &self.chosen[..self.dofs.count()]
    }

    /// What they are, for people: `y along z, theta about -y`.
    #[must_use]
    pub fn described(&self) -> String {
        let each = self.dofs.rows().zip(self.each()).map(|(dof, motion)| {
            let preposition = match motion.kind {
                DofKind::Translation => "along",
                DofKind::Rotation => "about",
            };
            format!("{} {preposition} {}", dof.name, motion.axis)
        });
        each.collect::<Vec<_>>().join(", ")
    }

    /// The joint at the frequency (Hz) at which hysteretic damping is converted.
    ///
    /// # Errors
    /// The frequency is not positive.
    pub fn of(
        self,
        interface: &InterfaceJoint,
        frequency_hz: f64,
    ) -> Result<PartOfInterface, NumberError> {
        Ok(PartOfInterface {
            stiffness: self.part(&interface.stiffness),
            damping: self.part(&interface.viscous_at(frequency_hz)?),
        })
    }

    /// The part of a matrix.
    #[must_use]
    pub fn part(self, matrix: &Matrix6) -> Vec<Vec<f64>> {
        let row = |one: &Motion| {
            let entries = self.each().iter().map(|other| {
                match matrix[one.index()][other.index()] {
                    // no −0
                    0.0 => 0.0,
                    entry if one == other => entry,
                    entry => one.axis.sign() * other.axis.sign() * entry,
                }
            });
            entries.collect()
        };
        self.each().iter().map(row).collect()
    }
}
