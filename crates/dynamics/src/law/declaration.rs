//! What a law says of itself once, from which variables, files, schemas, checks and pages follow.

/// A law of the joint: its parameters and what it remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Declaration {
    /// Name in joint files and messages.
    pub name: &'static str,
    /// What it is, in one sentence for people.
    pub summary: &'static str,
    /// Its parameters, in the order in which it takes them.
    pub parameters: &'static [Parameter],
    /// What it remembers of the motion that is a variable, in the order in which it gives it; nothing for a law without memory.
    pub memory: &'static [Remembered],
    /// Number of numbers that it remembers behind those, and that are no variables: part of the state, and nothing that
    /// people would look at.
    pub hidden_memory: usize,
    /// How many of its kind there can be on each DOF.
    pub at_most: usize,
    /// Which of them it is, from 1.
    pub number: usize,
}

impl Declaration {
    /// Number of numbers that it remembers.
    #[must_use]
    pub const fn memory_count(&self) -> usize {
        self.memory.len() + self.hidden_memory
    }

    /// The law that is that one of its kind.
    pub(super) const fn numbered(self, number: usize) -> Self {
        Self { number, ..self }
    }

    /// Its name, behind which all but the first of a kind have their number.
    #[must_use]
    pub fn numbered_name(&self) -> String {
        match self.number {
            1 => self.name.to_owned(),
            number => format!("{}_{number}", self.name),
        }
    }

    /// Name of the variable with one of its symbols on a DOF: `joint.SYMBOL_DOF`, such as `joint.jenkins_k_y`. All but the first
    /// of a kind have their number behind the kind: `joint.jenkins_2_k_y`.
    #[must_use]
    pub fn variable(&self, symbol: &str, dof: &str) -> String {
        let kind = self.name.replace('-', "_");
        match (self.number, symbol.strip_prefix(&kind)) {
            (1, _) | (_, None) => format!("joint.{symbol}_{dof}"),
            (number, Some(own)) => format!("joint.{kind}_{number}{own}_{dof}"),
        }
    }

    /// Whether it remembers anything.
    #[must_use]
    pub const fn remembers(&self) -> bool {
        self.memory_count() > 0
    }

    /// Number of its inner states: of what it remembers and that follows a differential equation.
    #[must_use]
    pub const fn inner_count(&self) -> usize {
        let (mut count, mut place) = (0, 0);
        while place < self.memory.len() {
            if self.memory[place].rate.is_some() {
                count += 1;
            }
            place += 1;
        }
        count
    }

    /// Whether it remembers anything beside inner states, such that it has to be told where the joint turns.
    #[must_use]
    pub const fn commits(&self) -> bool {
        self.remembers() && self.inner_count() == 0
    }
}

/// A parameter that is outside of its law's range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outside {
    /// Place of the parameter in the law's declaration.
    pub parameter: usize,
    /// What the law takes there, for people.
    pub expected: String,
}

impl Outside {
    /// The parameter at this place.
    pub(super) fn at(parameter: usize, expected: impl Into<String>) -> Option<Self> {
        let expected = expected.into();
        Some(Self {
            parameter,
            expected,
        })
    }
}

/// Whether a parameter is a finite number above zero.
pub(super) fn is_positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// One parameter of a law, on each DOF or between each two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Variable `joint.SYMBOL_DOF`, such as `k3` in `joint.k3_y`; between DOFs `joint.SYMBOL_DOFDOF`.
    pub symbol: &'static str,
    /// Key in a joint file.
    pub key: &'static str,
    /// Where it is.
    pub span: Span,
    /// Its unit.
    pub unit: UnitRule,
    /// Values that it can have.
    pub range: Range,
    /// Name of its type for each kind of place.
    pub quantity: Quantity,
    /// What it is, for people. `{load}`, `{motion}` and `{rate}` stand for the words of its DOF.
    pub description: &'static str,
    /// What changes with it.
    pub acts_on: ActsOn,
    /// Whether it grows as the preload of the bolt does, where the joint depends on that: what presses makes what slides.
    pub grows_with_preload: bool,
}

/// Where a parameter is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// On each relative DOF.
    Dof,
    /// On each DOF and between each two, as the upper triangle of a symmetric matrix; with the description of an entry off the
    /// diagonal, in which `{other_load}`, `{other_motion}` and `{other_rate}` stand for the words of the second DOF.
    Matrix(&'static str),
}

/// Unit of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitRule {
    /// load · s^`seconds` / displacement^`displacement`.
    LoadPer {
        /// Power of the displacement by which the load is divided; of a pair, the second DOF's displacement is the divisor.
        displacement: u8,
        /// Power of the time by which it is multiplied.
        seconds: u8,
    },
    /// displacement / s.
    Rate,
    /// None: a number.
    One,
}

impl UnitRule {
    /// Power of the displacement by which the load is divided; zero where it is no load.
    #[must_use]
    pub const fn displacement(self) -> u8 {
        match self {
            Self::LoadPer { displacement, .. } => displacement,
            Self::Rate | Self::One => 0,
        }
    }
}

/// Values that a parameter can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Every finite number.
    Any,
    /// Zero or more.
    NotNegative,
}

/// A physical quantity as FMI types have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Name for a translation; that for a rotation has `Rotational` before it, that between the two `Coupling`.
    pub name: &'static str,
    /// Typical size in translation, between translation and rotation, and in rotation.
    pub nominal: [f64; 3],
    /// Start value where no joint file gives one, in the same places.
    pub start: [f64; 3],
}

/// Which of a joint's unknowns change with a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActsOn {
    /// The load on the DOF.
    pub load: bool,
    /// The stored energy.
    pub stored_energy: bool,
    /// The power turned into heat.
    pub dissipated_power: bool,
    /// How far a softening joint holds.
    pub escape: bool,
}

impl ActsOn {
    /// A spring: its load and what it stores, and with them how far the joint holds.
    pub const SPRING: Self = Self {
        load: true,
        stored_energy: true,
        dissipated_power: false,
        escape: true,
    };

    /// A damper: its load and its heat.
    pub const DAMPER: Self = Self {
        load: true,
        stored_energy: false,
        dissipated_power: true,
        escape: false,
    };
}

/// A number that a law remembers on each DOF, committed at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remembered {
    /// Variable `joint.SYMBOL_DOF`.
    pub symbol: &'static str,
    /// Its quantity, that is its unit and type.
    pub quantity: RememberedAs,
    /// What it is, for people; words in braces as in [`Parameter::description`].
    pub description: &'static str,
    /// Its rate, where it follows a differential equation that an importer can integrate; `None` where it moves on only
    /// at the end of a step.
    pub rate: Option<RateOf>,
}

/// The rate of a remembered number that follows a differential equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateOf {
    /// Variable `joint.SYMBOL_DOF`.
    pub symbol: &'static str,
    /// What it is, for people; words in braces as in [`Parameter::description`].
    pub description: &'static str,
}

/// What a remembered number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RememberedAs {
    /// A relative displacement of its DOF.
    Displacement,
    /// A load on its DOF.
    Load,
}
