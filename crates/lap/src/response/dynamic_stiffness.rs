//! Force over relative motion as a function of the amplitude of that motion, with exact derivatives: in closed form for one
//! harmonic, by harmonic balance for more.

use bolted_joint_dynamics::{
    Body, Lap, Linear,
    law::{TERM_COUNT, Term},
};
use num_complex::Complex64;

use super::model::Values;
use super::slider::{ClosedLoops, MOST, SliderParameter, SliderValues};
use bolted_joint_harmonic::{
    HarmonicBalance, HarmonicLoads, Harmonics, Observed, Parameter, Side, Target,
};

/// z_r: amplitude of half the difference of the bodies' loads over that of the relative motion's fundamental.
#[derive(Clone, Copy, Debug)]
pub(super) struct DynamicStiffness {
    /// N/m
    pub(super) value: Complex64,
    /// Derivative by the logarithm of the amplitude.
    pub(super) by_log_amplitude: Complex64,
    /// Derivative by m.
    pub(super) by_mass: Complex64,
    /// Derivative by K = k/2 + k12.
    pub(super) by_stiffness: Complex64,
    /// Derivative by C = c/2 + c12.
    pub(super) by_damping: Complex64,
    /// Derivatives by the terms, in the order of [`Term::ALL`].
    pub(super) by_term: [Complex64; TERM_COUNT],
    /// Law that slips, and derivatives by its unknowns.
    slider: Option<(SliderValues, [Complex64; MOST])>,
}

impl DynamicStiffness {
    /// Derivative by the unknown of a parameter of the law that slips.
    pub(super) fn by_slider(&self, parameter: SliderParameter) -> Complex64 {
        let found = self.slider.as_ref().and_then(|(values, by)| {
            let index = values.index(parameter)?;
            by.get(index).copied()
        });
        found.unwrap_or(Complex64::ZERO)
    }
}

/// The relative motion of a lap with given numbers.
pub(super) struct RelativeMotion<'a> {
    values: &'a Values,
    /// Describing functions of the terms at an amplitude of 1 m.
    describing: [f64; TERM_COUNT],
    /// Of a law that slips.
    loops: Option<ClosedLoops>,
    /// For more than one harmonic.
    balance: Option<HarmonicBalance<1>>,
}

impl<'a> RelativeMotion<'a> {
    /// Of one harmonic.
    pub(super) fn fundamental(values: &'a Values) -> Self {
        Self {
            values,
            describing: Term::ALL.map(Term::describing),
            loops: values.slider.map(|slider| slider.closed_loops()),
            balance: None,
        }
    }

    /// Of odd harmonics up to the `highest`, of one beside a law that slips. Numbers that are no lap's leave the closed form, which
    /// the search leaves again.
    pub(super) fn new(values: &'a Values, highest: usize) -> Self {
        let balance = (highest > 1 && values.slider.is_none())
            .then(|| HarmonicBalance::new(&lap(values), Harmonics::odd(highest).ok()?).ok())
            .flatten();
        Self {
            balance,
            ..Self::fundamental(values)
        }
    }

    /// z_r at an amplitude of the fundamental (m). Not finite where nothing is found.
    pub(super) fn stiffness(&self, amplitude_m: f64, omega: f64) -> DynamicStiffness {
        match &self.balance {
            None => self.closed(amplitude_m, omega),
            Some(balance) => self
                .balanced(balance, amplitude_m, omega)
                .unwrap_or_else(|| {
                    let mut none = self.closed(amplitude_m, omega);
                    none.value = f64::NAN.into();
                    none
                }),
        }
    }

    fn closed(&self, amplitude_m: f64, omega: f64) -> DynamicStiffness {
        let values = self.values;
        let by_term = Term::ALL.map(|term| {
            let share = self.describing[term.index()] * amplitude_m.powi(term.amplitude_power());
            match term.is_damper() {
                false => Complex64::new(share, 0.0),
                true => Complex64::new(0.0, omega * share),
            }
        });
        // z_r = k/2 + k₁₂ − ω² m/2 + jω (c/2 + c₁₂) + Σ terms
        let mut value = Complex64::new(
            values.relative_stiffness() - 0.5 * values.mass * omega * omega,
            omega * values.relative_damping(),
        );
        for (term, by) in Term::ALL.into_iter().zip(by_term) {
            value += by * values.term(term);
        }
        let mut by_log_amplitude = self.by_log_amplitude(&by_term);
        let slider = values.slider.zip(self.loops.as_ref());
        let slider = slider.map(|(slider, loops)| {
            let slipping = loops.at(amplitude_m);
            value += slipping.value;
            by_log_amplitude += slipping.by_log_amplitude;
            (slider, slipping.by_unknown)
        });
        DynamicStiffness {
            value,
            by_log_amplitude,
            slider,
            by_mass: (-0.5 * omega * omega).into(),
            by_stiffness: Complex64::ONE,
            by_damping: Complex64::new(0.0, omega),
            by_term,
        }
    }

    fn balanced(
        &self,
        balance: &HarmonicBalance<1>,
        amplitude_m: f64,
        omega: f64,
    ) -> Option<DynamicStiffness> {
        let loads = HarmonicLoads::opposed(1.0);
        let target = Target::relative(0, amplitude_m);
        let solution = balance.controlled(omega, &loads, target, None).ok()?;
        let seen = Observed::Relative(0);
        let (load, r) = (
            solution.load_factor(),
            balance.amplitude_of(&solution, seen, 1),
        );
        let linear = [
            Parameter::Inertia(Side::A, 0),
            Parameter::Inertia(Side::B, 0),
            Parameter::JointStiffness(0, 0),
            Parameter::JointDamping(0, 0),
        ];
        let terms = Term::ALL.map(|term| Parameter::Term(term, 0));
        let parameters = [&linear[..], &terms].concat();
        let changes = balance.sensitivities(&solution, &parameters).ok()?;
        // z = λ/r
        let by = |place: usize| {
            let change = &changes[place];
            let dr = balance.amplitude_change(&solution, change, seen, 1);
            (change.load_factor - load * dr / r) / r
        };
        let by_term = Term::ALL.map(|term| by(linear.len() + term.index()));
        Some(DynamicStiffness {
            value: load / r,
            by_log_amplitude: self.by_log_amplitude(&by_term),
            by_mass: by(0) + by(1),
            by_stiffness: by(2),
            by_damping: by(3),
            by_term,
            slider: None,
        })
    }

    /// Over its own amplitude R the motion depends on k3 R², k5 R⁴, … alone: ∂z/∂ln R = Σ power · coefficient · ∂z/∂coefficient.
    fn by_log_amplitude(&self, by_term: &[Complex64; TERM_COUNT]) -> Complex64 {
        let terms = Term::ALL.into_iter().zip(by_term);
        terms
            .map(|(term, by)| by * self.values.term(term) * f64::from(term.amplitude_power()))
            .sum()
    }
}

/// Two free bodies with all stiffness and damping of the relative motion between them.
fn lap(values: &Values) -> Lap<1> {
    let body = Body {
        inertia: [values.mass],
        stiffness: [0.0],
        damping: [0.0],
    };
    let linear = Linear {
        stiffness: [[values.relative_stiffness()]],
        damping: [[values.relative_damping()]],
    };
    Lap {
        joint: linear.beside([values.terms]),
        a: body,
        b: body,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_dynamics::{Polynomial, law::SPRING_COUNT};

    fn values() -> Values {
        Values {
            mass: 3.9,
            support_stiffness: 2e4,
            support_damping: 0.4,
            joint_stiffness: 4.9e5,
            joint_damping: 3.0,
            terms: Polynomial::with(&[-3e11, 9e18, -5e25], &[4.6e8, 1e15]),
            ..Values::default()
        }
    }

    #[test]
    fn balance_of_one_harmonic_is_the_closed_form() {
        let values = values();
        let closed = RelativeMotion::fundamental(&values);
        let balance = HarmonicBalance::new(&lap(&values), Harmonics::odd(1).unwrap()).unwrap();
        let balanced = RelativeMotion {
            balance: Some(balance),
            ..RelativeMotion::fundamental(&values)
        };
        for omega in [490.0, 503.0, 515.0] {
            let [one, other] = [&closed, &balanced].map(|motion| motion.stiffness(2.5e-4, omega));
            let near = |a: Complex64, b: Complex64| (a - b).norm() < 1e-7 * a.norm().max(b.norm());
            assert!(
                near(one.value, other.value),
                "{} {}",
                one.value,
                other.value
            );
            assert!(near(one.by_log_amplitude, other.by_log_amplitude));
            assert!(near(one.by_mass, other.by_mass) && near(one.by_stiffness, other.by_stiffness));
            assert!(near(one.by_damping, other.by_damping));
            assert!(
                one.by_term
                    .into_iter()
                    .zip(other.by_term)
                    .all(|(a, b)| near(a, b))
            );
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let values = Values {
            terms: Polynomial::with(&[8e12], &[3e9]),
            ..values()
        };
        for highest in [1, 5] {
            let at = |values: &Values, log: f64| {
                RelativeMotion::new(values, highest).stiffness(log.exp(), 520.0)
            };
            let log = 2.5e-4_f64.ln();
            let z = at(&values, log);
            let by_log = (at(&values, log + 1e-5).value - at(&values, log - 1e-5).value) / 2e-5;
            assert!(
                (by_log - z.by_log_amplitude).norm() < 1e-6 * by_log.norm(),
                "{highest}"
            );
            let differences = |change: &dyn Fn(&mut Values, f64), step: f64| {
                let side = |sign: f64| {
                    let mut moved = values;
                    change(&mut moved, sign * step);
                    at(&moved, log).value
                };
                (side(1.0) - side(-1.0)) / (2.0 * step)
            };
            for (numerical, exact) in [
                (differences(&|v, d| v.mass += d, 1e-4), z.by_mass),
                (
                    differences(&|v, d| v.joint_stiffness += d, 10.0),
                    z.by_stiffness,
                ),
                (
                    differences(&|v, d| v.joint_damping += d, 1e-3),
                    z.by_damping,
                ),
                (
                    differences(&|v, d| v.terms.springs[0] += d, 1e8),
                    z.by_term[0],
                ),
                (
                    differences(&|v, d| v.terms.dampers[0] += d, 1e5),
                    z.by_term[SPRING_COUNT],
                ),
            ] {
                assert!(
                    (numerical - exact).norm() < 1e-5 * exact.norm(),
                    "{highest}: {numerical} {exact}"
                );
            }
        }
    }
}
