//! Where the search for a stiff joint begins: its motions are lost in noise and its loads are well known, so that motions are
//! regressed on loads. b = X f with X = D⁻¹ ≈ K⁻¹ − jω K⁻¹ C K⁻¹ is linear in both, from no compliance at all.

use bolted_joint_space::JointModel;
use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::dyads::{Grid, Group, descent, information};
use crate::fit::covariance;
use crate::links::Numbers;
use crate::normal::Normal;
use crate::patterns::Patterns;
use crate::problem::Problem;
use crate::side::MOTIONS;
use crate::starts::{LOSS, Loads, OfLine};

/// Rounds in which the weights of the motions follow the compliance.
const ROUNDS: usize = 10;

/// A compliance that noise has made smaller than this part of the largest is taken as so large.
const LEAST: f64 = 3e-3;

impl Loads {
    /// K and C of each joint, where X has all of its numbers.
    pub(crate) fn compliant(&self, problem: &Problem) -> Option<Vec<[Matrix6<f64>; 2]>> {
        let mut free = problem.clone();
        for link in &mut free.links.0 {
            if let Numbers::Unknown(model) = &mut link.numbers {
                let full = JointModel::Full.parametrisation().ok()?;
                *model = full.within(link.motions).ok()?;
            }
        }
        free.tolerances = None;
        let patterns = Patterns::of_joints(&free);
        let grid = Grid::new(self.weights.clone());
        let count = free.joint_count();
        let mut values = vec![0.0; count];
        for _ in 0..ROUNDS {
            let [flat, tilted] = free.links.sought_matrices(&values).ok()?;
            let mut normal = Normal::zeros(count);
            for (line, own) in self.lines.iter().enumerate() {
                let omega = problem.omega(line);
                let compliance = flat.zip_map(&tilted, |x, y| Complex64::new(x, -omega * y));
                let by_motions = self.by_motions(own, &compliance)?;
                let group = |joint: usize| Group {
                    left: by_motions.columns(MOTIONS * joint, MOTIONS).into_owned(),
                    right: own.loads.rows(MOTIONS * joint, MOTIONS).into_owned(),
                };
                let groups: Vec<Group> = (0..flat.nrows() / MOTIONS).map(group).collect();
                let errors = &by_motions * &own.motions;
                let products = patterns.products(information(&grid, &groups).as_view());
                let slopes = patterns.slopes(&descent(&grid, &groups, &errors));
                normal.add_line(omega, &patterns, &products, &slopes);
            }
            // derivatives are taken by −X and by its slope
            let found = covariance(&normal.information)? * &normal.descent;
            values = found.as_slice().to_vec();
            for joint in free.links.sought() {
                for own in &mut values[joint.first..joint.first + joint.model.count()] {
                    *own = -*own;
                }
            }
        }
        let middle = problem.omega(self.lines.len() / 2);
        let joints = free.links.sought();
        let of = |joint: &crate::links::Sought<'_>| {
            let [flat, tilted] = joint.matrices(&values).ok()?;
            stiff(&flat, &tilted, joint.link.length_m, middle)
        };
        let all: Option<Vec<_>> = joints.iter().map(of).collect();
        all.filter(|all| all.iter().flatten().flatten().all(|x| x.is_finite()))
    }

    /// T = Y Sᵀ (H + X)⁻¹, with rotations as lengths.
    fn by_motions(
        &self,
        own: &OfLine,
        compliance: &DMatrix<Complex64>,
    ) -> Option<DMatrix<Complex64>> {
        let (scales, motions) = (&self.scales, &self.own);
        let all = DMatrix::from_fn(motions.len(), motions.len(), |i, j| {
            let at = (motions[i], motions[j]);
            (own.seen[at] + compliance[at]) * scales[at.0] * scales[at.1]
        });
        let mut right = own.by_loads.select_columns(motions).transpose();
        for (mut row, &motion) in right.row_iter_mut().zip(motions) {
            row *= Complex64::from(scales[motion]);
        }
        let solved = all.transpose().lu().solve(&right)?;
        let mut by_motions = DMatrix::zeros(own.by_loads.nrows(), scales.len());
        for (row, &motion) in solved.row_iter().zip(motions) {
            by_motions.set_column(motion, &(row.transpose() * Complex64::from(scales[motion])));
        }
        Some(by_motions)
    }
}

/// K = X⁻¹ and C = K Y K of X − jωY; eigenvalues that noise has turned are made small ones.
fn stiff(
    flat: &Matrix6<f64>,
    tilted: &Matrix6<f64>,
    length_m: f64,
    omega: f64,
) -> Option<[Matrix6<f64>; 2]> {
    let scale = |i: usize| if i < 3 { 1.0 } else { length_m };
    let scaled = Matrix6::from_fn(|i, j| flat[(i, j)] * scale(i) * scale(j));
    let mut parts = scaled.symmetric_eigen();
    let least = LEAST * parts.eigenvalues.max();
    if least <= 0.0 {
        return None;
    }
    parts.eigenvalues.apply(|own| *own = own.max(least));
    let inverse = parts.recompose().try_inverse()?;
    let stiffness = Matrix6::from_fn(|i, j| inverse[(i, j)] * scale(i) * scale(j));
    let damping = stiffness * tilted * stiffness;
    let is_passive = damping.symmetric_eigenvalues().min() >= 0.0;
    let damping = match is_passive {
        true => damping,
        false => stiffness * (LOSS / omega),
    };
    Some([stiffness, damping])
}
