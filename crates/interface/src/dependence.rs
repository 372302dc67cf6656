//! Which variables belong to a joint of constant stiffness and damping, and which to one over the preload of its bolt.
//!
//! One description declares both; an FMU has the variables of its joint.

/// Of which joints a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// Of every joint.
    Any,
    /// Of a joint whose law is given by parameters.
    Constant,
    /// Of a joint whose law follows from the preload.
    OverPreload,
}

/// Of which joints the variable of this name is.
///
/// The rule: `joint.k…` and `joint.c…`, the coefficients of the law, are of constant joints. `preload` is of joints over the
/// preload, and so is what keeps account of the energy while it changes: `power.…` and `energy.…` but for `energy.stored` and
/// `power.dissipated`.
#[must_use]
pub fn dependence(name: &str) -> Dependence {
    match name.split_once('.') {
        None if name == "preload" => Dependence::OverPreload,
        Some(("joint", quantity)) if quantity.starts_with(['k', 'c']) => Dependence::Constant,
        Some(("power", "dissipated") | ("energy", "stored")) => Dependence::Any,
        Some(("power" | "energy", _)) => Dependence::OverPreload,
        _ => Dependence::Any,
    }
}

#[cfg(test)]
mod tests {
    use super::{Dependence, dependence};

    #[test]
    fn names_tell_the_joint() {
        for (names, expected) in [
            (
                &[
                    "joint.k_yy",
                    "joint.c_thetatheta",
                    "joint.k3_theta",
                    "joint.c2_y",
                ][..],
                Dependence::Constant,
            ),
            (
                &[
                    "preload",
                    "power.preload",
                    "power.supplied",
                    "energy.supplied",
                    "energy.dissipated",
                ],
                Dependence::OverPreload,
            ),
            (
                &[
                    "time",
                    "a.y",
                    "a.k_y",
                    "b.c_theta",
                    "joint.F",
                    "joint.M",
                    "energy.stored",
                    "power.dissipated",
                ],
                Dependence::Any,
            ),
        ] {
            for name in names {
                assert_eq!(dependence(name), expected, "{name}");
            }
        }
    }
}
