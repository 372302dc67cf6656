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

/// Every DOF there is, in the order of rows and columns.
pub const DOFS: [Dof; 2] = [
    Dof {
        name: "y",
        symbol: "y",
        rate: "v",
        acceleration: "acceleration",
        load: "F",
        inertia: "m",
        kind: DofKind::Translation,
    },
    Dof {
        name: "theta",
        symbol: "θ",
        rate: "omega",
        acceleration: "alpha",
        load: "M",
        inertia: "J",
        kind: DofKind::Rotation,
    },
];

/// Number of rows in [`DOFS`].
pub const DOF_COUNT: usize = DOFS.len();

/// The sets of DOFs that a joint can have, as indices of [`DOFS`].
pub const DOF_SETS: &[&[usize]] = &[&[0], &[0, 1]];

/// How many DOFs a joint can have: one case for each number of which the laws are compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofCount {
    /// One.
    One,
    /// Two.
    Two,
}

impl DofCount {
    /// As many as that, if a joint can have them.
    #[must_use]
    pub const fn of(count: usize) -> Option<Self> {
        match count {
            1 => Some(Self::One),
            2 => Some(Self::Two),
            _ => None,
        }
    }
}

/// An expression in which `D` is a [`DofCount`] as a constant, so that laws of that size can be used in it:
/// `with_dofs!(count, D => file.lap::<D>())`.
#[macro_export]
macro_rules! with_dofs {
    ($count:expr, $D:ident => $body:expr) => {
        match $count {
            $crate::DofCount::One => {
                const $D: usize = 1;
                $body
            }
            $crate::DofCount::Two => {
                const $D: usize = 2;
                $body
            }
        }
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
