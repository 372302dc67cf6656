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

/// A face for the stiffness and one for the damping of one joint.
#[derive(Clone, Debug, PartialEq)]
struct Faces {
    entries: usize,
    stiffness: Face,
    damping: Face,
}

impl Faces {
    /// The inside of both cones.
    fn free(entries: usize) -> Self {
        Self {
            entries,
            stiffness: Face::Free,
            damping: Face::Free,
        }
    }

    /// Coordinates of the stiffness, and of both.
    fn dimensions(&self) -> (usize, usize) {
        let stiffness = self.stiffness.dimension(self.entries);
        (stiffness, stiffness + self.damping.dimension(self.entries))
    }

    fn unknowns(&self, x: &[f64]) -> Vec<f64> {
        let (k, c) = x.split_at(self.dimensions().0);
        let mut values = self.stiffness.values(k, self.entries);
        values.extend(self.damping.values(c, self.entries));
        values
    }

    fn derivative(&self, x: &[f64], unknown: usize, coordinate: usize) -> f64 {
        let (k, c) = x.split_at(self.dimensions().0);
        match (
            unknown.checked_sub(self.entries),
            coordinate.checked_sub(k.len()),
        ) {
            (None, None) => self.stiffness.derivative(k, unknown, coordinate),
            (Some(entry), Some(coordinate)) => self.damping.derivative(c, entry, coordinate),
            _ => 0.0,
        }
    }

    fn near(&self, unknowns: &[f64]) -> Vec<f64> {
        let (k, c) = unknowns.split_at(self.entries);
        let mut x = self.stiffness.near(k);
        x.extend(self.damping.near(c));
        x
    }
}

/// The faces of each joint, whose unknowns and coordinates follow one after the other.
struct Joints<'f>(&'f [Faces]);

impl Joints<'_> {
    /// Each joint's faces with its own part of the coordinates and the index of its first one.
    fn parts<'x>(&'x self, x: &'x [f64]) -> impl Iterator<Item = (&'x Faces, &'x [f64], usize)> {
        let mut first = 0;
        self.0.iter().map(move |faces| {
            let own = first..first + faces.dimensions().1;
            first = own.end;
            (faces, &x[own.clone()], own.start)
        })
    }
}

impl Chart for Joints<'_> {
    fn unknowns(&self, coordinates: &DVector<f64>) -> DVector<f64> {
        let parts = self.parts(coordinates.as_slice());
        let values: Vec<f64> = parts.flat_map(|(faces, x, _)| faces.unknowns(x)).collect();
        DVector::from_vec(values)
    }

    fn derivative(&self, coordinates: &DVector<f64>) -> DMatrix<f64> {
        let unknowns: usize = self.0.iter().map(|faces| 2 * faces.entries).sum();
        let mut derivative = DMatrix::zeros(unknowns, coordinates.len());
        let mut row = 0;
        for (faces, x, first) in self.parts(coordinates.as_slice()) {
            for unknown in 0..2 * faces.entries {
                for coordinate in 0..x.len() {
                    derivative[(row + unknown, first + coordinate)] =
                        faces.derivative(x, unknown, coordinate);
                }
            }
            row += 2 * faces.entries;
        }
        derivative
    }
}

/// Whether K and C of one joint's unknowns are passive.
fn is_passive(model: JointModel, unknowns: &[f64]) -> [bool; 2] {
    let joint = JointMatrices::from_unknowns(model, unknowns);
    [&joint.stiffness, &joint.damping].map(super::model::is_positive_semidefinite)
}

/// The first joint that is not passive.
fn first_active(model: JointModel, unknowns: &DVector<f64>) -> Option<usize> {
    let mut joints = unknowns.as_slice().chunks_exact(model.unknowns());
    joints.position(|joint| is_passive(model, joint) != [true, true])
}

/// The passive estimate beside the `free` one; `None` if no face has a minimum, which only a joint without any effect has.
///
/// Of several joints one after the other gets its face, those before it keeping theirs: only the common errors of the
/// substructures couple them.
pub(super) fn passive<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    free: &Estimate,
) -> Option<Estimate> {
    let joints = free.unknowns.len() / model.unknowns();
    let mut faces = vec![Faces::free(model.entries().len()); joints];
    let mut estimate = free.clone();
    // A face moves the other joints a little, perhaps one of them across its boundary: then its turn comes.
    for _ in 0..2 * joints {
        let Some(active) = first_active(model, &estimate.unknowns) else {
            return Some(estimate);
        };
        (faces, estimate) = on_a_face(objective, model, noise, &estimate, &faces, active)?;
    }
    first_active(model, &estimate.unknowns)
        .is_none()
        .then_some(estimate)
}

/// The lowest minimum that has joint `active` on a face of the cone.
fn on_a_face<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    from: &Estimate,
    faces: &[Faces],
    active: usize,
) -> Option<(Vec<Faces>, Estimate)> {
    let all = || {
        let mut faces = vec![Face::Free];
        faces.extend(Face::of(model));
        faces
    };
    let own = active * model.unknowns()..(active + 1) * model.unknowns();
    let few = is_passive(model, &from.unknowns.as_slice()[own]).map(|inside| {
        if inside {
            vec![Face::Free]
        } else {
            Face::of(model)
        }
    });
    let lowest = |candidates: [Vec<Face>; 2]| {
        lowest(objective, model, noise, from, (faces, active), candidates)
    };
    lowest(few).or_else(|| lowest([all(), all()]))
}

fn lowest<const N: usize>(
    objective: &Objective<'_, N>,
    model: JointModel,
    noise: &Noise,
    from: &Estimate,
    (faces, active): (&[Faces], usize),
    [stiffness, damping]: [Vec<Face>; 2],
) -> Option<(Vec<Faces>, Estimate)> {
    let size = model.unknowns();
    let pairs = stiffness
        .iter()
        .flat_map(|stiffness| damping.iter().map(move |damping| (stiffness, damping)));
    pairs
        .filter_map(|(stiffness, damping)| {
            let mut faces = faces.to_vec();
            faces[active] = Faces {
                entries: model.entries().len(),
                stiffness: stiffness.clone(),
                damping: damping.clone(),
            };
            let values = from.unknowns.as_slice().chunks_exact(size);
            let start: Vec<f64> = values
                .zip(&faces)
                .flat_map(|(values, faces)| faces.near(values))
                .collect();
            let estimate = estimate(
                objective,
                noise,
                Some(from.levels),
                &Joints(&faces),
                &DVector::from_vec(start),
                Some(from.corrections.clone()),
            )?;
            Some((faces, estimate))
        })
        .filter(|(_, estimate)| {
            let own = &estimate.unknowns.as_slice()[active * size..(active + 1) * size];
            is_passive(model, own) == [true, true]
        })
        .min_by(|(_, a), (_, b)| a.misfit.total_cmp(&b.misfit))
}
