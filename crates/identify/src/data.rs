//! The data as a search goes through them, whatever the number of the joint's DOFs: matrices of the joint have a fixed size
//! for each number, what asks for sums over them has not and is compiled once.

use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;

use super::draw::draw;
use super::group::{Group, Side};
use super::layout::Place;
use super::lines::Lines;
use super::noise::{Levels, Noise, NoiseLevel};
use super::objective::{Corrections, Objective, State, Weights};
use super::residuals::Residuals;
use super::{parallel, starts};

/// Lines that are enough to tell which start leads to the best estimate.
const LINES_FOR_STARTS: usize = 200;

/// The instance of a generic function for a number of joint DOFs; `None` where there is no such joint.
macro_rules! for_dofs {
    ($dofs:expr, $function:ident) => {
        match $dofs {
            1 => Some($function::<1> as _),
            2 => Some($function::<2> as _),
            3 => Some($function::<3> as _),
            4 => Some($function::<4> as _),
            6 => Some($function::<6> as _),
            8 => Some($function::<8> as _),
            _ => None,
        }
    };
}
pub(super) use for_dofs;

/// The data in the three forms that the search goes through.
pub(super) struct Data {
    /// Few lines, substructures taken as exact.
    pub(super) thinned: Box<dyn Assemblies>,
    /// Few lines with the errors of the substructures; `None` where these are exact.
    pub(super) thinned_whole: Option<Box<dyn Assemblies>>,
    /// All lines with the errors of the substructures.
    pub(super) whole: Box<dyn Assemblies>,
}

impl Data {
    /// Assemblies, each with the number of its joint; `None` if there are none, or none of a joint with so many DOFs.
    pub(super) fn of(all: &[(&Lines, usize)], noise: &Noise) -> Option<Self> {
        let mut measured = all.iter().map(|(lines, _)| lines);
        let first = measured.find(|lines| !lines.frequency_hz.is_empty())?;
        let of: fn(&[(&Lines, usize)], &Noise) -> Self = for_dofs!(first.joint_dofs(), with_dofs)?;
        Some(of(all, noise))
    }
}

/// Which part of the lines is enough: every one, or every second …
fn stride(all: &[(&Lines, usize)]) -> usize {
    let longest = all.iter().map(|(lines, _)| lines.frequency_hz.len()).max();
    (longest.unwrap_or(0) / LINES_FOR_STARTS).max(1)
}

fn with_dofs<const N: usize>(all: &[(&Lines, usize)], noise: &Noise) -> Data {
    let stride = stride(all);
    let noisy = |side: Side| noise.acts_on(side);
    let whole: Vec<Group<N>> = Group::all(all, 1, noisy);
    let has_sources = whole.iter().any(|group| !group.sources.is_empty());
    let thinned: Vec<Group<N>> = Group::all(all, stride, noisy);
    if !has_sources {
        return Data {
            thinned: Box::new(thinned),
            thinned_whole: None,
            whole: Box::new(whole),
        };
    }
    let exact: Vec<Group<N>> = thinned.iter().flat_map(Group::with_exact_sources).collect();
    Data {
        thinned: Box::new(exact),
        thinned_whole: Some(Box::new(thinned)),
        whole: Box::new(whole),
    }
}

/// Assemblies whose joints have the same number of DOFs.
pub(super) trait Assemblies: Send + Sync {
    /// With what of the joint is sought.
    fn objective<'a>(&'a self, entries: &'a [Place]) -> Box<dyn Misfit + 'a>;
    /// See [`starts::Linear`]: what each of `guesses` leads to.
    fn linear_starts(
        &self,
        entries: &[Place],
        guesses: &[Option<DVector<f64>>],
    ) -> Vec<DVector<f64>>;
    /// See [`starts::grid`].
    fn grid(&self, entries: &[Place]) -> Vec<DVector<f64>>;
}

impl<const N: usize> Assemblies for Vec<Group<N>> {
    fn objective<'a>(&'a self, entries: &'a [Place]) -> Box<dyn Misfit + 'a> {
        let groups = self;
        Box::new(Objective { groups, entries })
    }

    fn linear_starts(
        &self,
        entries: &[Place],
        guesses: &[Option<DVector<f64>>],
    ) -> Vec<DVector<f64>> {
        let linear = starts::Linear::of(self);
        let from_guess = |guess: &Option<DVector<f64>>| linear.from(entries, guess.as_ref());
        let found = parallel::map(guesses, from_guess);
        found.into_iter().flatten().collect()
    }

    fn grid(&self, entries: &[Place]) -> Vec<DVector<f64>> {
        starts::grid(self, entries)
    }
}

/// What is asked of data and model at a point; see [`Objective`].
pub(super) trait Misfit: Sync {
    fn is_independent(&self) -> bool;
    fn is_within_reach(&self, unknowns: &DVector<f64>) -> bool;
    fn no_corrections(&self) -> Corrections;
    fn unweighted(&self, unknowns: DVector<f64>, corrections: Option<Corrections>) -> State;
    fn at(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<State>;
    fn step(&self, weights: &[Weights], state: &State, unknowns: DVector<f64>) -> Option<State>;
    fn renewed(
        &self,
        levels: Levels,
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<(Vec<Weights>, State)>;
    fn weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>>;
    fn marginal_weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>>;
    fn eased_weights(&self, levels: Levels, state: &State, part: f64) -> Option<Vec<Weights>>;
    fn level(&self, noise: &Noise, state: &State, shrinkage: f64) -> Option<NoiseLevel>;
    fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64;
    fn log_determinant(&self, weights: &[Weights], state: &State) -> Option<f64>;
    /// Sums over the residuals of consecutive lines, for each group those of its pieces.
    fn residuals(&self, levels: Levels, state: &State) -> Option<Vec<Vec<Residuals>>>;
    /// For each group, the derivative of the sum by the unknowns, line by line.
    fn scores(&self, weights: &[Weights], state: &State) -> Option<Vec<Vec<DVector<f64>>>>;
    /// Whether no variance depends on a level that is estimated.
    fn is_known(&self, noise: &Noise) -> bool;
    /// Complex numbers measured.
    fn measurements(&self) -> usize;
    /// Lines of all groups.
    fn lines(&self) -> usize;
    /// Largest measured |H|.
    fn largest_measured(&self) -> f64;
    /// Dynamic stiffness of the substructures of the first assembly with this joint at the joint's DOFs, and ω in the middle
    /// of the range; ones if there is no such assembly.
    fn substructures(&self, joint: usize) -> (&[f64], f64);
    /// Data drawn from the model at `state`, all noise included.
    fn drawn(
        &self,
        weights: &[Weights],
        state: &State,
        generator: &mut ChaCha8Rng,
    ) -> Option<Box<dyn Assemblies>>;
}

impl<const N: usize> Misfit for Objective<'_, N> {
    fn is_independent(&self) -> bool {
        Objective::is_independent(self)
    }

    fn is_within_reach(&self, unknowns: &DVector<f64>) -> bool {
        Objective::is_within_reach(self, unknowns)
    }

    fn no_corrections(&self) -> Corrections {
        Objective::no_corrections(self)
    }

    fn unweighted(&self, unknowns: DVector<f64>, corrections: Option<Corrections>) -> State {
        Objective::unweighted(self, unknowns, corrections)
    }

    fn at(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<State> {
        Objective::at(self, weights, unknowns, corrections)
    }

    fn step(&self, weights: &[Weights], state: &State, unknowns: DVector<f64>) -> Option<State> {
        Objective::step(self, weights, state, unknowns)
    }

    fn renewed(
        &self,
        levels: Levels,
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<(Vec<Weights>, State)> {
        Objective::renewed(self, levels, unknowns, corrections)
    }

    fn weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>> {
        Objective::weights(self, levels, state)
    }

    fn marginal_weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>> {
        Objective::marginal_weights(self, levels, state)
    }

    fn eased_weights(&self, levels: Levels, state: &State, part: f64) -> Option<Vec<Weights>> {
        Objective::eased_weights(self, levels, state, part)
    }

    fn level(&self, noise: &Noise, state: &State, shrinkage: f64) -> Option<NoiseLevel> {
        Objective::level(self, noise, state, shrinkage)
    }

    fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64 {
        Objective::log_variances_of_scatter(self, weights)
    }

    fn log_determinant(&self, weights: &[Weights], state: &State) -> Option<f64> {
        Objective::log_determinant(self, weights, state)
    }

    fn residuals(&self, levels: Levels, state: &State) -> Option<Vec<Vec<Residuals>>> {
        self.gather_whitened(levels, state, Residuals::add)
    }

    fn scores(&self, weights: &[Weights], state: &State) -> Option<Vec<Vec<DVector<f64>>>> {
        Objective::scores(self, weights, state)
    }

    fn is_known(&self, noise: &Noise) -> bool {
        Objective::is_known(self, noise)
    }

    fn measurements(&self) -> usize {
        let groups = self.groups.iter();
        groups
            .map(|group| group.lines() * group.measurements())
            .sum()
    }

    fn lines(&self) -> usize {
        self.groups.iter().map(Group::lines).sum()
    }

    fn largest_measured(&self) -> f64 {
        let blocks = self.groups.iter().flat_map(|group| &group.blocks);
        let values = blocks.flat_map(|block| &block.measured);
        values.fold(0.0, |largest, value| f64::max(largest, value.norm()))
    }

    fn substructures(&self, joint: usize) -> (&[f64], f64) {
        let mut blocks = self.groups.iter().flat_map(|group| &group.blocks);
        match blocks.find(|block| block.joint == joint) {
            Some(block) => (&block.dynamic_stiffness, block.omega[block.lines() / 2]),
            None => (&[1.0; N], 1.0),
        }
    }

    fn drawn(
        &self,
        weights: &[Weights],
        state: &State,
        generator: &mut ChaCha8Rng,
    ) -> Option<Box<dyn Assemblies>> {
        let drawn = draw(self, weights, state, generator)?;
        Some(Box::new(drawn))
    }
}
