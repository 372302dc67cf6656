//! What is given and what is asked: substructures, the functions of their assembly, and the unknowns of the joints.

use std::f64::consts::TAU;

use bolted_joint_space::{Dof, Selection, SpaceError};
use bolted_joint_virtual_point::Tolerances;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::chain::links::Links;
use crate::chain::side::Side;
use crate::error::SpatialError;

/// One measured function of the assembly.
#[derive(Clone, Debug)]
pub(crate) struct Observed {
    /// Its row and its column among those of both substructures with their interfaces.
    pub(crate) at: [usize; 2],
    /// Receptance at each line.
    pub(crate) values: Vec<Complex64>,
}

/// Substructures on two sides, their assembly, the joints.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) sides: [Side; 2],
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) observed: Vec<Observed>,
    pub(crate) links: Links,
    /// Of the set-ups; `None` where they are exact.
    pub(crate) tolerances: Option<Tolerances>,
}

/// Unknowns: of stiffness and of damping of each joint, and errors of the set-up of a and of b.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknowns(pub(crate) DVector<f64>);

impl Problem {
    /// With so many lines at most, spread over all.
    pub(crate) fn thinned(&self, most: usize) -> Self {
        let lines = self.frequency_hz.len();
        if lines <= most {
            return self.clone();
        }
        let kept: Vec<usize> = (0..most).map(|n| n * (lines - 1) / (most - 1)).collect();
        let mut own = self.clone();
        own.frequency_hz = kept.iter().map(|&line| self.frequency_hz[line]).collect();
        for (side, all) in own.sides.iter_mut().zip(&self.sides) {
            side.lines = kept.iter().map(|&line| all.lines[line].clone()).collect();
        }
        for (one, all) in own.observed.iter_mut().zip(&self.observed) {
            one.values = kept.iter().map(|&line| all.values[line]).collect();
        }
        own
    }

    /// Unknowns of the joints.
    pub(crate) fn joint_count(&self) -> usize {
        self.links.count()
    }

    /// Relative motions of all joints.
    pub(crate) fn motions(&self) -> usize {
        self.links.motions()
    }

    /// Scales rotations, m.
    pub(crate) fn length_m(&self) -> f64 {
        let lengths = self.links.0.iter().map(|link| link.length_m);
        lengths.fold(0.0, f64::max)
    }

    /// Errors of the set-up that are unknown: of a and of b.
    pub(crate) fn error_counts(&self) -> [usize; 2] {
        let count = |side: &Side| side.parameters().len();
        match self.tolerances {
            None => [0; 2],
            Some(_) => [&self.sides[0], &self.sides[1]].map(count),
        }
    }

    /// Of both.
    pub(crate) fn error_count(&self) -> usize {
        self.error_counts().iter().sum()
    }

    /// All unknowns.
    pub(crate) fn count(&self) -> usize {
        self.joint_count() + self.error_count()
    }

    /// With set-ups that have these errors, and are exact so.
    pub(crate) fn displaced(&self, unknowns: &Unknowns) -> Result<Self, SpatialError> {
        let mut own = self.clone();
        own.tolerances = None;
        let errors = self.errors(unknowns);
        for (side, errors) in own.sides.iter_mut().zip(&errors) {
            *side = side.displaced(errors)?;
        }
        Ok(own)
    }

    /// Standard deviations of the errors of the set-up before anything is measured.
    pub(crate) fn error_deviations(&self) -> Vec<f64> {
        let Some(tolerances) = &self.tolerances else {
            return Vec::new();
        };
        let of = |side: &Side| side.deviations(tolerances);
        self.sides.iter().flat_map(of).collect()
    }

    pub(crate) fn omega(&self, line: usize) -> f64 {
        TAU * self.frequency_hz[line]
    }

    /// K and C of all joints, one after the other on the diagonal.
    pub(crate) fn matrices(&self, unknowns: &Unknowns) -> Result<[DMatrix<f64>; 2], SpaceError> {
        self.links.matrices(unknowns.0.as_slice())
    }

    /// Errors of the set-ups; zero where they are exact.
    pub(crate) fn errors(&self, unknowns: &Unknowns) -> [Vec<f64>; 2] {
        let mut start = self.joint_count();
        let counts = self.error_counts();
        let sides = [0, 1];
        sides.map(|side| {
            let own = match counts[side] {
                0 => vec![0.0; self.sides[side].parameters().len()],
                count => unknowns.0.as_slice()[start..start + count].to_vec(),
            };
            start += counts[side];
            own
        })
    }

    /// S of the rows, and of the columns: the motions of the interfaces of a less those of b.
    pub(crate) fn selections(&self) -> Result<[Selection; 2], SpaceError> {
        let [a, b] = &self.sides;
        let motions = self.motions();
        let of = |[a, b]: [usize; 2]| {
            let matrix = DMatrix::from_fn(motions, a + b, |i, j| {
                let is_of = |end: usize| f64::from(u8::from(j + motions == end + i));
                is_of(a) - is_of(a + b)
            });
            Selection::new(matrix, Dof::ALL.into_iter().cycle().take(motions).collect())
        };
        Ok([of([a.rows(), b.rows()])?, of([a.columns(), b.columns()])?])
    }
}

/// Two matrices on a diagonal.
pub(crate) fn block_diagonal(blocks: [&DMatrix<Complex64>; 2]) -> DMatrix<Complex64> {
    let [a, b] = blocks;
    let mut all = DMatrix::zeros(a.nrows() + b.nrows(), a.ncols() + b.ncols());
    all.view_mut((0, 0), a.shape()).copy_from(a);
    all.view_mut(a.shape(), b.shape()).copy_from(b);
    all
}
