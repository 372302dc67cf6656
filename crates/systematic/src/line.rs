//! One line: what is left of the measurement, and how joint and causes move what is predicted.

mod block;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::budget::Prior;
use super::cause::{Cause, MeasuredSet, Side};
use super::coupling::{Coupled, DynamicStiffness, JointValues};
use super::effect::{At, Slopes};
use super::experiment::{Assembly, ComplexMatrix, Entry, Experiment, Structure};
use super::slope::PointSlopes;
use super::structures::Recomputations;

/// What does not change during a search.
pub(crate) struct Task<'t> {
    pub(crate) experiment: &'t Experiment<'t>,
    pub(crate) priors: &'t [Prior],
    slopes: Option<&'t [PointSlopes]>,
}

/// Joint and causes at one moment of the search.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    /// Stiffness of each unknown entry, then its damping; joint after joint.
    pub(crate) unknowns: Vec<f64>,
    /// Values of the causes.
    pub(crate) causes: Vec<f64>,
}

impl Point {
    pub(crate) fn moves(&mut self, step: &DVector<f64>) {
        let values = self.unknowns.iter_mut().chain(&mut self.causes);
        values.zip(step).for_each(|(value, step)| *value += step);
    }
}

/// Receptances of A's and of B's labels that are most likely at a line; empty for a structure that is not measured.
pub(crate) type Labelled = [Vec<Complex64>; 2];

/// The linearised line.
pub(crate) struct Terms {
    /// y − H^C(h₀), linearised at the present receptances
    pub(crate) residual: DVector<Complex64>,
    /// Derivative of what is predicted by each unknown, then by each cause.
    pub(crate) rows: DMatrix<Complex64>,
    /// Derivative of what is predicted by each labelled receptance of A, then of B.
    pub(crate) by_labelled: DMatrix<Complex64>,
    /// The labelled receptances as measured, without the causes.
    pub(crate) measured: Labelled,
    /// Their variances, A's and then B's.
    pub(crate) labelled_variance: Vec<f64>,
    /// How these move with the causes.
    pub(crate) measured_by_cause: [Vec<Option<Vec<Complex64>>>; 2],
    /// |H^C| at each entry
    pub(crate) magnitude: Vec<f64>,
    /// What smooth fits predict in place of that, beside it.
    pub(crate) apart: Vec<f64>,
}

impl<'t> Task<'t> {
    pub(crate) fn new(experiment: &'t Experiment<'t>, priors: &'t [Prior]) -> Self {
        Self {
            experiment,
            priors,
            slopes: experiment.slopes(),
        }
    }

    /// Measured structures without a smooth fit where causes need one.
    pub(crate) fn without_smooth_fit(&self) -> Vec<Side> {
        let is_without = |side: &Side| {
            let is_measured = matches!(self.experiment.side(*side), Structure::Measured(_));
            is_measured && !self.priors.is_empty() && self.experiment.fit(*side).is_none()
        };
        [Side::A, Side::B].into_iter().filter(is_without).collect()
    }

    pub(crate) fn unknowns(&self) -> usize {
        2 * self.experiment.joint.entries.len() * self.experiment.joints()
    }

    pub(crate) fn lines(&self) -> usize {
        self.experiment.omega.len()
    }

    /// R(ε) of each entry of a measured structure; 1 without a fit, and where an entry is not measured.
    pub(crate) fn ratios(&self, side: Side, line: usize, epsilon: f64) -> Vec<Complex64> {
        let moves = || self.experiment.fit(side).filter(|_| epsilon != 0.0);
        match moves() {
            Some(fit) => fit.ratios(line, self.experiment.omega[line], epsilon),
            None => vec![Complex64::from(1.0); self.experiment.labelled(side)],
        }
    }

    /// A structure's receptances at a line.
    pub(crate) fn formed(
        &self,
        side: Side,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<ComplexMatrix> {
        let dofs = self.experiment.joint.dofs_of_a_bolt;
        Some(match self.experiment.side(side) {
            Structure::Measured(measured) => measured.formed(
                dofs,
                side,
                (&labelled[side as usize], self.experiment.omega[line]),
                self.priors,
                &point.causes,
            ),
            Structure::Computed(_) => recomputed.side(side)?.receptances[line].clone(),
            Structure::Exact(matrices) => matrices[line].clone(),
        })
    }

    /// Receptances of both structures at a line.
    fn structures(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<[ComplexMatrix; 2]> {
        let formed = |side| self.formed(side, line, point, labelled, recomputed);
        Some([formed(Side::A)?, formed(Side::B)?])
    }

    /// The structures with the joint of an assembly between them.
    fn coupled(
        &self,
        assembly: &Assembly,
        line: usize,
        point: &Point,
        [a, b]: &[ComplexMatrix; 2],
    ) -> Option<Coupled> {
        let experiment = self.experiment;
        let omega = experiment.omega[line];
        let mut masses = experiment.known_masses.clone();
        for (prior, &value) in self.priors.iter().zip(&point.causes) {
            match prior.cause {
                Cause::JointMass(side, bolt) => masses.push((self.mass_dof(side, bolt), value)),
                Cause::JointInertia(side, bolt) => {
                    masses.push((self.mass_dof(side, bolt) + 1, value));
                }
                _ => {}
            }
        }
        let first = self.first_unknown(assembly);
        let joint = JointValues {
            unknowns: &point.unknowns[first..first + 2 * experiment.joint.entries.len()],
            loss_factor: self.loss_factor(point),
            masses: &masses,
        };
        Coupled::of(a, b, DynamicStiffness::of(&experiment.joint, &joint, omega))
    }

    /// Where the unknowns of an assembly's joint begin.
    fn first_unknown(&self, assembly: &Assembly) -> usize {
        2 * self.experiment.joint.entries.len() * assembly.joint
    }

    fn mass_dof(&self, side: Side, bolt: usize) -> usize {
        let joint = &self.experiment.joint;
        joint.translation(bolt) + if side == Side::B { joint.dofs } else { 0 }
    }

    fn loss_factor(&self, point: &Point) -> f64 {
        super::structures::value_of(Cause::LossFactor, self.priors, &point.causes)
    }

    pub(crate) fn at_assembly<'r>(
        &'r self,
        number: usize,
        coupled: &'r Coupled,
        line: usize,
    ) -> At<'r> {
        At {
            set: MeasuredSet::Assembly(number),
            functions: &self.experiment.assemblies[number].functions,
            truth: &coupled.receptance,
            omega: self.experiment.omega[line],
            slopes: self.slopes.map(|slopes| Slopes {
                of_points: &slopes[line],
                at_joint: &coupled.q,
            }),
        }
    }

    /// J: dH^C = v_p v_qᵀ + v_q v_pᵀ for a symmetric entry (p, q) of U, with V = Zᵀ W.
    fn by_labelled(&self, coupled: &Coupled, places: &[(usize, usize)]) -> DMatrix<Complex64> {
        let mut columns = Vec::new();
        for side in [Side::A, Side::B] {
            let Structure::Measured(measured) = self.experiment.side(side) else {
                continue;
            };
            let through = coupled.through(side == Side::A);
            let v = through.transpose() * measured.transformation.map(Complex64::from);
            for source in &measured.functions.entries {
                let (p, q) = source.place;
                columns.push(DVector::from_fn(places.len(), |e, _| {
                    let (row, column) = places[e];
                    let once = v[(row, p)] * v[(column, q)];
                    if p == q {
                        once
                    } else {
                        once + v[(row, q)] * v[(column, p)]
                    }
                }));
            }
        }
        if columns.is_empty() {
            DMatrix::zeros(places.len(), 0)
        } else {
            DMatrix::from_columns(&columns)
        }
    }

    /// Each assembly.
    pub(crate) fn assembled(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<Vec<Coupled>> {
        let structures = self.structures(line, point, labelled, recomputed)?;
        let assemblies = self.experiment.assemblies.iter();
        assemblies
            .map(|assembly| self.coupled(assembly, line, point, &structures))
            .collect()
    }

    /// What these receptances leave of the assemblies' functions without the causes, nothing linearised.
    pub(crate) fn left(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<DVector<Complex64>> {
        let assembled = self.assembled(line, point, labelled, recomputed)?;
        let mut left = Vec::new();
        for (number, coupled) in assembled.iter().enumerate() {
            let at = self.at_assembly(number, coupled, line);
            let beside = at.beside(self.priors, &point.causes);
            let factors = at.factors(self.priors, &point.causes);
            let entries = at.functions.entries.iter().zip(factors);
            for ((entry, factor), beside) in entries.zip(beside) {
                left.push(entry.values[line] / factor - beside - coupled.receptance[entry.place]);
            }
        }
        Some(DVector::from_vec(left))
    }

    /// Sum of squared residuals over their variances with these receptances, nothing linearised.
    pub(crate) fn cost(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<f64> {
        let left = self.left(line, point, labelled, recomputed)?;
        let entries = self.experiment.assembled();
        let of_entry =
            |(left, entry): (&Complex64, &Entry)| left.norm_sqr() / variance(entry, line);
        let mut cost: f64 = left.iter().zip(entries).map(of_entry).sum();
        let variances = self.labelled_variance(line, point, labelled);
        let mut variances = variances.iter();
        for side in [Side::A, Side::B] {
            let now = &labelled[side as usize];
            let clean = self.without_causes(side, line, point, now);
            for ((clean, now), variance) in clean.iter().zip(now).zip(&mut variances) {
                if *variance > 0.0 {
                    cost += (clean - now).norm_sqr() / variance;
                }
            }
        }
        cost.is_finite().then_some(cost)
    }
}

/// Numbers have no more digits than this: data without noise keep finite weights.
const ROUNDING: f64 = 1e-7;

/// Variance of an entry at a line; zero where it is not measured.
pub(crate) fn variance(entry: &Entry, line: usize) -> f64 {
    if entry.measurements.is_empty() {
        0.0
    } else {
        entry.variance[line].max(ROUNDING * ROUNDING * entry.values[line].norm_sqr())
    }
}
