//! The way downhill beside one λ. Loads that are best for given joints are left out of the sums: they follow from the joints.

use nalgebra::{Cholesky, DMatrix};
use num_complex::Complex64;

use super::Loosened;
use super::lines::{Line, Part};
use crate::dyads::{Grid, Group, descent, information};
use crate::normal::Normal;
use crate::parallel::over_lines;
use crate::problem::{Problem, Unknowns};
use crate::side::MOTIONS;
use crate::starts::pseudo_inverse;

/// Steps of a round, and the part by which a step lowers the squares at least, if it is not to be the last.
const STEPS_MAX: usize = 40;
const SETTLED: f64 = 1e-4;

/// Damping of the first step, in parts of the diagonal, and the least.
const DAMPING: f64 = 1e-2;
const DAMPING_MIN: f64 = 1e-8;
/// By how much it shrinks after a step that led down, and grows after one that did not; how often one after the other.
const SHRINKS: f64 = 0.2;
const GROWS: f64 = 4.0;
const GROWS_MOST: usize = 8;

/// A part of a line beside one λ.
struct Tightened<'l> {
    line: &'l Line,
    part: &'l Part,
    /// λ/|b₀|
    tightness: f64,
    /// (U; λ H)⁺: loads that explain best, scaled, own motions × rows and own motions.
    inverse: DMatrix<Complex64>,
    /// I − (U; λ H) (U; λ H)⁺: what no loads explain.
    across: DMatrix<Complex64>,
}

/// What joints ask of the loads.
struct Asked {
    /// λ H (I + D H)⁻¹, own motions × motions: by an error of the balance.
    by_balance: DMatrix<Complex64>,
    /// (Y₀ − Y; λ H X b₀), rows and own motions × columns.
    right: DMatrix<Complex64>,
}

impl Loosened {
    /// From these joints, where the unknowns that are open may change.
    pub(super) fn settled(
        &self,
        problem: &Problem,
        start: Unknowns,
        open: &[usize],
        tightness: f64,
    ) -> Option<Unknowns> {
        let parts = self.tightened(tightness)?;
        let mut unknowns = start;
        let mut damping = DAMPING;
        for _ in 0..STEPS_MAX {
            let normal = self.normal(problem, &parts, &unknowns)?;
            let mut ahead = None;
            for _ in 0..GROWS_MOST {
                let tried = damped(&normal, &unknowns, open, damping)?;
                let cost = self.cost(problem, &parts, &tried);
                if let Some(cost) = cost.filter(|cost| *cost < normal.cost) {
                    ahead = Some((cost, tried));
                    break;
                }
                damping *= GROWS;
            }
            let Some((cost, tried)) = ahead else { break };
            unknowns = tried;
            damping = (SHRINKS * damping).max(DAMPING_MIN);
            if normal.cost - cost < SETTLED * normal.cost {
                break;
            }
        }
        Some(unknowns)
    }

    /// What these joints leave beside one λ.
    #[cfg(test)]
    pub(super) fn squares(&self, problem: &Problem, at: &Unknowns, tightness: f64) -> Option<f64> {
        self.cost(problem, &self.tightened(tightness)?, at)
    }

    fn tightened(&self, tightness: f64) -> Option<Vec<Tightened<'_>>> {
        let all = self.lines.iter().flat_map(|line| {
            let parts = line.parts.iter();
            parts.map(move |part| self.tight(line, part, tightness / part.size))
        });
        all.collect()
    }

    fn tight<'l>(&self, line: &'l Line, part: &'l Part, tightness: f64) -> Option<Tightened<'l>> {
        let (rows, count) = part.by_loads.shape();
        let both = DMatrix::from_fn(rows + count, count, |n, m| {
            let own = match n.checked_sub(rows) {
                None => part.by_loads[(n, m)],
                Some(n) => line.seen[(self.own[n], self.own[m])] * (tightness * self.scales[n]),
            };
            own / self.scales[m]
        });
        let [alike, unscaled] = [rows + count, count].map(|n| vec![1.0; n]);
        let inverse = pseudo_inverse(&both, &alike, &unscaled)?;
        let across = DMatrix::identity(rows + count, rows + count) - both * &inverse;
        Some(Tightened {
            line,
            part,
            tightness,
            inverse,
            across,
        })
    }

    fn asked(&self, part: &Tightened<'_>, joints: &[DMatrix<f64>; 2]) -> Option<Asked> {
        let (seen, omega) = (&part.line.seen, part.line.omega);
        let dynamic = joints[0].zip_map(&joints[1], |k, c| Complex64::new(k, omega * c));
        let opened = DMatrix::identity(seen.nrows(), seen.nrows()) + &dynamic * seen;
        let transposed = opened.transpose().lu().solve(&seen.transpose())?;
        let by_balance = DMatrix::from_fn(self.own.len(), seen.nrows(), |n, m| {
            transposed[(m, self.own[n])] * (part.tightness * self.scales[n])
        });
        let moved = &by_balance * (&dynamic * &part.part.motions);
        let change = &part.part.change;
        let rows = change.nrows();
        let mut right = DMatrix::zeros(rows + moved.nrows(), change.ncols());
        right.rows_mut(0, rows).copy_from(change);
        right.rows_mut(rows, moved.nrows()).copy_from(&moved);
        Some(Asked { by_balance, right })
    }

    fn cost(&self, problem: &Problem, parts: &[Tightened<'_>], at: &Unknowns) -> Option<f64> {
        let joints = problem.links.sought_matrices(at.0.as_slice()).ok()?;
        let sums = over_lines(parts.len(), |own| {
            let mut sum = 0.0;
            for part in &parts[own] {
                let asked = self.asked(part, &joints).ok_or(())?;
                sum += (&part.across * asked.right).norm_squared();
            }
            Ok::<f64, ()>(sum)
        });
        let sum: f64 = sums.ok()?.iter().sum();
        sum.is_finite().then_some(sum)
    }

    /// Derivatives are those of the balance H (f − D b) with the motions b = b₀ − H f that the loads make, as if they stayed: from
    /// afar these are nearer to the truth than those that the joints would make.
    fn normal(&self, problem: &Problem, parts: &[Tightened<'_>], at: &Unknowns) -> Option<Normal> {
        let joints = problem.links.sought_matrices(at.0.as_slice()).ok()?;
        let count = problem.joint_count();
        let normals = over_lines(parts.len(), |own| {
            self.normal_of(count, &parts[own], &joints).ok_or(())
        });
        let mut normal = Normal::zeros(count);
        for own in normals.ok()? {
            normal.add(&own);
        }
        Some(normal)
    }

    fn normal_of(
        &self,
        count: usize,
        parts: &[Tightened<'_>],
        joints: &[DMatrix<f64>; 2],
    ) -> Option<Normal> {
        let mut normal = Normal::zeros(count);
        for part in parts {
            let Asked { by_balance, right } = self.asked(part, joints)?;
            let seen = &part.line.seen;
            let found = &part.inverse * &right;
            let mut loads = DMatrix::zeros(seen.nrows(), right.ncols());
            for (n, &motion) in self.own.iter().enumerate() {
                let own = found.row(n).unscale(self.scales[n]);
                loads.row_mut(motion).copy_from(&own);
            }
            let motions = &part.part.motions - seen * loads;
            let errors = &part.across * right;
            let rows = part.part.change.nrows();
            let left = part.across.columns(rows, self.own.len()) * by_balance;
            let group = |joint: usize| Group {
                left: left.columns(MOTIONS * joint, MOTIONS).into_owned(),
                right: motions.rows(MOTIONS * joint, MOTIONS).into_owned(),
            };
            let groups: Vec<Group> = (0..seen.nrows() / MOTIONS).map(group).collect();
            let grid = Grid::new(errors.map(|_| 1.0));
            let products = self
                .patterns
                .products(information(&grid, &groups).as_view());
            let slopes = self.patterns.slopes(&descent(&grid, &groups, &errors));
            normal.add_line(part.line.omega, &self.patterns, &products, &slopes);
            normal.cost += errors.norm_squared();
        }
        Some(normal)
    }
}

/// Where a damped step leads.
fn damped(normal: &Normal, from: &Unknowns, open: &[usize], damping: f64) -> Option<Unknowns> {
    let sizes = open.iter().map(|&n| normal.information[(n, n)].sqrt());
    let sizes: Vec<f64> = sizes.collect();
    let information = DMatrix::from_fn(open.len(), open.len(), |i, j| {
        let own = normal.information[(open[i], open[j])] / (sizes[i] * sizes[j]);
        own + if i == j { damping } else { 0.0 }
    });
    let mut step = normal.descent.select_rows(open);
    step.iter_mut()
        .zip(&sizes)
        .for_each(|(own, size)| *own /= size);
    let step = Cholesky::new(information)?.solve(&step);
    let mut ahead = from.clone();
    for ((&n, own), size) in open.iter().zip(&step).zip(&sizes) {
        ahead.0[n] += own / size;
    }
    Some(ahead)
}
