//! Damped Gauss–Newton (Levenberg and Marquardt): plain steps diverge from a stiffness 10 % off.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::error::SpatialError;
use crate::normal::{Deviations, Normal, bend, cost};
use crate::problem::{Problem, Unknowns};

/// Steps after which a search has not converged; and those where noise explains what is left, up to this factor: in a narrow valley
/// it creeps to the bottom.
const STEPS_MAX: usize = 150;
const STEPS_IN_A_VALLEY: usize = 600;
const EXPLAINED: f64 = 1.5;

/// A step that lowers the cost by less than this part of it, and this much, was the last one.
const SETTLED: f64 = 1e-8;

/// Likewise, of a search that another one goes on from, and its steps at most.
const NEARLY_SETTLED: f64 = 1e-2;
const NEAR: f64 = 1e-6;
const FEW_STEPS: usize = 8;

/// How far a search goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Effort {
    /// To where another one goes on from.
    Coarse,
    /// To the bottom as far as it matters: a small part of the deviations.
    Near,
    /// To the bottom, unless it creeps far above this cost.
    Promising(f64),
    /// To the bottom.
    Full,
}

/// Steps after which a search may be called creeping, and those over which it lowers the cost by less than half then.
const PATIENCE: usize = 30;
const CREEPING: usize = 10;
/// How far above the cost of a search that is promising.
const FAR_ABOVE: f64 = 10.0;

/// What bends a step, in parts of its length at most: where it is more, the second derivatives do not say enough.
const BENT_MOST: f64 = 0.375;

/// Damping that no step can be helped with.
const DAMPING_MAX: f64 = 1e12;

/// Where a search has come to.
#[derive(Clone)]
pub(crate) struct Fit {
    pub(crate) unknowns: Unknowns,
    pub(crate) cost: f64,
    pub(crate) has_converged: bool,
}

/// What is to be as small as it can be.
pub(crate) trait Squares {
    fn problem(&self) -> &Problem;

    /// Its normal equations at the start, or where a step has led to.
    fn normal(&mut self, unknowns: &Unknowns) -> Result<Normal, SpatialError>;

    /// Its value where a step would lead to.
    fn cost(&mut self, unknowns: &Unknowns) -> Result<f64, SpatialError>;

    /// What bends a step where the functions are far from linear in it, if that is worth while.
    fn bend(&self, _unknowns: &Unknowns, _step: &DVector<f64>) -> Option<DVector<f64>> {
        None
    }
}

/// That of functions of the assembly between substructures that are exact.
struct Exact<'p> {
    problem: &'p Problem,
    deviations: &'p Deviations,
}

impl Squares for Exact<'_> {
    fn problem(&self) -> &Problem {
        self.problem
    }

    fn normal(&mut self, unknowns: &Unknowns) -> Result<Normal, SpatialError> {
        Normal::of(self.problem, unknowns, self.deviations)
    }

    fn cost(&mut self, unknowns: &Unknowns) -> Result<f64, SpatialError> {
        cost(self.problem, unknowns, self.deviations)
    }

    fn bend(&self, unknowns: &Unknowns, step: &DVector<f64>) -> Option<DVector<f64>> {
        // the joint alone is near its bottom after a few straight steps
        let is_narrow = self.problem.error_count() > 0;
        let of = || bend(self.problem, unknowns, step, self.deviations).ok();
        is_narrow.then(of).flatten()
    }
}

impl Fit {
    /// From these unknowns downhill, to the bottom.
    pub(crate) fn from(
        problem: &Problem,
        start: Unknowns,
        deviations: &Deviations,
    ) -> Result<Self, SpatialError> {
        Self::of(problem, start, deviations, Effort::Full)
    }

    /// From here on with other lines or levels. Where this search has not converged, that one has not.
    pub(crate) fn on(
        self,
        problem: &Problem,
        deviations: &Deviations,
    ) -> Result<Self, SpatialError> {
        let mut own = Self::from(problem, self.unknowns, deviations)?;
        own.has_converged &= self.has_converged;
        Ok(own)
    }

    /// From these unknowns downhill.
    pub(crate) fn of(
        problem: &Problem,
        start: Unknowns,
        deviations: &Deviations,
        effort: Effort,
    ) -> Result<Self, SpatialError> {
        let mut exact = Exact {
            problem,
            deviations,
        };
        Self::by(&mut exact, start, effort)
    }

    /// Likewise, by any squares.
    pub(crate) fn by(
        squares: &mut impl Squares,
        start: Unknowns,
        effort: Effort,
    ) -> Result<Self, SpatialError> {
        let (steps_max, settled) = match effort {
            Effort::Coarse => (FEW_STEPS, NEARLY_SETTLED),
            Effort::Near => (STEPS_MAX, NEAR),
            Effort::Full | Effort::Promising(_) => (STEPS_MAX, SETTLED),
        };
        let mut normal = squares.normal(&start)?;
        let mut unknowns = start;
        let trust = Trust::of(squares.problem());
        let mut damping = trust.first();
        let mut costs = Vec::new();
        let explained = EXPLAINED * squares.problem().numbers() as f64;
        loop {
            let most = match effort == Effort::Full && normal.cost < explained {
                true => STEPS_IN_A_VALLEY,
                false => steps_max,
            };
            if costs.len() >= most {
                break;
            }
            costs.push(normal.cost);
            if is_creeping(effort, &costs) {
                return Ok(Self {
                    unknowns,
                    cost: normal.cost,
                    has_converged: false,
                });
            }
            let mut moved = None;
            while damping < DAMPING_MAX {
                if let Some(bounded) = trust.at(squares.problem(), &unknowns, &normal, damping) {
                    moved = tried(squares, &unknowns, &normal, &bounded);
                }
                if moved.is_some() {
                    damping = (0.1 * damping).max(1e-12);
                    break;
                }
                damping *= 10.0;
            }
            let Some((trial, found)) = moved else {
                break;
            };
            let gain = normal.cost - found;
            unknowns = trial;
            if gain <= settled * (1.0 + found) {
                return Ok(Self {
                    unknowns,
                    cost: found,
                    has_converged: true,
                });
            }
            normal = squares.normal(&unknowns)?;
        }
        // no step helps: at the bottom as far as rounding lets it be seen
        let has_converged = damping >= DAMPING_MAX;
        Ok(Self {
            unknowns,
            cost: normal.cost,
            has_converged,
        })
    }
}

/// Whether a search that has been at these costs is not worth while.
fn is_creeping(effort: Effort, costs: &[f64]) -> bool {
    let (Effort::Promising(promised), [.., last]) = (effort, costs) else {
        return false;
    };
    let before = costs.iter().rev().nth(CREEPING);
    costs.len() > PATIENCE
        && *last > FAR_ABOVE * promised
        && before.is_some_and(|before| *last > 0.5 * before)
}

/// In which metric a step is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trust {
    /// That of the information: (F + λ diag F)⁻¹ g.
    Information,
    /// That of what is expected: errors of the set-up in their deviations, the joint in what couples its motions at most.
    /// The functions determine some of the errors a million times better than others, which λ diag F would hold fast.
    Expectation,
}

impl Trust {
    fn of(problem: &Problem) -> Self {
        match problem.error_count() {
            0 => Self::Information,
            _ => Self::Expectation,
        }
    }

    fn first(self) -> f64 {
        match self {
            Self::Information => 1e-3,
            Self::Expectation => 1.0,
        }
    }

    /// Normal equations with this damping; `None` where they have no solution.
    fn at(
        self,
        problem: &Problem,
        unknowns: &Unknowns,
        normal: &Normal,
        damping: f64,
    ) -> Option<Bounded> {
        let scale = scale(&normal.information);
        let mut scaled = scaled(&normal.information, &scale);
        let metric = match self {
            Self::Information => DVector::repeat(scale.len(), 1.0),
            Self::Expectation => problem
                .expected(unknowns)
                .ok()?
                .zip_map(&scale, |expected, scale| (scale / expected).powi(2)),
        };
        for place in 0..scale.len() {
            scaled[(place, place)] += damping * metric[place];
        }
        let root = scaled.cholesky()?;
        Some(Bounded {
            scale,
            metric,
            root,
        })
    }
}

/// Normal equations with damping.
struct Bounded {
    scale: DVector<f64>,
    /// Of unknowns in that scale.
    metric: DVector<f64>,
    root: Cholesky<f64, Dyn>,
}

impl Bounded {
    fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let scaled = self.root.solve(&right.component_mul(&self.scale));
        let own = scaled.component_mul(&self.scale);
        own.iter().all(|x| x.is_finite()).then_some(own)
    }

    /// Length of a step in the metric in which steps are bounded.
    fn length(&self, step: &DVector<f64>) -> f64 {
        let scaled = step.component_div(&self.scale);
        scaled.component_mul(&scaled).dot(&self.metric).sqrt()
    }
}

/// Where a step leads, and the cost there, if that is no higher. In a narrow valley a straight step soon runs into its side: there it
/// is bent as the functions bend along it (Transtrum and Sethna's geodesic acceleration).
fn tried(
    squares: &mut impl Squares,
    unknowns: &Unknowns,
    normal: &Normal,
    bounded: &Bounded,
) -> Option<(Unknowns, f64)> {
    let straight = bounded.solve(&normal.descent)?;
    // ½ a with (F + λD) a = −Jᵀ Σ⁻¹ f″
    let bend = squares.bend(unknowns, &straight);
    let bend = bend.and_then(|right| Some(bounded.solve(&right)? * 0.5));
    let bend = bend.filter(|bend| bounded.length(bend) <= BENT_MOST * bounded.length(&straight));
    let bent = bend.map(|bend| &straight + bend);
    let mut steps = bent.into_iter().chain([straight]);
    steps.find_map(|step| {
        let trial = squares.problem().after(unknowns, &step);
        let found = squares.cost(&trial).ok()?;
        (found <= normal.cost).then_some((trial, found))
    })
}

/// 1/√F_ii; of what nothing tells, 1.
fn scale(information: &DMatrix<f64>) -> DVector<f64> {
    information.diagonal().map(|own| match own > 0.0 {
        true => own.sqrt().recip(),
        false => 1.0,
    })
}

fn scaled(information: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(information.nrows(), information.ncols(), |i, j| {
        information[(i, j)] * scale[i] * scale[j]
    })
}

/// F⁻¹: the covariance of all unknowns.
pub(crate) fn covariance(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = scale(information);
    let inverse = scaled(information, &scale).cholesky()?.inverse();
    let covariance = DMatrix::from_fn(inverse.nrows(), inverse.ncols(), |i, j| {
        inverse[(i, j)] * scale[i] * scale[j]
    });
    covariance
        .iter()
        .all(|x| x.is_finite())
        .then_some(covariance)
}
