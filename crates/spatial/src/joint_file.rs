//! The joint file of what was found.

use bolted_joint_joint::{
    BudgetRecord, Correlation, DofSet, Format, FreeEstimate, GroupRecord, InputFile, Intervals,
    Joint, JointFile, Residual, StandardDeviation, Status, Uncertainty, Validity,
};
use bolted_joint_space::Motions;
use bolted_joint_study::{Method, provenance};
use nalgebra::{DMatrix, Matrix6};

use crate::SpatialStudy;
use crate::chain::{ChainIdentification, ChainStudy, FoundJoint};
use crate::identification::{QUANTILE, SpatialIdentification, Unknown};
use crate::part_noise::percent;
use crate::problem::Level;

/// What is told of one joint.
struct Told<'t> {
    name: String,
    motions: Motions,
    reasons_against: &'t [String],
    matrices: [&'t Matrix6<f64>; 2],
    free: Option<&'t [Matrix6<f64>; 2]>,
    deviations: &'t [Matrix6<f64>; 2],
    basis: String,
    unknowns: &'t [Unknown],
    correlation: &'t DMatrix<f64>,
    budget: Option<BudgetRecord>,
    frequency_hz: &'t [f64],
    residual: Residual,
    model: &'t str,
    files: &'t [InputFile],
    notes: &'t [String],
}

impl Told<'_> {
    fn joint_file(self) -> JointFile {
        let Numbered { dofs, rows } = Numbered::of(self.matrices[0], self.motions);
        let part = |matrix: &Matrix6<f64>| lists(&rows, |i, j| matrix[(i, j)]);
        let interval = |n: usize| {
            let (matrix, deviation) = (self.matrices[n], &self.deviations[n]);
            let free = self.free.map_or(matrix, |free| &free[n]);
            lists(&rows, |i, j| {
                [-1.0, 1.0].map(|sign| {
                    let end = free[(i, j)] + sign * QUANTILE * deviation[(i, j)];
                    // with the passive estimate in it
                    sign * (sign * end).max(sign * matrix[(i, j)])
                })
            })
        };
        let count = self.unknowns.len();
        let names = |of: fn(&Unknown) -> bool| {
            let unknowns = self.unknowns.iter().filter(|unknown| of(unknown));
            unknowns.map(|unknown| unknown.name.clone()).collect()
        };
        let [stiffness, damping] = self.matrices;
        JointFile {
            about: None,
            format: Format::V1,
            name: self.name,
            status: Status::against(self.reasons_against),
            joint: Joint::linear(dofs, part(stiffness), part(damping)),
            bodies: None,
            uncertainty: Some(Uncertainty {
                standard_deviation: StandardDeviation {
                    stiffness: part(&self.deviations[0]),
                    damping: part(&self.deviations[1]),
                    ..StandardDeviation::default()
                },
                basis: self.basis,
                correlation: Some(Correlation {
                    unknowns: names(|_| true),
                    matrix: (0..count)
                        .map(|i| (0..count).map(|j| self.correlation[(i, j)]).collect())
                        .collect(),
                }),
                interval_95: Some(Intervals {
                    stiffness: interval(0),
                    damping: interval(1),
                }),
                budget: self.budget,
                not_identified: names(|unknown| !unknown.is_determined),
                free_estimate: self.free.map(|[stiffness, damping]| FreeEstimate {
                    stiffness: part(stiffness),
                    damping: part(damping),
                    ..FreeEstimate::default()
                }),
                ..Uncertainty::default()
            }),
            validity: self.frequency_hz.first().zip(self.frequency_hz.last()).map(
                |(first, last)| Validity {
                    frequency_hz: [*first, *last],
                    torque_n_m: None,
                    level: None,
                },
            ),
            residual: Some(self.residual),
            provenance: Some(provenance(
                Method::FrfSpace,
                self.model.to_owned(),
                self.files.to_vec(),
                self.notes.to_vec(),
            )),
        }
    }
}

impl SpatialIdentification {
    /// The joint file: six degrees of freedom, or those on which the model has anything.
    #[must_use]
    pub fn joint_file(&self, study: &SpatialStudy) -> JointFile {
        let motions = study.motions;
        let rows = Numbered::of(&self.stiffness, motions).rows;
        let part = |matrix: &Matrix6<f64>| lists(&rows, |i, j| matrix[(i, j)]);
        // part of each entry's variance
        let share = |own: &Matrix6<f64>, all: &Matrix6<f64>| {
            lists(&rows, |i, j| match all[(i, j)] {
                0.0 => 0.0,
                all => (own[(i, j)] / all).powi(2).min(1.0),
            })
        };
        let substructures = match (&study.noise, &self.substructures) {
            ([a, b], Some(found)) => format!(
                "noise of the substructures taken into account (a: {}; b: {}), {} lines left out where it moves too much",
                a.in_words(),
                b.in_words(),
                found.lines_left_out
            ),
            _ => "the substructures' functions taken as exact".to_owned(),
        };
        let tolerances = study.problem.tolerances;
        let errors = match tolerances {
            None => "the set-up taken as exact",
            Some(_) => "with what errors of sensors and impacts do to the estimate, to first order",
        };
        let [by_stiffness, by_damping] = &self.deviations;
        let [of_stiffness, of_damping] = &self.deviations_by_noise;
        let level = words(study.level);
        Told {
            name: study.name.clone(),
            motions,
            reasons_against: &self.reasons_against,
            matrices: [&self.stiffness, &self.damping],
            free: self.free.as_ref(),
            deviations: &self.deviations,
            basis: format!(
                "information matrix of the assembly's functions, {level}; {errors}; {substructures}{}",
                self.warnings.iter().map(|told| format!("; {told}")).collect::<String>()
            ),
            unknowns: &self.unknowns,
            correlation: &self.correlation,
            budget: tolerances.map(|_| BudgetRecord {
                noise_alone: StandardDeviation {
                    stiffness: part(of_stiffness),
                    damping: part(of_damping),
                    ..StandardDeviation::default()
                },
                groups: self
                    .groups
                    .iter()
                    .map(|group| GroupRecord {
                        group: group.name.clone(),
                        stiffness: share(&group.deviations[0], by_stiffness),
                        damping: share(&group.deviations[1], by_damping),
                    })
                    .collect(),
                contradicted: Vec::new(),
            }),
            frequency_hz: &study.problem.frequency_hz,
            residual: residual(self.relative_rms, self.lines, self.reduced_chi_squared),
            model: &study.model,
            files: &study.files,
            notes: &study.notes,
        }
        .joint_file()
    }
}

impl FoundJoint {
    /// Its joint file.
    #[must_use]
    pub fn joint_file(&self, study: &ChainStudy, found: &ChainIdentification) -> JointFile {
        let level = words(study.level);
        Told {
            name: format!("{}, joint {}", study.name, self.number),
            motions: study.motions,
            reasons_against: &found.reasons_against,
            matrices: [&self.stiffness, &self.damping],
            free: self.free.as_ref(),
            deviations: &self.deviations,
            basis: format!(
                "information matrix of the assembly's functions with all joints that are sought, {level}; the set-up and the parts' \
                 functions taken as exact"
            ),
            unknowns: &self.unknowns,
            correlation: &self.correlation,
            budget: None,
            frequency_hz: &study.problem.frequency_hz,
            residual: residual(found.relative_rms, found.lines, found.reduced_chi_squared),
            model: &self.model,
            files: &study.files,
            notes: &study.notes,
        }
        .joint_file()
    }
}

fn residual(relative_rms: f64, lines: usize, reduced_chi_squared: Option<f64>) -> Residual {
    Residual {
        relative_rms,
        lines,
        reduced_chi_squared,
        ..Residual::default()
    }
}

fn words(level: Level) -> String {
    match level {
        Level::Relative(part) => format!("noise of {} of each function's r.m.s.", percent(part)),
        Level::OfCoherence => "the noise that coherence and averages tell".to_owned(),
        Level::OfResiduals => "noise as large as each function's residual".to_owned(),
    }
}

/// DOFs of the file, and their rows among the six.
struct Numbered {
    dofs: DofSet,
    rows: Vec<usize>,
}

impl Numbered {
    fn of(stiffness: &Matrix6<f64>, motions: Motions) -> Self {
        let dofs = dofs(stiffness, motions);
        let rows = dofs.rows();
        let rows = rows.filter_map(|dof| DofSet::SPACE.position(dof.name));
        Self {
            rows: rows.collect(),
            dofs,
        }
    }
}

/// All motions of the study, or of all six the translations where no rotation has any stiffness.
fn dofs(stiffness: &Matrix6<f64>, motions: Motions) -> DofSet {
    if !motions.are_all() {
        let has = |name: &str| motions.dofs().any(|dof| dof.symbol() == name);
        return DofSet::in_space(|dof| has(dof.name)).unwrap_or(DofSet::SPACE);
    }
    let has_rotations = (3..6).any(|i| (0..6).any(|j| stiffness[(i, j)] != 0.0));
    let translations = ["x", "y", "z"];
    let of_translations = DofSet::in_space(|dof| translations.contains(&dof.name));
    of_translations
        .filter(|_| !has_rotations)
        .unwrap_or(DofSet::SPACE)
}

fn lists<T>(rows: &[usize], of: impl Fn(usize, usize) -> T) -> Vec<Vec<T>> {
    let row = |&i: &usize| rows.iter().map(|&j| of(i, j)).collect();
    rows.iter().map(row).collect()
}
