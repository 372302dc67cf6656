//! Values of a study that are not known well, and what follows from them: every result is a power of each, so a draw scales
//! what was computed once.

use std::fmt;

use serde::Serialize;

use super::super::uncertain::{
    Distribution, Drawn, InputPlace, Inputs, MonteCarlo, Outcome, Refusal, Spread, Uncertain,
};
use super::damping::SlipDamping;
use super::error::LayeredBeamError;
use super::joint_file::terms;
use super::lap::EquivalentDamping;
use super::study::LayeredBeamStudy;
use bolted_joint_joint::{
    Correlation, Intervals, StandardDeviation, Uncertainty, UncertaintyAtPreload,
    UncertaintyOverPreload,
};

/// What the tension in a fastener follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TensionFrom {
    /// Stress of rivets.
    Stress,
    /// Preload of bolts.
    Preload,
    /// Nut factor, which the tension is the inverse of.
    NutFactor,
}

/// The values that a study may give with a standard deviation.
#[derive(Clone, Copy, Debug)]
pub(super) struct UncertainValues {
    pub(super) stiffness_ratio: Uncertain,
    pub(super) tension: (TensionFrom, Uncertain),
    /// α′μ, or the damping ratio that it is calibrated by.
    pub(super) friction: Uncertain,
    /// Whether the calibration was on the study's own beam and fasteners; `None` where α′μ is given.
    pub(super) calibrated_on_own: Option<[bool; 2]>,
}

/// What is drawn, and how often.
#[derive(Clone, Debug)]
pub struct Scatter {
    monte_carlo: MonteCarlo,
    inputs: Inputs,
    stiffness_ratio: InputPlace,
    tension: InputPlace,
    is_inverse: bool,
    friction: InputPlace,
    calibrated_on_own: Option<[bool; 2]>,
}

/// A value drawn over that given.
struct Factors {
    stiffness: f64,
    tension: f64,
    alpha_mu: f64,
}

impl Scatter {
    /// `None` where everything is known exactly.
    pub(super) fn of(values: &UncertainValues, monte_carlo: MonteCarlo) -> Option<Self> {
        let mut inputs = Inputs::default();
        // the nominal value 1 is the bound itself
        let spread = match values.stiffness_ratio.is_exact() {
            true => Spread::Normal,
            false => Spread::NormalWithin {
                low: 0.0,
                high: 1.0,
            },
        };
        let ratio = Distribution::new(spread, values.stiffness_ratio);
        let stiffness_ratio = inputs.add("beam.stiffness_ratio", ratio);
        let (from, tension) = values.tension;
        let name = match from {
            TensionFrom::Stress => "fasteners.stress",
            TensionFrom::Preload => "fasteners.preload",
            TensionFrom::NutFactor => "fasteners.nut_factor",
        };
        let tension = inputs.add(name, Distribution::new(Spread::Lognormal, tension));
        let name = match values.calibrated_on_own {
            None => "friction.alpha_mu",
            Some(_) => "friction.calibration.damping_ratio",
        };
        let friction = inputs.add(name, Distribution::new(Spread::Lognormal, values.friction));
        (!inputs.are_exact()).then_some(Self {
            monte_carlo,
            inputs,
            stiffness_ratio,
            tension,
            is_inverse: from == TensionFrom::NutFactor,
            friction,
            calibrated_on_own: values.calibrated_on_own,
        })
    }

    fn factors(&self, drawn: &Drawn) -> Factors {
        let nominal = self.inputs.nominal();
        let of = |place: InputPlace| drawn.of(place) / nominal.of(place);
        let stiffness = of(self.stiffness_ratio);
        let tension = of(self.tension);
        let tension = if self.is_inverse {
            1.0 / tension
        } else {
            tension
        };
        // α′μ = π ζ k w/(N (h₁ + h₂) Y): what was calibrated on the same beam follows its stiffness and tension
        let [on_beam, on_fasteners] = self.calibrated_on_own.unwrap_or([false; 2]);
        let followed = if on_beam { stiffness } else { 1.0 };
        let divided = if on_fasteners { tension } else { 1.0 };
        Factors {
            stiffness,
            tension,
            alpha_mu: of(self.friction) * followed / divided,
        }
    }

    /// How many draws there are.
    pub(super) fn draws(&self) -> u64 {
        self.monte_carlo.draws
    }

    /// Draws everything; `over_torque` as in the study, `progress` is called after each draw.
    pub(super) fn run(
        &self,
        study: &LayeredBeamStudy,
        nominal: &SlipDamping,
        over_torque: &[(f64, SlipDamping)],
        progress: &(dyn Fn() + Sync),
    ) -> Result<Scattered, LayeredBeamError> {
        let first = study.amplitudes_m.first().copied().unwrap_or(f64::NAN);
        let damper = match study.damping {
            EquivalentDamping::AtAmplitude(_) => "c_yy",
            EquivalentDamping::Over(_) => "slip_force",
        };
        let mut names: Vec<String> = ["k_yy", damper, "frequency_hz", "damping_ratio"]
            .map(str::to_owned)
            .to_vec();
        for (torque, _) in over_torque {
            names.extend(["k_yy", damper].map(|name| format!("{name}@{torque}")));
        }
        let pair = |damping: &SlipDamping, factors: &Factors, how: &EquivalentDamping| {
            let damping = damping.scaled(factors);
            let (stiffness, damper) = terms(&damping, how).map_err(|error| Refusal {
                reason: error.to_string(),
            })?;
            Ok::<_, Refusal>([stiffness, damper.size()])
        };
        let model = |drawn: &Drawn| {
            let factors = self.factors(drawn);
            let mut results = pair(nominal, &factors, &study.damping)?.to_vec();
            let damping = nominal.scaled(&factors);
            results.extend([damping.mode.frequency_hz(), damping.damping_ratio(first)]);
            for (_, damping) in over_torque {
                results.extend(pair(damping, &factors, &study.damping)?);
            }
            Ok(results)
        };
        let outcome = self.monte_carlo.run(&self.inputs, &names, model, progress);
        let outcome = outcome.map_err(LayeredBeamError::MonteCarlo)?;
        Ok(Scattered {
            outcome,
            torques: over_torque.iter().map(|(torque, _)| *torque).collect(),
        })
    }
}

impl SlipDamping {
    fn scaled(&self, factors: &Factors) -> Self {
        let mut scaled = self.clone();
        // ω² and k are proportional to EI; shapes and masses do not depend on it
        scaled.mode.angular_frequency *= factors.stiffness.sqrt();
        scaled.mode.stiffness_n_per_m *= factors.stiffness;
        scaled.slip_moment_n_m *= factors.tension;
        scaled.alpha_mu *= factors.alpha_mu;
        scaled
    }
}

/// What the draws came to.
#[derive(Clone, Debug)]
pub(super) struct Scattered {
    outcome: Outcome,
    torques: Vec<f64>,
}

/// One result with its scatter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScatterRow {
    /// Its name: `k_yy` and `c_yy` or `slip_force` of the joint file, `frequency_hz`, `damping_ratio` at the smallest amplitude.
    pub name: String,
    /// Mean of the draws.
    pub mean: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
    /// From the 2.5th to the 97.5th percentile.
    pub interval_95: [f64; 2],
}

impl fmt::Display for ScatterRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.interval_95;
        write!(
            f,
            "{} scatters by {:.2e} about {:.5e}, 95 % from {low:.5e} to {high:.5e}",
            self.name, self.standard_deviation, self.mean
        )
    }
}

impl Scattered {
    pub(super) fn rows(&self) -> Vec<ScatterRow> {
        let rows = self.outcome.estimates.iter().map(|estimate| ScatterRow {
            name: estimate.name.clone(),
            mean: estimate.mean,
            standard_deviation: estimate.standard_deviation,
            interval_95: estimate.interval_95,
        });
        rows.collect()
    }

    /// For the joint file.
    pub(super) fn uncertainty(&self) -> Uncertainty {
        let of = &self.outcome.of;
        let suffixes = self.torques.iter().map(|torque| format!("@{torque}"));
        let suffixes: Vec<String> = suffixes.collect();
        let at = suffixes
            .iter()
            .zip(&self.torques)
            .map(|(suffix, &preload)| UncertaintyAtPreload {
                preload,
                standard_deviation: self.deviation(suffix),
                interval_95: Some(self.intervals(suffix)),
                ..UncertaintyAtPreload::default()
            });
        Uncertainty {
            standard_deviation: self.deviation(""),
            basis: format!(
                "Monte Carlo over {}: {} draws, seed {}; scatter of what was put into the model, not the model's own error",
                self.outcome.inputs.join(", "),
                of.draws,
                of.seed
            ),
            correlation: Some(self.correlation(&["k_yy".to_owned(), "c_yy".to_owned()])),
            interval_95: Some(self.intervals("")),
            over_preload: (!self.torques.is_empty()).then(|| {
                let names = suffixes.iter();
                let names =
                    names.flat_map(|suffix| ["k_yy", "c_yy"].map(|n| format!("{n}{suffix}")));
                let names: Vec<String> = names.collect();
                UncertaintyOverPreload {
                    at: at.collect(),
                    correlation: Some(self.correlation(&names)),
                }
            }),
            ..Uncertainty::default()
        }
    }

    fn deviation(&self, suffix: &str) -> StandardDeviation {
        let of = |name: &str| {
            let estimate = self.outcome.estimate(&format!("{name}{suffix}"));
            vec![vec![estimate.map_or(0.0, |found| found.standard_deviation)]]
        };
        StandardDeviation {
            stiffness: of("k_yy"),
            damping: of("c_yy"),
            ..StandardDeviation::default()
        }
    }

    fn intervals(&self, suffix: &str) -> Intervals {
        let of = |name: &str| {
            let estimate = self.outcome.estimate(&format!("{name}{suffix}"));
            vec![vec![estimate.map_or([0.0; 2], |found| found.interval_95)]]
        };
        Intervals {
            stiffness: of("k_yy"),
            damping: of("c_yy"),
        }
    }

    fn correlation(&self, names: &[String]) -> Correlation {
        let estimates = &self.outcome.estimates;
        let place = |name: &String| estimates.iter().position(|found| found.name == *name);
        // friction has no place among the unknowns of a joint file
        let names = names.iter().filter(|name| place(name).is_some());
        let places: Vec<usize> = names.clone().filter_map(place).collect();
        let entry = |i: usize, j: usize| match i == j {
            true => 1.0,
            // of a result that does not vary there is none
            false => Some(self.outcome.correlation[i][j])
                .filter(|value| value.is_finite())
                .unwrap_or(0.0),
        };
        let row = |&i: &usize| places.iter().map(|&j| entry(i, j)).collect();
        Correlation {
            unknowns: names.cloned().collect(),
            matrix: places.iter().map(row).collect(),
        }
    }
}
