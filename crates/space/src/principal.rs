//! A joint's own axes: along them a force moves it straight, about them a moment turns it straight.
//!
//! Where two stiffnesses agree every direction between their axes is as good; noise would choose one, so none is given.

use nalgebra::{DMatrix, Matrix3, Matrix6, SymmetricEigen, Vector3, Vector6};

use crate::centre::block;
use crate::elimination::solved;
use crate::uncertainty::{APART, of_square};
use crate::{SpaceError, Uncertainty, symmetry};

/// Eigenvalues nearer than this share of the largest entry agree, where deviations say nothing.
const SAME: f64 = 1e-10;

/// One of three stiffnesses at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalStiffness {
    /// N/m or N·m/rad
    pub stiffness: f64,
    /// Its standard deviation, if errors of the matrix are known.
    pub deviation: Option<f64>,
    /// Unit vector, its largest component positive; none if another stiffness agrees with this one.
    pub axis: Option<Vector3<f64>>,
}

/// Principal stiffnesses of a joint, ascending. None of them depends on the point that the matrix is told at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// Eigenvalues of K_tt: rotations held.
    pub translational: [PrincipalStiffness; 3],
    /// Eigenvalues of K_rr − K_rt K_tt⁻¹ K_tr: translations free.
    pub rotational: [PrincipalStiffness; 3],
}

impl PrincipalAxes {
    /// The axes of a symmetric stiffness (or C).
    ///
    /// Two stiffnesses agree if they differ by no more than 2.45 standard deviations of their difference: of a pair
    /// that is equal one in twenty differs by more.
    ///
    /// # Errors
    ///
    /// [`SpaceError::NotSymmetric`], [`SpaceError::NotFinite`]; [`SpaceError::NothingBears`] where rotations load
    /// translations without stiffness; [`SpaceError::Size`] or [`SpaceError::Value`] for an uncertainty that is none.
    pub fn of(stiffness: &Matrix6<f64>, uncertainty: &Uncertainty) -> Result<Self, SpaceError> {
        symmetry::checked(stiffness)?;
        uncertainty.checked()?;
        let translations = block(stiffness, 0, 0);
        // G = K_tt⁻¹ K_tr: −G θ is how the joint gives way when it is turned by θ
        let yielding = yielding(&translations, &block(stiffness, 0, 3))?;
        let rotations = block(stiffness, 3, 3);
        let free = rotations - block(stiffness, 3, 0) * yielding;
        let straight = |v: &Vector3<f64>| Vector6::new(v.x, v.y, v.z, 0.0, 0.0, 0.0);
        // The energy is stationary in how it gives way: d(vᵀ K_free v) = wᵀ dK w with w = (−G v, v)
        let turned = |v: &Vector3<f64>| {
            let u = -(yielding * v);
            Vector6::new(u.x, u.y, u.z, v.x, v.y, v.z)
        };
        Ok(Self {
            translational: principal(&translations, translations.amax(), straight, uncertainty),
            rotational: principal(&free, rotations.amax(), turned, uncertainty),
        })
    }
}

fn yielding(
    translations: &Matrix3<f64>,
    coupling: &Matrix3<f64>,
) -> Result<Matrix3<f64>, SpaceError> {
    let (size, loads) = (translations.amax(), coupling.amax());
    if loads == 0.0 {
        return Ok(Matrix3::zeros());
    }
    if size == 0.0 {
        return Err(SpaceError::NothingBears);
    }
    let left = DMatrix::from_fn(3, 3, |i, j| translations[(i, j)] / size);
    let right = DMatrix::from_fn(3, 3, |i, j| coupling[(i, j)] / loads);
    let solution = solved(left, right).ok_or(SpaceError::NothingBears)?;
    Ok(Matrix3::from_fn(|i, j| solution[(i, j)] * (loads / size)))
}

fn principal(
    matrix: &Matrix3<f64>,
    size: f64,
    motion: impl Fn(&Vector3<f64>) -> Vector6<f64>,
    uncertainty: &Uncertainty,
) -> [PrincipalStiffness; 3] {
    let eigen = SymmetricEigen::new((matrix + matrix.transpose()) * 0.5);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.map(|i| eigen.eigenvalues[i]);
    let axes = order.map(|i| pointed(eigen.eigenvectors.column(i).into_owned()));
    let gradients = axes.map(|axis| of_square(&motion(&axis)));
    std::array::from_fn(|i| {
        let agrees = |j: usize| {
            let difference: [f64; 21] = std::array::from_fn(|n| gradients[i][n] - gradients[j][n]);
            let blur = uncertainty
                .deviation(&difference)
                .map_or(0.0, |deviation| APART * deviation);
            (values[i] - values[j]).abs() <= blur.max(SAME * size)
        };
        PrincipalStiffness {
            stiffness: values[i],
            deviation: uncertainty.deviation(&gradients[i]),
            axis: (0..3).all(|j| j == i || !agrees(j)).then_some(axes[i]),
        }
    })
}

/// The same axis, its largest component positive.
fn pointed(axis: Vector3<f64>) -> Vector3<f64> {
    if axis[axis.iamax()] < 0.0 {
        -axis
    } else {
        axis
    }
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::close;

    use super::*;
    use crate::samples::{definite, scattered};
    use crate::{Axes, Entry, numbers, rotated, symmetric, transported};

    fn of(stiffness: &Matrix6<f64>) -> PrincipalAxes {
        PrincipalAxes::of(stiffness, &Uncertainty::None).unwrap()
    }

    /// A decoupled joint with axes of its own, turned and moved: what was put in comes out.
    #[test]
    fn known_axes_are_found_wherever_the_matrix_is_told() {
        let axes = Axes::with_z_along(&Vector3::new(0.2, -0.5, 0.7)).unwrap();
        let own = Matrix6::from_diagonal(&Vector6::new(1e7, 2e7, 5e7, 3e3, 9e3, 6e3));
        let told = rotated(&own, &axes.inverse());
        for offset in [Vector3::zeros(), Vector3::new(0.02, 0.05, -0.03)] {
            let found = of(&transported(&told, &offset));
            for (principal, (expected, row)) in
                found
                    .translational
                    .iter()
                    .zip([(1e7, 0), (2e7, 1), (5e7, 2)])
            {
                close(principal.stiffness, expected, 1e-12);
                let axis = axes.matrix().row(row).transpose();
                assert!(principal.axis.unwrap().cross(&axis).norm() < 1e-12);
                assert_eq!(principal.deviation, None);
            }
            for (principal, (expected, row)) in
                found.rotational.iter().zip([(3e3, 0), (6e3, 2), (9e3, 1)])
            {
                close(principal.stiffness, expected, 1e-9);
                let axis = axes.matrix().row(row).transpose();
                assert!(principal.axis.unwrap().cross(&axis).norm() < 1e-9);
            }
        }
    }

    /// The rotational ones are those of the compliance's inverse, at every point.
    #[test]
    fn rotational_stiffness_is_that_of_a_pure_moment() {
        for seed in 0..10 {
            let stiffness = definite(seed);
            let compliance = stiffness.try_inverse().unwrap();
            let mut expected: Vec<f64> = SymmetricEigen::new(block(&compliance, 3, 3))
                .eigenvalues
                .iter()
                .map(|e| e.recip())
                .collect();
            expected.sort_by(f64::total_cmp);
            let moved = transported(&stiffness, &Vector3::from(scattered::<3>(seed + 50)));
            for found in [of(&stiffness), of(&moved)] {
                for (principal, expected) in found.rotational.iter().zip(&expected) {
                    close(principal.stiffness, *expected, 1e-8);
                }
            }
        }
    }

    #[test]
    fn a_joint_round_about_an_axis_has_that_axis_alone() {
        let stiffness = Matrix6::from_diagonal(&Vector6::new(2e7, 2e7, 5e7, 4e3, 4e3, 1e3));
        let axes = Axes::with_z_along(&Vector3::new(1.0, 2.0, 2.0)).unwrap();
        let found = of(&rotated(&stiffness, &axes.inverse()));
        let [a, b, c] = found.translational.map(|principal| principal.axis);
        assert_eq!((a, b), (None, None));
        assert!((c.unwrap() - Vector3::new(1.0, 2.0, 2.0) / 3.0).norm() < 1e-14);
        let [a, b, c] = found.rotational.map(|principal| principal.axis);
        assert!((a.unwrap() - Vector3::new(1.0, 2.0, 2.0) / 3.0).norm() < 1e-14);
        assert_eq!((b, c), (None, None));
        let ball = Matrix6::identity();
        assert!(
            of(&ball)
                .translational
                .iter()
                .all(|principal| principal.axis.is_none())
        );
    }

    /// By differences of the eigenvalues, with errors that are correlated.
    #[test]
    fn deviations_are_those_of_differences() {
        let stiffness = definite(2);
        let given = numbers(&stiffness);
        let sizes = Entry::ALL.map(|Entry { row, column }| {
            (stiffness[(row.index(), row.index())] * stiffness[(column.index(), column.index())])
                .sqrt()
        });
        let root = DMatrix::from_fn(21, 21, |i, j| {
            sizes[i] * 1e-3 * scattered::<21>(i as u64)[j]
        });
        let covariance = &root * root.transpose();
        let by_difference = DMatrix::from_fn(6, 21, |which, n| {
            let [more, less] = [1e-6, -1e-6].map(|step| {
                let mut changed = given;
                changed[n] += step * sizes[n];
                let found = of(&symmetric(&changed));
                [found.translational, found.rotational].concat()[which].stiffness
            });
            (more - less) / (2e-6 * sizes[n])
        });
        let expected = &by_difference * &covariance * by_difference.transpose();
        let found = PrincipalAxes::of(&stiffness, &Uncertainty::Covariance(covariance)).unwrap();
        for (which, principal) in [found.translational, found.rotational]
            .concat()
            .iter()
            .enumerate()
        {
            close(
                principal.deviation.unwrap(),
                expected[(which, which)].sqrt(),
                1e-5,
            );
        }
    }

    /// Two equal stiffnesses under noise: 5 % of the runs may name an axis (2000 runs scatter by 0.5 %).
    #[test]
    fn noise_does_not_choose_an_axis() {
        let sure = Matrix6::from_diagonal(&Vector6::new(2e7, 2e7, 5e7, 4e3, 6e3, 8e3));
        let mut deviations = [0.0; 21];
        // an error that is alike in all directions of the plane: dk_xy has 1/√2 of the deviation of dk_xx
        for (entry, deviation) in Entry::ALL.iter().zip(&mut deviations) {
            *deviation = match (entry.row.index(), entry.column.index()) {
                (0, 0) | (1, 1) => 2e5,
                (0, 1) => 2e5 / 2.0_f64.sqrt(),
                _ => 0.0,
            };
        }
        let runs = 2000;
        let named = (0..runs).filter(|&run| {
            let uniform = scattered::<42>(run).map(|number| 0.5 * (number + 1.0));
            let mut noisy = numbers(&sure);
            for n in 0..21 {
                // Box and Muller 1958
                let normal = (-2.0 * (1.0 - uniform[n]).ln()).sqrt()
                    * (2.0 * std::f64::consts::PI * uniform[n + 21]).cos();
                noisy[n] += deviations[n] * normal;
            }
            let found = PrincipalAxes::of(&symmetric(&noisy), &Uncertainty::Deviations(deviations))
                .unwrap();
            assert!(found.translational[2].axis.is_some());
            found.translational[0].axis.is_some()
        });
        let share = named.count() as f64 / runs as f64;
        assert!((0.035..0.065).contains(&share), "{share}");
    }

    #[test]
    fn rotations_that_load_what_bears_nothing_are_refused() {
        let unborne = Entry::new(crate::Dof::X, crate::Dof::Ry).unit();
        assert_eq!(
            PrincipalAxes::of(&unborne, &Uncertainty::None),
            Err(SpaceError::NothingBears)
        );
        // one translation bears all that loads it
        let mut spring = Matrix6::zeros();
        spring[(2, 2)] = 1e7;
        let moved = transported(&spring, &Vector3::new(0.1, 0.2, 0.0));
        let found = of(&moved);
        assert!(
            found
                .rotational
                .iter()
                .all(|principal| principal.stiffness.abs() < 1e-9 * moved[(3, 3)])
        );
        close(found.translational[2].stiffness, 1e7, 1e-12);
    }
}
