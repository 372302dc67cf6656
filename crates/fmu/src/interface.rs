//! Tables of variables, generated from `modelDescription/*.xml`, the table of DOFs and the laws of the joint.

mod listed;
mod variables;

pub(crate) use listed::{FIRST_LISTED, ListedVariables};
pub(crate) use variables::Variables;

use std::{borrow::Cow, fmt};

use bolted_joint_dynamics::{
    DOF_COUNT, DOFS, SPACE, SPACE_COUNT,
    law::{
        DECLARATIONS, DOF_PARAMETER_COUNT, Declaration, FIRST_INNER_COUNT, FIRST_PARAMETER_COUNT,
        FIRST_REMEMBERED_COUNT, INNER_COUNT, REMEMBERED_COUNT,
    },
};

include!(concat!(env!("OUT_DIR"), "/interface.rs"));

/// Name of a variable: one that the build knows, or one that a start-value file has given.
pub(crate) type Name = Cow<'static, str>;

/// One variable of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Variable {
    /// Structured name.
    pub(crate) name: Name,
    /// Coherent SI unit.
    pub(crate) unit: Name,
    /// What it is to the library.
    pub(crate) role: Role,
    /// Start value that the FMU has before its start-value file and the importer set others; 0 for what is calculated.
    pub(crate) start: f64,
    /// The DOFs that it needs, a bit for each row of the table; each of several such sets suffices.
    pub(crate) rows: &'static [u32],
    /// The kinds of joints that it is of, a bit for each.
    pub(crate) joints: u32,
    /// Whether the importer may access it inside a communication step.
    pub(crate) intermediate: bool,
}

/// One continuous state of Model Exchange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContinuousState {
    /// Value reference of the state.
    pub(crate) reference: usize,
    /// Value reference of its derivative.
    pub(crate) derivative: usize,
    /// Typical magnitude, in the state's unit.
    pub(crate) nominal: f64,
}

/// What the law of an FMU's joint rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dependence {
    /// Parameters alone.
    Constant,
    /// The preload; with what these laws remember, a bit for each, if there are any, and one if they are a table.
    OverPreload(u32),
    /// Parameters, and what these laws remember of the motion, a bit for each as in [`Variable::joints`]; not empty.
    Memory(u32),
}

const OVER_PRELOAD_WITH_TABLE: u32 = JOINTS_OVER_PRELOAD | JOINTS_WITH_FRICTION_TABLE;

impl Dependence {
    /// The joint whose laws with memory have these names, separated by spaces.
    pub(crate) fn on_memory_of(names: &str) -> Option<Self> {
        let law = |name: &str| MEMORY_LAWS.iter().find(|(other, _)| *other == name);
        names
            .split(' ')
            .try_fold(0, |laws, name| Some(laws | law(name)?.1))
            .map(Self::Memory)
    }

    /// As one number, for a state that is written down: a bit for each kind of joints that it is of.
    pub(crate) const fn number(self) -> u32 {
        match self {
            Self::Constant => CONSTANT_JOINTS,
            Self::OverPreload(laws) => JOINTS_OVER_PRELOAD | laws,
            Self::Memory(laws) => laws,
        }
    }

    /// The reverse of [`Dependence::number`].
    pub(crate) fn from_number(number: u32) -> Option<Self> {
        let known = MEMORY_LAWS.iter().fold(0, |all, (_, law)| all | law);
        let laws = number & known;
        match number & !known {
            CONSTANT_JOINTS if laws == 0 => Some(Self::Constant),
            JOINTS_OVER_PRELOAD => Some(Self::OverPreload(laws)),
            OVER_PRELOAD_WITH_TABLE if laws != 0 => {
                Some(Self::OverPreload(laws | JOINTS_WITH_FRICTION_TABLE))
            }
            0 if laws != 0 => Some(Self::Memory(laws)),
            _ => None,
        }
    }

    /// The same over the preload, with what it remembers by parameters or by a table of these.
    pub(crate) const fn over_preload(self, has_friction_table: bool) -> Self {
        match self {
            Self::Memory(laws) if has_friction_table => {
                Self::OverPreload(laws | JOINTS_WITH_FRICTION_TABLE)
            }
            Self::Memory(laws) | Self::OverPreload(laws) => Self::OverPreload(laws),
            Self::Constant => Self::OverPreload(0),
        }
    }

    /// The laws that remember the motion, in the order in which they are declared.
    pub(crate) fn laws(self) -> impl Iterator<Item = &'static Declaration> {
        let own = match self {
            Self::Constant => 0,
            Self::OverPreload(laws) | Self::Memory(laws) => laws,
        };
        let all = MEMORY_LAWS.iter().filter(move |(_, law)| own & law != 0);
        all.filter_map(|(name, _)| DECLARATIONS.iter().find(|law| law.numbered_name() == *name))
    }

    /// Whether the joint remembers its motion.
    pub(crate) const fn remembers(self) -> bool {
        match self {
            Self::Memory(_) => true,
            Self::OverPreload(laws) => laws != 0,
            Self::Constant => false,
        }
    }

    /// Whether such a joint has what belongs to these, as in [`Variable::joints`]. One over the preload has no parameter of a
    /// constant law, whatever it remembers.
    const fn has(self, joints: u32) -> bool {
        match self {
            Self::OverPreload(laws)
                if laws & JOINTS_WITH_FRICTION_TABLE != 0 && joints & FRICTION_PARAMETERS != 0 =>
            {
                false
            }
            Self::Constant => joints & CONSTANT_JOINTS != 0,
            Self::Memory(laws) => joints & laws != 0,
            Self::OverPreload(_) if joints & CONSTANT_JOINTS != 0 => {
                joints & JOINTS_OVER_PRELOAD != 0
            }
            Self::OverPreload(laws) => joints & (laws | JOINTS_OVER_PRELOAD) != 0,
        }
    }
}

/// What a variable is to the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Time.
    Independent,
    /// Tunable parameter.
    Parameter,
    /// Continuous input.
    Input,
    /// Continuous input that cannot have every value.
    LimitedInput,
    /// Continuous state, exposed as an output.
    State,
    /// Calculated output.
    Output,
    /// Derivative of a continuous state, calculated; exposed as a local variable.
    Derivative,
    /// Parameter that follows from others.
    CalculatedParameter,
    /// Continuous state of a law of the joint, exposed as an output: the importer's in Model Exchange, what was committed in
    /// Co-Simulation.
    InnerState,
    /// Event indicator, calculated; exposed as a local variable.
    Indicator,
}

impl Role {
    /// Whether it is an input.
    pub(crate) const fn is_input(self) -> bool {
        matches!(self, Self::Input | Self::LimitedInput)
    }

    /// Its bit in a [`Roles`] set. The calculated local variables share one.
    const fn bit(self) -> u16 {
        match self {
            Self::Independent => 1,
            Self::Parameter => 2,
            Self::Input => 4,
            // in no set of roles by itself
            Self::LimitedInput => 4 | LIMITED,
            Self::State => 8,
            Self::Output => 16,
            Self::Derivative | Self::Indicator => 32,
            Self::CalculatedParameter => 64,
            Self::InnerState => 128,
        }
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Independent => "the independent variable",
            Self::Parameter => "a parameter",
            Self::Input | Self::LimitedInput => "an input",
            Self::State => "a state",
            Self::Output => "a calculated output",
            Self::Derivative => "a calculated derivative",
            Self::CalculatedParameter => "a calculated parameter",
            Self::InnerState => "an inner state of the joint",
            Self::Indicator => "an event indicator",
        })
    }
}

/// A set of roles; empty for a value reference that the FMU does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Roles(u16);

/// Beside the bits of roles: an input that is limited.
const LIMITED: u16 = 256;
/// Beside the bits of roles: what is calculated apart from other outputs, because it takes longer and few ask for it.
const APART: u16 = 512;
/// Beside the bits of roles: a state that goes on in other coordinates, and is told where somebody asks for it.
const CARRIED: u16 = 1024;

impl Roles {
    /// No role at all.
    pub(crate) const NONE: Self = Self(0);

    /// The set of these roles.
    pub(crate) const fn of(roles: &[Role]) -> Self {
        let mut bits = 0;
        let mut index = 0;
        while index < roles.len() {
            bits |= roles[index].bit();
            index += 1;
        }
        Self(bits)
    }

    /// Inputs that cannot have every value.
    pub(crate) const LIMITED: Self = Self(LIMITED);
    /// What is calculated apart from other outputs.
    pub(crate) const APART: Self = Self(APART);
    /// States that go on in other coordinates, and are told where somebody asks for them.
    pub(crate) const CARRIED: Self = Self(CARRIED);

    /// Both sets together.
    pub(crate) const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// This set but for that one.
    pub(crate) const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether this is just that set.
    #[inline]
    pub(crate) const fn is(self, other: Self) -> bool {
        self.0 == other.0
    }

    /// Whether the sets have a role in common.
    #[inline]
    pub(crate) const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

pub(crate) use crate::values::Values;

/// Number of values, beside what the joint's laws remember.
pub(crate) const VALUE_COUNT: usize = REFERENCE_COUNT + 6;

/// Value references of laws that stand beside another of their kind: one after the other, and no others between.
pub(crate) const FURTHER: std::ops::Range<usize> = {
    let mut start = 0;
    while !is_further(start) {
        start += 1;
    }
    let mut end = start;
    while end < REFERENCE_COUNT && is_further(end) {
        end += 1;
    }
    let mut behind = end;
    while behind < REFERENCE_COUNT {
        assert!(!is_further(behind));
        behind += 1;
    }
    start..end
};

/// Whether a value reference is that of a law that stands beside another of its kind.
const fn is_further(index: usize) -> bool {
    let mut row = 0;
    while row < DOF_COUNT {
        let mut place = FIRST_PARAMETER_COUNT;
        while place < DOF_PARAMETER_COUNT {
            if reference::LAW_PARAMETERS[row][place] == index {
                return true;
            }
            place += 1;
        }
        place = FIRST_REMEMBERED_COUNT;
        while place < REMEMBERED_COUNT {
            if reference::LAW_MEMORY[row][place] == index {
                return true;
            }
            place += 1;
        }
        place = FIRST_INNER_COUNT;
        while place < INNER_COUNT {
            if reference::INNER_RATES[row][place] == index {
                return true;
            }
            place += 1;
        }
        row += 1;
    }
    false
}

/// Whether a value of this index is remembered beside the variables.
pub(crate) fn is_beside(index: usize) -> bool {
    (REFERENCE_COUNT..VALUE_COUNT).contains(&index)
}

/// What is remembered of a joint over the preload, or with memory, beside its variables, as indices.
pub(crate) mod memory {
    use super::REFERENCE_COUNT;

    /// Preload (N·m) up to which the work of the changing stiffness was counted.
    pub(crate) const COUNTED_PRELOAD: usize = REFERENCE_COUNT;
    /// That work, J.
    pub(crate) const PRELOAD_WORK: usize = REFERENCE_COUNT + 1;
    /// Stored energy from which the balance starts, J.
    pub(crate) const FIRST_ENERGY: usize = REFERENCE_COUNT + 2;
    /// Rate of the preload at present, N·m/s, as far as it is known; not remembered, but calculated from the inputs' course.
    pub(crate) const PRELOAD_RATE: usize = REFERENCE_COUNT + 3;
    /// Time of the latest commit of a joint with memory, s.
    pub(crate) const COMMITTED_TIME: usize = REFERENCE_COUNT + 4;
    /// Power of its dampers then, W.
    pub(crate) const COMMITTED_POWER: usize = REFERENCE_COUNT + 5;
}

/// The row of the table of DOFs that the first DOF of a model is. Models of six are those of all joints in space: where a joint
/// has fewer, the others rest.
#[inline]
pub(crate) const fn first_row<const D: usize>() -> usize {
    if D == SPACE_COUNT { SPACE } else { 0 }
}

/// Values of the DOFs of a model.
#[inline]
pub(crate) fn gather<const D: usize>(values: &Values, references: &[usize; DOF_COUNT]) -> [f64; D] {
    std::array::from_fn(|dof| values[references[first_row::<D>() + dof]])
}

/// Writes values of the DOFs of a model.
#[inline]
pub(crate) fn scatter<const D: usize>(
    values: &mut Values,
    references: &[usize; DOF_COUNT],
    from: &[f64; D],
) {
    for dof in 0..D {
        values[references[first_row::<D>() + dof]] = from[dof];
    }
}

/// Whether an output is what was committed where the last step ended, and not calculated anew.
pub(crate) fn is_committed(index: usize) -> bool {
    index == reference::ENERGY_DISSIPATED
        || reference::LAW_MEMORY
            .iter()
            .flatten()
            .any(|&remembered| remembered == index)
}

// the tables are those of the same DOFs and laws
const _: () = assert!(reference::LAW_PARAMETERS.len() == DOF_COUNT);
const _: () = assert!(reference::LAW_MEMORY.len() == DOF_COUNT);
const _: () = assert!(reference::INNER_STATES[0].len() == INNER_COUNT);
const _: () = assert!(reference::INNER_RATES[0].len() == INNER_COUNT);

/// Who integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InterfaceType {
    /// The library, from one communication point to the next.
    CoSimulation,
    /// The importer.
    ModelExchange,
}

impl InterfaceType {
    /// Name for messages.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::CoSimulation => "Co-Simulation",
            Self::ModelExchange => "Model Exchange",
        }
    }
}

/// Which of the FMUs whose variables the build knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The joint alone: motion in, loads out.
    Element,
    /// Two bodies and the joint between them: loads in, motion out.
    Lap,
}

impl Kind {
    /// Name in the start-value file.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Lap => "lap",
        }
    }
}

/// Degrees of freedom of the joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dofs {
    /// Translation y.
    One,
    /// Translation y and rotation θ.
    Two,
    /// These of x, y, z, rx, ry and rz.
    Space(SpaceDofs),
}

/// A set of degrees of freedom in space, a bit for each; not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SpaceDofs(u8);

impl SpaceDofs {
    fn of(bits: u8) -> Option<Self> {
        (bits != 0 && bits >> SPACE_COUNT == 0).then_some(Self(bits))
    }
}

/// Beside a set of degrees of freedom in space, as one number.
const IN_SPACE: u8 = 128;

impl Dofs {
    /// As the start-value file tells them: the number of those in a plane, or the names of those in space, in their order.
    pub(crate) fn from_text(text: &str) -> Option<Self> {
        match text {
            "1" => return Some(Self::One),
            "2" => return Some(Self::Two),
            _ => {}
        }
        let mut bits = 0_u8;
        for name in text.split(' ') {
            let place = DOFS[SPACE..].iter().position(|dof| dof.name == name)?;
            // in their order, and none twice
            if bits >> place != 0 {
                return None;
            }
            bits |= 1 << place;
        }
        SpaceDofs::of(bits).map(Self::Space)
    }

    /// As one number, for a state that is written down.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Space(SpaceDofs(bits)) => IN_SPACE | bits,
        }
    }

    /// The reverse of [`Dofs::number`].
    pub(crate) fn from_number(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::One),
            2 => Some(Self::Two),
            _ if number & IN_SPACE != 0 => SpaceDofs::of(number & !IN_SPACE).map(Self::Space),
            _ => None,
        }
    }

    /// How many they are.
    pub(crate) const fn count(self) -> usize {
        self.rows().count_ones() as usize
    }

    /// How many the model has that serves them.
    pub(crate) const fn of_model(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Space(_) => SPACE_COUNT,
        }
    }

    /// The DOFs of that model that they are, by their place in it.
    pub(crate) fn places(self) -> impl Iterator<Item = usize> {
        let (rows, first) = (self.rows(), self.rows_of_model().start);
        self.rows_of_model()
            .filter(move |row| rows & (1 << row) != 0)
            .map(move |row| row - first)
    }

    /// Rows of the table of DOFs that the model serves and the joint has not.
    fn at_rest(self) -> impl Iterator<Item = usize> {
        let rows = self.rows();
        self.rows_of_model()
            .filter(move |row| rows & (1 << row) == 0)
    }

    fn rows_of_model(self) -> std::ops::Range<usize> {
        match self {
            Self::One | Self::Two => 0..self.of_model(),
            Self::Space(_) => SPACE..DOF_COUNT,
        }
    }

    /// The DOFs, a bit for each row of the table.
    const fn rows(self) -> u32 {
        match self {
            Self::One => 0b01,
            Self::Two => 0b11,
            Self::Space(SpaceDofs(bits)) => (bits as u32) << SPACE,
        }
    }
}

impl fmt::Display for Dofs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.count();
        match self {
            Self::One | Self::Two => write!(f, "{count} DOF"),
            Self::Space(_) => write!(f, "{count} DOF in space"),
        }
    }
}

/// The variable of the lap with this value reference, be it of whatever joint; the lap has all that the element has.
pub(crate) fn declared(reference: usize) -> Option<&'static Variable> {
    LAP.get(reference)?.as_ref()
}

/// Variables that one FMU has: a table of its kind, without those of DOFs that its joint does not have, and without those that
/// only other kinds of joints have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BuiltVariables {
    /// Which of the two FMUs.
    pub(crate) kind: Kind,
    /// Degrees of freedom of its joint.
    pub(crate) dofs: Dofs,
    /// Whether its joint's law is constant or follows from the preload.
    pub(crate) dependence: Dependence,
}

impl BuiltVariables {
    /// The variable with this value reference, if the FMU has one.
    pub(crate) fn get(self, reference: usize) -> Option<&'static Variable> {
        let table = match self.kind {
            Kind::Element => &ELEMENT,
            Kind::Lap => &LAP,
        };
        table
            .get(reference)?
            .as_ref()
            .filter(|variable| self.dependence.has(variable.joints))
            .filter(|variable| {
                let missing = !self.dofs.rows();
                variable.rows.iter().any(|needed| needed & missing == 0)
            })
    }

    /// Continuous states, in the order of the model structure, of all joints.
    const fn states(self) -> &'static [ContinuousState] {
        match self.kind {
            Kind::Element => ELEMENT_STATES,
            Kind::Lap => LAP_STATES,
        }
    }

    /// Value references of the event indicators, in the order of the model structure, of all joints.
    const fn indicators(self) -> &'static [usize] {
        match self.kind {
            Kind::Element => ELEMENT_INDICATORS,
            Kind::Lap => LAP_INDICATORS,
        }
    }
}
