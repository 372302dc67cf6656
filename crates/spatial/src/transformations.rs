//! How motions and loads of a side's interfaces follow from its functions, and how that changes with errors of the set-up.

use bolted_joint_virtual_point::{Role, SetUp, VirtualPoint, Weights};
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::side::{Errors, Interface, MOTIONS, OfInterface, Placed, Side};

/// T_u (motions × responses) and T_f (references × motions).
#[derive(Clone, Debug)]
pub(crate) struct Transformations {
    pub(crate) motions: DMatrix<Complex64>,
    pub(crate) loads: DMatrix<Complex64>,
    /// What channels of the assembly see of the motions beyond those of the structure's own test, responses × motions, where they do;
    pub(crate) seen: Option<DMatrix<Complex64>>,
    /// and what loads of its hits have beyond, motions × references.
    pub(crate) struck: Option<DMatrix<Complex64>>,
}

/// How these change with each error of the set-up.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// T_u with errors of sensors.
    pub(crate) motions: Vec<DMatrix<Complex64>>,
    /// T_f with errors of impacts.
    pub(crate) loads: Vec<DMatrix<Complex64>>,
    /// What is seen beyond with errors of the assembly's sensors, where these are mounted anew.
    pub(crate) seen: Option<Vec<DMatrix<Complex64>>>,
    /// Likewise what is struck with those of its hits.
    pub(crate) struck: Option<Vec<DMatrix<Complex64>>>,
}

impl Side {
    /// The transformations with these errors.
    pub(crate) fn transformations(&self, errors: &[f64]) -> Result<Transformations, OfInterface> {
        let (rows, columns, motions) =
            (self.responses.len(), self.references.len(), self.motions());
        let mut all = Transformations {
            motions: DMatrix::zeros(motions, rows),
            loads: DMatrix::zeros(columns, motions),
            seen: None,
            struck: None,
        };
        let errors = self.errors_of_each(errors);
        for (n, (placed, errors)) in self.interfaces.iter().zip(&errors).enumerate() {
            let set_up = match &placed.interface {
                Interface::Points(set_up) => set_up,
                Interface::Node(own) => {
                    let own = DMatrix::identity(MOTIONS, MOTIONS).select_columns(&own.rows());
                    all.motions += self.by_rows(n, &own);
                    all.loads += self.by_columns(n, &own);
                    continue;
                }
            };
            let point = placed.seen_by(set_up, &errors.of_all)?;
            all.motions += self.by_rows(n, point.motions_of_channels());
            all.loads += self.by_columns(n, &point.forces_of_loads().transpose());
            if let Some(own) = placed.beyond(Role::Channel, &errors.of_sensors) {
                let none = || DMatrix::zeros(rows, motions);
                *all.seen.get_or_insert_with(none) += self.by_sensors(n, &own);
            }
            if let Some(own) = placed.beyond(Role::Impact, &errors.of_hits) {
                let none = || DMatrix::zeros(motions, columns);
                *all.struck.get_or_insert_with(none) += self.by_hits(n, &own);
            }
        }
        Ok(all)
    }

    /// How the transformations change there.
    pub(crate) fn changes(&self, errors: &[f64]) -> Result<Changes, OfInterface> {
        let mut all = Changes {
            seen: self.anew.sensors.map(|_| Vec::new()),
            struck: self.anew.hits.map(|_| Vec::new()),
            ..Changes::default()
        };
        let each = self.errors_of_each(errors);
        for (n, (placed, Errors { of_all: errors, .. })) in
            self.interfaces.iter().zip(&each).enumerate()
        {
            let Interface::Points(set_up) = &placed.interface else {
                continue;
            };
            let point = placed.seen_by(set_up, errors)?;
            let mut by_channels = point.transformation_derivatives(Role::Channel);
            let mut by_impacts = point.transformation_derivatives(Role::Impact);
            let own = by_channels.len();
            let set_up = point.set_up();
            let by_vectors = (set_up.channels())
                .by_rotation_vectors(&mut by_channels, &errors[..own])
                .and_then(|()| {
                    let impacts = set_up.impacts();
                    impacts.by_rotation_vectors(&mut by_impacts, &errors[own..])
                });
            by_vectors.map_err(|source| placed.refused(source))?;
            (all.motions).extend(by_channels.iter().map(|own| self.by_rows(n, own)));
            (all.loads).extend(by_impacts.iter().map(|own| self.by_columns(n, own)));
            if let Some(seen) = &mut all.seen {
                let poses = placed.poses(Role::Channel);
                seen.extend(poses.iter().map(|(_, own)| self.by_sensors(n, own)));
            }
            if let Some(struck) = &mut all.struck {
                let poses = placed.poses(Role::Impact);
                struck.extend(poses.iter().map(|(_, own)| self.by_hits(n, own)));
            }
        }
        Ok(all)
    }

    /// Motions × responses of an interface among those of all, zero for what is none of its channels.
    fn by_rows(&self, interface: usize, own: &DMatrix<f64>) -> DMatrix<Complex64> {
        let first = [MOTIONS * interface, self.interfaces[interface].first[0]];
        placed_at(own, first, [self.motions(), self.responses.len()])
    }

    /// The transpose of motions × references likewise.
    fn by_columns(&self, interface: usize, own: &DMatrix<f64>) -> DMatrix<Complex64> {
        let first = [self.interfaces[interface].first[1], MOTIONS * interface];
        let size = [self.references.len(), self.motions()];
        placed_at(&own.transpose(), first, size)
    }

    /// Responses × motions likewise.
    fn by_sensors(&self, interface: usize, own: &DMatrix<f64>) -> DMatrix<Complex64> {
        let first = [self.interfaces[interface].first[0], MOTIONS * interface];
        placed_at(own, first, [self.responses.len(), self.motions()])
    }

    /// The transpose of references × motions likewise.
    fn by_hits(&self, interface: usize, own: &DMatrix<f64>) -> DMatrix<Complex64> {
        let first = [MOTIONS * interface, self.interfaces[interface].first[1]];
        let size = [self.motions(), self.references.len()];
        placed_at(&own.transpose(), first, size)
    }
}

/// A matrix as a block of another one.
fn placed_at(
    own: &DMatrix<f64>,
    [row, column]: [usize; 2],
    size: [usize; 2],
) -> DMatrix<Complex64> {
    let mut wide = DMatrix::zeros(size[0], size[1]);
    let mut place = wide.view_mut((row, column), own.shape());
    place.copy_from(&own.map(Complex64::from));
    wide
}

impl Placed {
    /// The virtual point with these errors of its sensors and impacts.
    fn seen_by(&self, set_up: &SetUp, errors: &[f64]) -> Result<VirtualPoint, OfInterface> {
        let displaced = set_up.displaced(errors);
        displaced
            .and_then(|set_up| VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal))
            .map_err(|source| self.refused(source))
    }
}
