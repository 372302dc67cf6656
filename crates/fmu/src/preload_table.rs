//! The table of a joint over the preload of its bolt, as the start-value file gives it.

use bolted_joint_dynamics::{
    Beyond, DofLaws, JointLaw, JointOverPreload, Linear, Polynomial, SPACE_COUNT, TableDefect,
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

/// A joint over the preload, and the preload that its friction is stated at.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OverPreload<const D: usize> {
    /// The joint; its friction is among the parameters.
    pub(crate) joint: JointOverPreload<D>,
    /// N·m; of a joint without friction there is none.
    pub(crate) nominal_n_m: Option<f64>,
}

impl PreloadTable {
    /// Numbers in a row: the preload, the upper triangles of K and C row by row, k3.
    pub(crate) const fn columns(dofs: Dofs) -> usize {
        columns(dofs.count())
    }

    /// The joint through these rows, each of [`PreloadTable::columns`] numbers.
    pub(crate) fn new(
        dofs: Dofs,
        rows: &[Vec<f64>],
        beyond: Beyond,
        nominal_n_m: Option<f64>,
    ) -> Result<Self, TableDefect> {
        match dofs {
            Dofs::One => over_preload(dofs, rows, beyond, nominal_n_m)
                .map(Box::new)
                .map(Self::One),
            Dofs::Two => over_preload(dofs, rows, beyond, nominal_n_m)
                .map(Box::new)
                .map(Self::Two),
            Dofs::Space(_) => over_preload(dofs, rows, beyond, nominal_n_m)
                .map(Box::new)
                .map(Self::Six),
        }
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

/// The same of a joint with so many degrees of freedom.
pub(crate) const fn columns(dofs: usize) -> usize {
    1 + dofs * (dofs + 1) + dofs
}

fn over_preload<const D: usize>(
    dofs: Dofs,
    rows: &[Vec<f64>],
    beyond: Beyond,
    nominal_n_m: Option<f64>,
) -> Result<OverPreload<D>, TableDefect> {
    let places: Vec<usize> = dofs.places().collect();
    Ok(OverPreload {
        joint: joint(&places, rows, beyond)?,
        nominal_n_m,
    })
}

/// The joint through these rows, each of as many numbers as [`columns`] says, with its degrees of freedom at these places.
pub(crate) fn joint<const D: usize>(
    places: &[usize],
    rows: &[Vec<f64>],
    beyond: Beyond,
) -> Result<JointOverPreload<D>, TableDefect> {
    let table: Vec<_> = rows.iter().filter_map(|row| law(places, row)).collect();
    JointOverPreload::new(&table, beyond)
}

impl<const D: usize> OverPreload<D> {
    /// The joint with the friction of these laws on each relative DOF.
    pub(crate) fn with_friction(&self, on: [DofLaws; D]) -> JointOverPreload<D> {
        let joint = self.joint.clone();
        match self.nominal_n_m {
            Some(nominal_n_m) => joint.with_friction(on, nominal_n_m),
            None => joint,
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
