//! The estimate: search, level of the noise, the joint alone with all lines, and what all errors together do to it.

use bolted_joint_space::{Entry, Part};
use bolted_joint_virtual_point::Place;
use nalgebra::{DMatrix, DVector, Matrix6};

use crate::error::SpatialError;
use crate::fit::{Fit, covariance};
use crate::fits::strongest;
use crate::identification::{Group, QUANTILE, SpatialIdentification, Substructures, Unknown};
use crate::level::{of_residuals, relative_rms, root_mean_square};
use crate::marginal::Refined;
use crate::normal::{Deviations, Normal, cost, squares_of_errors};
use crate::passive::{is_passive, nearest};
use crate::problem::{Level, Problem, Unknowns};
use crate::search::{SEARCHED, searched};
use crate::starts::starts;
use crate::study::SpatialStudy;
use crate::together::{LINES_MAX, together};

/// Rounds in which the level of the noise follows the residuals.
const ROUNDS: usize = 5;

/// Noise with which the errors of the set-up are searched where none is stated, in parts of the functions' r.m.s.
const NOISE: f64 = 0.01;

/// Information on an error of the set-up that is known, in parts of what there is.
const KNOWN: f64 = 1e9;

/// The search's end.
struct Found {
    /// Joint and errors of the set-up, at the lines of `estimated`.
    best: Fit,
    estimated: Problem,
    level: Deviations,
    /// The joint alone, with the errors as they were found, at all lines.
    joint: Refined,
    /// Starts that were tried, and that agree.
    starts: [usize; 2],
}

impl SpatialStudy {
    /// The joint.
    ///
    /// # Errors
    /// [`SpatialError`] where the functions do not determine one.
    pub fn identify(&self) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let (functions, lines) = (problem.observed.len(), problem.frequency_hz.len());
        if problem.numbers() <= problem.joint_count() {
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
        let found = match self.level {
            Level::Relative(part) if self.noise != [0.0; 2] => self.beside_noise(&rms, part)?,
            _ => self.beside_exact(&rms)?,
        };
        self.result(&found)
    }

    /// Where the substructures' functions are exact.
    fn beside_exact(&self, rms: &Deviations) -> Result<Found, SpatialError> {
        let problem = &self.problem;
        let errors = problem.error_count();
        let mut level: Deviations = match (self.level, errors) {
            (Level::Relative(part), _) => parts(rms, part),
            (Level::OfResiduals, 0) => rms.clone(),
            (Level::OfResiduals, _) => parts(rms, NOISE),
        };
        let (mut best, tried, agreeing) = match errors {
            0 => {
                let (found, tried, agreeing) = searched(&problem.thinned(SEARCHED), &level)?;
                (Fit::from(problem, found.unknowns, &level)?, tried, agreeing)
            }
            _ => together(problem, &level, matches!(self.level, Level::Relative(_)))?,
        };
        let estimated = match errors {
            0 => problem.clone(),
            _ => problem.thinned(LINES_MAX),
        };
        if let Level::OfResiduals = self.level {
            for _ in 0..ROUNDS {
                level = of_residuals(problem, &best.unknowns, rms)?;
                best = Fit::from(&estimated, best.unknowns, &level)?;
            }
        }
        // all lines, with the errors of the set-up as they were found
        let exact = problem.displaced(&best.unknowns)?;
        let start = joint_of(problem, &best.unknowns);
        let unknowns = match problem.frequency_hz.len() > estimated.frequency_hz.len() {
            true => Fit::from(&exact, start, &level)?.unknowns,
            false => start,
        };
        let normal = Normal::of(&exact, &unknowns, &level)?;
        let at = with_joint(&best.unknowns, &unknowns);
        Ok(Found {
            joint: Refined {
                covariance: covariance(&normal.information).ok_or(SpatialError::NotDetermined)?,
                squares: cost(problem, &at, &level)?,
                kept: (0..problem.frequency_hz.len()).collect(),
                moved: 0.0,
                has_converged: best.has_converged,
                unknowns,
            },
            best,
            estimated,
            level,
            starts: [tried, agreeing],
        })
    }

    /// Where the substructures' functions have noise.
    fn beside_noise(&self, rms: &Deviations, part: f64) -> Result<Found, SpatialError> {
        let problem = &self.problem;
        let level = parts(rms, part);
        let [a, b] = self.noise;
        // as if their noise moved the assembly's functions as much
        let all = parts(rms, (part * part + a * a + b * b).sqrt());
        if problem.error_count() == 0 {
            let smoothed = problem.smoothed()?;
            let first = starts(&smoothed.thinned(SEARCHED))?.into_iter().next();
            let first = first.ok_or(SpatialError::NoStart)?;
            // the lines at which noise moves least, as far as the joint is known
            let mut few = smoothed.with_lines(&problem.steadiest(&first, &level, self.noise)?);
            let (mut best, tried, agreeing) = searched(&few, &all)?;
            for _ in 0..ROUNDS {
                let lines = problem.steadiest(&best.unknowns, &level, self.noise)?;
                few = smoothed.with_lines(&lines);
                best = Fit::from(&few, best.unknowns, &all)?;
            }
            let joint = problem.refined(best.unknowns.clone(), &level, self.noise)?;
            return Ok(Found {
                best,
                estimated: few,
                level: all,
                joint,
                starts: [tried, agreeing],
            });
        }
        let (best, tried, agreeing) = together(problem, &all, true)?;
        let exact = problem.displaced(&best.unknowns)?;
        let joint = exact.refined(joint_of(problem, &best.unknowns), &level, self.noise)?;
        // the errors once more, at the lines that count and with the noise that was found there
        let estimated = problem.with_lines(&joint.kept).thinned(LINES_MAX);
        let level_there = parts(rms, part.hypot(joint.moved));
        let start = with_joint(&best.unknowns, &joint.unknowns);
        let best = Fit::from(&estimated, start, &level_there)?;
        let exact = problem.displaced(&best.unknowns)?;
        let mut joint = exact.refined(joint.unknowns, &level, self.noise)?;
        joint.squares += squares_of_errors(problem, &best.unknowns);
        Ok(Found {
            best,
            estimated,
            level: level_there,
            joint,
            starts: [tried, agreeing],
        })
    }

    fn result(&self, found: &Found) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let model = &problem.model;
        let count = problem.joint_count();
        let errors = problem.error_count();
        let Found {
            best,
            estimated,
            level,
            joint: alone,
            starts,
        } = found;
        let spread = Spread::of(estimated, best, level, &alone.covariance)?;
        let joint = spread.joint(&spread.all);
        let at = with_joint(&best.unknowns, &alone.unknowns);
        let free = alone.unknowns.0.clone();
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
        let entries = |covariance: &DMatrix<f64>| covariances(problem, covariance).map(deviations);
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
                    deviation_by_noise: alone.covariance[(n, n)].sqrt(),
                    is_determined: QUANTILE * deviation < (own * other).abs().sqrt(),
                }
            })
            .collect();
        let correlation = DMatrix::from_fn(count, count, |i, j| {
            joint[(i, j)] / (joint[(i, i)] * joint[(j, j)]).sqrt()
        });
        let groups = self
            .groups()
            .into_iter()
            .map(|(name, columns)| {
                // what is known of it no longer adds
                let without = spread.without(&columns).unwrap_or_else(|| joint.clone());
                let own = &joint - without;
                let share = |n: usize| own[(n, n)] / joint[(n, n)];
                Group {
                    name,
                    deviations: entries(&own),
                    largest_share: (0..count).map(share).fold(0.0, f64::max),
                }
            })
            .collect();
        let lines = alone.kept.len();
        let compared = problem.with_lines(&alone.kept);
        let freedom = (compared.numbers() - count) as f64;
        let reduced_chi_squared =
            matches!(self.level, Level::Relative(_)).then_some(alone.squares / freedom);
        let left_out = problem.frequency_hz.len() - lines;
        let mut result = SpatialIdentification {
            unknowns,
            stiffness,
            damping,
            free: match passive == free {
                true => None,
                false => Some(matrices(&free)?),
            },
            deviations: entries(&joint),
            deviations_by_noise: entries(&alone.covariance),
            covariances: covariances(problem, &joint),
            correlation,
            relative_rms: relative_rms(&compared, &at)?,
            functions: problem.observed.len(),
            lines,
            substructures: (self.noise != [0.0; 2]).then_some(Substructures {
                lines_left_out: left_out,
                moves: alone.moved,
            }),
            frequency_hz: problem.frequency_hz.clone(),
            fits: strongest(problem, &at, &alone.kept)?,
            reduced_chi_squared,
            budget_used: (errors > 0)
                .then(|| squares_of_errors(problem, &best.unknowns) / errors as f64),
            starts: *starts,
            groups,
            errors: self.errors(&best.unknowns, &spread.all),
            reasons_against: Vec::new(),
        };
        result.reasons_against = result.reasons(best.has_converged && alone.has_converged);
        Ok(result)
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

/// How noise and the errors of the set-up spread the joint.
struct Spread<'s> {
    /// Of joint and errors, at the lines of the search.
    information: DMatrix<f64>,
    /// Its inverse.
    all: DMatrix<f64>,
    /// θ follows η by −F_θθ⁻¹ F_θη.
    follows: DMatrix<f64>,
    by_noise: &'s DMatrix<f64>,
}

impl<'s> Spread<'s> {
    fn of(
        problem: &Problem,
        best: &Fit,
        level: &Deviations,
        by_noise: &'s DMatrix<f64>,
    ) -> Result<Self, SpatialError> {
        let (count, errors) = (problem.joint_count(), problem.error_count());
        if errors == 0 {
            return Ok(Self {
                information: DMatrix::zeros(0, 0),
                all: by_noise.clone(),
                follows: DMatrix::zeros(count, 0),
                by_noise,
            });
        }
        let information = Normal::of(problem, &best.unknowns, level)?.information;
        let own = information.view((0, 0), (count, count)).into_owned();
        let of_errors = information.view((0, count), (count, errors));
        Ok(Self {
            all: covariance(&information).ok_or(SpatialError::NotDetermined)?,
            follows: covariance(&own).ok_or(SpatialError::NotDetermined)? * of_errors,
            information,
            by_noise,
        })
    }

    /// Covariance of the joint, with this one of joint and errors.
    fn joint(&self, all: &DMatrix<f64>) -> DMatrix<f64> {
        let (count, errors) = self.follows.shape();
        let moved = &self.follows * all.view((count, count), (errors, errors));
        self.by_noise + moved * self.follows.transpose()
    }

    /// Likewise if some errors were known.
    fn without(&self, errors: &[usize]) -> Option<DMatrix<f64>> {
        let mut known = self.information.clone();
        for error in errors {
            let place = self.follows.nrows() + error;
            known[(place, place)] += KNOWN * known[(place, place)];
        }
        Some(self.joint(&covariance(&known)?))
    }
}

/// A part of each r.m.s.
fn parts(rms: &Deviations, part: f64) -> Deviations {
    rms.iter().map(|rms| part * rms).collect()
}

/// The joint's unknowns of all.
fn joint_of(problem: &Problem, all: &Unknowns) -> Unknowns {
    Unknowns(all.0.rows(0, problem.joint_count()).into_owned())
}

/// All unknowns, with this joint.
fn with_joint(all: &Unknowns, joint: &Unknowns) -> Unknowns {
    let mut own = all.clone();
    own.0.rows_mut(0, joint.0.len()).copy_from(&joint.0);
    own
}

/// Covariances of the 21 numbers of K and of those of C.
fn covariances(problem: &Problem, covariance: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let bases = problem.model.bases();
    let count = bases.len();
    let by_unknowns = DMatrix::from_fn(21, count, |n, unknown| {
        let Entry { row, column } = Entry::ALL[n];
        bases[unknown][(row.index(), column.index())]
    });
    [0, count].map(|first| {
        let own = covariance.view((first, first), (count, count));
        &by_unknowns * own * by_unknowns.transpose()
    })
}

/// Deviations of a matrix' entries.
fn deviations(covariance: DMatrix<f64>) -> Matrix6<f64> {
    let own = std::array::from_fn(|n| f64::max(covariance[(n, n)], 0.0).sqrt());
    bolted_joint_space::symmetric(&own)
}
