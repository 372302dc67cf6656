//! One line of the assemblies of a group as an estimate leaves it, for all that asks line by line.

use num_complex::Complex64;

use super::group::Group;
use super::noise::Size;
use super::weights::of_one;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// What is left of one line of a group. Reused from line to line.
pub(super) struct Line<'g> {
    group: &'g Group,
    pub(super) index: usize,
    /// H^C at each entry of all blocks.
    pub(super) computed: Vec<Complex64>,
    /// y − H^C as the substructures were measured, perhaps whitened.
    pub(super) residual: Vec<Complex64>,
    /// J: for each source, every entry of all blocks; empty where it is not asked for.
    pub(super) by_source: Vec<Complex64>,
    /// Jᵀr by the unknowns: what the whitened line adds to the gradient; empty where it is not asked for.
    pub(super) score: Vec<f64>,
    /// Σ|r|²/|H^C|², before whitening.
    pub(super) relative_power: f64,
}

impl<'g> Line<'g> {
    pub(super) fn new(group: &'g Group) -> Self {
        let size = group.entries();
        Self {
            group,
            index: 0,
            computed: vec![ZERO; size],
            residual: vec![ZERO; size],
            by_source: Vec::new(),
            score: Vec::new(),
            relative_power: 0.0,
        }
    }

    /// Entries that take part.
    pub(super) fn measurements(&self) -> usize {
        let blocks = self.group.blocks.iter();
        let used = blocks.filter(|block| block.takes_part(self.index));
        used.map(|block| block.entries.len()).sum()
    }

    /// H^C of one line as computed before, and the residual.
    pub(super) fn take(&mut self, index: usize, first: usize, computed: &[Vec<Complex64>]) {
        self.index = index;
        let mut at = 0;
        for (block, computed) in self.group.blocks.iter().zip(computed) {
            let count = block.entries.len();
            let among = (index - first) * count..(index - first + 1) * count;
            self.computed[at..at + count].copy_from_slice(&computed[among]);
            let measured = &block.measured[index * count..(index + 1) * count];
            for (e, measured) in (at..).zip(measured) {
                self.residual[e] = measured - self.computed[e];
            }
            at += count;
        }
        let pairs = self.residual.iter().zip(&self.computed);
        self.relative_power = pairs.map(|(r, h)| r.norm_sqr() / h.norm_sqr()).sum();
    }

    /// Divides by σ where every entry has an error of its own, as `level` gives it for the computed receptances.
    pub(super) fn whiten_by(&mut self, level: Size) {
        let mut at = 0;
        for block in &self.group.blocks {
            let count = block.entries.len();
            let known = block
                .known
                .get(self.index * count..(self.index + 1) * count);
            for (e, entry) in block.entries.iter().enumerate() {
                let known = known.map(|known| known[e]);
                let variance = of_one(level, entry.floor, known, self.computed[at + e].norm_sqr());
                self.residual[at + e] *= (f64::from(entry.count) / variance).sqrt();
            }
            at += count;
        }
    }
}
