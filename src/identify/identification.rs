//! The identification itself, from lines to a joint with its uncertainty.

use nalgebra::DMatrix;

use crate::frf::Dof;
use crate::joint::{
    Format, FunctionResidual, Joint, JointFile, Provenance, Residual, StandardDeviation,
    Uncertainty, Validity,
};
use crate::structure::{ComplexMatrix, Partition};

use super::bands::{self, Bands};
use super::error::IdentifyError;
use super::estimator::{Estimate, NoiseLevel, estimate};
use super::lines::Lines;
use super::model::{JointMatrices, JointModel};
use super::starts::starts;
use super::study::Study;
use super::unknown::Unknown;
use super::{assemble, decoupling, provenance};

/// Lines that are enough to tell which start leads to the best estimate.
const LINES_FOR_STARTS: usize = 200;

/// Two estimates are the same if their −2 log-likelihoods agree to this …
const SAME_MISFIT: f64 = 2e-3;

/// … or each of their unknowns does, relative to its value or to what would change the residual by its assumed standard
/// deviation: data without noise leave a misfit of rounding alone.
const SAME_UNKNOWN: f64 = 1e-6;

/// By how much the −2 log-likelihood of an estimate that has not converged must be lower to rank before one that has.
const DECISIVE_MISFIT: f64 = 20.0;

/// How many different estimates from thinned lines are refined on all lines.
const FINALISTS: usize = 4;

/// A minimum whose weighted mean square residual is so many times that of the best is not refined: no resonance between
/// the thinned lines makes up for it.
const COMPARABLE: f64 = 10.0;

/// A standard deviation beyond this fraction of the value makes the value unreliable.
const UNRELIABLE: f64 = 0.5;

/// What was identified, and from what.
#[derive(Clone, Debug)]
pub struct Identification {
    /// Name of the joint.
    pub name: String,
    /// Joint model.
    pub model: JointModel,
    /// The data.
    pub lines: Lines,
    /// K* of each line by (3.21); `None` where a matrix was singular.
    pub decoupled: Vec<Option<ComplexMatrix>>,
    /// Average of the decoupled values over bands, where every entry had lines.
    pub band_average: Option<JointMatrices>,
    /// The estimate.
    pub joint: JointMatrices,
    /// One standard deviation of each entry; infinite where the data do not determine the joint.
    pub standard_deviation: JointMatrices,
    /// The assembly's receptances H^C_ss with the estimated joint, line by line.
    pub regenerated: Vec<ComplexMatrix>,
    /// Fit of each measured function.
    pub fits: Vec<FunctionFit>,
    /// Root mean square of |measured − computed|/|computed| over all lines and functions.
    pub relative_rms: f64,
    /// χ² over degrees of freedom, where the study states the noise: about 1 if the model fits.
    pub reduced_chi_squared: Option<f64>,
    /// How many starts were tried, and how many of them led to this estimate.
    pub starts: (usize, usize),
    /// What the user should know before using the result.
    pub warnings: Vec<String>,
    provenance: Provenance,
    bodies: Option<crate::joint::Bodies>,
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

/// The refined estimate from lines alone, with what led to it.
#[derive(Clone, Debug)]
pub struct LinesEstimate {
    decoupled: Vec<Option<ComplexMatrix>>,
    band_average: Option<JointMatrices>,
    joint: JointMatrices,
    standard_deviation: JointMatrices,
    reduced_cost: Option<f64>,
    starts: (usize, usize),
    warnings: Vec<String>,
}

impl LinesEstimate {
    /// The joint.
    #[must_use]
    pub fn joint(&self) -> &JointMatrices {
        &self.joint
    }

    /// One standard deviation of each entry.
    #[must_use]
    pub fn standard_deviation(&self) -> &JointMatrices {
        &self.standard_deviation
    }

    /// Average of the decoupled values, from which the estimate started.
    #[must_use]
    pub fn band_average(&self) -> Option<&JointMatrices> {
        self.band_average.as_ref()
    }

    /// How many starts were tried, and how many of them led to this estimate.
    #[must_use]
    pub fn starts(&self) -> (usize, usize) {
        self.starts
    }

    /// What the user should know before using the estimate.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// Identifies the joint of a study.
///
/// # Errors
/// [`IdentifyError`] if a file or the study cannot be used, or the data do not lead to an estimate.
pub fn identify(study: &Study) -> Result<Identification, IdentifyError> {
    let (lines, mut warnings) = assemble::lines(study)?;
    let estimate = identify_lines(&lines, study.model, study.noise, &study.bands)?;
    let regenerated = lines.regenerated(&estimate.joint)?;
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
    let mean_square: f64 =
        fits.iter().map(|fit| fit.relative_rms.powi(2)).sum::<f64>() / fits.len() as f64;
    let provenance = provenance::of(study)?;
    warnings.extend(estimate.warnings);
    Ok(Identification {
        name: study.name.clone(),
        model: study.model,
        decoupled: estimate.decoupled,
        band_average: estimate.band_average,
        joint: estimate.joint,
        standard_deviation: estimate.standard_deviation,
        regenerated,
        fits,
        relative_rms: mean_square.sqrt(),
        reduced_chi_squared: study.noise.and(estimate.reduced_cost),
        starts: estimate.starts,
        warnings,
        lines,
        provenance,
        bodies: study.bodies.clone(),
    })
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

/// Identifies a joint from lines: decoupling, band average, then the refined estimate from several starts.
///
/// # Errors
/// [`IdentifyError::NoEstimate`] if no start leads to an estimate.
pub fn identify_lines(
    lines: &Lines,
    model: JointModel,
    noise: Option<NoiseLevel>,
    bands: &Bands,
) -> Result<LinesEstimate, IdentifyError> {
    if lines.frequency_hz.is_empty() || lines.measured.is_empty() {
        return Err(no_estimate(lines, 0));
    }
    let decoupled = decouple(lines);
    let band_average = bands::average(model, &lines.frequency_hz, &decoupled, bands);
    let weights = noise.unwrap_or(NoiseLevel {
        relative: 1.0,
        floor: 0.0,
    });
    let (best, starts) = best_estimate(lines, model, weights, band_average.as_ref())?;
    // χ²/ν with ν = 2N − dim p: twice the cost, because σ² is the sum of the variances of two parts.
    let degrees_of_freedom = best.degrees_of_freedom as f64;
    let reduced_cost = (degrees_of_freedom > 0.0).then(|| 2.0 * best.cost / degrees_of_freedom);
    // As many numbers as unknowns are always met: such a residual says nothing about the noise.
    let standard_deviation = standard_deviation(model, &best, reduced_cost.or(noise.map(|_| 1.0)));
    let mut warnings = Vec::new();
    if reduced_cost.is_none() {
        warnings.push(format!(
            "{} measured values for {} unknowns: the residual does not show how well they fit; use more lines",
            2 * lines.frequency_hz.len() * lines.measured.len(),
            model.unknowns()
        ));
    }
    if lines.points.len() < model.dofs() {
        warnings.push(format!(
            "{} response point for a joint with {} DOFs: H_ks (H_ss − H^C_ss)⁻¹ H_sk has rank {} on every line and does not \
             determine the joint there, so the band averages are no estimate; the refined values rest on the lines together",
            lines.points.len(),
            model.dofs(),
            lines.points.len()
        ));
    }
    if !best.converged {
        warnings.push("the refined estimate has not converged; do not rely on it".to_owned());
    }
    warnings.extend(unreliable(model, &best.joint, &standard_deviation));
    Ok(LinesEstimate {
        decoupled,
        band_average,
        joint: best.joint,
        standard_deviation,
        reduced_cost,
        starts,
        warnings,
    })
}

fn decouple(lines: &Lines) -> Vec<Option<ComplexMatrix>> {
    let line = |index: usize| {
        let a_joint = &lines.a_joint[index];
        // Equation (3.21) needs nothing of A but H_jj.
        let a = Partition::of(a_joint, a_joint.nrows());
        decoupling::from_ss(&a, &lines.b[index], &lines.assembly[index])
    };
    (0..lines.frequency_hz.len()).map(line).collect()
}

/// The estimate with the lowest cost, and of how many starts how many led to it.
fn best_estimate(
    lines: &Lines,
    model: JointModel,
    noise: NoiseLevel,
    band_average: Option<&JointMatrices>,
) -> Result<(Estimate, (usize, usize)), IdentifyError> {
    let stride = (lines.frequency_hz.len() / LINES_FOR_STARTS).max(1);
    let thinned = lines.thinned(stride);
    let starts = starts(&thinned, model, band_average);
    let mut estimates: Vec<Estimate> = starts
        .iter()
        .filter_map(|start| estimate(&thinned, model, noise, start))
        .collect();
    estimates.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    let residuals = 2.0 * (thinned.frequency_hz.len() * lines.measured.len()) as f64;
    let comparable = |candidate: &Estimate, best: &Estimate| {
        candidate.misfit <= best.misfit + residuals * COMPARABLE.ln()
    };
    let mut finalists: Vec<&Estimate> = Vec::new();
    for candidate in &estimates {
        if finalists.len() < FINALISTS
            && finalists
                .first()
                .is_none_or(|best| comparable(candidate, best))
            && !finalists.iter().any(|known| same(model, known, candidate))
        {
            finalists.push(candidate);
        }
    }
    // Thinned lines may have passed over the resonances that tell two minima apart.
    let refined: Vec<(&Estimate, Estimate)> = finalists
        .into_iter()
        .filter_map(|candidate| Some((candidate, estimate(lines, model, noise, &candidate.joint)?)))
        .collect();
    let (_, best) = refined
        .iter()
        .min_by(|(_, a), (_, b)| rank(a).total_cmp(&rank(b)))
        .ok_or_else(|| no_estimate(lines, starts.len()))?;
    let leads_to_best = |estimate: &&Estimate| {
        let known = |(candidate, end): &(&Estimate, Estimate)| {
            same(model, candidate, estimate) && same(model, end, best)
        };
        refined.iter().any(known)
    };
    let agreeing = estimates.iter().filter(leads_to_best).count();
    Ok((best.clone(), (starts.len(), agreeing)))
}

fn no_estimate(lines: &Lines, starts: usize) -> IdentifyError {
    IdentifyError::NoEstimate {
        starts,
        points: lines
            .points
            .iter()
            .map(Dof::to_string)
            .collect::<Vec<_>>()
            .join(", "),
    }
}

/// What estimates are ranked by: the −2 log-likelihood, with a handicap for those that have not converged.
fn rank(estimate: &Estimate) -> f64 {
    let handicap = if estimate.converged {
        0.0
    } else {
        DECISIVE_MISFIT
    };
    estimate.misfit + handicap
}

/// Whether two estimates from the same lines are one minimum.
fn same(model: JointModel, one: &Estimate, other: &Estimate) -> bool {
    let values = one
        .joint
        .unknowns(model)
        .into_iter()
        .zip(other.joint.unknowns(model));
    let close = |(index, (a, b)): (usize, (f64, f64))| {
        let variance = one
            .unit_covariance
            .as_ref()
            .map_or(0.0, |matrix| matrix[(index, index)]);
        (a - b).abs() <= SAME_UNKNOWN * a.abs().max(b.abs()).max(variance.sqrt())
    };
    (one.misfit - other.misfit).abs() <= SAME_MISFIT || values.enumerate().all(close)
}

/// Standard deviations from s²(JᵀJ)⁻¹, s² being the residual's own variance in units of the assumed one; infinite where
/// JᵀJ is singular or s² is not known.
fn standard_deviation(
    model: JointModel,
    best: &Estimate,
    reduced_cost: Option<f64>,
) -> JointMatrices {
    let unknowns: Vec<f64> = match best.unit_covariance.as_ref().zip(reduced_cost) {
        Some((covariance, reduced_cost)) => covariance
            .diagonal()
            .iter()
            // JᵀJ counts real and imaginary parts with σ² each; together they have σ², so each has half of it.
            .map(|variance| (0.5 * reduced_cost * variance).sqrt())
            .collect(),
        None => vec![f64::INFINITY; model.unknowns()],
    };
    JointMatrices::from_unknowns(model, &unknowns)
}

fn unreliable(
    model: JointModel,
    joint: &JointMatrices,
    deviation: &JointMatrices,
) -> impl Iterator<Item = String> {
    Unknown::of(model).into_iter().filter_map(move |unknown| {
        let (value, deviation) = (unknown.value(joint), unknown.value(deviation));
        // A coupling may be zero: it counts beside the largest that a passive joint has.
        let size = value.abs().max(unknown.passive_bound(joint));
        (deviation.is_nan() || deviation > UNRELIABLE * size).then(|| {
            format!(
                "{} = {value:.3e} {unit} has a standard deviation of {deviation:.1e} {unit}: the data hardly determine it",
                unknown.name,
                unit = unknown.unit
            )
        })
    })
}

impl Identification {
    /// The joint file: the estimate, its uncertainty, where it holds, how well it fits and where it comes from.
    #[must_use]
    pub fn joint_file(&self) -> JointFile {
        let rows = |matrix: &DMatrix<f64>| -> Vec<Vec<f64>> {
            matrix
                .row_iter()
                .map(|row| row.iter().copied().collect())
                .collect()
        };
        let finite = |matrix: &DMatrix<f64>| matrix.iter().all(|value| value.is_finite());
        let deviation = &self.standard_deviation;
        let frequency_hz = &self.lines.frequency_hz;
        JointFile {
            format: Format::V1,
            name: self.name.clone(),
            joint: Joint {
                dofs: self.model.into(),
                stiffness: rows(&self.joint.stiffness),
                damping: rows(&self.joint.damping),
                cubic: vec![0.0; self.model.dofs()],
                over_preload: None,
            },
            bodies: self.bodies.clone(),
            uncertainty: (finite(&deviation.stiffness) && finite(&deviation.damping)).then(|| {
                Uncertainty {
                    standard_deviation: StandardDeviation {
                        stiffness: rows(&deviation.stiffness),
                        damping: rows(&deviation.damping),
                    },
                    basis: "linearised least squares, scaled by the residual's own variance; \
                            noise of the assembly's receptances only"
                        .to_owned(),
                }
            }),
            validity: Some(Validity {
                frequency_hz: [frequency_hz[0], frequency_hz[frequency_hz.len() - 1]],
            }),
            residual: Some(Residual {
                relative_rms: self.relative_rms,
                lines: frequency_hz.len(),
                functions: self
                    .fits
                    .iter()
                    .map(|fit| FunctionResidual {
                        response: fit.response.to_string(),
                        reference: fit.reference.to_string(),
                        relative_rms: fit.relative_rms,
                    })
                    .collect(),
            }),
            provenance: Some(self.provenance.clone()),
        }
    }
}
