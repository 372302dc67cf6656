//! The structures on one side of the joints: their functions, and how the motions and loads of their interfaces follow from them.
//!
//! A joint connects a structure of one side with one of the other. Of two structures each is a side; of a chain every second
//! one belongs to side a, and the others to side b.

use bolted_joint_frf::Dof;
use bolted_joint_space::Dof as Motion;
use bolted_joint_virtual_point::{
    Change, Parameter, Role, Tolerances, VirtualPoint, VirtualPointError, Weights,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
use num_complex::Complex64;

pub(crate) use crate::side::{Interface, MOTIONS};

/// One structure, or those of a chain that do not touch each other.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// Channels or motions of the interfaces first, then what else responds.
    pub(crate) responses: Vec<Dof>,
    /// Impacts or loads on the interfaces first, then what else is excited.
    pub(crate) references: Vec<Dof>,
    /// Receptances, responses × references, at each line.
    pub(crate) lines: Vec<DMatrix<Complex64>>,
    /// One for each joint, in their order.
    pub(crate) interfaces: Vec<Placed>,
}

/// An interface, and where its channels and impacts are among those of the side.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    /// The table of the study that has its sensors and impacts: `a`, `b`, `b.far`.
    pub(crate) name: String,
    /// Its first response, and its first reference.
    pub(crate) first: [usize; 2],
    pub(crate) interface: Interface,
}

impl Placed {
    /// What may be wrong with the channels, or with the impacts.
    pub(crate) fn parameters(&self, role: Role) -> Vec<Parameter> {
        match &self.interface {
            Interface::Node => Vec::new(),
            Interface::Points(set_up) => set_up.places(role).parameters(),
        }
    }
}

/// T_u (motions × responses) and T_f (references × motions), and how they change with each error of the set-up: of sensors, then
/// of impacts.
#[derive(Clone, Debug)]
pub(crate) struct Transformations {
    pub(crate) motions: DMatrix<Complex64>,
    pub(crate) loads: DMatrix<Complex64>,
    pub(crate) motions_changes: Vec<DMatrix<Complex64>>,
    pub(crate) loads_changes: Vec<DMatrix<Complex64>>,
}

/// An error of a virtual point, with the table of the study that it belongs to.
#[derive(Debug)]
pub(crate) struct OfInterface {
    pub(crate) name: String,
    pub(crate) source: VirtualPointError,
}

impl Side {
    /// Motions of its interfaces.
    pub(crate) fn motions(&self) -> usize {
        MOTIONS * self.interfaces.len()
    }

    /// Rows of its functions together with those of the interfaces.
    pub(crate) fn rows(&self) -> usize {
        self.responses.len() + self.motions()
    }

    /// Columns likewise.
    pub(crate) fn columns(&self) -> usize {
        self.references.len() + self.motions()
    }

    /// Errors that the set-up may have, with the interface that they belong to: those of channels, then those of impacts.
    pub(crate) fn parameters(&self) -> Vec<(&Placed, Parameter)> {
        let of = |role| {
            let placed = self.interfaces.iter();
            placed.flat_map(move |placed| {
                let own = placed.parameters(role).into_iter();
                own.map(move |parameter| (placed, parameter))
            })
        };
        of(Role::Channel).chain(of(Role::Impact)).collect()
    }

    /// Standard deviations of these errors.
    pub(crate) fn deviations(&self, tolerances: &Tolerances) -> Vec<f64> {
        let parameters = self.parameters();
        let of = parameters
            .iter()
            .map(|(_, one)| tolerances.of(one.place, one.change));
        of.collect()
    }

    /// The errors of each interface: of its channels, then of its impacts.
    fn errors_of_each(&self, errors: &[f64]) -> Vec<Vec<f64>> {
        let mut own: Vec<Vec<f64>> = vec![Vec::new(); self.interfaces.len()];
        let mut start = 0;
        for role in [Role::Channel, Role::Impact] {
            for (own, placed) in own.iter_mut().zip(&self.interfaces) {
                let count = placed.parameters(role).len();
                own.extend_from_slice(&errors[start..start + count]);
                start += count;
            }
        }
        own
    }

    /// With errors of the set-up, and exact so.
    pub(crate) fn displaced(&self, errors: &[f64]) -> Result<Self, OfInterface> {
        let mut own = self.clone();
        for (placed, errors) in own.interfaces.iter_mut().zip(self.errors_of_each(errors)) {
            let displaced = placed.interface.displaced(&errors);
            placed.interface = displaced.map_err(|source| placed.refused(source))?;
        }
        Ok(own)
    }

    /// The transformations with these errors.
    pub(crate) fn transformations(&self, errors: &[f64]) -> Result<Transformations, OfInterface> {
        let (rows, columns, motions) =
            (self.responses.len(), self.references.len(), self.motions());
        let mut all = Transformations {
            motions: DMatrix::zeros(motions, rows),
            loads: DMatrix::zeros(columns, motions),
            motions_changes: Vec::new(),
            loads_changes: Vec::new(),
        };
        let errors = self.errors_of_each(errors);
        for (n, (placed, errors)) in self.interfaces.iter().zip(&errors).enumerate() {
            let [first_row, first_column] = placed.first;
            // zero for what is no channel or impact of this interface
            let by_rows = |own: &DMatrix<f64>| {
                let mut wide = DMatrix::zeros(motions, rows);
                let mut place = wide.view_mut((MOTIONS * n, first_row), own.shape());
                place.copy_from(&own.map(Complex64::from));
                wide
            };
            let by_columns = |own: &DMatrix<f64>| {
                let mut wide = DMatrix::zeros(columns, motions);
                let own = own.transpose();
                let mut place = wide.view_mut((first_column, MOTIONS * n), own.shape());
                place.copy_from(&own.map(Complex64::from));
                wide
            };
            let Interface::Points(set_up) = &placed.interface else {
                let own = DMatrix::identity(MOTIONS, MOTIONS);
                all.motions += by_rows(&own);
                all.loads += by_columns(&own);
                continue;
            };
            let displaced = set_up.displaced(errors);
            let point = displaced
                .and_then(|set_up| VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal))
                .map_err(|source| placed.refused(source))?;
            let mut by_channels = point.transformation_derivatives(Role::Channel);
            let mut by_impacts = point.transformation_derivatives(Role::Impact);
            let parameters = set_up.parameters();
            let own = by_channels.len();
            by_rotation_vectors(&mut by_channels, &parameters[..own], &errors[..own]);
            by_rotation_vectors(&mut by_impacts, &parameters[own..], &errors[own..]);
            all.motions += by_rows(point.motions_of_channels());
            all.loads += by_columns(&point.forces_of_loads().transpose());
            all.motions_changes.extend(by_channels.iter().map(by_rows));
            all.loads_changes.extend(by_impacts.iter().map(by_columns));
        }
        Ok(all)
    }
}

impl Placed {
    pub(crate) fn refused(&self, source: VirtualPointError) -> OfInterface {
        OfInterface {
            name: self.name.clone(),
            source,
        }
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
        let count = self.motions.nrows();
        let by_loads = functions * &self.loads;
        let mut all = DMatrix::zeros(p + count, q + count);
        all.view_mut((0, 0), (p, q)).copy_from(functions);
        all.view_mut((0, q), (p, count)).copy_from(&by_loads);
        let motions = &self.motions * all.rows(0, p);
        all.rows_mut(p, count).copy_from(&motions);
        all
    }
}
