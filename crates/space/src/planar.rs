//! Joints in space beside joints of a planar beam, whose rotation θ is the slope of its deflection y.

use nalgebra::{ComplexField, Matrix2, Matrix6};

use crate::{Dof, Others, SpaceError, condensed};

/// The axis along which a beam runs that bends along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BeamAlong {
    /// θ = dy/dx = rz
    X,
    /// θ = dy/dz = −rx
    Z,
}

impl BeamAlong {
    /// The DOFs in space of y and θ.
    #[must_use]
    pub const fn dofs(self) -> [Dof; 2] {
        match self {
            Self::X => [Dof::Y, Dof::Rz],
            Self::Z => [Dof::Y, Dof::Rx],
        }
    }

    /// θ of a unit rotation in space: +1 or −1. It is also the factor of every coupling between y and θ.
    #[must_use]
    pub const fn slope_sign(self) -> f64 {
        match self {
            Self::X => 1.0,
            Self::Z => -1.0,
        }
    }
}

/// The (y, θ) matrix of a joint in space, for a beam in a plane.
///
/// # Errors
///
/// Those of [`condensed`].
pub fn planar<T>(
    matrix: &Matrix6<T>,
    beam: BeamAlong,
    others: Others,
) -> Result<Matrix2<T>, SpaceError>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let part = condensed(matrix, &beam.dofs(), others)?;
    let sign = T::from_real(beam.slope_sign());
    Ok(Matrix2::new(
        part[(0, 0)],
        part[(0, 1)] * sign,
        part[(1, 0)] * sign,
        part[(1, 1)],
    ))
}

/// A planar joint's (y, θ) matrix in space; all that the plane does not know is zero.
#[must_use]
pub fn in_space<T>(planar: &Matrix2<T>, beam: BeamAlong) -> Matrix6<T>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let [y, rotation] = beam.dofs().map(Dof::index);
    let sign = T::from_real(beam.slope_sign());
    let mut matrix = Matrix6::zeros();
    matrix[(y, y)] = planar[(0, 0)];
    matrix[(y, rotation)] = planar[(0, 1)] * sign;
    matrix[(rotation, y)] = planar[(1, 0)] * sign;
    matrix[(rotation, rotation)] = planar[(1, 1)];
    matrix
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::{CentreOfElasticity, Uncertainty, transported};

    #[test]
    fn there_and_back_is_the_same() {
        let stiffness = Matrix2::new(5.73e5, 1.2e4, 1.2e4, 1.29e3);
        for (beam, dof, coupling) in [(BeamAlong::X, 5, 1.2e4), (BeamAlong::Z, 3, -1.2e4)] {
            let spatial = in_space(&stiffness, beam);
            assert_eq!([spatial[(1, dof)], spatial[(dof, 1)]], [coupling; 2]);
            for others in [Others::Held, Others::Free] {
                assert_eq!(planar(&spatial, beam, others), Ok(stiffness));
            }
        }
    }

    /// The centre of a planar joint lies where y and θ are decoupled: at k_yθ/k_yy along the beam, d_z = −k_y_rx/k_yy.
    #[test]
    fn the_centre_of_a_planar_joint_is_on_its_beam() {
        let stiffness = Matrix2::new(5.73e5, 1.2e4, 1.2e4, 1.29e3);
        for (beam, along) in [(BeamAlong::X, Vector3::x()), (BeamAlong::Z, Vector3::z())] {
            let spatial = in_space(&stiffness, beam);
            let centre = CentreOfElasticity::of(&spatial, &Uncertainty::None).unwrap();
            assert!(
                (centre.offset_m - along * (1.2e4 / 5.73e5)).norm() < 1e-15,
                "{beam:?}"
            );
            // no stiffness but along y
            assert_eq!(centre.free_directions.len(), 1);
            let there =
                planar(&transported(&spatial, &centre.offset_m), beam, Others::Held).unwrap();
            assert!(there[(0, 1)].abs() < 1e-10);
        }
    }

    /// A spring k along y at a distance s along the beam loads y + θ s: by the planar formula k [1 s; s s²], and by
    /// transport.
    #[test]
    fn a_spring_away_from_the_point_couples_with_the_sign_of_the_slope() {
        let (k, s) = (3e6, 0.04);
        let expected = Matrix2::new(k, k * s, k * s, k * s * s);
        let mut spring = Matrix6::zeros();
        spring[(1, 1)] = k;
        for (beam, along) in [(BeamAlong::X, Vector3::x()), (BeamAlong::Z, Vector3::z())] {
            // from the spring to the beam's point: −s
            let seen = planar(&transported(&spring, &(along * -s)), beam, Others::Held).unwrap();
            assert!(
                (seen - expected).abs().max() < 1e-12 * k,
                "{beam:?}: {seen}"
            );
        }
    }
}
