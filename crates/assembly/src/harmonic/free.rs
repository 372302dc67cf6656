//! Motion without loads: unknowns are the motion, its frequency and damping, and how large it is.

use bolted_joint_dynamics::Dual;
use bolted_joint_dynamics::law::{DOF_AT_REST, DofLaws};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::follow::Curve;
use super::{ITERATIONS, Linear, OF_FREQUENCY, OF_LOGARITHM, OF_RATIO, Problem, VARIED};

/// A nonlinear mode: unknowns are the motion, ω, ζ, and the logarithm of the amplitude of an output.
pub(super) struct Free<'p, 'm> {
    pub(super) problem: &'p Problem<'m>,
    pub(super) output: usize,
}

impl Free<'_, '_> {
    fn no_loads(&self) -> DVector<Complex64> {
        DVector::zeros(self.problem.condensed.loads())
    }

    /// Gives the motion the shape of the linear mode, and the amplitude that is asked for.
    pub(super) fn shape(&self, unknowns: &mut DVector<f64>) -> Option<()> {
        let problem = self.problem;
        let size = problem.size();
        // beside the mode: at an undamped resonance of a structure itself nothing is finite
        unknowns[size] *= 1.0 + VARIED;
        let omega = unknowns[size];
        let linear = problem.linear(omega, unknowns[size + 1], &self.no_loads())?;
        let first = linear.at.first()?;
        let mut stiffness = first.stiffness.clone();
        for (dof, (_, laws)) in problem.condensed.laws.iter().enumerate() {
            // of small motion
            let laws = DofLaws::new(laws.parameters().map(Dual::<2>::from));
            let [k, c] = laws
                .load(&DOF_AT_REST, Dual::along(0.0, 0), Dual::along(0.0, 1))
                .change;
            stiffness[(dof, dof)] += Complex64::new(k, omega * c);
        }
        let count = stiffness.nrows();
        let lu = stiffness.lu();
        let mut r = DVector::from_element(count, Complex64::ONE);
        for _ in 0..ITERATIONS {
            r = lu.solve(&r)?;
            let norm = r.norm();
            r /= Complex64::from(norm);
        }
        let mut motion = vec![0.0; size];
        let put = |motion: &mut [f64], r: &DVector<Complex64>| {
            for dof in 0..count {
                let place = problem.place(dof, 0);
                motion[place] = r[dof].re;
                motion[place + 1] = -r[dof].im;
            }
        };
        put(&mut motion, &r);
        // y of the mode with f = −Z r
        let forces = -&first.stiffness * &r;
        let y = first.outputs(&forces)[self.output];
        if y.norm() == 0.0 {
            return None;
        }
        let r = r * (Complex64::from(unknowns[size + 2].exp()) / y);
        put(&mut motion, &r);
        unknowns.rows_mut(0, size).copy_from_slice(&motion);
        Some(())
    }

    fn residual(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let problem = self.problem;
        let size = problem.size();
        let loads = self.no_loads();
        let (omega, ratio, amplitude) =
            (unknowns[size], unknowns[size + 1], unknowns[size + 2].exp());
        let motion = unknowns.as_slice().get(..size)?;
        let linear = problem.linear(omega, ratio, &loads)?;
        let balance = problem.balance(&linear, motion, omega);
        // y = U f with f = −Z r at the fundamental, which is linear in r
        let output = |linear: &Linear| -> Option<DMatrix<Complex64>> {
            let first = linear.at.first()?;
            Some(-first.by_forces(self.output) * &first.stiffness)
        };
        let rows = output(&linear)?;
        let count = problem.condensed.laws.len();
        let r = DVector::from_fn(count, |dof, _| problem.phasor(motion, dof, 0));
        let y = (&rows * &r)[(0, 0)];
        let mut residual = DVector::zeros(size + 2);
        residual.rows_mut(0, size).copy_from(&balance.residual);
        residual[size] = y.re / amplitude - 1.0;
        residual[size + 1] = y.im / amplitude;
        let mut matrix = DMatrix::zeros(size + 2, size + 3);
        matrix
            .view_mut((0, 0), (size, size + 1))
            .copy_from(&balance.derivatives);
        let [by_omega, by_ratio] = [[VARIED * omega, 0.0], [0.0, VARIED]];
        for (column, [omega_change, ratio_change]) in [(size, by_omega), (size + 1, by_ratio)] {
            let step = omega_change + ratio_change;
            let next = problem.linear(omega + omega_change, ratio + ratio_change, &loads)?;
            let mut own = matrix.view_mut((0, column), (size, 1));
            own += problem.by_change([&linear, &next], motion, step);
            let change = ((output(&next)? * &r)[(0, 0)] - y) / step;
            matrix[(size, column)] = change.re / amplitude;
            matrix[(size + 1, column)] = change.im / amplitude;
        }
        for dof in 0..count {
            let place = problem.place(dof, 0);
            let own = rows[(0, dof)];
            // own (a − jb)
            matrix[(size, place)] = own.re / amplitude;
            matrix[(size, place + 1)] = own.im / amplitude;
            matrix[(size + 1, place)] = own.im / amplitude;
            matrix[(size + 1, place + 1)] = -own.re / amplitude;
        }
        matrix[(size, size + 2)] = -y.re / amplitude;
        matrix[(size + 1, size + 2)] = -y.im / amplitude;
        Some((residual, matrix))
    }
}

impl Curve for Free<'_, '_> {
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        self.residual(unknowns)
    }

    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let size = self.problem.size();
        let mut scale = DVector::from_element(size + 3, self.problem.amplitude(unknowns));
        scale[size] = OF_FREQUENCY * unknowns[size];
        scale[size + 1] = OF_RATIO;
        scale[size + 2] = OF_LOGARITHM;
        scale
    }
}
