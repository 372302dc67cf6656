//! The degrees of freedom that a side of a joint can have: one row each, from which names and units of variables, matrices,
//! reports and schemas follow.

/// Whether a DOF is a translation or a rotation: that gives all of its units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofKind {
    /// A displacement along an axis.
    Translation,
    /// A rotation about an axis.
    Rotation,
}

/// One degree of freedom of a side, with the names that its quantities have in an FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dof {
    /// Displacement or rotation, also the key in a joint file: `a.y`, `joint.k_yy`.
    pub name: &'static str,
    /// Its symbol on pages for people.
    pub symbol: &'static str,
    /// Its rate: `a.v`.
    pub rate: &'static str,
    /// Its acceleration: `a.acceleration`.
    pub acceleration: &'static str,
    /// The load that does work on it: `a.F`.
    pub load: &'static str,
    /// The inertia against it: `a.m`.
    pub inertia: &'static str,
    /// Translation or rotation.
    pub kind: DofKind,
}

/// A translation along an axis.
const fn translation([name, symbol, rate, acceleration, load, inertia]: [&'static str; 6]) -> Dof {
    Dof {
        name,
        symbol,
        rate,
        acceleration,
        load,
        inertia,
        kind: DofKind::Translation,
    }
}

/// A rotation about an axis.
const fn rotation(names: [&'static str; 6]) -> Dof {
    Dof {
        kind: DofKind::Rotation,
        ..translation(names)
    }
}

/// Every DOF there is, in the order of rows and columns: first those of joints in a plane, then those of joints in space.
#[rustfmt::skip]
pub const DOFS: [Dof; 8] = [
    translation(["y",  "y",  "v",  "acceleration",   "F",  "m"]),
    rotation(["theta", "θ",  "omega", "alpha",       "M",  "J"]),
    translation(["x",  "x",  "vx", "acceleration_x", "Fx", "m_x"]),
    translation(["y",  "y",  "vy", "acceleration_y", "Fy", "m_y"]),
    translation(["z",  "z",  "vz", "acceleration_z", "Fz", "m_z"]),
    rotation(["rx",    "rx", "wx", "alpha_x",        "Mx", "J_x"]),
    rotation(["ry",    "ry", "wy", "alpha_y",        "My", "J_y"]),
    rotation(["rz",    "rz", "wz", "alpha_z",        "Mz", "J_z"]),
];

/// Number of rows in [`DOFS`].
pub const DOF_COUNT: usize = DOFS.len();

/// The first row of [`DOFS`] that is one of joints in space; the others follow it.
pub const SPACE: usize = 2;

/// Number of DOFs in space.
pub const SPACE_COUNT: usize = DOF_COUNT - SPACE;

/// Sets of DOFs in space, a bit for each: all but none, and but y alone, which is a joint in a plane.
const SPACE_SET_COUNT: usize = (1 << SPACE_COUNT) - 2;
const Y_ALONE: usize = 0b10;

/// The rows of each of these sets, and how many they are; one with fewer DOFs first.
const SPACE_SETS: [([usize; SPACE_COUNT], usize); SPACE_SET_COUNT] = {
    let mut sets = [([0; SPACE_COUNT], 0); SPACE_SET_COUNT];
    let (mut place, mut count) = (0, 1);
    while count <= SPACE_COUNT {
        let mut bits: usize = 1;
        while bits < 1 << SPACE_COUNT {
            if bits.count_ones() as usize == count && bits != Y_ALONE {
                sets[place] = rows(bits);
                place += 1;
            }
            bits += 1;
        }
        count += 1;
    }
    sets
};

/// The rows of a set of DOFs in space, and how many they are.
const fn rows(bits: usize) -> ([usize; SPACE_COUNT], usize) {
    let (mut rows, mut count, mut dof) = ([0; SPACE_COUNT], 0, 0);
    while dof < SPACE_COUNT {
        if bits & (1 << dof) != 0 {
            rows[count] = SPACE + dof;
            count += 1;
        }
        dof += 1;
    }
    (rows, count)
}

/// The sets of DOFs that a joint can have, as indices of [`DOFS`]: y, y and θ, and every set in space but y alone; the full set
/// is the last.
pub const DOF_SETS: &[&[usize]] = &{
    let mut sets: [&[usize]; 2 + SPACE_SET_COUNT] = [&[]; 2 + SPACE_SET_COUNT];
    sets[0] = &[0];
    sets[1] = &[0, 1];
    let mut place = 0;
    while place < SPACE_SET_COUNT {
        let (rows, count) = &SPACE_SETS[place];
        sets[2 + place] = rows.split_at(*count).0;
        place += 1;
    }
    sets
};

/// How many DOFs a joint can have: one case for each number of which the laws are compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofCount {
    /// One.
    One,
    /// Two.
    Two,
    /// Three.
    Three,
    /// Four.
    Four,
    /// Five.
    Five,
    /// Six.
    Six,
}

impl DofCount {
    /// As many as that, if a joint can have them.
    #[must_use]
    pub const fn of(count: usize) -> Option<Self> {
        match count {
            1 => Some(Self::One),
            2 => Some(Self::Two),
            3 => Some(Self::Three),
            4 => Some(Self::Four),
            5 => Some(Self::Five),
            6 => Some(Self::Six),
            _ => None,
        }
    }
}

/// An expression in which `D` is a [`DofCount`] as a constant, so that laws of that size can be used in it:
/// `with_dofs!(count, D => file.lap::<D>())`.
#[macro_export]
macro_rules! with_dofs {
    (@each $count:expr, $D:ident => $body:expr, $($case:ident = $number:literal)+) => {
        match $count {
            $($crate::DofCount::$case => {
                const $D: usize = $number;
                $body
            })+
        }
    };
    ($count:expr, $D:ident => $body:expr) => {
        $crate::with_dofs!(@each $count, $D => $body, One = 1 Two = 2 Three = 3 Four = 4 Five = 5 Six = 6)
    };
}

impl DofKind {
    /// Unit of the displacement.
    #[must_use]
    pub const fn displacement_unit(self) -> &'static str {
        match self {
            Self::Translation => "m",
            Self::Rotation => "rad",
        }
    }

    /// Unit of the load.
    #[must_use]
    pub const fn load_unit(self) -> &'static str {
        match self {
            Self::Translation => "N",
            Self::Rotation => "N.m",
        }
    }

    /// Unit of the inertia.
    #[must_use]
    pub const fn inertia_unit(self) -> &'static str {
        match self {
            Self::Translation => "kg",
            Self::Rotation => "kg.m2",
        }
    }

    /// The word for the displacement.
    #[must_use]
    pub const fn displacement(self) -> &'static str {
        match self {
            Self::Translation => "displacement",
            Self::Rotation => "rotation",
        }
    }

    /// The word for the motion, as in "stiffness in translation".
    #[must_use]
    pub const fn motion(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
        }
    }

    /// The word for its rate.
    #[must_use]
    pub const fn rate(self) -> &'static str {
        match self {
            Self::Translation => "velocity",
            Self::Rotation => "angular velocity",
        }
    }

    /// The word for the acceleration.
    #[must_use]
    pub const fn acceleration(self) -> &'static str {
        match self {
            Self::Translation => "acceleration",
            Self::Rotation => "angular acceleration",
        }
    }

    /// The word for the load.
    #[must_use]
    pub const fn load(self) -> &'static str {
        match self {
            Self::Translation => "force",
            Self::Rotation => "moment",
        }
    }

    /// The word for the inertia.
    #[must_use]
    pub const fn inertia(self) -> &'static str {
        match self {
            Self::Translation => "mass",
            Self::Rotation => "moment of inertia",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DOF_SETS, DOFS, DofCount};

    #[test]
    fn laws_are_compiled_for_every_set() {
        for set in DOF_SETS {
            let count = DofCount::of(set.len()).unwrap();
            assert_eq!(with_dofs!(count, D => [0; D].len()), set.len());
        }
    }

    #[test]
    fn there_is_every_set_in_space_once() {
        let mut sets: Vec<&[usize]> = DOF_SETS.to_vec();
        sets.sort_unstable();
        sets.dedup();
        // 2⁶ − 1 sets that are not empty, one of which, y alone, is a joint in a plane; and y with θ
        assert_eq!((sets.len(), DOF_SETS.len()), (64, 64));
        assert_eq!(*DOF_SETS.last().unwrap(), [2, 3, 4, 5, 6, 7]);
        let names = |set: &[usize]| set.iter().map(|&row| DOFS[row].name).collect::<Vec<_>>();
        let mut all: Vec<_> = DOF_SETS.iter().map(|set| names(set)).collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), DOF_SETS.len());
    }

    #[test]
    fn no_name_stands_twice_in_a_set() {
        for set in DOF_SETS {
            let names: Vec<&str> = set
                .iter()
                .map(|&row| &DOFS[row])
                .flat_map(|dof| [dof.name, dof.rate, dof.acceleration, dof.load, dof.inertia])
                .collect();
            for (index, name) in names.iter().enumerate() {
                assert!(!names[..index].contains(name), "{name}");
            }
            assert!(set.is_sorted());
        }
    }
}
