//! Several joints of a chain at once, and whether the functions tell them apart.

use bolted_joint_joint::{
    Correlation, DofSet, Format, Intervals, Joint, JointFile, Residual, StandardDeviation, Status,
    Uncertainty, Validity,
};
use bolted_joint_space::Parametrisation;
use bolted_joint_study::{Method, provenance};
use nalgebra::{DMatrix, DVector, Matrix6};

use super::apart::{Apart, apart};
use super::assembled::Assembled;
use super::links::{Sought, is_determined, size};
use super::normal::Normal;
use super::problem::{Problem, Unknowns};
use super::search::{downhill, searched};
use super::study::ChainStudy;
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::identification::{QUANTILE, Unknown};
use crate::normal::Deviations;
use crate::passive::{is_passive, nearest};
use crate::problem::Level;

/// Rounds in which the level of the noise follows the residuals.
const ROUNDS: usize = 5;

/// Level of a function whose residual is nothing, in parts of its r.m.s.: rounding.
const LEAST_LEVEL: f64 = 1e-12;

/// Lines that are searched from several starts; all are used from where these lead.
const SEARCHED: usize = 40;

/// χ² over degrees of freedom beyond which stated noise does not explain the residuals.
const MISFIT: f64 = 1.5;

/// Residual over computed functions, r.m.s., beyond which the model is not that of the data.
const RESIDUAL_MAX: f64 = 0.5;

/// Growth of the deviations of one joint by the unknowns of another, in the median, beyond which the functions hardly tell them
/// apart.
const GROWTH_MAX: f64 = 100.0;

/// One of the joints that were sought.
#[derive(Clone, Debug)]
pub struct FoundJoint {
    /// Its table in the study.
    pub key: String,
    /// Its place in the chain, from 1.
    pub number: usize,
    /// The unknowns of stiffness, then those of damping.
    pub unknowns: Vec<Unknown>,
    /// K, N/m, N/rad, N·m/rad.
    pub stiffness: Matrix6<f64>,
    /// C, in the units of K times s.
    pub damping: Matrix6<f64>,
    /// Standard deviations of the entries of K and of C.
    pub deviations: [Matrix6<f64>; 2],
    /// Correlation of its unknowns.
    pub correlation: DMatrix<f64>,
    model: String,
    free: [Matrix6<f64>; 2],
}

/// What was found of a chain.
#[derive(Clone, Debug)]
pub struct ChainIdentification {
    /// The joints that were sought, in the order of the chain.
    pub joints: Vec<FoundJoint>,
    /// Whether they are told apart.
    pub apart: Vec<Apart>,
    /// Root mean square of |measured − computed|/|computed|'s r.m.s. of each function.
    pub relative_rms: f64,
    /// Functions of the assembly that were compared.
    pub functions: usize,
    /// Lines.
    pub lines: usize,
    /// χ² over degrees of freedom where the noise is stated.
    pub reduced_chi_squared: Option<f64>,
    /// Starts of the search, and how many came to the same minimum.
    pub starts: [usize; 2],
    /// Why the result is not to be relied on.
    pub reasons_against: Vec<String>,
}

impl ChainStudy {
    /// The joints that are sought, all at once, from sensors and impacts whose places are exact.
    ///
    /// # Errors
    /// [`SpatialError`] where the functions do not determine them, or do not tell them apart.
    pub fn identify(&self) -> Result<ChainIdentification, SpatialError> {
        let problem = self.measured()?;
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        let count = problem.joint_count();
        if 2 * functions * lines <= count {
            return Err(SpatialError::TooFewFunctions {
                found: functions,
                lines,
                unknowns: count,
            });
        }
        let rms: Deviations = problem
            .observed
            .iter()
            .map(|one| {
                let squares: f64 = one.values.iter().map(|value| value.norm_sqr()).sum();
                (squares / lines as f64).sqrt()
            })
            .collect();
        let mut level = match self.level {
            Level::Relative(part) => rms.iter().map(|rms| part * rms).collect(),
            Level::OfResiduals => rms.clone(),
        };
        let is_stated = matches!(self.level, Level::Relative(_));
        let (coarse, starts) = searched(&problem.thinned(SEARCHED), &level, is_stated)?;
        let mut best = downhill(&problem, coarse.unknowns, &level)?;
        if let Level::OfResiduals = self.level {
            for _ in 0..ROUNDS {
                level = of_residuals(&problem, &best.unknowns, &rms)?;
                best = downhill(&problem, best.unknowns, &level)?;
            }
        }
        let apart = apart(&problem, &best.unknowns, &level)?;
        if let Some(alike) = apart.iter().find(|pair| !pair.told.is_told()) {
            return Err(SpatialError::NotToldApart {
                joints: alike.joints.clone(),
                correlation: alike.told.correlation,
            });
        }
        let normal = Normal::of(&problem, &best.unknowns, &level)?;
        let all = covariance(&normal.information).ok_or(SpatialError::NotDetermined)?;
        let joints: Vec<FoundJoint> = problem
            .links
            .sought()
            .iter()
            .zip(&self.models)
            .map(|(joint, model)| found(joint, model, &best.unknowns.0, &all))
            .collect::<Result<_, _>>()?;
        let freedom = (2 * functions * lines - count) as f64;
        let mut found = ChainIdentification {
            joints,
            apart,
            relative_rms: relative_rms(&problem, &best.unknowns)?,
            functions,
            lines,
            reduced_chi_squared: is_stated.then_some(best.cost / freedom),
            starts,
            reasons_against: Vec::new(),
        };
        found.reasons_against = found.reasons(best.has_converged && coarse.has_converged);
        Ok(found)
    }

    /// The problem with what was measured.
    fn measured(&self) -> Result<Problem, SpatialError> {
        let sought = self.sought();
        if sought == 0 {
            return Err(SpatialError::AllKnown);
        }
        if sought > 1 && self.problem.tolerances.is_some() {
            return Err(SpatialError::BudgetOfSeveral { sought });
        }
        let mut problem = self.problem.clone();
        problem.tolerances = None;
        problem.observed = self.observed()?;
        Ok(problem)
    }
}

impl ChainIdentification {
    fn reasons(&self, has_converged: bool) -> Vec<String> {
        let mut reasons = Vec::new();
        if !has_converged {
            reasons.push(
                "the search has not converged, or its starts lead to different minima".to_owned(),
            );
        }
        if self.relative_rms > RESIDUAL_MAX {
            reasons.push(format!(
                "the residual is {:.0} % of the functions: the model is not that of the data; check units, directions and signs",
                100.0 * self.relative_rms
            ));
        }
        if let Some(chi) = self.reduced_chi_squared.filter(|&chi| chi > MISFIT) {
            reasons.push(format!(
                "χ² over degrees of freedom is {chi:.2}: the stated noise does not explain the residuals, and the deviations are too small"
            ));
        }
        for pair in &self.apart {
            let growth = pair.told.median_growth().into_iter().fold(0.0, f64::max);
            if growth > GROWTH_MAX {
                let [one, other] = &pair.joints;
                reasons.push(format!(
                    "the functions hardly tell {one} and {other} apart: with both unknown, deviations are {growth:.0} times as large as \
                     with one of them known; measure on the part between them, at frequencies where it bends, or state one of the joints \
                     (known)"
                ));
            }
        }
        reasons
    }
}

impl FoundJoint {
    /// Its joint file.
    #[must_use]
    pub fn joint_file(&self, study: &ChainStudy, found: &ChainIdentification) -> JointFile {
        let has_rotations = (3..6).any(|i| self.stiffness[(i, i)] != 0.0);
        let translations = ["x", "y", "z"];
        let of_translations = DofSet::in_space(|dof| translations.contains(&dof.name));
        let dofs = of_translations
            .filter(|_| !has_rotations)
            .unwrap_or(DofSet::SPACE);
        let size = dofs.count();
        let lists = |matrix: &Matrix6<f64>| -> Vec<Vec<f64>> {
            (0..size)
                .map(|i| (0..size).map(|j| matrix[(i, j)]).collect())
                .collect()
        };
        let interval = |part: usize, matrix: &Matrix6<f64>| -> Vec<Vec<[f64; 2]>> {
            let end = |sign: f64, i: usize, j: usize| {
                let end = self.free[part][(i, j)] + sign * QUANTILE * self.deviations[part][(i, j)];
                // with the passive estimate in it
                sign * (sign * end).max(sign * matrix[(i, j)])
            };
            let both = |i: usize, j: usize| [-1.0, 1.0].map(|sign| end(sign, i, j));
            (0..size)
                .map(|i| (0..size).map(|j| both(i, j)).collect())
                .collect()
        };
        let level = match study.level {
            Level::Relative(part) => {
                format!("noise of {} % of each function's r.m.s.", 100.0 * part)
            }
            Level::OfResiduals => "noise as large as each function's residual".to_owned(),
        };
        let count = self.unknowns.len();
        let frequency = &study.problem.frequency_hz;
        JointFile {
            format: Format::V1,
            name: format!("{}, joint {}", study.name, self.number),
            status: Status::against(&found.reasons_against),
            joint: Joint::linear(dofs, lists(&self.stiffness), lists(&self.damping)),
            bodies: None,
            uncertainty: Some(Uncertainty {
                standard_deviation: StandardDeviation {
                    stiffness: lists(&self.deviations[0]),
                    damping: lists(&self.deviations[1]),
                },
                basis: format!(
                    "information matrix of the assembly's functions with all joints that are sought, {level}; the set-up and the parts' \
                     functions taken as exact"
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
                    stiffness: interval(0, &self.stiffness),
                    damping: interval(1, &self.damping),
                }),
                not_identified: self
                    .unknowns
                    .iter()
                    .filter(|unknown| !unknown.is_determined)
                    .map(|unknown| unknown.name.clone())
                    .collect(),
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
                relative_rms: found.relative_rms,
                lines: found.lines,
                reduced_chi_squared: found.reduced_chi_squared,
                ..Residual::default()
            }),
            provenance: Some(provenance(
                Method::FrfSpace,
                self.model.clone(),
                study.files.clone(),
                study.notes.clone(),
            )),
        }
    }
}

/// One joint of all unknowns and their covariance.
fn found(
    joint: &Sought<'_>,
    name: &str,
    values: &DVector<f64>,
    all: &DMatrix<f64>,
) -> Result<FoundJoint, SpatialError> {
    let model = joint.model;
    let count = 2 * model.count();
    let own = all
        .view((joint.first, joint.first), (count, count))
        .into_owned();
    let free = DVector::from_column_slice(joint.of(values.as_slice()));
    let passive = match is_passive(model, &free) {
        true => free.clone(),
        false => {
            let information = covariance(&own).ok_or(SpatialError::NotDetermined)?;
            nearest(model, &free, &information, joint.link.length_m).unwrap_or_else(|| free.clone())
        }
    };
    let matrices = |unknowns: &DVector<f64>| -> Result<[Matrix6<f64>; 2], SpatialError> {
        let (stiffness, damping) = unknowns.as_slice().split_at(model.count());
        Ok([model.matrix(stiffness)?, model.matrix(damping)?])
    };
    let passive_matrices = matrices(&passive)?;
    let [stiffness, damping] = passive_matrices;
    let unknowns = joint.names().into_iter().enumerate().map(|(n, name)| {
        let matrix = &passive_matrices[n / model.count()];
        let deviation = own[(n, n)].sqrt();
        Unknown {
            name,
            value: passive[n],
            free: free[n],
            deviation,
            deviation_by_noise: deviation,
            is_determined: is_determined(
                deviation,
                size(matrix, &model.entries()[n % model.count()]),
            ),
        }
    });
    Ok(FoundJoint {
        key: joint.link.key.clone(),
        number: joint.number + 1,
        unknowns: unknowns.collect(),
        stiffness,
        damping,
        deviations: entries(model, &own),
        correlation: DMatrix::from_fn(count, count, |i, j| {
            own[(i, j)] / (own[(i, i)] * own[(j, j)]).sqrt()
        }),
        model: name.to_owned(),
        free: matrices(&free)?,
    })
}

/// Deviations of the entries of K and of C.
fn entries(model: &Parametrisation, covariance: &DMatrix<f64>) -> [Matrix6<f64>; 2] {
    [0, 1].map(|part| {
        let first = part * model.count();
        Matrix6::from_fn(|i, j| {
            let mut variance = 0.0;
            for (m, one) in model.bases().iter().enumerate() {
                for (n, other) in model.bases().iter().enumerate() {
                    variance += one[(i, j)] * other[(i, j)] * covariance[(first + m, first + n)];
                }
            }
            f64::max(variance, 0.0).sqrt()
        })
    })
}

/// The level of each function's noise, by its residuals.
fn of_residuals(
    problem: &Problem,
    unknowns: &Unknowns,
    rms: &Deviations,
) -> Result<Deviations, SpatialError> {
    let lines = problem.frequency_hz.len() as f64;
    // each function's share of the unknowns is spent
    let spent = problem.joint_count() as f64 / (2 * problem.observed.len()) as f64;
    let freedom = (lines - spent).max(1.0);
    let squares = squares(problem, unknowns)?;
    let levels = squares.iter().zip(rms);
    Ok(levels
        .map(|([residual, _], rms)| (residual / freedom).sqrt().max(LEAST_LEVEL * rms))
        .collect())
}

/// Σ |measured − computed|² and Σ |computed|² of each function.
fn squares(problem: &Problem, unknowns: &Unknowns) -> Result<Vec<[f64; 2]>, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let mut sums = vec![[0.0; 2]; problem.observed.len()];
    for line in 0..problem.frequency_hz.len() {
        let functions = assembled.functions(line)?;
        for ((sum, one), function) in sums.iter_mut().zip(&problem.observed).zip(functions) {
            sum[0] += (one.values[line] - function).norm_sqr();
            sum[1] += function.norm_sqr();
        }
    }
    Ok(sums)
}

fn relative_rms(problem: &Problem, unknowns: &Unknowns) -> Result<f64, SpatialError> {
    let squares = squares(problem, unknowns)?;
    let sum: f64 = squares
        .iter()
        .map(|[residual, computed]| residual / computed)
        .sum();
    Ok((sum / squares.len().max(1) as f64).sqrt())
}
