//! H^C of lines as they are corrected, with its derivatives by the joint and by the motions.

use super::super::factored::Factored;
use super::super::kernel::{dot, filled, through, times};
use super::super::lanes::{Complexes, Number, Reals};
use super::super::motions::{Act, Action, Moved};
use super::super::strip::complex_stiffness;
use super::Piece;
use super::lines::{CORRECTED, Corrected, MEASURED, Member};

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
            let stiffness = complex_stiffness(entries, own, self.omega);
            let factored = Factored::of(dofs, &member.free[CORRECTED], &stiffness)?;
            let transfer = &member.transfer[CORRECTED];
            for ((q, x), column) in member.q.iter_mut().zip(&mut member.x).zip(transfer) {
                *q = factored.solve(dofs, column);
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

    /// H^C, the residual and the derivatives by the motions, with these as they are.
    pub(super) fn linearise(&mut self) -> Option<()> {
        self.correct(None);
        self.compute()?;
        self.derive_by_motion();
        Some(())
    }

    pub(super) fn derive_by_joint(&mut self) {
        let (size, entries) = (self.residual.len(), self.piece.entries);
        let mut at = 0;
        for (block, member) in self.piece.group.blocks.iter().zip(&self.members) {
            let own = at..at + block.entries.len();
            at = own.end;
            let mut columns = self.by_joint.chunks_exact_mut(size);
            for joint in 0..self.piece.joints() {
                for (place, column) in entries.iter().zip(&mut columns) {
                    let column = &mut column[own.clone()];
                    if joint != block.joint {
                        column.fill(Complexes::ZERO);
                        continue;
                    }
                    let first = place.first();
                    for (value, entry) in column.iter_mut().zip(&block.entries) {
                        let (p, q) = (&member.q[entry.row], &member.q[entry.column]);
                        *value = -through(p, q, first);
                    }
                    for indices in place.all().skip(1) {
                        for (value, entry) in column.iter_mut().zip(&block.entries) {
                            let (p, q) = (&member.q[entry.row], &member.q[entry.column]);
                            *value -= through(p, q, indices);
                        }
                    }
                }
            }
        }
    }

    /// By F it is Xᵀ dF X, by H_ks −(dH_skᵀ X + Xᵀ dH_ks).
    pub(super) fn derive_by_motion(&mut self) {
        let group = self.piece.group;
        let mut rest = self.by_motion.as_mut_slice();
        for cluster in &group.motions.clusters {
            for actions in &cluster.motions {
                let (rows, others) = rest.split_at_mut(cluster.rows.len());
                rest = others;
                rows.fill(Complexes::ZERO);
                for action in actions {
                    derivative(&self.members[action.block], action, rows);
                }
            }
        }
    }
}

/// Adds the derivative of H^C by what acts on one assembly to its rows.
#[inline(always)]
fn derivative<const N: usize>(member: &Member<N>, action: &Action, rows: &mut [Complexes]) {
    let x = &member.x;
    match action.act {
        Act::Free(i, j) if i == j => {
            for &Moved { points, at } in &action.entries {
                rows[at] += x[points.0][i] * x[points.1][i];
            }
        }
        Act::Free(i, j) => {
            for &Moved { points, at } in &action.entries {
                let (p, q) = (&x[points.0], &x[points.1]);
                rows[at] += p[i] * q[j] + p[j] * q[i];
            }
        }
        Act::Transfer(i, point) => {
            for &Moved { points, at } in &action.entries {
                if points.0 == point {
                    rows[at] -= x[points.1][i];
                }
                if points.1 == point {
                    rows[at] -= x[points.0][i];
                }
            }
        }
        Act::Own(_) => {
            for moved in &action.entries {
                rows[moved.at] += Complexes::ONE;
            }
        }
    }
}
