//! Laws that slip, in balance with one harmonic: what their closed loops add to the stiffness of a joint that sticks.

use bolted_joint_dynamics::{
    Dual, JointLaw,
    law::{DofLaws, Iwan, Jenkins, Law, dof_parameters},
};
use num_complex::Complex64;

use super::{HarmonicError, masing_fundamental};

/// The laws with Masing's rule on each relative DOF.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slipping<const D: usize> {
    on: [DofLaws; D],
}

impl<const D: usize> Slipping<D> {
    /// Those of a joint, `None` where nothing slips.
    ///
    /// # Errors
    /// [`HarmonicError::Memory`] where a law remembers otherwise than by Masing's rule.
    pub(super) fn of(joint: &JointLaw<D>) -> Result<Option<Self>, HarmonicError> {
        if !joint.has_memory() {
            return Ok(None);
        }
        let have_rule = [
            <Jenkins as Law<f64>>::DECLARATION.name,
            <Iwan as Law<f64>>::DECLARATION.name,
        ];
        for laws in &joint.on {
            for (value, (law, _)) in laws.parameters().iter().zip(dof_parameters()) {
                if *value != 0.0 && law.remembers() && !have_rule.contains(&law.name) {
                    return Err(HarmonicError::Memory);
                }
            }
        }
        Ok(Some(Self { on: joint.on }))
    }

    /// Stiffness of a DOF's laws while all sticks, N/m or N·m/rad.
    pub(super) fn stuck(&self, dof: usize) -> f64 {
        self.on[dof].jenkins().stiffness + self.on[dof].iwan().stiffness
    }

    /// What they add at an amplitude of the relative motion beyond that, with its derivative by the amplitude.
    pub(super) fn stiffness(&self, dof: usize, amplitude: f64) -> [Complex64; 2] {
        let laws = &self.on[dof];
        let none = [Complex64::ZERO; 2];
        if amplitude.is_nan() || amplitude <= 0.0 {
            return none;
        }
        let jenkins = laws.jenkins();
        let iwan = laws.iwan();
        let knees = [
            (jenkins.stiffness, jenkins.nonlinear_amplitude(0.0, 0.0)),
            (iwan.stiffness, iwan.nonlinear_amplitude(0.0, 0.0)),
        ];
        let laws = DofLaws::new(laws.parameters().map(Dual::<1>::from));
        let at = Dual::along(amplitude, 0);
        let loads: [&dyn Fn(Dual<1>) -> Dual<1>; 2] = [
            &|u| laws.jenkins().load::<f64>(&[], u, Dual::from(0.0)),
            &|u| laws.iwan().load::<f64>(&[], u, Dual::from(0.0)),
        ];
        let mut sum = none;
        for (load, (stuck, knee)) in loads.into_iter().zip(knees) {
            if stuck == 0.0 {
                continue;
            }
            // f = a₁ cos θ + b₁ sin θ of u = U cos θ: z = (a₁ − j b₁)/U
            let found = masing_fundamental(load, knee, at);
            let (real, imaginary) = (found.in_phase / at, -(found.quadrature / at));
            sum[0] += Complex64::new(real.value - stuck, imaginary.value);
            sum[1] += Complex64::new(real.change[0], imaginary.change[0]);
        }
        sum
    }
}
