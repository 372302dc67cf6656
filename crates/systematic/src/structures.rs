//! The structures at one moment of the search: formed from corrected functions, or computed anew with another material.

use nalgebra::DMatrix;
use num_complex::Complex64;
use rayon::prelude::*;

use super::bends::Beside;
use super::budget::Prior;
use super::cause::{Cause, Side};
use super::experiment::{Change, ComplexMatrix, Computed, Experiment, Structure};
use super::measured::Measured;

/// Part of a prior standard deviation over which a computed structure is differentiated.
const STEP: f64 = 0.02;

/// A computed structure with the present causes.
pub(crate) struct Recomputed {
    pub(crate) receptances: Vec<ComplexMatrix>,
    /// Derivative by each cause that changes it: number of the cause, value at each line.
    pub(crate) by_cause: Vec<(usize, Vec<ComplexMatrix>)>,
}

/// Both structures, where they are computed.
pub(crate) struct Recomputations {
    pub(crate) a: Option<Recomputed>,
    pub(crate) b: Option<Recomputed>,
}

impl Recomputations {
    /// `None` where a structure cannot be computed with these causes.
    pub(crate) fn of(
        experiment: &Experiment<'_>,
        priors: &[Prior],
        values: &[f64],
    ) -> Option<Self> {
        Self::each(experiment, |computed, side| {
            recomputed(computed, experiment, side, priors, values)
        })
    }

    /// The same without derivatives.
    pub(crate) fn values(
        experiment: &Experiment<'_>,
        priors: &[Prior],
        values: &[f64],
    ) -> Option<Self> {
        Self::each(experiment, |computed, side| {
            let change = change(experiment, side, priors, values);
            Some(Recomputed {
                receptances: computed.compute.receptances(&change)?,
                by_cause: Vec::new(),
            })
        })
    }

    fn each(
        experiment: &Experiment<'_>,
        of: impl Fn(&Computed<'_>, Side) -> Option<Recomputed>,
    ) -> Option<Self> {
        let side = |side: Side| match experiment.side(side) {
            Structure::Computed(computed) => of(computed, side).map(Some),
            _ => Some(None),
        };
        Some(Self {
            a: side(Side::A)?,
            b: side(Side::B)?,
        })
    }

    pub(crate) fn side(&self, side: Side) -> Option<&Recomputed> {
        match side {
            Side::A => self.a.as_ref(),
            Side::B => self.b.as_ref(),
        }
    }
}

fn recomputed(
    computed: &Computed<'_>,
    experiment: &Experiment<'_>,
    side: Side,
    priors: &[Prior],
    values: &[f64],
) -> Option<Recomputed> {
    let change = change(experiment, side, priors, values);
    let receptances = computed.compute.receptances(&change)?;
    let derivative = |(number, prior): (usize, &Prior)| {
        let step = STEP * prior.standard_deviation;
        let moved = |offset: f64| {
            let mut moved = values.to_vec();
            moved[number] += offset;
            self::change(experiment, side, priors, &moved)
        };
        let above = computed.compute.receptances(&moved(step))?;
        let below = computed.compute.receptances(&moved(-step))?;
        let pairs = above.iter().zip(&below);
        let slope = pairs.map(|(above, below)| (above - below) / Complex64::from(2.0 * step));
        Some((number, slope.collect::<Vec<_>>()))
    };
    let acting: Vec<(usize, &Prior)> = priors
        .iter()
        .enumerate()
        .filter(|(_, prior)| acts_on(experiment, prior.cause, side))
        .collect();
    let by_cause = acting.into_par_iter().filter_map(derivative).collect();
    Some(Recomputed {
        receptances,
        by_cause,
    })
}

/// Whether a cause changes a computed structure.
fn acts_on(experiment: &Experiment<'_>, cause: Cause, side: Side) -> bool {
    match cause {
        Cause::YoungsModulus(of)
        | Cause::Density(of)
        | Cause::StructureDamping(of)
        | Cause::JointPosition(of, _) => of == side,
        Cause::Position(point) => experiment.points_on(side).contains(&point),
        _ => false,
    }
}

fn change(experiment: &Experiment<'_>, side: Side, priors: &[Prior], values: &[f64]) -> Change {
    let points = experiment.points_on(side);
    let mut change = Change {
        joint_m: vec![0.0; experiment.joint.bolts()],
        points_m: vec![0.0; points.len()],
        ..Change::default()
    };
    for (prior, &value) in priors.iter().zip(values) {
        match prior.cause {
            Cause::YoungsModulus(of) if of == side => change.youngs_modulus = value,
            Cause::Density(of) if of == side => change.density = value,
            Cause::StructureDamping(of) if of == side => change.damping = value,
            Cause::JointPosition(of, bolt) if of == side => change.joint_m[bolt] = value,
            Cause::Position(point) if points.contains(&point) => {
                change.points_m[point - points.start] = value;
            }
            _ => {}
        }
    }
    change
}

impl Measured {
    /// H = W U Wᵀ at the joint and the points, with what the differences lack.
    pub(crate) fn as_measured(&self, labelled: &[Complex64]) -> ComplexMatrix {
        let whole = self.transformation.map(Complex64::from);
        let mut formed = &whole * self.functions.matrix(labelled) * whole.transpose();
        if let Some([correction, _]) = &self.correction {
            add_at_joint(&mut formed, correction);
        }
        formed
    }

    fn beside(&self, dofs_of_a_bolt: usize, bolt: usize, omega: f64) -> Beside {
        let bend = self.at_bolts.get(bolt).and_then(|at| at.bend.as_ref());
        Beside::new(bolt * dofs_of_a_bolt, bend, omega)
    }

    /// The same with the causes: EI of the correction, and the joint where it is.
    pub(crate) fn formed(
        &self,
        dofs_of_a_bolt: usize,
        side: Side,
        (labelled, omega): (&[Complex64], f64),
        priors: &[Prior],
        values: &[f64],
    ) -> ComplexMatrix {
        let mut formed = self.as_measured(labelled);
        if let Some([_, by_stiffness]) = &self.correction {
            let stiffness = value_of(Cause::DifferenceStiffness(side), priors, values);
            add_at_joint(&mut formed, &(by_stiffness * stiffness));
        }
        let spacing = value_of(Cause::DifferenceSpacing(side), priors, values);
        if spacing != 0.0 {
            for &theta in &self.differences {
                formed.row_mut(theta).scale_mut(1.0 + spacing);
                formed.column_mut(theta).scale_mut(1.0 + spacing);
            }
        }
        for (prior, &value) in priors.iter().zip(values) {
            match prior.cause {
                Cause::JointPosition(of, bolt) if of == side && value != 0.0 => {
                    self.beside(dofs_of_a_bolt, bolt, omega)
                        .shift(&mut formed, value);
                }
                Cause::JointBending(of, bolt) if of == side => {
                    let theta = bolt * dofs_of_a_bolt + 1;
                    formed[(theta, theta)] -= self.at_bolts[bolt].flexibility * value;
                }
                _ => {}
            }
        }
        formed
    }

    /// What a cause does to the formed receptances beyond what it does to the measured functions.
    pub(crate) fn formed_by_cause(
        &self,
        dofs_of_a_bolt: usize,
        side: Side,
        (formed, omega): (&ComplexMatrix, f64),
        (cause, value): (Cause, f64),
    ) -> Option<ComplexMatrix> {
        match cause {
            Cause::DifferenceStiffness(of) if of == side => {
                let [_, by_stiffness] = self.correction.as_ref()?;
                let mut change = ComplexMatrix::zeros(formed.nrows(), formed.ncols());
                add_at_joint(&mut change, by_stiffness);
                Some(change)
            }
            Cause::DifferenceSpacing(of) if of == side => {
                let mut change = ComplexMatrix::zeros(formed.nrows(), formed.ncols());
                for &theta in &self.differences {
                    for other in 0..formed.nrows() {
                        let own = formed[(theta, other)] / (1.0 + value);
                        change[(theta, other)] += own;
                        change[(other, theta)] += own;
                    }
                }
                Some(change)
            }
            Cause::JointPosition(of, bolt) if of == side => {
                Some(-self.beside(dofs_of_a_bolt, bolt, omega).displaced(formed))
            }
            Cause::JointBending(of, bolt) if of == side => {
                let mut change = ComplexMatrix::zeros(formed.nrows(), formed.ncols());
                let theta = bolt * dofs_of_a_bolt + 1;
                change[(theta, theta)] = Complex64::from(-self.at_bolts[bolt].flexibility);
                Some(change)
            }
            _ => None,
        }
    }
}

fn add_at_joint(formed: &mut ComplexMatrix, part: &DMatrix<f64>) {
    for i in 0..part.nrows() {
        for j in 0..part.ncols() {
            formed[(i, j)] += part[(i, j)];
        }
    }
}

/// Value of a cause; zero where it takes no part.
pub(crate) fn value_of(cause: Cause, priors: &[Prior], values: &[f64]) -> f64 {
    let found = priors.iter().position(|prior| prior.cause == cause);
    found.map_or(0.0, |index| values[index])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::{Entry, JointShape, MeasuredFunctions};

    /// A rotation by a central difference of three points, whose spacing is not what it is said to be: θ = (y₃ − y₁)/2s.
    #[test]
    fn a_spacing_scales_what_is_divided_by_it() {
        let joint = JointShape {
            dofs: 2,
            dofs_of_a_bolt: 2,
            entries: vec![vec![(0, 0)], vec![(0, 1)], vec![(1, 1)]],
        };
        let places: Vec<_> = (0..3).flat_map(|j| (0..=j).map(move |i| (i, j))).collect();
        let entry = |&place: &(usize, usize)| Entry {
            place,
            measurements: vec![place],
            values: Vec::new(),
            variance: Vec::new(),
        };
        let functions = || MeasuredFunctions {
            is_translation: vec![true; 3],
            positions_m: Vec::new(),
            entries: places.iter().map(entry).collect(),
        };
        let labelled: Vec<Complex64> = (1..=6)
            .map(|n| Complex64::new(f64::from(n * n), -0.3 * f64::from(n)))
            .collect();
        let of_spacing = |spacing_m: f64| {
            let by = 0.5 / spacing_m;
            let rows = DMatrix::from_row_slice(2, 3, &[0.0, 1.0, 0.0, -by, 0.0, by]);
            Measured::new(functions(), rows, None, Some(30.0), &joint)
        };
        let stated = of_spacing(0.015);
        assert_eq!(stated.differences, [1]);
        let cause = Cause::DifferenceSpacing(Side::A);
        let priors = [Prior {
            cause,
            standard_deviation: 0.01,
            centre: 0.0,
        }];
        let formed = |value: f64| stated.formed(2, Side::A, (&labelled, 100.0), &priors, &[value]);
        // points that lie 2 % nearer to each other than they are said to have rotated 2 % more
        let (own, nearer) = (
            formed(0.02),
            of_spacing(0.015 / 1.02).as_measured(&labelled),
        );
        assert!((&own - nearer).norm() < 1e-12 * own.norm());
        let slope = stated.formed_by_cause(2, Side::A, (&own, 100.0), (cause, 0.02));
        let expected = (formed(0.021) - formed(0.019)) / Complex64::from(2e-3);
        assert!((slope.unwrap() - &expected).norm() < 1e-9 * expected.norm());
    }
}
