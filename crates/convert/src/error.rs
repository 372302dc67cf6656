//! Why a tool cannot have a joint.

use thiserror::Error;

/// Why a tool cannot have a joint.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConvertError {
    /// It depends on the preload.
    #[error("found a joint over the preload, expected one at one preload: --preload TORQUE")]
    OverPreload,
    /// It has laws or terms that the tool has no elements or equations for.
    #[error(
        "found {}, which {tool} is not given as {instead}; take the joint of small motion about rest, where sliders stick and terms \
         of higher order vanish: --at-rest",
        joined(found)
    )]
    NotExpressible {
        /// What.
        found: Vec<String>,
        /// The tool.
        tool: &'static str,
        /// What it gets.
        instead: &'static str,
    },
    /// A joint of an assembly.
    #[error("joint {joint}: {source}")]
    OfJoint {
        /// Its name.
        joint: String,
        /// Why.
        source: Box<ConvertError>,
    },
    /// A name of an assembly that no variable can have.
    #[error(
        "found the name {found:?}, expected letters, digits and _ in names that become variables; give it another name"
    )]
    Name {
        /// The name.
        found: String,
    },
    /// Numbers of nodes that mean two things at once, or that the tool does not have.
    #[error("{key}: found {found}, expected {expected}")]
    Numbers {
        /// Which.
        key: &'static str,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A name that the tool would cut.
    #[error(
        "found the name {found:?} of {} characters, expected at most {most} for {tool}; give the file a shorter name",
        found.len()
    )]
    Long {
        /// The name.
        found: String,
        /// The tool.
        tool: &'static str,
        /// How many characters it takes.
        most: usize,
    },
    /// A name that means something else in the tool's language.
    #[error(
        "found the name {found:?}, a word of {language}, expected another; give the file another name"
    )]
    Reserved {
        /// The name.
        found: String,
        /// The language.
        language: &'static str,
    },
    /// The numbers do not make a law.
    #[error("{0}")]
    Law(String),
}

fn joined(all: &[String]) -> String {
    all.join(", ")
}
