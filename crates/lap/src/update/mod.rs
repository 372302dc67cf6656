//! Updating of the lap model from natural frequencies: the paper's fireflies beside deterministic least squares, and what the
//! frequencies determine.

mod file;
mod firefly;
mod identifiability;
mod least_squares;
mod problem;
mod reliability;
mod study;
mod warnings;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

pub use firefly::{Firefly, FireflyResult, fireflies};
pub use identifiability::{Combination, Identifiability, Knowledge};
pub use least_squares::least_squares;
pub use problem::{Range, UpdateProblem};
pub use study::{LapUpdateStudy, TorqueData};

use super::parameter::LapParameters;
use bolted_joint_identify::Watch;
use bolted_joint_joint::Provenance;
use bolted_joint_study::{Method, StudyError};

/// The lap model updated at every torque of a study.
#[derive(Clone, Debug)]
pub struct LapUpdate {
    /// Name of the joint.
    pub name: String,
    /// One for each torque, ascending.
    pub torques: Vec<TorqueUpdate>,
    /// The search with fireflies, as the study set it.
    pub firefly: Firefly,
    /// Where the joints come from.
    pub provenance: Provenance,
}

/// The lap model updated from the frequencies at one torque.
#[derive(Clone, Debug)]
pub struct TorqueUpdate {
    /// What was measured.
    pub data: TorqueData,
    /// What was minimised.
    pub problem: UpdateProblem,
    /// What the fireflies found.
    pub firefly: FireflyResult,
    /// What least squares found: of all solutions the one nearest to the prior.
    pub solution: LapParameters,
    /// The objective there.
    pub objective: f64,
    /// What the frequencies say of each parameter.
    pub identifiability: Identifiability,
}

impl LapUpdate {
    /// Updates the model at every torque. `watch` hears of every generation of fireflies.
    ///
    /// # Errors
    /// [`StudyError`] if the study's file has vanished meanwhile.
    pub fn of(study: &LapUpdateStudy, watch: &dyn Watch) -> Result<Self, StudyError> {
        let torques = study.torques.iter().enumerate().map(|(number, data)| {
            let problem = study.problem(data);
            // Every torque has a stream of its own, so that the result at one does not depend on the others.
            let mut generator = ChaCha8Rng::seed_from_u64(study.firefly.seed);
            generator.set_stream(number as u64);
            let firefly = fireflies(&problem, &study.firefly, &mut generator, &|| watch.drawn());
            let solution = least_squares(&problem);
            TorqueUpdate {
                data: data.clone(),
                firefly,
                solution,
                objective: problem.objective(&solution),
                identifiability: Identifiability::of(&problem, &solution, data.relative_deviation),
                problem,
            }
        });
        let torques = torques.collect();
        Ok(Self {
            name: study.name.clone(),
            torques,
            firefly: study.firefly,
            provenance: super::input::origin(
                Method::LapUpdate,
                "lap",
                &study.path,
                &[],
                study.notes.clone(),
                watch,
            )?,
        })
    }
}
