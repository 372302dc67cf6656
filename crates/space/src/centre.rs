//! The centre of elasticity: the point at which a force turns a joint as little as it can.
//!
//! At this point the coupling of translations and rotations is symmetric. It vanishes only if the joint is decoupled
//! there; a joint in space need not be decoupled anywhere.

use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3};

use crate::uncertainty::APART;
use crate::{Entry, SpaceError, Uncertainty, symmetry, transported};

/// Stiffnesses below this share of the largest one count as zero, where deviations say nothing.
const NOTHING: f64 = 1e-12;

/// Couplings below this share of √(‖K_tt‖ ‖K_rr‖) are rounding.
const ROUNDING: f64 = 1e-14;

/// Where a joint's centre of elasticity is, and how translations and rotations are coupled there.
#[derive(Clone, Debug, PartialEq)]
pub struct CentreOfElasticity {
    /// From the point of the matrix to the centre, m; to the nearest of the centres if it is not unique.
    pub offset_m: Vector3<f64>,
    /// Standard deviation of the offset's components, m, if errors of the matrix are known.
    pub deviation_m: Option<Vector3<f64>>,
    /// Directions along which the centre may be moved, since no stiffness fixes it: none if it is unique, the line's
    /// direction if there is stiffness along one axis alone, three without any stiffness of translations.
    pub free_directions: Vec<Vector3<f64>>,
    /// Symmetric part of K_tr at the centre, N: what no choice of the point takes away.
    pub coupling: Matrix3<f64>,
    /// Size of that coupling beside √(‖K_tt‖ ‖K_rr‖) at the centre, Frobenius norms: 0 for a decoupled joint, at most
    /// √3.
    pub relative_coupling: f64,
    /// Size of that coupling beside K_tr at the given point, largest entries; None if that is zero.
    pub share_of_given: Option<f64>,
    /// Size of what is left of the antisymmetric part, as `relative_coupling`: zero up to rounding for a passive joint.
    pub relative_antisymmetric: f64,
}

impl CentreOfElasticity {
    /// The centre of a symmetric stiffness (or C, M, for their centres).
    ///
    /// # Errors
    ///
    /// [`SpaceError::NotSymmetric`], [`SpaceError::NotFinite`]; [`SpaceError::Size`] or [`SpaceError::Value`] for an
    /// uncertainty that is none.
    pub fn of(stiffness: &Matrix6<f64>, uncertainty: &Uncertainty) -> Result<Self, SpaceError> {
        symmetry::checked(stiffness)?;
        uncertainty.checked()?;
        // K_tr + K_tt [d]× is symmetric where (tr(K_tt) I − K_tt) d = −v, v the axial vector of K_tr − K_trᵀ
        let eigen = SymmetricEigen::new(spin(stiffness));
        let largest = eigen.eigenvalues.amax();
        let mut inverse = Matrix3::zeros();
        let mut free_directions = Vec::new();
        for (mu, direction) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            let direction = direction.into_owned();
            let by_numbers =
                Entry::ALL.map(|entry| direction.dot(&(spin(&entry.unit()) * direction)));
            let blurred = uncertainty
                .deviation(&by_numbers)
                .is_some_and(|deviation| mu.abs() <= APART * deviation);
            if blurred || mu.abs() <= NOTHING * largest {
                free_directions.push(direction);
            } else {
                inverse += direction * direction.transpose() / *mu;
            }
        }
        let offset_m = -(inverse * axial(stiffness));
        let moved = transported(stiffness, &offset_m);
        let at_centre = block(&moved, 0, 3);
        let coupling = (at_centre + at_centre.transpose()) * 0.5;
        let translations = block(stiffness, 0, 0).norm();
        let [given_rotations, rotations] =
            [stiffness, &moved].map(|matrix| block(matrix, 3, 3).norm());
        // Where a line of springs has no rotational stiffness on its own line, rounding is not set in relation to
        // rounding.
        let least = ROUNDING * (translations * given_rotations.max(rotations)).sqrt();
        let beside = |part: f64| {
            if part > least {
                part / (translations * rotations).sqrt()
            } else {
                0.0
            }
        };
        let given = block(stiffness, 0, 3).amax();
        Ok(Self {
            deviation_m: deviation_of(&inverse, &offset_m, uncertainty),
            offset_m,
            free_directions,
            coupling,
            relative_coupling: beside(coupling.norm()),
            share_of_given: (given > 0.0).then(|| coupling.amax() / given),
            relative_antisymmetric: beside((at_centre - coupling).norm()),
        })
    }

    /// Whether there is one such point: stiffness along two axes at least.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        self.free_directions.is_empty()
    }
}

/// tr(K_tt) I − K_tt
fn spin(stiffness: &Matrix6<f64>) -> Matrix3<f64> {
    let translations = block(stiffness, 0, 0);
    Matrix3::identity() * translations.trace() - translations
}

/// v = (N₃₂ − N₂₃, N₁₃ − N₃₁, N₂₁ − N₁₂) of N = K_tr
fn axial(stiffness: &Matrix6<f64>) -> Vector3<f64> {
    let n = block(stiffness, 0, 3);
    Vector3::new(
        n[(2, 1)] - n[(1, 2)],
        n[(0, 2)] - n[(2, 0)],
        n[(1, 0)] - n[(0, 1)],
    )
}

/// dd = −G⁻¹ (dv + dG d), G = tr(K_tt) I − K_tt, for each number of the matrix.
fn deviation_of(
    inverse: &Matrix3<f64>,
    offset_m: &Vector3<f64>,
    uncertainty: &Uncertainty,
) -> Option<Vector3<f64>> {
    let by_numbers = Entry::ALL.map(|entry| {
        let unit = entry.unit();
        -(inverse * (axial(&unit) + spin(&unit) * offset_m))
    });
    let [x, y, z] = [0, 1, 2].map(|axis| uncertainty.deviation(&by_numbers.map(|by| by[axis])));
    Some(Vector3::new(x?, y?, z?))
}

pub(crate) fn block(matrix: &Matrix6<f64>, row: usize, column: usize) -> Matrix3<f64> {
    matrix.fixed_view::<3, 3>(row, column).into_owned()
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, near};

    use super::*;
    use crate::samples::{check_stiffness, definite, scattered};
    use crate::{Axes, numbers, rotated, symmetric};

    fn of(stiffness: &Matrix6<f64>) -> CentreOfElasticity {
        CentreOfElasticity::of(stiffness, &Uncertainty::None).unwrap()
    }

    /// With the coupling of z and rz left over: 2e4 N at a centre where K_x_ry and K_y_rx are 4e4 N.
    #[test]
    fn the_check_values_hold() {
        let centre = of(&check_stiffness());
        assert!((centre.offset_m - Vector3::new(0.0, 0.0, 0.003)).norm() < 1e-12);
        assert!(centre.is_unique());
        let offset = Vector3::new(0.01, -0.02, 0.03);
        let from_q = of(&transported(&check_stiffness(), &offset));
        assert!((from_q.offset_m - Vector3::new(-0.01, 0.02, -0.027)).norm() < 1e-12);
        let expected = Matrix3::new(0.0, 4e4, 0.0, 4e4, 0.0, 0.0, 0.0, 0.0, 2e4);
        assert!(
            (centre.coupling - expected).amax() < 1e-8,
            "{}",
            centre.coupling
        );
        assert!(
            (from_q.coupling - expected).amax() < 1e-7,
            "{}",
            from_q.coupling
        );
        close(centre.share_of_given.unwrap(), 0.4, 1e-10);
        close(from_q.relative_coupling, centre.relative_coupling, 1e-12);
        assert!(centre.relative_antisymmetric < 1e-15);
    }

    #[test]
    fn the_coupling_is_symmetric_at_the_centre_of_any_joint() {
        for seed in 0..20 {
            let stiffness = definite(seed);
            let centre = of(&stiffness);
            assert!(centre.is_unique() && centre.relative_antisymmetric < 1e-15);
            assert!(centre.relative_coupling < 3.0_f64.sqrt());
            let at_centre = block(&transported(&stiffness, &centre.offset_m), 0, 3);
            assert!(
                (at_centre - at_centre.transpose()).amax()
                    < 1e-14 * at_centre.amax().max(stiffness.amax() * 1e-3)
            );
            // it is a vector of the body: it turns with the axes
            let axes = Axes::with_z_along(&Vector3::from(scattered::<3>(seed))).unwrap();
            let turned = of(&rotated(&stiffness, &axes)).offset_m;
            assert!(
                (turned - axes.matrix() * centre.offset_m).norm() < 1e-13 * centre.offset_m.norm()
            );
        }
    }

    #[test]
    fn a_decoupled_joint_is_found_again_where_it_was() {
        let mut decoupled = definite(3);
        decoupled.fixed_view_mut::<3, 3>(0, 3).fill(0.0);
        decoupled.fixed_view_mut::<3, 3>(3, 0).fill(0.0);
        let offset = Vector3::new(0.03, -0.02, 0.05);
        let centre = of(&transported(&decoupled, &offset));
        assert!((centre.offset_m + offset).norm() < 1e-15 && centre.relative_coupling < 1e-14);
        assert_eq!(of(&decoupled).share_of_given, None);
    }

    #[test]
    fn a_spring_along_one_axis_has_a_line_of_centres() {
        let direction = Vector3::new(1.0, 2.0, -2.0) / 3.0;
        let mut spring = Matrix6::zeros();
        spring
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(direction * direction.transpose() * 1e7));
        let offset = Vector3::new(0.02, 0.03, 0.1);
        let centre = of(&transported(&spring, &offset));
        assert!(!centre.is_unique());
        let [free] = centre.free_directions[..] else {
            panic!("{:?}", centre.free_directions)
        };
        near(free.dot(&direction).abs(), 1.0, 1e-14);
        // the foot of the perpendicular from the point on the spring's line
        let nearest = -offset + direction * direction.dot(&offset);
        assert!(
            (centre.offset_m - nearest).norm() < 1e-15,
            "{}",
            centre.offset_m
        );
        assert!(centre.relative_antisymmetric < 1e-12);
        // two axes fix it
        let mut two = spring;
        two[(0, 0)] += 1e5;
        assert!(of(&transported(&two, &offset)).is_unique());
        // none leaves everything open
        let nowhere = of(&Matrix6::zeros());
        assert_eq!(
            (nowhere.free_directions.len(), nowhere.offset_m),
            (3, Vector3::zeros())
        );
        let mut rotations = Matrix6::zeros();
        rotations.fixed_view_mut::<3, 3>(3, 3).fill_diagonal(1e3);
        assert_eq!(of(&rotations).free_directions.len(), 3);
    }

    /// The deviation by differences of the centre; a transverse stiffness that its deviation hides leaves the centre
    /// open.
    #[test]
    fn deviations_are_those_of_differences() {
        let stiffness = definite(8);
        let given = numbers(&stiffness);
        let deviations = scattered::<21>(9).map(|d| 1e-3 * d.abs());
        let sized: [f64; 21] = std::array::from_fn(|n| {
            let Entry { row, column } = Entry::ALL[n];
            let diagonal =
                stiffness[(row.index(), row.index())] * stiffness[(column.index(), column.index())];
            deviations[n] * diagonal.sqrt()
        });
        let mut variance = Vector3::zeros();
        for n in 0..21 {
            let [more, less] = [1e-3, -1e-3].map(|step| {
                let mut changed = given;
                changed[n] += step * sized[n];
                of(&symmetric(&changed)).offset_m
            });
            variance += ((more - less) / 2e-3).map(|change| change * change);
        }
        let found = CentreOfElasticity::of(&stiffness, &Uncertainty::Deviations(sized)).unwrap();
        let deviation = found.deviation_m.unwrap();
        for axis in 0..3 {
            close(deviation[axis], variance[axis].sqrt(), 1e-6);
        }
        let mut hidden = Matrix6::zeros();
        hidden
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from_slice(&[1e3, 0.0, 0.0, 0.0, 1e3, 0.0, 0.0, 0.0, 1e7]);
        let errors = Uncertainty::Deviations([1e3; 21]);
        assert!(of(&hidden).is_unique());
        let blurred = CentreOfElasticity::of(&hidden, &errors).unwrap();
        assert_eq!(blurred.free_directions.len(), 1);
        near(blurred.free_directions[0].z.abs(), 1.0, 1e-12);
    }
}
