//! The estimate from lines alone: what it was asked for, and what came of it.

mod identified;

use nalgebra::DMatrix;

use bolted_joint_draws::Draw;
use bolted_joint_frf::structure::{ComplexMatrix, SingularAssembly};
use bolted_joint_joint::Drawn;

use super::assessment::Assessment;
use super::bands::{BandChoices, UsedBands};
use super::bootstrap::Bootstrap;
use super::budget::Systematic;
use super::choice::ModelChoice;
use super::decoupling;
use super::joint_estimate::{BootstrapResult, JointEstimate};
use super::layout::{Bolts, Layout};
use super::line_by_line::Equations;
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::{Levels, Noise, NoiseLevel};
use super::observed::Observed;
use super::search::Effort;
use super::sensitivity::{self, Sensitivity};
use super::torque::{TorqueChoice, TorqueDependence};
use super::uncertainty::Covariance;

pub use identified::identify_lines;

/// What an identification from lines is to do beyond the estimate itself.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// The bolts, whose DOFs follow one another in the lines.
    pub bolts: Bolts,
    /// Noise of everything measured.
    pub noise: Noise,
    /// Bands of the averages.
    pub bands: BandChoices,
    /// A joint to start from at every bolt, beside the starts that the data give.
    pub start: Option<JointMatrices>,
    /// Whether to compare the joint models and, where there are several torques, a common joint with separate ones.
    pub compare_models: bool,
    /// Tightening torque of each assembly, N·m; empty where not all are known.
    pub torques_n_m: Vec<f64>,
    /// Whether each torque has a joint of its own.
    pub dependence: TorqueDependence,
    /// How many points of each assembly, the last ones, are on A; none where the list is empty.
    pub points_on_a: Vec<usize>,
    /// Whether an estimate with errors of the set-up follows, which has a search of its own where these lead this one astray.
    pub has_budget: bool,
    /// Bootstrap to run, if any.
    pub bootstrap: Option<Bootstrap>,
    /// Called after each draw of the bootstrap.
    pub progress: Option<&'a (dyn Fn() + Sync)>,
}

impl Options<'_> {
    fn effort(&self) -> Effort {
        if self.has_budget && self.noise.is_stated() {
            Effort::BesideBudget
        } else {
            Effort::Whole
        }
    }
}

/// The estimate from lines alone, with what led to it.
#[derive(Clone, Debug)]
pub struct LinesEstimate {
    decoupled: Vec<Vec<Option<ComplexMatrix>>>,
    /// The equations by which each assembly was decoupled; none where it was not.
    pub equations: Vec<Option<Equations>>,
    /// All joints: the common one, or one for each torque in the order of their first assemblies.
    pub joints: Vec<JointEstimate>,
    joint_of_assembly: Vec<usize>,
    layout: Layout,
    /// Covariance of the unknowns of one torque after the other, in the order of [`Self::joints`]: common errors of the
    /// substructures correlate them.
    pub covariance_of_all: DMatrix<f64>,
    /// Whether the residual is noise.
    pub assessment: Assessment,
    /// Noise of the assembly's functions, stated or estimated; `None` where coherence tells it line by line, and without
    /// degrees of freedom to estimate it.
    pub noise_level: Option<NoiseLevel>,
    /// How many starts were tried, and how many of them led to this estimate.
    pub starts: (usize, usize),
    /// Lines that the estimate rests on, of how many, those of all assemblies together. It leaves out those at which the errors of
    /// measured substructures act too far from linearly.
    pub lines_used: (usize, usize),
    /// Noise of everything measured, stated or estimated.
    pub(super) levels: Levels,
    /// By how many standard deviations an unknown still moved when the search ended: zero where it had come to rest, infinite
    /// where nothing can be said.
    pub unrest: f64,
    /// How much of what seems to be information is noise of the substructures, where several bolts have joints of their own.
    pub(super) observed: Option<Observed>,
    /// The draws of the bootstrap that were made or given, where one was asked for: the unknowns of one torque after the other.
    pub draws: Option<Vec<Draw>>,
    choice: Option<ModelChoice>,
    torque_choice: Option<TorqueChoice>,
    /// What the user should know before using the estimate.
    pub warnings: Vec<String>,
    /// Those of the warnings that speak of the values of the joint and of what it leaves.
    joint_warnings: Vec<String>,
}

/// What is said of *the* joint is that of the first assembly, which all have in common unless each torque has its own, and
/// at the first bolt where every bolt has its own.
impl LinesEstimate {
    /// K* of each line of each assembly at the bolts that have joint number `bolt`, a list for each of them.
    #[must_use]
    pub fn decoupled_of(&self, bolt: usize) -> Vec<Vec<Vec<Option<ComplexMatrix>>>> {
        let dofs = self.layout.model().dofs();
        let at = |bolt| {
            let lists = self.decoupled.iter();
            lists
                .map(|list| decoupling::of_bolt(list, bolt, dofs))
                .collect()
        };
        self.layout.bolts_with(bolt).map(at).collect()
    }

    /// The same with joints, deviations and warnings of an estimate in which the set-up's errors take part.
    #[must_use]
    pub(super) fn with_systematic_errors(self, found: &Systematic, bolts: &[String]) -> Self {
        let plain = self.joints.into_iter();
        let joints: Vec<JointEstimate> = plain
            .enumerate()
            .map(|(number, joint)| joint.with_systematic_errors(found, number, bolts))
            .collect();
        let mut warnings = self.warnings;
        warnings.retain(|warning| !self.joint_warnings.contains(warning));
        let joint_warnings: Vec<String> = joints
            .iter()
            .flat_map(|joint| joint.warnings(bolts))
            .collect();
        warnings.extend(joint_warnings.iter().cloned());
        warnings.extend(found.warnings());
        Self {
            joints,
            warnings,
            joint_warnings,
            covariance_of_all: found.covariance.clone(),
            observed: found.observed.clone(),
            unrest: if found.converged { 0.0 } else { f64::INFINITY },
            ..self
        }
    }

    /// The same with what a bootstrap of noise and causes shows.
    #[must_use]
    pub(super) fn with_draws(mut self, bootstrap: &Bootstrap, draws: Vec<Draw>) -> Self {
        let size = self.layout.unknowns();
        for (number, joint) in self.joints.iter_mut().enumerate() {
            let own = number * size..(number + 1) * size;
            joint.bootstrap = Some(BootstrapResult::of(
                bootstrap,
                Drawn::NoiseAndSetUp,
                &draws,
                own,
            ));
        }
        self.draws = Some(draws);
        self
    }

    /// The equations of the decoupling, one after the other, where any assembly was measured on A.
    #[must_use]
    pub fn equations_on_both_sides(&self) -> Option<String> {
        let mut named: Vec<String> = Vec::new();
        for equations in self.equations.iter().flatten() {
            let name = equations.to_string();
            if !named.contains(&name) {
                named.push(name);
            }
        }
        let is_on_a = |equations: &Option<Equations>| *equations != Some(Equations::Ss);
        let is_any = self.equations.iter().flatten().count() > 0;
        (is_any && self.equations.iter().any(is_on_a)).then(|| named.join("; "))
    }

    /// The number of the joint that each assembly has.
    pub(super) fn joint_numbers(&self) -> &[usize] {
        &self.joint_of_assembly
    }

    /// The joint in one of the assemblies; the first one's if there are not so many.
    #[must_use]
    pub fn joint_of(&self, assembly: usize) -> &JointEstimate {
        let joint = self.joint_of_assembly.get(assembly).copied().unwrap_or(0);
        &self.joints[joint]
    }

    /// Whether an assembly has the joint of the first one.
    #[must_use]
    pub fn has_first_joint(&self, assembly: usize) -> bool {
        self.joint_of_assembly.get(assembly) == Some(&0)
    }

    /// The joints by torque.
    #[must_use]
    pub fn by_torque(&self) -> Vec<&JointEstimate> {
        let mut joints: Vec<&JointEstimate> = self.joints.iter().collect();
        let torque = |joint: &JointEstimate| joint.torque_n_m.unwrap_or(0.0);
        joints.sort_by(|a, b| torque(a).total_cmp(&torque(b)));
        joints
    }

    /// The joint: the passive estimate where there is one.
    #[must_use]
    pub fn joint(&self) -> &JointMatrices {
        self.joints[0].joint()
    }

    /// The joint of each bolt that has one of its own, or the one for all.
    #[must_use]
    pub fn bolts(&self) -> &[JointMatrices] {
        self.joints[0].bolts()
    }

    /// K and C over the DOFs of all bolts, as [`Lines::regenerated`] takes them.
    #[must_use]
    pub fn whole(&self) -> &JointMatrices {
        &self.joints[0].whole
    }

    /// The estimate that is free to be active.
    #[must_use]
    pub fn free(&self) -> &JointMatrices {
        &self.joints[0].free[0]
    }

    /// Covariance of the unknowns, and which of them are identified.
    #[must_use]
    pub fn covariance(&self) -> &Covariance {
        &self.joints[0].covariance
    }

    /// One standard deviation of each entry.
    #[must_use]
    pub fn standard_deviation(&self, model: JointModel) -> JointMatrices {
        self.joints[0].standard_deviation(model)
    }

    /// How much each measured receptance of `lines`, those of an assembly, depends on each unknown entry, at this estimate.
    ///
    /// # Errors
    /// [`SingularAssembly`] at an undamped resonance.
    pub fn sensitivities(
        &self,
        assembly: usize,
        lines: &Lines,
    ) -> Result<Vec<Sensitivity>, SingularAssembly> {
        sensitivity::to_unknowns(lines, &self.layout, &self.joint_of(assembly).whole)
    }

    /// Average of the decoupled values, one of the starts.
    #[must_use]
    pub fn band_average(&self) -> Option<&JointMatrices> {
        self.joints[0].band_average()
    }

    /// The bands that each entry of each bolt's joint is averaged over.
    #[must_use]
    pub fn bands(&self) -> &[Vec<UsedBands>] {
        &self.joints[0].bands
    }

    /// The joint models beside each other, where they were compared.
    #[must_use]
    pub fn model_choice(&self) -> Option<&ModelChoice> {
        self.choice.as_ref()
    }

    /// A common joint beside one for each torque, where there are several torques and they were compared.
    #[must_use]
    pub fn torque_choice(&self) -> Option<&TorqueChoice> {
        self.torque_choice.as_ref()
    }

    /// Names of the unknowns that a draw of the bootstrap has: `left k_yy@10` is that of the bolt `left` at 10 N·m.
    #[must_use]
    pub fn names_of_draws(&self, bolts: &[String]) -> Vec<String> {
        let joints = self.joints.iter();
        let names = joints.flat_map(|joint| {
            let at = joint.torque_n_m.map(|torque| format!("@{torque}"));
            let unknowns = joint.covariance.unknowns.iter();
            unknowns.map(move |own| own.label(bolts) + at.as_deref().unwrap_or_default())
        });
        names.collect()
    }

    /// The bootstrap, where one was asked for.
    #[must_use]
    pub fn bootstrap(&self) -> Option<&BootstrapResult> {
        self.joints[0].bootstrap.as_ref()
    }
}
