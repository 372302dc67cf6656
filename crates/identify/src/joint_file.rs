//! The joint file of an identification: the passive estimate, how sure it is, where it holds and where it comes from.

use nalgebra::DMatrix;

use bolted_joint_joint::{
    BootstrapRecord, BudgetRecord, Correlation, Format, FreeEstimate, FunctionResidual,
    GroupRecord, Intervals, Joint, JointFile, NoiseRecord, OutlierRecord, OverPreload, Residual,
    StandardDeviation, Status, Uncertainty, UncertaintyAtPreload, UncertaintyOverPreload, Validity,
};

use bolted_joint_systematic::Group;

use super::identification::{FunctionFit, Identification};
use super::joint_estimate::{BootstrapResult, JointEstimate};
use super::model::{JointMatrices, JointModel};
use super::uncertainty;

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
                .map(|(bolt, name)| (Some(name.as_str()), self.file_of(bolt)))
                .collect(),
        }
    }

    fn file_of(&self, bolt: usize) -> JointFile {
        let name = match self.bolts.with_own_joint().get(bolt) {
            Some(bolt) => format!("{}, {bolt}", self.name),
            None => self.name.clone(),
        };
        JointFile {
            about: None,
            format: Format::V1,
            name,
            status: Status::against(&self.reasons_against),
            joint: self.joint_record(bolt),
            bodies: self.bodies.clone(),
            uncertainty: self.uncertainty(bolt),
            validity: Some(Validity {
                frequency_hz: self.frequency_hz(),
                torque_n_m: self.torque_n_m,
                level: self.level.clone(),
            }),
            residual: Some(self.residual()),
            provenance: self.provenance.get(bolt).cloned(),
        }
    }

    fn joint_record(&self, bolt: usize) -> Joint {
        let joint = &self.estimate.bolts()[bolt];
        let (stiffness, damping) = (rows(&joint.stiffness), rows(&joint.damping));
        let constant = Joint {
            cubic: vec![0.0; self.model.dofs()],
            ..Joint::linear(self.model.into(), stiffness, damping)
        };
        let joints = self.ascending();
        // The nominal torque is that of the first assembly.
        let nominal = self.estimate.joints.first();
        let Some(nominal) = nominal.and_then(|joint| joint.torque_n_m) else {
            return constant;
        };
        let each = |matrix: fn(&JointMatrices) -> &DMatrix<f64>| {
            let joints = joints.iter();
            joints
                .map(|(_, joint)| rows(matrix(&joint.bolts()[bolt])))
                .collect()
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
                friction: Vec::new(),
            }),
            ..constant
        }
    }

    /// The joints by torque, each with its number.
    fn ascending(&self) -> Vec<(usize, &JointEstimate)> {
        let mut joints: Vec<_> = self.estimate.joints.iter().enumerate().collect();
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

    fn uncertainty(&self, bolt: usize) -> Option<Uncertainty> {
        let all = &self.estimate.covariance_of_all;
        if all.diagonal().iter().any(|variance| !variance.is_finite()) {
            return None;
        }
        let noise = if self.estimate.assessment.noise_is_known {
            "the noise that coherence and averages tell"
        } else if self.noise_is_stated {
            "the stated noise"
        } else {
            "the noise that the residual shows"
        };
        let substructures = self.lines.a.measured().is_some() || self.lines.b.measured().is_some();
        let of = if substructures {
            "the assembly and of the measured substructures"
        } else {
            "the assembly only"
        };
        let joints = &self.estimate.joints;
        let inflation = joints.iter().flat_map(|joint| {
            let own = joint.unknowns_of(bolt).into_iter();
            own.map(|index| joint.covariance.inflation[index])
        });
        let inflation = inflation.fold(1.0, f64::max);
        let nominal = joints.first()?;
        let own = nominal.unknowns_of(bolt);
        let correlation = nominal.covariance.correlation();
        let names = own
            .iter()
            .map(|&index| nominal.covariance.unknowns[index].name);
        let nominal = self.at_torque((0, nominal), bolt);
        let budget = match self.systematic {
            Some(_) => ", and errors of the set-up within the error budget",
            None => "",
        };
        Some(Uncertainty {
            standard_deviation: nominal.standard_deviation,
            basis: format!(
                "information matrix of the maximum-likelihood estimate with {noise}; random errors of the receptances of {of}{budget}"
            ),
            correlation: Some(Correlation {
                unknowns: names.map(str::to_owned).collect(),
                matrix: rows(&correlation.select_rows(&own).select_columns(&own)),
            }),
            interval_95: nominal.interval_95,
            inflation: (inflation > 1.0).then_some(inflation),
            budget: nominal.budget,
            not_identified: nominal.not_identified,
            free_estimate: nominal.free_estimate,
            bootstrap: nominal.bootstrap,
            over_preload: (joints.len() > 1).then(|| self.uncertainty_over_preload(bolt)),
        })
    }

    /// What errors of the set-up do to the unknowns number `own` among those of all torques.
    fn budget(&self, own: &[usize]) -> Option<BudgetRecord> {
        let found = self.systematic.as_ref()?;
        let noise: Vec<f64> = found
            .noise_covariance
            .diagonal()
            .iter()
            .map(|v| v.sqrt())
            .collect();
        let group = |(group, parts): &(Group, Vec<f64>)| {
            let matrices = JointMatrices::from_unknowns(self.model, &chosen(parts, own));
            GroupRecord {
                group: group.name().to_owned(),
                stiffness: rows(&matrices.stiffness),
                damping: rows(&matrices.damping),
            }
        };
        Some(BudgetRecord {
            noise_alone: deviations(self.model, &chosen(&noise, own)),
            groups: found.shares.groups.iter().map(group).collect(),
            contradicted: found.contradicted(),
        })
    }

    fn uncertainty_over_preload(&self, bolt: usize) -> UncertaintyOverPreload {
        let joints = self.ascending();
        // The covariance has the torques in the order of the assemblies.
        let places: Vec<usize> = joints
            .iter()
            .flat_map(|(number, joint)| {
                let first = number * joint.covariance.unknowns.len();
                let own = joint.unknowns_of(bolt).into_iter();
                own.map(move |index| first + index)
            })
            .collect();
        let all = &self.estimate.covariance_of_all;
        let ascending = all.select_rows(&places).select_columns(&places);
        let names = joints.iter().flat_map(|(_, joint)| {
            let own = joint.unknowns_of(bolt).into_iter();
            own.map(|index| {
                let name = joint.covariance.unknowns[index].name;
                format!("{name}@{}", torque(joint))
            })
        });
        UncertaintyOverPreload {
            at: joints
                .iter()
                .map(|&numbered| self.at_torque(numbered, bolt))
                .collect(),
            correlation: Some(Correlation {
                unknowns: names.collect(),
                matrix: rows(&uncertainty::correlation(&ascending)),
            }),
        }
    }

    fn at_torque(
        &self,
        (number, joint): (usize, &JointEstimate),
        bolt: usize,
    ) -> UncertaintyAtPreload {
        let covariance = &joint.covariance;
        let own = joint.unknowns_of(bolt);
        let first = number * covariance.unknowns.len();
        let among_all: Vec<usize> = own.iter().map(|index| first + index).collect();
        let open = own.iter().filter(|&&index| !covariance.identified[index]);
        let (deviation, ends) = (covariance.standard_deviation(), joint.intervals());
        let (free, passive) = (&joint.free[bolt], &joint.bolts()[bolt]);
        UncertaintyAtPreload {
            preload: torque(joint),
            standard_deviation: deviations(self.model, &chosen(&deviation, &own)),
            interval_95: Some(intervals(self.model, &chosen(&ends, &own))),
            budget: self.budget(&among_all),
            not_identified: open
                .map(|&index| covariance.unknowns[index].name.to_owned())
                .collect(),
            free_estimate: (free != passive).then(|| FreeEstimate {
                stiffness: rows(&free.stiffness),
                damping: rows(&free.damping),
                ..FreeEstimate::default()
            }),
            bootstrap: joint
                .bootstrap
                .as_ref()
                .filter(|result| result.converged > 1)
                .map(|result| bootstrap(self.model, result, &own)),
        }
    }

    fn residual(&self) -> Residual {
        let further = || self.further.iter();
        let lines = further().map(|assembly| assembly.lines.frequency_hz.len());
        let fits = self.fits.iter().chain(further().flat_map(|a| &a.fits));
        let assessment = &self.estimate.assessment;
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
            outliers: self
                .outliers
                .values
                .iter()
                .map(|outlier| OutlierRecord {
                    set: outlier.set.clone(),
                    response: outlier.response.to_string(),
                    reference: outlier.reference.to_string(),
                    frequency_hz: outlier.frequency_hz,
                })
                .collect(),
            lines_left_out: Some(self.outliers.lines_left_out).filter(|lines| *lines > 0),
            line_correlation: assessment
                .line_correlation
                .is_finite()
                .then_some(assessment.line_correlation),
            noise: self.estimate.noise_level.map(|level| NoiseRecord {
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
        ..StandardDeviation::default()
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

/// Those of the `values` that belong to the unknowns number `own`.
fn chosen<T: Copy>(values: &[T], own: &[usize]) -> Vec<T> {
    own.iter().map(|&index| values[index]).collect()
}

fn bootstrap(model: JointModel, result: &BootstrapResult, own: &[usize]) -> BootstrapRecord {
    BootstrapRecord {
        drawn: result.drawn,
        draws: result.draws,
        seed: result.seed,
        converged: result.converged,
        standard_deviation: deviations(model, &chosen(&result.standard_deviation, own)),
        interval_95: intervals(model, &chosen(&result.intervals, own)),
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}
