//! The lap model as a test sees it: what is unknown, and force, response and phase as functions of the relative amplitude.

use std::borrow::Cow;
use std::f64::consts::FRAC_PI_2;

use bolted_joint_dynamics::{Polynomial, law::Term};
use nalgebra::DVector;
use num_complex::Complex64;
use serde::Serialize;

use super::data::{SineLine, wrapped};
use super::dynamic_stiffness::RelativeMotion;
use super::slider::{Slider, SliderParameter, SliderValues};
use super::study::{Noise, Place};
use super::terms::{self, TermSet};

/// A number that a study may leave unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum ResponseUnknown {
    /// m of each body, kg.
    Mass,
    /// k of each support, N/m.
    SupportStiffness,
    /// c of each support, N·s/m.
    SupportDamping,
    /// k12 of the joint, N/m.
    JointStiffness,
    /// c12 of the joint, N·s/m.
    JointDamping,
    /// A term of the joint that depends on amplitude.
    Term(#[serde(serialize_with = "terms::by_symbol")] Term),
    /// A parameter of a law that slips.
    Slider(SliderParameter),
    /// Real part of what other modes add to the receptance, m/N.
    OtherModesReal,
    /// Imaginary part of that, m/N.
    OtherModesImaginary,
}

impl ResponseUnknown {
    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Mass => "m",
            Self::SupportStiffness => "k",
            Self::SupportDamping => "c",
            Self::JointStiffness => "k12",
            Self::JointDamping => "c12",
            Self::Term(term) => term.row().symbol,
            Self::Slider(parameter) => parameter.symbol(),
            Self::OtherModesReal => "Re ρ",
            Self::OtherModesImaginary => "Im ρ",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> Cow<'static, str> {
        let unit = match self {
            Self::Mass => "kg",
            Self::SupportStiffness | Self::JointStiffness => "N/m",
            Self::SupportDamping | Self::JointDamping => "N·s/m",
            Self::Term(term) => return terms::unit_of(term).into(),
            Self::Slider(parameter) => parameter.unit(),
            Self::OtherModesReal | Self::OtherModesImaginary => "m/N",
        };
        unit.into()
    }
}

/// A motion of the two bodies that may resonate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// Both together, which leaves the joint alone.
    Together,
    /// One against the other.
    Relative,
}

impl Motion {
    /// All.
    pub const ALL: [Self; 2] = [Self::Together, Self::Relative];
}

/// A value of everything.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Values {
    /// m of each body, kg.
    pub mass: f64,
    /// k of each support, N/m.
    pub support_stiffness: f64,
    /// c of each support, N·s/m.
    pub support_damping: f64,
    /// k12 of the joint, N/m; beside a law that slips that of small motion, the law's own stiffness among it.
    pub joint_stiffness: f64,
    /// c12 of the joint, N·s/m.
    pub joint_damping: f64,
    /// The terms of the joint that depend on amplitude, in their SI units.
    #[serde(serialize_with = "terms::as_list")]
    pub terms: Polynomial,
    /// The law of the joint that slips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slider: Option<SliderValues>,
    /// What other modes add to the receptance, real and imaginary part, m/N.
    pub other_modes: [f64; 2],
}

impl Default for Values {
    /// Zero everywhere.
    fn default() -> Self {
        Self {
            mass: 0.0,
            support_stiffness: 0.0,
            support_damping: 0.0,
            joint_stiffness: 0.0,
            joint_damping: 0.0,
            terms: Polynomial::NONE,
            slider: None,
            other_modes: [0.0; 2],
        }
    }
}

impl Values {
    /// The value of a term.
    #[must_use]
    pub fn term(&self, term: Term) -> f64 {
        self.terms.coefficient(term)
    }

    /// What the joint's linear spring has: k12, less the stiffness of a law that slips, N/m.
    #[must_use]
    pub fn spring(&self) -> f64 {
        let of_slider = self.slider.map_or(0.0, |slider| slider.stiffness());
        self.joint_stiffness - of_slider
    }

    /// K = k/2 + k12: linear stiffness of the relative motion, N/m.
    #[must_use]
    pub fn relative_stiffness(&self) -> f64 {
        0.5 * self.support_stiffness + self.joint_stiffness
    }

    /// C = c/2 + c12: viscous damping of the relative motion, N·s/m.
    #[must_use]
    pub fn relative_damping(&self) -> f64 {
        0.5 * self.support_damping + self.joint_damping
    }

    /// The same beside Iwan's law with all parameters where none of them is far from those that a motion tells; `None` of others.
    pub(super) fn moderate(&self) -> Option<Self> {
        let slider = self.slider.filter(|slider| slider.slider == Slider::Iwan)?;
        Some(Self {
            slider: Some(slider.moderate()),
            ..*self
        })
    }

    /// The same where Iwan's law has next to nothing that slips last, with a part of it; `None` of others.
    pub(super) fn with_a_last_slider(&self) -> Option<Self> {
        let slider = self.slider?.with_a_last_slider()?;
        Some(Self {
            slider: Some(slider),
            ..*self
        })
    }

    /// The value of an unknown, zero of what is not there.
    #[must_use]
    pub fn of(&self, unknown: ResponseUnknown) -> f64 {
        if let ResponseUnknown::Slider(parameter) = unknown {
            return self.slider.map_or(0.0, |slider| slider.of(parameter));
        }
        let mut copy = *self;
        copy.place(unknown).map_or(0.0, |place| *place)
    }

    /// Where a search finds an unknown; of a law that slips there are logarithms. `None` of what is not there.
    pub(super) fn place(&mut self, unknown: ResponseUnknown) -> Option<&mut f64> {
        let place = match unknown {
            ResponseUnknown::Slider(parameter) => return self.slider.as_mut()?.place(parameter),
            ResponseUnknown::Mass => &mut self.mass,
            ResponseUnknown::SupportStiffness => &mut self.support_stiffness,
            ResponseUnknown::SupportDamping => &mut self.support_damping,
            ResponseUnknown::JointStiffness => &mut self.joint_stiffness,
            ResponseUnknown::JointDamping => &mut self.joint_damping,
            ResponseUnknown::Term(term) => self.terms.coefficient_mut(term),
            ResponseUnknown::OtherModesReal => &mut self.other_modes[0],
            ResponseUnknown::OtherModesImaginary => &mut self.other_modes[1],
        };
        Some(place)
    }
}

/// What a test excites and measures, and what of it is unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Where the force acts.
    pub drive: Place,
    /// What is measured.
    pub response: Place,
    /// The terms that depend on amplitude.
    pub terms: TermSet,
    /// What is unknown.
    pub unknowns: Vec<ResponseUnknown>,
    /// Highest harmonic of the relative motion, odd; one is the closed form of describing functions.
    pub harmonics: usize,
}

/// One line's residuals in standard deviations (force, response, phase), with their derivatives.
pub(super) struct LineResidual {
    pub(super) residual: [f64; 3],
    /// Row by unknown.
    pub(super) by_unknown: Vec<[f64; 3]>,
    /// By the logarithm of the relative amplitude.
    pub(super) by_log_amplitude: [f64; 3],
}

impl Model {
    /// By how much the unknowns are more in the second than in the first, as they are searched.
    pub(super) fn change(&self, from: &Values, to: &Values) -> DVector<f64> {
        let (mut from, mut to) = (*from, *to);
        let change = self.unknowns.iter().map(|&unknown| {
            let pair = from.place(unknown).zip(to.place(unknown));
            pair.map_or(0.0, |(from, to)| *to - *from)
        });
        DVector::from_iterator(self.unknowns.len(), change)
    }

    /// The values with the unknowns changed by so much, as they are searched.
    pub(super) fn moved(&self, values: &Values, change: &DVector<f64>) -> Values {
        let mut moved = *values;
        for (unknown, change) in self.unknowns.iter().zip(change.iter()) {
            if let Some(place) = moved.place(*unknown) {
                *place += change;
            }
        }
        if let Some(slider) = &mut moved.slider {
            slider.keep_in_range();
        }
        moved
    }

    /// Half the difference of the loads on a and b, and their sum, at a unit force.
    fn loads(&self) -> (f64, f64) {
        match self.drive {
            Place::A => (0.5, 1.0),
            Place::B => (-0.5, 1.0),
            Place::Relative => (1.0, 0.0),
        }
    }

    /// Shares of x₁ + x₂ and of x₁ − x₂ in what is measured.
    fn shares(&self) -> (f64, f64) {
        match self.response {
            Place::A => (0.5, 0.5),
            Place::B => (0.5, -0.5),
            Place::Relative => (0.0, 1.0),
        }
    }

    /// q d: receptance times z_r, where nothing but the relative motion is seen.
    pub(super) fn relative_factor(&self) -> f64 {
        self.loads().0 * self.shares().1
    }

    /// Share of the relative motion in what is measured.
    pub(super) fn relative_share(&self) -> f64 {
        self.shares().1
    }

    /// Half the difference of the loads at a unit force.
    pub(super) fn relative_load(&self) -> f64 {
        self.loads().0
    }

    /// Whether the motion of both bodies together is excited and seen.
    #[must_use]
    pub fn sees_sum(&self) -> bool {
        self.loads().1 * self.shares().0 != 0.0
    }

    /// z_s = k − ω² m + jω c: load over motion of both bodies together.
    fn sum_stiffness(values: &Values, omega: f64) -> Complex64 {
        Complex64::new(
            values.support_stiffness - values.mass * omega * omega,
            omega * values.support_damping,
        )
    }

    /// Phase of the response against the force where a motion resonates, rad; `None` of one that is not seen.
    pub(super) fn phase_of_resonance(&self, motion: Motion) -> Option<f64> {
        match motion {
            Motion::Together => self.sees_sum().then_some(-FRAC_PI_2),
            // driven at one body and seen at the other, the bodies' relative motion is turned round
            Motion::Relative => Some(-FRAC_PI_2.copysign(self.relative_factor())),
        }
    }

    /// Which motion makes more of the response.
    pub(super) fn strongest(&self, values: &Values, amplitude_m: f64, omega: f64) -> Motion {
        let (sum, of_sum) = (self.loads().1, self.shares().0);
        let together = of_sum * sum / Self::sum_stiffness(values, omega);
        let relative = self.relative_factor()
            / RelativeMotion::fundamental(values)
                .stiffness(amplitude_m, omega)
                .value;
        match self.sees_sum() && together.norm() > relative.norm() {
            true => Motion::Together,
            false => Motion::Relative,
        }
    }

    /// Receptance and force (N) at an amplitude of the relative motion (m).
    #[must_use]
    pub fn receptance(&self, values: &Values, amplitude_m: f64, omega: f64) -> (Complex64, f64) {
        let stiffness = RelativeMotion::new(values, self.harmonics)
            .stiffness(amplitude_m, omega)
            .value;
        let ((difference, sum), (of_sum, of_relative)) = (self.loads(), self.shares());
        let mut receptance = of_relative * difference / stiffness
            + Complex64::new(values.other_modes[0], values.other_modes[1]);
        if self.sees_sum() {
            receptance += of_sum * sum / Self::sum_stiffness(values, omega);
        }
        (
            receptance,
            stiffness.norm() * amplitude_m / difference.abs(),
        )
    }

    /// K: stiffness of the relative motion at an amplitude (m), N/m.
    #[must_use]
    pub fn equivalent_stiffness(&self, values: &Values, amplitude_m: f64) -> f64 {
        RelativeMotion::fundamental(values)
            .stiffness(amplitude_m, 0.0)
            .value
            .re
    }

    /// A first guess of a line's relative amplitude, m: what of the response the linear parts do not explain.
    #[must_use]
    pub fn relative_amplitude(&self, values: &Values, line: &SineLine) -> f64 {
        let ((difference, sum), (of_sum, of_relative)) = (self.loads(), self.shares());
        let measured = Complex64::from_polar(line.displacement_m / line.force_n, line.phase_rad);
        let mut rest = measured - Complex64::new(values.other_modes[0], values.other_modes[1]);
        if self.sees_sum() {
            rest -= of_sum * sum / Self::sum_stiffness(values, line.omega);
        }
        let by_rest = rest.norm() * line.force_n / of_relative.abs();
        let linear = RelativeMotion::fundamental(values)
            .stiffness(0.0, line.omega)
            .value
            .norm();
        let by_force = difference.abs() * line.force_n / linear;
        // Away from the relative mode's resonance the rest is a small difference of large numbers.
        let smaller_cost = [by_rest, by_force].map(|amplitude| {
            let (receptance, force) = self.receptance(values, amplitude, line.omega);
            let response = (receptance.norm() * force / line.displacement_m).ln();
            (force / line.force_n).ln().powi(2) + response.powi(2)
        });
        if smaller_cost[0] <= smaller_cost[1] {
            by_rest
        } else {
            by_force
        }
    }

    /// A line's residuals at a relative amplitude.
    pub(super) fn residual(
        &self,
        values: &Values,
        motion: &RelativeMotion<'_>,
        line: &SineLine,
        log_amplitude: f64,
        noise: &Noise,
    ) -> LineResidual {
        let amplitude = log_amplitude.exp();
        let omega = line.omega;
        let z = motion.stiffness(amplitude, omega);
        let ((difference, sum), (of_sum, of_relative)) = (self.loads(), self.shares());
        let sum_stiffness = Self::sum_stiffness(values, omega);
        let (from_sum, by_sum) = if self.sees_sum() {
            let part = of_sum * sum / sum_stiffness;
            (part, -part / sum_stiffness)
        } else {
            (Complex64::ZERO, Complex64::ZERO)
        };
        // h = p e/z_s + q d/z_r + ρ,  |F| = |z_r| R/|d|
        let from_relative = of_relative * difference / z.value;
        let by_relative = -from_relative / z.value;
        let other = Complex64::new(values.other_modes[0], values.other_modes[1]);
        let receptance = from_sum + from_relative + other;
        let force = z.value.norm() * amplitude / difference.abs();
        let [for_force, for_response, for_phase] = noise.weights(line);
        // d ln F = Re(dz_r/z_r) (+ d ln R),  d ln h = dh/h: real part of the modulus, imaginary part of the angle
        let rows = |dz_r: Complex64, dh: Complex64, of_amplitude: f64| {
            let log_force = (dz_r / z.value).re + of_amplitude;
            let log_receptance = dh / receptance;
            [
                -for_force * log_force,
                -for_response * (log_receptance.re + log_force),
                -for_phase * log_receptance.im,
            ]
        };
        let by_unknown = self.unknowns.iter().map(|unknown| {
            let j_omega = Complex64::new(0.0, omega);
            let (dz_r, dz_s): (Complex64, Complex64) = match *unknown {
                ResponseUnknown::Mass => (z.by_mass, (-omega * omega).into()),
                ResponseUnknown::SupportStiffness => (0.5 * z.by_stiffness, Complex64::ONE),
                ResponseUnknown::SupportDamping => (0.5 * z.by_damping, j_omega),
                ResponseUnknown::JointStiffness => (z.by_stiffness, Complex64::ZERO),
                ResponseUnknown::JointDamping => (z.by_damping, Complex64::ZERO),
                ResponseUnknown::Term(term) => (z.by_term[term.index()], Complex64::ZERO),
                ResponseUnknown::Slider(parameter) => (z.by_slider(parameter), Complex64::ZERO),
                ResponseUnknown::OtherModesReal => {
                    return rows(Complex64::ZERO, Complex64::ONE, 0.0);
                }
                ResponseUnknown::OtherModesImaginary => {
                    return rows(Complex64::ZERO, Complex64::I, 0.0);
                }
            };
            rows(dz_r, by_relative * dz_r + by_sum * dz_s, 0.0)
        });
        LineResidual {
            residual: [
                for_force * (line.force_n / force).ln(),
                for_response * (line.displacement_m / (receptance.norm() * force)).ln(),
                for_phase * wrapped(line.phase_rad - receptance.arg()),
            ],
            by_unknown: by_unknown.collect(),
            by_log_amplitude: rows(z.by_log_amplitude, by_relative * z.by_log_amplitude, 1.0),
        }
    }
}
