//! Which relative motions of its two sides a joint resists.

use std::fmt;

use bolted_joint_dynamics::{
    DOF_COUNT, DOF_SETS, DOFS, Dof, DofCount, DofKind, SPACE, law::UnitRule,
};
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{EnumAccess, Error as _, VariantAccess as _, Visitor},
};

use super::units::unit;

/// Degrees of freedom of a joint, in the order of the rows of its matrices: one of [`DOF_SETS`].
///
/// In the file it is the list of their names: `["y"]` or `["y", "theta"]` for a joint in a plane, some of
/// `["x", "y", "z", "rx", "ry", "rz"]` for one in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Vec<String>", into = "Vec<&'static str>")]
pub struct DofSet(&'static [usize]);

impl DofSet {
    /// One translation alone.
    pub const TRANSLATION: Self = Self(DOF_SETS[0]);

    /// A translation and a rotation.
    pub const TRANSLATION_ROTATION: Self = Self(DOF_SETS[1]);

    /// All motions in space.
    pub const SPACE: Self = Self(DOF_SETS[DOF_SETS.len() - 1]);

    /// The set of the DOFs in space for which this is so; `None` of none, and of y alone, which is a joint in a plane.
    #[must_use]
    pub fn in_space(has: impl Fn(&'static Dof) -> bool) -> Option<Self> {
        let rows: Vec<usize> = (SPACE..DOF_COUNT).filter(|&row| has(&DOFS[row])).collect();
        DOF_SETS
            .iter()
            .find(|set| **set == rows)
            .map(|set| Self(set))
    }

    /// Whether they are motions in space, and not in a plane.
    #[must_use]
    pub const fn is_in_space(self) -> bool {
        self.0[0] >= SPACE
    }

    /// Every set that a joint can have.
    pub fn all() -> impl Iterator<Item = Self> {
        DOF_SETS.iter().map(|rows| Self(rows))
    }

    /// Number of DOFs: the order of the joint's matrices.
    #[must_use]
    pub const fn count(self) -> usize {
        self.0.len()
    }

    /// That number for [`bolted_joint_dynamics::with_dofs`].
    #[must_use]
    pub fn size(self) -> DofCount {
        // a test of the table's own sees to it that there is a case for each of its sets
        DofCount::of(self.count()).unwrap_or(DofCount::One)
    }

    /// The DOFs in the order of the matrices' rows.
    #[must_use]
    pub fn rows(self) -> impl ExactSizeIterator<Item = &'static Dof> + Clone {
        self.0.iter().map(|&row| &DOFS[row])
    }

    /// Whether any of them is a rotation.
    #[must_use]
    pub fn turns(self) -> bool {
        self.rows().any(|dof| dof.kind == DofKind::Rotation)
    }

    /// The DOF of a row of the matrices; the last one beyond them.
    #[must_use]
    pub fn row(self, index: usize) -> &'static Dof {
        let last = self.count().saturating_sub(1);
        &DOFS[self.0[index.min(last)]]
    }

    /// The rows of the table of DOFs that it has.
    #[must_use]
    pub fn indices(self) -> &'static [usize] {
        self.0
    }

    /// Names of the DOFs in the order of the matrices' rows.
    #[must_use]
    pub fn names(self) -> Vec<&'static str> {
        self.rows().map(|dof| dof.name).collect()
    }

    /// Row and column of each entry of the upper triangle of a matrix, row by row.
    pub fn entries(self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.count();
        (0..count).flat_map(move |i| (i..count).map(move |j| [i, j]))
    }

    /// Unit of a parameter at this row and column, as people write it.
    #[must_use]
    pub fn unit(self, rule: UnitRule, [row, column]: [usize; 2]) -> String {
        unit(rule, self.row(row).kind, self.row(column).kind)
    }

    /// Row of the matrices of the DOF with this name.
    #[must_use]
    pub fn position(self, name: &str) -> Option<usize> {
        self.rows().position(|dof| dof.name == name)
    }
}

/// The list as it stands in the file.
impl fmt::Display for DofSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.names())
    }
}

impl From<DofSet> for Vec<&'static str> {
    fn from(dofs: DofSet) -> Self {
        dofs.names()
    }
}

impl TryFrom<Vec<String>> for DofSet {
    type Error = String;

    fn try_from(names: Vec<String>) -> Result<Self, String> {
        Self::all()
            .find(|dofs| dofs.names() == names)
            .ok_or_else(|| {
                format!(
                    "found {names:?}, expected {} or {} in a plane, or some of {} in this order in space",
                    Self::TRANSLATION,
                    Self::TRANSLATION_ROTATION,
                    Self::SPACE
                )
            })
    }
}

/// Names of all DOFs there are; y is one in a plane and one in space.
pub(super) const NAMES: [&str; DOF_COUNT - 1] = {
    let mut names = [""; DOF_COUNT - 1];
    let (mut row, mut place) = (0, 0);
    while row < DOF_COUNT {
        if row != Y_IN_SPACE {
            names[place] = DOFS[row].name;
            place += 1;
        }
        row += 1;
    }
    names
};

/// The row of y in space; that in a plane is the first one.
const Y_IN_SPACE: usize = SPACE + 1;

/// A DOF as files name it; the first one unless another is named. Whether it is one in a plane or in space, the joint tells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DofName(usize);

impl DofName {
    /// The DOF; y is that in a plane.
    #[must_use]
    pub fn dof(self) -> &'static Dof {
        &DOFS[self.0]
    }
}

impl<'de> Deserialize<'de> for DofName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("DofName", &NAMES, DofNameVisitor)
    }
}

struct DofNameVisitor;

impl<'de> Visitor<'de> for DofNameVisitor {
    type Value = DofName;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("enum DofName")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<DofName, A::Error> {
        let (found, rest) = data.variant::<String>()?;
        rest.unit_variant()?;
        let row = DOFS.iter().position(|dof| dof.name == found);
        row.map(DofName)
            .ok_or_else(|| A::Error::unknown_variant(&found, &NAMES))
    }
}
