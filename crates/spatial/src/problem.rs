//! What is given and what is asked: substructures, the functions of their assembly, and the unknowns of the joints.

use std::f64::consts::TAU;

use bolted_joint_space::{Dof, Selection, SpaceError};
use bolted_joint_virtual_point::{Parameter, Tolerances};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::budget::EXACT_IN_A_WHOLE;
use crate::error::SpatialError;
use crate::links::{Links, Sought};
use crate::prior::Common;
use crate::side::{Anew, Side};
use crate::transformations::Transformations;

/// How large the noise of the assembly's functions is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// This part of each function's r.m.s.
    Relative(f64),
    /// As the coherence of each function tells it, line by line.
    OfCoherence,
    /// As large as the residuals of each function.
    OfResiduals,
}

impl Level {
    /// Whether it is known before anything is found, so that χ² tells something.
    #[must_use]
    pub fn is_known(self) -> bool {
        match self {
            Self::Relative(_) | Self::OfCoherence => true,
            Self::OfResiduals => false,
        }
    }
}

/// One measured function of the assembly.
#[derive(Clone, Debug)]
pub(crate) struct Observed {
    /// Its row among the responses of a and of b, its column among their references.
    pub(crate) at: [usize; 2],
    /// Receptance at each line.
    pub(crate) values: Vec<Complex64>,
    /// Deviation of its noise at each line over that of all; empty where all lines have the same.
    pub(crate) uneven: Vec<f64>,
    /// Deviation of its noise over all lines, where coherence tells it.
    pub(crate) told: Option<f64>,
}

impl Observed {
    /// One that was not measured yet, or whose lines have noise that is alike.
    pub(crate) fn new(at: [usize; 2], values: Vec<Complex64>) -> Self {
        Self {
            at,
            values,
            uneven: Vec::new(),
            told: None,
        }
    }

    /// Deviation of its noise at a line over that of all.
    pub(crate) fn uneven(&self, line: usize) -> f64 {
        self.uneven.get(line).copied().unwrap_or(1.0)
    }
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
    /// By how much the deviation of each error of the set-up is wider than the tolerances say; empty where none is, of no account without them.
    pub(crate) wider: Vec<f64>,
    /// What of it may be off as a whole.
    pub(crate) common: Common,
    /// Stiffnesses that balance the structures in each motion of the joints that are sought, N/m and N·m/rad: 1/|H_ii|. Where they
    /// are known, steps follow the functions.
    pub(crate) balance: Option<Vec<f64>>,
}

/// Unknowns: of stiffness and of damping of each joint, and errors of the set-up of a and of b.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknowns(pub(crate) DVector<f64>);

impl Unknowns {
    /// Those of the joint, beside these errors of a and of b.
    pub(crate) fn beside(self, errors: &[Vec<f64>; 2]) -> Self {
        let joint = self.0.iter().copied();
        let all: Vec<f64> = joint.chain(errors.iter().flatten().copied()).collect();
        Self(DVector::from_vec(all))
    }
}

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
            noise: match side.noise.is_empty() {
                true => Vec::new(),
                false => kept.iter().map(|&line| side.noise[line].clone()).collect(),
            },
            interfaces: side.interfaces.clone(),
            anew: side.anew,
        };
        let observed = |one: &Observed| Observed {
            at: one.at,
            values: kept.iter().map(|&line| one.values[line]).collect(),
            uneven: match one.uneven.is_empty() {
                true => Vec::new(),
                false => kept.iter().map(|&line| one.uneven[line]).collect(),
            },
            told: one.told,
        };
        Self {
            sides: self.sides.each_ref().map(side),
            frequency_hz: kept.iter().map(|&line| self.frequency_hz[line]).collect(),
            observed: self.observed.iter().map(observed).collect(),
            links: self.links.clone(),
            tolerances: self.tolerances,
            wider: self.wider.clone(),
            common: self.common,
            balance: self.balance.clone(),
        }
    }

    /// Whether coherence tells the noise of all functions.
    pub(crate) fn is_told(&self) -> bool {
        self.observed.iter().all(|one| one.told.is_some())
    }

    /// Unknowns of the joints.
    pub(crate) fn joint_count(&self) -> usize {
        self.links.count()
    }

    /// Relative motions of all joints.
    pub(crate) fn motions(&self) -> usize {
        self.links.motions()
    }

    /// The joint that is sought, where it is the only one.
    pub(crate) fn only(&self) -> Result<Sought<'_>, SpatialError> {
        let sought = self.links.sought();
        let only = sought.first().filter(|_| sought.len() == 1);
        only.copied().ok_or(SpatialError::AllKnown)
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

    /// Those of them that are not exact, and what may be off as a whole.
    pub(crate) fn open_error_count(&self) -> usize {
        let Some(tolerances) = &self.tolerances else {
            return 0;
        };
        let open = |side: &Side| {
            let all = side
                .parameters()
                .into_iter()
                .zip(side.deviations(tolerances));
            let is_open = all.filter(|(one, own)| {
                let Parameter { place, change } = one.parameter;
                *own > EXACT_IN_A_WHOLE * Tolerances::TYPICAL.of(place, change)
            });
            is_open.count()
        };
        let own: usize = self.sides.iter().map(open).sum();
        own + self.prior().whole_count()
    }

    /// All unknowns.
    pub(crate) fn count(&self) -> usize {
        self.joint_count() + self.error_count()
    }

    /// With set-ups that have the errors of these unknowns, and are exact so.
    pub(crate) fn displaced(&self, unknowns: &Unknowns) -> Result<Self, SpatialError> {
        self.with_errors(&self.errors(unknowns))
    }

    /// With set-ups that have these errors of a and of b, and are exact so; as it is, where it is exact already.
    pub(crate) fn with_errors(&self, errors: &[Vec<f64>; 2]) -> Result<Self, SpatialError> {
        let mut own = self.clone();
        if errors.iter().all(Vec::is_empty) {
            return Ok(own);
        }
        own.tolerances = None;
        for (side, errors) in own.sides.iter_mut().zip(errors) {
            *side = side.displaced(errors)?;
        }
        Ok(own)
    }

    /// Real numbers of the assembly less those of the joints, at least one.
    pub(crate) fn free_numbers(&self) -> usize {
        self.numbers().saturating_sub(self.joint_count()).max(1)
    }

    /// Whether there are fewer functions than the motions of the joints have among themselves: these may have other joints as well.
    pub(crate) fn has_few_functions(&self) -> bool {
        self.observed.len() < self.links.own_motions().len().pow(2)
    }

    /// With sensors and hits of the assembly that may be so far from those of the substructures' tests.
    pub(crate) fn with_anew(mut self, anew: Anew) -> Self {
        for side in &mut self.sides {
            side.anew = anew;
        }
        self
    }

    /// Standard deviations of the errors of the set-up, as the budget has them.
    pub(crate) fn budget_deviations(&self) -> Vec<f64> {
        let Some(tolerances) = &self.tolerances else {
            return Vec::new();
        };
        let of = |side: &Side| side.deviations(tolerances);
        self.sides.iter().flat_map(of).collect()
    }

    /// Those with which they are estimated, each by itself.
    pub(crate) fn own_deviations(&self) -> Vec<f64> {
        let mut all = self.budget_deviations();
        for (own, factor) in all.iter_mut().zip(&self.wider) {
            *own *= factor;
        }
        all
    }

    pub(crate) fn omega(&self, line: usize) -> f64 {
        TAU * self.frequency_hz[line]
    }

    /// How far unknowns are expected to be off: those of the joint by what couples their motions at most, errors of the
    /// set-up by their deviations.
    pub(crate) fn expected(&self, unknowns: &Unknowns) -> Result<DVector<f64>, SpaceError> {
        let of_joints = match self
            .balance
            .as_deref()
            .and_then(|own| self.reaches(own, unknowns))
        {
            Some(own) => own,
            None => self.links.sizes(unknowns.0.as_slice())?,
        };
        let all: Vec<f64> = of_joints
            .into_iter()
            .chain(self.prior().deviations())
            .collect();
        Ok(DVector::from_vec(all))
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

    /// S of the rows, and of the columns: the motions of the interfaces of a less those of b, as the transformations have them.
    pub(crate) fn selections(
        &self,
        [a, b]: [&Transformations; 2],
    ) -> Result<[Selection; 2], SpaceError> {
        let motions = self.motions();
        let of = |a: &DMatrix<Complex64>, b: &DMatrix<Complex64>| {
            let matrix = DMatrix::from_fn(motions, a.ncols() + b.ncols(), |i, j| {
                match j.checked_sub(a.ncols()) {
                    None => a[(i, j)].re,
                    Some(j) => -b[(i, j)].re,
                }
            });
            Selection::new(matrix, Dof::ALL.into_iter().cycle().take(motions).collect())
        };
        Ok([
            of(&a.motions, &b.motions)?,
            of(&a.loads.transpose(), &b.loads.transpose())?,
        ])
    }

    /// Rows and columns of the assembly before those of b.
    pub(crate) fn skips(&self) -> [usize; 2] {
        let a = &self.sides[0];
        [a.responses.len(), a.references.len()]
    }

    /// 1/σ² of the observed functions over all lines, rows × columns of the assembly; 0 for what was not measured.
    pub(crate) fn weights(&self, deviations: &[f64]) -> DMatrix<f64> {
        self.weights_by(deviations, |_| 1.0)
    }

    /// The same at one line.
    pub(crate) fn weights_at(&self, deviations: &[f64], line: usize) -> DMatrix<f64> {
        self.weights_by(deviations, |one| one.uneven(line))
    }

    fn weights_by(&self, deviations: &[f64], uneven: impl Fn(&Observed) -> f64) -> DMatrix<f64> {
        let [a, b] = &self.sides;
        let mut weights = DMatrix::zeros(
            a.responses.len() + b.responses.len(),
            a.references.len() + b.references.len(),
        );
        for (one, deviation) in self.observed.iter().zip(deviations) {
            weights[(one.at[0], one.at[1])] += (deviation * uneven(one)).powi(-2);
        }
        weights
    }

    /// Real numbers that are compared.
    pub(crate) fn numbers(&self) -> usize {
        2 * self.observed.len() * self.frequency_hz.len()
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
