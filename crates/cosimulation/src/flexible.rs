//! Joint elements between flexible structures that integrate themselves exactly under the loads of a step.
//!
//! No estimate by masses decides here, nor one by 2c/k: the first falls with every mode that is kept, and both together are not
//! safe. What decides is the spectral radius of one exact step of structures and joints.

use std::f64::consts::TAU;

use bolted_joint_assembly::{AssemblyError, AssemblyModel, ModalForm};
use bolted_joint_frf::Dof;
use bolted_joint_joint::Joint;
use nalgebra::{DMatrix, RowDVector, Schur, SymmetricEigen};

use super::element::{all_tangents, check_count};
use super::{CouplingError, StepBound};

/// How the loads of a step follow from the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadOfStep {
    /// Read at the beginning and held.
    Held,
    /// Read at the beginning of the step before and held: what masters do that exchange values after all have stepped.
    Late,
    /// That of the motion at the end, held: implicit.
    End,
    /// That of the mean motion, held: implicit. The energy of a linear passive joint and its structures does not grow.
    Mean,
}

impl LoadOfStep {
    /// Those that have a bound.
    pub const BOUNDED: [Self; 3] = [Self::Held, Self::Late, Self::End];
}

/// Structures in coordinates of unit mass, and the linear joints between them.
#[derive(Debug, Clone)]
pub struct Flexible {
    /// ω of each coordinate, rad/s.
    frequency_rad_per_s: Vec<f64>,
    /// C between the coordinates, 1/s.
    damping_per_s: DMatrix<f64>,
    /// S: relative motions of all joints (rows) by coordinates.
    relative: DMatrix<f64>,
    /// K of all joints.
    stiffness: DMatrix<f64>,
    /// C of all joints.
    damping: DMatrix<f64>,
}

/// Ratio of neighbouring steps in the search.
const RATIO: f64 = 1.04;
/// Steps that are looked at, at most.
const LOOKS: usize = 400;
/// Relative width at which the bisection stops.
const WIDTH: f64 = 1e-6;
/// Part of the estimate at which the search begins.
const BEGIN: f64 = 0.1;
/// By how much a radius may be above one before motion counts as growing: what rounding does in a matrix exponential.
const SLACK: f64 = 1e-9;
/// Periods of the slowest elastic coordinate up to which is looked.
const PERIODS: f64 = 10.0;
/// Part of the largest below which a direction is rounding.
const ROUNDING: f64 = 1e-12;

impl Flexible {
    /// All structures and joints of an assembly, the joints for small motion about rest. Of an assembly without joints all
    /// motion is common, and nothing bounds the step.
    ///
    /// # Errors
    /// [`AssemblyError`] where a joint gives no law.
    pub fn of(model: &AssemblyModel) -> Result<Self, AssemblyError> {
        let equations = model.equations()?;
        let size = equations.size();
        let rows: usize = model
            .joints
            .iter()
            .map(|own| own.file.joint.dofs.count())
            .sum();
        let mut found = Self {
            frequency_rad_per_s: equations.frequencies_rad_per_s.clone(),
            damping_per_s: DMatrix::from_fn(size, size, |i, j| equations.damping_per_s[(i, j)]),
            relative: DMatrix::zeros(rows, size),
            stiffness: DMatrix::zeros(rows, rows),
            damping: DMatrix::zeros(rows, rows),
        };
        let mut first = 0;
        for (joint, own) in model.joints.iter().zip(&equations.joints) {
            let (stiffness, damping) = joint.of_small_motion_about(0.0)?;
            let count = stiffness.nrows();
            let relative = DMatrix::from_fn(count, size, |i, j| own.relative[(i, j)]);
            found
                .relative
                .view_mut((first, 0), (count, size))
                .copy_from(&relative);
            found
                .stiffness
                .view_mut((first, first), (count, count))
                .copy_from(&stiffness);
            found
                .damping
                .view_mut((first, first), (count, count))
                .copy_from(&damping);
            first += count;
        }
        Ok(found.without_common_motion())
    }

    /// A joint between two structures, or one and what does not move; one for each place within the amplitude of the relative
    /// motion (m, rad) at which a nonlinear joint is stiffest or softest, rest first. Each structure has a point for every degree
    /// of freedom of the joint.
    ///
    /// # Errors
    /// [`CouplingError`] where the joint has no such matrices, or points are missing.
    pub fn between(
        joint: &Joint,
        neighbours: [Option<(&ModalForm, &[Dof])>; 2],
        amplitude: Option<&[f64]>,
    ) -> Result<Vec<Self>, CouplingError> {
        let dofs = joint.dofs.count();
        let size = neighbours
            .iter()
            .flatten()
            .map(|(form, _)| form.size())
            .sum();
        let mut structures = Self {
            frequency_rad_per_s: Vec::with_capacity(size),
            damping_per_s: DMatrix::zeros(size, size),
            relative: DMatrix::zeros(dofs, size),
            stiffness: DMatrix::zeros(dofs, dofs),
            damping: DMatrix::zeros(dofs, dofs),
        };
        for (neighbour, sign) in neighbours.into_iter().zip([1.0, -1.0]) {
            if let Some((form, points)) = neighbour {
                check_count(points.len(), dofs)?;
                structures.add(form, points, sign)?;
            }
        }
        let structures = structures.without_common_motion();
        let tangents = all_tangents(joint, amplitude)?.into_iter();
        let with = tangents.map(|own| Self {
            stiffness: own.stiffness,
            damping: own.damping,
            ..structures.clone()
        });
        Ok(with.collect())
    }

    /// Adds a structure whose points move the joint so: x_a − x_b.
    fn add(&mut self, form: &ModalForm, points: &[Dof], sign: f64) -> Result<(), CouplingError> {
        let (first, count) = (self.frequency_rad_per_s.len(), form.size());
        let mut block = self.damping_per_s.view_mut((first, first), (count, count));
        block.copy_from(&form.damping_per_s);
        self.frequency_rad_per_s
            .extend(form.frequency_rad_per_s.iter());
        for (i, &point) in points.iter().enumerate() {
            let row = form.row(point).ok_or_else(|| CouplingError::NoPoint {
                found: point.to_string(),
                there: form.points.iter().map(Dof::to_string).collect(),
            })?;
            self.relative
                .view_mut((i, first), (1, count))
                .copy_from(&(row * sign));
        }
        Ok(())
    }

    /// Takes out free motions that no joint sees: with a double eigenvalue at 1, their radius is noise.
    fn without_common_motion(self) -> Self {
        let size = self.frequency_rad_per_s.len();
        let is_free = |i: &usize| {
            self.frequency_rad_per_s[*i] == 0.0 && self.damping_per_s.row(*i).amax() == 0.0
        };
        let free: Vec<usize> = (0..size).filter(is_free).collect();
        let others: Vec<usize> = (0..size).filter(|i| !is_free(i)).collect();
        if free.is_empty() {
            return self;
        }
        let seen = self.relative.select_columns(&free);
        // rows of one size: translations and rotations have units of their own
        let rows: Vec<RowDVector<f64>> = seen
            .row_iter()
            .map(|row| row / row.norm().max(f64::MIN_POSITIVE))
            .collect();
        let scaled = match rows.is_empty() {
            true => DMatrix::zeros(0, free.len()),
            false => DMatrix::from_rows(&rows),
        };
        let eigen = SymmetricEigen::new(scaled.transpose() * &scaled);
        let kept: Vec<usize> = (0..free.len())
            .filter(|&i| eigen.eigenvalues[i] > ROUNDING)
            .collect();
        let turned = seen * eigen.eigenvectors.select_columns(&kept);
        let (count, elastic) = (kept.len(), others.len());
        let mut relative = DMatrix::zeros(self.relative.nrows(), count + elastic);
        relative
            .view_mut((0, 0), (turned.nrows(), count))
            .copy_from(&turned);
        relative
            .view_mut((0, count), (self.relative.nrows(), elastic))
            .copy_from(&self.relative.select_columns(&others));
        let mut damping = DMatrix::zeros(count + elastic, count + elastic);
        let own = self
            .damping_per_s
            .select_rows(&others)
            .select_columns(&others);
        damping
            .view_mut((count, count), (elastic, elastic))
            .copy_from(&own);
        let frequencies = others.iter().map(|&i| self.frequency_rad_per_s[i]);
        Self {
            frequency_rad_per_s: std::iter::repeat_n(0.0, count).chain(frequencies).collect(),
            damping_per_s: damping,
            relative,
            ..self
        }
    }

    /// Spectral radius of one communication step.
    #[must_use]
    pub fn radius(&self, load: LoadOfStep, step_s: f64) -> f64 {
        self.map(load, step_s)
            .filter(|map| map.iter().all(|entry| entry.is_finite()))
            .and_then(|map| Schur::try_new(map, f64::EPSILON, 100_000))
            .map_or(f64::INFINITY, |schur| {
                let values = schur.complex_eigenvalues();
                values.iter().map(|value| value.norm()).fold(0.0, f64::max)
            })
    }

    /// One step of (D q, q̇), D = diag max(ω, ω_ref), and of the load of the step before where that counts.
    fn map(&self, load: LoadOfStep, step_s: f64) -> Option<DMatrix<f64>> {
        let (size, dofs) = (self.frequency_rad_per_s.len(), self.relative.nrows());
        let reference = self.reference();
        let scale: Vec<f64> = self
            .frequency_rad_per_s
            .iter()
            .map(|own| own.max(reference))
            .collect();
        let mut generator = DMatrix::zeros(2 * size + dofs, 2 * size + dofs);
        for i in 0..size {
            generator[(i, size + i)] = scale[i] * step_s;
            generator[(size + i, i)] = -self.frequency_rad_per_s[i].powi(2) / scale[i] * step_s;
        }
        generator
            .view_mut((size, size), (size, size))
            .copy_from(&(&self.damping_per_s * -step_s));
        // what the loads on the joints do to the structures: −Sᵀ
        generator
            .view_mut((size, 2 * size), (size, dofs))
            .copy_from(&(self.relative.transpose() * -step_s));
        let whole = generator.exp();
        let free = whole.view((0, 0), (2 * size, 2 * size)).into_owned();
        let by_load = whole.view((0, 2 * size), (2 * size, dofs)).into_owned();
        let [mut motion, mut rate] = [
            DMatrix::zeros(dofs, 2 * size),
            DMatrix::zeros(dofs, 2 * size),
        ];
        for i in 0..size {
            motion.set_column(i, &(self.relative.column(i) / scale[i]));
            rate.set_column(size + i, &self.relative.column(i));
        }
        let one = DMatrix::identity(2 * size, 2 * size);
        let at_once = &self.stiffness * &motion + &self.damping * &rate;
        match load {
            LoadOfStep::Held => Some(free + by_load * at_once),
            LoadOfStep::End => (one - &by_load * at_once).lu().solve(&free),
            LoadOfStep::Mean => {
                // f = K (r₀ + r₁)/2 + C (r₁ − r₀)/H
                let spring = &self.stiffness * &motion * 0.5;
                let damper = &self.damping * &motion / step_s;
                let before = free + &by_load * (&spring - &damper);
                (one - by_load * (spring + damper)).lu().solve(&before)
            }
            LoadOfStep::Late => {
                let mut map = DMatrix::zeros(2 * size + dofs, 2 * size + dofs);
                // the load by the largest of its parts, so that all entries are of one size
                let unit = at_once.amax().max(f64::MIN_POSITIVE);
                map.view_mut((0, 0), (2 * size, 2 * size)).copy_from(&free);
                map.view_mut((0, 2 * size), (2 * size, dofs))
                    .copy_from(&(by_load * unit));
                map.view_mut((2 * size, 0), (dofs, 2 * size))
                    .copy_from(&(at_once / unit));
                Some(map)
            }
        }
    }

    /// The frequency that stands in for that of free motion, rad/s.
    fn reference(&self) -> f64 {
        let elastic = self
            .frequency_rad_per_s
            .iter()
            .copied()
            .filter(|&own| own > 0.0);
        elastic
            .reduce(f64::min)
            .unwrap_or_else(|| self.contact_rate())
    }

    /// √λmax(S Sᵀ K), rad/s: how fast the joints let the structures swing against each other at the most.
    fn contact_rate(&self) -> f64 {
        let square = (&self.relative * self.relative.transpose() * &self.stiffness).norm();
        square.sqrt().max(1.0)
    }

    /// The longest step below which motion does not grow, as far as steps of a ratio of 1.04 tell.
    #[must_use]
    pub fn bound(&self, load: LoadOfStep) -> StepBound {
        if self.relative.amax() == 0.0 || self.stiffness.amax().max(self.damping.amax()) == 0.0 {
            return StepBound::Nothing;
        }
        let is_stable = |step_s: f64| self.radius(load, step_s) <= 1.0 + SLACK;
        let elastic = self
            .frequency_rad_per_s
            .iter()
            .copied()
            .filter(|&own| own > 0.0);
        let slowest = elastic
            .reduce(f64::min)
            .unwrap_or_else(|| self.contact_rate());
        let longest = PERIODS * TAU / slowest;
        let estimate = self.estimate_s().unwrap_or(f64::INFINITY);
        let mut stable = (BEGIN * estimate).min(0.01 / self.contact_rate());
        if !is_stable(stable) {
            return StepBound::Never;
        }
        for _ in 0..LOOKS {
            let next = stable * RATIO;
            if next > longest {
                break;
            }
            if !is_stable(next) {
                let mut unstable = next;
                while unstable - stable > WIDTH * stable {
                    let middle = 0.5 * (stable + unstable);
                    match is_stable(middle) {
                        true => stable = middle,
                        false => unstable = middle,
                    }
                }
                return StepBound::Below(stable);
            }
            stable = next;
        }
        StepBound::NotBelow(stable)
    }

    /// A step that explicit coupling with the held load has borne in every case that was tried, without a proof; `None` where
    /// the joints' damping pays for no delay: 1/H = 1/H_t + 1/(2 λmin(M, C)), H_t = min 2 atan(ω λ)/ω, λ = λmin(C, K).
    #[must_use]
    pub fn estimate_s(&self) -> Option<f64> {
        let by_stiffness = smallest(&self.damping, &self.stiffness)?;
        let mobility = &self.relative * self.relative.transpose();
        // λmin(M, C) = 1/λmax(M⁻¹ C)
        let by_mass = Schur::try_new(&mobility * &self.damping, f64::EPSILON, 10_000)?;
        let largest = by_mass
            .complex_eigenvalues()
            .iter()
            .map(|own| own.re)
            .fold(0.0, f64::max);
        let delays = self
            .frequency_rad_per_s
            .iter()
            .map(|&omega| match omega > 0.0 {
                true => 2.0 * (omega * by_stiffness).atan() / omega,
                false => 2.0 * by_stiffness,
            });
        let delay = delays.fold(f64::INFINITY, f64::min);
        let step_s = (1.0 / delay + 0.5 * largest).recip();
        (step_s.is_finite() && step_s > 0.0).then_some(step_s)
    }
}

/// The smallest λ of C x = λ K x with K positive definite; `None` where it is not, or λ is not above zero, or there is no joint.
fn smallest(damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Option<f64> {
    // an empty matrix has no eigenvalues, which the library does not bear
    if stiffness.is_empty() {
        return None;
    }
    let root = stiffness.clone().cholesky()?.l();
    let half = root.solve_lower_triangular(damping)?;
    let whole = root.solve_lower_triangular(&half.transpose())?;
    let least = SymmetricEigen::new(whole).eigenvalues.min();
    (least > 0.0).then_some(least)
}

#[cfg(test)]
mod tests {
    use super::{Flexible, LoadOfStep};
    use crate::StepBound;
    use nalgebra::{DMatrix, dmatrix};

    /// A of one mode and B rigid: ω = 800, ζ = 0.02, φ = 1.2; 0.5 kg; r = √2 q_B − 1.2 q_A.
    fn small(damping_ratio: f64) -> Flexible {
        Flexible {
            frequency_rad_per_s: vec![800.0, 0.0],
            damping_per_s: DMatrix::from_row_slice(
                2,
                2,
                &[2.0 * damping_ratio * 800.0, 0.0, 0.0, 0.0],
            ),
            relative: dmatrix![-1.2, 2f64.sqrt()],
            stiffness: dmatrix![4e5],
            damping: dmatrix![20.0],
        }
    }

    #[test]
    fn the_bound_of_a_held_load_is_that_of_an_independent_program() {
        // computed by NumPy and SciPy from the same equations
        let StepBound::Below(found) = small(0.02).bound(LoadOfStep::Held) else {
            panic!("expected a bound");
        };
        assert!((found / 1.3173856697e-4 - 1.0).abs() < 2e-6, "{found}");
        // neither 2c/k = 1e-4 nor 2μ/c = 2.9e-2 is it
        assert!(small(0.02).estimate_s().is_some_and(|step| step < found));
    }

    #[test]
    fn rigid_neighbours_have_the_bound_of_the_formula() {
        // two masses of 1 kg on one coordinate of relative motion: μ = 0.5 kg
        let rigid = |stiffness: f64, damping: f64| Flexible {
            frequency_rad_per_s: vec![0.0],
            damping_per_s: DMatrix::zeros(1, 1),
            relative: dmatrix![2f64.sqrt()],
            stiffness: dmatrix![stiffness],
            damping: dmatrix![damping],
        };
        for (stiffness, damping) in [(1e6, 10.0), (1e4, 1e3)] {
            let expected = f64::min(2.0 * damping / stiffness, 2.0 * 0.5 / damping);
            let StepBound::Below(found) = rigid(stiffness, damping).bound(LoadOfStep::Held) else {
                panic!("expected a bound");
            };
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        }
        assert_eq!(rigid(1e6, 0.0).bound(LoadOfStep::Held), StepBound::Never);
    }

    #[test]
    fn the_mean_load_is_stable_at_any_step() {
        for step_s in [1e-6, 1e-4, 1e-3, 1e-2, 1.0] {
            let radius = small(0.0).radius(LoadOfStep::Mean, step_s);
            assert!(radius <= 1.0 + 1e-9, "{step_s}: {radius}");
        }
    }

    #[test]
    fn without_a_joint_nothing_bounds_the_step() {
        let apart = Flexible {
            frequency_rad_per_s: vec![0.0, 800.0],
            damping_per_s: DMatrix::zeros(2, 2),
            relative: DMatrix::zeros(0, 2),
            stiffness: DMatrix::zeros(0, 0),
            damping: DMatrix::zeros(0, 0),
        };
        let apart = apart.without_common_motion();
        for load in LoadOfStep::BOUNDED {
            assert_eq!(apart.bound(load), StepBound::Nothing);
        }
        assert_eq!(apart.estimate_s(), None);
    }

    #[test]
    fn free_motion_in_common_is_left_out() {
        let pair = Flexible {
            frequency_rad_per_s: vec![0.0, 0.0],
            damping_per_s: DMatrix::zeros(2, 2),
            relative: dmatrix![1.0, -1.0],
            stiffness: dmatrix![1e6],
            damping: dmatrix![10.0],
        };
        let reduced = pair.without_common_motion();
        assert_eq!(reduced.frequency_rad_per_s.len(), 1);
        assert!((reduced.relative[(0, 0)].abs() - 2f64.sqrt()).abs() < 1e-12);
    }
}
