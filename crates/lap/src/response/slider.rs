//! Laws that slip, as unknowns of a lap: by logarithms, so that no step of a search leaves their range, and about the stiffness of
//! small motion, which responses tell best.

mod first_loading;
mod many;
mod range;

use std::f64::consts::PI;

use bolted_joint_dynamics::{
    Dual, Number,
    law::{Iwan, Jenkins, Law},
};
use num_complex::Complex64;
use serde::{Serialize, Serializer};

use self::many::ManySliders;

pub(super) use self::first_loading::FirstLoading;

/// Unknowns of a law at most.
pub(super) const MOST: usize = 4;
/// φ_max of small motion over the largest amplitude observed: responses do not tell it, but that all does not slip before.
const BEYOND: f64 = 2.0;

/// A law that slips, beside the joint's spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slider {
    /// One elastic slider.
    Jenkins,
    /// Iwan's law of small motion: R and χ alone, since nothing slips through.
    MicroSlip,
    /// Iwan's law with all four parameters.
    Iwan,
}

/// A parameter of such a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SliderParameter {
    /// K_T, while all sticks, N/m.
    Stiffness,
    /// F_S, at which all slips, N.
    SlipForce,
    /// R, density of the sliders over the displacement at which they slip, N/m^(χ+2).
    Density,
    /// χ, the power of that density.
    Exponent,
    /// β, stiffness of what slips last over that of all else.
    Ratio,
}

impl Slider {
    /// All of them, from the simplest.
    pub const ALL: [Self; 3] = [Self::Jenkins, Self::MicroSlip, Self::Iwan];

    /// Its name in studies and in comparisons.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Jenkins => "jenkins",
            Self::MicroSlip => "micro-slip",
            Self::Iwan => "iwan",
        }
    }

    /// Its parameters.
    #[must_use]
    pub fn parameters(self) -> &'static [SliderParameter] {
        use SliderParameter::{Density, Exponent, Ratio, SlipForce, Stiffness};
        match self {
            Self::Jenkins => &[Stiffness, SlipForce],
            Self::MicroSlip => &[Density, Exponent],
            Self::Iwan => &[SlipForce, Stiffness, Exponent, Ratio],
        }
    }

    /// The parameters that its law has in a file, in their order there.
    pub(super) fn in_file(self) -> &'static [SliderParameter] {
        match self {
            Self::Jenkins => self.parameters(),
            // micro-slip is Iwan's law before anything slips through
            Self::MicroSlip | Self::Iwan => Self::Iwan.parameters(),
        }
    }
}

impl SliderParameter {
    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Stiffness => "K_T",
            Self::SlipForce => "F_S",
            Self::Density => "R",
            Self::Exponent => "χ",
            Self::Ratio => "β",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Stiffness => "N/m",
            Self::SlipForce => "N",
            Self::Density => "N/m^(χ+2)",
            Self::Exponent | Self::Ratio => "",
        }
    }
}

/// What a law that slips has for values.
///
/// Its unknowns are logarithms: of K_T and F_S/K_T (m) for one slider; for Iwan's law of the stiffness that is lost at the `reference_m`,
/// of χ + 1, of φ_max over the reference, and of β.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderValues {
    /// The law.
    pub slider: Slider,
    /// Largest amplitude of the relative motion that was observed, m.
    pub reference_m: f64,
    pub(super) logs: [f64; MOST],
}

/// A law with values of one kind of number.
enum Valued<N> {
    Jenkins(Jenkins<N>),
    Iwan(Iwan<N>),
}

/// What a law that slips adds to the dynamic stiffness of the relative motion, beyond its stiffness of small motion.
pub(super) struct Slipping {
    pub(super) value: Complex64,
    /// By the logarithm of the amplitude.
    pub(super) by_log_amplitude: Complex64,
    /// By its unknowns.
    pub(super) by_unknown: [Complex64; MOST],
}

impl SliderValues {
    /// One slider with these values, N/m and N.
    #[must_use]
    pub fn jenkins(stiffness: f64, slip_force: f64, reference_m: f64) -> Self {
        Self {
            slider: Slider::Jenkins,
            reference_m,
            logs: [stiffness.ln(), (slip_force / stiffness).ln(), 0.0, 0.0],
        }
    }

    /// Iwan's law that loses so much stiffness (N/m) at the reference, of `slider`.
    pub(super) fn iwan(
        slider: Slider,
        lost_n_per_m: f64,
        exponent: f64,
        [span, ratio]: [f64; 2],
        reference_m: f64,
    ) -> Self {
        let logs = [
            lost_n_per_m.ln(),
            (exponent + 1.0).ln(),
            span.ln(),
            ratio.ln(),
        ];
        Self {
            slider,
            reference_m,
            logs,
        }
    }

    fn law<N: Number>(&self, logs: [N; MOST]) -> Valued<N> {
        let one = N::from(1.0);
        let reference = N::from(self.reference_m);
        let [first, second, third, fourth] = logs;
        // K_l = R A^(χ+1)/(χ+1), at φ_max K_l (φ_max/A)^(χ+1); S = β of that
        let (span, ratio) = match self.slider {
            Slider::Jenkins => {
                return Valued::Jenkins(Jenkins {
                    stiffness: first.exp(),
                    slip_force: (first + second).exp(),
                });
            }
            Slider::MicroSlip => (N::from(BEYOND), N::ZERO),
            Slider::Iwan => (third.exp(), fourth.exp()),
        };
        let above = second.exp();
        let lost = first.exp() * span.powf(above);
        // K_T = R φ_max^(χ+1)/(χ+1) + S,  F_S = R φ_max^(χ+2)/(χ+2) + S φ_max
        Valued::Iwan(Iwan {
            slip_force: lost * span * reference * (above / (above + one) + ratio),
            stiffness: lost * (one + ratio),
            exponent: above - one,
            ratio,
        })
    }

    /// K_T, stiffness while all sticks, N/m.
    pub(super) fn stiffness(&self) -> f64 {
        self.stiffness_of(self.logs)
    }

    /// K_T with these unknowns in place of its own, N/m.
    pub(super) fn stiffness_of<N: Number>(&self, logs: [N; MOST]) -> N {
        match self.law(logs) {
            Valued::Jenkins(law) => law.stiffness,
            Valued::Iwan(law) => law.stiffness,
        }
    }

    /// Its parameters in the order of [`Slider::parameters`], each with its derivatives by the unknowns.
    pub(super) fn parameters(&self) -> Vec<(f64, [f64; MOST])> {
        let logs = std::array::from_fn(|i| Dual::<MOST>::along(self.logs[i], i));
        let one = Dual::from(1.0);
        let all = match (self.slider, self.law(logs)) {
            (_, Valued::Jenkins(law)) => vec![law.stiffness, law.slip_force],
            (Slider::MicroSlip, Valued::Iwan(law)) => {
                // R = K_l (χ+1)/A^(χ+1)
                let above = law.exponent + one;
                let lost = logs[0].exp();
                let density = lost * above / Dual::from(self.reference_m).powf(above);
                vec![density, law.exponent]
            }
            (_, Valued::Iwan(law)) => {
                vec![law.slip_force, law.stiffness, law.exponent, law.ratio]
            }
        };
        all.into_iter().map(|n| (n.value, n.change)).collect()
    }

    /// Displacement at which the curve of first loading has a corner, m.
    pub(super) fn corner_m(&self) -> f64 {
        match self.law(self.logs) {
            Valued::Jenkins(law) => law.nonlinear_amplitude(0.0, 0.0),
            Valued::Iwan(law) => law.nonlinear_amplitude(0.0, 0.0),
        }
    }

    /// Makes it softer where it is stiffer than this, N/m.
    pub(super) fn soften_to(&mut self, stiffness: f64) {
        // K_T grows with the first unknown's exponential
        self.logs[0] += (stiffness / self.stiffness()).ln().min(0.0);
    }

    /// Derivatives of K_T by the unknowns.
    pub(super) fn stiffness_by_unknowns(&self) -> [f64; MOST] {
        let logs = std::array::from_fn(|i| Dual::<MOST>::along(self.logs[i], i));
        self.stiffness_of(logs).change
    }

    /// Derivatives of K_T by its parameters, in the order of [`Slider::parameters`].
    pub(super) fn stiffness_by_parameters(&self) -> Vec<f64> {
        let parameters = self.slider.parameters().iter();
        let by = |parameter: &SliderParameter| match (self.slider, parameter) {
            (_, SliderParameter::Stiffness) => 1.0,
            // K_T = R φ_max^(χ+1)/(χ+1)
            (Slider::MicroSlip, SliderParameter::Density) => self.stiffness() / self.of(*parameter),
            (Slider::MicroSlip, SliderParameter::Exponent) => {
                let above = self.of(*parameter) + 1.0;
                self.stiffness() * ((BEYOND * self.reference_m).ln() - above.recip())
            }
            _ => 0.0,
        };
        parameters.map(by).collect()
    }

    /// The law of a joint file: its name there and its parameters, in the order of its declaration.
    pub(super) fn in_file(&self) -> (&'static str, Vec<f64>) {
        match self.law(self.logs) {
            Valued::Jenkins(law) => (
                <Jenkins as Law<f64>>::DECLARATION.name,
                vec![law.stiffness, law.slip_force],
            ),
            Valued::Iwan(law) => (
                <Iwan as Law<f64>>::DECLARATION.name,
                vec![law.slip_force, law.stiffness, law.exponent, law.ratio],
            ),
        }
    }

    /// Its unknowns as other numbers, each made of its parameter and itself.
    pub(super) fn logs_as<N: Number>(
        &self,
        number: impl Fn(SliderParameter, f64) -> N,
    ) -> [N; MOST] {
        let mut logs = self.logs.map(N::from);
        for (log, parameter) in logs.iter_mut().zip(self.slider.parameters()) {
            *log = number(*parameter, log.value());
        }
        logs
    }

    /// Place of a parameter's unknown.
    pub(super) fn index(&self, parameter: SliderParameter) -> Option<usize> {
        let mut all = self.slider.parameters().iter();
        all.position(|own| *own == parameter)
    }

    /// Value of a parameter, zero of what is not there.
    pub(super) fn of(&self, parameter: SliderParameter) -> f64 {
        let index = self.index(parameter);
        index.map_or(0.0, |index| self.parameters()[index].0)
    }

    /// Where a search finds the unknown of a parameter.
    pub(super) fn place(&mut self, parameter: SliderParameter) -> Option<&mut f64> {
        let index = self.index(parameter)?;
        self.logs.get_mut(index)
    }

    /// Its closed loops, made ready for many amplitudes.
    pub(super) fn closed_loops(&self) -> ClosedLoops {
        ClosedLoops(match self.slider {
            Slider::Jenkins => Loops::One([0, 1].map(|i| self.logs[i].exp())),
            Slider::MicroSlip | Slider::Iwan => {
                let is_small = self.slider == Slider::MicroSlip;
                Loops::Many(ManySliders::new(self.logs, self.reference_m, is_small))
            }
        })
    }
}

/// The closed loops of a law at given values.
pub(super) struct ClosedLoops(Loops);

enum Loops {
    /// Of one slider: k (N/m) and h/k (m).
    One([f64; 2]),
    /// Of many.
    Many(ManySliders),
}

impl ClosedLoops {
    /// What the law adds at an amplitude of the relative motion, m.
    pub(super) fn at(&self, amplitude_m: f64) -> Slipping {
        match &self.0 {
            _ if amplitude_m.is_nan() || amplitude_m <= 0.0 => Slipping::NONE,
            Loops::One(numbers) => of_one_slider(*numbers, amplitude_m),
            Loops::Many(sliders) => sliders.slipping(amplitude_m),
        }
    }
}

impl Slipping {
    /// Of what does not move.
    const NONE: Self = Self {
        value: Complex64::ZERO,
        by_log_amplitude: Complex64::ZERO,
        by_unknown: [Complex64::ZERO; MOST],
    };
}

/// One slider k, h in its closed loop: z − k.
fn of_one_slider([stiffness, slips_at_m]: [f64; 2], amplitude_m: f64) -> Slipping {
    let part = slips_at_m / amplitude_m;
    if part >= 1.0 {
        return Slipping::NONE;
    }
    // θ_s = arccos(1 − 2h/(kU)); a₁ = (kU/π)(θ_s − ½ sin 2θ_s); b₁ = −(4h/π)(1 − h/(kU))
    let cosine = 1.0 - 2.0 * part;
    let sine = 2.0 * (part * (1.0 - part)).sqrt();
    let stays = (cosine.acos() - sine * cosine) / PI;
    let loss = 4.0 / PI * part * (1.0 - part);
    let value = stiffness * Complex64::new(stays - 1.0, loss);
    // by ln(h/(kU)): dθ_s/dcos θ_s = −1/sin θ_s
    let by_part = stiffness * 4.0 / PI * part * Complex64::new(sine, 1.0 - 2.0 * part);
    Slipping {
        value,
        by_log_amplitude: -by_part,
        by_unknown: [value, by_part, Complex64::ZERO, Complex64::ZERO],
    }
}

impl Serialize for Slider {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Serialize for SliderValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let names = self.slider.parameters().iter().map(|of| of.symbol());
        let values = self.parameters().into_iter().map(|(value, _)| value);
        serializer.collect_map(names.zip(values))
    }
}

impl Serialize for SliderParameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.symbol())
    }
}

#[cfg(test)]
mod tests;
