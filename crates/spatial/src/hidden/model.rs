//! The functions of the assembly and of both substructures, as they follow from the substructures' reduced functions h, from the
//! joint and from the errors of the set-up:
//!
//! Y_A = R_u h R_fᵀ, Y_C = R_u G R_fᵀ with G the reduced functions coupled by the joint.
//!
//! A change of any unknown is a sum of dyads: dG = L dh R with L = I − a D S, R = I − Sᵀ D b; dG = −a dD b; and an error of a
//! sensor or of an impact changes its own row or column alone.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::rows::Rows;
use crate::assembled::{Assembled, Line};
use crate::dyads::Group;
use crate::error::SpatialError;
use crate::prior::Common;
use crate::problem::{Observed, Problem, Unknowns, block_diagonal};
use crate::side::{Anew, Interface, Placed, Side};

/// h of both sides at one line.
pub(super) type Hidden = [DMatrix<Complex64>; 2];

/// The same joints between interfaces that are nodes, and all functions between them; `hidden` at each line.
pub(super) fn between_nodes(problem: &Problem, hidden: &[Hidden]) -> Problem {
    let side = |n: usize| {
        let own = &problem.sides[n];
        let (rows, columns) = hidden.first().map_or((0, 0), |hidden| hidden[n].shape());
        let named = |all: &[bolted_joint_frf::Dof], count: usize| {
            all.iter().copied().cycle().take(count).collect()
        };
        Side {
            responses: named(&own.responses, rows),
            references: named(&own.references, columns),
            lines: hidden.iter().map(|hidden| hidden[n].clone()).collect(),
            noise: Vec::new(),
            interfaces: (own.interfaces.iter())
                .map(|placed| Placed {
                    name: placed.name.clone(),
                    first: [0, 0],
                    interface: Interface::Node(own.motions_of_one()),
                    seen: None,
                    struck: None,
                })
                .collect(),
            anew: Anew::default(),
        }
    };
    let sides = [side(0), side(1)];
    let [rows, columns] = [
        sides.iter().map(|side| side.responses.len()).sum::<usize>(),
        sides.iter().map(|side| side.references.len()).sum(),
    ];
    // column by column
    let places = (0..columns).flat_map(|column| (0..rows).map(move |row| [row, column]));
    Problem {
        sides,
        frequency_hz: problem.frequency_hz.clone(),
        observed: places.map(|at| Observed::new(at, Vec::new())).collect(),
        links: problem.links.clone(),
        tolerances: None,
        wider: Vec::new(),
        common: Common::default(),
        balance: None,
    }
}

/// At one set of unknowns.
pub(super) struct Model<'p> {
    nodes: &'p Problem,
    assembled: Assembled<'p>,
    pub(super) rows: [Rows; 2],
    /// R_u and R_f of both sides in the assembly.
    all: [DMatrix<Complex64>; 2],
}

/// The functions at one line.
pub(super) struct Computed {
    pub(super) assembly: DMatrix<Complex64>,
    pub(super) substructures: Hidden,
    /// a and b of the interfaces, and D.
    line: Line,
    /// G
    whole: DMatrix<Complex64>,
}

impl<'p> Model<'p> {
    pub(super) fn of(
        problem: &Problem,
        nodes: &'p Problem,
        unknowns: &Unknowns,
    ) -> Result<Self, SpatialError> {
        let errors = problem.errors(unknowns);
        let joint = Unknowns(unknowns.0.rows(0, problem.joint_count()).into_owned());
        let [a, b] = [0, 1].map(|n| Rows::of(&problem.sides[n], &errors[n]));
        let rows = [a?, b?];
        let [a, b] = &rows;
        Ok(Self {
            nodes,
            assembled: Assembled::new(nodes, &joint)?,
            all: [
                block_diagonal([&a.seen, &b.seen]),
                block_diagonal([&a.struck, &b.struck]),
            ],
            rows,
        })
    }

    pub(super) fn line(&self, line: usize, hidden: &Hidden) -> Result<Computed, SpatialError> {
        let found = self.assembled.line_of(line, hidden.each_ref())?;
        let (rows, columns) = (found.by_joint_loads.nrows(), found.joint_motions.ncols());
        let whole = DMatrix::from_column_slice(rows, columns, &found.functions);
        let [responses, references] = &self.all;
        let own = |n: usize| self.rows[n].reduction.expanded(&hidden[n]);
        Ok(Computed {
            assembly: responses * &whole * references.transpose(),
            substructures: [own(0), own(1)],
            line: found,
            whole,
        })
    }

    /// Of the reduced functions of a side: in the assembly.
    pub(super) fn of_hidden(&self, side: usize, at: &Computed) -> Group {
        let own = &self.rows[side].reduction;
        let motions = own.own.rows();
        let sign = Complex64::from(if side == 0 { 1.0 } else { -1.0 });
        let [responses, references] = &self.all;
        let (a, b) = (&at.line.by_joint_loads, &at.line.joint_motions);
        let [first_row, first_column] = match side {
            0 => [0, 0],
            _ => {
                let before = &self.rows[0].reduction;
                [before.rows.nrows(), before.columns.nrows()]
            }
        };
        let mut left = DMatrix::zeros(responses.nrows(), own.rows.ncols());
        left.view_mut((first_row, 0), own.rows.shape())
            .copy_from(&self.rows[side].seen);
        let mut of_interface = left.columns_mut(0, motions.len());
        of_interface -= (responses * (a * &at.line.dynamic) * sign).select_columns(&motions);
        let mut right = DMatrix::zeros(own.columns.ncols(), references.nrows());
        right
            .view_mut(
                (0, first_column),
                (own.columns.ncols(), own.columns.nrows()),
            )
            .copy_from(&self.rows[side].struck.transpose());
        let mut of_interface = right.rows_mut(0, motions.len());
        let changes = (&at.line.dynamic * b) * references.transpose() * sign;
        of_interface -= changes.select_rows(&motions);
        Group { left, right }
    }

    /// In the substructure itself.
    pub(super) fn of_hidden_alone(&self, side: usize) -> Group {
        let own = &self.rows[side].reduction;
        Group {
            left: own.rows.clone(),
            right: own.columns.transpose(),
        }
    }

    /// Of the joints that are sought.
    pub(super) fn of_joints(&self, at: &Computed) -> Vec<Group> {
        let [responses, references] = &self.all;
        let own = at.line.dyads(self.nodes).into_iter();
        own.map(|group| Group {
            left: responses * group.left,
            right: group.right * references.transpose(),
        })
        .collect()
    }

    /// Of the rows of R_u and of R_f of a side: in the assembly. What its sensors and hits alone have beyond those of the substructure acts as the
    /// latter.
    pub(super) fn of_set_up(&self, side: usize, at: &Computed) -> [Group; 2] {
        let before = match side {
            0 => [0; 4],
            _ => {
                let own = &self.rows[0].reduction;
                let ([p, m], [q, n]) = (
                    [own.rows.nrows(), own.rows.ncols()],
                    [own.columns.nrows(), own.columns.ncols()],
                );
                [p, m, q, n]
            }
        };
        let [responses, references] = &self.all;
        let count = self.rows[side].reduction.own.count();
        let motions = at.whole.rows(before[1], count) * references.transpose();
        let by_loads = responses * at.whole.columns(before[3], count);
        self.of_rows(side, motions, by_loads, [before[0], before[2]])
    }

    /// In the substructure itself.
    pub(super) fn of_set_up_alone(&self, side: usize, hidden: &Hidden) -> [Group; 2] {
        let own = &self.rows[side].reduction;
        let count = own.own.count();
        let motions = hidden[side].rows(0, count) * own.columns.transpose();
        let by_loads = &own.rows * hidden[side].columns(0, count);
        self.of_rows(side, motions, by_loads, [0, 0])
    }

    /// What the interface does for each column, and at each row by its loads.
    fn of_rows(
        &self,
        side: usize,
        motions: DMatrix<Complex64>,
        by_loads: DMatrix<Complex64>,
        [first_row, first_column]: [usize; 2],
    ) -> [Group; 2] {
        let [channels, impacts] = self.rows[side].near();
        let one = |is: bool| Complex64::from(f64::from(u8::from(is)));
        let of_channels =
            DMatrix::from_fn(by_loads.nrows(), channels, |i, j| one(i == first_row + j));
        let of_impacts =
            DMatrix::from_fn(impacts, motions.ncols(), |i, j| one(j == first_column + i));
        [
            Group {
                left: of_channels,
                right: motions,
            },
            Group {
                left: by_loads,
                right: of_impacts,
            },
        ]
    }
}
