//! A test as it would be: what would be measured, and what that tells of every unknown.

use bolted_joint_frf::Dof;
use nalgebra::{DMatrix, DVector};

use super::Planned;
use super::reason::{Reason, Seen};
use crate::assembled::Assembled;
use crate::chain::apart::{Apart, apart};
use crate::chain::study::ChainStudy;
use crate::error::SpatialError;
use crate::fit::covariance;
use crate::level::sizes;
use crate::links::is_determined;
use crate::normal::{Deviations, Normal};
use crate::part_noise::PartNoise;
use crate::problem::{Observed, Problem, Unknowns};
use crate::side::{Interface, MOTIONS, Side};
use crate::spread::Spread;
use crate::together::LINES_MAX;

/// Deviations, in parts of what couples the motions at most, of what no function tells: large beside all that is determined, and
/// small enough for the numbers to be inverted.
const OPEN: f64 = 100.0;

/// A number below this part of what couples its motions at most is rounding.
const ROUNDING: f64 = 1e-12;

/// Others that are named as looking like a number.
const MOST_ALIKE: usize = 3;

/// A test as it would be.
pub(super) struct Test {
    pub(super) problem: Problem,
    pub(super) truth: Unknowns,
    pub(super) level: Deviations,
    /// Row and column of every function, also of those that are zero.
    places: Vec<[usize; 2]>,
    /// Noise of the substructures.
    noise: [PartNoise; 2],
}

impl Test {
    /// What would be measured: every function between sensors and impacts, and what else is named.
    pub(super) fn of(
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
        let sizes = sizes(&problem).into_iter();
        let level: Deviations = sizes.map(|size| noise * size).collect();
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
            noise: study.noise.clone(),
        })
    }

    /// 1/(part · size)² of each unknown of the joints.
    pub(super) fn before(&self, part: f64) -> Result<Vec<f64>, SpatialError> {
        let sizes = self.problem.links.sizes(self.truth.0.as_slice())?;
        Ok(sizes.iter().map(|size| (part * size).powi(-2)).collect())
    }

    pub(super) fn unknowns(&self) -> Result<(Vec<Planned>, Vec<Apart>, usize), SpatialError> {
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
        let exact = problem.displaced(truth)?;
        let own = Unknowns(truth.0.rows(0, count).into_owned());
        let (normal, alone, lines) = match &self.noise {
            [a, b] if a.is_none() && b.is_none() => (
                Normal::of(&estimated, truth, level)?,
                Normal::of(&exact, &own, level)?,
                problem.frequency_hz.len(),
            ),
            noise => {
                let (alone, lines) = exact.told_beside_noise(&own, level, noise)?;
                let (normal, _) = match problem.error_count() {
                    0 => (Normal::zeros(count), 0),
                    _ => problem.told_beside_noise(truth, level, noise)?,
                };
                (normal, alone, lines)
            }
        };
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
                    value: match truth.0[n] {
                        value if value.abs() <= ROUNDING * size => 0.0,
                        value => value,
                    },
                    size,
                    deviation: of_all,
                    deviation_by_noise: of_noise,
                    is_determined: is_known,
                    reason,
                    largest_group,
                });
            }
        }
        Ok((unknowns, apart(&exact, &own, level)?, lines))
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
}

/// Functions that would be measured.
fn observed(
    sides: &[Side; 2],
    measured: &[Option<Vec<Dof>>; 2],
) -> Result<Vec<Observed>, SpatialError> {
    let [a, b] = sides;
    // the motions of a node are no sensors
    let is_node = |side: &Side, row: usize, which: usize| {
        side.interfaces.iter().any(|placed| {
            let first = placed.first[which];
            match placed.interface {
                Interface::Node(motions) => (first..first + motions.count()).contains(&row),
                Interface::Points(_) => false,
            }
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
    Ok(pairs.map(|at| Observed::new(at, Vec::new())).collect())
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
