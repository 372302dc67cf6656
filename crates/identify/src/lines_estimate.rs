//! From lines to a joint: decoupling, averages, the search, the passive estimate, and how sure all of it is.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use bolted_joint_draws::Draw;
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{ComplexMatrix, SingularAssembly};
use bolted_joint_joint::Drawn;

use super::assessment::Assessment;
use super::averages::{Decoupled, band_averages, first_bands, own_resonances, used_bands};
use super::bands::{BandChoices, UsedBands};
use super::bootstrap::{self, Bootstrap};
use super::budget::Systematic;
use super::choice::{self, ModelChoice};
use super::decoupling;
use super::error::IdentifyError;
use super::joint_estimate::{BootstrapResult, CovarianceOfAll, JointEstimate};
use super::layout::{Bolts, Layout};
use super::line_by_line::{Equations, decouple};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::{Levels, Noise, NoiseLevel, Of};
use super::observed::{self, Observed};
use super::parallel;
use super::passive;
use super::reliability::{NOTABLE_UNREST, TOLERABLE_UNREST};
use super::search::{Effort, Found};
use super::sensitivity::{self, Sensitivity};
use super::torque::{self, Assignment, Problem, TorqueChoice, TorqueDependence, Torques};
use super::uncertainty::Covariance;

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

/// Identifies a joint from the lines of one or more assemblies that have it in common, or one joint for each torque to
/// which they are tightened.
///
/// # Errors
/// [`IdentifyError::NoEstimate`] if no start leads to an estimate, [`IdentifyError::Torques`] if each torque is to have its
/// joint and there are not several of them.
pub fn identify_lines(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    parallel::among_them(|| identified(all, model, options))
}

fn identified(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    let first = all.iter().find(|lines| !lines.frequency_hz.is_empty());
    let dofs = first.map_or(0, Lines::joint_dofs);
    let layout = Layout::new(model, &options.bolts, dofs);
    let is_empty = all.iter().any(|lines| lines.measured.is_empty());
    let Some(layout) = layout.filter(|_| !is_empty) else {
        return Err(no_estimate(all, 0));
    };
    let torques = Torques::of(&options.torques_n_m, all.len());
    let dependence = options.dependence;
    let separate = match (dependence, &torques) {
        (TorqueDependence::Common, _) => None,
        (TorqueDependence::Separate, Some(torques)) => Some(torques),
        (TorqueDependence::Separate, None) => {
            return Err(IdentifyError::Torques {
                assemblies: all.len(),
                found_n_m: options.torques_n_m.clone(),
            });
        }
    };
    let assignment = match separate {
        None => Assignment::common(all),
        Some(torques) => Assignment::separate(all, torques),
    };
    let (joint_of_assembly, count): (Vec<usize>, usize) = (
        assignment.all.iter().map(|&(_, joint)| joint).collect(),
        assignment.joints,
    );
    let noise = &options.noise;
    let on_a = options.points_on_a.iter().copied();
    let on_a = on_a.chain(std::iter::repeat(0));
    let equations: Vec<Option<Equations>> = all
        .iter()
        .zip(on_a)
        .map(|(lines, on_a)| Equations::of(lines, on_a))
        .collect();
    let problem = Problem::new(assignment, noise).ok_or_else(|| no_estimate(all, 0))?;
    let each = all.iter().zip(&equations);
    let decoupled: Vec<_> = each
        .map(|(lines, equations)| decouple(lines, &layout, *equations))
        .collect();
    let decoupled_of = |joint: usize| -> Vec<Decoupled<'_>> {
        let own = all.iter().zip(&decoupled).zip(&joint_of_assembly);
        own.filter(|(_, own)| **own == joint)
            .map(|((lines, values), _)| Decoupled { lines, values })
            .collect()
    };
    let first_bands = first_bands(&layout, &options.bands);
    let first_averages: Vec<Option<Vec<JointMatrices>>> = (0..count)
        .map(|joint| band_averages(&decoupled_of(joint), &layout, &first_bands))
        .collect();
    let starts: Vec<Vec<DVector<f64>>> = first_averages
        .iter()
        .map(|averages| starts(&layout, options.start.as_ref(), averages.as_deref()))
        .collect();
    let (found, own_hz) = parallel::beside(
        || problem.best(&layout, &starts, options.effort(), None),
        || {
            let of = |joint: usize| own_resonances(&decoupled_of(joint), &options.bands);
            (0..count).map(of).collect::<Vec<_>>()
        },
    );
    let mut found = found.map_err(|starts| no_estimate(all, starts))?;
    let places = layout.places();
    let used = Arc::clone(&found.used);
    let objective = used.assemblies.objective(&places);
    let mut observed = None;
    if layout.joints() > 1 {
        (found.estimate, observed) = observed::observed(&objective, noise, found.estimate);
    }
    let estimate = &found.estimate;
    let names = options.bolts.with_own_joint();
    let covariance = CovarianceOfAll::of(&objective, noise, &found, observed.as_ref());
    let passive = passive::passive(&objective, &layout, noise, estimate);
    let draws = options.bootstrap.as_ref().and_then(|bootstrap| {
        let progress = options.progress.unwrap_or(&|| ());
        let draws = bootstrap::draws(&objective, &places, noise, estimate, bootstrap, progress)?;
        Some((bootstrap, draws))
    });
    let size = layout.unknowns();
    let of_torque = |joint: usize| {
        let own = joint * size..(joint + 1) * size;
        let (data, unknowns) = (
            decoupled_of(joint),
            &estimate.unknowns.as_slice()[own.clone()],
        );
        let at = (unknowns, own_hz[joint].as_deref());
        let bands = used_bands(&data, &layout, &options.bands, at);
        let matrices = |unknowns: &DVector<f64>| layout.matrices(&unknowns.as_slice()[own.clone()]);
        let free = matrices(&estimate.unknowns);
        let passive = passive.as_ref().map(|passive| matrices(&passive.unknowns));
        JointEstimate {
            torque_n_m: separate.map(|torques| torques.values_n_m[joint]),
            band_averages: if bands == first_bands {
                first_averages[joint].clone()
            } else {
                band_averages(&data, &layout, &bands)
            },
            bands,
            covariance: covariance.of_torque(&objective, &layout, names, &found, joint),
            bootstrap: draws.as_ref().map(|(bootstrap, draws)| {
                BootstrapResult::of(bootstrap, Drawn::Noise, draws, own.clone())
            }),
            whole: layout.whole(passive.as_ref().unwrap_or(&free)),
            layout: layout.clone(),
            free,
            passive,
        }
    };
    let joints: Vec<JointEstimate> = (0..count).map(of_torque).collect();
    drop(passive);
    let noise_level = (noise.is_stated() || estimate.degrees_of_freedom > 0)
        .then(|| NoiseLevel {
            relative: estimate.levels.assembly.relative,
            floor: floors_of_assembly(all, noise, estimate.levels),
        })
        .filter(|_| !found.assessment.noise_is_known);
    let levels = estimate.levels;
    let found = found.clone().without_corrections();
    let choice = options
        .compare_models
        .then(|| choice::compare(&problem, &layout, &found));
    drop(problem);
    let torque_choice = torques
        .filter(|_| options.compare_models)
        .and_then(|torques| torque::compare(all, &torques, noise, &layout, dependence, &found));
    let mut warnings = warnings(all, &equations, &layout, &found);
    let of_joints = joints.iter().flat_map(|joint| joint.warnings(names));
    let joint_warnings: Vec<String> = complaint(&found, &joints)
        .into_iter()
        .chain(of_joints)
        .collect();
    warnings.extend(joint_warnings.iter().cloned());
    warnings.extend(
        torque_choice
            .as_ref()
            .and_then(|choice| choice.complaint(dependence)),
    );
    Ok(LinesEstimate {
        decoupled,
        equations,
        noise_level,
        levels,
        joints,
        joint_of_assembly,
        layout,
        covariance_of_all: covariance.matrix,
        unrest: unrest(&found),
        observed,
        assessment: found.assessment,
        starts: (found.tried, found.agreeing),
        lines_used: (
            found.used.count(),
            all.iter().map(|lines| lines.frequency_hz.len()).sum(),
        ),
        draws: draws.map(|(_, draws)| draws),
        choice,
        torque_choice,
        warnings,
        joint_warnings,
    })
}

/// Root mean square of the floors of the assemblies' functions between translations, m/N.
fn floors_of_assembly(all: &[Lines], noise: &Noise, levels: Levels) -> f64 {
    let floors = all.iter().flat_map(|lines| {
        let is_rotation = |point: usize| lines.points[point].direction().is_rotation();
        let places = lines.measured.iter();
        places
            .filter(move |(p, q)| !is_rotation(*p) && !is_rotation(*q))
            .map(|&place| {
                let floor = noise.floor(Of::Assembly, [false; 2], || lines.floor(place));
                floor.variance(levels.assembly)
            })
    });
    let (sum, count) = floors.fold((0.0, 0), |(sum, count), floor| (sum + floor, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// By how many standard deviations an unknown still moved when the search ended. Exact data leave rounding alone, in which a
/// search cannot come to rest.
fn unrest(found: &Found) -> f64 {
    match found.estimate.converged || found.assessment.is_exact {
        true => 0.0,
        false => found.estimate.unrest,
    }
}

/// Starts from a `given` joint and from the `averages` at one torque.
fn starts(
    layout: &Layout,
    given: Option<&JointMatrices>,
    averages: Option<&[JointMatrices]>,
) -> Vec<DVector<f64>> {
    let given = given.map(std::slice::from_ref);
    [given, averages]
        .into_iter()
        .flatten()
        .filter_map(|joints| layout.unknowns_of(joints).map(DVector::from_vec))
        .filter(|start| start.iter().all(|value| value.is_finite()))
        .collect()
}

pub(super) fn no_estimate(all: &[Lines], starts: usize) -> IdentifyError {
    let points = all.iter().flat_map(|lines| &lines.points);
    IdentifyError::NoEstimate {
        starts,
        points: points.map(Dof::to_string).collect::<Vec<_>>().join(", "),
    }
}

fn warnings(
    all: &[Lines],
    equations: &[Option<Equations>],
    layout: &Layout,
    found: &Found,
) -> Vec<String> {
    let dofs = layout.used_dofs().len();
    let mut warnings = Vec::new();
    if found.estimate.degrees_of_freedom == 0 {
        warnings.push(format!(
            "{} measured values for {} unknowns: the residual does not show how well they fit; use more lines",
            2 * found.estimate.measurements,
            found.estimate.unknowns.len()
        ));
    }
    let once = |warnings: &mut Vec<String>, warning: String| {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    };
    for lines in all {
        if lines.points.len() < dofs {
            let warning = format!(
                "{} response point{} for a joint with {dofs} DOFs: H_ks (H_ss − H^C_ss)⁻¹ H_sk has rank {} on every line and does not \
                 determine the joint there, so the band averages are no estimate; the refined values rest on the lines together",
                lines.points.len(),
                if lines.points.len() == 1 { "" } else { "s" },
                lines.points.len()
            );
            once(&mut warnings, warning);
        }
    }
    for (lines, equations) in all.iter().zip(equations) {
        if equations.is_none() {
            let warning = format!(
                "{} of {} pairs of points were measured: without all of them there is no decoupling and no band average; the \
                 refined estimate does not need them",
                lines.independent().len(),
                lines.points.len() * lines.points.len()
            );
            once(&mut warnings, warning);
        }
    }
    let unrest = unrest(found);
    if (NOTABLE_UNREST..=TOLERABLE_UNREST).contains(&unrest) {
        warnings.push(format!(
            "the search ended while the values still moved by up to {unrest:.2} of their standard deviations"
        ));
    }
    warnings
}

/// What is said of a residual that is not noise.
fn complaint(found: &Found, joints: &[JointEstimate]) -> Option<String> {
    let complaint = found.assessment.complaint()?;
    let inflation = joints.iter().flat_map(|joint| &joint.covariance.inflation);
    let most = inflation.copied().fold(1.0, f64::max);
    let wider = match most {
        ..1.05 => String::new(),
        _ => format!("; the intervals are wider for it, by up to a factor of {most:.1}"),
    };
    Some(format!(
        "what the joint leaves of the measurement is not noise: {complaint}. Either the joint model or the substructures do not \
         fit, or every one of {} starts ended in a local minimum{wider}",
        found.tried
    ))
}
