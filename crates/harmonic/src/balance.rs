//! The equations: what is out of balance at each harmonic of the relative motion, and how that changes with everything.

use bolted_joint_dynamics::{Lap, Polynomial, law::Term};
use nalgebra::DMatrix;
use num_complex::Complex64;

use super::branches::Remembering;
use super::condensed::{BodyNumber, Circumstances, Condensed};
use super::course::Course;
use super::sampling::{Sampling, Spectrum};
use super::slipping::Slipping;
use super::{HarmonicError, HarmonicLoads, Harmonics, Parameter};

/// A lap model made ready for harmonic balance.
///
/// The harmonics of its relative motion are the only unknowns: the bodies are linear and condensed to it.
#[derive(Clone, Debug)]
pub struct HarmonicBalance<const D: usize> {
    /// With the stiffness of laws that slip while they stick.
    pub(super) lap: Lap<D>,
    pub(super) slipping: Option<Slipping<D>>,
    pub(super) harmonics: Harmonics,
    pub(super) sampling: Sampling,
    pub(super) terms: [Polynomial; D],
    /// Length of each DOF's coordinate, so that all have the same stiffness.
    pub(super) length: [f64; D],
    /// That stiffness, N/m.
    pub(super) stiffness: f64,
    /// A frequency that the lap has, rad/s.
    pub(super) omega: f64,
}

/// What is out of balance, with its derivatives, in SI units. DOF by DOF, each in the layout of the harmonics.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    pub(super) residual: Vec<f64>,
    pub(super) by_omega: Vec<f64>,
    pub(super) by_factor: Vec<f64>,
    pub(super) by_released: Vec<f64>,
    /// With respect to the coefficients.
    pub(super) jacobian: DMatrix<f64>,
    r: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    damping_force: Vec<f64>,
    spectrum: Spectrum,
}

impl<const D: usize> HarmonicBalance<D> {
    /// Prepares `lap`.
    ///
    /// # Errors
    /// [`HarmonicError::Model`] if the lap has an inertia that is not positive or anything that is not finite,
    /// [`HarmonicError::Rate`] if its joint has friction that depends on how fast it moves.
    pub fn new(lap: &Lap<D>, harmonics: Harmonics) -> Result<Self, HarmonicError> {
        if let Some(defect) = lap.defect() {
            return Err(HarmonicError::Model(defect));
        }
        let slipping = Slipping::of(&lap.joint)?;
        let mut lap = *lap;
        if let Some(slipping) = &slipping {
            for dof in 0..D {
                let stuck = slipping.on(dof).map_or(0.0, Remembering::stuck);
                lap.joint.linear.stiffness[dof][dof] += stuck;
            }
        }
        let terms = lap.joint.polynomials();
        let degree = terms.iter().map(Polynomial::degree).fold(0, usize::max);
        // Relative stiffness and inertia of each DOF: the joint's, and those of the bodies in series.
        let in_series = |a: f64, b: f64| if a + b > 0.0 { a * b / (a + b) } else { 0.0 };
        let stiffness: [f64; D] = std::array::from_fn(|i| {
            let own = lap.joint.linear.stiffness[i][i].abs();
            let held = own + in_series(lap.a.stiffness[i], lap.b.stiffness[i]);
            if held > 0.0 { held } else { 1.0 }
        });
        let inertia = in_series(lap.a.inertia[0], lap.b.inertia[0]);
        Ok(Self {
            lap,
            slipping,
            sampling: Sampling::new(&harmonics, degree),
            harmonics,
            terms,
            length: std::array::from_fn(|i| (stiffness[0] / stiffness[i]).sqrt()),
            stiffness: stiffness[0],
            omega: (stiffness[0] / inertia).sqrt(),
        })
    }

    /// The harmonics that the motion is made of.
    #[must_use]
    pub fn harmonics(&self) -> &Harmonics {
        &self.harmonics
    }

    /// Number of real coefficients of the relative motion.
    pub(super) fn size(&self) -> usize {
        D * self.harmonics.slots()
    }

    pub(super) fn check_loads(&self, loads: &HarmonicLoads<D>) -> Result<(), HarmonicError> {
        if !loads.is_finite() {
            return Err(HarmonicError::Value {
                what: "loads",
                found: f64::NAN,
                expected: "finite amplitudes",
            });
        }
        if loads.has_constant() && !self.harmonics.has_constant() {
            return Err(HarmonicError::ConstantLoad);
        }
        let at = Circumstances {
            omega: 0.0,
            load_factor: 1.0,
            released: 0.0,
        };
        for dof in 0..D {
            if Condensed::new(&self.lap, loads, dof, 0, at).is_carried_away() {
                return Err(HarmonicError::Value {
                    what: "constant loads",
                    found: loads.constant.a[dof] + loads.constant.b[dof],
                    expected: "a sum of zero on bodies without supports",
                });
            }
        }
        Ok(())
    }

    /// Order and place of each harmonic, the constant term as order 0 among them.
    pub(super) fn all_places(&self) -> impl Iterator<Item = (usize, usize)> + Clone + '_ {
        let constant = self.harmonics.has_constant().then_some((0, 0));
        constant.into_iter().chain(self.harmonics.places())
    }

    /// Order and place of the harmonic of this order, if it is among those of the balance.
    pub(super) fn place_of(&self, order: usize) -> Option<(usize, usize)> {
        self.all_places().find(|place| place.0 == order)
    }

    /// Complex amplitude of one harmonic of a list of coefficients.
    pub(super) fn amplitude(
        &self,
        coefficients: &[f64],
        dof: usize,
        (order, place): (usize, usize),
    ) -> Complex64 {
        let at = dof * self.harmonics.slots() + place;
        match order {
            0 => coefficients[at].into(),
            // a cos + b sin = Re((a − jb) e^{jτ})
            _ => Complex64::new(coefficients[at], -coefficients[at + 1]),
        }
    }

    /// Adds a harmonic's complex amplitude to a list of coefficients.
    fn add(
        &self,
        amplitude: Complex64,
        dof: usize,
        (order, place): (usize, usize),
        coefficients: &mut [f64],
    ) {
        let at = dof * self.harmonics.slots() + place;
        coefficients[at] += amplitude.re;
        if order > 0 {
            coefficients[at + 1] -= amplitude.im;
        }
    }

    /// Room for evaluations.
    pub(super) fn room(&self) -> Evaluation {
        let (size, samples) = (self.size(), self.sampling.count());
        let list = || vec![0.0; size];
        let series = || vec![0.0; samples];
        Evaluation {
            residual: list(),
            by_omega: list(),
            by_factor: list(),
            by_released: list(),
            jacobian: DMatrix::zeros(size, size),
            r: series(),
            rate: series(),
            force: series(),
            stiffness: series(),
            damping: series(),
            damping_force: series(),
            spectrum: Spectrum::default(),
        }
    }

    /// What is out of balance at this motion.
    pub(super) fn evaluate(
        &self,
        coefficients: &[f64],
        loads: &HarmonicLoads<D>,
        at: Circumstances,
        result: &mut Evaluation,
    ) {
        for list in [
            &mut result.residual,
            &mut result.by_omega,
            &mut result.by_factor,
            &mut result.by_released,
        ] {
            list.fill(0.0);
        }
        result.jacobian.fill(0.0);
        self.add_linear(coefficients, loads, at, result);
        for dof in 0..D {
            self.add_terms(dof, coefficients, at.omega, result);
            if let Some(laws) = self.slipping.as_ref().and_then(|all| all.on(dof)) {
                let slots = self.harmonics.slots();
                let from = dof * slots;
                let course = Course::new(&self.harmonics, &coefficients[from..from + slots]);
                laws.add(course, from, &mut result.residual, &mut result.jacobian);
            }
        }
    }

    fn add_linear(
        &self,
        coefficients: &[f64],
        loads: &HarmonicLoads<D>,
        at: Circumstances,
        result: &mut Evaluation,
    ) {
        let slots = self.harmonics.slots();
        let law = &self.lap.joint.linear;
        for (order, place) in self.all_places() {
            let harmonic = (order, place);
            let h = order as f64;
            for i in 0..D {
                let bodies = Condensed::new(&self.lap, loads, i, order, at);
                let (z, p) = (bodies.stiffness(), bodies.load());
                let r = self.amplitude(coefficients, i, harmonic);
                // z r + (K + jΩC) r + f(r) − p = 0
                let mut value = z.value * r - p.value;
                let mut by_omega = z.by_omega * r - p.by_omega;
                let by_released = z.by_released * r - p.by_released;
                for j in 0..D {
                    let joint =
                        Complex64::new(law.stiffness[i][j], h * at.omega * law.damping[i][j]);
                    let other = self.amplitude(coefficients, j, harmonic);
                    value += joint * other;
                    by_omega += Complex64::new(0.0, h * law.damping[i][j]) * other;
                    let entry = if i == j { z.value + joint } else { joint };
                    let (row, column) = (i * slots + place, j * slots + place);
                    result.jacobian[(row, column)] += entry.re;
                    if order > 0 {
                        // cos: Zr a + Zi b;  sin: Zr b − Zi a
                        result.jacobian[(row, column + 1)] += entry.im;
                        result.jacobian[(row + 1, column)] -= entry.im;
                        result.jacobian[(row + 1, column + 1)] += entry.re;
                    }
                }
                self.add(value, i, harmonic, &mut result.residual);
                self.add(by_omega, i, harmonic, &mut result.by_omega);
                self.add(by_released, i, harmonic, &mut result.by_released);
                if order == 1 {
                    let unit = Circumstances {
                        load_factor: 1.0,
                        ..at
                    };
                    let whole = Condensed::new(&self.lap, loads, i, order, unit);
                    self.add(-whole.load().value, i, harmonic, &mut result.by_factor);
                }
            }
        }
    }

    fn add_terms(&self, dof: usize, coefficients: &[f64], omega: f64, result: &mut Evaluation) {
        let slots = self.harmonics.slots();
        let from = dof * slots;
        let terms = &self.terms[dof];
        let own = &coefficients[from..from + slots];
        self.sampling
            .motion(&self.harmonics, own, &mut result.r, &mut result.rate);
        for n in 0..self.sampling.count() {
            let tangent = terms.tangent(result.r[n], omega * result.rate[n]);
            result.force[n] = tangent.force;
            result.stiffness[n] = tangent.stiffness;
            result.damping[n] = tangent.damping;
        }
        let add = |samples: &[f64], list: &mut [f64]| {
            self.sampling
                .add_harmonics(&self.harmonics, samples, &mut list[from..from + slots]);
        };
        add(&result.force, &mut result.residual);
        self.sampling
            .spectrum(&result.stiffness, &mut result.spectrum);
        self.add_products(&result.spectrum, None, from, &mut result.jacobian);
        if terms.has_damping() {
            for n in 0..self.sampling.count() {
                result.damping_force[n] = result.damping[n] * result.rate[n];
            }
            add(&result.damping_force, &mut result.by_omega);
            self.sampling
                .spectrum(&result.damping, &mut result.spectrum);
            self.add_products(&result.spectrum, Some(omega), from, &mut result.jacobian);
        }
    }

    /// Adds the harmonics of g·(cos lτ, sin lτ), or of g·ω·(−l sin lτ, l cos lτ) where ω is given: products of two harmonics
    /// are sums of the spectrum of g at the sum and at the difference of their orders.
    fn add_products(
        &self,
        g: &Spectrum,
        omega: Option<f64>,
        from: usize,
        jacobian: &mut DMatrix<f64>,
    ) {
        let mut add = |row: usize, column: usize, order: usize, by_cosine: f64, by_sine: f64| {
            let (row, column) = (from + row, from + column);
            let (a, b) = match omega {
                None => (by_cosine, by_sine),
                Some(omega) => {
                    let rate = omega * order as f64;
                    (-rate * by_sine, rate * by_cosine)
                }
            };
            jacobian[(row, column)] += a;
            if order > 0 {
                jacobian[(row, column + 1)] += b;
            }
        };
        for (l, column) in self.all_places() {
            for (h, row) in self.all_places() {
                if h == 0 {
                    add(row, column, l, g.cosine[l], g.sine[l]);
                    continue;
                }
                if l == 0 {
                    add(row, column, l, 2.0 * g.cosine[h], 0.0);
                    add(row + 1, column, l, 2.0 * g.sine[h], 0.0);
                    continue;
                }
                // sin (h − l)τ changes its sign with h − l
                let (apart, sign) = if h >= l { (h - l, 1.0) } else { (l - h, -1.0) };
                let (cosine_sum, cosine_apart) = (g.cosine[h + l], g.cosine[apart]);
                let (sine_sum, sine_apart) = (g.sine[h + l], sign * g.sine[apart]);
                // 2 cos h cos l = cos(h−l) + cos(h+l);  2 cos h sin l = sin(h+l) − sin(h−l)
                add(
                    row,
                    column,
                    l,
                    cosine_apart + cosine_sum,
                    sine_sum - sine_apart,
                );
                // 2 sin h cos l = sin(h+l) + sin(h−l);  2 sin h sin l = cos(h−l) − cos(h+l)
                add(
                    row + 1,
                    column,
                    l,
                    sine_sum + sine_apart,
                    cosine_apart - cosine_sum,
                );
            }
        }
    }

    /// Derivative of what is out of balance with respect to a number of the model, at fixed motion.
    pub(super) fn by_parameter(
        &self,
        parameter: Parameter,
        coefficients: &[f64],
        loads: &HarmonicLoads<D>,
        at: Circumstances,
    ) -> Vec<f64> {
        let mut result = vec![0.0; self.size()];
        match parameter {
            // The frequency is an unknown of the equations, and changes with them.
            Parameter::AngularFrequency => {}
            Parameter::LoadFactor => {
                let mut evaluation = self.room();
                self.evaluate(coefficients, loads, at, &mut evaluation);
                for (result, by_factor) in result.iter_mut().zip(&evaluation.by_factor) {
                    *result = at.load_factor * by_factor;
                }
            }
            Parameter::Term(term, dof) => {
                self.add_term(term, dof, coefficients, at.omega, &mut result);
            }
            Parameter::JointStiffness(row, column) => {
                let unit = |_| Complex64::ONE;
                self.add_joint(row, column, coefficients, unit, &mut result);
            }
            Parameter::JointDamping(row, column) => {
                let viscous = |h: f64| Complex64::new(0.0, h * at.omega);
                self.add_joint(row, column, coefficients, viscous, &mut result);
            }
            Parameter::Inertia(..)
            | Parameter::SupportStiffness(..)
            | Parameter::SupportDamping(..) => {
                if let Some((side, number, dof)) = parameter.of_body() {
                    for harmonic in self.all_places() {
                        let bodies = Condensed::new(&self.lap, loads, dof, harmonic.0, at);
                        let [dz, dp] = bodies.by_number(side, number);
                        let r = self.amplitude(coefficients, dof, harmonic);
                        self.add(dz * r - dp, dof, harmonic, &mut result);
                    }
                }
            }
        }
        result
    }

    fn add_joint(
        &self,
        row: usize,
        column: usize,
        coefficients: &[f64],
        factor: impl Fn(f64) -> Complex64,
        result: &mut [f64],
    ) {
        for harmonic in self.all_places() {
            let factor = factor(harmonic.0 as f64);
            let mut entry = |i: usize, j: usize| {
                let r = self.amplitude(coefficients, j, harmonic);
                self.add(factor * r, i, harmonic, result);
            };
            entry(row, column);
            if row != column {
                entry(column, row);
            }
        }
    }

    /// Harmonics of r^p ṙ^q.
    fn add_term(
        &self,
        term: Term,
        dof: usize,
        coefficients: &[f64],
        omega: f64,
        result: &mut [f64],
    ) {
        let slots = self.harmonics.slots();
        let own = dof * slots..(dof + 1) * slots;
        // The term may be of a higher degree than those that the joint has.
        let sampling = Sampling::new(&self.harmonics, term.degree());
        let mut r = vec![0.0; sampling.count()];
        let mut rate = r.clone();
        let motion = &coefficients[own.clone()];
        sampling.motion(&self.harmonics, motion, &mut r, &mut rate);
        let [of_r, of_rate] = term.powers();
        for (r, rate) in r.iter_mut().zip(&rate) {
            *r = r.powi(of_r) * (omega * rate).powi(of_rate);
        }
        sampling.add_harmonics(&self.harmonics, &r, &mut result[own]);
    }
}

impl Parameter {
    /// The number of a body that it is, and its DOF.
    pub(super) fn of_body(self) -> Option<(super::Side, BodyNumber, usize)> {
        match self {
            Self::Inertia(side, dof) => Some((side, BodyNumber::Inertia, dof)),
            Self::SupportStiffness(side, dof) => Some((side, BodyNumber::Stiffness, dof)),
            Self::SupportDamping(side, dof) => Some((side, BodyNumber::Damping, dof)),
            _ => None,
        }
    }
}
