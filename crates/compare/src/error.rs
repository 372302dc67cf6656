//! Why joints cannot be compared.

use bolted_joint_joint::{DofSet, JointFile, LawError, OverPreload};
use thiserror::Error;

/// Why joints cannot be compared.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CompareError {
    /// Nothing to compare with.
    #[error("found {found} joint file, expected at least two")]
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// Other degrees of freedom.
    #[error(
        "{first} has the degrees of freedom {first_dofs}, {second} has {second_dofs}; expected the same: numbers of one motion say \
         nothing of those of another, and k_yy of a joint that turns is not that of one that does not"
    )]
    Dofs {
        /// Name of the first joint.
        first: String,
        /// Its degrees of freedom.
        first_dofs: DofSet,
        /// Name of the other.
        second: String,
        /// Its degrees of freedom.
        second_dofs: DofSet,
    },
    /// One depends on the preload.
    #[error(
        "{constant} is constant, {over_preload} depends on the preload; compare at one preload: --preload TORQUE"
    )]
    Kinds {
        /// Name of the joint that does not.
        constant: String,
        /// Name of the joint that does.
        over_preload: String,
    },
    /// Other preloads.
    #[error(
        "{first} has the preloads {first_n_m:?} N·m, {second} has {second_n_m:?} N·m; compare at one preload: --preload TORQUE"
    )]
    Preloads {
        /// Name of the first joint.
        first: String,
        /// Its preloads, N·m.
        first_n_m: Vec<f64>,
        /// Name of the other.
        second: String,
        /// Its preloads, N·m.
        second_n_m: Vec<f64>,
    },
    /// A joint over the preload has no law at one of its preloads.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Other laws.
    #[error(
        "{first}: found {first_laws}, {second}: found {second_laws}; expected the same laws: stiffness and damping mean something \
         else beside another law"
    )]
    Laws {
        /// Name of the first joint.
        first: String,
        /// Its laws.
        first_laws: String,
        /// Name of the other.
        second: String,
        /// Its laws.
        second_laws: String,
    },
}

/// Whether two joints have the same numbers.
pub(crate) fn comparable(
    (first_name, first): (&str, &JointFile),
    (second_name, second): (&str, &JointFile),
) -> Result<(), CompareError> {
    let (one, other) = (&first.joint, &second.joint);
    let names = || (first_name.to_owned(), second_name.to_owned());
    if one.dofs != other.dofs {
        let (first, second) = names();
        return Err(CompareError::Dofs {
            first,
            first_dofs: one.dofs,
            second,
            second_dofs: other.dofs,
        });
    }
    match (&one.over_preload, &other.over_preload) {
        (Some(OverPreload { preload, .. }), Some(theirs)) if *preload != theirs.preload => {
            let (first, second) = names();
            return Err(CompareError::Preloads {
                first,
                first_n_m: preload.clone(),
                second,
                second_n_m: theirs.preload.clone(),
            });
        }
        (Some(_), None) => {
            let (over_preload, constant) = names();
            return Err(CompareError::Kinds {
                constant,
                over_preload,
            });
        }
        (None, Some(_)) => {
            let (constant, over_preload) = names();
            return Err(CompareError::Kinds {
                constant,
                over_preload,
            });
        }
        _ => {}
    }
    let laws = |file: &JointFile| -> Vec<String> {
        let own = file.joint.friction.iter();
        let mut laws: Vec<String> = own
            .map(|own| format!("{} on {}", own.law.name, own.dof.name))
            .collect();
        laws.sort();
        laws
    };
    let told = |laws: Vec<String>| match laws.as_slice() {
        [] => "no law of friction".to_owned(),
        laws => laws.join(", "),
    };
    let (one, other) = (laws(first), laws(second));
    if one != other {
        let (first, second) = names();
        return Err(CompareError::Laws {
            first,
            first_laws: told(one),
            second,
            second_laws: told(other),
        });
    }
    Ok(())
}
