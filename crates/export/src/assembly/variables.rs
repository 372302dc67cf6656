//! The variables of an assembly's FMU, in the order in which the library has them: what the start-value file lists and the model
//! description declares.

use bolted_joint_assembly::{AssemblyModel, Channel};
use bolted_joint_dynamics::{
    DofKind, DofLaws,
    assembly::Assembly,
    law::{Declaration, INNER_PLACES, Remembered, remembered},
};

/// What a variable is to the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Input,
    /// An input that cannot have every value.
    Limited,
    /// A state that is known at the start.
    State,
    /// A state that follows from the others at the start.
    Inner,
    Output,
    Derivative,
    Indicator,
}

impl Role {
    /// Its word in the start-value file.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Limited => "limited",
            Self::State => "state",
            Self::Inner => "inner",
            Self::Output => "output",
            Self::Derivative => "derivative",
            Self::Indicator => "indicator",
        }
    }
}

/// The type of a variable.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TypeOf {
    /// One of this name in the frames of the model descriptions.
    Named(&'static str),
    /// That one with another typical magnitude, ten to this power.
    OfMagnitude(&'static str, i32),
    /// That of a variable of the lap.
    OfLap(String),
}

/// A variable of the list.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Listed {
    pub(super) name: String,
    pub(super) role: Role,
    /// Whether it is an output, and not a variable of the FMU's own.
    pub(super) is_output: bool,
    /// Its type.
    pub(super) declared_type: TypeOf,
    pub(super) description: String,
    /// Place of the variable that it is the derivative of.
    pub(super) derivative_of: Option<usize>,
    /// Places of what it depends on: of inputs and states; and where the simulation starts.
    pub(super) on: Vec<usize>,
    pub(super) initially_on: Vec<usize>,
    /// Its start value, of an input or a state.
    pub(super) start: f64,
}

/// The list, and the place of the first variable that is calculated apart from other outputs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct List {
    pub(super) variables: Vec<Listed>,
    pub(super) apart: usize,
}

impl List {
    /// Places of the continuous states and of their derivatives, in the order of the model structure.
    pub(super) fn states(&self) -> Vec<[usize; 2]> {
        let derivatives = self.variables.iter().enumerate();
        derivatives
            .filter_map(|(place, own)| {
                let state = own.derivative_of?;
                let role = self.variables.get(state)?.role;
                matches!(role, Role::State | Role::Inner).then_some([state, place])
            })
            .collect()
    }
}

/// Places of inputs and states.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    pub(super) loads: usize,
    /// Preloads, which stand behind the loads.
    pub(super) preloads: usize,
    pub(super) size: usize,
}

impl Places {
    pub(super) fn of(assembly: &Assembly) -> Self {
        Self {
            loads: assembly.loads.columns(),
            preloads: assembly.over_preload().count(),
            size: assembly.size(),
        }
    }

    pub(super) fn inputs(self) -> usize {
        self.loads + self.preloads
    }

    pub(super) fn q(self, coordinate: usize) -> usize {
        self.inputs() + coordinate
    }

    pub(super) fn v(self, coordinate: usize) -> usize {
        self.inputs() + self.size + coordinate
    }

    pub(super) fn energy(self, which: usize) -> usize {
        self.inputs() + 2 * self.size + which
    }

    pub(super) fn inner(self, which: usize) -> usize {
        self.inputs() + 2 * self.size + 2 + which
    }
}

/// A number that the laws on a DOF remember and that is a variable.
pub(super) struct Shown {
    /// The DOF, among those that have laws.
    pub(super) law: usize,
    /// Its place in what is remembered there.
    pub(super) place: usize,
    pub(super) is_inner: bool,
}

/// All of them, in their order.
pub(super) fn shown_places(assembly: &Assembly) -> Vec<Shown> {
    let laws = assembly.laws().enumerate();
    laws.flat_map(|(law, own)| {
        shown(own).map(move |(place, _, _)| Shown {
            law,
            place,
            is_inner: INNER_PLACES.contains(&place),
        })
    })
    .collect()
}

/// What the laws on a DOF remember and that is a variable.
pub(super) fn shown(
    laws: &DofLaws,
) -> impl Iterator<Item = (usize, &'static Declaration, &'static Remembered)> {
    let present: Vec<String> = laws.present().map(Declaration::numbered_name).collect();
    remembered().filter(move |(_, law, _)| present.contains(&law.numbered_name()))
}

/// The name of a variable of a joint that has a name.
pub(super) fn of_joint(joint: &str, declared: &str) -> String {
    match declared.strip_prefix("joint.") {
        Some(own) => format!("{joint}.{own}"),
        None => format!("{joint}.{declared}"),
    }
}

/// The place as people read it.
pub(super) fn place(model: &AssemblyModel, channel: &Channel) -> String {
    let structure = model.structures.get(channel.place.structure);
    let name = structure.map_or("", |structure| structure.name.as_str());
    format!("structure {name} at {}", channel.place.dof)
}

pub(super) fn load(kind: DofKind) -> &'static str {
    match kind {
        DofKind::Translation => "Force",
        DofKind::Rotation => "Moment",
    }
}

pub(super) fn displacement(kind: DofKind) -> &'static str {
    match kind {
        DofKind::Translation => "Displacement",
        DofKind::Rotation => "Rotation",
    }
}

pub(super) fn rate(kind: DofKind) -> &'static str {
    match kind {
        DofKind::Translation => "Velocity",
        DofKind::Rotation => "Angular velocity",
    }
}

/// Types of the frames.
pub(super) fn load_type(kind: DofKind) -> &'static str {
    load(kind)
}

pub(super) fn displacement_type(kind: DofKind) -> &'static str {
    displacement(kind)
}

pub(super) fn rate_type(kind: DofKind) -> &'static str {
    match kind {
        DofKind::Translation => "Velocity",
        DofKind::Rotation => "AngularVelocity",
    }
}

/// A number with so many digits that it can be told.
pub(super) fn short(number: f64) -> String {
    format!("{:.4e}", number)
        .parse::<f64>()
        .map_or_else(|_| number.to_string(), |short| short.to_string())
}
