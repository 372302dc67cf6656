//! The numbers of one joint, from what was estimated of it: the passive joint that is nearest, and how far they are known.

use bolted_joint_space::{Entry, Parametrisation};
use nalgebra::{DMatrix, DVector, Matrix6};

use crate::error::SpatialError;
use crate::fit::covariance;
use crate::identification::Unknown;
use crate::links::{Sought, is_determined, size};
use crate::passive::{is_passive, nearest};

/// One joint.
pub(crate) struct Numbers {
    /// The unknowns of stiffness, then those of damping.
    pub(crate) unknowns: Vec<Unknown>,
    /// K and C.
    pub(crate) matrices: [Matrix6<f64>; 2],
    /// Without the constraint that the joint be passive, where that is another estimate.
    pub(crate) free: Option<[Matrix6<f64>; 2]>,
    /// Of the 21 numbers of K and of those of C.
    pub(crate) covariances: [DMatrix<f64>; 2],
    /// Of the unknowns.
    pub(crate) correlation: DMatrix<f64>,
    /// χ² by which the joint is away from the free estimate: (θ − θ̂)ᵀ F (θ − θ̂).
    pub(crate) squares_from_free: f64,
}

impl Numbers {
    /// From a joint's own unknowns, their covariance, and that of noise alone. Where a search has come to nothing the covariance may
    /// have no inverse, and no joint is the nearest: the free one then stands there, which is refused in any case.
    pub(crate) fn of(
        joint: &Sought<'_>,
        free: DVector<f64>,
        all: &DMatrix<f64>,
        by_noise: &DMatrix<f64>,
        has_converged: bool,
    ) -> Result<Self, SpatialError> {
        let model = joint.model;
        let count = model.count();
        let (mut passive, mut squares_from_free) = (free.clone(), 0.0);
        if !is_passive(model, &free) {
            let information = covariance(all);
            if information.is_none() && has_converged {
                return Err(SpatialError::NotDetermined);
            }
            let length_m = joint.link.length_m;
            if let Some(information) = information
                && let Some(found) = nearest(model, &free, &information, length_m)
            {
                let difference = &found - &free;
                squares_from_free = difference.dot(&(information * &difference));
                passive = found;
            }
        }
        let matrices = |unknowns: &DVector<f64>| -> Result<[Matrix6<f64>; 2], SpatialError> {
            let (stiffness, damping) = unknowns.as_slice().split_at(count);
            Ok([model.matrix(stiffness)?, model.matrix(damping)?])
        };
        let own = matrices(&passive)?;
        let unknowns = joint.names().into_iter().enumerate().map(|(n, name)| {
            let deviation = all[(n, n)].sqrt();
            let size = size(&own[n / count], &model.entries()[n % count]);
            Unknown {
                name,
                value: passive[n],
                free: free[n],
                deviation,
                deviation_by_noise: by_noise[(n, n)].sqrt(),
                is_determined: is_determined(deviation, size),
            }
        });
        Ok(Self {
            unknowns: unknowns.collect(),
            matrices: own,
            free: match passive == free {
                true => None,
                false => Some(matrices(&free)?),
            },
            covariances: covariances(model, all),
            correlation: DMatrix::from_fn(2 * count, 2 * count, |i, j| {
                all[(i, j)] / (all[(i, i)] * all[(j, j)]).sqrt()
            }),
            squares_from_free,
        })
    }
}

/// Covariances of the 21 numbers of K and of those of C.
fn covariances(model: &Parametrisation, covariance: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let bases = model.bases();
    let count = bases.len();
    let by_unknowns = DMatrix::from_fn(21, count, |n, unknown| {
        let Entry { row, column } = Entry::ALL[n];
        bases[unknown][(row.index(), column.index())]
    });
    [0, count].map(|first| {
        let own = covariance.view((first, first), (count, count));
        &by_unknowns * own * by_unknowns.transpose()
    })
}

/// Deviations of the entries of K and of C.
pub(crate) fn deviations(model: &Parametrisation, covariance: &DMatrix<f64>) -> [Matrix6<f64>; 2] {
    covariances(model, covariance).map(|own| {
        let own = std::array::from_fn(|n| f64::max(own[(n, n)], 0.0).sqrt());
        bolted_joint_space::symmetric(&own)
    })
}
