//! What a test will tell of the joints, before it is made: the deviations to be expected of every unknown, which of them it will
//! not determine and why, and what to measure besides.
//!
//! The joint is taken to be the expected one and the set-up to be where it is said to be. There the information of the functions
//! and of the error budget is that of the estimate itself ([theory, section 16a](../../../docs/theory.md)).

pub(crate) mod candidates;
mod reason;
mod trial;
mod worth;

use bolted_joint_wanted::{Pieces, step};
use nalgebra::DVector;

use crate::advice::advice;
use crate::chain::apart::Apart;
use crate::chain::part::Part;
use crate::chain::study::{ChainStudy, sides};
use crate::error::SpatialError;
use crate::links::Links;
use crate::problem::{Level, Problem};
use crate::side::Side;
use candidates::{Candidate, proposed};
pub use reason::Reason;
use trial::Test;

/// Lines at which candidates are compared.
const COMPARED_LINES: usize = 8;

/// What of an expected joint its model may leave out.
const LEFT_OUT: f64 = 1e-3;

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
    /// Lines; without those at which noise of the substructures would move the functions too far.
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

impl ChainStudy {
    /// What the test of this study would tell, and what to add to it: so many sensors or impacts.
    ///
    /// # Errors
    /// [`SpatialError`] where the study does not say enough, or names what there is not.
    pub fn plan(&self, aim: &Aim, additions: usize) -> Result<Plan, SpatialError> {
        let links = &self.problem.links;
        if links.sought().is_empty() {
            return Err(self.all_known().into());
        }
        let Level::Relative(noise) = self.stated else {
            return Err(SpatialError::NoNoise);
        };
        let (values, mut warnings) = self.expected()?;
        let chosen = chosen(links, aim)?;
        let of_test = step("the test as it is", Pieces::Unknown);
        let test = self.test(&self.parts, &values, noise, usize::MAX)?;
        warnings.extend(self.assumed.iter().cloned());
        warnings.extend(self.at_known_joints());
        warnings.extend(advice(&test.problem.sides));
        let (unknowns, apart, lines) = test.unknowns()?;
        let all = test.problem.frequency_hz.len();
        if lines < all {
            warnings.push(format!(
                "noise of the substructures moves the functions too far at {} of {all} lines, which do not take part; candidates are \
                 compared without that noise",
                all - lines
            ));
        }
        let unknown = unknowns.iter().filter(|one| !one.is_determined).count();
        if 2 * unknown > unknowns.len() {
            warnings.push(format!(
                "the test will not determine {unknown} of {} numbers: the estimate will not find the joint, and may end in another minimum",
                unknowns.len()
            ));
        }
        let mut plan = Plan {
            unknowns,
            functions: test.problem.observed.len(),
            lines,
            apart,
            additions: Vec::new(),
            ranking: Vec::new(),
            warnings,
        };
        drop(of_test);
        let mut left = self.candidates()?;
        let mut parts = self.parts.clone();
        // each addition leaves one candidate less for the next
        let counts = (0..additions).map(|taken| left.len().saturating_sub(taken));
        let of_candidates = step("candidates", Pieces::Exactly(counts.sum()));
        for step in 0..additions {
            let compared = |parts: &[Part]| {
                let test = self.test(parts, &values, noise, COMPARED_LINES)?;
                test.worth(&chosen, self.lines())
            };
            let now = compared(&parts)?;
            let mut ranked = Vec::new();
            for (n, candidate) in left.iter().enumerate() {
                let Some(with) = candidate.added(&parts) else {
                    of_candidates.done();
                    continue;
                };
                let then = compared(&with)?;
                of_candidates.done();
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
