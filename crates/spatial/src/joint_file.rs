//! The joint file of what was found.

use bolted_joint_joint::{
    BudgetRecord, Correlation, DofSet, Format, FreeEstimate, GroupRecord, Intervals, Joint,
    JointFile, Residual, StandardDeviation, Status, Uncertainty, Validity,
};
use bolted_joint_study::{Method, provenance};
use nalgebra::Matrix6;

use crate::SpatialStudy;
use crate::identification::{QUANTILE, SpatialIdentification};
use crate::problem::Level;

impl SpatialIdentification {
    /// The joint file: six degrees of freedom, or those on which the model has anything.
    #[must_use]
    pub fn joint_file(&self, study: &SpatialStudy) -> JointFile {
        let dofs = dofs(&self.stiffness);
        let rows: Vec<usize> = dofs
            .rows()
            .filter_map(|dof| DofSet::SPACE.position(dof.name))
            .collect();
        let part = |matrix: &Matrix6<f64>| lists(&rows, |i, j| matrix[(i, j)]);
        let [of_stiffness, of_damping] = &self.deviations;
        let [free_stiffness, free_damping] = match &self.free {
            Some([stiffness, damping]) => [stiffness, damping],
            None => [&self.stiffness, &self.damping],
        };
        let deviation = |[stiffness, damping]: &[Matrix6<f64>; 2]| StandardDeviation {
            stiffness: part(stiffness),
            damping: part(damping),
        };
        let interval = |matrix: &Matrix6<f64>, free: &Matrix6<f64>, deviation: &Matrix6<f64>| {
            lists(&rows, |i, j| {
                [-1.0, 1.0].map(|sign| {
                    let end = free[(i, j)] + sign * QUANTILE * deviation[(i, j)];
                    // with the passive estimate in it
                    sign * (sign * end).max(sign * matrix[(i, j)])
                })
            })
        };
        // part of each entry's variance
        let share = |own: &Matrix6<f64>, all: &Matrix6<f64>| {
            lists(&rows, |i, j| match all[(i, j)] {
                0.0 => 0.0,
                all => (own[(i, j)] / all).powi(2).min(1.0),
            })
        };
        let problem = &study.problem;
        let level = match study.level {
            Level::Relative(part) => {
                format!("noise of {} % of each function's r.m.s.", 100.0 * part)
            }
            Level::OfResiduals => "noise as large as each function's residual".to_owned(),
        };
        let substructures = match (study.noise, &self.substructures) {
            ([a, b], Some(found)) => format!(
                "noise of {} % and {} % of each value of a and of b taken into account, {} lines left out where it moves too much",
                100.0 * a,
                100.0 * b,
                found.lines_left_out
            ),
            _ => "the substructures' functions taken as exact".to_owned(),
        };
        let errors = match problem.tolerances {
            None => "the set-up taken as exact",
            Some(_) => "with what errors of sensors and impacts do to the estimate, to first order",
        };
        let count = self.unknowns.len();
        let frequency = &problem.frequency_hz;
        JointFile {
            format: Format::V1,
            name: study.name.clone(),
            status: Status::against(&self.reasons_against),
            joint: Joint::linear(dofs, part(&self.stiffness), part(&self.damping)),
            bodies: None,
            uncertainty: Some(Uncertainty {
                standard_deviation: deviation(&self.deviations),
                basis: format!(
                    "information matrix of the assembly's functions, {level}; {errors}; {substructures}"
                ),
                correlation: Some(Correlation {
                    unknowns: self
                        .unknowns
                        .iter()
                        .map(|unknown| unknown.name.clone())
                        .collect(),
                    matrix: (0..count)
                        .map(|i| (0..count).map(|j| self.correlation[(i, j)]).collect())
                        .collect(),
                }),
                interval_95: Some(Intervals {
                    stiffness: interval(&self.stiffness, free_stiffness, of_stiffness),
                    damping: interval(&self.damping, free_damping, of_damping),
                }),
                budget: problem.tolerances.map(|_| BudgetRecord {
                    noise_alone: deviation(&self.deviations_by_noise),
                    groups: self
                        .groups
                        .iter()
                        .map(|group| GroupRecord {
                            group: group.name.clone(),
                            stiffness: share(&group.deviations[0], of_stiffness),
                            damping: share(&group.deviations[1], of_damping),
                        })
                        .collect(),
                    contradicted: Vec::new(),
                }),
                not_identified: self
                    .unknowns
                    .iter()
                    .filter(|unknown| !unknown.is_determined)
                    .map(|unknown| unknown.name.clone())
                    .collect(),
                free_estimate: self.free.as_ref().map(|[stiffness, damping]| FreeEstimate {
                    stiffness: part(stiffness),
                    damping: part(damping),
                    ..FreeEstimate::default()
                }),
                ..Uncertainty::default()
            }),
            validity: frequency
                .first()
                .zip(frequency.last())
                .map(|(first, last)| Validity {
                    frequency_hz: [*first, *last],
                    torque_n_m: None,
                    level: None,
                }),
            residual: Some(Residual {
                relative_rms: self.relative_rms,
                lines: self.lines,
                reduced_chi_squared: self.reduced_chi_squared,
                ..Residual::default()
            }),
            provenance: Some(provenance(
                Method::FrfSpace,
                study.model.clone(),
                study.files.clone(),
                study.notes.clone(),
            )),
        }
    }
}

/// All six, or the translations where no rotation has any stiffness.
fn dofs(stiffness: &Matrix6<f64>) -> DofSet {
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
