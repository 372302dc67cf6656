//! The data as a search goes through them, whatever the number of the joint's DOFs: matrices of the joint have a fixed size
//! for each number, what asks for sums over them has not and is compiled once.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;

use super::draw::draw;
use super::group::Group;
use super::layout::Place;
use super::lines::Lines;
use super::noise::{Levels, Noise, Size};
use super::objective::{Corrections, Objective, State, Weights};
use super::residuals::Residuals;
use super::used::{self, Chosen};
use super::{parallel, starts};

/// Lines whose use is judged at a time.
const LINES_AT_A_TIME: usize = 1024;

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
            5 => Some($function::<5> as _),
            6 => Some($function::<6> as _),
            7 => Some($function::<7> as _),
            8 => Some($function::<8> as _),
            10 => Some($function::<10> as _),
            12 => Some($function::<12> as _),
            14 => Some($function::<14> as _),
            16 => Some($function::<16> as _),
            _ => None,
        }
    };
}
pub(super) use for_dofs;

/// The data in the forms that the search goes through.
pub(super) struct Data<'a> {
    all: Vec<(&'a Lines, usize)>,
    noise: &'a Noise,
    form: Form,
    few: Vec<Vec<usize>>,
    every: Vec<Vec<usize>>,
    /// Few lines, substructures taken as exact.
    pub(super) thinned: Box<dyn Assemblies>,
    /// The same lines with the errors of the substructures; `None` where these are exact.
    pub(super) thinned_whole: Option<Box<dyn Assemblies>>,
    /// All lines, where the substructures are exact.
    whole: Option<Arc<Used>>,
}

/// The assemblies with the lines that are used of each.
pub(super) struct Used {
    pub(super) chosen: Vec<Chosen>,
    pub(super) assemblies: Box<dyn Assemblies>,
}

/// Noise and unknowns at which it is asked which lines can be used.
type Near<'n> = (Levels, &'n DVector<f64>);

/// Forms assemblies of which these lines are taken.
type Form = fn(&[(&Lines, usize)], &[Chosen], &Noise) -> Box<dyn Assemblies>;

impl<'a> Data<'a> {
    /// Assemblies, each with the number of its joint; `None` if there are none, or none of a joint with so many DOFs.
    pub(super) fn of(all: Vec<(&'a Lines, usize)>, noise: &'a Noise) -> Option<Self> {
        let mut measured = all.iter().map(|(lines, _)| lines);
        let first = measured.find(|lines| !lines.frequency_hz.is_empty())?;
        let form: Form = for_dofs!(first.joint_dofs(), formed)?;
        let counts = || all.iter().map(|(lines, _)| lines.frequency_hz.len());
        let stride = (counts().max().unwrap_or(0) / LINES_FOR_STARTS).max(1);
        let of_stride = |stride: usize| -> Vec<Vec<usize>> {
            let lines = counts().map(|count| (0..count).step_by(stride));
            lines.map(Iterator::collect).collect()
        };
        let few = of_stride(stride);
        let every = of_stride(1);
        let mut thinned = form(&all, &Chosen::all_of(&few), noise);
        let exact = thinned.with_exact_sources();
        let thinned_whole = exact.map(|exact| std::mem::replace(&mut thinned, exact));
        let mut data = Self {
            all,
            noise,
            form,
            few,
            every: Vec::new(),
            thinned,
            thinned_whole,
            whole: None,
        };
        match data.thinned_whole {
            Some(_) => data.every = every,
            None => data.whole = Some(data.used(Chosen::all_of(&every))),
        }
        Some(data)
    }

    /// Whether measured substructures have errors, so that not every line can be used.
    pub(super) fn has_errors(&self) -> bool {
        self.whole.is_none()
    }

    /// These lines of each assembly.
    pub(super) fn used(&self, chosen: Vec<Chosen>) -> Arc<Used> {
        let assemblies = (self.form)(&self.all, &chosen, self.noise);
        Arc::new(Used { chosen, assemblies })
    }

    /// The lines that an estimate near these unknowns can use.
    pub(super) fn used_near(&self, entries: &[Place], near: Near<'_>) -> Arc<Used> {
        match &self.whole {
            Some(whole) => Arc::clone(whole),
            None => self.used(self.steady_near(entries, near, &self.every)),
        }
    }

    /// Those of the few lines that an estimate near these unknowns can use.
    pub(super) fn few_near(&self, entries: &[Place], near: Near<'_>) -> Arc<Used> {
        self.used(self.steady_near(entries, near, &self.few))
    }

    /// Which of these lines of each assembly the errors of the substructures move little enough.
    fn steady_near(
        &self,
        entries: &[Place],
        (levels, unknowns): Near<'_>,
        lines: &[Vec<usize>],
    ) -> Vec<Chosen> {
        let longest = lines.iter().map(Vec::len).max().unwrap_or(0);
        let of_piece = |piece: &Range<usize>| {
            let own = lines.iter().map(|lines| {
                let end = piece.end.min(lines.len());
                lines[piece.start.min(end)..end].to_vec()
            });
            let own: Vec<Vec<usize>> = own.collect();
            let assemblies = (self.form)(&self.all, &Chosen::all_of(&own), self.noise);
            let moved = assemblies.objective(entries).moved(levels, unknowns);
            let members = assemblies.members().into_iter().map(<[usize]>::to_vec);
            members.zip(moved).collect::<Vec<_>>()
        };
        let mut moved: Vec<Vec<f64>> = vec![Vec::new(); lines.len()];
        let pieces = parallel::pieces(longest, LINES_AT_A_TIME);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (members, of_group) in parallel::map(&pieces, of_piece).into_iter().flatten() {
            for (&assembly, of_block) in members.iter().zip(of_group) {
                moved[assembly].extend(of_block);
            }
            if !groups.contains(&members) {
                groups.push(members);
            }
        }
        used::chosen(lines, &moved, &groups)
    }
}

fn formed<const N: usize>(
    all: &[(&Lines, usize)],
    chosen: &[Chosen],
    noise: &Noise,
) -> Box<dyn Assemblies> {
    let groups: Vec<Group<N>> = Group::all(all, chosen, noise);
    Box::new(groups)
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
    /// The assemblies of each group by their numbers.
    fn members(&self) -> Vec<&[usize]>;
    /// The same assemblies, the substructures taken as measured; `None` where they have no errors.
    fn with_exact_sources(&self) -> Option<Box<dyn Assemblies>>;
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

    fn members(&self) -> Vec<&[usize]> {
        let groups = self.iter();
        groups.map(|group| group.assemblies.as_slice()).collect()
    }

    fn with_exact_sources(&self) -> Option<Box<dyn Assemblies>> {
        let has_sources = self.iter().any(|group| !group.sources.is_empty());
        let exact = || -> Self { self.iter().flat_map(Group::with_exact_sources).collect() };
        has_sources.then(|| Box::new(exact()) as _)
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
    fn renewed(
        &self,
        levels: Levels,
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<(Vec<Weights>, State)>;
    fn weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>>;
    fn marginal_weights(&self, levels: Levels, state: &State) -> Option<Vec<Weights>>;
    /// By what part errors of the substructures move each line, for each assembly of each group; see [`used`].
    fn moved(&self, levels: Levels, unknowns: &DVector<f64>) -> Vec<Vec<Vec<f64>>>;
    fn level(&self, noise: &Noise, state: &State, shrinkage: f64) -> Option<Size>;
    fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64;
    fn log_powers(&self) -> f64;
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

    fn moved(&self, levels: Levels, unknowns: &DVector<f64>) -> Vec<Vec<Vec<f64>>> {
        Objective::moved(self, levels, unknowns)
    }

    fn level(&self, noise: &Noise, state: &State, shrinkage: f64) -> Option<Size> {
        Objective::level(self, noise, state, shrinkage)
    }

    fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64 {
        Objective::log_variances_of_scatter(self, weights)
    }

    fn log_powers(&self) -> f64 {
        Objective::log_powers(self)
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
        self.groups.iter().map(Group::measurements).sum()
    }

    fn lines(&self) -> usize {
        self.groups.iter().map(Group::lines).sum()
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
