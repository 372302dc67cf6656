//! From lines to a joint: decoupling, averages, the search, the passive estimate, and how sure all of it is.

use nalgebra::DVector;

use crate::frf::Dof;
use crate::structure::ComplexMatrix;

use super::assessment::{self, Assessment};
use super::bands::{self, Bands};
use super::bootstrap::{self, Bootstrap};
use super::choice::{self, ModelChoice};
use super::error::IdentifyError;
use super::group::{Group, Side};
use super::line_by_line::{self, is_complete};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::noise::{Noise, NoiseLevel, StatedLevel};
use super::objective::Objective;
use super::passive;
use super::search::{self, Data, Effort, Found};
use super::uncertainty::{self, Covariance};
use super::unknown::Unknown;

/// A standard deviation beyond this fraction of the value makes the value unreliable.
const UNRELIABLE: f64 = 0.5;

/// What an identification from lines is to do beyond the estimate itself.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// Noise of everything measured.
    pub noise: Noise,
    /// Bands of the averages.
    pub bands: Bands,
    /// A joint to start from, beside the starts that the data give.
    pub start: Option<JointMatrices>,
    /// Whether to compare the joint models.
    pub compare_models: bool,
    /// Bootstrap to run, if any.
    pub bootstrap: Option<Bootstrap>,
    /// Called after each draw of the bootstrap.
    pub progress: Option<&'a (dyn Fn() + Sync)>,
}

/// The estimate from lines alone, with what led to it.
#[derive(Clone, Debug)]
pub struct LinesEstimate {
    pub(super) decoupled: Vec<Vec<Option<ComplexMatrix>>>,
    pub(super) band_average: Option<JointMatrices>,
    pub(super) free: JointMatrices,
    pub(super) passive: Option<JointMatrices>,
    pub(super) covariance: Covariance,
    pub(super) assessment: Assessment,
    pub(super) noise_level: Option<NoiseLevel>,
    pub(super) starts: (usize, usize),
    pub(super) choice: Option<ModelChoice>,
    pub(super) bootstrap: Option<BootstrapResult>,
    pub(super) warnings: Vec<String>,
}

/// Scatter of the estimates over bootstrap draws.
#[derive(Clone, Debug, PartialEq)]
pub struct BootstrapResult {
    /// Draws asked for.
    pub draws: usize,
    /// Seed.
    pub seed: u64,
    /// Draws whose estimate converged.
    pub converged: usize,
    /// Standard deviation of each unknown over them.
    pub standard_deviation: Vec<f64>,
    /// From the 2.5th to the 97.5th percentile of each unknown.
    pub intervals: Vec<[f64; 2]>,
}

impl LinesEstimate {
    /// K* of each line of each assembly by (3.21); `None` where it cannot be had.
    #[must_use]
    pub fn decoupled(&self) -> &[Vec<Option<ComplexMatrix>>] {
        &self.decoupled
    }

    /// The joint: the passive estimate where there is one.
    #[must_use]
    pub fn joint(&self) -> &JointMatrices {
        self.passive.as_ref().unwrap_or(&self.free)
    }

    /// The estimate that is free to be active.
    #[must_use]
    pub fn free(&self) -> &JointMatrices {
        &self.free
    }

    /// Covariance of the unknowns, and which of them are identified.
    #[must_use]
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// One standard deviation of each entry.
    #[must_use]
    pub fn standard_deviation(&self, model: JointModel) -> JointMatrices {
        JointMatrices::from_unknowns(model, &self.covariance.standard_deviation())
    }

    /// Whether the residual is noise.
    #[must_use]
    pub fn assessment(&self) -> &Assessment {
        &self.assessment
    }

    /// Noise of the assembly's functions, stated or estimated; `None` where coherence tells it line by line, and without
    /// degrees of freedom to estimate it.
    #[must_use]
    pub fn noise_level(&self) -> Option<NoiseLevel> {
        self.noise_level
    }

    /// Average of the decoupled values, one of the starts.
    #[must_use]
    pub fn band_average(&self) -> Option<&JointMatrices> {
        self.band_average.as_ref()
    }

    /// How many starts were tried, and how many of them led to this estimate.
    #[must_use]
    pub fn starts(&self) -> (usize, usize) {
        self.starts
    }

    /// The joint models beside each other, where they were compared.
    #[must_use]
    pub fn model_choice(&self) -> Option<&ModelChoice> {
        self.choice.as_ref()
    }

    /// The bootstrap, where one was asked for.
    #[must_use]
    pub fn bootstrap(&self) -> Option<&BootstrapResult> {
        self.bootstrap.as_ref()
    }

    /// What the user should know before using the estimate.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// Identifies a joint from the lines of one or more assemblies that have it in common.
///
/// # Errors
/// [`IdentifyError::NoEstimate`] if no start leads to an estimate.
pub fn identify_lines(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    let first = all.iter().find(|lines| !lines.frequency_hz.is_empty());
    let dofs = first.map_or(0, |lines| lines.a_joint[0].nrows());
    if all.iter().any(|lines| lines.measured.is_empty()) || dofs < model.dofs() {
        return Err(no_estimate(all, 0));
    }
    match dofs {
        1 => identify_with::<1>(all, model, options),
        2 => identify_with::<2>(all, model, options),
        _ => Err(no_estimate(all, 0)),
    }
}

fn identify_with<const N: usize>(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    let decoupled: Vec<_> = all.iter().map(line_by_line::decouple::<N>).collect();
    let band_average = if let ([lines], [decoupled]) = (all, &decoupled[..]) {
        bands::band_average(model, &lines.frequency_hz, decoupled, &options.bands)
    } else {
        let frequency_hz: Vec<f64> = all.iter().flat_map(|l| l.frequency_hz.clone()).collect();
        bands::band_average(model, &frequency_hz, &decoupled.concat(), &options.bands)
    };
    let data = data::<N>(all, &options.noise);
    let noise = &options.noise;
    let starts = [options.start.as_ref(), band_average.as_ref()];
    let starts: Vec<DVector<f64>> = starts
        .into_iter()
        .flatten()
        .map(|joint| DVector::from_vec(joint.unknowns(model)))
        .filter(|start| start.iter().all(|value| value.is_finite()))
        .collect();
    let found = search::best(&data, model.entries(), noise, starts, Effort::Whole)
        .map_err(|starts| no_estimate(all, starts))?;
    let objective = Objective {
        groups: &data.whole,
        entries: model.entries(),
    };
    let estimate = &found.estimate;
    let covariance = covariance(&objective, model, noise, &found);
    let free = JointMatrices::from_unknowns(model, estimate.unknowns.as_slice());
    let passive = passive::passive(&objective, model, noise, estimate)
        .map(|passive| JointMatrices::from_unknowns(model, passive.unknowns.as_slice()));
    let bootstrap = options.bootstrap.and_then(|bootstrap| {
        let progress = options.progress.unwrap_or(&|| ());
        let draws = bootstrap::draws(&objective, noise, estimate, bootstrap, progress)?;
        Some(BootstrapResult::of(bootstrap, &draws))
    });
    let choice = options
        .compare_models
        .then(|| choice::compare(&data, model, noise, &found));
    let mut warnings = warnings(all, model, &found, &covariance);
    warnings.extend(undetermined(model, &free, &covariance));
    Ok(LinesEstimate {
        decoupled,
        band_average,
        free,
        passive,
        noise_level: (noise.is_stated() || estimate.degrees_of_freedom > 0)
            .then_some(estimate.levels.assembly)
            .filter(|_| !found.assessment.noise_is_known),
        covariance,
        assessment: found.assessment,
        starts: (found.tried, found.agreeing),
        choice,
        bootstrap,
        warnings,
    })
}

fn data<const N: usize>(all: &[Lines], noise: &Noise) -> Data<N> {
    let longest = all.iter().map(|lines| lines.frequency_hz.len()).max();
    let stride = (longest.unwrap_or(0) / search::LINES_FOR_STARTS).max(1);
    let exact = StatedLevel {
        relative: Some(0.0),
        floor: Some(0.0),
    };
    let noisy = |side: Side| match side {
        Side::A => noise.a != exact,
        Side::B => noise.b != exact,
    };
    let whole = Group::all(all, 1, noisy);
    let has_sources = whole.iter().any(|group| !group.sources.is_empty());
    Data {
        thinned: Group::all(all, stride, |_| false),
        thinned_whole: if has_sources {
            Group::all(all, stride, noisy)
        } else {
            Vec::new()
        },
        whole,
    }
}

pub(super) fn no_estimate(all: &[Lines], starts: usize) -> IdentifyError {
    let points = all.iter().flat_map(|lines| &lines.points);
    IdentifyError::NoEstimate {
        starts,
        points: points.map(Dof::to_string).collect::<Vec<_>>().join(", "),
    }
}

/// Covariance with what the residual says about the noise and about the model.
fn covariance<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    found: &Found,
) -> Covariance {
    let estimate = &found.estimate;
    let unit = uncertainty::unit_covariance(&estimate.information);
    let reduced = estimate.reduced_chi_squared();
    // Stated noise is believed as long as χ² does not contradict it; otherwise the residual tells the level. What coherence
    // tells is the least that the noise can be.
    let (scale, freedom) = match reduced {
        Some(chi) if found.assessment.noise_is_known => (chi.max(1.0), usize::MAX),
        Some(chi) if !noise.is_stated() => (chi, estimate.degrees_of_freedom),
        Some(chi) if found.assessment.chi_squared_excess > assessment::SIGNIFICANT => {
            (chi, usize::MAX)
        }
        None if !noise.is_stated() => (f64::INFINITY, usize::MAX),
        _ => (1.0, usize::MAX),
    };
    let mut matrix = &unit * scale;
    let mut inflation = vec![scale.max(1.0).sqrt(); unit.nrows()];
    if !noise.is_stated() && !found.assessment.noise_is_known {
        inflation.fill(1.0);
    }
    if found.assessment.line_correlation_excess > assessment::SIGNIFICANT
        && !found.assessment.is_exact
        && scale.is_finite()
        && let Some(more) = assessment::inflation(objective, estimate, &unit, scale)
    {
        matrix = super::normal::scaled_by(&matrix, &more);
        for (total, more) in inflation.iter_mut().zip(more.iter()) {
            *total *= more;
        }
    }
    let values: Vec<f64> = estimate.unknowns.iter().copied().collect();
    let deviation: Vec<f64> = matrix.diagonal().iter().map(|v| v.sqrt()).collect();
    let blocks: Vec<_> = objective.groups.iter().flat_map(|g| &g.blocks).collect();
    let dynamic = blocks
        .first()
        .map_or([1.0; N], |block| block.dynamic_stiffness);
    let omega = blocks
        .first()
        .map_or(1.0, |block| block.omega[block.lines() / 2]);
    let unknowns = Unknown::of(model);
    let (identified, sizes) = uncertainty::identified(model, &values, &deviation, &dynamic, omega);
    Covariance {
        determined_together: uncertainty::determined_together(
            &unknowns,
            &identified,
            &sizes,
            &matrix,
        ),
        unknowns,
        values,
        coverage_factor: uncertainty::student_975(freedom),
        inflation,
        identified,
        matrix,
    }
}

fn warnings(
    all: &[Lines],
    model: JointModel,
    found: &Found,
    covariance: &Covariance,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if found.estimate.degrees_of_freedom == 0 {
        warnings.push(format!(
            "{} measured values for {} unknowns: the residual does not show how well they fit; use more lines",
            2 * found.estimate.measurements,
            model.unknowns()
        ));
    }
    for lines in all {
        if lines.points.len() < model.dofs() {
            warnings.push(format!(
                "{} response point for a joint with {} DOFs: H_ks (H_ss − H^C_ss)⁻¹ H_sk has rank {} on every line and does not \
                 determine the joint there, so the band averages are no estimate; the refined values rest on the lines together",
                lines.points.len(),
                model.dofs(),
                lines.points.len()
            ));
        }
    }
    for lines in all {
        if !is_complete(lines) {
            warnings.push(format!(
                "{} of {} pairs of points were measured: without all of them there is no decoupling and no band average; the \
                 refined estimate does not need them",
                lines.independent().len(),
                lines.points.len() * lines.points.len()
            ));
        }
    }
    if !found.estimate.converged {
        warnings.push("the refined estimate has not converged; do not rely on it".to_owned());
    }
    if let Some(complaint) = found.assessment.complaint() {
        let most = covariance.inflation.iter().copied().fold(1.0, f64::max);
        warnings.push(format!(
            "what the joint leaves of the measurement is not noise: {complaint}. Either the joint model or the substructures do not \
             fit, or every one of {} starts ended in a local minimum; the intervals are wider for it, by up to a factor of {most:.1}",
            found.tried
        ));
    }
    warnings
}

fn undetermined(model: JointModel, joint: &JointMatrices, covariance: &Covariance) -> Vec<String> {
    let deviations = covariance.standard_deviation();
    let mut warnings = Vec::new();
    let open: Vec<&str> = Unknown::of(model)
        .iter()
        .zip(&covariance.identified)
        .filter(|(_, identified)| !**identified)
        .map(|(unknown, _)| unknown.name)
        .collect();
    if !open.is_empty() {
        let mut text = format!(
            "not identified: {}; the data do not determine {}, so do not use the value{}",
            open.join(", "),
            if open.len() == 1 { "it" } else { "them" },
            if open.len() == 1 { "" } else { "s" },
        );
        for combination in &covariance.determined_together {
            text += &format!("; determined together: {combination}");
        }
        warnings.push(text);
    }
    for (index, unknown) in Unknown::of(model).into_iter().enumerate() {
        let (value, deviation) = (unknown.value(joint), deviations[index]);
        // A coupling may be zero: it counts beside the largest that a passive joint has.
        let size = value.abs().max(unknown.passive_bound(joint));
        if covariance.identified[index] && deviation > UNRELIABLE * size {
            warnings.push(format!(
                "{} = {value:.3e} {unit} has a standard deviation of {deviation:.1e} {unit}: the data hardly determine it",
                unknown.name,
                unit = unknown.unit
            ));
        }
    }
    warnings
}

impl BootstrapResult {
    fn of(bootstrap: Bootstrap, draws: &[DVector<f64>]) -> Self {
        let size = draws.first().map_or(0, DVector::len);
        let sorted = |unknown: usize| {
            let mut values: Vec<f64> = draws.iter().map(|draw| draw[unknown]).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let deviation = |values: &[f64]| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (squares / (values.len() as f64 - 1.0)).sqrt()
        };
        let quantile = |values: &[f64], level: f64| {
            let place = level * (values.len() as f64 - 1.0);
            let below = place.floor() as usize;
            let above = (below + 1).min(values.len() - 1);
            values[below] + (place - below as f64) * (values[above] - values[below])
        };
        let unknowns: Vec<Vec<f64>> = (0..size).map(sorted).collect();
        Self {
            draws: bootstrap.draws,
            seed: bootstrap.seed,
            converged: draws.len(),
            standard_deviation: unknowns.iter().map(|values| deviation(values)).collect(),
            intervals: unknowns
                .iter()
                .map(|values| [quantile(values, 0.025), quantile(values, 0.975)])
                .collect(),
        }
    }
}
