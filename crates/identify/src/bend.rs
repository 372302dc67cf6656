//! How the assembly's receptances bend along a step: what turns a straight step in a narrow valley into one that follows it.
//!
//! With H the receptances along θ + t v, (JᵀΣ⁻¹J + μD) a = −JᵀΣ⁻¹ H″ is the acceleration of the geodesic that leaves θ with v, and
//! θ + v + a/2 is on it to second order (Transtrum and Sethna, arXiv:1201.5885).

use nalgebra::DVector;

use super::group::Group;
use super::independent::PIECE;
use super::kernel::{dot, filled, through, times};
use super::lanes::{Complexes, LANES, Number, Reals};
use super::layout::Place;
use super::objective::{Objective, Weights};
use super::parallel;
use super::strip::{ENTRIES_OF_FOUR, MOST_ENTRIES, Strip};

impl Objective<'_> {
    /// −Re JᴴΣ⁻¹H″ along a step from these unknowns. `None` where few unknowns are sought, whose valleys are wide, and where errors of
    /// the substructures follow the unknowns.
    pub(super) fn bend(
        &self,
        weights: &[Weights],
        unknowns: &DVector<f64>,
        step: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        if !self.has_many_joints() || !self.is_independent() {
            return None;
        }
        let mut bend = DVector::zeros(unknowns.len());
        let along = (unknowns.as_slice(), step.as_slice());
        for (group, weights) in self.groups.iter().zip(weights) {
            let add: Add = match group.dofs() {
                5..=8 if self.entries.len() <= ENTRIES_OF_FOUR => add_group::<8, ENTRIES_OF_FOUR>,
                ..=16 => add_group::<16, MOST_ENTRIES>,
                _ => return None,
            };
            add(group, self.entries, along, weights, &mut bend)?;
        }
        Some(bend)
    }
}

type Add = fn(&Group, &[Place], (&[f64], &[f64]), &Weights, &mut DVector<f64>) -> Option<()>;

fn add_group<const N: usize, const E: usize>(
    group: &Group,
    entries: &[Place],
    (unknowns, step): (&[f64], &[f64]),
    weights: &Weights,
    bend: &mut DVector<f64>,
) -> Option<()> {
    let (size, count) = (group.entries(), entries.len());
    let mut at = 0;
    for block in &group.blocks {
        let own = block.unknowns(entries);
        let (unknowns, step) = (&unknowns[own.clone()], &step[own.clone()]);
        let pieces: Vec<usize> = (0..block.lines()).step_by(PIECE).collect();
        let sums = parallel::map(&pieces, |&first| {
            let mut by_stiffness = [Reals::ZERO; E];
            let mut by_damping = [Reals::ZERO; E];
            let mut strip = Strip::<N>::new(block);
            let dofs = filled::<N>(block.dofs);
            let none = vec![[Complexes::ZERO; N]; block.points];
            let (mut moved, mut far) = (none.clone(), none);
            let end = block.lines().min(first + PIECE);
            for line in (first..end).step_by(LANES) {
                let factored = strip.solve(line, entries, unknowns)?;
                let (free, along) = (strip.free(), strip.complex_stiffness(entries, step));
                for ((moved, far), q) in moved.iter_mut().zip(&mut far).zip(&strip.q) {
                    *moved = times(dofs, &along, q);
                    *far = factored.solve(dofs, &times(dofs, &free, moved));
                }
                let mut rights = [Complexes::ZERO; E];
                for (e, &entry) in block.entries.iter().enumerate() {
                    let place = |lane: usize| strip.index[lane] * size + at + e;
                    let weight = Reals::of(|lane| weights.entries[place(lane)]).reciprocal();
                    // H″/2 = Q_pᵀ V* (I + F K*)⁻¹ F V* Q_q
                    let half = dot(&moved[entry.row][..dofs], &far[entry.column][..dofs]);
                    let second = (half + half).scaled(strip.used * weight);
                    let (p, q) = (&strip.q[entry.row], &strip.q[entry.column]);
                    for (right, place) in rights.iter_mut().zip(entries) {
                        for at in place.all() {
                            *right += through(p, q, at).conj_times(second);
                        }
                    }
                }
                for (t, right) in rights[..count].iter().enumerate() {
                    by_stiffness[t] += right.re;
                    by_damping[t] += strip.omega * right.im;
                }
            }
            let sum = |sums: [Reals; E]| sums.map(Reals::sum);
            Some((sum(by_stiffness), sum(by_damping)))
        });
        for sums in sums {
            let (by_stiffness, by_damping) = sums?;
            for t in 0..count {
                bend[own.start + t] += by_stiffness[t];
                bend[own.start + count + t] += by_damping[t];
            }
        }
        at += block.entries.len();
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::super::block::{Block, Entry};
    use super::super::independent::computed;
    use super::super::layout::{Bolts, Layout};
    use super::super::model::JointModel;
    use super::super::noise::{Floor, Levels};
    use super::*;
    use num_complex::Complex64;

    const LINES: usize = 6;
    const DOFS: usize = 6;
    const POINTS: usize = 2;

    fn number(at: usize) -> Complex64 {
        let at = at as f64;
        Complex64::new((3.0 * at).sin(), 0.3 * (7.0 * at).cos())
    }

    /// Three bolts between structures of arbitrary symmetric receptances.
    fn block() -> Block {
        let entry = |(row, column)| Entry {
            row,
            column,
            count: 1,
            floor: Floor::default(),
        };
        let free = (0..LINES * DOFS * DOFS).map(|at| {
            let (line, i, j) = (at / (DOFS * DOFS), at / DOFS % DOFS, at % DOFS);
            number(line + 11 * i.min(j) + 5 * i.max(j)) + if i == j { 3.0 } else { 0.0 }
        });
        Block {
            joint: 0,
            dofs: DOFS,
            points: POINTS,
            entries: [(0, 0), (0, 1), (1, 1)].map(entry).to_vec(),
            omega: (0..LINES).map(|line| 1.0 + 0.2 * line as f64).collect(),
            free: free.collect(),
            dynamic_stiffness: vec![1.0; DOFS],
            transfer: (0..LINES * DOFS * POINTS)
                .map(|at| number(at + 3))
                .collect(),
            own: (0..LINES * 3).map(|at| number(at + 50)).collect(),
            measured: vec![Complex64::ZERO; LINES * 3],
            scatter: vec![0.0; LINES * 3],
            known: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// Of data y = H + H″ the normal equations have Jᵀ Σ⁻¹ H″ on the right.
    #[test]
    fn it_is_the_second_difference_of_what_is_computed() {
        const PART: f64 = 1e-3;
        let names = ["a", "b", "c"].map(str::to_owned).to_vec();
        let layout = Layout::new(JointModel::Full, &Bolts::Different(names), DOFS).unwrap();
        let entries = layout.places();
        let size = 2 * entries.len();
        let of = |seed: usize| DVector::from_fn(size, |i, _| number(i + seed).re + 1.5);
        let (unknowns, step) = (of(1), of(90));
        let mut block = block();
        let at = |part: f64| {
            let moved = &unknowns + &step * part;
            computed(&block, &entries, moved.as_slice(), 0..LINES).unwrap()
        };
        let (before, here, after) = (at(-PART), at(0.0), at(PART));
        let second = |i: usize| (before[i] + after[i] - 2.0 * here[i]) / (PART * PART);
        let measured = (0..here.len()).map(|i| here[i] + second(i)).collect();
        block.measured = measured;
        let groups = [Group {
            assemblies: vec![0],
            blocks: vec![block],
            ..Group::default()
        }];
        let objective = Objective {
            groups: &groups,
            entries: &entries,
            holds: false,
        };
        let weights = [Weights {
            entries: (0..LINES * 3).map(|i| 1.0 + (i % 4) as f64).collect(),
            levels: Levels::EXACT,
            scatter: 0.0,
        }];
        let bend = objective.bend(&weights, &unknowns, &step).unwrap();
        let right = objective.at(&weights, unknowns.clone(), None).unwrap();
        let right = right.normal.gradient;
        assert!(
            (&bend + &right).norm() < 1e-5 * right.norm(),
            "{bend} {right}"
        );
    }
}
