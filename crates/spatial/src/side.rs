//! The structures on one side of the joints: their functions, and how the motions and loads of their interfaces follow from them.
//!
//! A joint connects a structure of one side with one of the other. Of two structures each is a side; of a chain every second
//! one belongs to side a, and the others to side b.

use bolted_joint_frf::Dof;
use bolted_joint_space::Motions;
use bolted_joint_virtual_point::{
    Change, Parameter, Role, SetUp, Tolerance, Tolerances, VirtualPoint, VirtualPointError, Weights,
};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Motions of an interface.
pub(crate) const MOTIONS: usize = 6;

/// One structure, or those of a chain that do not touch each other.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// Channels or motions of the interfaces first, then what else responds.
    pub(crate) responses: Vec<Dof>,
    /// Impacts or loads on the interfaces first, then what else is excited.
    pub(crate) references: Vec<Dof>,
    /// Receptances, responses × references, at each line.
    pub(crate) lines: Vec<DMatrix<Complex64>>,
    /// Deviation of the noise of each, where coherence tells it; else empty.
    pub(crate) noise: Vec<DMatrix<f64>>,
    /// One for each joint, in their order.
    pub(crate) interfaces: Vec<Placed>,
    pub(crate) anew: Anew,
}

/// How far what is at an interface in the assembly's test may be from where it was in that of the structure; `None` where it is there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Anew {
    /// Sensors that were taken off and mounted again.
    pub(crate) sensors: Option<Tolerance>,
    /// Hits: no hammer hits a place twice.
    pub(crate) hits: Option<Tolerance>,
}

impl Anew {
    fn of(&self, role: Role) -> Option<Tolerance> {
        match role {
            Role::Channel => self.sensors,
            Role::Impact => self.hits,
        }
    }
}

/// An interface, and where its channels and impacts are among those of the side.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    /// The table of the study that has its sensors and impacts: `a`, `b`, `b.far`.
    pub(crate) name: String,
    /// Its first response, and its first reference.
    pub(crate) first: [usize; 2],
    pub(crate) interface: Interface,
    /// What R_u of the assembly's sensors has beyond that of the structure's own test, channels × 6, as far as it is known; `None`
    /// where it is the same.
    pub(crate) seen: Option<DMatrix<f64>>,
    /// Likewise R_f of its hits, impacts × 6.
    pub(crate) struck: Option<DMatrix<f64>>,
}

/// In which test something is wrong with a sensor or an impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Test {
    /// In all tests alike.
    All,
    /// In that of the assembly, against all: with its sensors, or with its hits.
    Assembly(Role),
}

/// What may be wrong with a set-up.
pub(crate) struct MayErr<'s> {
    /// The interface that it belongs to.
    pub(crate) placed: &'s Placed,
    pub(crate) parameter: Parameter,
    pub(crate) test: Test,
}

/// How the interface is seen.
#[derive(Clone, Debug)]
pub(crate) enum Interface {
    /// Its first responses are these motions, its first references their loads.
    Node(Motions),
    /// By sensors and impacts near it.
    Points(SetUp),
}

impl Interface {
    /// With errors of the set-up.
    pub(crate) fn displaced(&self, errors: &[f64]) -> Result<Self, VirtualPointError> {
        Ok(match self {
            Self::Node(motions) => Self::Node(*motions),
            Self::Points(set_up) => Self::Points(set_up.displaced(errors)?),
        })
    }
}

impl Placed {
    /// What may be wrong with the channels, or with the impacts.
    pub(crate) fn parameters(&self, role: Role) -> Vec<Parameter> {
        match &self.interface {
            Interface::Node(_) => Vec::new(),
            Interface::Points(set_up) => set_up.places(role).parameters(),
        }
    }

    /// What being mounted, or hit, anew changes: places and directions, with dR by each, channels or impacts × 6.
    pub(crate) fn poses(&self, role: Role) -> Vec<(Parameter, DMatrix<f64>)> {
        let Interface::Points(set_up) = &self.interface else {
            return Vec::new();
        };
        let places = set_up.places(role);
        let all = places.parameters().into_iter().zip(places.derivatives());
        all.filter(|(parameter, _)| matches!(parameter.change, Change::Pose(_)))
            .collect()
    }

    /// What R of the assembly has beyond that of the structure's own test, with these errors.
    pub(crate) fn beyond(&self, role: Role, errors: &[f64]) -> Option<DMatrix<f64>> {
        let known = match role {
            Role::Channel => &self.seen,
            Role::Impact => &self.struck,
        };
        if errors.is_empty() {
            return known.clone();
        }
        let changes = self.poses(role).into_iter().zip(errors);
        changes.fold(known.clone(), |sum, ((_, change), error)| {
            let own = change * *error;
            Some(sum.map_or_else(|| own.clone(), |sum| sum + &own))
        })
    }
}

/// The errors of an interface's set-up.
#[derive(Clone, Debug, Default)]
pub(crate) struct Errors {
    /// Of its channels, then of its impacts, in all tests alike.
    pub(crate) of_all: Vec<f64>,
    /// Of the assembly's sensors against these, and of its hits.
    pub(crate) of_sensors: Vec<f64>,
    pub(crate) of_hits: Vec<f64>,
}

/// What the functions of a side with a rigid interface follow from, Y = R_u h R_fᵀ: those between motions and loads of the
/// virtual point and what is measured elsewhere; and how h is found, h = T_u Y T_f.
#[derive(Clone, Debug)]
pub(crate) struct Reduction {
    /// R_u, responses × (motions + others).
    pub(crate) rows: DMatrix<Complex64>,
    /// R_f, references × (motions + others).
    pub(crate) columns: DMatrix<Complex64>,
    /// T_u, (motions + others) × responses.
    pub(crate) motions: DMatrix<Complex64>,
    /// T_f, references × (motions + others).
    pub(crate) loads: DMatrix<Complex64>,
    /// The motions that the interface has.
    pub(crate) own: Motions,
}

impl Reduction {
    pub(crate) fn reduced(&self, functions: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        &self.motions * functions * &self.loads
    }

    pub(crate) fn expanded(&self, reduced: &DMatrix<Complex64>) -> DMatrix<Complex64> {
        &self.rows * reduced * self.columns.transpose()
    }
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

    /// What a side with one interface has there.
    pub(crate) fn motions_of_one(&self) -> Motions {
        let first = self.interfaces.first().map(|placed| &placed.interface);
        first.map_or(Motions::ALL, |own| match own {
            Interface::Node(motions) => *motions,
            Interface::Points(set_up) => set_up.motions(),
        })
    }

    /// The interface with its sensors and impacts, of a side with one interface that has any.
    pub(crate) fn points(&self) -> Option<(&Placed, &SetUp)> {
        self.interfaces.first().and_then(Placed::points)
    }

    /// Of one interface whose channels and impacts come first, and a set-up without errors.
    pub(crate) fn reduction(&self) -> Result<Reduction, OfInterface> {
        let (p, q) = (self.responses.len(), self.references.len());
        let Some((placed, set_up)) = self.points() else {
            let unit = |count: usize| DMatrix::identity(count, count);
            return Ok(Reduction {
                rows: unit(p),
                columns: unit(q),
                motions: unit(p),
                loads: unit(q),
                own: self.motions_of_one(),
            });
        };
        let point = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)
            .map_err(|source| placed.refused(source))?;
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
        let own = set_up.motions();
        let motions = own.rows();
        let [r_u, r_f] = [Role::Channel, Role::Impact]
            .map(|role| set_up.places(role).matrix().select_columns(&motions));
        let [wide, tall] =
            [(p, r_u.nrows()), (q, r_f.nrows())].map(|(all, own)| motions.len() + all - own);
        let t_u = point.motions_of_channels().select_rows(&motions);
        let t_f = point.forces_of_loads().select_columns(&motions);
        Ok(Reduction {
            rows: beside(&r_u, p, wide),
            columns: beside(&r_f, q, tall),
            motions: beside(&t_u, wide, p),
            loads: beside(&t_f, q, tall),
            own,
        })
    }

    /// Errors that the set-up may have: those of channels, those of impacts, and those of the assembly's channels and impacts
    /// against these.
    pub(crate) fn parameters(&self) -> Vec<MayErr<'_>> {
        let of = |role| {
            let placed = self.interfaces.iter();
            placed.flat_map(move |placed| {
                let own = placed.parameters(role).into_iter();
                own.map(move |parameter| MayErr {
                    placed,
                    parameter,
                    test: Test::All,
                })
            })
        };
        let again = |role| {
            let placed = self.interfaces.iter();
            let placed = placed.filter(move |_| self.anew.of(role).is_some());
            placed.flat_map(move |placed| {
                let own = placed.poses(role).into_iter();
                own.map(move |(parameter, _)| MayErr {
                    placed,
                    parameter,
                    test: Test::Assembly(role),
                })
            })
        };
        of(Role::Channel)
            .chain(of(Role::Impact))
            .chain(again(Role::Channel))
            .chain(again(Role::Impact))
            .collect()
    }

    /// Standard deviations of these errors.
    pub(crate) fn deviations(&self, tolerances: &Tolerances) -> Vec<f64> {
        let parameters = self.parameters();
        let of = parameters.iter().map(|one| {
            let anew = match one.test {
                Test::Assembly(role) => self.anew.of(role),
                Test::All => None,
            };
            anew.map_or_else(
                || tolerances.of(one.parameter.place, one.parameter.change),
                |own| own.of(one.parameter.change),
            )
        });
        of.collect()
    }

    /// The errors of each interface.
    pub(crate) fn errors_of_each(&self, errors: &[f64]) -> Vec<Errors> {
        let mut all = vec![Errors::default(); self.interfaces.len()];
        let mut rest = errors;
        let mut next = |count: usize| {
            let (first, others) = rest.split_at(count);
            rest = others;
            first
        };
        for role in [Role::Channel, Role::Impact] {
            for (own, placed) in all.iter_mut().zip(&self.interfaces) {
                (own.of_all).extend_from_slice(next(placed.parameters(role).len()));
            }
        }
        for role in [Role::Channel, Role::Impact] {
            if self.anew.of(role).is_none() {
                continue;
            }
            for (own, placed) in all.iter_mut().zip(&self.interfaces) {
                let errors = next(placed.poses(role).len());
                match role {
                    Role::Channel => own.of_sensors.extend_from_slice(errors),
                    Role::Impact => own.of_hits.extend_from_slice(errors),
                }
            }
        }
        all
    }

    /// With errors of the set-up, and exact so.
    pub(crate) fn displaced(&self, errors: &[f64]) -> Result<Self, OfInterface> {
        let mut own = self.clone();
        let each = self.errors_of_each(errors);
        for (placed, errors) in own.interfaces.iter_mut().zip(each) {
            placed.seen = placed.beyond(Role::Channel, &errors.of_sensors);
            placed.struck = placed.beyond(Role::Impact, &errors.of_hits);
            let displaced = placed.interface.displaced(&errors.of_all);
            placed.interface = displaced.map_err(|source| placed.refused(source))?;
        }
        Ok(own)
    }
}

impl Placed {
    /// With its sensors and impacts, unless it is a node.
    pub(crate) fn points(&self) -> Option<(&Self, &SetUp)> {
        match &self.interface {
            Interface::Node(_) => None,
            Interface::Points(set_up) => Some((self, set_up)),
        }
    }

    pub(crate) fn refused(&self, source: VirtualPointError) -> OfInterface {
        OfInterface {
            name: self.name.clone(),
            source,
        }
    }
}
