//! R: what all channels see of the motion of the virtual point, or all impacts do to it, with its derivatives by what
//! may be wrong with each of them.

use std::ops::Range;

use bolted_joint_space::{Dof, Motions};
use nalgebra::{DMatrix, Vector3};

use crate::place::Body;
use crate::{Change, Impact, Place, Role, Sensor, VirtualPointError};

/// One number of the set-up that is known to a tolerance only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// The sensor or impact.
    pub place: Place,
    /// What is wrong with it.
    pub change: Change,
}

/// All channels, or all impacts: R with a row for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Places {
    role: Role,
    bodies: Vec<Body>,
    first_rows: Vec<usize>,
    motions: Motions,
    matrix: DMatrix<f64>,
}

impl Places {
    /// R_u of sensors. Three channels of a triaxial sensor are three rows.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] without any.
    pub fn sensors(sensors: &[Sensor]) -> Result<Self, VirtualPointError> {
        Self::new(
            Role::Channel,
            sensors.iter().map(|sensor| sensor.0.clone()).collect(),
            Motions::ALL,
        )
    }

    /// R_f of impacts.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] without any.
    pub fn impacts(impacts: &[Impact]) -> Result<Self, VirtualPointError> {
        Self::new(
            Role::Impact,
            impacts.iter().map(|impact| impact.0.clone()).collect(),
            Motions::ALL,
        )
    }

    fn new(role: Role, bodies: Vec<Body>, motions: Motions) -> Result<Self, VirtualPointError> {
        let rows: Vec<_> = bodies.iter().flat_map(Body::rows).collect();
        let found = rows.len();
        if found == 0 {
            let least = motions.count();
            return Err(VirtualPointError::TooFew { role, found, least });
        }
        let matrix = of_motions(motions, DMatrix::from_fn(found, 6, |i, j| rows[i][j]));
        let mut next = 0;
        let first_rows = bodies.iter().map(|body| {
            let first = next;
            next += body.count();
            first
        });
        let first_rows = first_rows.collect();
        Ok(Self {
            role,
            bodies,
            first_rows,
            motions,
            matrix,
        })
    }

    /// The same where the virtual point has these motions alone: R is zero for the others.
    #[must_use]
    pub fn in_motions(self, motions: Motions) -> Self {
        let matrix = of_motions(motions, self.matrix);
        Self {
            motions,
            matrix,
            ..self
        }
    }

    /// The motions that the virtual point has.
    #[must_use]
    pub fn motions(&self) -> Motions {
        self.motions
    }

    /// Channels or impacts.
    #[must_use]
    pub fn role(&self) -> Role {
        self.role
    }

    /// How many channels or impacts there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.matrix.nrows()
    }

    /// R, n × 6: u = R_u q for channels, m = R_fᵀ f for impacts.
    #[must_use]
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// Where each sensor or impact is, m.
    pub fn positions_m(&self) -> impl Iterator<Item = Vector3<f64>> {
        self.bodies.iter().map(|body| *body.position_m())
    }

    /// The rows of each sensor or impact.
    #[must_use]
    pub fn rows_of_each(&self) -> Vec<Range<usize>> {
        let each = self.bodies.iter().zip(&self.first_rows);
        each.map(|(body, &first)| first..first + body.count())
            .collect()
    }

    /// What may be wrong, place by place: for each of them its pose (m, rad, in the order of
    /// [`Dof::ALL`](bolted_joint_space::Dof::ALL)), then a gain for each of its channels. The three channels of a
    /// triaxial sensor share one pose.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let each = self.bodies.iter().enumerate();
        each.flat_map(|(number, body)| {
            let place = self.place(number);
            body.changes()
                .map(move |change| Parameter { place, change })
        })
        .collect()
    }

    /// dR by each of [`Self::parameters`], n × 6.
    #[must_use]
    pub fn derivatives(&self) -> Vec<DMatrix<f64>> {
        let each = self.bodies.iter().zip(&self.first_rows);
        each.flat_map(|(body, &first)| {
            body.changes().map(move |change| {
                let mut derivative = DMatrix::zeros(self.count(), 6);
                for (offset, row) in body.derivatives(change).enumerate() {
                    derivative.row_mut(first + offset).copy_from(&row);
                }
                of_motions(self.motions, derivative)
            })
        })
        .collect()
    }

    /// dR of some rows of one sensor or impact by its pose, each 6 columns.
    pub(crate) fn pose_derivatives(&self, rows: &[usize]) -> [DMatrix<f64>; 6] {
        let each = self.bodies.iter().zip(&self.first_rows);
        let mut own = each.filter(|&(body, &first)| {
            let of_body = first..first + body.count();
            rows.iter().all(|row| of_body.contains(row))
        });
        let own = own.next();
        Dof::ALL.map(|dof| {
            let mut derivative = DMatrix::zeros(rows.len(), 6);
            if let Some((body, first)) = own {
                let all: Vec<_> = body.derivatives(Change::Pose(dof)).collect();
                for (at, row) in rows.iter().enumerate() {
                    derivative.row_mut(at).copy_from(&all[row - first]);
                }
            }
            of_motions(self.motions, derivative)
        })
    }

    /// The places with errors η of [`Self::parameters`]: shifted, turned by a rotation vector, with gains changed. What
    /// derivatives of the result say is by further changes.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] for η of another length, [`VirtualPointError::NotFinite`],
    /// [`VirtualPointError::Lost`] for gains that become 0.
    pub fn displaced(&self, errors: &[f64]) -> Result<Self, VirtualPointError> {
        let (what, found) = ("errors of the set-up", errors.len());
        let expected = self.bodies.iter().map(|body| 6 + body.count()).sum();
        let size = VirtualPointError::Size {
            what,
            found,
            expected,
        };
        if found != expected {
            return Err(size);
        }
        if !errors.iter().all(|error| error.is_finite()) {
            return Err(VirtualPointError::NotFinite { what });
        }
        let mut rest = errors;
        let mut bodies = Vec::with_capacity(self.bodies.len());
        for (number, body) in self.bodies.iter().enumerate() {
            let (own, others) = rest.split_at(6 + body.count());
            rest = others;
            let Some(changed) = body.changed(own) else {
                return Err(size);
            };
            if let Some(gain) = changed.lost_gain() {
                let place = self.place(number);
                return Err(VirtualPointError::Lost { place, gain });
            }
            bodies.push(changed);
        }
        Self::new(self.role, bodies, self.motions)
    }

    /// The places on the other side of the virtual point along one of its axes, the directions being what they are.
    ///
    /// # Errors
    ///
    /// None but those of [`Self::sensors`].
    pub(crate) fn mirrored(&self, axis: usize) -> Result<Self, VirtualPointError> {
        let bodies = self.bodies.iter().map(|body| body.mirrored(axis)).collect();
        Self::new(self.role, bodies, self.motions)
    }

    /// Root mean square of the distances from the virtual point, one for each row, m; 1 if all are there.
    pub(crate) fn length_m(&self) -> f64 {
        let squares = self.bodies.iter().map(|body| {
            let count = body.count() as f64;
            count * body.position_m().norm_squared()
        });
        let length = (squares.sum::<f64>() / self.count() as f64).sqrt();
        if length > 0.0 { length } else { 1.0 }
    }

    /// The name of a sensor or impact.
    pub(crate) fn place(&self, number: usize) -> Place {
        match self.role {
            Role::Channel => Place::Sensor(number),
            Role::Impact => Place::Impact(number),
        }
    }
}

/// With zeros in the columns of other motions.
fn of_motions(motions: Motions, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for dof in Dof::ALL.into_iter().filter(|&dof| !motions.has(dof)) {
        matrix.column_mut(dof.index()).fill(0.0);
    }
    matrix
}
