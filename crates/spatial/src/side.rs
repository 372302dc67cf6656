//! One substructure: its functions, and how its interface's motions and loads follow from them.

use bolted_joint_frf::Dof;
use bolted_joint_space::Dof as Motion;
use bolted_joint_virtual_point::{
    Change, Parameter, Role, SetUp, Tolerances, VirtualPoint, VirtualPointError, Weights,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
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

impl Side {
    /// Rows of its functions together with those of the interface.
    pub(crate) fn rows(&self) -> usize {
        self.responses.len() + MOTIONS
    }

    /// Columns likewise.
    pub(crate) fn columns(&self) -> usize {
        self.references.len() + MOTIONS
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
        let parameters = self.parameters();
        let own = by_channels.len();
        by_rotation_vectors(&mut by_channels, &parameters[..own], &errors[..own]);
        by_rotation_vectors(&mut by_impacts, &parameters[own..], &errors[own..]);
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

/// Makes derivatives by further turns those by the rotation vectors themselves: exp(φ + dφ) = exp(J dφ) exp(φ) with
/// J = I + (1 − cos θ)/θ² [φ]× + (θ − sin θ)/θ³ [φ]×², θ = |φ|. Without it a search crawls: what weakly determined unknowns
/// may do depends on how exactly the others follow.
fn by_rotation_vectors(changes: &mut [DMatrix<f64>], parameters: &[Parameter], errors: &[f64]) {
    for first in 0..parameters.len() {
        if parameters[first].change != Change::Pose(Motion::Rx) {
            continue;
        }
        let vector = Vector3::from_row_slice(&errors[first..first + 3]);
        let cross = vector.cross_matrix();
        let angle = vector.norm();
        // series where the difference would be lost
        let [of_one, of_two] = if angle < 1e-3 {
            [
                0.5 - angle * angle / 24.0,
                1.0 / 6.0 - angle * angle / 120.0,
            ]
        } else {
            [
                (1.0 - angle.cos()) / angle.powi(2),
                (angle - angle.sin()) / angle.powi(3),
            ]
        };
        let jacobian = Matrix3::identity() + of_one * cross + of_two * cross * cross;
        let by_turns: [DMatrix<f64>; 3] = std::array::from_fn(|n| changes[first + n].clone());
        for (k, change) in changes[first..first + 3].iter_mut().enumerate() {
            *change = (0..3).fold(by_turns[0].clone() * 0.0, |sum, m| {
                sum + &by_turns[m] * jacobian[(m, k)]
            });
        }
    }
}

impl Transformations {
    /// The functions of a line with those of the interface: [[Y, Y T_f], [T_u Y, T_u Y T_f]].
    pub(crate) fn extended(&self, functions: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        let (p, q) = functions.shape();
        let by_loads = functions * &self.loads;
        let mut all = DMatrix::zeros(p + MOTIONS, q + MOTIONS);
        all.view_mut((0, 0), (p, q)).copy_from(functions);
        all.view_mut((0, q), (p, MOTIONS)).copy_from(&by_loads);
        let motions = &self.motions * all.rows(0, p);
        all.rows_mut(p, MOTIONS).copy_from(&motions);
        all
    }
}
