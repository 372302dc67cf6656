//! Goes through the lines as an estimate leaves them, for all that asks line by line.

use std::ops::Range;

use super::corrected::Seen;
use super::group::Group;
use super::independent;
use super::line::Line;
use super::noise::Levels;
use super::objective::{Objective, PIECE, State, Weights};
use super::parallel;

impl Objective<'_> {
    /// Calls `visit` with each line of each group as it is at `state`; derivatives are those by the sources.
    pub(super) fn visit(
        &self,
        state: &State,
        visit: &mut dyn FnMut(usize, &Line<'_>),
    ) -> Option<()> {
        for (number, group) in self.groups.iter().enumerate() {
            let (all, visit) = (0..group.lines(), &mut |line: &Line<'_>| visit(number, line));
            if group.sources.is_empty() {
                self.visit_independent(group, None, state, all, visit)?;
            } else {
                // What is computed does not depend on errors.
                let levels = Levels::EXACT;
                self.visit_corrected(number, levels, state, all, |_| Seen::Plain, visit)?;
            }
        }
        Some(())
    }

    /// What `visit` gathers of each group's lines as they are at `state`, whitened by the variances that `levels` give there. It
    /// begins with nothing gathered for each piece of consecutive lines.
    pub(super) fn gather_whitened<T: Default + Send>(
        &self,
        levels: Levels,
        state: &State,
        visit: impl Fn(&mut T, &Line<'_>) + Sync,
    ) -> Option<Vec<Vec<T>>> {
        let of_group = |(number, group): (usize, &Group)| {
            let is_independent = group.sources.is_empty();
            let length = if is_independent {
                independent::PIECE
            } else {
                PIECE
            };
            let of_piece = |lines: &Range<usize>| {
                let mut gathered = T::default();
                let (lines, visit) = (lines.clone(), &mut |line: &Line<'_>| {
                    visit(&mut gathered, line);
                });
                if is_independent {
                    self.visit_independent(group, Some(levels), state, lines, visit)?;
                } else {
                    self.visit_corrected(number, levels, state, lines, |_| Seen::Renewed, visit)?;
                }
                Some(gathered)
            };
            let pieces = parallel::pieces(group.lines(), length);
            parallel::map(&pieces, of_piece).into_iter().collect()
        };
        self.groups.iter().enumerate().map(of_group).collect()
    }

    /// Calls `visit` with each line of each group, whitened by these variances, with its score.
    pub(super) fn visit_scores(
        &self,
        weights: &[Weights],
        state: &State,
        visit: &mut dyn FnMut(usize, &Line<'_>),
    ) -> Option<()> {
        for (number, (group, weights)) in self.groups.iter().zip(weights).enumerate() {
            let (all, visit) = (0..group.lines(), &mut |line: &Line<'_>| visit(number, line));
            let seen = |lines| Seen::Score(weights.of_entries(group, lines));
            self.visit_corrected(number, weights.levels, state, all, seen, visit)?;
        }
        Some(())
    }

    /// Lines whose entries have errors of their own, whitened by what the levels give for the computed receptances, if there are
    /// any.
    fn visit_independent(
        &self,
        group: &Group,
        levels: Option<Levels>,
        state: &State,
        lines: Range<usize>,
        visit: &mut dyn FnMut(&Line<'_>),
    ) -> Option<()> {
        let unknowns = state.unknowns.as_slice();
        let blocks = group.blocks.iter();
        let computed: Option<Vec<_>> = blocks
            .map(|block| independent::computed(block, self.entries, unknowns, lines.clone()))
            .collect();
        let computed = computed?;
        let mut line = Line::new(group);
        let first = lines.start;
        for index in lines {
            line.take(index, first, &computed);
            if let Some(levels) = levels {
                line.whiten_by(levels.assembly);
            }
            visit(&line);
        }
        Some(())
    }

    /// Lines of any group, computed with their corrections at `state`, piece by piece.
    fn visit_corrected<'w>(
        &self,
        number: usize,
        levels: Levels,
        state: &State,
        lines: Range<usize>,
        seen: impl Fn(Range<usize>) -> Seen<'w>,
        visit: &mut dyn FnMut(&Line<'_>),
    ) -> Option<()> {
        let group = &self.groups[number];
        let count = group.sources.len();
        for first in lines.clone().step_by(PIECE) {
            let own = first..lines.end.min(first + PIECE);
            let corrections = &state.corrections[number][own.start * count..own.end * count];
            let piece = self.piece(group, levels, &state.unknowns, first / PIECE);
            piece.visit(own.len(), corrections, seen(own.clone()), visit)?;
        }
        Some(())
    }
}
