//! A prediction: the joint at the values given, and how it scatters with those that are uncertain.

use super::check::InterfaceStudy;
use super::error::ModelError;
use super::model::State;
use super::results;
use crate::uncertain::{Drawn, Estimate, MonteCarlo, MonteCarloError, Outcome, Refusal};
use crate::virtual_material::VirtualMaterial;
use std::ops::Range;

use bolted_joint_draws::Draw;
use bolted_joint_study::StudyError;

/// What is said of every prediction of an interface.
pub const CONTACT_ALONE: &str = "This is the contact alone, not the joint: the bolt and the bending of the parts where they overlap are missing, \
                                 and can make a joint thousands of times as soft.";

/// A predicted joint.
#[derive(Debug, Clone)]
pub struct Prediction<'s> {
    /// What it was predicted from.
    pub study: &'s InterfaceStudy,
    /// The joint at the values given, at each torque of the table in ascending order, or once.
    pub states: Vec<State>,
    /// Fractal dimension and roughness (m) of both surfaces together, at the values given.
    pub roughness: [f64; 2],
    /// What the draws came to, where a value is uncertain. The names of its results are those of the joint file's unknowns, of the
    /// diagonal of the 6×6 stiffness (`K_zz`) and of the loss factors (`eta_n`), with `@` and the torque behind them where
    /// there are several.
    pub outcome: Option<Outcome>,
}

impl<'s> Prediction<'s> {
    /// Computes a study. `progress` is called after each draw, from any thread.
    ///
    /// # Errors
    /// [`StudyError::Model`] where the values given are outside the model, or hardly any draw is inside.
    pub fn of(study: &'s InterfaceStudy, progress: &(dyn Fn() + Sync)) -> Result<Self, StudyError> {
        let found = Self::without_draws(study)?;
        let names = found.results();
        let model = |values: &Drawn| found.drawn(values, names.len());
        let run = |monte_carlo: MonteCarlo| monte_carlo.run(&study.inputs, &names, model, progress);
        let outcome = study.monte_carlo.map(run).transpose();
        found.with(outcome)
    }

    /// Computes a study whose draws have been made, all of them, by [`Prediction::part`].
    ///
    /// # Errors
    /// As [`Prediction::of`].
    pub fn of_parts(study: &'s InterfaceStudy, draws: &[Draw]) -> Result<Self, StudyError> {
        let found = Self::without_draws(study)?;
        let names = found.results();
        let run = |monte_carlo: MonteCarlo| monte_carlo.of_parts(&study.inputs, &names, draws);
        let outcome = study.monte_carlo.map(run).transpose();
        found.with(outcome)
    }

    /// The draws of these numbers; none where no value is uncertain. `progress` is called after each, from any thread.
    #[must_use]
    pub fn part(&self, numbers: Range<u64>, progress: &(dyn Fn() + Sync)) -> Vec<Draw> {
        let count = self.results().len();
        let model = |values: &Drawn| self.drawn(values, count);
        let part = |monte_carlo: MonteCarlo| {
            monte_carlo.part(numbers, &self.study.inputs, model, progress)
        };
        self.study.monte_carlo.map(part).unwrap_or_default()
    }

    /// Names of what a draw gives.
    #[must_use]
    pub fn results(&self) -> Vec<String> {
        let study = self.study;
        let (dofs, slipping) = (study.motions.dofs(), study.slipping_dofs());
        let torques = study.torques().into_iter();
        torques
            .flat_map(|torque| results::names(dofs, &slipping, torque))
            .collect()
    }

    /// Computes a study at the values given alone.
    ///
    /// # Errors
    /// [`StudyError::Model`] where they are outside the model.
    pub fn without_draws(study: &'s InterfaceStudy) -> Result<Self, StudyError> {
        let refused = |reason| refusal(study, reason);
        let torques = study.torques();
        let nominal = study.inputs.nominal();
        let roughness = study.roughness(&nominal).map_err(refused)?;
        let law = study.law(&nominal).map_err(refused)?;
        let states = torques
            .iter()
            .map(|&torque| study.state(&nominal, &law, torque))
            .collect::<Result<Vec<_>, _>>()
            .map_err(refused)?;
        Ok(Self {
            study,
            states,
            roughness: [roughness.fractal_dimension(), roughness.roughness_m()],
            outcome: None,
        })
    }

    /// The `count` results of all torques at drawn values.
    fn drawn(&self, values: &Drawn, count: usize) -> Result<Vec<f64>, Refusal> {
        let study = self.study;
        let law = study.law(values)?;
        let mut all = Vec::with_capacity(count);
        for torque in study.torques() {
            let drawn = study.drawn_joint(values, &law, torque)?;
            all.extend(results::values(study.motions.dofs(), &drawn));
        }
        Ok(all)
    }

    /// The same with what the draws came to.
    fn with(self, outcome: Result<Option<Outcome>, MonteCarloError>) -> Result<Self, StudyError> {
        let refused = |error| refusal(self.study, ModelError::from(error));
        let outcome = outcome.map_err(refused)?;
        Ok(Self { outcome, ..self })
    }

    /// The joint at the nominal torque, or the only one.
    #[must_use]
    pub fn nominal(&self) -> &State {
        let nominal = self.study.nominal_n_m;
        let found = self.states.iter().find(|state| state.torque_n_m == nominal);
        // There is a state at every torque, and the nominal one is one of them.
        found.unwrap_or(&self.states[0])
    }

    /// The isotropic material of the virtual layer at the nominal torque.
    ///
    /// # Errors
    /// [`StudyError::Model`] where the model has no layer, or its moduli are those of no isotropic material.
    pub fn material(&self) -> Result<VirtualMaterial, StudyError> {
        let layer = self.nominal().layer.as_ref();
        let material = match layer {
            Some(layer) => layer.material.clone().map_err(ModelError::from),
            None => Err(ModelError::NoLayer),
        };
        let path = &self.study.path;
        material.map_err(|reason| StudyError::model(path, Some("layer"), reason))
    }

    /// What the draws say of a result, such as `k_yy`, at a torque.
    #[must_use]
    pub fn estimate(&self, name: &str, torque_n_m: Option<f64>) -> Option<&Estimate> {
        let outcome = self.outcome.as_ref()?;
        outcome.estimate(&results::at(name, torque_n_m))
    }
}

/// What is said of a study that is outside the model.
fn refusal(study: &InterfaceStudy, reason: ModelError) -> StudyError {
    let key = key_of(&reason);
    StudyError::model(&study.path, Some(key), reason)
}

/// The key of the study that an error is about.
fn key_of(error: &ModelError) -> &'static str {
    match error {
        ModelError::Material(_) => "materials",
        ModelError::Roughness(_) | ModelError::Surface(_) => "surface",
        ModelError::Contact(_) | ModelError::NoLayer => "contact",
        ModelError::Pressure(_) => "pressure",
        ModelError::Tightening(_) => "tightening",
        ModelError::Field(_) => "interface.field",
        ModelError::Damping(_) => "damping",
        ModelError::Planar(_) => "joint",
        ModelError::CoupledSlip { .. } => "joint.reference",
        ModelError::Correlation(_) | ModelError::MonteCarlo(_) => "uncertainty",
    }
}
