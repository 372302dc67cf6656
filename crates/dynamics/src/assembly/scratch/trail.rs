//! What a law that knows time remembers at the nodes of a step, and how far it errs on the way between them.

use super::super::lobatto::NODES;
use crate::law::{DOF_AT_REST, DofLaws, DofMemory};

/// A law that knows time, node by node: it takes the mean velocity on its way, so that it errs with the square of the way's length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trail {
    pub(super) memory: [DofMemory; NODES],
    /// Heat on the way to each node, J.
    pub(super) heat_j: [f64; NODES],
}

impl Trail {
    pub(super) const AT_REST: Self = Self {
        memory: [DOF_AT_REST; NODES],
        heat_j: [0.0; NODES],
    };

    /// Goes on to the node `to` at (r, ṙ); what the load there is more than that on one way from the first node.
    pub(super) fn go_on(&mut self, laws: &DofLaws, to: usize, [r, velocity]: [f64; 2]) -> f64 {
        let (earlier, later) = self.memory.split_at_mut(to);
        let (Some(first), Some(last)) = (earlier.first(), earlier.last()) else {
            return 0.0;
        };
        let more = laws.load(last, r, velocity) - laws.load(first, r, velocity);
        laws.copy_memory(last, &mut later[0]);
        self.heat_j[to] = laws.commit(&mut later[0], r, velocity);
        more
    }

    /// What the load at the end is other than on a way with one stop in the middle, about half of which is what it errs by: the
    /// cubes of the ways between the nodes come to a third of those of two halves.
    pub(super) fn error(&self, laws: &DofLaws, middle: [f64; 2], [r, velocity]: [f64; 2]) -> f64 {
        let [first, .., last, _] = &self.memory;
        let mut memory = DOF_AT_REST;
        laws.copy_memory(first, &mut memory);
        laws.commit(&mut memory, middle[0], middle[1]);
        0.5 * (laws.load(last, r, velocity) - laws.load(&memory, r, velocity)).abs()
    }
}
