//! What a test will tell of the joints, before it is made: the deviations to be expected of every unknown, which of them it will
//! not determine and why, and what to measure besides.
//!
//! The joint is taken to be the expected one and the set-up to be where it is said to be. There the information of the functions
//! and of the error budget is that of the estimate itself ([theory, section 16a](../../../docs/theory.md)).

pub(crate) mod candidates;
mod reason;

use nalgebra::{DMatrix, DVector};

use crate::assembled::Assembled;
use crate::chain::apart::{Apart, apart};
use crate::chain::part::Part;
use crate::chain::study::{ChainStudy, sides};
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::links::{Links, is_determined};
use crate::normal::{Deviations, Normal};
use crate::problem::Level;
use crate::problem::{Observed, Problem, Unknowns};
use crate::side::{Interface, MOTIONS, Side};
use crate::spread::Spread;
use crate::together::LINES_MAX;
use candidates::{Candidate, proposed};
pub use reason::Reason;
use reason::Seen;

/// Deviations, in parts of what couples the motions at most, of what no function tells: large beside all that is determined, and
/// small enough for the numbers to be inverted.
const OPEN: f64 = 100.0;

/// The same where candidates are compared: nothing is known of a number but its size.
const BEFORE: f64 = 1.0;

/// Lines at which candidates are compared.
const COMPARED_LINES: usize = 8;

/// What of an expected joint its model may leave out.
const LEFT_OUT: f64 = 1e-3;

/// Others that are named as looking like a number.
const MOST_ALIKE: usize = 3;

/// One number of a joint.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The joint's table in the study.
    pub joint: String,
    /// Its name in the model's axes, such as `k_x` or `c_x_ry`.
    pub name: String,
    /// What it is taken to be, SI units.
    pub value: f64,
    /// What couples its motions at most, √(k_ii k_jj).
    pub size: f64,
    /// Standard deviation to be expected, with the errors of the set-up.
    pub deviation: f64,
    /// That of noise alone.
    pub deviation_by_noise: f64,
    /// Whether the test determines it.
    pub is_determined: bool,
    /// Why it does not.
    pub reason: Option<Reason>,
    /// The largest part of its variance that one kind of errors of the set-up has, and which.
    pub largest_group: Option<(String, f64)>,
}

/// What is worth most.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// All numbers: ln det(I + J P Jᵀ).
    All,
    /// The sum of the relative variances of some of them.
    Numbers(Vec<String>),
}

/// A sensor or an impact that could be added.
#[derive(Clone, Debug)]
pub struct Addition {
    /// Where it would be.
    pub what: String,
    /// ln det(I + J P Jᵀ), or what the sum of relative variances falls by, in parts of it.
    pub gain: f64,
}

/// What is to be expected of a test.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The unknowns of each joint that is sought: stiffness, then damping.
    pub unknowns: Vec<Planned>,
    /// Functions of the assembly that would be measured.
    pub functions: usize,
    /// Lines.
    pub lines: usize,
    /// Whether joints are told apart, where several are sought.
    pub apart: Vec<Apart>,
    /// What to add next, one after the other.
    pub additions: Vec<Addition>,
    /// All that could be added first, the best ones first.
    pub ranking: Vec<Addition>,
    /// What should be looked at.
    pub warnings: Vec<String>,
}

/// A test as it would be.
struct Test {
    problem: Problem,
    truth: Unknowns,
    level: Deviations,
    /// Row and column of every function, also of those that are zero.
    places: Vec<[usize; 2]>,
}

impl ChainStudy {
    /// What the test of this study would tell, and what to add to it: so many sensors or impacts.
    ///
    /// # Errors
    /// [`SpatialError`] where the study does not say enough, or names what there is not.
    pub fn plan(&self, aim: &Aim, additions: usize) -> Result<Plan, SpatialError> {
        let links = &self.problem.links;
        if links.sought().is_empty() {
            return Err(SpatialError::AllKnown);
        }
        let Level::Relative(noise) = self.level else {
            return Err(SpatialError::NoNoise);
        };
        let (values, mut warnings) = self.expected()?;
        let chosen = chosen(links, aim)?;
        let test = self.test(&self.parts, &values, noise, usize::MAX)?;
        warnings.extend(advice(&test.problem));
        let (unknowns, apart) = test.unknowns()?;
        let mut plan = Plan {
            unknowns,
            functions: test.problem.observed.len(),
            lines: test.problem.frequency_hz.len(),
            apart,
            additions: Vec::new(),
            ranking: Vec::new(),
            warnings,
        };
        let mut left = self.candidates()?;
        let mut parts = self.parts.clone();
        for step in 0..additions {
            let compared = |parts: &[Part]| {
                let test = self.test(parts, &values, noise, COMPARED_LINES)?;
                test.worth(&chosen, self.lines())
            };
            let now = compared(&parts)?;
            let mut ranked = Vec::new();
            for (n, candidate) in left.iter().enumerate() {
                let Some(with) = candidate.added(&parts) else {
                    continue;
                };
                let then = compared(&with)?;
                let gain = match chosen.is_empty() {
                    true => then - now,
                    // of a sum of variances, with the other sign
                    false => 1.0 - then / now,
                };
                ranked.push((
                    n,
                    Addition {
                        what: candidate.to_string(),
                        gain,
                    },
                    with,
                ));
            }
            ranked.sort_by(|(_, one, _), (_, other, _)| other.gain.total_cmp(&one.gain));
            if step == 0 {
                plan.ranking = ranked
                    .iter()
                    .map(|(_, addition, _)| addition.clone())
                    .collect();
            }
            let Some((n, addition, with)) = ranked.into_iter().next() else {
                break;
            };
            plan.additions.push(addition);
            left.remove(n);
            parts = with;
        }
        Ok(plan)
    }

    fn lines(&self) -> usize {
        self.problem.frequency_hz.len()
    }

    /// The unknowns of the expected joints, and what the models leave out of them.
    fn expected(&self) -> Result<(DVector<f64>, Vec<String>), SpatialError> {
        let links = &self.problem.links;
        let mut matrices = Vec::new();
        for (key, expected) in &self.expected {
            matrices
                .push(expected.ok_or_else(|| SpatialError::NotExpected { joint: key.clone() })?);
        }
        let mut warnings = Vec::new();
        for (joint, own) in links.sought().iter().zip(&matrices) {
            for (what, matrix) in ["stiffness", "damping"].iter().zip(own) {
                let nearest = joint.model.nearest(matrix, joint.link.length_m)?;
                if nearest.left_out_share > LEFT_OUT {
                    warnings.push(format!(
                        "{}: the model holds all but {:.2} % of the expected {what}; the plan is for what it holds",
                        joint.link.key,
                        100.0 * nearest.left_out_share
                    ));
                }
            }
        }
        let values = links.nearest(&matrices)?;
        let sizes = links.sizes(values.as_slice())?;
        for joint in links.sought() {
            let names = joint.names();
            for (n, name) in names.into_iter().enumerate() {
                if sizes[joint.first + n] <= 0.0 {
                    return Err(SpatialError::NothingExpected {
                        joint: joint.link.key.clone(),
                        name,
                    });
                }
            }
        }
        Ok((values, warnings))
    }

    fn candidates(&self) -> Result<Vec<Candidate>, SpatialError> {
        if let Some(stated) = &self.candidates {
            // one whose functions nobody knows is told by its key
            for candidate in stated {
                if let Some(with) = candidate.added(&self.parts) {
                    let first = &self.problem.frequency_hz[..1];
                    self.sides_of(&with, first)
                        .map_err(|source| SpatialError::Candidate {
                            key: candidate.key.clone().unwrap_or_default(),
                            source: Box::new(source),
                        })?;
                }
            }
            return Ok(stated.clone());
        }
        let parts = &self.parts;
        let links = &self.problem.links;
        // joint j is between part j and the next; a part's first interface is towards the one before
        let length_m = |name: &str| {
            let part = parts
                .iter()
                .position(|part| part.interfaces.iter().any(|own| own.name == name));
            let part = part.unwrap_or_default();
            let is_far = name.ends_with(".far");
            let joint = if is_far || part == 0 { part } else { part - 1 };
            links.0.get(joint).map_or(0.0, |link| link.length_m)
        };
        proposed(parts, &length_m).map_err(|source| SpatialError::Interface {
            name: "candidates".to_owned(),
            source,
        })
    }

    fn sides_of(&self, parts: &[Part], frequency_hz: &[f64]) -> Result<[Side; 2], SpatialError> {
        sides(&self.text, parts, frequency_hz).map_err(SpatialError::from)
    }

    /// A test on these parts, at all lines or, to compare it with others, at some.
    fn test(
        &self,
        parts: &[Part],
        values: &DVector<f64>,
        noise: f64,
        lines: usize,
    ) -> Result<Test, SpatialError> {
        let problem = self.problem.thinned(lines);
        let sides = self.sides_of(parts, &problem.frequency_hz)?;
        Test::of(self, Problem { sides, ..problem }, values, noise)
    }
}

impl Test {
    /// What would be measured: every function between sensors and impacts, and what else is named.
    fn of(
        study: &ChainStudy,
        mut problem: Problem,
        values: &DVector<f64>,
        noise: f64,
    ) -> Result<Self, SpatialError> {
        problem.observed = observed(&problem.sides, &study.planned)?;
        let mut truth = DVector::zeros(problem.count());
        truth.rows_mut(0, values.len()).copy_from(values);
        let truth = Unknowns(truth);
        let computed = {
            let assembled = Assembled::new(&problem, &truth)?;
            let lines = 0..problem.frequency_hz.len();
            lines
                .map(|line| Ok(assembled.line(line)?.functions))
                .collect::<Result<Vec<_>, SpatialError>>()?
        };
        for (n, one) in problem.observed.iter_mut().enumerate() {
            one.values = computed.iter().map(|functions| functions[n]).collect();
        }
        let level: Deviations = problem
            .observed
            .iter()
            .map(|one| {
                let squares: f64 = one.values.iter().map(|value| value.norm_sqr()).sum();
                noise * (squares / one.values.len() as f64).sqrt()
            })
            .collect();
        // a function that is nothing tells nothing, though its sensor and its impact are there
        let places = problem.observed.iter().map(|one| one.at).collect();
        let mut told = level.iter();
        problem
            .observed
            .retain(|_| told.next().is_some_and(|&level| level > 0.0));
        let level = level.into_iter().filter(|&level| level > 0.0).collect();
        if problem.observed.is_empty() {
            return Err(SpatialError::NoneOf {
                what: "function that is not zero between sensors and impacts",
            });
        }
        Ok(Self {
            problem,
            truth,
            level,
            places,
        })
    }

    /// 1/(part · size)² of each unknown of the joints.
    fn before(&self, part: f64) -> Result<Vec<f64>, SpatialError> {
        let sizes = self.problem.links.sizes(self.truth.0.as_slice())?;
        Ok(sizes.iter().map(|size| (part * size).powi(-2)).collect())
    }

    fn unknowns(&self) -> Result<(Vec<Planned>, Vec<Apart>), SpatialError> {
        let Self {
            problem,
            truth,
            level,
            ..
        } = self;
        let count = problem.joint_count();
        let sizes = problem.links.sizes(truth.0.as_slice())?;
        let before = self.before(OPEN)?;
        let with_before = |information: &DMatrix<f64>| {
            let mut all = information.clone();
            for (n, own) in before.iter().enumerate() {
                all[(n, n)] += own;
            }
            all
        };
        // as the estimate has it: all lines for the joint, fewer for the errors of the set-up
        let estimated = match problem.error_count() {
            0 => problem.clone(),
            _ => problem.thinned(LINES_MAX),
        };
        let normal = Normal::of(&estimated, truth, level)?;
        let exact = problem.displaced(truth)?;
        let own = Unknowns(truth.0.rows(0, count).into_owned());
        let alone = Normal::of(&exact, &own, level)?;
        let by_noise =
            covariance(&with_before(&alone.information)).ok_or(SpatialError::NotDetermined)?;
        let spread = Spread::of(&estimated, &with_before(&normal.information), by_noise)
            .ok_or(SpatialError::NotDetermined)?;
        let seen = self.seen()?;
        let names: Vec<String> = problem
            .links
            .sought()
            .iter()
            .flat_map(|joint| {
                let many = problem.links.sought().len() > 1;
                let own = joint.names().into_iter();
                own.map(move |name| {
                    if many {
                        format!("{} of {}", name, joint.link.key)
                    } else {
                        name
                    }
                })
            })
            .collect();
        let mut unknowns = Vec::new();
        for joint in problem.links.sought() {
            let half = joint.model.count();
            for (m, name) in joint.names().into_iter().enumerate() {
                let n = joint.first + m;
                let deviation = |all: &DMatrix<f64>| all[(n, n)].max(0.0).sqrt();
                let (of_all, of_noise) = (deviation(&spread.all), deviation(&spread.by_noise));
                let size = sizes[n];
                let groups = spread.groups.iter().map(|(group, added)| {
                    (
                        group.clone(),
                        (added[(n, n)] / spread.all[(n, n)]).clamp(0.0, 1.0),
                    )
                });
                let largest_group = groups.max_by(|(_, one), (_, other)| one.total_cmp(other));
                let is_known = is_determined(of_all, size);
                let reason = (!is_known).then(|| {
                    let alone = alone.information[(n, n)].sqrt().recip();
                    seen[joint.number]
                        .missing(&joint.model.entries()[m % half])
                        .unwrap_or_else(|| match &largest_group {
                            _ if !is_determined(alone, size) => Reason::Faint,
                            Some((group, _)) if is_determined(of_noise, size) => {
                                Reason::SetUp(group.clone())
                            }
                            _ => Reason::Alike(alike(&spread.by_noise, n, &names)),
                        })
                });
                unknowns.push(Planned {
                    joint: joint.link.key.clone(),
                    name,
                    value: truth.0[n],
                    size,
                    deviation: of_all,
                    deviation_by_noise: of_noise,
                    is_determined: is_known,
                    reason,
                    largest_group,
                });
            }
        }
        Ok((unknowns, apart(&exact, &own, level)?))
    }

    /// What the measured functions have to do with each motion of each joint.
    fn seen(&self) -> Result<Vec<Seen>, SpatialError> {
        let problem = &self.problem;
        let assembled = Assembled::new(problem, &self.truth)?;
        let mut sums = [(); 2].map(|()| vec![0.0; problem.motions()]);
        for line in 0..problem.frequency_hz.len() {
            let found = assembled.line(line)?;
            for &[o, i] in &self.places {
                for motion in 0..problem.motions() {
                    sums[0][motion] += found.by_joint_loads[(o, motion)].norm_sqr();
                    sums[1][motion] += found.joint_motions[(motion, i)].norm_sqr();
                }
            }
        }
        let length_m = |joint: usize, dof: usize| match dof {
            0..3 => 1.0,
            _ => problem.links.0[joint].length_m,
        };
        let of = |joint: usize, sums: &[f64]| {
            let own: [f64; MOTIONS] = std::array::from_fn(|dof| {
                sums[MOTIONS * joint + dof].sqrt() * length_m(joint, dof)
            });
            let largest = own.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            own.map(|size| size / largest)
        };
        let joints = 0..problem.links.0.len();
        Ok(joints
            .map(|joint| Seen {
                by_sensors: of(joint, &sums[0]),
                by_impacts: of(joint, &sums[1]),
            })
            .collect())
    }

    /// ln det of the information on the joints, in parts of their sizes, with what is known before; or the sum of the relative
    /// variances of some of the unknowns. With all lines, of which these are some.
    fn worth(&self, chosen: &[usize], lines: usize) -> Result<f64, SpatialError> {
        let problem = &self.problem;
        let (count, errors) = (problem.joint_count(), problem.error_count());
        let mut level = self.level.clone();
        let fewer = problem.frequency_hz.len() as f64 / lines as f64;
        for level in &mut level {
            *level *= fewer.sqrt();
        }
        let mut information = Normal::of(problem, &self.truth, &level)?.information;
        for (n, own) in self.before(BEFORE)?.into_iter().enumerate() {
            information[(n, n)] += own;
        }
        let all = covariance(&information).ok_or(SpatialError::NotDetermined)?;
        let sizes = problem.links.sizes(self.truth.0.as_slice())?;
        if !chosen.is_empty() {
            return Ok(chosen
                .iter()
                .map(|&n| all[(n, n)] / (sizes[n] * sizes[n]))
                .sum());
        }
        // the marginal information on the joints has det F/det F_ηη
        let of_errors = information
            .view((count, count), (errors, errors))
            .into_owned();
        let marginal = log_det(&information).zip(log_det(&of_errors));
        let (whole, of_errors) = marginal.ok_or(SpatialError::NotDetermined)?;
        let of_sizes: f64 = sizes.iter().map(|size| 2.0 * size.ln()).sum();
        Ok(whole - of_errors + of_sizes)
    }
}

/// ln det of a positive definite matrix.
fn log_det(matrix: &DMatrix<f64>) -> Option<f64> {
    let scale = matrix.diagonal().map(|own| own.sqrt().recip());
    let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
        matrix[(i, j)] * scale[i] * scale[j]
    });
    let factor = scaled.cholesky()?;
    let of_factor: f64 = factor
        .l_dirty()
        .diagonal()
        .iter()
        .map(|own| 2.0 * own.ln())
        .sum();
    Some(of_factor - scale.iter().map(|own| 2.0 * own.ln()).sum::<f64>())
}

/// Functions that would be measured.
fn observed(
    sides: &[Side; 2],
    measured: &[Option<Vec<bolted_joint_frf::Dof>>; 2],
) -> Result<Vec<Observed>, SpatialError> {
    let [a, b] = sides;
    // the motions of a node are no sensors
    let is_node = |side: &Side, row: usize, which: usize| {
        side.interfaces.iter().any(|placed| {
            let first = placed.first[which];
            matches!(placed.interface, Interface::Node) && (first..first + MOTIONS).contains(&row)
        })
    };
    let places = |which: usize| -> Result<Vec<usize>, SpatialError> {
        let mut all = Vec::new();
        let mut found = Vec::new();
        for (side, skip) in [
            (a, 0),
            (
                b,
                if which == 0 {
                    a.responses.len()
                } else {
                    a.references.len()
                },
            ),
        ] {
            let dofs = if which == 0 {
                &side.responses
            } else {
                &side.references
            };
            for (n, dof) in dofs.iter().enumerate() {
                let is_asked = measured[which]
                    .as_ref()
                    .is_none_or(|list| list.contains(dof));
                if !is_node(side, n, which) && is_asked {
                    all.push(skip + n);
                    found.push(*dof);
                }
            }
        }
        let what = ["sensors", "impacts"][which];
        let missing = measured[which]
            .iter()
            .flatten()
            .find(|dof| !found.contains(dof));
        if let Some(&dof) = missing {
            return Err(SpatialError::NotThere { what, dof });
        }
        match all.is_empty() {
            true => Err(SpatialError::NoneOf { what }),
            false => Ok(all),
        }
    };
    let (rows, columns) = (places(0)?, places(1)?);
    let pairs = rows
        .iter()
        .flat_map(|&row| columns.iter().map(move |&column| [row, column]));
    Ok(pairs
        .map(|at| Observed {
            at,
            values: Vec::new(),
        })
        .collect())
}

/// The unknowns that an aim names.
fn chosen(links: &Links, aim: &Aim) -> Result<Vec<usize>, SpatialError> {
    let Aim::Numbers(wanted) = aim else {
        return Ok(Vec::new());
    };
    let sought = links.sought();
    let names: Vec<(usize, String)> = sought
        .iter()
        .flat_map(|joint| {
            joint
                .names()
                .into_iter()
                .enumerate()
                .map(|(n, name)| (joint.first + n, name))
        })
        .collect();
    let mut chosen = Vec::new();
    for name in wanted {
        let before = chosen.len();
        chosen.extend(names.iter().filter(|(_, own)| own == name).map(|(n, _)| *n));
        if chosen.len() == before {
            let all: Vec<&str> = names.iter().map(|(_, own)| own.as_str()).collect();
            return Err(SpatialError::NoSuchNumber {
                found: name.clone(),
                expected: all.join(", "),
            });
        }
    }
    Ok(chosen)
}

/// The unknowns that are most correlated with one.
fn alike(covariance: &DMatrix<f64>, n: usize, names: &[String]) -> Vec<String> {
    let correlation =
        |m: usize| (covariance[(n, m)] / (covariance[(n, n)] * covariance[(m, m)]).sqrt()).abs();
    let mut others: Vec<usize> = (0..names.len()).filter(|&m| m != n).collect();
    others.sort_by(|&one, &other| correlation(other).total_cmp(&correlation(one)));
    others.truncate(MOST_ALIKE);
    others.into_iter().map(|m| names[m].clone()).collect()
}

/// What the places of sensors and impacts are warned of.
fn advice(problem: &Problem) -> Vec<String> {
    use bolted_joint_virtual_point::{Role, VirtualPoint, Weights};
    let interfaces = problem.sides.iter().flat_map(|side| &side.interfaces);
    let mut all = Vec::new();
    for placed in interfaces {
        let Interface::Points(set_up) = &placed.interface else {
            continue;
        };
        let Ok(point) = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal) else {
            continue;
        };
        for role in [Role::Channel, Role::Impact] {
            let own = point.conditioning(role).advice();
            all.extend(
                own.iter()
                    .map(|advice| format!("{}: {advice}", placed.name)),
            );
        }
    }
    all
}
