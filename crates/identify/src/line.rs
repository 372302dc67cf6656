//! One line of the assemblies of a group: receptances, residuals and derivatives, and how they are whitened.

use num_complex::Complex64;

use super::group::Group;
use super::kernel::Kernel;
use super::layout::Place;
use super::noise::Size;
use super::strip::MOST_ENTRIES;
use super::weights::of_one;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// One line of a group, linearised: everything that the normal equations need of it. Reused from line to line.
pub(super) struct Line<'g> {
    group: &'g Group,
    joint_entries: &'g [Place],
    kernel: Kernel,
    free: Vec<Complex64>,
    transfer: Vec<Complex64>,
    pub(super) index: usize,
    pub(super) omega: f64,
    /// H^C at each entry of all blocks.
    pub(super) computed: Vec<Complex64>,
    /// y − H^C, then r̃, then whitened.
    pub(super) residual: Vec<Complex64>,
    /// The joints of this group, ascending.
    joints: Vec<usize>,
    /// ∂H^C/∂K*, then whitened: for each of `joints`, for each entry of all blocks, one of each unknown entry of its K*.
    by_joint: Vec<[Complex64; MOST_ENTRIES]>,
    /// Unknowns of all torques together.
    unknowns: usize,
    /// J: for each source, every entry of all blocks.
    pub(super) by_source: Vec<Complex64>,
    /// Σ, then its Cholesky factor.
    factor: Vec<Complex64>,
    /// Σ|r̃|²/|H^C|², before whitening.
    pub(super) relative_power: f64,
}

/// Variances of one line.
#[derive(Clone, Copy)]
pub(super) struct Variances<'w> {
    /// σ_C² of the mean of each entry of all blocks.
    pub(super) entries: &'w [f64],
    /// σ_H² of each source.
    pub(super) sources: &'w [f64],
}

impl<'g> Line<'g> {
    pub(super) fn new(group: &'g Group, joint_entries: &'g [Place]) -> Self {
        let size = group.entries();
        let joints = group.joints();
        Self {
            group,
            joint_entries,
            kernel: Kernel::new(group.dofs()),
            free: Vec::new(),
            transfer: Vec::new(),
            index: 0,
            omega: 0.0,
            computed: vec![ZERO; size],
            residual: vec![ZERO; size],
            by_joint: vec![[ZERO; MOST_ENTRIES]; size * joints.len()],
            joints,
            unknowns: 0,
            by_source: vec![ZERO; size * group.sources.len()],
            factor: vec![
                ZERO;
                if group.sources.is_empty() {
                    0
                } else {
                    size * size
                }
            ],
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
    }

    /// H^C, the residual and the derivatives at this line.
    pub(super) fn linearise(
        &mut self,
        index: usize,
        unknowns: &[f64],
        delta: &[Complex64],
    ) -> Option<()> {
        self.index = index;
        self.omega = self.group.blocks.first()?.omega[index];
        self.unknowns = unknowns.len();
        let size = self.computed.len();
        if self.joints.len() > 1 {
            self.by_joint.fill([ZERO; MOST_ENTRIES]);
        }
        let mut at = 0;
        for (number, block) in self.group.blocks.iter().enumerate() {
            let own_joint = unknowns.get(block.unknowns(self.joint_entries))?;
            let slot = size * self.slot(block.joint);
            let count = block.entries.len();
            let own = &block.own[index * count..(index + 1) * count];
            let measured = &block.measured[index * count..(index + 1) * count];
            self.free.clear();
            self.free.extend_from_slice(block.free_at(index));
            self.transfer.clear();
            self.transfer.extend_from_slice(block.transfer_at(index));
            for (source, &delta) in self.group.sources.iter().zip(delta) {
                if let Some(pattern) = &source.patterns[number] {
                    for &(i, j, share) in &pattern.entries_of_free {
                        self.free[i * block.dofs + j] += delta * share;
                    }
                    for &i in &pattern.dofs_of_transfer {
                        let own = self.transfer.iter_mut().skip(i).step_by(block.dofs);
                        let shares = pattern.transfer.iter().skip(i).step_by(block.dofs);
                        for (value, share) in own.zip(shares) {
                            *value += delta * share;
                        }
                    }
                }
            }
            let joint = (self.joint_entries, own_joint, self.omega);
            self.kernel.solve(&self.free, &self.transfer, joint)?;
            for (e, &entry) in block.entries.iter().enumerate() {
                let mut own = own[e];
                for (source, &delta) in self.group.sources.iter().zip(delta) {
                    if let Some(pattern) = &source.patterns[number]
                        && let Some(&share) = pattern.own.get(e)
                    {
                        own += delta * share;
                    }
                }
                let computed = self.kernel.receptance(own, entry);
                self.computed[at + e] = computed;
                self.residual[at + e] = measured[e] - computed;
                for (t, &place) in self.joint_entries.iter().enumerate() {
                    self.by_joint[slot + at + e][t] = self.kernel.by_stiffness(entry, place);
                }
                for (s, source) in self.group.sources.iter().enumerate() {
                    self.by_source[s * size + at + e] =
                        source.patterns[number].as_ref().map_or(ZERO, |pattern| {
                            let own = pattern.own.get(e).copied().unwrap_or(0.0);
                            self.kernel.by_source(entry, pattern, own)
                        });
                }
            }
            at += count;
        }
        Some(())
    }

    /// Divides by σ where every entry has an error of its own.
    pub(super) fn whiten_independent(&mut self, variances: &[f64]) {
        self.measure();
        for (e, variance) in variances.iter().enumerate() {
            let weight = variance.recip().sqrt();
            self.residual[e] *= weight;
            for by_joint in self.by_joint.chunks_exact_mut(self.residual.len()) {
                for value in &mut by_joint[e][..self.joint_entries.len()] {
                    *value *= weight;
                }
            }
        }
    }

    /// The same with the variances that `level` gives for the computed receptances.
    pub(super) fn whiten_by(&mut self, level: Size) {
        self.measure();
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

    fn measure(&mut self) {
        let pairs = self.residual.iter().zip(&self.computed);
        self.relative_power = pairs.map(|(r, h)| r.norm_sqr() / h.norm_sqr()).sum();
    }

    /// y − H^C + Jδ: the residual as if the substructures' receptances were those measured.
    pub(super) fn add_corrections(&mut self, delta: &[Complex64]) {
        let size = self.residual.len();
        for (s, delta) in delta.iter().enumerate() {
            for e in 0..size {
                self.residual[e] += self.by_source[s * size + e] * delta;
            }
        }
    }

    /// Σ = Σ_C + J Σ_H Jᴴ = L Lᴴ, and L⁻¹ before residual and derivatives.
    pub(super) fn whiten(&mut self, variances: Variances<'_>, delta: &[Complex64]) -> Option<()> {
        if self.group.sources.is_empty() {
            self.whiten_independent(variances.entries);
            return Some(());
        }
        self.whiten_residual(variances, delta)?;
        self.whiten_derivatives();
        Some(())
    }

    fn whiten_residual(&mut self, variances: Variances<'_>, delta: &[Complex64]) -> Option<()> {
        self.add_corrections(delta);
        self.measure();
        self.factorise(variances)?;
        forward(&self.factor, self.residual.len(), &mut self.residual);
        Some(())
    }

    fn whiten_derivatives(&mut self) {
        let size = self.residual.len();
        for by_joint in self.by_joint.chunks_exact_mut(size) {
            for t in 0..self.joint_entries.len() {
                for row in 0..size {
                    let mut value = by_joint[row][t];
                    for column in 0..row {
                        value -= self.factor[row * size + column] * by_joint[column][t];
                    }
                    by_joint[row][t] = value / self.factor[row * size + row].re;
                }
            }
        }
    }

    fn factorise(&mut self, variances: Variances<'_>) -> Option<()> {
        let size = self.residual.len();
        self.factor.fill(ZERO);
        for (e, variance) in variances.entries.iter().enumerate() {
            self.factor[e * size + e] = Complex64::from(*variance);
        }
        for (s, &variance) in variances.sources.iter().enumerate() {
            let column = &self.by_source[s * size..(s + 1) * size];
            for row in 0..size {
                // Only receptances of the joint act on every entry.
                if column[row] == ZERO {
                    continue;
                }
                let left = column[row] * variance;
                for other in 0..=row {
                    self.factor[row * size + other] += left * column[other].conj();
                }
            }
        }
        for row in 0..size {
            for column in 0..=row {
                let mut value = self.factor[row * size + column];
                for k in 0..column {
                    value -= self.factor[row * size + k] * self.factor[column * size + k].conj();
                }
                if row == column {
                    // infinite where the entry is left out
                    if value.re.is_nan() || value.re <= 0.0 {
                        return None;
                    }
                    self.factor[row * size + row] = Complex64::from(value.re.sqrt());
                } else {
                    self.factor[row * size + column] =
                        value / self.factor[column * size + column].re;
                }
            }
        }
        Some(())
    }

    /// Where the unknowns of a joint begin among those of all.
    fn first_unknown(&self, joint: usize) -> usize {
        joint * 2 * self.joint_entries.len()
    }

    /// Place of a joint among those of this group.
    fn slot(&self, joint: usize) -> usize {
        self.joints.partition_point(|&other| other < joint)
    }

    /// Jᵀr of this whitened line by the unknowns: what it adds to the gradient.
    pub(super) fn score(&self) -> Vec<f64> {
        let count = self.joint_entries.len();
        let mut score = vec![0.0; self.unknowns];
        let own_rows = self.by_joint.chunks_exact(self.residual.len());
        for (rows, &joint) in own_rows.zip(&self.joints) {
            let first = self.first_unknown(joint);
            for (residual, row) in self.residual.iter().zip(rows) {
                for t in 0..count {
                    let product = row[t].conj() * residual;
                    score[first + t] += product.re;
                    score[first + count + t] += self.omega * product.im;
                }
            }
        }
        score
    }
}

/// x ← L⁻¹ x
fn forward(factor: &[Complex64], size: usize, x: &mut [Complex64]) {
    for row in 0..size {
        let mut value = x[row];
        for column in 0..row {
            value -= factor[row * size + column] * x[column];
        }
        x[row] = value / factor[row * size + row].re;
    }
}
