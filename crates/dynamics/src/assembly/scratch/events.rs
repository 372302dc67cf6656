//! Events within a step: where a law that remembers turns, or passes a corner of its load.

use super::super::{state::Underway, system::System};
use super::{Means, Scratch, at_nodes};
use crate::law::Corner;

impl Scratch {
    /// Whether within the step that was found a law that remembers turns or passes a corner of its load.
    pub(in super::super) fn has_event(&mut self, means: Means<'_>, before: &Underway) -> bool {
        let Means { system, rung, .. } = means;
        (0..system.forces()).any(|i| self.has_event_on(system, rung.length_s, before, i))
    }

    fn has_event_on(
        &mut self,
        system: &System,
        length_s: f64,
        before: &Underway,
        i: usize,
    ) -> bool {
        let [at_begin, .., at_end] = at_nodes(system, &self.laws);
        if !at_end.on[i].have_memory() {
            return false;
        }
        let d = system.forces();
        if self
            .relative
            .windows(2)
            .any(|pair| pair[0][d + i] * pair[1][d + i] < 0.0)
        {
            return true;
        }
        let [begin, .., end] = &self.relative;
        self.corners.clear();
        if !self.laws.is_empty() {
            at_begin.on[i].corners(&before.memory[i], end[i], &mut |corner| {
                if let Corner::Sharp(place) = corner {
                    self.corners.push(place);
                }
            });
        }
        let mut passes = false;
        let mut first = self.corners.iter();
        at_end.on[i].corners(&before.memory[i], end[i], &mut |corner| {
            if let Corner::Sharp(place) = corner {
                passes |= is_between(begin[i], place, end[i]);
                // with the preload a corner moves: what slides is on it, and sticks where the motion falls behind
                if let Some(&was) = first.next() {
                    let rate = (place - was) / length_s;
                    passes |= (was - begin[i]) * (end[i] - place) > 0.0;
                    passes |= (begin[d + i] - rate) * (end[d + i] - rate) < 0.0;
                }
            }
        });
        passes
    }
}

/// Whether a place is between two others, by more than rounding: what slides is on its corner.
fn is_between(begin: f64, place: f64, end: f64) -> bool {
    let rounding = 8.0 * f64::EPSILON * place.abs().max(begin.abs());
    (place - begin).abs() > rounding && (place - begin) * (end - place) > 0.0
}
