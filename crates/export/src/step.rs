//! How long the Runge–Kutta steps of the lap model may be, and what a simulation of it should start with.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{Lap, Spectrum};

use super::ExportError;

/// Step (s) of a model in which nothing moves by itself, so that its eigenvalues say nothing.
const STEP_WITHOUT_MODES_S: f64 = 1e-3;

/// Runge–Kutta steps in the communication step that the FMU suggests: about twenty samples a period of the fastest mode.
const STEPS_PER_COMMUNICATION_STEP: f64 = 5.0;

/// Periods of the slowest mode in the simulation that the FMU suggests.
const SUGGESTED_PERIODS: f64 = 20.0;

/// Most communication steps in the simulation that the FMU suggests.
const SUGGESTED_STEPS: f64 = 1e5;

/// Part of the accurate step that a lap takes whose energies are counted.
///
/// RK4 changes the energy of a mode by 2π z⁵/72 of itself in a period, z = hω: 10⁻⁷ with the accurate step, which after
/// thousands of periods shows in a balance; with half of it 3·10⁻⁹.
const PART_FOR_ENERGY: f64 = 0.5;

/// Longest Runge–Kutta step of an exported lap model, the start value of `step_size_max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSize {
    /// The step, s.
    pub longest_s: f64,
    /// Why that one.
    pub choice: StepChoice,
    /// Largest |λ| of the model about rest, and within the amplitude that the joint file states, 1/s.
    pub largest_modulus: f64,
    /// Longest step with which RK4 is stable, s; `None` where no step makes it unstable.
    pub stability_limit_s: Option<f64>,
}

/// What the Runge–Kutta step of a lap shall be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepWish {
    /// One with which the fastest mode is accurate.
    Accurate,
    /// At most so long, s.
    AtMost(f64),
    /// As long as motions and joint loads are wrong by no more than this part of their largest values.
    Error(f64),
}

/// Why a step size was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepChoice {
    /// The user gave it.
    Given,
    /// The user said how large the error may be: what it is in the reference run, as a part of the largest values there.
    Error {
        /// With this step.
        found: f64,
        /// The step that the fastest mode asks for, s.
        of_modes_s: f64,
    },
    /// The fastest mode drifts by 1e-6 rad in a period with it.
    Accuracy,
    /// That of [`Self::Accuracy`], for a joint that remembers and of which no step is known to be accurate where it slips: none
    /// was found in the reference run, or that run does not stay finite.
    AccuracyAtRest,
    /// The model has no modes that would set one.
    NoModes,
}

/// The simulation that an FMU suggests, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Experiment {
    pub(super) stop_s: f64,
    pub(super) communication_step_s: f64,
}

impl StepSize {
    /// The step for a lap whose energies are counted: a shorter one, unless it was given.
    pub(super) fn for_energy(self) -> Self {
        match self.choice {
            StepChoice::Accuracy | StepChoice::AccuracyAtRest => Self {
                longest_s: rounded_down(PART_FOR_ENERGY * self.longest_s, 2),
                ..self
            },
            StepChoice::Given | StepChoice::Error { .. } | StepChoice::NoModes => self,
        }
    }

    /// Takes the step that is given, or picks one from the eigenvalues of the model, linear about every place that it
    /// shall be good for. Where an error is wished for, that is where its search begins.
    pub(super) fn choose<const D: usize>(
        laps: &[Lap<D>],
        wish: StepWish,
    ) -> Result<Self, ExportError> {
        let given_s = match wish {
            StepWish::AtMost(given_s) => Some(given_s),
            StepWish::Accurate | StepWish::Error(_) => None,
        };
        let spectra = laps.iter().map(Lap::spectrum).collect::<Option<Vec<_>>>();
        let spectra = spectra
            .filter(|spectra| !spectra.is_empty())
            .ok_or(ExportError::NoSpectrum)?;
        let largest_modulus = spectra
            .iter()
            .map(Spectrum::largest_modulus)
            .fold(0.0, f64::max);
        let stability_limit_s = spectra
            .iter()
            .filter_map(stability_limit_s)
            .min_by(f64::total_cmp);
        let accurate_s = spectra
            .iter()
            .filter_map(Spectrum::accurate_step_s)
            .min_by(f64::total_cmp);
        let is_stable_with = |step_s: f64| {
            spectra
                .iter()
                .all(|spectrum| spectrum.is_stable_with(step_s))
        };
        let (longest_s, choice) = match (given_s, accurate_s) {
            (Some(found_s), _) if !(found_s.is_finite() && found_s > 0.0) => {
                return Err(ExportError::StepNotPositive { found_s });
            }
            (Some(found_s), _) => match stability_limit_s {
                Some(limit_s) if !is_stable_with(found_s) => {
                    return Err(ExportError::StepUnstable {
                        found_s,
                        largest_modulus,
                        limit_s: rounded_down(limit_s, 3),
                    });
                }
                _ => (found_s, StepChoice::Given),
            },
            (None, Some(accurate_s)) => (rounded_down(accurate_s, 2), StepChoice::Accuracy),
            (None, None) => (STEP_WITHOUT_MODES_S, StepChoice::NoModes),
        };
        Ok(Self {
            longest_s,
            choice,
            largest_modulus,
            stability_limit_s,
        })
    }
}

impl Experiment {
    /// Some periods of the slowest mode, in communication steps that hold a whole number of Runge–Kutta steps.
    pub(super) fn of_lap(spectrum: Option<&Spectrum>, step: &StepSize) -> Self {
        let longest_s = STEPS_PER_COMMUNICATION_STEP * step.longest_s;
        let slowest = spectrum
            .into_iter()
            .flat_map(Spectrum::eigenvalues)
            .map(|eigenvalue| eigenvalue.imaginary.abs())
            .filter(|frequency| *frequency > 1e-6 * step.largest_modulus)
            .fold(f64::INFINITY, f64::min);
        // T = 2π/ω
        let wanted_s = SUGGESTED_PERIODS * TAU / slowest;
        let most_s = SUGGESTED_STEPS * longest_s;
        let stop_s = if wanted_s > 0.0 {
            wanted_s.min(most_s)
        } else {
            most_s.min(1.0)
        };
        let stop_s = rounded_down(stop_s, 1);
        Self {
            stop_s,
            communication_step_s: dividing(longest_s, stop_s),
        }
    }

    /// Twenty samples a period of the highest frequency that the joint was identified at.
    pub(super) fn of_element(highest_frequency_hz: f64) -> Self {
        let longest_s = 1.0 / (20.0 * highest_frequency_hz);
        let stop_s = rounded_down((SUGGESTED_STEPS * longest_s).min(1.0), 1);
        Self {
            stop_s,
            communication_step_s: dividing(longest_s, stop_s),
        }
    }
}

/// The longest step of two digits that is not above `step_s` and of which the stop time is a whole multiple: some tools refuse
/// others.
fn dividing(step_s: f64, stop_s: f64) -> f64 {
    let exponent = step_s.log10().floor() as i32 - 1;
    let leading = (step_s / 10.0_f64.powi(exponent) * (1.0 + 1e-12)).floor();
    // written as text, so that each is the very number
    let steps = (10..=leading as u32).rev();
    let mut steps = steps.filter_map(|digits| format!("{digits}e{exponent}").parse().ok());
    let divides = |step_s: &f64| {
        let count = stop_s / step_s;
        count >= 1.0 && (count - count.round()).abs() < 1e-9 * count
    };
    steps.find(divides).unwrap_or(step_s)
}

/// Longest step (s) with which RK4 is stable, by bisection.
fn stability_limit_s(spectrum: &Spectrum) -> Option<f64> {
    let mut stable_s = spectrum.accurate_step_s()?;
    // RK4's region of stability lies within |hλ| < 4.
    let mut unstable_s = 4.0 / spectrum.largest_modulus();
    if !spectrum.is_stable_with(stable_s) || spectrum.is_stable_with(unstable_s) {
        return None;
    }
    while unstable_s - stable_s > 1e-6 * stable_s {
        let middle_s = 0.5 * (stable_s + unstable_s);
        if spectrum.is_stable_with(middle_s) {
            stable_s = middle_s;
        } else {
            unstable_s = middle_s;
        }
    }
    Some(stable_s)
}

/// The largest number of so many significant decimal digits that does not exceed `value`, which is positive.
pub(super) fn rounded_down(value: f64, digits: i32) -> f64 {
    let exponent = value.log10().floor() as i32 + 1 - digits;
    // A quotient just below a whole number is that number, rounded.
    let mantissa = (value / 10_f64.powi(exponent) * (1.0 + 1e-14)).floor();
    // The decimal text gives the double nearest to the decimal number; a product of powers would not.
    format!("{mantissa}e{exponent}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_dynamics::{Body, Linear, STABILITY_LIMIT_IMAGINARY, STABILITY_LIMIT_REAL};

    fn lap(mass: f64, k: f64, c: f64, k12: f64, c12: f64) -> Lap<1> {
        let body = Body {
            inertia: [mass],
            stiffness: [k],
            damping: [c],
        };
        Lap {
            joint: Linear {
                stiffness: [[k12]],
                damping: [[c12]],
            }
            .into(),
            a: body,
            b: body,
        }
    }

    #[test]
    fn rounding_down_keeps_decimal_numbers() {
        for (value, digits, expected) in [
            (1.899e-5, 2, 1.8e-5),
            (1.8e-5, 2, 1.8e-5),
            (0.3, 1, 0.3),
            (9.99e-5, 1, 9e-5),
            (1.0, 2, 1.0),
            (123.0, 2, 120.0),
            (1e-5, 2, 1e-5),
        ] {
            assert_eq!(rounded_down(value, digits), expected, "{value}");
        }
    }

    #[test]
    fn the_limit_is_that_of_the_fastest_mode() {
        // Undamped: |λ| = √((k + 2 k12)/m) on the imaginary axis.
        let step =
            StepSize::choose(&[lap(2.35, 10.56e5, 0.0, 4.56e6, 0.0)], StepWish::Accurate).unwrap();
        let fastest = f64::sqrt((10.56e5 + 2.0 * 4.56e6) / 2.35);
        let limit = step.stability_limit_s.unwrap();
        assert!((limit * fastest / STABILITY_LIMIT_IMAGINARY - 1.0).abs() < 1e-5);
        // (1e-6 · 120/2π)^¼ = 0.066106 rad a step
        let accurate = 0.066_106 / fastest;
        assert!(step.longest_s <= accurate && step.longest_s > 0.95 * accurate);
        assert_eq!(step.choice, StepChoice::Accuracy);
        // Overdamped: λ ≈ −2 c12/m on the real axis.
        let step = StepSize::choose(&[lap(1.0, 0.0, 0.0, 0.0, 5e3)], StepWish::Accurate).unwrap();
        let limit = step.stability_limit_s.unwrap();
        assert!((limit * 1e4 / STABILITY_LIMIT_REAL - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_given_step_must_be_stable() {
        let model = lap(2.35, 10.56e5, 1.39, 4.56e6, 0.54);
        let step = StepSize::choose(&[model], StepWish::AtMost(2e-4)).unwrap();
        assert_eq!((step.longest_s, step.choice), (2e-4, StepChoice::Given));
        let message = StepSize::choose(&[model], StepWish::AtMost(2e-3))
            .unwrap_err()
            .to_string();
        // √((10.56e5 + 2·4.56e6)/2.35) = 2080.9 1/s; 2.828/2080.9 = 1.359e-3 s
        for fragment in ["found 0.002 s", "|λ| = 2.0809e3 1/s", "at most 0.00135 s"] {
            assert!(message.contains(fragment), "{message}");
        }
        for bad in [0.0, -1e-5, f64::NAN, f64::INFINITY] {
            let refused = StepSize::choose(&[model], StepWish::AtMost(bad)).unwrap_err();
            assert!(matches!(refused, ExportError::StepNotPositive { .. }));
        }
    }

    #[test]
    fn the_fastest_place_sets_the_step() {
        let slow = lap(2.35, 10.56e5, 1.39, 4.56e6, 0.54);
        let stiff = lap(2.35, 10.56e5, 1.39, 9.0e6, 0.54);
        let damped = lap(2.35, 10.56e5, 1.39, 4.56e6, 1e5);
        for fast in [stiff, damped] {
            let both = StepSize::choose(&[slow, fast], StepWish::Accurate).unwrap();
            assert_eq!(both, StepSize::choose(&[fast], StepWish::Accurate).unwrap());
            assert!(
                both.longest_s
                    < StepSize::choose(&[slow], StepWish::Accurate)
                        .unwrap()
                        .longest_s
            );
        }
        // stable about rest alone
        let given_s = 1e-4;
        assert!(StepSize::choose(&[slow], StepWish::AtMost(given_s)).is_ok());
        let refused = StepSize::choose(&[slow, damped], StepWish::AtMost(given_s));
        assert!(matches!(refused, Err(ExportError::StepUnstable { .. })));
    }

    #[test]
    fn a_model_without_modes_still_has_a_step() {
        let model = lap(1.0, 0.0, 0.0, 0.0, 0.0);
        let step = StepSize::choose(&[model], StepWish::Accurate).unwrap();
        assert_eq!(step.choice, StepChoice::NoModes);
        let experiment = Experiment::of_lap(model.spectrum().as_ref(), &step);
        assert!(experiment.stop_s > 0.0 && experiment.communication_step_s > 0.0);
    }

    #[test]
    fn the_suggested_simulation_shows_the_slowest_mode_and_resolves_the_fastest() {
        let model = lap(2.35, 10.56e5, 1.39, 4.56e6, 0.54);
        let step = StepSize::choose(&[model], StepWish::Accurate).unwrap();
        let experiment = Experiment::of_lap(model.spectrum().as_ref(), &step);
        // 20 periods of 670.35 rad/s are 0.187 s.
        assert_eq!(experiment.stop_s, 0.1);
        assert_eq!(step.longest_s, 3.1e-5);
        // five Runge–Kutta steps are 1.55e-4 s, and the longest below that of which 0.1 s is a multiple is this one
        assert_eq!(experiment.communication_step_s, 1e-4);
    }

    #[test]
    fn the_suggested_step_divides_the_stop_time() {
        for (longest, stop, expected) in [
            (9.7e-5, 1.0, 8e-5),
            (1.55e-4, 0.3, 1.5e-4),
            (1e-4, 0.1, 1e-4),
            (9.99e-6, 0.7, 8e-6),
        ] {
            let found = dividing(longest, stop);
            assert_eq!(found, expected, "{longest} {stop}");
            // in decimal: as the texts are
            let digits = |number: f64| format!("{number:e}");
            let (step, stop) = (digits(found), digits(stop));
            assert!(step.len() <= 6 && stop.len() <= 6, "{step} {stop}");
        }
        for frequency_hz in [3.0, 97.0, 512.0, 1031.0, 5154.6] {
            let experiment = Experiment::of_element(frequency_hz);
            let count = experiment.stop_s / experiment.communication_step_s;
            assert!(
                (count - count.round()).abs() < 1e-9 * count,
                "{frequency_hz}: {count}"
            );
        }
    }
}
