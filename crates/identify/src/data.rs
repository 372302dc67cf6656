//! The data as a search goes through them: few lines or all, the substructures exact or with their errors.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;

use super::draw::draw;
use super::estimator::Estimate;
use super::group::Group;
use super::layout::{MOST_BOLTS, Place};
use super::lines::Lines;
use super::noise::{Levels, Noise};
use super::objective::{Objective, State, Weights};
use super::residuals::Residuals;
use super::trials::same;
use super::used::{self, Chosen};
use super::{parallel, starts};

/// Most DOFs of a joint: those of as many bolts as there can be.
const MOST_DOFS: usize = 2 * MOST_BOLTS;

/// Lines whose use is judged at a time.
const LINES_AT_A_TIME: usize = 1024;

/// Lines that are enough to tell which start leads to the best estimate.
const LINES_FOR_STARTS: usize = 200;

/// The data in the forms that the search goes through.
pub(super) struct Data<'a> {
    all: Vec<(&'a Lines, usize)>,
    noise: &'a Noise,
    few: Vec<Vec<usize>>,
    every: Vec<Vec<usize>>,
    /// Few lines, substructures taken as exact.
    pub(super) thinned: Assemblies,
    /// The same lines with the errors of the substructures; `None` where these are exact.
    pub(super) thinned_whole: Option<Assemblies>,
    /// All lines, where the substructures are exact.
    whole: Option<Arc<Used>>,
}

/// The assemblies with the lines that are used of each.
pub(super) struct Used {
    pub(super) chosen: Vec<Chosen>,
    pub(super) assemblies: Assemblies,
}

impl Used {
    /// Lines of all assemblies that are used.
    pub(super) fn count(&self) -> usize {
        self.chosen.iter().map(Chosen::count).sum()
    }
}

/// Noise and unknowns at which it is asked which lines can be used.
type Near<'n> = (Levels, &'n DVector<f64>);

impl<'a> Data<'a> {
    /// Assemblies, each with the number of its joint; `None` if there are none, or none of a joint with so many DOFs.
    pub(super) fn of(all: Vec<(&'a Lines, usize)>, noise: &'a Noise) -> Option<Self> {
        let mut measured = all.iter().map(|(lines, _)| lines);
        let first = measured.find(|lines| !lines.frequency_hz.is_empty())?;
        if !(1..=MOST_DOFS).contains(&first.joint_dofs()) {
            return None;
        }
        let counts = || all.iter().map(|(lines, _)| lines.frequency_hz.len());
        let stride = (counts().max().unwrap_or(0) / LINES_FOR_STARTS).max(1);
        let of_stride = |stride: usize| -> Vec<Vec<usize>> {
            let lines = counts().map(|count| (0..count).step_by(stride));
            lines.map(Iterator::collect).collect()
        };
        let few = of_stride(stride);
        let every = of_stride(1);
        let mut thinned = Assemblies::of(&all, &Chosen::all_of(&few), noise);
        let exact = thinned.with_exact_sources();
        let thinned_whole = exact.map(|exact| std::mem::replace(&mut thinned, exact));
        let mut data = Self {
            all,
            noise,
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

    /// Lines of all assemblies.
    pub(super) fn lines(&self) -> usize {
        let counts = self.all.iter().map(|(lines, _)| lines.frequency_hz.len());
        counts.sum()
    }

    /// Gives each estimate its standing on the lines that starts are tried on, where there are substructures with errors and
    /// different estimates.
    pub(super) fn give_standings(&self, entries: &[Place], estimates: &mut [Estimate]) {
        let Some(whole) = &self.thinned_whole else {
            return;
        };
        let first_alike = |index: usize| {
            let is_alike = |other: &usize| same(&estimates[*other], &estimates[index]);
            (0..index).find(is_alike).unwrap_or(index)
        };
        let first_alike: Vec<usize> = (0..estimates.len()).map(first_alike).collect();
        let of_all = first_alike.iter().enumerate();
        let different: Vec<usize> = of_all
            .filter(|(index, first)| index == *first)
            .map(|(index, _)| index)
            .collect();
        if different.len() < 2 {
            return;
        }
        let whole = whole.objective(entries);
        let standings = parallel::map(&different, |&index| {
            let one = &estimates[index];
            let known = one.standing;
            known.unwrap_or_else(|| whole.standing(one, self.noise))
        });
        for (index, standing) in different.into_iter().zip(standings) {
            estimates[index].standing = Some(standing);
        }
        // the first one stands before those that are alike
        for (index, first) in first_alike.into_iter().enumerate() {
            estimates[index].standing = estimates[first].standing;
        }
    }

    /// Whether measured substructures have errors, so that not every line can be used.
    pub(super) fn has_errors(&self) -> bool {
        self.whole.is_none()
    }

    /// These lines of each assembly.
    pub(super) fn used(&self, chosen: Vec<Chosen>) -> Arc<Used> {
        let assemblies = Assemblies::of(&self.all, &chosen, self.noise);
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
            let assemblies = Assemblies::of(&self.all, &Chosen::all_of(&own), self.noise);
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

/// Assemblies whose joints have the same number of DOFs.
pub(super) struct Assemblies(Vec<Group>);

impl Assemblies {
    /// These lines of all assemblies, each with the number of its joint.
    fn of(all: &[(&Lines, usize)], chosen: &[Chosen], noise: &Noise) -> Self {
        Self(Group::all(all, chosen, noise))
    }

    /// With what of the joint is sought.
    pub(super) fn objective<'a>(&'a self, entries: &'a [Place]) -> Objective<'a> {
        let groups = &self.0;
        Objective {
            groups,
            entries,
            holds: false,
        }
    }

    /// See [`starts::Linear`]: what each of `guesses` leads to.
    pub(super) fn linear_starts(
        &self,
        entries: &[Place],
        guesses: &[Option<DVector<f64>>],
    ) -> Vec<DVector<f64>> {
        let linear = starts::Linear::of(&self.0);
        let from_guess = |guess: &Option<DVector<f64>>| linear.from(entries, guess.as_ref());
        let found = parallel::map(guesses, from_guess);
        found.into_iter().flatten().collect()
    }

    /// See [`starts::grid`].
    pub(super) fn grid(&self, entries: &[Place]) -> Vec<DVector<f64>> {
        starts::grid(&self.0, entries)
    }

    /// The assemblies of each group by their numbers.
    fn members(&self) -> Vec<&[usize]> {
        let groups = self.0.iter();
        groups.map(|group| group.assemblies.as_slice()).collect()
    }

    /// The same assemblies, the substructures taken as measured; `None` where they have no errors.
    fn with_exact_sources(&self) -> Option<Self> {
        let groups = || self.0.iter();
        let has_sources = groups().any(|group| !group.sources.is_empty());
        has_sources.then(|| Self(groups().flat_map(Group::with_exact_sources).collect()))
    }
}

/// What is asked of data and model as a whole.
impl Objective<'_> {
    /// Sums over the residuals of consecutive lines, for each group those of its pieces.
    pub(super) fn residuals(&self, levels: Levels, state: &State) -> Option<Vec<Vec<Residuals>>> {
        self.gather_whitened(levels, state, Residuals::add)
    }

    /// Complex numbers measured.
    pub(super) fn measurements(&self) -> usize {
        self.groups.iter().map(Group::measurements).sum()
    }

    /// Lines of all groups.
    pub(super) fn lines(&self) -> usize {
        self.groups.iter().map(Group::lines).sum()
    }

    /// Dynamic stiffness of the substructures of the first assembly with this joint at the joint's DOFs, and ω in the middle
    /// of the range; ones if there is no such assembly.
    pub(super) fn substructures(&self, joint: usize) -> (&[f64], f64) {
        let mut blocks = self.groups.iter().flat_map(|group| &group.blocks);
        match blocks.find(|block| block.joint == joint) {
            Some(block) => (&block.dynamic_stiffness, block.omega[block.lines() / 2]),
            None => (&[1.0; MOST_DOFS], 1.0),
        }
    }

    /// Data drawn from the model at `state`, all noise included.
    pub(super) fn drawn(
        &self,
        weights: &[Weights],
        state: &State,
        generator: &mut ChaCha8Rng,
    ) -> Option<Assemblies> {
        Some(Assemblies(draw(self, weights, state, generator)?))
    }
}
