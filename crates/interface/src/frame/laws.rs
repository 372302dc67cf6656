//! The variables that the laws of the joint bring with them: a parameter on each DOF or between each two, and what is
//! remembered on each DOF.

use bolted_joint_dynamics::{
    Dof, DofKind,
    law::{ActsOn, Declaration, Parameter, RememberedAs, Span},
};

use super::{
    filling::Filling,
    types::{Type, of_memory, of_parameter, of_rate},
    words,
};
use crate::scope::{Joints, Rows, Scope};

/// Where a parameter is, by rows of the DOF table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// On a DOF.
    Dof(usize),
    /// Between two different DOFs, or on one as the diagonal of a matrix; the earlier row first.
    Pair(usize, usize),
}

impl At {
    /// Whether it is on this DOF or between it and another.
    #[must_use]
    pub fn touches(self, row: usize) -> bool {
        match self {
            Self::Dof(at) => at == row,
            Self::Pair(one, other) => one == row || other == row,
        }
    }

    pub(super) fn rows(self) -> Rows {
        match self {
            Self::Dof(row) => Rows::of(&[row]),
            Self::Pair(one, other) => Rows::of(&[one, other]),
        }
    }
}

/// A parameter of a law at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct LawParameter {
    /// Variable's name, such as `joint.k_yy`.
    pub name: String,
    /// Place of its law among the declarations.
    pub law: usize,
    /// Place of the parameter among those of its law.
    pub parameter: usize,
    /// Symbol, such as `k`.
    pub symbol: &'static str,
    /// Key in a joint file.
    pub key: &'static str,
    /// Where it is.
    pub at: At,
    pub(super) acts_on: ActsOn,
    pub(super) start: f64,
    pub(super) description: String,
    pub(super) declared_type: Type,
    pub(super) scope: Scope,
}

/// What a law remembers on a DOF.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LawMemory {
    pub(super) name: String,
    pub(super) law: usize,
    /// Place among what its law remembers.
    pub(super) number: usize,
    pub(super) row: usize,
    pub(super) description: String,
    pub(super) declared_type: Type,
    pub(super) scope: Scope,
    /// Its rate, where it is an inner state.
    pub(super) rate: Option<InnerRate>,
}

/// The rate of an inner state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct InnerRate {
    pub(super) name: String,
    pub(super) description: String,
    pub(super) declared_type: Type,
}

/// Every parameter of every law, in the order of declarations and DOFs.
#[must_use]
pub fn law_parameters(filling: &Filling<'_>) -> Vec<LawParameter> {
    let mut all = Vec::new();
    for (law, declaration) in filling.laws.iter().enumerate() {
        for (parameter, declared) in declaration.parameters.iter().enumerate() {
            for at in places(declared.span, filling) {
                all.push(LawParameter {
                    name: parameter_name(declaration, declared, at, filling.dofs),
                    law,
                    parameter,
                    symbol: declared.symbol,
                    key: declared.key,
                    at,
                    acts_on: declared.acts_on,
                    start: declared.quantity.start[Place::of(at, filling.dofs) as usize],
                    description: description(declared, at, filling.dofs) + &which(declaration),
                    declared_type: of_parameter(declared, Place::of(at, filling.dofs)),
                    scope: Scope {
                        rows: vec![at.rows()],
                        joints: Joints::of_law(law, filling.laws),
                    },
                });
            }
        }
    }
    all
}

/// What every law remembers, in the order of declarations and DOFs.
pub(super) fn law_memory(filling: &Filling<'_>) -> Vec<LawMemory> {
    let mut all = Vec::new();
    for (law, declaration) in filling.laws.iter().enumerate() {
        for (number, remembered) in declaration.memory.iter().enumerate() {
            for (row, dof) in filling.dofs.iter().enumerate() {
                let quantity = match remembered.quantity {
                    RememberedAs::Displacement => words::Quantity::Displacement,
                    RememberedAs::Load => words::Quantity::Load,
                };
                all.push(LawMemory {
                    name: declaration.variable(remembered.symbol, dof.name),
                    law,
                    number,
                    row,
                    description: with_words(remembered.description, dof.kind, None)
                        + &which(declaration),
                    declared_type: of_memory(quantity, dof.kind),
                    scope: Scope {
                        rows: vec![Rows::of(&[row])],
                        joints: Joints::with_memory_of(law),
                    },
                    rate: remembered.rate.map(|rate| InnerRate {
                        name: declaration.variable(rate.symbol, dof.name),
                        description: with_words(rate.description, dof.kind, None)
                            + &which(declaration),
                        declared_type: of_rate(quantity, dof.kind),
                    }),
                });
            }
        }
    }
    all
}

/// Kind of a place, in the order of [`bolted_joint_dynamics::law::Quantity`]'s numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Translation,
    Between,
    Rotation,
}

impl Place {
    fn of(at: At, dofs: &[Dof]) -> Self {
        let (one, other) = match at {
            At::Dof(row) => (row, row),
            At::Pair(one, other) => (one, other),
        };
        match (dofs[one].kind, dofs[other].kind) {
            (DofKind::Translation, DofKind::Translation) => Self::Translation,
            (DofKind::Rotation, DofKind::Rotation) => Self::Rotation,
            _ => Self::Between,
        }
    }
}

fn places(span: Span, filling: &Filling<'_>) -> Vec<At> {
    let rows = 0..filling.dofs.len();
    match span {
        Span::Dof => rows.map(At::Dof).collect(),
        Span::Matrix(_) => rows
            .clone()
            .flat_map(|one| (one..rows.end).map(move |other| (one, other)))
            .filter(|&(one, other)| filling.are_together(one, other))
            .map(|(one, other)| At::Pair(one, other))
            .collect(),
    }
}

fn parameter_name(law: &Declaration, declared: &Parameter, at: At, dofs: &[Dof]) -> String {
    let of_dof = match at {
        At::Dof(row) => dofs[row].name.to_owned(),
        At::Pair(one, other) => format!("{}{}", dofs[one].name, dofs[other].name),
    };
    law.variable(declared.symbol, &of_dof)
}

/// Behind a description, which of its kind a law is, where it is not the first.
fn which(law: &Declaration) -> String {
    match law.number {
        1 => String::new(),
        number => format!(", of number {number} of its kind"),
    }
}

fn description(declared: &Parameter, at: At, dofs: &[Dof]) -> String {
    match (at, declared.span) {
        (At::Pair(one, other), Span::Matrix(coupling)) if one != other => {
            with_words(coupling, dofs[one].kind, Some(dofs[other].kind))
        }
        (At::Pair(row, _) | At::Dof(row), _) => {
            with_words(declared.description, dofs[row].kind, None)
        }
    }
}

/// A declaration's description; a placeholder that stands for nothing stays, and is found in the description.
fn with_words(text: &str, kind: DofKind, other: Option<DofKind>) -> String {
    words::filled(text, |placeholder| {
        match (placeholder.strip_prefix("other_"), other) {
            (Some(word), Some(other)) => words::word(word, other),
            (Some(_), None) => None,
            (None, _) => words::word(placeholder, kind),
        }
    })
    .unwrap_or_else(|_| text.to_owned())
}
