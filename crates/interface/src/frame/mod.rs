//! Makes model descriptions from the frames `modelDescription/*.xml`.
//!
//! A frame declares once what the rows of the DOF table give for each DOF, and marks where the laws' own declarations put their
//! parameters and what they remember. It is FMI 3.0's model description but for this:
//! - `each="dof"` writes the line once for each row; braces in it stand for the row's names (in names of variables) or for the
//!   words for its quantities (in texts and types), such as `{rate}` and `{Rate}`,
//!   or for one text in translation and another in rotation, `{1.41|1e-3}`;
//! - `each="parameter"` and `each="memory"` write it for each parameter of a law and each number that a law remembers,
//!   inner states apart; `each="state"` and `each="rate"` for each inner state and its rate;
//! - `only="constant"`, `only="over_preload"`, `only="memory"` keep the variable to such joints, `only="turning"` to those
//!   that remember more than inner states, several words to either;
//! - value references are not written, but found in `value-references.txt`, and `derivative` and the model structure go by names.

mod fill;
mod filling;
mod instance;
mod laws;
mod line;
mod references;
mod types;
mod unknowns;
mod words;

pub use filling::Filling;
pub use laws::{At, LawParameter, law_parameters};

use crate::{
    error::{InterfaceError, InterfaceProblem},
    scope::Scope,
};
use fill::Filled;
use line::Line;

const ELEMENT: &str = "element.xml";
const LAP: &str = "lap.xml";
const VALUE_REFERENCES: &str = "value-references.txt";

/// The frames of both FMUs, as text.
#[derive(Clone, Copy, Debug)]
pub struct Frames<'a> {
    /// That of the joint alone.
    pub element: &'a str,
    /// That of two bodies with the joint between them.
    pub lap: &'a str,
    /// Names of variables; a name's place, counted from 0, is its value reference.
    pub value_references: &'a str,
}

impl Frames<'static> {
    /// The project's own.
    pub const PRESENT: Self = Self {
        element: include_str!("../../../../modelDescription/element.xml"),
        lap: include_str!("../../../../modelDescription/lap.xml"),
        value_references: include_str!("../../../../modelDescription/value-references.txt"),
    };
}

/// A frame that has become a model description, with what FMI does not tell of its variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Expanded {
    /// File of the frame, such as `lap.xml`.
    pub file: &'static str,
    /// The model description of FMI 3.0, with the variables of all joints.
    pub xml: String,
    variables: Vec<Declared>,
}

impl Expanded {
    /// The model descriptions of element and lap, with the project's own frames, DOFs and laws.
    ///
    /// # Errors
    ///
    /// [`InterfaceError::Inconsistent`] with what is wrong in a frame.
    pub fn present() -> Result<[Self; 2], InterfaceError> {
        Self::new(&Frames::PRESENT, &Filling::PRESENT)
    }

    /// The model descriptions of element and lap.
    ///
    /// # Errors
    ///
    /// [`InterfaceError::Inconsistent`] with what is wrong in a frame.
    pub fn new(frames: &Frames<'_>, filling: &Filling<'_>) -> Result<[Self; 2], InterfaceError> {
        let inconsistent = |file: &'static str| {
            move |problem: InterfaceProblem| InterfaceError::Inconsistent {
                file: file.to_owned(),
                problem,
            }
        };
        let filled = |file, text| Filled::new(file, text, filling).map_err(inconsistent(file));
        let element = filled(ELEMENT, frames.element)?;
        let lap = filled(LAP, frames.lap)?;
        let names = element
            .variables
            .iter()
            .chain(&lap.variables)
            .map(|variable| variable.name.as_str());
        let references = references::references(frames.value_references, names)
            .map_err(inconsistent(VALUE_REFERENCES))?;
        Ok([
            element
                .expanded(&references)
                .map_err(inconsistent(ELEMENT))?,
            lap.expanded(&references).map_err(inconsistent(LAP))?,
        ])
    }

    /// Of which joints the variable of this name is; `None` if no joint has it.
    #[must_use]
    pub fn scope(&self, name: &str) -> Option<&Scope> {
        self.variables
            .iter()
            .find(|variable| variable.name == name)
            .map(|variable| &variable.scope)
    }

    pub(crate) fn variables(&self) -> &[Declared] {
        &self.variables
    }
}

/// A variable as a frame or a law declares it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Declared {
    pub(crate) name: String,
    pub(crate) scope: Scope,
    /// Which line it comes from, and where it stands among those of that line.
    pub(crate) origins: Vec<Origin>,
    line: Line,
    number: usize,
}

/// Where a variable comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Origin {
    /// A line of its own.
    Alone,
    /// A line for each DOF: its name, with what varies, and the row.
    Dof {
        /// Name before its placeholder is filled, such as `a.{load}`.
        pattern: String,
        /// Row of the table of DOFs.
        row: usize,
    },
    /// A parameter of a law.
    Parameter {
        /// Place of the law among the declarations, and of the parameter among its own.
        place: [usize; 2],
        /// Its symbol.
        symbol: &'static str,
        /// Where it is.
        at: At,
    },
    /// What a law remembers: place of the law, of the number, and row of the table of DOFs.
    Memory([usize; 3]),
    /// The rate of an inner state, by the same places.
    Rate([usize; 3]),
}
