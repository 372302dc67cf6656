//! Joint and causes that are most likely together, with how sure both are.

use nalgebra::DMatrix;

use super::budget::Prior;
use super::cause::{Cause, Side};
use super::experiment::Experiment;
use super::line::{Point, Task};
use super::search::{Found, Inflation, inverse, priors_cost, search, with_priors};
use super::shares::Shares;
use super::starts::grid;

/// How an estimate is found.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Gauss–Newton steps at most.
    pub most_iterations: usize,
    /// Lines where the substructures' noise moves what is predicted by more than this part of it are left out.
    pub most_nonlinear: f64,
    /// Lines that a frequency scale of two prior standard deviations moves by more than this part are left out.
    pub most_shifted: f64,
    /// Above this χ² per degree of freedom the search starts again with the assembly's noise inflated.
    pub most_reduced_chi_squared: f64,
    /// With more lines than these every second one, every third, and so on, is used.
    pub most_lines: usize,
    /// Whether other starts are tried where the first one leads to nothing that fits.
    pub seeks_elsewhere: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            most_iterations: 40,
            most_nonlinear: 0.3,
            most_shifted: 0.3,
            most_reduced_chi_squared: 1.3,
            most_lines: usize::MAX,
            seeks_elsewhere: true,
        }
    }
}

/// Where a search begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Stiffness of each unknown entry, then its damping; joint after joint.
    pub unknowns: Vec<f64>,
    /// Causes that are not zero, with their values in their units.
    pub causes: Vec<(Cause, f64)>,
}

impl Start {
    /// Begins without causes.
    #[must_use]
    pub fn without_causes(unknowns: &[f64]) -> Self {
        Self {
            unknowns: unknowns.to_vec(),
            causes: Vec::new(),
        }
    }

    /// Begins with a joint about ten times as stiff as the structures are there; `None` where these cannot be computed.
    #[must_use]
    pub fn typical(experiment: &Experiment<'_>) -> Option<Self> {
        let unknowns = grid(experiment).into_iter().next()?;
        Some(Self::without_causes(&unknowns))
    }

    pub(crate) fn point(&self, priors: &[Prior]) -> Point {
        let value = |prior: &Prior| {
            let own = self.causes.iter().find(|(cause, _)| *cause == prior.cause);
            own.map_or(0.0, |(_, value)| *value)
        };
        Point {
            unknowns: self.unknowns.clone(),
            causes: priors.iter().map(value).collect(),
        }
    }
}

/// A pull beyond so many prior standard deviations contradicts the prior.
pub const CONTRADICTED: f64 = 2.5;
/// A prior that is contradicted is made so much wider.
const WIDER: f64 = 10.0;
/// Priors that are made wider at most.
const MOST_WIDENED: usize = 4;
/// So many priors are not contradicted at once.
const UNLIKELY: usize = 2;
/// Steps of a search from a start of the grid, …
const FEW_ITERATIONS: usize = 25;
/// … and its lines.
const FEW_LINES: usize = 120;
/// A search that has not come to rest, or came to a joint without stiffness, counts as if it left so much more.
const HANDICAP: f64 = 0.5;
/// First inflations of the assembly's standard deviation, one after the other until the data are fitted.
const INFLATIONS: [f64; 3] = [1.0, 30.0, 100.0];

/// χ² per degree of freedom beyond which a joint may have been sought in the wrong place.
pub const FAR: f64 = 3.0;

/// What is known of a cause after the measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CauseEstimate {
    /// The cause with the prior that the estimate used.
    pub prior: Prior,
    /// Most likely value, in the unit of the cause.
    pub value: f64,
    /// Standard deviation after the measurement.
    pub standard_deviation: f64,
    /// The value over the standard deviation of the budget, where the data contradicted that and it was made wider.
    pub contradicted: Option<f64>,
}

/// The estimate with systematic errors.
pub struct Estimate {
    /// Stiffness of each unknown entry, then its damping; joint after joint.
    pub unknowns: Vec<f64>,
    /// Covariance of the unknowns, systematic errors included.
    pub covariance: DMatrix<f64>,
    /// What is known of each cause.
    pub causes: Vec<CauseEstimate>,
    /// What each group of causes does to each variance.
    pub shares: Shares,
    /// χ² over degrees of freedom; `None` without degrees of freedom.
    pub reduced_chi_squared: Option<f64>,
    /// Lines that were used, of how many.
    pub lines: (usize, usize),
    /// Gauss–Newton steps.
    pub iterations: usize,
    /// Measured structures of which no smooth fit was found: their frequency scales have no effect.
    pub without_smooth_fit: Vec<Side>,
    /// Whether the search came to rest.
    pub converged: bool,
    pub(crate) found: Found,
}

/// Finds the joint and the causes from `start` or, where that leads to nothing that fits, from others. Of the priors that the
/// data contradict the worst is made wider, one after the other. `None` where the assembly is singular, the data do not
/// determine the joint or a structure cannot be computed.
#[must_use]
pub fn estimate(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    start: &Start,
    settings: &Settings,
) -> Option<Estimate> {
    let mut priors = priors.to_vec();
    let mut contradicted: Vec<Option<f64>> = vec![None; priors.len()];
    let mut found = best_of_many(&Task::new(experiment, &priors), start, settings)?;
    for _ in 0..MOST_WIDENED {
        let pulls = contradictions(&priors, &found).into_iter();
        let new = pulls.filter(|(number, _)| contradicted[*number].is_none());
        let worst = new.max_by(|(_, one), (_, other)| one.abs().total_cmp(&other.abs()));
        let Some((number, pull)) = worst else {
            break;
        };
        contradicted[number] = Some(pull);
        let mut wider = priors.clone();
        wider[number].standard_deviation *= WIDER;
        let near = Start::without_causes(&found.point.unknowns);
        let task = Task::new(experiment, &wider);
        // where the joint with the narrow prior leads nowhere, the search begins anew
        let next = best(&task, &near, settings).or_else(|| best_of_many(&task, start, settings));
        let Some(next) = next else {
            break;
        };
        (priors, found) = (wider, next);
    }
    of(&Task::new(experiment, &priors), found, &contradicted)
}

/// Causes beyond what their priors allow, with the pull. Where a search has not come to rest the pulls say nothing.
fn contradictions(priors: &[Prior], found: &Found) -> Vec<(usize, f64)> {
    let pulls = std::iter::zip(&found.point.causes, priors)
        .map(|(value, prior)| prior.pull(*value))
        .enumerate();
    pulls
        .filter(|(_, pull)| found.converged && pull.abs() > CONTRADICTED)
        .collect()
}

/// The best of what several starts lead to. The first that fits is taken, unless it contradicts so many priors that it is
/// hardly true.
fn best_of_many(task: &Task<'_>, start: &Start, settings: &Settings) -> Option<Found> {
    let fits = |found: &Found| {
        let is_likely = contradictions(task.priors, found).len() < UNLIKELY;
        is_likely && rank(task, found) < settings.most_reduced_chi_squared
    };
    // without causes what is left is no noise as soon as there are errors
    let is_good = |found: &Found| task.priors.is_empty() || fits(found);
    let first = best(task, start, settings);
    if !settings.seeks_elsewhere || first.as_ref().is_some_and(is_good) {
        return first;
    }
    let few = Settings {
        most_iterations: settings.most_iterations.min(FEW_ITERATIONS),
        most_lines: settings.most_lines.min(FEW_LINES),
        ..settings.clone()
    };
    let none = Inflation::none(task.experiment);
    let mut nearest: Option<Found> = None;
    for unknowns in grid(task.experiment) {
        let start = Start::without_causes(&unknowns);
        let near = search(task, start.point(task.priors), &few, &none);
        let promises = |found: &Found| {
            let reduced = reduced_chi_squared(task, found);
            reduced.is_some_and(|reduced| reduced < settings.most_reduced_chi_squared)
        };
        if let Some(near) = near.as_ref().filter(|near| promises(near)) {
            let found = search(task, near.point.clone(), settings, &none);
            if found.as_ref().is_some_and(fits) {
                return found;
            }
        }
        nearest = better(task, nearest, near);
    }
    let second = nearest.and_then(|nearest| {
        let near = Start::without_causes(&nearest.point.unknowns);
        let found = best(task, &near, settings);
        found.or_else(|| search(task, nearest.point, settings, &none))
    });
    better(task, first, second)
}

fn better(task: &Task<'_>, one: Option<Found>, other: Option<Found>) -> Option<Found> {
    let both = one.into_iter().chain(other);
    both.min_by(|one, other| rank(task, one).total_cmp(&rank(task, other)))
}

/// χ² per degree of freedom, with a handicap for a search that has not come to rest and for a joint that is none: beyond a rigid
/// joint there is one that pushes back.
pub(crate) fn rank(task: &Task<'_>, found: &Found) -> f64 {
    let reduced = reduced_chi_squared(task, found).unwrap_or(0.0);
    if found.converged && has_stiffness(task, found) {
        reduced
    } else {
        HANDICAP + reduced
    }
}

/// Whether every stiffness on the diagonal is above zero.
fn has_stiffness(task: &Task<'_>, found: &Found) -> bool {
    let entries = task.experiment.joint.entries.iter();
    entries
        .zip(&found.point.unknowns)
        .filter(|(places, _)| places[0].0 == places[0].1)
        .all(|(_, stiffness)| *stiffness > 0.0)
}

/// As [`estimate`], with the priors as they are.
pub(crate) fn estimate_with(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    start: &Start,
    settings: &Settings,
) -> Option<Estimate> {
    let task = Task::new(experiment, priors);
    of(
        &task,
        best(&task, start, settings)?,
        &vec![None; priors.len()],
    )
}

/// As [`estimate`], with the priors as they are and from this start alone. `None` where that does not come to rest, too.
#[must_use]
pub fn estimate_near(
    experiment: &Experiment<'_>,
    priors: &[Prior],
    start: &Start,
    settings: &Settings,
) -> Option<Estimate> {
    let task = Task::new(experiment, priors);
    let none = Inflation::none(experiment);
    let found = search(&task, start.point(priors), settings, &none)?;
    let found = Some(found).filter(|found| found.converged)?;
    of(&task, found, &vec![None; priors.len()])
}

/// What the data say of a joint without causes, not searched for. `None` as in [`estimate`].
#[must_use]
pub fn evaluated(
    experiment: &Experiment<'_>,
    unknowns: &[f64],
    settings: &Settings,
) -> Option<Estimate> {
    let settings = Settings {
        most_iterations: 1,
        ..settings.clone()
    };
    let task = Task::new(experiment, &[]);
    let start = Start::without_causes(unknowns).point(&[]);
    of(
        &task,
        search(&task, start, &settings, &Inflation::none(experiment))?,
        &[],
    )
}

impl Estimate {
    /// Whether it leaves so much that it may be in the wrong place altogether.
    pub(crate) fn is_far(&self) -> bool {
        self.reduced_chi_squared.is_none_or(|chi| chi > FAR)
    }

    /// Whether no prior is contradicted.
    #[must_use]
    pub fn is_within_the_budget(&self) -> bool {
        self.causes.iter().all(|cause| cause.contradicted.is_none())
    }

    /// Whether the search came to rest and what is left is noise.
    #[must_use]
    pub fn fits(&self, settings: &Settings) -> bool {
        let chi = self.reduced_chi_squared;
        self.converged && chi.is_some_and(|chi| chi <= settings.most_reduced_chi_squared)
    }

    /// χ² of each of its lines that another estimate uses, too.
    pub(crate) fn costs_at<'e>(&'e self, other: &'e Self) -> impl Iterator<Item = f64> + 'e {
        let own = self.found.lines.iter().zip(&self.found.shares);
        own.filter(|(line, _)| other.found.lines.binary_search(line).is_ok())
            .map(|(_, share)| share.cost)
    }
}

fn best(task: &Task<'_>, start: &Start, settings: &Settings) -> Option<Found> {
    let experiment = task.experiment;
    let from = |inflation: f64| {
        let inflation = Inflation::from(experiment, inflation);
        search(task, start.point(task.priors), settings, &inflation)
    };
    // An assembly by itself is easier, and what it says of the structures leads the others.
    let led_by = |leading: usize| {
        let [held, released] = Inflation::led_by(experiment, leading);
        let led = search(task, start.point(task.priors), settings, &held)?;
        search(task, led.point, settings, &released)
    };
    let assemblies = 0..experiment.assemblies.len();
    let leading = assemblies.filter(|_| experiment.joints() > 1 && !task.priors.is_empty());
    let [first, others @ ..] = INFLATIONS;
    let ways = std::iter::once(Way::Inflated(first))
        .chain(leading.map(Way::Led))
        .chain(others.map(Way::Inflated));
    let mut found: Option<Found> = None;
    for way in ways {
        let next = match way {
            Way::Inflated(inflation) => from(inflation),
            Way::Led(leading) => led_by(leading),
        };
        found = better(task, found, next);
        let fits = |found: &Found| rank(task, found) < settings.most_reduced_chi_squared;
        if found.as_ref().is_some_and(fits) {
            break;
        }
    }
    let restless = found.as_ref().filter(|found| !found.converged);
    let again = restless.and_then(|found| {
        let none = Inflation::none(experiment);
        search(task, found.point.clone(), settings, &none)
    });
    better(task, found, again)
}

/// A way from a start to an estimate.
enum Way {
    /// With all assemblies' noise so many times as large at first.
    Inflated(f64),
    /// With one assembly before the others.
    Led(usize),
}

/// Degrees of freedom: as many causes as priors, so that the joint's unknowns alone cost some.
fn freedom(task: &Task<'_>, found: &Found) -> Option<f64> {
    let numbers = 2 * found.lines.len() * task.experiment.assembled().count();
    let freedom = numbers.checked_sub(task.unknowns());
    freedom
        .filter(|&freedom| freedom > 0)
        .map(|freedom| freedom as f64)
}

/// χ² of residuals and priors over the degrees of freedom.
fn reduced_chi_squared(task: &Task<'_>, found: &Found) -> Option<f64> {
    let priors = priors_cost(task, &found.point);
    Some((found.cost + priors) / freedom(task, found)?)
}

/// What is known at the end of a search.
pub(crate) fn of(task: &Task<'_>, found: Found, contradicted: &[Option<f64>]) -> Option<Estimate> {
    let size = task.unknowns();
    let whole = inverse(&with_priors(task, &found.information))?;
    let causes = task
        .priors
        .iter()
        .enumerate()
        .map(|(number, &prior)| CauseEstimate {
            prior,
            value: found.point.causes[number],
            standard_deviation: whole[(size + number, size + number)].sqrt(),
            contradicted: contradicted[number],
        });
    Some(Estimate {
        unknowns: found.point.unknowns.clone(),
        covariance: whole.view((0, 0), (size, size)).into_owned(),
        causes: causes.collect(),
        shares: Shares::of(task, &whole),
        reduced_chi_squared: reduced_chi_squared(task, &found),
        lines: (found.lines.len(), task.lines()),
        iterations: found.iterations,
        without_smooth_fit: task.without_smooth_fit(),
        converged: found.converged,
        found,
    })
}
