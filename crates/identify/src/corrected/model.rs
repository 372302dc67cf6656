//! H^C of lines as they are corrected, with its derivatives by the joint and by the motions.

use super::super::kernel::{coupled, dot, filled, through, times};
use super::super::lanes::{Complexes, Number, Reals};
use super::super::motions::Act;
use super::Piece;
use super::lines::{CORRECTED, Corrected, MEASURED};

impl<const N: usize> Corrected<'_, N> {
    /// Puts what is measured, moved by `part` of the way from the motions where it is linearised to the best ones, into the model.
    pub(super) fn correct(&mut self, part: Option<Reals>) {
        for member in &mut self.members {
            member.free[CORRECTED] = member.free[MEASURED];
            let [measured, corrected] = &mut member.transfer;
            corrected.copy_from_slice(measured);
            let [measured, corrected] = &mut member.own;
            corrected.copy_from_slice(measured);
        }
        for cluster in &self.piece.group.motions.clusters {
            for (motion, actions) in (cluster.first..).zip(&cluster.motions) {
                let mut by = self.motions[motion];
                if let Some(part) = part {
                    by += (self.best.motions[motion] - by).scaled(part);
                }
                for action in actions {
                    let member = &mut self.members[action.block];
                    match action.act {
                        Act::Free(i, j) => {
                            member.free[CORRECTED][i][j] += by;
                            if i != j {
                                member.free[CORRECTED][j][i] += by;
                            }
                        }
                        Act::Transfer(i, point) => member.transfer[CORRECTED][point][i] += by,
                        Act::Own(entry) => member.own[CORRECTED][entry] += by,
                    }
                }
            }
        }
    }

    /// H^C and the residual of the model as it is corrected.
    pub(super) fn compute(&mut self) -> Option<()> {
        let Piece { group, entries, .. } = *self.piece;
        let mut at = 0;
        for (block, member) in group.blocks.iter().zip(&mut self.members) {
            let own = &self.piece.unknowns[block.unknowns(entries)];
            let dofs = filled::<N>(block.dofs);
            let mut stiffness = [[Complexes::ZERO; N]; N];
            for (t, place) in entries.iter().enumerate() {
                // K* = K + jωC
                let value = Complexes {
                    re: Reals::all(own[t]),
                    im: self.omega * Reals::all(own[entries.len() + t]),
                };
                for (i, j) in place.all() {
                    stiffness[i][j] = value;
                    stiffness[j][i] = value;
                }
            }
            let inverse = coupled(dofs, &member.free[CORRECTED], &stiffness)?;
            let transfer = &member.transfer[CORRECTED];
            for ((q, x), column) in member.q.iter_mut().zip(&mut member.x).zip(transfer) {
                *q = times(dofs, &inverse, column);
                *x = times(dofs, &stiffness, q);
            }
            for (e, entry) in block.entries.iter().enumerate() {
                let (left, right) = (&transfer[entry.row], &member.x[entry.column]);
                let computed = member.own[CORRECTED][e] - dot(&left[..dofs], &right[..dofs]);
                self.computed[at + e] = computed;
                self.residual[at + e] = self.measured[at + e] - computed;
            }
            at += block.entries.len();
        }
        Some(())
    }

    /// H^C, the residual and the derivatives with the motions as they are.
    pub(super) fn linearise(&mut self) -> Option<()> {
        self.correct(None);
        self.compute()?;
        self.derive_by_joint();
        self.derive_by_motion();
        Some(())
    }

    fn derive_by_joint(&mut self) {
        let (size, count) = (self.residual.len(), self.piece.entries.len());
        let mut at = 0;
        for (block, member) in self.piece.group.blocks.iter().zip(&self.members) {
            let columns = self.by_joint.chunks_exact_mut(size * count);
            for (joint, columns) in columns.enumerate() {
                for (place, column) in self
                    .piece
                    .entries
                    .iter()
                    .zip(columns.chunks_exact_mut(size))
                {
                    for (e, entry) in block.entries.iter().enumerate() {
                        let mut sum = Complexes::ZERO;
                        if joint == block.joint {
                            let (p, q) = (&member.q[entry.row], &member.q[entry.column]);
                            for indices in place.all() {
                                sum -= through(p, q, indices);
                            }
                        }
                        column[at + e] = sum;
                    }
                }
            }
            at += block.entries.len();
        }
    }

    /// By F it is Xᵀ dF X, by H_ks −(dH_skᵀ X + Xᵀ dH_ks).
    fn derive_by_motion(&mut self) {
        let group = self.piece.group;
        let mut rest = self.by_motion.as_mut_slice();
        for cluster in &group.motions.clusters {
            for actions in &cluster.motions {
                let (rows, others) = rest.split_at_mut(cluster.rows.len());
                rest = others;
                rows.fill(Complexes::ZERO);
                for action in actions {
                    let (block, member) =
                        (&group.blocks[action.block], &self.members[action.block]);
                    for &(e, at) in &action.entries {
                        let entry = block.entries[e];
                        let (p, q) = (&member.x[entry.row], &member.x[entry.column]);
                        match action.act {
                            Act::Free(i, j) => rows[at] += through(p, q, (i, j)),
                            Act::Transfer(i, point) => {
                                if entry.row == point {
                                    rows[at] -= q[i];
                                }
                                if entry.column == point {
                                    rows[at] -= p[i];
                                }
                            }
                            Act::Own(_) => rows[at] += Complexes::ONE,
                        }
                    }
                }
            }
        }
    }
}
