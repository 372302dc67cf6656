//! Masses that only the assembly has, where they are known: a structure with them, and functions without an accelerometer.

use bolted_joint_frf::structure::ComplexMatrix;
use num_complex::Complex64;

use super::super::study::MassAtJoint;

/// Masses and moments of inertia above zero, each with the joint's DOF that it moves with.
pub(in super::super) fn masses_at(
    masses: &[MassAtJoint],
    dofs_of_a_bolt: usize,
) -> Vec<(usize, f64)> {
    let of = |(bolt, mass): (usize, &MassAtJoint)| {
        [mass.mass_kg, mass.inertia_kg_m2]
            .into_iter()
            .take(dofs_of_a_bolt)
            .enumerate()
            .map(move |(dof, value)| (bolt * dofs_of_a_bolt + dof, value))
    };
    let all = masses.iter().enumerate().flat_map(of);
    all.filter(|&(_, value)| value > 0.0).collect()
}

/// Receptances U with masses: `motions` has a row for each, its motion by those of U. `None` at an undamped resonance.
///
/// D = −ω² diag(m), U′ = (U⁻¹ + SᵀDS)⁻¹ = U − U SᵀD (1 + S U SᵀD)⁻¹ S U
pub(super) fn with_masses(
    u: ComplexMatrix,
    motions: &ComplexMatrix,
    masses: &[f64],
    frequency_hz: f64,
) -> Option<ComplexMatrix> {
    let omega = std::f64::consts::TAU * frequency_hz;
    let mut loads = motions.transpose();
    for (mut column, mass) in loads.column_iter_mut().zip(masses) {
        column *= Complex64::from(-omega * omega * mass);
    }
    let moved = motions * &u;
    let mut system = &moved * &loads;
    for i in 0..masses.len() {
        system[(i, i)] += 1.0;
    }
    let change = system.lu().solve(&moved)?;
    let with = &u - &u * loads * change;
    let is_finite = |value: &Complex64| value.re.is_finite() && value.im.is_finite();
    // by rounding alone it is not symmetric
    let symmetric = (&with + with.transpose()) * Complex64::from(0.5);
    symmetric.iter().all(is_finite).then_some(symmetric)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses on springs: m₁ = 2 kg on 900 N/m to the ground, 500 N/m between, m₂ = 3 kg.
    fn receptances(m1_kg: f64, m2_kg: f64, omega: f64) -> ComplexMatrix {
        let square = omega * omega;
        let spring = Complex64::new(500.0, 3.0);
        let ground = Complex64::new(900.0, 4.0);
        ComplexMatrix::from_row_slice(
            2,
            2,
            &[
                ground + spring - square * m1_kg,
                -spring,
                -spring,
                spring - square * m2_kg,
            ],
        )
        .try_inverse()
        .unwrap()
    }

    #[test]
    fn a_mass_is_as_if_the_structure_had_it() {
        let omega = 11.0;
        let hz = omega / std::f64::consts::TAU;
        let u = receptances(2.0, 3.0, omega);
        let motions = ComplexMatrix::identity(2, 2);
        let found = with_masses(u, &motions, &[0.4, 0.7], hz).unwrap();
        let expected = receptances(2.4, 3.7, omega);
        assert!((found - &expected).norm() < 1e-13 * expected.norm());
        // a moment of inertia about the middle, at a distance of 0.5 m: θ = (u₂ − u₁)/1 m
        let u = receptances(2.0, 3.0, omega);
        let turn = ComplexMatrix::from_row_slice(1, 2, &[-1.0, 1.0].map(Complex64::from));
        let found = with_masses(u.clone(), &turn, &[0.3], hz).unwrap();
        let inertia = turn.transpose() * &turn * Complex64::from(-omega * omega * 0.3);
        let expected = (u.try_inverse().unwrap() + inertia).try_inverse().unwrap();
        assert!((found - &expected).norm() < 1e-13 * expected.norm());
    }

    #[test]
    fn only_what_is_known_is_there() {
        let mass = |mass_kg, inertia_kg_m2| MassAtJoint {
            mass_kg,
            inertia_kg_m2,
        };
        let bolts = [mass(0.0, 2e-6), mass(0.01, 0.0), mass(0.02, 3e-6)];
        assert_eq!(
            masses_at(&bolts, 2),
            [(1, 2e-6), (2, 0.01), (4, 0.02), (5, 3e-6)]
        );
        assert_eq!(masses_at(&bolts, 1), [(1, 0.01), (2, 0.02)]);
    }
}
