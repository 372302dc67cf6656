//! Right-handed axes, so that a mirrored system, in which rotations turn the other way, cannot enter unseen.

use nalgebra::{ComplexField, Matrix3, Matrix6, Rotation3, Vector3};

use crate::SpaceError;

/// How far axes may be from unit vectors at right angles.
const ORTHONORMAL: f64 = 1e-9;

/// Three unit vectors at right angles that make a right-handed system, told in the axes that a matrix is given in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes(Matrix3<f64>);

impl Axes {
    /// Axes whose unit vectors are the rows of a matrix: x_new = Q x_old.
    ///
    /// # Errors
    ///
    /// [`SpaceError::NotOrthonormal`] for vectors that are no unit vectors at right angles, [`SpaceError::Mirrored`]
    /// for a left-handed system.
    pub fn new(rows: Matrix3<f64>) -> Result<Self, SpaceError> {
        let off = (rows * rows.transpose() - Matrix3::identity()).abs().max();
        // `max` passes over what is no number
        if off >= ORTHONORMAL || !rows.iter().all(|component| component.is_finite()) {
            let most = ORTHONORMAL;
            return Err(SpaceError::NotOrthonormal { off, most });
        }
        let determinant = rows.determinant();
        if determinant < 0.0 {
            return Err(SpaceError::Mirrored { determinant });
        }
        Ok(Self(rows))
    }

    /// The axes a matrix is given in.
    #[must_use]
    pub fn identity() -> Self {
        Self(Matrix3::identity())
    }

    /// Axes whose z is a direction; where x and y point is of no account. Along z they are the present ones.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Direction`] for a vector without length.
    pub fn with_z_along(axis: &Vector3<f64>) -> Result<Self, SpaceError> {
        let z = unit("axis", axis)?;
        let aside = if z.x.abs() < 0.9 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        Ok(Self::from_z_and(&z, &aside))
    }

    /// Axes whose z is a direction and whose x is another one, at right angles to it.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Direction`] for vectors without length, or not at right angles (1e-6).
    pub fn with_z_and_x_along(axis: &Vector3<f64>, x: &Vector3<f64>) -> Result<Self, SpaceError> {
        let (z, aside) = (unit("axis", axis)?, unit("line", x)?);
        if z.dot(&aside).abs() > 1e-6 {
            return Err(SpaceError::Direction {
                what: "line",
                found: (*x).into(),
                expected: "a vector at right angles to the axis",
            });
        }
        Ok(Self::from_z_and(&z, &aside))
    }

    fn from_z_and(z: &Vector3<f64>, aside: &Vector3<f64>) -> Self {
        let x = (aside - z * z.dot(aside)).normalize();
        let y = z.cross(&x);
        Self(Matrix3::from_rows(&[
            x.transpose(),
            y.transpose(),
            z.transpose(),
        ]))
    }

    /// Unit vectors as rows: a vector's components in these axes are this times its old ones.
    #[must_use]
    pub fn matrix(&self) -> &Matrix3<f64> {
        &self.0
    }

    /// The old axes, told in these.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self(self.0.transpose())
    }

    /// blkdiag(Q, Q): motions and loads of a point in these axes, q_new = 𝐐 q_old.
    #[must_use]
    pub fn of_six(&self) -> Matrix6<f64> {
        let mut six = Matrix6::zeros();
        six.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.0);
        six.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.0);
        six
    }
}

impl From<Rotation3<f64>> for Axes {
    /// A body turned by the rotation carries its axes into these.
    fn from(rotation: Rotation3<f64>) -> Self {
        Self(rotation.matrix().transpose())
    }
}

/// A joint's matrix in other axes, at the same point.
#[must_use]
pub fn rotated<T>(matrix: &Matrix6<T>, axes: &Axes) -> Matrix6<T>
where
    T: ComplexField<RealField = f64> + Copy,
{
    // K_new = 𝐐 K 𝐐ᵀ
    let six = axes.of_six().map(T::from_real);
    six * matrix * six.transpose()
}

/// A vector of length one.
fn unit(what: &'static str, vector: &Vector3<f64>) -> Result<Vector3<f64>, SpaceError> {
    let length = vector.norm();
    if length > 0.0 && length.is_finite() {
        return Ok(vector / length);
    }
    let found = (*vector).into();
    let expected = "a vector that has a length";
    Err(SpaceError::Direction {
        what,
        found,
        expected,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{CHECK_STIFFNESS, check_stiffness, scattered};

    #[test]
    fn a_mirrored_system_is_refused() {
        let mirrored = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
        assert_eq!(
            Axes::new(mirrored),
            Err(SpaceError::Mirrored { determinant: -1.0 })
        );
        let skew = Matrix3::new(1.0, 0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0, 1.0);
        assert!(
            matches!(Axes::new(skew), Err(SpaceError::NotOrthonormal { off, .. }) if off == 0.1)
        );
        let nothing = Matrix3::from_element(f64::NAN);
        assert!(matches!(
            Axes::new(nothing),
            Err(SpaceError::NotOrthonormal { .. })
        ));
        let flat = Axes::with_z_along(&Vector3::zeros());
        assert!(matches!(
            flat,
            Err(SpaceError::Direction { what: "axis", .. })
        ));
        let oblique = Axes::with_z_and_x_along(&Vector3::z(), &Vector3::new(1.0, 0.0, 0.1));
        assert!(matches!(
            oblique,
            Err(SpaceError::Direction { what: "line", .. })
        ));
    }

    /// A quarter turn about z: the new x is the old y, the new y the old −x.
    #[test]
    fn a_quarter_turn_swaps_entries() {
        let quarter = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let turned = rotated(&check_stiffness(), &Axes::from(quarter));
        let near = |row, column, expected: f64| {
            bolted_joint_testing::near(turned[(row, column)], expected, 1e-8);
        };
        near(0, 0, CHECK_STIFFNESS[1]);
        near(1, 1, CHECK_STIFFNESS[0]);
        near(3, 3, CHECK_STIFFNESS[4]);
        // k_x_ry of the new axes is f_y by a rotation about −x: −k_y_rx
        near(0, 4, 5e4);
        near(1, 3, -1e5);
        near(2, 5, 2e4);
    }

    #[test]
    fn energy_does_not_depend_on_the_axes() {
        let stiffness = check_stiffness();
        for trial in 0..20 {
            let axes = Axes::with_z_along(&Vector3::from(scattered::<3>(trial))).unwrap();
            assert_eq!(Axes::new(*axes.matrix()), Ok(axes));
            let motion = nalgebra::Vector6::from(scattered::<6>(trial + 100));
            let turned = axes.of_six() * motion;
            let energy = motion.dot(&(stiffness * motion));
            let again = turned.dot(&(rotated(&stiffness, &axes) * turned));
            bolted_joint_testing::close(again, energy, 1e-14);
            let back = rotated(&rotated(&stiffness, &axes), &axes.inverse());
            assert!((back - stiffness).abs().max() < 1e-14 * 5e7);
        }
    }

    /// A vector along the given direction has that component alone.
    #[test]
    fn z_points_along_the_axis() {
        for direction in [
            Vector3::z(),
            Vector3::x(),
            -Vector3::y(),
            Vector3::new(0.3, -2.0, 1.0),
        ] {
            let seen = Axes::with_z_along(&direction).unwrap().matrix() * direction;
            assert!((seen - Vector3::z() * direction.norm()).norm() < 1e-15);
        }
        assert_eq!(Axes::with_z_along(&Vector3::z()).unwrap(), Axes::identity());
    }
}
