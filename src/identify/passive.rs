//! The estimate within the cone of passive joints, K = LLᵀ and C = LLᵀ.
//!
//! Where the free estimate is passive it is this one. Else the minimum lies on the cone's boundary: a factor L with fewer
//! columns, K = l lᵀ or less. There L's own derivatives stay regular, which those of a full L would not as a column
//! vanishes. Each face of the cone is searched, and the lowest minimum whose other matrix is passive is the estimate.

use nalgebra::{DMatrix, DVector};

use super::estimator::{Chart, Estimate, estimate};
use super::model::{JointMatrices, JointModel};
use super::noise::Noise;
use super::objective::Objective;

/// Part of the boundary of the cone of one matrix.
#[derive(Clone, Debug, PartialEq)]
enum Face {
    /// The matrix as it is: the inside of the cone, if it is passive.
    Free,
    /// l lᵀ
    RankOne,
    /// Only these entries of the joint model, the others being zero.
    Only(Vec<usize>),
}

impl Face {
    /// The faces of a matrix of this joint model beside its inside.
    fn of(model: JointModel) -> Vec<Self> {
        match model {
            JointModel::Translation => vec![Self::Only(Vec::new())],
            JointModel::Diagonal => vec![
                Self::Only(vec![0]),
                Self::Only(vec![1]),
                Self::Only(Vec::new()),
            ],
            JointModel::Full => vec![Self::RankOne, Self::Only(Vec::new())],
        }
    }

    fn dimension(&self, entries: usize) -> usize {
        match self {
            Self::Free => entries,
            Self::RankOne => 2,
            Self::Only(kept) => kept.len(),
        }
    }

    fn values(&self, x: &[f64], entries: usize) -> Vec<f64> {
        match self {
            Self::Free => x.to_vec(),
            Self::RankOne => vec![x[0] * x[0], x[0] * x[1], x[1] * x[1]],
            Self::Only(kept) => {
                let mut values = vec![0.0; entries];
                for (&index, &value) in kept.iter().zip(x) {
                    values[index] = value;
                }
                values
            }
        }
    }

    /// ∂(entry)/∂(coordinate)
    fn derivative(&self, x: &[f64], entry: usize, coordinate: usize) -> f64 {
        match self {
            Self::Free => f64::from(u8::from(entry == coordinate)),
            Self::RankOne => {
                [[2.0 * x[0], 0.0], [x[1], x[0]], [0.0, 2.0 * x[1]]][entry][coordinate]
            }
            Self::Only(kept) => f64::from(u8::from(kept[coordinate] == entry)),
        }
    }

    /// Coordinates of the face near a matrix that may lie off it.
    fn near(&self, values: &[f64]) -> Vec<f64> {
        match self {
            Self::Free => values.to_vec(),
            // With one column of L as long as the diagonal says, and the sign of the coupling.
            Self::RankOne => vec![
                values[0].abs().sqrt(),
                values[2].abs().sqrt() * values[1].signum(),
            ],
            Self::Only(kept) => kept.iter().map(|&index| values[index].max(0.0)).collect(),
        }
    }
}

/// A face for the stiffness and one for the damping.
struct Faces {
    entries: usize,
    stiffness: Face,
    damping: Face,
}

impl Faces {
    fn split<'x>(&self, x: &'x DVector<f64>) -> (&'x [f64], &'x [f64]) {
        x.as_slice()
            .split_at(self.stiffness.dimension(self.entries))
    }
}

impl Chart for Faces {
    fn unknowns(&self, coordinates: &DVector<f64>) -> DVector<f64> {
        let (k, c) = self.split(coordinates);
        let mut values = self.stiffness.values(k, self.entries);
        values.extend(self.damping.values(c, self.entries));
        DVector::from_vec(values)
    }

    fn derivative(&self, coordinates: &DVector<f64>) -> Option<DMatrix<f64>> {
        let (k, c) = self.split(coordinates);
        Some(DMatrix::from_fn(
            2 * self.entries,
            coordinates.len(),
            |entry, coordinate| match (
                entry.checked_sub(self.entries),
                coordinate.checked_sub(k.len()),
            ) {
                (None, None) => self.stiffness.derivative(k, entry, coordinate),
                (Some(entry), Some(coordinate)) => self.damping.derivative(c, entry, coordinate),
                _ => 0.0,
            },
        ))
    }
}

/// Whether K and C of these unknowns are passive.
pub(super) fn is_passive(model: JointModel, unknowns: &DVector<f64>) -> [bool; 2] {
    let joint = JointMatrices::from_unknowns(model, unknowns.as_slice());
    [&joint.stiffness, &joint.damping].map(super::model::is_positive_semidefinite)
}

/// The passive estimate beside the `free` one; `None` if no face has a minimum, which only a joint without any effect has.
pub(super) fn passive<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    free: &Estimate,
) -> Option<Estimate> {
    let inside = is_passive(model, &free.unknowns);
    if inside == [true, true] {
        return Some(free.clone());
    }
    let few = |inside: bool| {
        if inside {
            vec![Face::Free]
        } else {
            Face::of(model)
        }
    };
    let lowest = lowest(objective, model, noise, free, inside.map(few));
    lowest.or_else(|| {
        let all = || {
            let mut faces = vec![Face::Free];
            faces.extend(Face::of(model));
            faces
        };
        self::lowest(objective, model, noise, free, [all(), all()])
    })
}

fn lowest<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    free: &Estimate,
    [stiffness, damping]: [Vec<Face>; 2],
) -> Option<Estimate> {
    let entries = model.entries().len();
    let (k, c) = free.unknowns.as_slice().split_at(entries);
    let pairs = stiffness
        .iter()
        .flat_map(|stiffness| damping.iter().map(move |damping| (stiffness, damping)));
    pairs
        .filter_map(|(stiffness, damping)| {
            let chart = Faces {
                entries,
                stiffness: stiffness.clone(),
                damping: damping.clone(),
            };
            let mut start = stiffness.near(k);
            start.extend(damping.near(c));
            let start = DVector::from_vec(start);
            let corrections = Some(free.corrections.clone());
            estimate(
                objective,
                noise,
                Some(free.levels),
                &chart,
                &start,
                corrections,
            )
        })
        .filter(|estimate| is_passive(model, &estimate.unknowns) == [true, true])
        .min_by(|a, b| a.misfit.total_cmp(&b.misfit))
}
