//! What is given and what is asked: two substructures, the functions of their assembly, and the joint's unknowns.

use std::f64::consts::TAU;

use bolted_joint_space::{Parametrisation, SpaceError};
use bolted_joint_virtual_point::Tolerances;
use nalgebra::{DMatrix, DVector, Matrix6};
use num_complex::Complex64;

use crate::error::SpatialError;
use crate::side::Side;

/// How large the noise of the assembly's functions is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// This part of each function's r.m.s.
    Relative(f64),
    /// As large as the residuals of each function.
    OfResiduals,
}

/// One measured function of the assembly.
#[derive(Clone, Debug)]
pub(crate) struct Observed {
    /// Its row among the responses of a and of b, its column among their references.
    pub(crate) at: [usize; 2],
    /// Receptance at each line.
    pub(crate) values: Vec<Complex64>,
}

/// Two substructures, their assembly, the joint.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) sides: [Side; 2],
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) observed: Vec<Observed>,
    /// That of K and of C alike.
    pub(crate) model: Parametrisation,
    /// Scales rotations, m.
    pub(crate) length_m: f64,
    /// Of the set-ups; `None` where they are exact.
    pub(crate) tolerances: Option<Tolerances>,
}

/// Unknowns: of stiffness, of damping, and errors of the set-up of a and of b.
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
        self.with_lines(&kept)
    }

    /// With these of its lines.
    pub(crate) fn with_lines(&self, kept: &[usize]) -> Self {
        let side = |side: &Side| Side {
            responses: side.responses.clone(),
            references: side.references.clone(),
            lines: kept.iter().map(|&line| side.lines[line].clone()).collect(),
            interface: side.interface.clone(),
        };
        let observed = |one: &Observed| Observed {
            at: one.at,
            values: kept.iter().map(|&line| one.values[line]).collect(),
        };
        Self {
            sides: self.sides.each_ref().map(side),
            frequency_hz: kept.iter().map(|&line| self.frequency_hz[line]).collect(),
            observed: self.observed.iter().map(observed).collect(),
            model: self.model.clone(),
            length_m: self.length_m,
            tolerances: self.tolerances,
        }
    }

    /// Unknowns of the joint.
    pub(crate) fn joint_count(&self) -> usize {
        2 * self.model.count()
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
        for (n, (side, errors)) in own.sides.iter_mut().zip(&errors).enumerate() {
            let displaced = side.interface.displaced(errors);
            side.interface = displaced.map_err(|source| SpatialError::of_side(n, source))?;
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

    /// How far unknowns are expected to be off: those of the joint by what couples their motions at most, errors of the
    /// set-up by their deviations.
    pub(crate) fn expected(&self, unknowns: &Unknowns) -> Result<DVector<f64>, SpaceError> {
        let matrices = self.matrices(unknowns)?;
        let entries = self.model.entries();
        let of_joint = matrices.iter().flat_map(|matrix| {
            entries.iter().map(|entry| {
                let own = [entry.row, entry.column].map(|dof| matrix[(dof as usize, dof as usize)]);
                (own[0] * own[1]).abs().sqrt()
            })
        });
        let all: Vec<f64> = of_joint.chain(self.error_deviations()).collect();
        Ok(DVector::from_vec(all))
    }

    /// K and C.
    pub(crate) fn matrices(&self, unknowns: &Unknowns) -> Result<[Matrix6<f64>; 2], SpaceError> {
        let count = self.model.count();
        let values = unknowns.0.as_slice();
        Ok([
            self.model.matrix(&values[..count])?,
            self.model.matrix(&values[count..2 * count])?,
        ])
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

    /// Rows and columns of the assembly before those of b.
    pub(crate) fn skips(&self) -> [usize; 2] {
        let a = &self.sides[0];
        [a.responses.len(), a.references.len()]
    }

    /// 1/σ² of the observed functions, rows × columns of the assembly; 0 for what was not measured.
    pub(crate) fn weights(&self, deviations: &[f64]) -> DMatrix<f64> {
        let [a, b] = &self.sides;
        let mut weights = DMatrix::zeros(
            a.responses.len() + b.responses.len(),
            a.references.len() + b.references.len(),
        );
        for (one, deviation) in self.observed.iter().zip(deviations) {
            weights[(one.at[0], one.at[1])] += 1.0 / (deviation * deviation);
        }
        weights
    }

    /// Real numbers that are compared.
    pub(crate) fn numbers(&self) -> usize {
        2 * self.observed.len() * self.frequency_hz.len()
    }
}
