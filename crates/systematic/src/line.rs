//! One line: what is left of the measurement, and how joint and causes move what is predicted.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::budget::Prior;
use super::cause::{Cause, MeasuredSet, Side};
use super::coupling::{Coupled, DynamicStiffness, JointValues};
use super::effect::{At, slopes};
use super::experiment::{ComplexMatrix, Entry, Experiment, Structure};
use super::structures::Recomputations;

/// What does not change during a search.
pub(crate) struct Task<'t> {
    pub(crate) experiment: &'t Experiment<'t>,
    pub(crate) priors: &'t [Prior],
    slopes: Option<DMatrix<f64>>,
}

/// Joint and causes at one moment of the search.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    /// Stiffness of each unknown entry, then its damping.
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
}

impl<'t> Task<'t> {
    pub(crate) fn new(experiment: &'t Experiment<'t>, priors: &'t [Prior]) -> Self {
        let positions_m = experiment.assembly.positions_m.as_ref();
        let is_computed = matches!(experiment.b, Structure::Computed(_));
        Self {
            experiment,
            priors,
            slopes: positions_m
                .filter(|_| !is_computed)
                .map(|positions_m| slopes(positions_m)),
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
        2 * self.experiment.joint.entries.len()
    }

    pub(crate) fn lines(&self) -> usize {
        self.experiment.omega.len()
    }

    /// R(ε) of an entry of a measured structure; 1 without a fit.
    pub(crate) fn ratio(&self, side: Side, line: usize, entry: usize, epsilon: f64) -> Complex64 {
        let fit = self.experiment.fit(side);
        let omega = self.experiment.omega[line];
        fit.map_or(Complex64::from(1.0), |fit| fit.ratio(entry, omega, epsilon))
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
                &labelled[side as usize],
                self.priors,
                &point.causes,
            ),
            Structure::Computed(_) => recomputed.side(side)?.receptances[line].clone(),
            Structure::Exact(matrices) => matrices[line].clone(),
        })
    }

    fn coupled(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<(ComplexMatrix, ComplexMatrix, Coupled)> {
        let experiment = self.experiment;
        let omega = experiment.omega[line];
        let mut masses = experiment.known_masses.clone();
        let mut loss_factor = 0.0;
        for (prior, &value) in self.priors.iter().zip(&point.causes) {
            match prior.cause {
                Cause::JointMass(side, bolt) => masses.push((self.mass_dof(side, bolt), value)),
                Cause::JointInertia(side, bolt) => {
                    masses.push((self.mass_dof(side, bolt) + 1, value));
                }
                Cause::LossFactor => loss_factor = value,
                _ => {}
            }
        }
        let joint = JointValues {
            unknowns: &point.unknowns,
            loss_factor,
            masses: &masses,
        };
        let stiffness = DynamicStiffness::of(&experiment.joint, &joint, omega);
        let a = self.formed(Side::A, line, point, labelled, recomputed)?;
        let b = self.formed(Side::B, line, point, labelled, recomputed)?;
        let coupled = Coupled::of(&a, &b, stiffness)?;
        Some((a, b, coupled))
    }

    fn mass_dof(&self, side: Side, bolt: usize) -> usize {
        let joint = &self.experiment.joint;
        joint.translation(bolt) + if side == Side::B { joint.dofs } else { 0 }
    }

    /// Linearises a line; `None` where the assembly is singular.
    pub(crate) fn terms(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<Terms> {
        let experiment = self.experiment;
        let omega = experiment.omega[line];
        let own = self.coupled(line, point, labelled, recomputed)?;
        let coupled = &own.2;
        let entries = &experiment.assembly.entries;
        let measured = [Side::A, Side::B]
            .map(|side| self.without_causes(side, line, point, &labelled[side as usize]));
        // Derivatives by the causes come from smooth receptances: from noisy ones the noise would be read as information.
        let smooth = self.smooth(line, point, labelled);
        let of_smooth = match self.priors {
            [] => None,
            _ => Some(self.coupled(line, point, &smooth, recomputed)?),
        };
        let (smooth_a, smooth_b, smooth_coupled) = of_smooth.as_ref().unwrap_or(&own);
        let smooth_at = self.at_assembly(&smooth_coupled.receptance, omega);
        let chain = smooth_at.by_truth(self.priors, &point.causes);
        let mut places: Vec<(usize, usize)> = entries.iter().map(|entry| entry.place).collect();
        if chain.is_some() {
            places.extend((0..experiment.assembly.labels()).map(|label| (label, label)));
        }
        let chained = |changes: DMatrix<Complex64>| match &chain {
            Some(chain) => chain * changes,
            None => changes,
        };
        let smooth_by_labelled = chained(self.by_labelled(smooth_coupled, &places));
        let measured_by_cause = [Side::A, Side::B]
            .map(|side| self.by_causes(side, line, point, &smooth[side as usize]));
        let by_labelled = chained(self.by_labelled(coupled, &places));
        let at = self.at_assembly(&coupled.receptance, omega);
        let beside = at.beside(self.priors, &point.causes);
        let shift: Vec<Complex64> = (0..2)
            .flat_map(|side| {
                measured[side]
                    .iter()
                    .zip(&labelled[side])
                    .map(|(clean, now)| clean - now)
            })
            .collect();
        let moved = &by_labelled * DVector::from_vec(shift);
        let residual = DVector::from_fn(entries.len(), |e, _| {
            let entry = &entries[e];
            let clean =
                entry.values[line] / at.factor(entry, self.priors, &point.causes) - beside[e];
            clean - coupled.receptance[entry.place] - moved[e]
        });
        let count = experiment.joint.entries.len();
        let mut rows = DMatrix::zeros(places.len(), 2 * count + self.priors.len());
        for (t, of) in experiment.joint.entries.iter().enumerate() {
            for (e, place) in places.iter().enumerate() {
                let by = coupled.by_stiffness(of, *place);
                // K* = K (1 + jη) + jωC
                rows[(e, t)] = by * Complex64::new(1.0, self.loss_factor(point));
                rows[(e, count + t)] = by * Complex64::new(0.0, omega);
            }
        }
        for (number, prior) in self.priors.iter().enumerate() {
            let column = 2 * count + number;
            let mut add = |change: &ComplexMatrix| {
                for (e, place) in places.iter().enumerate() {
                    rows[(e, column)] += change[*place];
                }
            };
            match prior.cause {
                Cause::LossFactor => add(&smooth_coupled.by_loss_factor()),
                Cause::JointMass(side, bolt) => {
                    add(&smooth_coupled.by_mass(self.mass_dof(side, bolt), omega))
                }
                Cause::JointInertia(side, bolt) => {
                    add(&smooth_coupled.by_mass(self.mass_dof(side, bolt) + 1, omega))
                }
                _ => {}
            }
            for side in [Side::A, Side::B] {
                let formed = if side == Side::A { smooth_a } else { smooth_b };
                let direct = match experiment.side(side) {
                    Structure::Measured(measured) => measured.formed_by_cause(
                        experiment.joint.dofs_of_a_bolt,
                        side,
                        formed,
                        prior.cause,
                    ),
                    Structure::Computed(_) => {
                        let all = recomputed
                            .side(side)
                            .map(|side| side.by_cause.as_slice())
                            .unwrap_or_default();
                        all.iter()
                            .find(|(of, _)| *of == number)
                            .map(|(_, slope)| slope[line].clone())
                    }
                    Structure::Exact(_) => None,
                };
                if let Some(direct) = direct {
                    add(&smooth_coupled.by_structure(side == Side::A, &direct));
                }
            }
        }
        let mut rows = chained(rows);
        for (number, prior) in self.priors.iter().enumerate() {
            let column = 2 * count + number;
            if let Some(by) = smooth_at.by_cause(prior.cause, point.causes[number]) {
                for (e, by) in by.into_iter().enumerate() {
                    rows[(e, column)] += by;
                }
            }
            let mut first = 0;
            for side in 0..2 {
                if let Some(by) = &measured_by_cause[side][number] {
                    for (s, by) in by.iter().enumerate() {
                        for e in 0..entries.len() {
                            rows[(e, column)] += smooth_by_labelled[(e, first + s)] * by;
                        }
                    }
                }
                first += labelled[side].len();
            }
        }
        Some(Terms {
            residual,
            rows,
            by_labelled,
            labelled_variance: self.labelled_variance(line, point, &smooth),
            measured,
            measured_by_cause,
            magnitude: std::iter::zip(entries, beside)
                .map(|(entry, beside)| (coupled.receptance[entry.place] + beside).norm())
                .collect(),
        })
    }

    fn loss_factor(&self, point: &Point) -> f64 {
        super::structures::value_of(Cause::LossFactor, self.priors, &point.causes)
    }

    fn at_assembly<'r>(&'r self, receptance: &'r ComplexMatrix, omega: f64) -> At<'r> {
        At {
            set: MeasuredSet::Assembly,
            functions: &self.experiment.assembly,
            truth: receptance,
            omega,
            slopes: self.slopes.as_ref(),
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

    /// Sum of squared residuals over their variances with these receptances, nothing linearised.
    pub(crate) fn cost(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        recomputed: &Recomputations,
    ) -> Option<f64> {
        let experiment = self.experiment;
        let (_, _, coupled) = self.coupled(line, point, labelled, recomputed)?;
        let at = self.at_assembly(&coupled.receptance, experiment.omega[line]);
        let beside = at.beside(self.priors, &point.causes);
        let mut cost = 0.0;
        for (entry, beside) in experiment.assembly.entries.iter().zip(beside) {
            let clean = entry.values[line] / at.factor(entry, self.priors, &point.causes) - beside;
            cost += (clean - coupled.receptance[entry.place]).norm_sqr() / variance(entry, line);
        }
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
