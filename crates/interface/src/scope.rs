//! Of which joints a variable is: which DOFs it needs, and on what the joint's law must rest.
//!
//! One description declares the variables of all joints; an FMU has those of its joint.

use bolted_joint_dynamics::law::Declaration;

/// A set of DOFs, one bit for each row of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u32);

impl Rows {
    /// No DOF.
    pub const NONE: Self = Self(0);

    /// The set of these rows.
    #[must_use]
    pub fn of(rows: &[usize]) -> Self {
        Self(rows.iter().fold(0, |bits, row| bits | 1 << row))
    }

    /// One bit for each row.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    const fn contains(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }
}

/// A set of kinds of joints, by what their law rests on: constant parameters alone, the preload, or the memory of laws that
/// remember the motion, one kind for each such law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Joints(u32);

impl Joints {
    /// No joint.
    pub(crate) const NONE: Self = Self(0);
    /// A joint whose law is given by parameters and remembers nothing.
    pub const CONSTANT: Self = Self(1);
    /// A joint whose law follows from the preload.
    pub const OVER_PRELOAD: Self = Self(2);
    /// A joint with memory.
    pub const MEMORY: Self = Self(!(3 | Self::FRICTION_TABLE.0 | Self::FRICTION_PARAMETERS.0));
    /// Every joint.
    pub const ANY: Self = Self(!(Self::FRICTION_TABLE.0 | Self::FRICTION_PARAMETERS.0));
    /// Beside what a joint over the preload is: its laws with memory are a table, so that it has none of their parameters.
    pub const FRICTION_TABLE: Self = Self(1 << 31);
    /// Beside the joints that a variable is of: it is a parameter of a law with memory.
    pub const FRICTION_PARAMETERS: Self = Self(1 << 30);

    /// A joint whose law is given by parameters and has the law with memory at this place among the declarations.
    #[must_use]
    pub const fn with_memory_of(law: usize) -> Self {
        Self(4 << law)
    }

    /// The joints that have to be told where they turn: with a law that remembers more than an inner state.
    #[must_use]
    pub fn that_commit(laws: &[Declaration]) -> Self {
        let mut places = laws.iter().enumerate();
        places
            .by_ref()
            .filter(|(_, law)| law.commits())
            .fold(Self::NONE, |joints, (place, _)| {
                joints.with(Self::with_memory_of(place))
            })
    }

    /// Whether they remember their motion.
    #[must_use]
    pub const fn remembers(self) -> bool {
        self.0 & Self::MEMORY.0 != 0 && self.0 & Self::CONSTANT.0 == 0
    }

    /// Whether a joint of this kind has what belongs to these joints. One over the preload has no parameter of a constant law,
    /// whatever it remembers.
    const fn has(self, of: Self) -> bool {
        if self.intersects(Self::FRICTION_TABLE) && of.intersects(Self::FRICTION_PARAMETERS) {
            return false;
        }
        if self.0 & Self::OVER_PRELOAD.0 != 0 && of.0 & Self::CONSTANT.0 != 0 {
            return of.0 & Self::OVER_PRELOAD.0 != 0;
        }
        self.intersects(of)
    }

    /// Both sets together.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// One bit for each kind.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// The laws with memory, each with the joints that have it.
    #[must_use]
    pub fn of_memory_laws(laws: &[Declaration]) -> Vec<(String, Self)> {
        let places = laws.iter().enumerate();
        places
            .filter(|(_, law)| law.remembers())
            .map(|(place, law)| (law.numbered_name(), Self::with_memory_of(place)))
            .collect()
    }

    /// The joints that have the parameters of the law at this place: its own where it remembers, else all but those over the
    /// preload.
    pub(crate) fn of_law(law: usize, laws: &[Declaration]) -> Self {
        if laws[law].remembers() {
            Self::with_memory_of(law).with(Self::FRICTION_PARAMETERS)
        } else {
            Self::CONSTANT.with(Self::MEMORY)
        }
    }

    /// The kinds by name, for types; nothing where they are all.
    pub(crate) fn label(self) -> String {
        if self == Self::ANY {
            return String::new();
        }
        [
            (Self::CONSTANT, "Constant"),
            (Self::OVER_PRELOAD, "OverPreload"),
            (Self::MEMORY, "Memory"),
        ]
        .iter()
        .filter(|(kind, _)| self.intersects(*kind))
        .map(|(_, name)| *name)
        .collect()
    }

    const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// Of which joints a variable is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scope {
    /// The DOFs that it needs; several sets where each of them suffices.
    pub(crate) rows: Vec<Rows>,
    /// The kinds of joints that it is of.
    pub(crate) joints: Joints,
}

impl Scope {
    /// Whether the FMU of a joint of this kind with these DOFs has the variable.
    #[must_use]
    pub fn includes(&self, rows: Rows, joint: Joints) -> bool {
        joint.has(self.joints) && self.rows.iter().any(|&needed| rows.contains(needed))
    }

    /// Whether joints of this kind have it, if they have its DOFs.
    #[must_use]
    pub fn includes_joint(&self, joint: Joints) -> bool {
        joint.has(self.joints)
    }

    /// Whether it is of these kinds of joints and no other.
    #[must_use]
    pub fn is_only_of(&self, joints: Joints) -> bool {
        self.joints == joints
    }
}
