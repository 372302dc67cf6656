//! How periodic motions change with the numbers of the model: exact, from the equations that they solve.

use nalgebra::DVector;
use num_complex::Complex64;

use super::balance::HarmonicBalance;
use super::condensed::{Circumstances, Condensed};
use super::solution::not_found;
use super::system::{Closing, Regime, Scale, System};
use super::{Derivative, HarmonicError, HarmonicLoads, Observed, Parameter, Solution, Target};

/// How a solution changes with one number of the model, while what its test holds stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The number.
    pub parameter: Parameter,
    /// Change of the angular frequency, rad/s per unit of the number: of a resonance; zero where the frequency is given.
    pub omega_rad_s: f64,
    /// Change of the factor of the loads: where it is adjusted to an amplitude.
    pub load_factor: f64,
    /// Change of the damping ratio of a free motion.
    pub damping_ratio: f64,
    pub(super) coefficients: Vec<f64>,
}

impl<const D: usize> HarmonicBalance<D> {
    /// How a solution changes with each of the parameters, while what its test holds stays: the frequency and the loads, the
    /// frequency and the amplitude, or of a resonance and a free motion the amplitude.
    ///
    /// # Errors
    /// [`HarmonicError`] if the solution is at a fold, where it has no derivative, or a DOF does not exist.
    pub fn sensitivities(
        &self,
        solution: &Solution<D>,
        parameters: &[Parameter],
    ) -> Result<Vec<Sensitivity>, HarmonicError> {
        for parameter in parameters {
            if let Some(&dof) = parameter.dofs().iter().find(|&&dof| dof >= D) {
                return Err(HarmonicError::Value {
                    what: "DOF of a parameter",
                    found: dof as f64,
                    expected: "one that the lap has",
                });
            }
        }
        let mut system = System::new(self, &solution.loads, solution.regime);
        let unknowns = system.unknowns(&solution.coefficients, solution.at);
        let scale = system.scale(&unknowns);
        let target = solution.regime.observed().map(|observed| Target {
            observed,
            derivative: Derivative::Displacement,
            amplitude: self
                .observe(observed, &unknowns, &solution.loads, solution.at)
                .value
                .norm(),
        });
        let closing = match (solution.regime, target) {
            (Regime::Resonance(_) | Regime::Free(_), Some(target)) => Closing::Amplitude(target),
            (Regime::Level(_), _) => Closing::LoadFactor(solution.at.load_factor),
            _ => Closing::Frequency(solution.at.omega),
        };
        let (matrix, _) = system.linearise(&unknowns, &closing, &scale);
        let factors = matrix.lu();
        let size = self.size();
        parameters
            .iter()
            .map(|&parameter| {
                let change = system.by_parameter(parameter, &unknowns, &closing, &scale);
                let change = factors
                    .solve(&change)
                    .filter(|change| change.iter().all(|value| value.is_finite()))
                    .ok_or_else(|| not_found(solution.at.omega, 1))?;
                let of = |n: usize| -scale.unknown[n] * change[n];
                let second = if system.size() > size + 1 {
                    of(size + 1)
                } else {
                    0.0
                };
                let is_free = matches!(solution.regime, Regime::Free(_));
                Ok(Sensitivity {
                    parameter,
                    omega_rad_s: of(size),
                    load_factor: if is_free { 0.0 } else { second },
                    damping_ratio: if is_free { second } else { 0.0 },
                    coefficients: (0..size).map(of).collect(),
                })
            })
            .collect()
    }

    /// Derivative of [`HarmonicBalance::amplitude_of`] with respect to the parameter of a sensitivity.
    #[must_use]
    pub fn amplitude_change(
        &self,
        solution: &Solution<D>,
        sensitivity: &Sensitivity,
        observed: Observed,
        order: usize,
    ) -> Complex64 {
        let dof = observed.dof();
        let Some(place) = self.place_of(order).filter(|_| dof < D) else {
            return Complex64::ZERO;
        };
        let dr = self.amplitude(&sensitivity.coefficients, dof, place);
        let side = match observed {
            Observed::Relative(_) => return dr,
            Observed::Body(side, _) => side,
        };
        let r = self.amplitude(&solution.coefficients, dof, place);
        let bodies = Condensed::new(&self.lap, &solution.loads, dof, order, solution.at);
        bodies.body_by_r(side) * dr
            + bodies.body_by_omega(r) * sensitivity.omega_rad_s
            + bodies.body_by_released(r) * sensitivity.damping_ratio
            + bodies.body_by_factor(&solution.loads, dof) * sensitivity.load_factor
            + self.seen_change(
                sensitivity.parameter,
                observed,
                order,
                &solution.coefficients,
                &solution.loads,
                solution.at,
            )
    }

    /// How a harmonic of a body changes with a parameter at the same relative motion.
    fn seen_change(
        &self,
        parameter: Parameter,
        observed: Observed,
        order: usize,
        coefficients: &[f64],
        loads: &HarmonicLoads<D>,
        at: Circumstances,
    ) -> Complex64 {
        let dof = observed.dof();
        let (Observed::Body(..), Some(place)) = (observed, self.place_of(order)) else {
            return Complex64::ZERO;
        };
        let r = self.amplitude(coefficients, dof, place);
        let bodies = Condensed::new(&self.lap, loads, dof, order, at);
        match parameter.of_body() {
            Some((of, number, own)) if own == dof => bodies.body_by_number(of, number, r),
            None if parameter == Parameter::LoadFactor => {
                bodies.body_by_factor(loads, dof) * at.load_factor
            }
            _ => Complex64::ZERO,
        }
    }
}

impl<const D: usize> System<'_, D> {
    /// Scaled derivative of all equations with respect to a parameter.
    fn by_parameter(
        &self,
        parameter: Parameter,
        unknowns: &[f64],
        closing: &Closing<'_>,
        scale: &Scale,
    ) -> DVector<f64> {
        let balance = self.balance;
        let (size, total) = (balance.size(), self.size());
        let at = self.circumstances(unknowns);
        let mut change = DVector::zeros(total);
        if parameter == Parameter::AngularFrequency {
            // The frequency is an unknown already: only where it is given can it be changed.
            if let Closing::Frequency(omega) = closing {
                change[total - 1] = -1.0 / omega;
            }
            return change;
        }
        let own = balance.by_parameter(parameter, &unknowns[..size], self.loads, at);
        for row in 0..size {
            change[row] = own[row] * scale.of_row(balance, row);
        }
        let seen = |observed: Observed| {
            balance.seen_change(parameter, observed, 1, unknowns, self.loads, at)
        };
        if total > size + 1 {
            change[size] = self.condition_change(seen, unknowns, scale);
        }
        if let Closing::Amplitude(target) = closing {
            change[total - 1] = self.target_change(target, seen(target.observed), unknowns);
        }
        change
    }
}

impl Regime {
    fn observed(self) -> Option<Observed> {
        match self {
            Self::Forced | Self::Level(_) => None,
            Self::Controlled(target) => Some(target.observed),
            Self::Resonance(observed) | Self::Free(observed) => Some(observed),
        }
    }
}

impl Parameter {
    fn dofs(self) -> [usize; 2] {
        match self {
            Self::Inertia(_, dof)
            | Self::SupportStiffness(_, dof)
            | Self::SupportDamping(_, dof)
            | Self::Term(_, dof) => [dof; 2],
            Self::JointStiffness(row, column) | Self::JointDamping(row, column) => [row, column],
            Self::LoadFactor | Self::AngularFrequency => [0; 2],
        }
    }
}
