//! The joint file of an identification: the passive estimate, how sure it is, where it holds and where it comes from.

use nalgebra::DMatrix;

use crate::joint::{
    BootstrapRecord, Correlation, Format, FreeEstimate, FunctionResidual, Intervals, Joint,
    JointFile, NoiseRecord, Residual, StandardDeviation, Uncertainty, Validity,
};

use super::identification::{FunctionFit, Identification};
use super::lines_estimate::BootstrapResult;
use super::model::{JointMatrices, JointModel};

impl Identification {
    /// The joint file: the estimate, its uncertainty, where it holds, how well it fits and where it comes from.
    #[must_use]
    pub fn joint_file(&self) -> JointFile {
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
            uncertainty: self.uncertainty(),
            validity: Some(Validity {
                frequency_hz: self.frequency_hz(),
                torque_n_m: self.torque_n_m,
                level: None,
            }),
            residual: Some(self.residual()),
            provenance: Some(self.provenance.clone()),
        }
    }

    fn frequency_hz(&self) -> [f64; 2] {
        let further = self.further.iter().map(|assembly| &assembly.lines);
        let all = std::iter::once(&self.lines).chain(further);
        let lines = all.flat_map(|lines| &lines.frequency_hz);
        lines.fold([f64::INFINITY, 0.0], |[low, high], &hz| {
            [low.min(hz), high.max(hz)]
        })
    }

    fn uncertainty(&self) -> Option<Uncertainty> {
        let covariance = self.estimate.covariance();
        let deviation = covariance.standard_deviation();
        if deviation.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let noise = if self.estimate.assessment().noise_is_known {
            "the noise that coherence and averages tell"
        } else if self.noise_is_stated {
            "the stated noise"
        } else {
            "the noise that the residual shows"
        };
        let substructures = self.lines.a_measured.is_some() || self.lines.b_measured.is_some();
        let of = if substructures {
            "the assembly and of the measured substructures"
        } else {
            "the assembly only"
        };
        let inflation = covariance.inflation.iter().copied().fold(1.0, f64::max);
        let free = self.estimate.free();
        let names = covariance.unknowns.iter().map(|unknown| unknown.name);
        let not_identified = names
            .clone()
            .zip(&covariance.identified)
            .filter(|(_, identified)| !**identified)
            .map(|(name, _)| name.to_owned());
        Some(Uncertainty {
            standard_deviation: deviations(self.model, &deviation),
            basis: format!(
                "information matrix of the maximum-likelihood estimate with {noise}; random errors of the receptances of {of}"
            ),
            correlation: Some(Correlation {
                unknowns: names.map(str::to_owned).collect(),
                matrix: rows(&covariance.correlation()),
            }),
            interval_95: Some(intervals(self.model, &covariance.intervals())),
            inflation: (inflation > 1.0).then_some(inflation),
            not_identified: not_identified.collect(),
            free_estimate: (*free != self.joint).then(|| FreeEstimate {
                stiffness: rows(&free.stiffness),
                damping: rows(&free.damping),
            }),
            bootstrap: self
                .estimate
                .bootstrap()
                .filter(|result| result.converged > 1)
                .map(|result| bootstrap(self.model, result)),
        })
    }

    fn residual(&self) -> Residual {
        let further = || self.further.iter();
        let lines = further().map(|assembly| assembly.lines.frequency_hz.len());
        let fits = self.fits.iter().chain(further().flat_map(|a| &a.fits));
        let assessment = self.estimate.assessment();
        Residual {
            relative_rms: self.relative_rms,
            lines: self.lines.frequency_hz.len() + lines.sum::<usize>(),
            functions: fits
                .map(|fit: &FunctionFit| FunctionResidual {
                    response: fit.response.to_string(),
                    reference: fit.reference.to_string(),
                    relative_rms: fit.relative_rms,
                })
                .collect(),
            reduced_chi_squared: self.reduced_chi_squared,
            line_correlation: assessment
                .line_correlation
                .is_finite()
                .then_some(assessment.line_correlation),
            noise: self.estimate.noise_level().map(|level| NoiseRecord {
                relative: level.relative,
                floor: level.floor,
                stated: self.noise_is_stated,
            }),
        }
    }
}

fn deviations(model: JointModel, deviation: &[f64]) -> StandardDeviation {
    let matrices = JointMatrices::from_unknowns(model, deviation);
    StandardDeviation {
        stiffness: rows(&matrices.stiffness),
        damping: rows(&matrices.damping),
    }
}

fn intervals(model: JointModel, intervals: &[[f64; 2]]) -> Intervals {
    let end = |end: usize| {
        let values: Vec<f64> = intervals.iter().map(|interval| interval[end]).collect();
        JointMatrices::from_unknowns(model, &values)
    };
    let (low, high) = (end(0), end(1));
    let pairs = |low: &DMatrix<f64>, high: &DMatrix<f64>| {
        let row = |i: usize| {
            (0..low.ncols())
                .map(|j| [low[(i, j)], high[(i, j)]])
                .collect()
        };
        (0..low.nrows()).map(row).collect()
    };
    Intervals {
        stiffness: pairs(&low.stiffness, &high.stiffness),
        damping: pairs(&low.damping, &high.damping),
    }
}

fn bootstrap(model: JointModel, result: &BootstrapResult) -> BootstrapRecord {
    BootstrapRecord {
        draws: result.draws,
        seed: result.seed,
        converged: result.converged,
        standard_deviation: deviations(model, &result.standard_deviation),
        interval_95: intervals(model, &result.intervals),
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}
