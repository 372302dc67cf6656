//! The estimate within the cone of passive joints, K = LLᵀ and C = LLᵀ.
//!
//! Where the free estimate is passive it is this one. Else the minimum lies on the cone's boundary: a factor L with fewer
//! columns, K = l lᵀ or less. There L's own derivatives stay regular, which those of a full L would not as a column
//! vanishes. Each face of the cone is searched, and the lowest minimum whose other matrix is passive is the estimate.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::estimator::{Chart, Estimate, estimate};
use super::layout::Layout;
use super::model::JointModel;
use super::noise::Noise;
use super::normal::scaled_by;
use super::objective::Objective;

/// Combinations of faces that are looked at, at most: all of four bolts with both matrices of each outside the cone.
const MOST_COMBINATIONS: usize = 256;

/// Combinations of faces that are searched before it is asked whether one of them has led to a passive joint.
const AT_A_TIME: usize = 4;

/// Combinations that are searched at most: those farther away are no better.
const MOST_SEARCHED: usize = 2 * AT_A_TIME;

/// Part of the boundary of the cone of one matrix.
#[derive(Clone, Debug, PartialEq)]
enum Face {
    /// The matrix as it is: the inside of the cone, if it is passive.
    Free,
    /// l lᵀ
    RankOne,
    /// Only these entries of the joint model, the others being zero.
    Only(Vec<usize>),
    /// These values and no others.
    Held(Vec<f64>),
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
            Self::Held(_) => 0,
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
            Self::Held(values) => values.clone(),
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
            Self::Held(_) => 0.0,
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
            Self::Held(_) => Vec::new(),
        }
    }
}

/// A face for each matrix of the unknowns, which follow one after the other: the stiffnesses and dampings of the bolts with a
/// joint of their own, then the same of the next torque.
#[derive(Clone)]
struct Faces {
    /// Entries of one matrix.
    entries: usize,
    faces: Vec<Face>,
}

impl Faces {
    /// The coordinates of each face.
    fn split<'x>(&self, x: &'x DVector<f64>) -> Vec<&'x [f64]> {
        let mut rest = x.as_slice();
        let next = |face: &Face| {
            let (own, others) = rest.split_at(face.dimension(self.entries));
            rest = others;
            own
        };
        self.faces.iter().map(next).collect()
    }

    /// Coordinates near unknowns that may lie off the faces.
    fn near(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let matrices = unknowns.as_slice().chunks(self.entries);
        let own = self.faces.iter().zip(matrices);
        let own = own.flat_map(|(face, values)| face.near(values));
        DVector::from_vec(own.collect())
    }

    /// Coordinates of the point that is nearest to some unknowns in this metric, and the square of its distance.
    fn nearest(&self, target: &DVector<f64>, metric: &DMatrix<f64>) -> (DVector<f64>, f64) {
        let mut x = self.near(target);
        for _ in 0..STEPS {
            let (rest, Some(slope)) = (target - self.unknowns(&x), self.derivative(&x)) else {
                break;
            };
            let weighted = slope.transpose() * metric;
            let Some(step) = (&weighted * &slope)
                .cholesky()
                .map(|normal| normal.solve(&(weighted * rest)))
            else {
                break;
            };
            x += step;
        }
        let rest = target - self.unknowns(&x);
        let distance = rest.dot(&(metric * &rest));
        (x, distance)
    }
}

impl Chart for Faces {
    fn unknowns(&self, coordinates: &DVector<f64>) -> DVector<f64> {
        let own = self.faces.iter().zip(self.split(coordinates));
        let values = own.flat_map(|(face, x)| face.values(x, self.entries));
        DVector::from_vec(values.collect())
    }

    fn derivative(&self, coordinates: &DVector<f64>) -> Option<DMatrix<f64>> {
        let rows = self.entries * self.faces.len();
        let mut derivative = DMatrix::zeros(rows, coordinates.len());
        let mut first = 0;
        for (matrix, (face, x)) in self.faces.iter().zip(self.split(coordinates)).enumerate() {
            for entry in 0..self.entries {
                for coordinate in 0..x.len() {
                    derivative[(matrix * self.entries + entry, first + coordinate)] =
                        face.derivative(x, entry, coordinate);
                }
            }
            first += x.len();
        }
        Some(derivative)
    }
}

/// Whether each matrix of the unknowns of one torque is passive: each K, bolt by bolt, and then each C.
fn is_passive(layout: &Layout, unknowns: &[f64]) -> Vec<bool> {
    let joints = layout.matrices(unknowns);
    let stiffness = joints.iter().map(|joint| &joint.stiffness);
    let damping = joints.iter().map(|joint| &joint.damping);
    stiffness
        .chain(damping)
        .map(super::model::is_positive_semidefinite)
        .collect()
}

/// The first torque at which a joint is not passive.
fn first_active(layout: &Layout, unknowns: &DVector<f64>) -> Option<usize> {
    let mut torques = unknowns.as_slice().chunks_exact(layout.unknowns());
    torques.position(|own| is_passive(layout, own).contains(&false))
}

/// By how much the −2 log-likelihood of an estimate under constraints may be above that of the free one by chance: five standard
/// deviations.
pub(super) const CHANCE: f64 = 25.0;

/// The passive estimate beside the `free` one; `None` if no face has a minimum, which only a joint without any effect has.
///
/// Joints of different torques that measured substructures couple tell of each other's errors: if one of them is active by
/// chance, the others move with it. If noise does not explain that it is active, they are held where they are.
pub(super) fn passive(
    objective: &Objective<'_>,
    layout: &Layout,
    noise: &Noise,
    free: &Estimate,
) -> Option<Estimate> {
    let together = constrained(objective, layout, noise, free, Others::Move);
    let alone = free.unknowns.len() == layout.unknowns();
    together
        .filter(|estimate| alone || estimate.misfit <= free.misfit + CHANCE)
        .or_else(|| constrained(objective, layout, noise, free, Others::Stay))
}

/// Steps towards the nearest point of a face.
const STEPS: usize = 50;

/// The passive joint that is nearest to unknowns in the metric of their covariance: the unknowns themselves where they are
/// passive. `None` if no face has a passive point.
pub(super) fn nearest(
    layout: &Layout,
    unknowns: &[f64],
    covariance: &DMatrix<f64>,
) -> Option<Vec<f64>> {
    let passive = is_passive(layout, unknowns);
    if !passive.contains(&false) {
        return Some(unknowns.to_vec());
    }
    let entries = layout.model().entries().len();
    let scale = covariance
        .diagonal()
        .map(|variance| variance.sqrt().recip());
    let weight = scaled_by(&scaled_by(covariance, &scale).try_inverse()?, &scale);
    let target = DVector::from_column_slice(unknowns);
    let mut combinations: Vec<Vec<Face>> = vec![Vec::new()];
    for &is_passive in &passive {
        let mut faces = if is_passive {
            vec![Face::Free]
        } else {
            Vec::new()
        };
        faces.extend(Face::of(layout.model()));
        let longer = |combination: &Vec<Face>| -> Vec<Vec<Face>> {
            let with = |face: &Face| combination.iter().chain([face]).cloned().collect();
            faces.iter().map(with).collect()
        };
        combinations = combinations
            .iter()
            .flat_map(longer)
            .take(MOST_COMBINATIONS)
            .collect();
    }
    let mut best: Option<(f64, Vec<f64>)> = None;
    for faces in combinations {
        let faces = Faces { entries, faces };
        let (x, distance) = faces.nearest(&target, &weight);
        let found = faces.unknowns(&x);
        let found = found.as_slice().to_vec();
        let is_better = best.as_ref().is_none_or(|(least, _)| distance < *least);
        if distance.is_finite() && is_better && !is_passive(layout, &found).contains(&false) {
            best = Some((distance, found));
        }
    }
    best.map(|(_, found)| found)
}

/// What the joints of the torques do that are not being constrained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Others {
    Move,
    Stay,
}

/// One active torque after the other gets its faces, those before it keeping theirs.
fn constrained(
    objective: &Objective<'_>,
    layout: &Layout,
    noise: &Noise,
    free: &Estimate,
    others: Others,
) -> Option<Estimate> {
    let torques = free.unknowns.len() / layout.unknowns();
    let matrices = 2 * layout.joints() * torques;
    let mut faces = Faces {
        entries: layout.model().entries().len(),
        faces: vec![Face::Free; matrices],
    };
    let mut estimate = free.clone();
    // A face moves the other joints a little, perhaps one of them across its boundary: then its turn comes.
    for _ in 0..2 * torques {
        let Some(active) = first_active(layout, &estimate.unknowns) else {
            return Some(estimate);
        };
        if others == Others::Stay {
            let values = estimate.unknowns.as_slice().chunks(faces.entries);
            faces.faces = values.map(|values| Face::Held(values.to_vec())).collect();
        }
        (faces, estimate) = on_a_face(objective, layout, noise, &estimate, &faces, active)?;
    }
    first_active(layout, &estimate.unknowns)
        .is_none()
        .then_some(estimate)
}

/// The lowest minimum that has the joints of torque number `active` on faces of the cone.
fn on_a_face(
    objective: &Objective<'_>,
    layout: &Layout,
    noise: &Noise,
    from: &Estimate,
    faces: &Faces,
    active: usize,
) -> Option<(Faces, Estimate)> {
    let own = active * layout.unknowns()..(active + 1) * layout.unknowns();
    let inside = is_passive(layout, &from.unknowns.as_slice()[own]);
    let of_model = || Face::of(layout.model());
    let few = inside.iter().map(|&inside| match inside {
        true => vec![Face::Free],
        false => of_model(),
    });
    let lowest = |candidates: &[Vec<Face>]| {
        lowest(objective, layout, noise, from, (faces, active), candidates)
    };
    lowest(&few.collect::<Vec<_>>()).or_else(|| {
        // Another matrix that was passive may have left the cone: any face of any.
        let all = inside
            .iter()
            .map(|_| [vec![Face::Free], of_model()].concat());
        lowest(&all.collect::<Vec<_>>())
    })
}

/// The lowest minimum that is passive at torque number `active`, over combinations of the faces that each of its matrices may lie
/// on; of many, over the nearest.
fn lowest(
    objective: &Objective<'_>,
    layout: &Layout,
    noise: &Noise,
    from: &Estimate,
    (faces, active): (&Faces, usize),
    candidates: &[Vec<Face>],
) -> Option<(Faces, Estimate)> {
    let (size, matrices) = (layout.unknowns(), 2 * layout.joints());
    let own = active * size..(active + 1) * size;
    let is_passive_there = |unknowns: &DVector<f64>| {
        !is_passive(layout, &unknowns.as_slice()[own.clone()]).contains(&false)
    };
    let charts = combinations(candidates).into_iter().map(|own| {
        let mut chart = faces.clone();
        chart.faces[active * matrices..(active + 1) * matrices].clone_from_slice(&own);
        chart
    });
    let mut starts: Vec<(f64, Faces, DVector<f64>)> = charts
        .map(|chart| {
            let start = chart.near(&from.unknowns);
            (0.0, chart, start)
        })
        .collect();
    if starts.len() > AT_A_TIME {
        // The sum that is minimised grows with the distance in the metric of the information: the nearest points come first.
        for (distance, chart, start) in &mut starts {
            let (x, apart) = chart.nearest(&from.unknowns, &from.information);
            let is_possible = apart.is_finite() && is_passive_there(&chart.unknowns(&x));
            (*distance, *start) = match is_possible {
                true => (apart, x),
                false => (f64::INFINITY, chart.near(&from.unknowns)),
            };
        }
        starts.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        starts.truncate(MOST_SEARCHED);
    }
    let of_start = |(_, chart, start): &(f64, Faces, DVector<f64>)| {
        let corrections = Some(Arc::clone(&from.corrections));
        let levels = Some(from.levels);
        let estimate = estimate(objective, noise, levels, chart, start, corrections)?;
        is_passive_there(&estimate.unknowns).then(|| (chart.clone(), estimate))
    };
    starts.chunks(AT_A_TIME).find_map(|part| {
        let found = part.iter().filter_map(of_start);
        found.min_by(|(_, a), (_, b)| a.misfit.total_cmp(&b.misfit))
    })
}

/// One face for each matrix, in every combination; those of the first matrices only, where they would be too many.
fn combinations(faces: &[Vec<Face>]) -> Vec<Vec<Face>> {
    let mut all = vec![Vec::new()];
    for own in faces {
        let own = if all.len() * own.len() > MOST_COMBINATIONS {
            &own[..1]
        } else {
            own.as_slice()
        };
        all = all
            .iter()
            .flat_map(|before: &Vec<Face>| {
                own.iter()
                    .map(move |face| [before.as_slice(), std::slice::from_ref(face)].concat())
            })
            .collect();
    }
    all
}
