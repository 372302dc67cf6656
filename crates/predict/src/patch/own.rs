//! What an interface has of its own, whatever point and axes its matrices are told in.

use bolted_joint_space::{CentreOfElasticity, PrincipalAxes, PrincipalStiffness, Uncertainty};
use nalgebra::Matrix6 as SquareMatrix;

use super::interface::InterfaceJoint;

/// Centre of elasticity and principal stiffnesses of an interface.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnStiffness {
    /// The point at which a translation and a rotation are coupled symmetrically, and for most interfaces not at all, m.
    pub centre_m: [f64; 3],
    /// How much of translation and rotation is still coupled there, as a part of their stiffnesses.
    pub coupling: f64,
    /// Against translations, ascending, N/m.
    pub translational: [Principal; 3],
    /// Against rotations about that point while forces are held free, ascending, N·m/rad.
    pub rotational: [Principal; 3],
}

/// A principal stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// N/m, N·m/rad.
    pub stiffness: f64,
    /// Its axis, of length 1; none where another one is as large, so that every axis between them is one.
    pub axis: Option<[f64; 3]>,
}

impl InterfaceJoint {
    /// Centre of elasticity and principal stiffnesses; `None` where some motion meets no stiffness at all.
    #[must_use]
    pub fn own_stiffness(&self) -> Option<OwnStiffness> {
        let stiffness = SquareMatrix::from_fn(|i, j| self.stiffness[i][j]);
        let centre = CentreOfElasticity::of(&stiffness, &Uncertainty::None).ok()?;
        let axes = PrincipalAxes::of(&stiffness, &Uncertainty::None).ok()?;
        let [x, y, z] = self.reference_m;
        let offset = centre.offset_m;
        let of = |principal: &[PrincipalStiffness; 3]| {
            principal.each_ref().map(|own| Principal {
                stiffness: own.stiffness,
                axis: own.axis.map(Into::into),
            })
        };
        centre.is_unique().then(|| OwnStiffness {
            centre_m: [x + offset.x, y + offset.y, z + offset.z],
            coupling: centre.relative_coupling,
            translational: of(&axes.translational),
            rotational: of(&axes.rotational),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Contact, NormalDamping};
    use crate::pressure::Element;

    /// Three patches: the centre of the stiffness along the normal and of that along the interface lie apart in the plane, and
    /// where all are alike it is their centroid with the sums and second moments as principal stiffnesses.
    #[test]
    fn alike_patches_have_their_centroid_and_their_moments() {
        let places = [[0.03, 0.0], [-0.01, 0.02], [0.01, -0.05]];
        let elements = places.map(|[x_m, y_m]| Element {
            x_m,
            y_m,
            area_m2: 1e-4,
            pressure_pa: 1e6,
        });
        let contact = Contact {
            normal_stiffness_n_per_m3: 2e12,
            tangential_stiffness_n_per_m3: 1e12,
            ..Contact::default()
        };
        let parts = elements.iter().map(|element| (element, contact));
        let found = InterfaceJoint::new(parts, [0.1, -0.2, 0.05], NormalDamping::Hysteretic)
            .unwrap()
            .own_stiffness()
            .unwrap();
        for (found, expected) in found.centre_m.iter().zip([0.01, -0.01, 0.0]) {
            assert!((found - expected).abs() < 1e-12, "{:?}", found);
        }
        assert!(found.coupling < 1e-9);
        let stiffnesses = found.translational.map(|own| own.stiffness);
        for (found, expected) in stiffnesses.iter().zip([3e8, 3e8, 6e8]) {
            assert!((found / expected - 1.0).abs() < 1e-12);
        }
        // any axis in the plane is one
        assert_eq!(found.translational[0].axis, None);
        assert_eq!(
            found.translational[2].axis.map(|axis| axis[2].abs()),
            Some(1.0)
        );
        // Σ k_t (r_x² + r_y²) about the normal
        let polar: f64 = places
            .iter()
            .map(|[x, y]| 1e8 * ((x - 0.01_f64).powi(2) + (y + 0.01_f64).powi(2)))
            .sum();
        let about_normal = found
            .rotational
            .iter()
            .find(|own| own.axis.is_some_and(|axis| axis[2].abs() > 0.99))
            .unwrap();
        assert!((about_normal.stiffness / polar - 1.0).abs() < 1e-9);
    }
}
