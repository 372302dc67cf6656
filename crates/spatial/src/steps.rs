//! Where a step leads: along the curve on which the functions are nearly straight.
//!
//! Between structures that a joint sees with H, the functions follow from K* (I + H K*)⁻¹ = H⁻¹ − H⁻¹ (H⁻¹ + K*)⁻¹ H⁻¹. They are
//! linear in (H⁻¹ + K*)⁻¹, and not in K*: what is nearly rigid would run away to infinity, from where no straight step comes
//! back. So a step dK* leads to K*′ with
//!
//! (B + K*′)⁻¹ = (B + K*)⁻¹ − (B + K*)⁻¹ dK* (B + K*)⁻¹,
//!
//! with B for the size of H⁻¹. To first order that is K* + dK*; it goes through infinity as through any other place.

use nalgebra::{DMatrix, DVector, Matrix6};
use num_complex::Complex64;

use crate::links::{Sought, size};
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;

impl Problem {
    /// Where a step leads.
    pub(crate) fn after(&self, unknowns: &Unknowns, step: &DVector<f64>) -> Unknowns {
        let mut after = Unknowns(&unknowns.0 + step);
        let Some(balance) = &self.balance else {
            return after;
        };
        let sought = self.links.sought();
        let moved: Option<Vec<_>> = (sought.iter().zip(balance.chunks_exact(MOTIONS)))
            .map(|(one, balance)| self.joint_after(one, balance, unknowns, step))
            .collect();
        let values = moved.and_then(|matrices| self.links.nearest(&matrices).ok());
        if let Some(values) = values.filter(|values| values.iter().all(|x| x.is_finite())) {
            after.0.rows_mut(0, values.len()).copy_from(&values);
        }
        after
    }

    /// K and C of one joint after a step, with K* = K + jωC at the middle of the lines.
    fn joint_after(
        &self,
        one: &Sought<'_>,
        balance: &[f64],
        unknowns: &Unknowns,
        step: &DVector<f64>,
    ) -> Option<[Matrix6<f64>; 2]> {
        let omega = self.middle_omega();
        let moving: Vec<usize> = (0..MOTIONS).filter(|&dof| balance[dof] > 0.0).collect();
        // with √b as the unit of each motion, B is the unit matrix
        let unit = |n: usize| balance[moving[n]].sqrt();
        let scaled = |values: &[f64]| {
            let [stiffness, damping] = one.matrices(values).ok()?;
            Some(DMatrix::from_fn(moving.len(), moving.len(), |n, m| {
                let at = (moving[n], moving[m]);
                Complex64::new(stiffness[at], omega * damping[at]) / (unit(n) * unit(m))
            }))
        };
        let one_matrix = DMatrix::<Complex64>::identity(moving.len(), moving.len());
        let sum = scaled(unknowns.0.as_slice())? + &one_matrix;
        let change = scaled(step.as_slice())?;
        // B + K*′ = (I − dK* (B + K*)⁻¹)⁻¹ (B + K*)
        let turned = &one_matrix - change * sum.clone().try_inverse()?;
        let moved = turned.lu().solve(&sum)? - one_matrix;
        let mut matrices = [Matrix6::zeros(); 2];
        for (n, &row) in moving.iter().enumerate() {
            for (m, &column) in moving.iter().enumerate() {
                let own = 0.5 * (moved[(n, m)] + moved[(m, n)]) * unit(n) * unit(m);
                matrices[0][(row, column)] = own.re;
                matrices[1][(row, column)] = own.im / omega;
            }
        }
        Some(matrices)
    }

    /// ω at the middle of the lines.
    fn middle_omega(&self) -> f64 {
        self.omega(self.frequency_hz.len() / 2)
    }

    /// How far the unknowns of the joints may go in a step: as far as what couples their motions at most, √(k_ii k_jj); where the joint
    /// is stiffer than the structures, as far as this changes the functions as much.
    pub(crate) fn reaches(&self, balance: &[f64], unknowns: &Unknowns) -> Option<Vec<f64>> {
        let mut all = Vec::new();
        for (one, balance) in self
            .links
            .sought()
            .iter()
            .zip(balance.chunks_exact(MOTIONS))
        {
            let [stiffness, damping] = one.matrices(unknowns.0.as_slice()).ok()?;
            let stiffer = |dof: usize| match balance[dof] > 0.0 {
                true => 1.0 + stiffness[(dof, dof)].abs() / balance[dof],
                false => 1.0,
            };
            for matrix in [stiffness, damping] {
                let entries = one.model.entries().iter();
                all.extend(entries.map(|entry| {
                    let [row, column] = [entry.row, entry.column].map(|dof| dof as usize);
                    size(&matrix, entry) * (stiffer(row) * stiffer(column)).sqrt()
                }));
            }
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{problem, unknowns};

    /// The sample with a stiffness of 1 that balances each motion, and the diagonal of K* = K + jωC alone.
    fn diagonal(stiffness: f64) -> (Problem, Unknowns) {
        let mut problem = problem();
        problem.balance = Some(vec![1.0; MOTIONS]);
        let matrices = [Matrix6::identity() * stiffness, Matrix6::zeros()];
        let joint = problem.links.nearest(&[matrices]).unwrap();
        let errors = DVector::zeros(problem.error_count());
        let all = joint.iter().chain(errors.iter()).copied();
        (
            problem,
            Unknowns(DVector::from_iterator(joint.len() + errors.len(), all)),
        )
    }

    fn stiffness(problem: &Problem, unknowns: &Unknowns) -> f64 {
        let [stiffness, _] = problem
            .links
            .sought_matrices(unknowns.0.as_slice())
            .unwrap();
        stiffness[(0, 0)]
    }

    /// 1/(1 + k′) = 1/(1 + k) − dk/(1 + k)², by hand.
    #[test]
    fn a_step_goes_through_infinity() {
        for (from, by) in [
            (0.0, 0.5),
            (3.0, -1.0),
            (3.0, 3.9),
            (3.0, 8.0),
            (1e6, -1e12),
        ] {
            let (problem, start) = diagonal(from);
            let (_, step) = diagonal(by);
            let after = stiffness(&problem, &problem.after(&start, &step.0));
            let inverse = 1.0 / (1.0 + from) - by / (1.0 + from).powi(2);
            let expected = 1.0 / inverse - 1.0;
            assert!(
                (after - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                "{from} {by}: {after} {expected}"
            );
        }
    }

    #[test]
    fn a_small_step_is_straight() {
        let problem = {
            let mut own = problem();
            own.balance = Some(vec![1e3; MOTIONS]);
            own
        };
        let start = unknowns(&problem);
        let step = 1e-6 * &start.0;
        let straight = &start.0 + &step;
        let after = problem.after(&start, &step).0;
        // of second order
        assert!((after - &straight).norm() < 1e-3 * step.norm());
    }

    #[test]
    fn without_stiffnesses_of_the_structures_steps_are_straight() {
        let problem = problem();
        let start = unknowns(&problem);
        let step = 0.3 * &start.0;
        assert_eq!(problem.after(&start, &step).0, &start.0 + &step);
    }
}
