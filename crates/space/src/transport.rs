//! A joint's matrix told at another point of the same rigid bodies.
//!
//! A matrix belongs to a point: the same joint has other numbers at its bolt's head than in its interface, since a
//! rotation moves every other point.

use nalgebra::{ComplexField, Matrix6, Vector3};

/// X(d): the motion at P by the motion at Q = P + d of the same rigid body, q_P = X q_Q; X(d)⁻¹ = X(−d).
#[must_use]
pub fn transport(offset_m: &Vector3<f64>) -> Matrix6<f64> {
    // u_P = u_Q − θ × d = u_Q + d × θ: X = [I [d]×; 0 I]
    let mut motion = Matrix6::identity();
    motion
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&offset_m.cross_matrix());
    motion
}

/// A joint's matrix (K, C, M or D) at Q = P + `offset_m`, from the one at P.
#[must_use]
pub fn transported<T>(matrix: &Matrix6<T>, offset_m: &Vector3<f64>) -> Matrix6<T>
where
    T: ComplexField<RealField = f64> + Copy,
{
    // The energy is the same: K_Q = Xᵀ K_P X
    let motion = transport(offset_m).map(T::from_real);
    motion.transpose() * matrix * motion
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, near};
    use nalgebra::Vector6;
    use num_complex::Complex64;

    use super::*;
    use crate::samples::{check_stiffness, definite, scattered};

    #[test]
    fn the_check_values_hold() {
        let at_q = transported(&check_stiffness(), &Vector3::new(0.01, -0.02, 0.03));
        for (row, column, expected) in [
            (0, 4, -5e5),
            (3, 3, 48_000.0),
            (4, 5, 10_200.0),
            (3, 4, 10_000.0),
        ] {
            close(at_q[(row, column)], expected, 1e-10);
            close(at_q[(column, row)], expected, 1e-10);
        }
    }

    #[test]
    fn there_and_back_is_the_same() {
        for seed in 0..20 {
            let stiffness = definite(seed);
            let offset = Vector3::from(scattered::<3>(seed)) * 0.1;
            let back = transported(&transported(&stiffness, &offset), &-offset);
            assert!((back - stiffness).abs().max() < 1e-14 * stiffness.abs().max());
            let product = transport(&offset) * transport(&-offset);
            near((product - Matrix6::identity()).abs().max(), 0.0, 1e-16);
        }
    }

    /// By the cross product of each motion, without the matrix X; complex matrices as well.
    #[test]
    fn loads_and_motions_are_those_of_a_rigid_body() {
        let offset = Vector3::new(0.03, -0.02, 0.05);
        let stiffness = definite(7).map(|k| Complex64::new(k, 0.1 * k));
        let moved = transported(&stiffness, &offset);
        for seed in 0..10 {
            let at_p = Vector6::from(scattered::<6>(seed));
            let (u, theta) = (
                at_p.fixed_rows::<3>(0).into_owned(),
                at_p.fixed_rows::<3>(3).into_owned(),
            );
            // u_Q = u_P + θ × d
            let u_q = u + theta.cross(&offset);
            let at_q = Vector6::from_iterator(u_q.iter().chain(theta.iter()).copied())
                .map(Complex64::from);
            let load_p = stiffness * at_p.map(Complex64::from);
            // m_Q = m_P − d × f
            let [f, m] = [0, 3].map(|row| load_p.fixed_rows::<3>(row).into_owned());
            let m_q = m - offset.map(Complex64::from).cross(&f);
            let load_q = moved * at_q;
            let expected = Vector6::from_iterator(f.iter().chain(m_q.iter()).copied());
            assert!((load_q - expected).norm() < 1e-13 * expected.norm());
        }
    }
}
