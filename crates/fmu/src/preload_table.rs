//! The table of a joint over the preload of its bolt, as the start-value file gives it.

use bolted_joint_dynamics::{Beyond, HigherTerms, JointLaw, JointOverPreload, TableDefect};

use crate::interface::Dofs;

/// A joint over the preload, of either number of degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PreloadTable {
    /// Translation y.
    One(JointOverPreload<1>),
    /// Translation y and rotation θ.
    Two(JointOverPreload<2>),
}

impl PreloadTable {
    /// Numbers in a row: the preload, the upper triangles of K and C row by row, k3.
    pub(crate) const fn columns(dofs: Dofs) -> usize {
        match dofs {
            Dofs::One => 4,
            Dofs::Two => 9,
        }
    }

    /// The joint through these rows, each of [`PreloadTable::columns`] numbers.
    pub(crate) fn new(dofs: Dofs, rows: &[Vec<f64>], beyond: Beyond) -> Result<Self, TableDefect> {
        match dofs {
            Dofs::One => {
                let table: Vec<_> = rows
                    .iter()
                    .filter_map(|row| match *row.as_slice() {
                        [preload_n_m, k, c, k3] => Some((preload_n_m, law([[k]], [[c]], [k3]))),
                        _ => None,
                    })
                    .collect();
                JointOverPreload::new(&table, beyond).map(Self::One)
            }
            Dofs::Two => {
                let table: Vec<_> = rows
                    .iter()
                    .filter_map(|row| match *row.as_slice() {
                        [preload_n_m, k11, k12, k22, c11, c12, c22, k3_y, k3_theta] => {
                            let symmetric = |a, b, d| [[a, b], [b, d]];
                            let law = law(
                                symmetric(k11, k12, k22),
                                symmetric(c11, c12, c22),
                                [k3_y, k3_theta],
                            );
                            Some((preload_n_m, law))
                        }
                        _ => None,
                    })
                    .collect();
                JointOverPreload::new(&table, beyond).map(Self::Two)
            }
        }
    }

    /// Whether there is a joint at this preload (N·m).
    pub(crate) fn covers(&self, preload_n_m: f64) -> bool {
        match self {
            Self::One(joint) => joint.covers(preload_n_m),
            Self::Two(joint) => joint.covers(preload_n_m),
        }
    }

    /// First and last preload of the table, N·m.
    pub(crate) fn range_n_m(&self) -> [f64; 2] {
        match self {
            Self::One(joint) => joint.range_n_m(),
            Self::Two(joint) => joint.range_n_m(),
        }
    }
}

fn law<const D: usize>(
    stiffness: [[f64; D]; D],
    damping: [[f64; D]; D],
    cubic: [f64; D],
) -> JointLaw<D> {
    JointLaw {
        stiffness,
        damping,
        cubic,
        higher: HigherTerms::NONE,
    }
}
