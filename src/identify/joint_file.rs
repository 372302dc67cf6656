//! The joint file of an identification: the passive estimate, how sure it is, where it holds and where it comes from.

use nalgebra::DMatrix;

use crate::joint::{
    BootstrapRecord, Correlation, Format, FreeEstimate, FunctionResidual, Intervals, Joint,
    JointFile, NoiseRecord, OverPreload, Residual, StandardDeviation, Uncertainty,
    UncertaintyAtPreload, UncertaintyOverPreload, Validity,
};

use super::identification::{FunctionFit, Identification};
use super::joint_estimate::{BootstrapResult, JointEstimate};
use super::model::{JointMatrices, JointModel};
use super::uncertainty::correlation;

impl Identification {
    /// The joint file: the estimate, its uncertainty, where it holds, how well it fits and where it comes from.
    #[must_use]
    pub fn joint_file(&self) -> JointFile {
        JointFile {
            format: Format::V1,
            name: self.name.clone(),
            joint: self.joint_record(),
            bodies: self.bodies.clone(),
            uncertainty: self.uncertainty(),
            validity: Some(Validity {
                frequency_hz: self.frequency_hz(),
                torque_n_m: self.torque_n_m,
                level: self.level.clone(),
            }),
            residual: Some(self.residual()),
            provenance: Some(self.provenance.clone()),
        }
    }

    fn joint_record(&self) -> Joint {
        let constant = Joint {
            dofs: self.model.into(),
            stiffness: rows(&self.joint.stiffness),
            damping: rows(&self.joint.damping),
            cubic: vec![0.0; self.model.dofs()],
            over_preload: None,
        };
        let joints = self.ascending();
        // The nominal torque is that of the first assembly.
        let nominal = self.estimate.joints().first();
        let Some(nominal) = nominal.and_then(|joint| joint.torque_n_m) else {
            return constant;
        };
        let each = |matrix: fn(&JointMatrices) -> &DMatrix<f64>| {
            let joints = joints.iter().map(|(_, joint)| rows(matrix(joint.joint())));
            joints.collect()
        };
        Joint {
            stiffness: Vec::new(),
            damping: Vec::new(),
            cubic: Vec::new(),
            over_preload: Some(OverPreload {
                preload: joints.iter().map(|(_, joint)| torque(joint)).collect(),
                nominal,
                stiffness: each(|joint| &joint.stiffness),
                damping: each(|joint| &joint.damping),
                cubic: Vec::new(),
            }),
            ..constant
        }
    }

    /// The joints by torque, each with its number.
    fn ascending(&self) -> Vec<(usize, &JointEstimate)> {
        let mut joints: Vec<_> = self.estimate.joints().iter().enumerate().collect();
        joints.sort_by(|(_, a), (_, b)| torque(a).total_cmp(&torque(b)));
        joints
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
        let all = self.estimate.covariance_of_all();
        if all.diagonal().iter().any(|variance| !variance.is_finite()) {
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
        let joints = self.estimate.joints();
        let inflation = joints.iter().flat_map(|joint| &joint.covariance.inflation);
        let inflation = inflation.copied().fold(1.0, f64::max);
        let nominal = self.at_torque(joints.first()?);
        let covariance = self.estimate.covariance();
        let names = covariance.unknowns.iter().map(|unknown| unknown.name);
        Some(Uncertainty {
            standard_deviation: nominal.standard_deviation,
            basis: format!(
                "information matrix of the maximum-likelihood estimate with {noise}; random errors of the receptances of {of}"
            ),
            correlation: Some(Correlation {
                unknowns: names.map(str::to_owned).collect(),
                matrix: rows(&covariance.correlation()),
            }),
            interval_95: nominal.interval_95,
            inflation: (inflation > 1.0).then_some(inflation),
            not_identified: nominal.not_identified,
            free_estimate: nominal.free_estimate,
            bootstrap: nominal.bootstrap,
            over_preload: (joints.len() > 1).then(|| self.uncertainty_over_preload()),
        })
    }

    fn uncertainty_over_preload(&self) -> UncertaintyOverPreload {
        let joints = self.ascending();
        let size = self.model.unknowns();
        // The covariance has the joints in the order of the assemblies.
        let places: Vec<usize> = joints
            .iter()
            .flat_map(|(number, _)| number * size..(number + 1) * size)
            .collect();
        let all = self.estimate.covariance_of_all();
        let ascending = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            all[(places[i], places[j])]
        });
        let names = joints.iter().flat_map(|(_, joint)| {
            let unknowns = joint.covariance.unknowns.iter();
            unknowns.map(|unknown| format!("{}@{}", unknown.name, torque(joint)))
        });
        UncertaintyOverPreload {
            at: joints
                .iter()
                .map(|(_, joint)| self.at_torque(joint))
                .collect(),
            correlation: Some(Correlation {
                unknowns: names.collect(),
                matrix: rows(&correlation(&ascending)),
            }),
        }
    }

    fn at_torque(&self, joint: &JointEstimate) -> UncertaintyAtPreload {
        let covariance = &joint.covariance;
        let names = covariance.unknowns.iter().map(|unknown| unknown.name);
        let not_identified = names
            .zip(&covariance.identified)
            .filter(|(_, identified)| !**identified)
            .map(|(name, _)| name.to_owned());
        UncertaintyAtPreload {
            preload: torque(joint),
            standard_deviation: deviations(self.model, &covariance.standard_deviation()),
            interval_95: Some(intervals(self.model, &covariance.intervals())),
            not_identified: not_identified.collect(),
            free_estimate: (joint.free != *joint.joint()).then(|| FreeEstimate {
                stiffness: rows(&joint.free.stiffness),
                damping: rows(&joint.free.damping),
            }),
            bootstrap: joint
                .bootstrap
                .as_ref()
                .filter(|result| result.converged > 1)
                .map(|result| bootstrap(self.model, result)),
        }
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

/// Zero for a joint that is common to all torques.
fn torque(joint: &JointEstimate) -> f64 {
    joint.torque_n_m.unwrap_or(0.0)
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
