//! A joint as fewer DOFs see it: the planar models that beams are measured with are parts of a joint in space.
//!
//! What such a part is depends on what the other motions do. A test in a plane finds neither of both, unless planes of
//! symmetry keep the other motions at rest.

use nalgebra::{ComplexField, DMatrix, Matrix6};

use crate::elimination::{equilibrating, solved};
use crate::{Dof, SpaceError};

/// What the relative motions do that are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Others {
    /// They are zero; the loads that this takes are borne elsewhere.
    Held,
    /// They follow without load. Never stiffer than held.
    Free,
}

/// A joint's matrix for some of its DOFs, in the order given.
///
/// A joint with damping or inertia is condensed as D(ω) ([`JointMatrices::dynamic`](crate::JointMatrices::dynamic))
/// when others are free: K and C condensed apart are not its stiffness and damping.
///
/// # Errors
///
/// [`SpaceError::TooFew`] without DOFs, [`SpaceError::Twice`] for one that stands twice, [`SpaceError::NotFinite`] for a
/// matrix that holds no number, [`SpaceError::NothingBears`] where free DOFs are loaded without stiffness.
pub fn condensed<T>(
    matrix: &Matrix6<T>,
    kept: &[Dof],
    others: Others,
) -> Result<DMatrix<T>, SpaceError>
where
    T: ComplexField<RealField = f64> + Copy,
{
    if kept.is_empty() {
        return Err(SpaceError::TooFew {
            what: "DOFs to keep",
            found: 0,
            least: 1,
        });
    }
    if let Some((_, &dof)) = kept
        .iter()
        .enumerate()
        .find(|(at, dof)| kept[..*at].contains(dof))
    {
        return Err(SpaceError::Twice { dof });
    }
    if !matrix.iter().all(|number| number.is_finite()) {
        return Err(SpaceError::NotFinite {
            what: "the joint's matrix",
        });
    }
    let held = part(matrix, kept, kept);
    let free: Vec<Dof> = Dof::ALL
        .into_iter()
        .filter(|dof| !kept.contains(dof))
        .collect();
    if others == Others::Held || free.is_empty() {
        return Ok(held);
    }
    // K_pp − K_pf K_ff⁻¹ K_fp (Guyan 1965), scaled so that the rank of K_ff does not depend on units
    let scales = equilibrating(&DMatrix::from_fn(6, 6, |i, j| matrix[(i, j)]));
    let [by_free, by_kept] = [&free, kept].map(|dofs: &[Dof]| {
        DMatrix::from_fn(free.len(), dofs.len(), |i, j| {
            let (row, column) = (free[i].index(), dofs[j].index());
            matrix[(row, column)] * T::from_real(scales[row] * scales[column])
        })
    });
    let following = solved(by_free, by_kept).ok_or(SpaceError::NothingBears)?;
    let to_kept = part(matrix, kept, &free);
    let released = DMatrix::from_fn(free.len(), kept.len(), |i, j| {
        let scale = scales[free[i].index()] / scales[kept[j].index()];
        following[(i, j)] * T::from_real(scale)
    });
    Ok(held - to_kept * released)
}

fn part<T>(matrix: &Matrix6<T>, rows: &[Dof], columns: &[Dof]) -> DMatrix<T>
where
    T: ComplexField<RealField = f64> + Copy,
{
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
        matrix[(rows[i].index(), columns[j].index())]
    })
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::close;
    use nalgebra::{SymmetricEigen, Vector3};
    use num_complex::Complex64;

    use super::*;
    use crate::samples::{check_stiffness, definite};
    use crate::{JointMatrices, transported};

    #[test]
    fn the_check_values_hold() {
        let at_q = transported(&check_stiffness(), &Vector3::new(0.01, -0.02, 0.03));
        let free = condensed(&at_q, &[Dof::Y, Dof::Rz], Others::Free).unwrap();
        let expected = [
            4_196_428.571_428_571,
            -41_964.285_714_285_71,
            -41_964.285_714_285_71,
            8_411.642_857_142_857,
        ];
        for (found, expected) in free.iter().zip(expected) {
            close(*found, expected, 1e-10);
        }
        let held = condensed(&at_q, &[Dof::Y, Dof::Rz], Others::Held).unwrap();
        for (found, expected) in held.iter().zip([3e7, -3e5, -3e5, 19_000.0]) {
            close(*found, expected, 1e-10);
        }
    }

    /// Free others are the inverse of a part of the compliance; holding them adds stiffness.
    #[test]
    fn free_is_the_inverse_of_the_compliance_and_softer() {
        for (seed, kept) in [
            (1, vec![Dof::Y, Dof::Rx]),
            (2, vec![Dof::Rz]),
            (3, vec![Dof::Rz, Dof::X, Dof::Ry]),
            (4, Dof::ALL.to_vec()),
        ] {
            let stiffness = definite(seed);
            let compliance = stiffness.try_inverse().unwrap();
            let free = condensed(&stiffness, &kept, Others::Free).unwrap();
            let expected = part(&compliance, &kept, &kept).try_inverse().unwrap();
            assert!(
                (&free - &expected).norm() < 1e-12 * expected.norm(),
                "{kept:?}"
            );
            let held = condensed(&stiffness, &kept, Others::Held).unwrap();
            let less = SymmetricEigen::new(&held - &free).eigenvalues.min();
            assert!(less > -1e-9 * held.norm(), "{kept:?}: {less}");
        }
    }

    /// With damping, by the compliance at ω; K and C apart would be wrong.
    #[test]
    fn damping_is_condensed_with_the_stiffness() {
        let joint = JointMatrices::massless(definite(5), definite(6) * 1e-4);
        let (omega, kept) = (2.0 * std::f64::consts::PI * 500.0, [Dof::Y, Dof::Rx]);
        let found = condensed(&joint.dynamic(omega), &kept, Others::Free).unwrap();
        let compliance = joint.dynamic(omega).try_inverse().unwrap();
        let expected = part(&compliance, &kept, &kept).try_inverse().unwrap();
        assert!((&found - &expected).norm() < 1e-12 * expected.norm());
        let [k, c] = [joint.stiffness, joint.damping]
            .map(|matrix| condensed(&matrix, &kept, Others::Free).unwrap());
        let apart = k.zip_map(&c, |k, c| Complex64::new(k, omega * c));
        assert!((&apart - &expected).norm() > 1e-2 * expected.norm());
    }

    #[test]
    fn motions_without_stiffness_are_no_special_case() {
        // Only translations, at a point that is not the centre: rank 3 and coupled
        let mut translations = Matrix6::zeros();
        translations
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from_slice(&[2e7, 1e6, 0.0, 1e6, 3e7, 0.0, 0.0, 0.0, 5e7]);
        let moved = transported(&translations, &Vector3::new(0.01, 0.02, -0.03));
        let kept = [Dof::X, Dof::Y, Dof::Z];
        // Whatever it does, a rotation about some other point brings these three translations to zero or leaves one: by
        // compliance with a faint stiffness against rotation
        let faint = moved
            + Matrix6::from_diagonal(&nalgebra::Vector6::new(0.0, 0.0, 0.0, 1e-3, 1e-3, 1e-3));
        let expected = condensed(&faint, &kept, Others::Free).unwrap();
        let found = condensed(&moved, &kept, Others::Free).unwrap();
        assert!(
            (&found - &expected).norm() < 1e-6 * moved.norm(),
            "{found} {expected}"
        );
        let none = condensed(&Matrix6::<f64>::zeros(), &kept, Others::Free).unwrap();
        assert_eq!(none.abs().max(), 0.0);
    }

    #[test]
    fn what_cannot_be_condensed_is_refused() {
        let unborne = crate::Entry::new(Dof::X, Dof::Ry).unit();
        assert_eq!(
            condensed(&unborne, &[Dof::X], Others::Free),
            Err(SpaceError::NothingBears)
        );
        let stiffness = check_stiffness();
        let twice = condensed(&stiffness, &[Dof::X, Dof::Y, Dof::X], Others::Held);
        assert_eq!(twice, Err(SpaceError::Twice { dof: Dof::X }));
        assert!(matches!(
            condensed(&stiffness, &[], Others::Held),
            Err(SpaceError::TooFew {
                found: 0,
                least: 1,
                ..
            })
        ));
        let broken = stiffness.map(|k| if k == 1e5 { f64::NAN } else { k });
        assert!(matches!(
            condensed(&broken, &[Dof::X], Others::Free),
            Err(SpaceError::NotFinite { .. })
        ));
    }
}
