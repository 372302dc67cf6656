//! The joints of an assembly: which are sought, which are known, and how their unknowns stand in a row.

use std::ops::Range;

use bolted_joint_space::{Entry, JointModel, Motions, Parametrisation, Part, SpaceError};
use nalgebra::{DMatrix, DVector, Matrix6};

use crate::identification::QUANTILE;
use crate::side::MOTIONS;

/// One joint.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    /// The table of the study that it comes from: `joint`, `joint[1]`.
    pub(crate) key: String,
    /// About the size of its interface, m: scales rotations.
    pub(crate) length_m: f64,
    /// The motions that it connects.
    pub(crate) motions: Motions,
    pub(crate) numbers: Numbers,
    /// Whether its model says where it is: one of all numbers is what it is, seen from anywhere.
    pub(crate) is_placed: bool,
}

/// What is known of a joint.
#[derive(Clone, Debug)]
pub(crate) enum Numbers {
    /// Its unknowns: those of K and of C alike.
    Unknown(Parametrisation),
    /// K and C.
    Known(Box<[Matrix6<f64>; 2]>),
}

impl Numbers {
    /// Whether they are unknown and fewer than all, so that they belong to a place.
    pub(crate) fn are_placed(&self, motions: Motions) -> bool {
        let Self::Unknown(model) = self else {
            return false;
        };
        let full = JointModel::Full.parametrisation();
        full.and_then(|full| full.within(motions))
            .is_ok_and(|full| model.count() < full.count())
    }
}

/// A joint that is sought, and where its numbers are.
#[derive(Clone, Copy)]
pub(crate) struct Sought<'l> {
    /// Its number among all joints.
    pub(crate) number: usize,
    /// Its first unknown.
    pub(crate) first: usize,
    pub(crate) link: &'l Link,
    pub(crate) model: &'l Parametrisation,
}

/// All joints, in the order of the chain.
#[derive(Clone, Debug)]
pub(crate) struct Links(pub(crate) Vec<Link>);

impl Links {
    /// Relative motions of all joints.
    pub(crate) fn motions(&self) -> usize {
        MOTIONS * self.0.len()
    }

    /// What scales each of these: 1 for translations, the joint's length for rotations, m.
    pub(crate) fn scales(&self) -> Vec<f64> {
        let of = |link: &Link| [1.0, 1.0, 1.0, link.length_m, link.length_m, link.length_m];
        self.0.iter().flat_map(of).collect()
    }

    /// Those of the joints that are sought that the study is about, among all of these joints.
    pub(crate) fn own_motions(&self) -> Vec<usize> {
        let sought = self.sought().into_iter().enumerate();
        let of = |(number, one): (usize, Sought<'_>)| {
            let rows = one.link.motions.rows().into_iter();
            rows.map(move |row| MOTIONS * number + row)
        };
        sought.flat_map(of).collect()
    }

    /// The size of the largest joint, m.
    pub(crate) fn length_m(&self) -> f64 {
        let lengths = self.0.iter().map(|link| link.length_m);
        lengths.fold(0.0, f64::max)
    }

    /// Those that are sought. The unknowns of a joint are those of its stiffness, then those of its damping.
    pub(crate) fn sought(&self) -> Vec<Sought<'_>> {
        let mut first = 0;
        let mut sought = Vec::new();
        for (number, link) in self.0.iter().enumerate() {
            if let Numbers::Unknown(model) = &link.numbers {
                sought.push(Sought {
                    number,
                    first,
                    link,
                    model,
                });
                first += 2 * model.count();
            }
        }
        sought
    }

    /// Unknowns of all joints.
    pub(crate) fn count(&self) -> usize {
        let counts = self.sought();
        counts.iter().map(|one| 2 * one.model.count()).sum()
    }

    /// K and C of all joints.
    pub(crate) fn matrices(&self, values: &[f64]) -> Result<[DMatrix<f64>; 2], SpaceError> {
        let mut all = self.known();
        for one in self.sought() {
            put(&mut all, one.number, &one.matrices(values)?);
        }
        Ok(all)
    }

    /// As if the joints that are sought were not there.
    pub(crate) fn known(&self) -> [DMatrix<f64>; 2] {
        let mut all = [(); 2].map(|()| DMatrix::zeros(self.motions(), self.motions()));
        for (number, link) in self.0.iter().enumerate() {
            if let Numbers::Known(own) = &link.numbers {
                put(&mut all, number, own);
            }
        }
        all
    }

    /// K and C of those that are sought, one after the other on the diagonal.
    pub(crate) fn sought_matrices(&self, values: &[f64]) -> Result<[DMatrix<f64>; 2], SpaceError> {
        let sought = self.sought();
        let count = MOTIONS * sought.len();
        let mut all = [(); 2].map(|()| DMatrix::zeros(count, count));
        for (number, one) in sought.iter().enumerate() {
            put(&mut all, number, &one.matrices(values)?);
        }
        Ok(all)
    }

    /// The unknowns nearest to K and C of the joints that are sought.
    pub(crate) fn nearest(
        &self,
        matrices: &[[Matrix6<f64>; 2]],
    ) -> Result<DVector<f64>, SpaceError> {
        let mut all = DVector::zeros(self.count());
        for (one, own) in self.sought().iter().zip(matrices) {
            let count = one.model.count();
            for (part, matrix) in own.iter().enumerate() {
                let nearest = one.model.nearest(matrix, one.link.length_m)?;
                all.rows_mut(one.first + part * count, count)
                    .copy_from_slice(&nearest.unknowns);
            }
        }
        Ok(all)
    }

    /// Which of the unknowns are stiffnesses of one motion.
    pub(crate) fn stiffnesses(&self) -> Vec<usize> {
        let of = |one: &Sought<'_>| {
            let first = one.first;
            let entries = one.model.entries().iter().enumerate();
            let own = entries.filter(|(_, entry)| entry.row == entry.column);
            own.map(move |(n, _)| first + n).collect::<Vec<_>>()
        };
        self.sought().iter().flat_map(of).collect()
    }

    /// What couples the motions of each unknown at most: √(k_ii k_jj).
    pub(crate) fn sizes(&self, values: &[f64]) -> Result<Vec<f64>, SpaceError> {
        let mut sizes = Vec::new();
        for one in self.sought() {
            for matrix in one.matrices(values)? {
                sizes.extend(one.model.entries().iter().map(|entry| size(&matrix, entry)));
            }
        }
        Ok(sizes)
    }
}

impl Sought<'_> {
    /// Its motions among those of all joints.
    pub(crate) fn motions(&self) -> Range<usize> {
        MOTIONS * self.number..MOTIONS * (self.number + 1)
    }

    /// Its unknowns among all.
    pub(crate) fn of<'v>(&self, values: &'v [f64]) -> &'v [f64] {
        &values[self.first..self.first + 2 * self.model.count()]
    }

    /// K and C.
    pub(crate) fn matrices(&self, values: &[f64]) -> Result<[Matrix6<f64>; 2], SpaceError> {
        let (stiffness, damping) = self.of(values).split_at(self.model.count());
        Ok([self.model.matrix(stiffness)?, self.model.matrix(damping)?])
    }

    /// Names of its unknowns.
    pub(crate) fn names(&self) -> Vec<String> {
        let of = |part| self.model.names(part);
        [of(Part::Stiffness), of(Part::Damping)].concat()
    }
}

/// K and C of one joint in their place among those of all.
fn put(all: &mut [DMatrix<f64>; 2], number: usize, own: &[Matrix6<f64>; 2]) {
    for (all, own) in all.iter_mut().zip(own) {
        let at = MOTIONS * number;
        all.view_mut((at, at), (MOTIONS, MOTIONS)).copy_from(own);
    }
}

/// √(k_ii k_jj)
pub(crate) fn size(matrix: &Matrix6<f64>, entry: &Entry) -> f64 {
    let [own, other] = [entry.row, entry.column].map(|dof| matrix[(dof as usize, dof as usize)]);
    (own * other).abs().sqrt()
}

/// Whether a number is known at all: its interval is smaller than what couples its motions at most.
pub(crate) fn is_determined(deviation: f64, size: f64) -> bool {
    QUANTILE * deviation < size
}
