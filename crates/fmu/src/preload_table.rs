//! The table of a joint over the preload of its bolt, as the start-value file gives it.

use bolted_joint_dynamics::{
    Beyond, DofLaws, JointLaw, JointOverPreload, Linear, Polynomial, SPACE_COUNT, TableDefect,
    law::{DOF_PARAMETER_COUNT, Declaration, dof_parameters},
};

use crate::interface::Dofs;

/// A joint over the preload, for each model that serves one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PreloadTable {
    /// Translation y.
    One(Box<OverPreload<1>>),
    /// Translation y and rotation θ.
    Two(Box<OverPreload<2>>),
    /// Degrees of freedom in space.
    Six(Box<OverPreload<SPACE_COUNT>>),
}

/// A joint over the preload, and where its friction is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OverPreload<const D: usize> {
    /// The joint; its friction is among the parameters, unless it has a table of that.
    pub(crate) joint: JointOverPreload<D>,
    friction: FrictionOf,
}

/// Where the friction of a joint over the preload is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FrictionOf {
    /// There is none.
    Nothing,
    /// Among the parameters, as it is at this preload, N·m.
    Parameters { nominal_n_m: f64 },
    /// In the table.
    Table,
}

/// What the heading of a table says of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TableFriction<'a> {
    /// There is none.
    None,
    /// It is stated at this preload, N·m.
    At(f64),
    /// The parameters of these laws on each DOF stand in each line.
    InLines(&'a [&'static Declaration]),
}

impl TableFriction<'_> {
    /// Numbers of it in a line, for each DOF.
    fn count(self) -> usize {
        match self {
            Self::None | Self::At(_) => 0,
            Self::InLines(laws) => laws.iter().map(|law| law.parameters.len()).sum(),
        }
    }
}

impl PreloadTable {
    /// The joint through these rows, each of as many numbers as [`columns`] says.
    pub(crate) fn new(
        dofs: Dofs,
        rows: &[Vec<f64>],
        beyond: Beyond,
        friction: TableFriction<'_>,
    ) -> Result<Self, TableDefect> {
        match dofs {
            Dofs::One => over_preload(dofs, rows, beyond, friction)
                .map(Box::new)
                .map(Self::One),
            Dofs::Two => over_preload(dofs, rows, beyond, friction)
                .map(Box::new)
                .map(Self::Two),
            Dofs::Space(_) => over_preload(dofs, rows, beyond, friction)
                .map(Box::new)
                .map(Self::Six),
        }
    }

    /// Whether friction is in the table, so that it is no parameter.
    pub(crate) fn has_friction(&self) -> bool {
        let friction = match self {
            Self::One(table) => table.friction,
            Self::Two(table) => table.friction,
            Self::Six(table) => table.friction,
        };
        friction == FrictionOf::Table
    }

    /// Whether there is a joint at this preload (N·m).
    pub(crate) fn covers(&self, preload_n_m: f64) -> bool {
        match self {
            Self::One(table) => table.joint.covers(preload_n_m),
            Self::Two(table) => table.joint.covers(preload_n_m),
            Self::Six(table) => table.joint.covers(preload_n_m),
        }
    }

    /// First and last preload of the table, N·m.
    pub(crate) fn range_n_m(&self) -> [f64; 2] {
        match self {
            Self::One(table) => table.joint.range_n_m(),
            Self::Two(table) => table.joint.range_n_m(),
            Self::Six(table) => table.joint.range_n_m(),
        }
    }
}

/// Numbers in a row: the preload, the upper triangles of K and C row by row, k3, and friction.
pub(crate) fn columns(dofs: usize, friction: TableFriction<'_>) -> usize {
    1 + dofs * (dofs + 1) + dofs + dofs * friction.count()
}

fn over_preload<const D: usize>(
    dofs: Dofs,
    rows: &[Vec<f64>],
    beyond: Beyond,
    friction: TableFriction<'_>,
) -> Result<OverPreload<D>, TableDefect> {
    let places: Vec<usize> = dofs.places().collect();
    Ok(OverPreload {
        joint: joint(&places, rows, beyond, friction)?,
        friction: match friction {
            TableFriction::None => FrictionOf::Nothing,
            TableFriction::At(nominal_n_m) => FrictionOf::Parameters { nominal_n_m },
            TableFriction::InLines(_) => FrictionOf::Table,
        },
    })
}

/// The joint through these rows, each of as many numbers as [`columns`] says, with its degrees of freedom at these places, and
/// with the friction that is in the rows.
pub(crate) fn joint<const D: usize>(
    places: &[usize],
    rows: &[Vec<f64>],
    beyond: Beyond,
    friction: TableFriction<'_>,
) -> Result<JointOverPreload<D>, TableDefect> {
    let table: Vec<_> = rows.iter().filter_map(|row| law(places, row)).collect();
    let joint = JointOverPreload::new(&table, beyond)?;
    let TableFriction::InLines(laws) = friction else {
        return Ok(joint);
    };
    let behind = columns(places.len(), TableFriction::None);
    let own = |row: &Vec<f64>| sliders(places, laws, row.get(behind..).unwrap_or_default());
    let entries: Vec<_> = rows.iter().map(own).collect();
    joint.with_friction_table(&entries)
}

/// The laws on each DOF, by the numbers of a row behind those of springs and dampers.
fn sliders<const D: usize>(
    places: &[usize],
    laws: &[&Declaration],
    numbers: &[f64],
) -> [DofLaws; D] {
    let mut numbers = numbers.iter().copied();
    let mut on = [[0.0; DOF_PARAMETER_COUNT]; D];
    for &place in places {
        for law in laws {
            let mut own = on[place].iter_mut().zip(dof_parameters());
            own.by_ref()
                .filter(|(_, (other, _))| (other.name, other.number) == (law.name, law.number))
                .for_each(|(parameter, _)| *parameter = numbers.next().unwrap_or(0.0));
        }
    }
    on.map(DofLaws::new)
}

impl<const D: usize> OverPreload<D> {
    /// The joint with the friction of these laws on each relative DOF, where that is among the parameters.
    pub(crate) fn with_friction(&self, on: [DofLaws; D]) -> JointOverPreload<D> {
        let joint = self.joint.clone();
        match self.friction {
            FrictionOf::Parameters { nominal_n_m } => joint.with_friction(on, nominal_n_m),
            FrictionOf::Nothing | FrictionOf::Table => joint,
        }
    }
}

/// Preload and law of one row.
fn law<const D: usize>(places: &[usize], row: &[f64]) -> Option<(f64, JointLaw<D>)> {
    let mut numbers = row.iter().copied();
    let preload_n_m = numbers.next()?;
    let mut matrix = || {
        let mut matrix = [[0.0; D]; D];
        for (n, &i) in places.iter().enumerate() {
            for &j in places.iter().skip(n) {
                matrix[i][j] = numbers.next()?;
                matrix[j][i] = matrix[i][j];
            }
        }
        Some(matrix)
    };
    let linear = Linear {
        stiffness: matrix()?,
        damping: matrix()?,
    };
    let mut cubic = [Polynomial::NONE; D];
    for &i in places {
        cubic[i] = Polynomial::cubic(numbers.next()?);
    }
    Some((preload_n_m, linear.beside(cubic)))
}
