//! What is seen of a motion at the ends of a part: where one ends the next begins, and it is summed only once.

use super::super::{coordinates::Sight, system::System};

/// The latest motion that was looked at, and what was seen of it.
#[derive(Clone, Debug)]
pub(in super::super) struct Look {
    motion: Vec<f64>,
    seen: Vec<f64>,
}

impl Look {
    pub(in super::super) fn of(system: &System) -> Self {
        // of a motion that is at rest
        Self {
            motion: vec![0.0; 2 * system.size],
            seen: vec![0.0; 2 * system.forces() + system.loads],
        }
    }

    /// Relative motions (r, ṙ), and after them displacements at the loads.
    pub(super) fn at(&mut self, sight: &Sight, motion: &[f64]) -> &[f64] {
        let pairs = self.motion.iter().zip(motion);
        // all bits, so that nothing branches
        let differ = pairs.fold(0, |bits, (own, other)| {
            bits | (own.to_bits() ^ other.to_bits())
        });
        if differ != 0 {
            self.motion.copy_from_slice(motion);
            self.seen.fill(0.0);
            sight.ends.add_product_to(motion, &mut self.seen);
        }
        &self.seen
    }
}
