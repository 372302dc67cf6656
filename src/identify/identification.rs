//! The identification itself, from lines to a joint with its uncertainty.

use nalgebra::DMatrix;

use crate::frf::Dof;
use crate::joint::{
    Format, FunctionResidual, Joint, JointFile, Provenance, Residual, StandardDeviation,
    Uncertainty, Validity,
};
use crate::structure::ComplexMatrix;

use super::error::IdentifyError;
use super::lines::Lines;
use super::lines_estimate::{LinesEstimate, Options, identify_lines};
use super::model::{JointMatrices, JointModel};
use super::noise::Noise;
use super::study::Study;
use super::{assemble, provenance};

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
    /// The estimate with its covariance, the free and the passive one, the comparison of joint models.
    pub estimate: LinesEstimate,
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

/// Identifies the joint of a study.
///
/// # Errors
/// [`IdentifyError`] if a file or the study cannot be used, or the data do not lead to an estimate.
pub fn identify(study: &Study) -> Result<Identification, IdentifyError> {
    let (lines, mut warnings) = assemble::lines(study)?;
    let options = Options {
        noise: study.noise.map(Noise::stated).unwrap_or_default(),
        bands: study.bands.clone(),
        compare_models: true,
        ..Options::default()
    };
    let estimate = identify_lines(std::slice::from_ref(&lines), study.model, &options)?;
    let regenerated = lines.regenerated(estimate.joint())?;
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
    warnings.extend(estimate.warnings.iter().cloned());
    Ok(Identification {
        name: study.name.clone(),
        model: study.model,
        decoupled: estimate.decoupled.first().cloned().unwrap_or_default(),
        band_average: estimate.band_average.clone(),
        joint: estimate.joint().clone(),
        standard_deviation: estimate.standard_deviation(study.model),
        regenerated,
        fits,
        relative_rms: mean_square.sqrt(),
        reduced_chi_squared: study.noise.and(estimate.assessment.reduced_chi_squared),
        starts: estimate.starts,
        warnings,
        lines,
        provenance,
        bodies: study.bodies.clone(),
        estimate,
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
