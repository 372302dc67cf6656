//! The identification itself, from lines to a joint with its uncertainty.

use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_frf::{Dof, FileSummary};
use bolted_joint_joint::Provenance;
use bolted_joint_wanted::{Pieces, step};

use super::assemble::{self, Assembled};
use super::bootstrap::Bootstrap;
use super::budget::{Systematic, are_together};
use super::error::IdentifyError;
use super::from_modes::FromModes;
use super::layout::Bolts;
use super::level;
use super::lines::Lines;
use super::lines_estimate::{LinesEstimate, Options, identify_lines};
use super::model::{JointMatrices, JointModel};
use super::outliers::{Candidates, Outliers};
use super::provenance;
use super::reliability;
use super::slips::{self, FoundSlip};
use super::study::Study;
use super::watch::Watch;

/// What was identified, and from what.
#[derive(Clone, Debug)]
pub struct Identification {
    /// Name of the joint.
    pub name: String,
    /// Joint model.
    pub model: JointModel,
    /// The data of the first assembly.
    pub lines: Lines,
    /// The bolts.
    pub bolts: Bolts,
    /// Average of the decoupled values over bands, where every entry had lines; at the first bolt where every bolt has its own.
    pub band_average: Option<JointMatrices>,
    /// The passive estimate, which is the free one where that is passive: of the first assembly's joint, where each torque has
    /// its own, and at the first bolt where every bolt has. `estimate` has all of them.
    pub joint: JointMatrices,
    /// One standard deviation of each entry of `joint`; infinite where the data do not determine the joint.
    pub standard_deviation: JointMatrices,
    /// The assembly's receptances H^C_ss with the estimated joint, line by line.
    pub regenerated: Vec<ComplexMatrix>,
    /// Fit of each measured function of the first assembly.
    pub fits: Vec<FunctionFit>,
    /// The assemblies beside the first one, with the fit of their functions.
    pub further: Vec<AssemblyFit>,
    /// Root mean square of |measured − computed|/|computed| over all lines and functions.
    pub relative_rms: f64,
    /// Median of |measured − computed|/max(|measured|, |computed|) over all values; `None` without values.
    pub median_difference: Option<f64>,
    /// χ² over degrees of freedom, where the study states the noise or coherence tells it: about 1 if the model fits.
    pub reduced_chi_squared: Option<f64>,
    /// How many starts were tried, and how many of them led to this estimate.
    pub starts: (usize, usize),
    /// What the user should know before using the result.
    pub warnings: Vec<String>,
    /// Why the result is not to be relied on; empty if nothing speaks against it.
    pub reasons_against: Vec<String>,
    /// What modes supplied beside measured functions of a substructure.
    pub from_modes: Vec<FromModes>,
    /// The estimate with its covariance, the free and the passive one, the comparison of joint models.
    pub estimate: LinesEstimate,
    /// What errors of the set-up do to the estimate, where they take part.
    pub systematic: Option<Systematic>,
    /// Slips that explain what the estimate leaves, the most likely first.
    pub slips: Vec<FoundSlip>,
    /// Values that noise cannot have made; the lines of the assemblies are without theirs.
    pub outliers: Outliers,
    /// What each file of functions states.
    pub files: Vec<FileSummary>,
    /// Of each bolt's joint.
    pub(super) provenance: Vec<Provenance>,
    pub(super) torque_n_m: Option<[f64; 2]>,
    pub(super) level: Option<String>,
    pub(super) noise_is_stated: bool,
    pub(super) bodies: Option<bolted_joint_joint::Bodies>,
}

/// An assembly beside the first one.
#[derive(Clone, Debug)]
pub struct AssemblyFit {
    /// Its data.
    pub lines: Lines,
    /// Its receptances with the estimated joint, line by line.
    pub regenerated: Vec<ComplexMatrix>,
    /// Fit of each of its measured functions.
    pub fits: Vec<FunctionFit>,
}

/// Fit of one measured function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionFit {
    /// Response.
    pub response: Dof,
    /// Reference.
    pub reference: Dof,
    /// Row and column in H^C_ss.
    pub place: (usize, usize),
    /// Root mean square of |measured − computed|/|computed| over the lines.
    pub relative_rms: f64,
}

/// Identifies the joint of a study.
///
/// # Errors
/// [`IdentifyError`] if a file or the study cannot be used, or the data do not lead to an estimate.
pub fn identify(study: &Study) -> Result<Identification, IdentifyError> {
    identify_and_draw(study, None, &|| ())
}

/// Identifies the joint of a study, and repeats the estimate on data drawn from the fitted model; `watch` is told how far it
/// has come.
///
/// # Errors
/// As [`identify`].
pub fn identify_and_draw(
    study: &Study,
    bootstrap: Option<Bootstrap>,
    watch: &dyn Watch,
) -> Result<Identification, IdentifyError> {
    let reading = step("functions at the lines", Pieces::Unknown);
    let Assembled {
        lines: all,
        files,
        mut warnings,
        reasons_against: unsound,
        from_modes,
    } = assemble::lines(study, watch)?;
    drop(reading);
    let of_b = &all[0].points.clone();
    let dofs = study.dofs_of_a_bolt();
    let labels = match study.points_by_side() {
        (_, []) => [
            assemble::measured_labels(&study.a, dofs, &[]),
            assemble::measured_labels(&study.b, dofs, of_b),
        ],
        // both structures are one
        _ => [Vec::new(), Vec::new()],
    };
    let apart = are_together(study, &all).err();
    let has_budget = study.has_causes() && apart.is_none();
    let mut options = Options {
        bolts: study.bolts.clone(),
        noise: study.noise,
        bands: study.bands.clone(),
        start: study.start.clone(),
        compare_models: study.compares_rivals,
        torques_n_m: torques(study).unwrap_or_default(),
        dependence: study.torques,
        points_on_a: std::iter::once(study.points_on_a)
            .chain(study.further.iter().map(|further| further.points_on_a))
            .collect(),
        has_budget,
        // with causes it draws these, too, and follows
        bootstrap: bootstrap.clone().filter(|_| !has_budget),
        progress: Some(&|| watch.drawn()),
    };
    let candidates = {
        let _step = step("values that noise cannot have made", Pieces::Unknown);
        Candidates::of(&all, [&labels[0], &labels[1]])
    };
    warnings.extend(candidates.warning());
    let (all, outliers, estimate) = if candidates.is_empty() {
        let estimate = estimated(study, &all, &options)?;
        (all, Outliers::default(), estimate)
    } else {
        let bootstrap = options.bootstrap.take();
        let (left, outliers) = candidates.leave_out(&all);
        let estimate = estimated(study, &left, &options)?;
        let joint = |assembly: usize| &estimate.joint_of(assembly).whole;
        let (candidates, is_fewer) = candidates.beside(&all, joint);
        options.bootstrap = bootstrap;
        if is_fewer || options.bootstrap.is_some() {
            let (left, outliers) = candidates.leave_out(&all);
            let estimate = estimated(study, &left, &options)?;
            (left, outliers, estimate)
        } else {
            (left, outliers, estimate)
        }
    };
    warnings.extend(outliers.warning());
    let of_set_up = step("errors of the set-up", Pieces::Unknown);
    let slips = || match all.as_slice() {
        [lines] if slips::are_possible(&estimate.assessment) => slips::found(
            lines,
            &study.layout(),
            &study.noise,
            &estimate.covariance().values,
        ),
        _ => Vec::new(),
    };
    let likely = slips::are_likely(&estimate.assessment).then(slips);
    // Beside a slip that explains the data errors of the set-up are not sought from everywhere.
    let is_certain = |slips: &Vec<_>| slips::are_certain(slips, &estimate.assessment);
    let elsewhere = !likely.as_ref().is_some_and(is_certain);
    let within_limits = Systematic::within_limits(study, &all, &estimate, elsewhere);
    let slips = match within_limits {
        Some(_) => Vec::new(),
        None => likely.unwrap_or_else(slips),
    };
    // A slip is none where an error of the set-up explains the data; where none does, what it leaves tells nothing of errors.
    let systematic = within_limits.or_else(|| {
        if slips::are_certain(&slips, &estimate.assessment) {
            return None;
        }
        Systematic::of(study, &all, &estimate)
            .filter(|found| slips.is_empty() || found.explains_the_data())
    });
    let slips = match systematic {
        Some(_) => Vec::new(),
        None => slips,
    };
    drop(of_set_up);
    let estimate = match (&systematic, &bootstrap) {
        (Some(found), bootstrap) => {
            let draws = bootstrap.as_ref().map(|bootstrap| {
                let progress = || watch.drawn();
                let draws = found.draws(study, &all, &estimate, bootstrap, &progress);
                (bootstrap, draws)
            });
            let estimate = estimate.with_systematic_errors(found, study.bolts.with_own_joint());
            match draws {
                Some((bootstrap, draws)) => estimate.with_draws(bootstrap, draws),
                None => estimate,
            }
        }
        (None, Some(_)) if has_budget => {
            options.bootstrap.clone_from(&bootstrap);
            estimated(study, &all, &options)?
        }
        (None, _) => estimate,
    };
    let mut fitted = Vec::with_capacity(all.len());
    for (number, lines) in all.into_iter().enumerate() {
        let regenerated = lines.regenerated(&estimate.joint_of(number).whole)?;
        let fits: Vec<FunctionFit> = lines
            .measured
            .iter()
            .map(|&place| FunctionFit {
                response: lines.points[place.0],
                reference: lines.points[place.1],
                place,
                relative_rms: relative_rms(&lines.assembly, &regenerated, place),
            })
            .collect();
        fitted.push(AssemblyFit {
            lines,
            regenerated,
            fits,
        });
    }
    let functions = || fitted.iter().flat_map(|assembly| &assembly.fits);
    let squares: f64 = functions().map(|fit| fit.relative_rms.powi(2)).sum();
    let relative_rms = (squares / functions().count() as f64).sqrt();
    let median_difference = reliability::median_difference(&fitted);
    // What the causes explain is no misfit.
    let is_explained = systematic
        .as_ref()
        .is_some_and(Systematic::explains_the_data);
    let unexplained = median_difference.filter(|_| !is_explained);
    let mut reasons_against = reliability::reasons_against(&estimate, &study.bolts, unexplained);
    reasons_against.extend(reliability::because_of(&slips, &estimate.assessment));
    reasons_against.extend(unsound);
    reasons_against.extend(systematic.as_ref().and_then(Systematic::feeding_energy));
    reasons_against.extend(systematic.as_ref().and_then(Systematic::out_of_scale));
    if has_budget && systematic.is_none() && slips.is_empty() {
        reasons_against.extend(reliability::without_budget(&estimate.assessment));
    }
    warnings.extend(study.rotations_not_corrected());
    if systematic.is_none() && slips.is_empty() && study.has_causes() {
        warnings.push(Systematic::not_applied(apart));
    }
    let provenance = provenance::of(study, &estimate, &from_modes, watch)?;
    warnings.extend(estimate.warnings.iter().cloned());
    warnings.extend(reliability::of_stated_noise(
        &study.noise,
        &estimate.assessment,
        median_difference,
    ));
    let large = reliability::warning(&estimate, study.model, relative_rms, unexplained);
    warnings.extend(large);
    let first = fitted.remove(0);
    Ok(Identification {
        name: study.name.clone(),
        model: study.model,
        bolts: study.bolts.clone(),
        band_average: estimate.band_average().cloned(),
        joint: estimate.joint().clone(),
        standard_deviation: estimate.standard_deviation(study.model),
        lines: first.lines,
        regenerated: first.regenerated,
        fits: first.fits,
        further: fitted,
        relative_rms,
        median_difference,
        reduced_chi_squared: (estimate.assessment.noise_is_stated
            || estimate.assessment.noise_is_known)
            .then_some(estimate.assessment.reduced_chi_squared)
            .flatten(),
        starts: estimate.starts,
        warnings,
        reasons_against,
        from_modes,
        systematic,
        slips,
        outliers,
        files,
        provenance,
        torque_n_m: torques(study).and_then(range),
        level: level::in_words(study),
        noise_is_stated: study.noise.is_stated(),
        bodies: study.bodies.clone(),
        estimate,
    })
}

/// The estimate without causes. Where errors of the set-up leave it none, it begins at the joint that is found with them.
fn estimated(
    study: &Study,
    all: &[Lines],
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    identify_lines(all, study.model, options).or_else(|error| {
        let is_none = matches!(error, IdentifyError::NoEstimate { .. });
        let start = is_none.then(|| Systematic::start(study, all)).flatten();
        match start {
            Some(start) => {
                let start = Some(start);
                let options = Options {
                    start,
                    ..options.clone()
                };
                identify_lines(all, study.model, &options)
            }
            None => Err(error),
        }
    })
}

/// The torque of each of a study's assemblies, N·m, where all state theirs.
fn torques(study: &Study) -> Option<Vec<f64>> {
    let further = study.further.iter().map(|assembly| assembly.torque_n_m);
    std::iter::once(study.torque_n_m).chain(further).collect()
}

/// Lowest and highest.
fn range(values: Vec<f64>) -> Option<[f64; 2]> {
    let lowest = values.iter().copied().reduce(f64::min)?;
    Some([lowest, values.into_iter().fold(lowest, f64::max)])
}

fn relative_rms(
    measured: &[ComplexMatrix],
    computed: &[ComplexMatrix],
    place: (usize, usize),
) -> f64 {
    let squares = measured.iter().zip(computed).map(|(measured, computed)| {
        (measured[place] - computed[place]).norm_sqr() / computed[place].norm_sqr()
    });
    (squares.sum::<f64>() / measured.len() as f64).sqrt()
}
