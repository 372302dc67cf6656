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
    /// The joint file: the estimate, its uncertainty, where it holds, how well it fits and where it comes from. Where every
    /// bolt has a joint of its own it is that of the first; [`Self::joint_files`] gives all.
    #[must_use]
    pub fn joint_file(&self) -> JointFile {
        self.file_of(0)
    }

    /// A joint file for each bolt that has a joint of its own, with its name; without such bolts the one for all.
    #[must_use]
    pub fn joint_files(&self) -> Vec<(Option<&str>, JointFile)> {
        match self.bolts.with_own_joint() {
            [] => vec![(None, self.file_of(0))],
            bolts => bolts
                .iter()
                .enumerate()
                .map(|(joint, bolt)| (Some(bolt.as_str()), self.file_of(joint)))
                .collect(),
        }
    }

    fn file_of(&self, joint: usize) -> JointFile {
        let matrices = &self.estimate.joints()[joint];
        let name = match self.bolts.with_own_joint().get(joint) {
            Some(bolt) => format!("{}, {bolt}", self.name),
            None => self.name.clone(),
        };
        JointFile {
            format: Format::V1,
            name,
            joint: Joint {
                dofs: self.model.into(),
                stiffness: rows(&matrices.stiffness),
                damping: rows(&matrices.damping),
                cubic: vec![0.0; self.model.dofs()],
                over_preload: None,
            },
            bodies: self.bodies.clone(),
            uncertainty: self.uncertainty(joint),
            validity: Some(Validity {
                frequency_hz: self.frequency_hz(),
                torque_n_m: self.torque_n_m,
                level: None,
            }),
            residual: Some(self.residual()),
            provenance: self.provenance.get(joint).cloned(),
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

    fn uncertainty(&self, joint: usize) -> Option<Uncertainty> {
        let covariance = self.estimate.covariance();
        let own = self.estimate.unknowns_of(joint);
        let all = covariance.standard_deviation();
        let deviation: Vec<f64> = own.iter().map(|&index| all[index]).collect();
        if deviation.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let noise = if self.noise_is_stated {
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
        let inflation = own.iter().map(|&index| covariance.inflation[index]);
        let inflation = inflation.fold(1.0, f64::max);
        let (free, passive) = (
            &self.estimate.free_joints()[joint],
            &self.estimate.joints()[joint],
        );
        let name = |&index: &usize| covariance.unknowns[index].name.to_owned();
        let open = own.iter().filter(|&&index| !covariance.identified[index]);
        let intervals_of_all = covariance.intervals();
        let own_intervals: Vec<[f64; 2]> =
            own.iter().map(|&index| intervals_of_all[index]).collect();
        Some(Uncertainty {
            standard_deviation: deviations(self.model, &deviation),
            basis: format!(
                "information matrix of the maximum-likelihood estimate with {noise}; random errors of the receptances of {of}"
            ),
            correlation: Some(Correlation {
                unknowns: own.iter().map(name).collect(),
                matrix: rows(
                    &covariance
                        .correlation()
                        .select_rows(&own)
                        .select_columns(&own),
                ),
            }),
            interval_95: Some(intervals(self.model, &own_intervals)),
            inflation: (inflation > 1.0).then_some(inflation),
            not_identified: open.map(name).collect(),
            free_estimate: (free != passive).then(|| FreeEstimate {
                stiffness: rows(&free.stiffness),
                damping: rows(&free.damping),
            }),
            bootstrap: self
                .estimate
                .bootstrap()
                .filter(|result| result.converged > 1)
                .map(|result| bootstrap(self.model, result, &own)),
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

/// The bootstrap of the unknowns number `own`, those of one joint.
fn bootstrap(model: JointModel, result: &BootstrapResult, own: &[usize]) -> BootstrapRecord {
    let deviation: Vec<f64> = own
        .iter()
        .map(|&index| result.standard_deviation[index])
        .collect();
    let ends: Vec<[f64; 2]> = own.iter().map(|&index| result.intervals[index]).collect();
    BootstrapRecord {
        draws: result.draws,
        seed: result.seed,
        converged: result.converged,
        standard_deviation: deviations(model, &deviation),
        interval_95: intervals(model, &ends),
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}
