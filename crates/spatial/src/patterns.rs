//! How the unknowns are made of dyads, and what the sums over dyads say of the unknowns.
//!
//! A number of a joint stands at some of the 36 entries of its matrix, and an error of a sensor or an impact changes the
//! transformation of its interface: both are weighted sums of dyads, with weights that no line changes. So the lines are summed
//! first, and the weights applied once.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorViewMut};
use num_complex::Complex64;

use crate::assembled::{Assembled, Line};
use crate::dyads::Group;
use crate::error::SpatialError;
use crate::links::Sought;
use crate::normal::Normal;
use crate::problem::Problem;
use crate::sums::{Slopes, Sums};

/// One unknown's dyads, θ_pq at p·right + q of its group, counted through all groups, and their weights.
#[derive(Clone, Debug)]
pub(crate) struct Pattern(Vec<(usize, f64)>);

/// Where what a pattern does belongs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Places {
    /// The unknown of stiffness and that of damping: ∂D/∂k and ∂D/∂c = jω ∂D/∂k.
    OfJoint([usize; 2]),
    /// An error of a set-up.
    OfSetUp(usize),
}

/// Those of all unknowns.
pub(crate) struct Patterns {
    of_joints: Vec<Pattern>,
    places: Vec<[usize; 2]>,
    of_set_up: Vec<Pattern>,
    /// Errors that have their dyads among themselves, such as those of a side's sensors; as far as the sums over all lines need them.
    blocks: Vec<Block>,
    /// The first error's unknown.
    first_error: usize,
}

/// Consecutive errors of a set-up.
struct Block {
    /// Places of their dyads, and of the errors among all of them.
    dyads: Range<usize>,
    errors: Range<usize>,
    /// Of each dyad in each error.
    weights: DMatrix<f64>,
}

impl Pattern {
    /// From dyads and their weights, of which those that are zero need not stand there.
    pub(crate) fn new(dyads: impl Iterator<Item = (usize, f64)>) -> Self {
        Self(dyads.filter(|(_, weight)| *weight != 0.0).collect())
    }

    /// What the unknown does to the function of a row and a column.
    pub(crate) fn of(&self, groups: &[Group], [row, column]: [usize; 2]) -> Complex64 {
        let mut sum = Complex64::default();
        for &(place, weight) in &self.0 {
            let mut own = place;
            for group in groups {
                let width = group.right.nrows();
                let count = group.left.ncols() * width;
                if own < count {
                    let (p, q) = (own / width, own % width);
                    sum += weight * group.left[(row, p)] * group.right[(q, column)];
                    break;
                }
                own -= count;
            }
        }
        sum
    }
}

impl Line {
    /// a and b, the dyads of every change of the joints that are sought.
    pub(crate) fn dyads(&self, problem: &Problem) -> Vec<Group> {
        let of = |joint: &Sought<'_>| Group {
            left: self
                .by_joint_loads
                .columns_range(joint.motions())
                .into_owned(),
            right: self.joint_motions.rows_range(joint.motions()).into_owned(),
        };
        problem.links.sought().iter().map(of).collect()
    }
}

impl Patterns {
    /// Of the joints that are sought alone.
    pub(crate) fn of_joints(problem: &Problem) -> Self {
        let (mut of_joints, mut places) = (Vec::new(), Vec::new());
        for (number, joint) in problem.links.sought().iter().enumerate() {
            let count = joint.model.count();
            for (n, basis) in joint.model.bases().iter().enumerate() {
                let own = (0..36).map(|place| (36 * number + place, basis[(place / 6, place % 6)]));
                of_joints.push(Pattern::new(own));
                places.push([joint.first + n, joint.first + count + n]);
            }
        }
        Self {
            of_joints,
            places,
            of_set_up: Vec::new(),
            blocks: Vec::new(),
            first_error: problem.joint_count(),
        }
    }

    /// Likewise, and these of the errors of the set-up.
    pub(crate) fn beside(problem: &Problem, of_set_up: Vec<Pattern>) -> Self {
        Self {
            of_set_up,
            ..Self::of_joints(problem)
        }
    }

    /// Likewise, and those of the errors of the set-up where they are unknown.
    pub(crate) fn of(problem: &Problem, assembled: &Assembled<'_>) -> Result<Self, SpatialError> {
        if problem.tolerances.is_none() {
            return Ok(Self::of_joints(problem));
        }
        let (mut of_set_up, mut blocks) = (Vec::new(), Vec::new());
        let mut first = 36 * problem.links.sought().len();
        let counts = problem.sides.iter().flat_map(|side| {
            let [rows, columns] = [side.responses.len(), side.references.len()];
            let of_sensors = side.anew.sensors.map(|_| rows);
            let of_hits = side.anew.hits.map(|_| columns);
            let all = [rows, columns].into_iter().chain(of_sensors).chain(of_hits);
            all.map(|own| own * problem.motions())
        });
        for (changes, count) in assembled.changes()?.iter().zip(counts) {
            // θ_pq at p·right + q: row by row
            let weights = DMatrix::from_fn(count, changes.len(), |place, n| {
                let width = changes[n].ncols();
                changes[n][(place / width, place % width)].re
            });
            let before = of_set_up.len();
            let own = weights.column_iter().map(|weights| {
                Pattern::new(weights.iter().enumerate().map(|(n, own)| (first + n, *own)))
            });
            of_set_up.extend(own);
            blocks.push(Block {
                dyads: first..first + count,
                errors: before..of_set_up.len(),
                weights,
            });
            first += count;
        }
        Ok(Self {
            blocks,
            ..Self::beside(problem, of_set_up)
        })
    }

    /// Those of the joints, then those of the set-up.
    fn each(&self) -> impl Iterator<Item = &Pattern> {
        self.of_joints.iter().chain(&self.of_set_up)
    }

    /// All, with where they belong.
    pub(crate) fn all(&self) -> impl Iterator<Item = (Places, &Pattern)> {
        let places = self.places.iter().copied().map(Places::OfJoint);
        let of_set_up = self.of_set_up.iter().enumerate();
        let of_set_up = of_set_up.map(|(n, own)| (Places::OfSetUp(self.first_error + n), own));
        places.zip(&self.of_joints).chain(of_set_up)
    }

    /// Jᴴ Σ⁻¹ J and Jᴴ Σ⁻¹ e: of ∂Y_C/∂k = −dyads, ∂Y_C/∂c = −jω dyads, ∂Y_C/∂η = dyads.
    pub(crate) fn normal(&self, count: usize, mut sums: Sums) -> Normal {
        sums.flat.fill_upper_triangle_with_lower_triangle();
        let mut normal = Normal::zeros(count);
        normal.cost = sums.squares;
        let joints = &self.of_joints;
        let flat = combined(joints, &sums.flat, joints);
        let tilted = combined(joints, &sums.tilted, joints);
        let curved = combined(joints, &sums.curved, joints);
        for (k, &[stiffness, damping]) in self.places.iter().enumerate() {
            for (l, &[other, of_other]) in self.places.iter().enumerate() {
                normal.information[(stiffness, other)] = 2.0 * flat[(k, l)];
                normal.information[(stiffness, of_other)] = -2.0 * tilted[(k, l)];
                normal.information[(damping, other)] = 2.0 * tilted[(k, l)];
                normal.information[(damping, of_other)] = 2.0 * curved[(k, l)];
            }
        }
        let flat = self.beside_joints(&sums.flat);
        let tilted = self.beside_joints(&sums.tilted);
        for n in 0..self.of_set_up.len() {
            let place = self.first_error + n;
            for (k, &[stiffness, damping]) in self.places.iter().enumerate() {
                for (row, value) in [(stiffness, flat[(k, n)]), (damping, tilted[(k, n)])] {
                    normal.information[(row, place)] = -2.0 * value;
                    normal.information[(place, row)] = -2.0 * value;
                }
            }
        }
        for (n, own) in self.blocks.iter().enumerate() {
            let place = self.first_error + own.errors.start;
            for other in &self.blocks[n..] {
                let below = sums.flat.view_range(other.dyads.clone(), own.dyads.clone());
                let product = other.weights.tr_mul(&(below * &own.weights)) * 2.0;
                let of_other = self.first_error + other.errors.start;
                let mut all = normal
                    .information
                    .view_mut((of_other, place), product.shape());
                all.copy_from(&product);
                let product = product.transpose();
                let mut all = normal
                    .information
                    .view_mut((place, of_other), product.shape());
                all.copy_from(&product);
            }
        }
        normal.descent = self.descent(count, &sums.slopes);
        normal
    }

    /// Eᵀ M E′ of the joints and the errors of the set-up, of the joints' rows of M.
    fn beside_joints(&self, sums: &DMatrix<f64>) -> DMatrix<f64> {
        let mut by_joints = DMatrix::zeros(self.of_joints.len(), sums.ncols());
        for (k, own) in self.of_joints.iter().enumerate() {
            for &(place, factor) in &own.0 {
                for (sum, entry) in by_joints.row_mut(k).iter_mut().zip(sums.row(place).iter()) {
                    *sum += factor * entry;
                }
            }
        }
        let mut all = DMatrix::zeros(self.of_joints.len(), self.of_set_up.len());
        for own in &self.blocks {
            let mut errors = all.columns_range_mut(own.errors.clone());
            errors.gemm(
                1.0,
                &by_joints.columns_range(own.dyads.clone()),
                &own.weights,
                0.0,
            );
        }
        all
    }

    /// 2 Re Jᴴ Σ⁻¹ e of all unknowns.
    pub(crate) fn descent(&self, count: usize, sums: &Slopes) -> DVector<f64> {
        let mut descent = DVector::zeros(count);
        for (own, &[stiffness, damping]) in self.of_joints.iter().zip(&self.places) {
            descent[stiffness] = -2.0 * own.sum(&sums.flat);
            descent[damping] = -2.0 * own.sum(&sums.tilted);
        }
        for (n, error) in self.of_set_up.iter().enumerate() {
            descent[self.first_error + n] = 2.0 * error.sum(&sums.flat);
        }
        descent
    }

    /// Eᵀ M E of sums over the dyads.
    pub(crate) fn products(&self, sums: DMatrixView<'_, Complex64>) -> DMatrix<Complex64> {
        let count = self.count();
        let mut products = DMatrix::zeros(count, count);
        let mut column = DVector::zeros(sums.nrows());
        for (mut own, pattern) in products.column_iter_mut().zip(self.each()) {
            column.fill(Complex64::ZERO);
            pattern.add_column(sums, column.as_view_mut());
            for (product, other) in own.iter_mut().zip(self.each()) {
                *product = other.of_sums(column.as_slice());
            }
        }
        products
    }

    /// M E.
    pub(crate) fn columns(&self, sums: DMatrixView<'_, Complex64>) -> DMatrix<Complex64> {
        let mut columns = DMatrix::zeros(sums.nrows(), self.count());
        for (column, pattern) in columns.column_iter_mut().zip(self.each()) {
            pattern.add_column(sums, column);
        }
        columns
    }

    fn count(&self) -> usize {
        self.of_joints.len() + self.of_set_up.len()
    }

    /// Eᵀ v.
    pub(crate) fn slopes(&self, sums: &DVector<Complex64>) -> DVector<Complex64> {
        let own = self.each().map(|pattern| pattern.of_sums(sums.as_slice()));
        DVector::from_iterator(self.count(), own)
    }
}

impl Pattern {
    /// Its column of M E.
    fn add_column(
        &self,
        sums: DMatrixView<'_, Complex64>,
        mut column: DVectorViewMut<'_, Complex64>,
    ) {
        for &(place, factor) in &self.0 {
            for (own, sum) in column.iter_mut().zip(sums.column(place).iter()) {
                *own += factor * sum;
            }
        }
    }

    fn of_sums(&self, sums: &[Complex64]) -> Complex64 {
        let terms = self.0.iter();
        terms.map(|&(place, factor)| factor * sums[place]).sum()
    }

    fn sum(&self, sums: &DVector<f64>) -> f64 {
        let terms = self.0.iter();
        terms.map(|&(place, factor)| factor * sums[place]).sum()
    }
}

/// Eᵀ M E′
fn combined(rows: &[Pattern], sums: &DMatrix<f64>, columns: &[Pattern]) -> DMatrix<f64> {
    let mut half = DMatrix::zeros(sums.nrows(), columns.len());
    for (l, column) in columns.iter().enumerate() {
        for &(place, factor) in &column.0 {
            half.column_mut(l).axpy(factor, &sums.column(place), 1.0);
        }
    }
    DMatrix::from_fn(rows.len(), columns.len(), |k, l| {
        let own = rows[k].0.iter();
        own.map(|&(place, factor)| factor * half[(place, l)]).sum()
    })
}

impl Normal {
    /// The information and descent of a line, by Jᴴ Σ⁻¹ J and Jᴴ Σ⁻¹ e of −J_k = a ∂K/∂k b and of the errors of the set-up: C's
    /// derivatives are jω times K's.
    pub(crate) fn add_line(
        &mut self,
        omega: f64,
        patterns: &Patterns,
        products: &DMatrix<Complex64>,
        slopes: &DVector<Complex64>,
    ) {
        let places = &patterns.places;
        let joints = places.len();
        for (k, &[stiffness, damping]) in places.iter().enumerate() {
            for (l, &[other, of_other]) in places.iter().enumerate() {
                let product = 2.0 * products[(k, l)];
                self.information[(stiffness, other)] += product.re;
                self.information[(stiffness, of_other)] -= omega * product.im;
                self.information[(damping, other)] += omega * product.im;
                self.information[(damping, of_other)] += omega * omega * product.re;
            }
            let slope = 2.0 * slopes[k];
            self.descent[stiffness] -= slope.re;
            self.descent[damping] -= omega * slope.im;
            for n in 0..patterns.of_set_up.len() {
                let product = -2.0 * products[(k, joints + n)];
                let place = patterns.first_error + n;
                for (own, value) in [(stiffness, product.re), (damping, omega * product.im)] {
                    self.information[(own, place)] += value;
                    self.information[(place, own)] += value;
                }
            }
        }
        let first = patterns.first_error;
        for n in 0..patterns.of_set_up.len() {
            for m in 0..patterns.of_set_up.len() {
                let product = products[(joints + n, joints + m)].re;
                self.information[(first + n, first + m)] += 2.0 * product;
            }
            self.descent[first + n] += 2.0 * slopes[joints + n].re;
        }
    }
}
