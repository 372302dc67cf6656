//! One substructure: its functions, and how its interface's motions and loads follow from them.

use bolted_joint_frf::Dof;
use bolted_joint_virtual_point::{
    Parameter, Role, SetUp, Tolerances, VirtualPoint, VirtualPointError, Weights,
};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Motions of an interface.
pub(crate) const MOTIONS: usize = 6;

/// A substructure.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// Channels or motions of the interface first, then what else responds.
    pub(crate) responses: Vec<Dof>,
    /// Impacts or loads on the interface first, then what else is excited.
    pub(crate) references: Vec<Dof>,
    /// Receptances, responses × references, at each line.
    pub(crate) lines: Vec<DMatrix<Complex64>>,
    pub(crate) interface: Interface,
}

/// How the interface is seen.
#[derive(Clone, Debug)]
pub(crate) enum Interface {
    /// The first six responses are its motions, the first six references its loads.
    Node,
    /// By sensors and impacts near it.
    Points(SetUp),
}

impl Interface {
    /// With errors of the set-up.
    pub(crate) fn displaced(&self, errors: &[f64]) -> Result<Self, VirtualPointError> {
        Ok(match self {
            Self::Node => Self::Node,
            Self::Points(set_up) => Self::Points(set_up.displaced(errors)?),
        })
    }
}

/// T_u (6 × responses) and T_f (references × 6), and how they change with each error of the set-up: of sensors, then of
/// impacts.
#[derive(Clone, Debug)]
pub(crate) struct Transformations {
    pub(crate) motions: DMatrix<Complex64>,
    pub(crate) loads: DMatrix<Complex64>,
    pub(crate) motions_changes: Vec<DMatrix<Complex64>>,
    pub(crate) loads_changes: Vec<DMatrix<Complex64>>,
}

/// What the functions of a side with a rigid interface follow from, Y = R_u h R_fᵀ: those between motions and loads of the
/// virtual point and what is measured elsewhere; and how h is found, h = T_u Y T_f.
#[derive(Clone, Debug)]
pub(crate) struct Reduction {
    /// R_u, responses × (6 + others).
    pub(crate) rows: DMatrix<Complex64>,
    /// R_f, references × (6 + others).
    pub(crate) columns: DMatrix<Complex64>,
    /// T_u, (6 + others) × responses.
    pub(crate) motions: DMatrix<Complex64>,
    /// T_f, references × (6 + others).
    pub(crate) loads: DMatrix<Complex64>,
}

impl Reduction {
    pub(crate) fn reduced(&self, functions: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        &self.motions * functions * &self.loads
    }

    pub(crate) fn expanded(&self, reduced: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        &self.rows * reduced * self.columns.transpose()
    }
}

impl Side {
    /// Of a set-up without errors.
    pub(crate) fn reduction(&self) -> Result<Reduction, VirtualPointError> {
        let (p, q) = (self.responses.len(), self.references.len());
        let set_up = match &self.interface {
            Interface::Node => {
                let unit = |count: usize| DMatrix::identity(count, count);
                return Ok(Reduction {
                    rows: unit(p),
                    columns: unit(q),
                    motions: unit(p),
                    loads: unit(q),
                });
            }
            Interface::Points(set_up) => set_up,
        };
        let point = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)?;
        // beside the interface's, what is measured elsewhere stands for itself
        let beside = |own: &DMatrix<f64>, height: usize, width: usize| {
            let (n, m) = own.shape();
            DMatrix::from_fn(height, width, |i, j| {
                Complex64::from(match (i < n, j < m) {
                    (true, true) => own[(i, j)],
                    (false, false) if i - n == j - m => 1.0,
                    _ => 0.0,
                })
            })
        };
        let (r_u, r_f) = (set_up.channels().matrix(), set_up.impacts().matrix());
        let [wide, tall] =
            [(p, r_u.nrows()), (q, r_f.nrows())].map(|(all, own)| MOTIONS + all - own);
        Ok(Reduction {
            rows: beside(r_u, p, wide),
            columns: beside(r_f, q, tall),
            motions: beside(point.motions_of_channels(), wide, p),
            loads: beside(&point.forces_of_loads(), q, tall),
        })
    }

    /// Errors that the set-up may have.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        match &self.interface {
            Interface::Node => Vec::new(),
            Interface::Points(set_up) => set_up.parameters(),
        }
    }

    /// Standard deviations of these errors.
    pub(crate) fn deviations(&self, tolerances: &Tolerances) -> Vec<f64> {
        let of = |parameter: &Parameter| tolerances.of(parameter.place, parameter.change);
        self.parameters().iter().map(of).collect()
    }

    /// The transformations with these errors.
    pub(crate) fn transformations(
        &self,
        errors: &[f64],
    ) -> Result<Transformations, VirtualPointError> {
        let (rows, columns) = (self.responses.len(), self.references.len());
        // zero for what is no channel or impact
        let wide = |own: &DMatrix<f64>, count: usize| {
            DMatrix::from_fn(MOTIONS, count, |i, j| {
                Complex64::from(own.get((i, j)).copied().unwrap_or(0.0))
            })
        };
        let set_up = match &self.interface {
            Interface::Node => {
                let own = DMatrix::identity(MOTIONS, MOTIONS);
                return Ok(Transformations {
                    motions: wide(&own, rows),
                    loads: wide(&own, columns).transpose(),
                    motions_changes: Vec::new(),
                    loads_changes: Vec::new(),
                });
            }
            Interface::Points(set_up) => set_up.displaced(errors)?,
        };
        let point = VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal)?;
        let mut by_channels = point.transformation_derivatives(Role::Channel);
        let mut by_impacts = point.transformation_derivatives(Role::Impact);
        let own = by_channels.len();
        let set_up = point.set_up();
        set_up
            .channels()
            .by_rotation_vectors(&mut by_channels, &errors[..own])?;
        set_up
            .impacts()
            .by_rotation_vectors(&mut by_impacts, &errors[own..])?;
        Ok(Transformations {
            motions: wide(point.motions_of_channels(), rows),
            loads: wide(&point.forces_of_loads().transpose(), columns).transpose(),
            motions_changes: by_channels.iter().map(|by| wide(by, rows)).collect(),
            loads_changes: by_impacts
                .iter()
                .map(|by| wide(by, columns).transpose())
                .collect(),
        })
    }
}
