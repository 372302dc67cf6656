//! The estimate: searches from several starts, the level of the noise, the covariance, and what speaks against the result.

use bolted_joint_space::{Part, semidefinite};
use bolted_joint_virtual_point::Place;
use nalgebra::{DMatrix, DVector, Matrix6};

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::fit::{Fit, covariance};
use crate::normal::{Deviations, Normal, cost, squares_of_errors};
use crate::passive::{is_passive, nearest};
use crate::problem::{Level, Problem, Unknowns};
use crate::starts::starts;
use crate::study::SpatialStudy;
use crate::together::{LINES_MAX, together};

/// Rounds in which the level of the noise follows the residuals.
const ROUNDS: usize = 5;

/// Level of a function whose residual is nothing, in parts of its r.m.s.: rounding.
const LEAST_LEVEL: f64 = 1e-12;

/// Likewise where errors of the set-up are estimated: nobody measures better, and beside less the budget would be lost.
const LEAST_MEASURED: f64 = 1e-4;

/// Squares of the errors of the set-up over those of the budget beyond which it does not hold.
const BEYOND_BUDGET: f64 = 2.0;

/// Lines that are searched from several starts; all are used from where these lead.
const SEARCHED: usize = 60;

/// Noise with which the errors of the set-up are searched where none is stated, in parts of the functions' r.m.s.
const NOISE: f64 = 0.01;

/// Information on an error of the set-up that is known, in parts of what there is.
const KNOWN: f64 = 1e9;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-6;

/// 97.5 % quantile of the normal distribution.
pub(crate) const QUANTILE: f64 = 1.959_963_984_540_054;

/// χ² over degrees of freedom beyond which stated noise does not explain the residuals.
const MISFIT: f64 = 1.5;

/// Residual over computed functions, r.m.s., beyond which the model is not that of the data.
const RESIDUAL_MAX: f64 = 0.5;

/// Negative eigenvalues of a scaled matrix that noise does not excuse.
const NOT_PASSIVE: f64 = 1e-9;

/// One number of the joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its name in the model's axes, such as `k_x` or `c_x_ry`.
    pub name: String,
    /// SI units, of a passive joint.
    pub value: f64,
    /// Without that constraint.
    pub free: f64,
    /// Standard deviation, with the errors of the set-up.
    pub deviation: f64,
    /// That of noise alone.
    pub deviation_by_noise: f64,
    /// Whether the functions determine it: its deviation is smaller than what couples its motions at most.
    pub is_determined: bool,
}

impl Unknown {
    /// Interval of 95 %, about the free estimate and with the passive one in it.
    #[must_use]
    pub fn interval_95(&self) -> [f64; 2] {
        let [low, high] = [-1.0, 1.0].map(|sign| self.free + sign * QUANTILE * self.deviation);
        [low.min(self.value), high.max(self.value)]
    }
}

/// What one kind of errors of the set-up adds.
#[derive(Clone, Debug)]
pub struct Group {
    /// `sensors of a` and so on.
    pub name: String,
    /// Standard deviations of the entries of K and of C that it makes by itself.
    pub deviations: [Matrix6<f64>; 2],
    /// Largest part of an unknown's variance that is its.
    pub largest_share: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct SpatialIdentification {
    /// The unknowns of stiffness, then those of damping.
    pub unknowns: Vec<Unknown>,
    /// K, N/m, N/rad, N·m/rad.
    pub stiffness: Matrix6<f64>,
    /// C, in the units of K times s.
    pub damping: Matrix6<f64>,
    /// K and C without the constraint that the joint be passive, where that is another estimate.
    pub free: Option<[Matrix6<f64>; 2]>,
    /// Standard deviations of the entries of K and of C.
    pub deviations: [Matrix6<f64>; 2],
    /// Those of noise alone.
    pub deviations_by_noise: [Matrix6<f64>; 2],
    /// Correlation of the unknowns.
    pub correlation: DMatrix<f64>,
    /// Root mean square of |measured − computed|/|computed|'s r.m.s. of each function.
    pub relative_rms: f64,
    /// Functions of the assembly and lines that were compared.
    pub functions: usize,
    /// Lines.
    pub lines: usize,
    /// χ² over degrees of freedom where the noise is stated.
    pub reduced_chi_squared: Option<f64>,
    /// Squares of the errors of the set-up that were found, over those of the budget; `None` without errors.
    pub budget_used: Option<f64>,
    /// Starts of the search, and how many came to the same minimum.
    pub starts: [usize; 2],
    /// What errors of the set-up add to the deviations: of sensors and of impacts of each side, where they take part.
    pub groups: Vec<Group>,
    /// Why the result is not to be relied on.
    pub reasons_against: Vec<String>,
}

impl SpatialStudy {
    /// The joint.
    ///
    /// # Errors
    /// [`SpatialError`] where the functions do not determine one.
    pub fn identify(&self) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        if 2 * functions * lines <= problem.joint_count() {
            return Err(SpatialError::TooFewFunctions {
                found: functions,
                lines,
                unknowns: problem.joint_count(),
            });
        }
        let rms: Deviations = problem
            .observed
            .iter()
            .map(|one| root_mean_square(one.values.iter().map(|value| value.norm_sqr())))
            .collect();
        let mut level: Deviations = match (self.level, problem.error_count()) {
            (Level::Relative(part), _) => rms.iter().map(|rms| part * rms).collect(),
            (Level::OfResiduals, 0) => rms.clone(),
            (Level::OfResiduals, _) => rms.iter().map(|rms| NOISE * rms).collect(),
        };
        let (mut best, tried, agreeing) = match problem.error_count() {
            0 => {
                let (found, tried, agreeing) = searched(&problem.thinned(SEARCHED), &level)?;
                (Fit::from(problem, found.unknowns, &level)?, tried, agreeing)
            }
            _ => together(problem, &level, matches!(self.level, Level::Relative(_)))?,
        };
        let estimated = match problem.error_count() {
            0 => problem.clone(),
            _ => problem.thinned(LINES_MAX),
        };
        if let Level::OfResiduals = self.level {
            for _ in 0..ROUNDS {
                level = of_residuals(problem, &best.unknowns, &rms)?;
                best = Fit::from(&estimated, best.unknowns, &level)?;
            }
        }
        self.result(&estimated, &best, &level, [tried, agreeing])
    }

    fn result(
        &self,
        estimated: &Problem,
        best: &Fit,
        level: &Deviations,
        starts: [usize; 2],
    ) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let count = problem.joint_count();
        let errors = problem.error_count();
        let normal = Normal::of(estimated, &best.unknowns, level)?;
        let of_errors = normal.information.view((0, count), (count, errors));
        let all = covariance(&normal.information).ok_or(SpatialError::NotDetermined)?;
        // all lines, with the errors of the set-up as they were found
        let exact = problem.displaced(&best.unknowns)?;
        let start = Unknowns(best.unknowns.0.rows(0, count).into_owned());
        let refined = match problem.frequency_hz.len() > estimated.frequency_hz.len() {
            true => Fit::from(&exact, start, level)?.unknowns,
            false => start,
        };
        let alone = Normal::of(&exact, &refined, level)?;
        let by_noise = covariance(&alone.information).ok_or(SpatialError::NotDetermined)?;
        // θ follows η by −F_θθ⁻¹ F_θη
        let follows = {
            let own = normal.information.view((0, 0), (count, count)).into_owned();
            covariance(&own).ok_or(SpatialError::NotDetermined)? * of_errors
        };
        let with = |all: &DMatrix<f64>| {
            let moved = &follows * all.view((count, count), (errors, errors));
            &by_noise + moved * follows.transpose()
        };
        let joint = with(&all);
        let mut at = best.unknowns.clone();
        at.0.rows_mut(0, count).copy_from(&refined.0);
        let model = &problem.model;
        let free = refined.0.clone();
        let passive = match is_passive(model, &free) {
            true => free.clone(),
            false => {
                let information = covariance(&joint).ok_or(SpatialError::NotDetermined)?;
                nearest(model, &free, &information, problem.length_m)
                    .unwrap_or_else(|| free.clone())
            }
        };
        let matrices = |unknowns: &DVector<f64>| problem.matrices(&Unknowns(unknowns.clone()));
        let [stiffness, damping] = matrices(&passive)?;
        let entries = |covariance: &DMatrix<f64>| -> [Matrix6<f64>; 2] {
            [0, 1].map(|part| {
                let first = part * model.count();
                Matrix6::from_fn(|i, j| {
                    let bases = model.bases();
                    let mut variance = 0.0;
                    for (m, one) in bases.iter().enumerate() {
                        for (n, other) in bases.iter().enumerate() {
                            variance +=
                                one[(i, j)] * other[(i, j)] * covariance[(first + m, first + n)];
                        }
                    }
                    f64::max(variance, 0.0).sqrt()
                })
            })
        };
        let deviations = entries(&joint);
        let names = [Part::Stiffness, Part::Damping].map(|part| model.names(part));
        let unknowns: Vec<Unknown> = names
            .concat()
            .into_iter()
            .enumerate()
            .map(|(n, name)| {
                let entry = model.entries()[n % model.count()];
                let matrix = if n < model.count() {
                    &stiffness
                } else {
                    &damping
                };
                let [own, other] =
                    [entry.row, entry.column].map(|dof| matrix[(dof as usize, dof as usize)]);
                let deviation = joint[(n, n)].sqrt();
                Unknown {
                    name,
                    value: passive[n],
                    free: free[n],
                    deviation,
                    deviation_by_noise: by_noise[(n, n)].sqrt(),
                    is_determined: QUANTILE * deviation < (own * other).abs().sqrt(),
                }
            })
            .collect();
        let correlation = DMatrix::from_fn(count, count, |i, j| {
            joint[(i, j)] / (joint[(i, i)] * joint[(j, j)]).sqrt()
        });
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        let groups = self
            .groups()
            .into_iter()
            .map(|(name, columns)| {
                // what is known of it no longer adds
                let mut known = normal.information.clone();
                for column in columns {
                    let place = count + column;
                    known[(place, place)] += KNOWN * known[(place, place)];
                }
                let without = covariance(&known).map_or_else(|| joint.clone(), |all| with(&all));
                let own = &joint - without;
                let share = |n: usize| own[(n, n)] / joint[(n, n)];
                Group {
                    name,
                    deviations: entries(&own),
                    largest_share: (0..count).map(share).fold(0.0, f64::max),
                }
            })
            .collect();
        let squares = cost(problem, &at, level)?;
        let freedom = (2 * functions * lines - count) as f64;
        let reduced_chi_squared =
            matches!(self.level, Level::Relative(_)).then_some(squares / freedom);
        let mut found = SpatialIdentification {
            unknowns,
            stiffness,
            damping,
            free: match passive == free {
                true => None,
                false => Some(matrices(&free)?),
            },
            deviations,
            deviations_by_noise: entries(&by_noise),
            correlation,
            relative_rms: relative_rms(problem, &at)?,
            functions,
            lines,
            reduced_chi_squared,
            budget_used: (errors > 0)
                .then(|| squares_of_errors(problem, &best.unknowns) / errors as f64),
            starts,
            groups,
            reasons_against: Vec::new(),
        };
        found.reasons_against = found.reasons(best.has_converged);
        Ok(found)
    }

    /// Sensors and impacts of each side, with the places of their errors.
    fn groups(&self) -> Vec<(String, Vec<usize>)> {
        if self.problem.tolerances.is_none() {
            return Vec::new();
        }
        let sides = self.names.iter().zip(&self.problem.sides);
        let kinds = sides.flat_map(|(name, side)| {
            let parameters = side.parameters().into_iter();
            parameters.map(move |parameter| match parameter.place {
                Place::Sensor(_) | Place::Channel(_) => format!("sensors of {name}"),
                Place::Impact(_) => format!("impacts of {name}"),
            })
        });
        let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
        for (place, kind) in kinds.enumerate() {
            match groups.iter_mut().find(|(name, _)| *name == kind) {
                Some((_, places)) => places.push(place),
                None => groups.push((kind, vec![place])),
            }
        }
        groups
    }
}

impl SpatialIdentification {
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
        if let Some(used) = self.budget_used.filter(|&used| used > BEYOND_BUDGET) {
            reasons.push(format!(
                "the errors of the set-up would be {:.1} times as large as the budget says: check positions, directions, signs and gains \
                 of sensors and impacts, or state larger ones in budget",
                used.sqrt()
            ));
        }
        if let Some(chi) = self.reduced_chi_squared.filter(|&chi| chi > MISFIT) {
            reasons.push(format!(
                "χ² over degrees of freedom is {chi:.2}: the stated noise does not explain the residuals, and the deviations are too small"
            ));
        }
        for (name, matrix) in [("stiffness", &self.stiffness), ("damping", &self.damping)] {
            if let Err(refused) = semidefinite(matrix)
                && !is_excused(matrix)
            {
                reasons.push(format!("joint.{name} is not passive: {refused}"));
            }
        }
        reasons
    }
}

/// Whether a negative eigenvalue is rounding.
fn is_excused(matrix: &Matrix6<f64>) -> bool {
    let scale = matrix.diagonal().map(|own| own.abs().sqrt());
    let scaled = Matrix6::from_fn(|i, j| {
        let size = scale[i] * scale[j];
        if size > 0.0 {
            matrix[(i, j)] / size
        } else {
            0.0
        }
    });
    scaled.symmetric_eigenvalues().min() > -NOT_PASSIVE
}

/// The lowest of the searches, how many starts were tried and how many came as low. When a second one has, the others are not
/// tried.
fn searched(problem: &Problem, level: &Deviations) -> Result<(Fit, usize, usize), SpatialError> {
    let slack = 2.0 * (problem.observed.len() * problem.frequency_hz.len()) as f64;
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing) = (0, 0);
    for start in starts(problem)? {
        tried += 1;
        let Ok(fit) = Fit::from(problem, start, level) else {
            continue;
        };
        let lowest = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        let as_low = AS_LOW * (lowest.min(fit.cost) + slack);
        agreeing = match fit.cost - lowest {
            above if above > as_low => agreeing,
            above if above >= -as_low => agreeing + 1,
            _ => 1,
        };
        if fit.cost < lowest {
            best = Some(fit);
        }
        if agreeing > 1 {
            break;
        }
    }
    Ok((best.ok_or(SpatialError::NoStart)?, tried, agreeing))
}

/// The level of each function's noise, by its residuals.
fn of_residuals(
    problem: &Problem,
    unknowns: &Unknowns,
    rms: &Deviations,
) -> Result<Deviations, SpatialError> {
    let squares = squares(problem, unknowns)?;
    // each function's share of the unknowns is spent
    let lines = problem.frequency_hz.len() as f64;
    let spent = problem.joint_count() as f64 / (2 * problem.observed.len()) as f64;
    let freedom = (lines - spent).max(1.0);
    let least = match problem.error_count() {
        0 => LEAST_LEVEL,
        _ => LEAST_MEASURED,
    };
    let levels = squares.iter().zip(rms);
    Ok(levels
        .map(|([residual, _], rms)| (residual / freedom).sqrt().max(least * rms))
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
    let parts = squares
        .iter()
        .map(|[residual, computed]| residual / computed);
    Ok(root_mean_square(parts))
}

fn root_mean_square(squares: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = squares.len().max(1) as f64;
    (squares.sum::<f64>() / count).sqrt()
}
