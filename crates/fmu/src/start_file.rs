//! The start-value file `resources/start.txt`: which model the FMU is, its token and its parameters.

use std::{fmt, str::Lines};

use crate::interface::{Dofs, Kind, Role, Values, Variables};

/// First line of every start-value file.
pub(crate) const HEADER: &str = "bolted-joint-start/1";

/// What the file says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StartFile {
    /// Kind and degrees of freedom of the FMU.
    pub(crate) variables: Variables,
    /// Token that the importer has to give at instantiation.
    pub(crate) token: String,
    /// Start values of all variables: parameters from the file, the rest from the model description.
    pub(crate) values: Values,
}

/// Why a start-value file is refused. Line numbers start at 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StartFileError {
    /// Path of the file.
    pub(crate) path: String,
    /// Line number.
    pub(crate) line: usize,
    /// What is wrong there.
    pub(crate) fault: Fault,
}

/// What is wrong in a line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Fault {
    /// The line says something else than it must.
    Unexpected {
        found: String,
        expected: &'static str,
    },
    /// The line is not `name value`.
    NotAPair { found: String },
    /// No parameter of this FMU has that name.
    UnknownName { found: String },
    /// The parameter was given before.
    Duplicate { name: &'static str },
    /// The value is not a finite number.
    NotFinite { name: &'static str, found: String },
    /// The file ends without this parameter.
    Missing { name: &'static str },
}

impl fmt::Display for StartFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, line {}: ", self.path, self.line)?;
        match &self.fault {
            Fault::Unexpected { found, expected } => {
                write!(f, "found \"{found}\", expected {expected}")?;
            }
            Fault::NotAPair { found } => {
                write!(
                    f,
                    "found \"{found}\", expected the name of a parameter, a space and a number"
                )?;
            }
            Fault::UnknownName { found } => {
                write!(f, "\"{found}\" is not a parameter of this FMU")?;
            }
            Fault::Duplicate { name } => write!(f, "parameter {name} is given a second time")?,
            Fault::NotFinite { name, found } => {
                write!(
                    f,
                    "parameter {name} is \"{found}\", expected a finite number"
                )?;
            }
            Fault::Missing { name } => write!(f, "the file ends without parameter {name}")?,
        }
        f.write_str("; export the FMU again")
    }
}

impl StartFile {
    /// Reads the text of the file at `path`.
    pub(crate) fn parse(path: &str, text: &str) -> Result<Self, StartFileError> {
        let mut header = Header {
            path,
            lines: text.lines(),
            line: 0,
        };
        header.next("", "the header bolted-joint-start/1", |found| {
            (found == HEADER).then_some(())
        })?;
        let kind = header.next("model ", "\"model element\" or \"model lap\"", |found| {
            [Kind::Element, Kind::Lap]
                .into_iter()
                .find(|kind| kind.name() == found)
        })?;
        let dofs = header.next("dofs ", "\"dofs 1\" or \"dofs 2\"", |found| match found {
            "1" => Some(Dofs::One),
            "2" => Some(Dofs::Two),
            _ => None,
        })?;
        let token = header.next("token ", "\"token\" and the instantiation token", |found| {
            (!found.trim().is_empty()).then(|| found.to_owned())
        })?;
        let variables = Variables { kind, dofs };
        let values = parse_parameters(header, variables)?;
        Ok(Self {
            variables,
            token,
            values,
        })
    }
}

/// The lines of fixed meaning at the top.
struct Header<'a> {
    path: &'a str,
    lines: Lines<'a>,
    line: usize,
}

impl Header<'_> {
    fn next<T>(
        &mut self,
        prefix: &str,
        expected: &'static str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, StartFileError> {
        self.line += 1;
        let found = self.lines.next().unwrap_or("");
        found
            .strip_prefix(prefix)
            .and_then(read)
            .ok_or_else(|| StartFileError {
                path: self.path.to_owned(),
                line: self.line,
                fault: Fault::Unexpected {
                    found: shortened(found),
                    expected,
                },
            })
    }
}

fn parse_parameters(header: Header<'_>, variables: Variables) -> Result<Values, StartFileError> {
    let Header {
        path,
        lines,
        mut line,
    } = header;
    let refuse = |line: usize, fault: Fault| StartFileError {
        path: path.to_owned(),
        line,
        fault,
    };
    let parameters: Vec<(usize, &'static str)> = variables
        .iter()
        .filter(|(_, variable)| variable.role == Role::Parameter)
        .map(|(reference, variable)| (reference, variable.name))
        .collect();
    let mut values = variables.start();
    let mut given: Vec<usize> = Vec::with_capacity(parameters.len());
    for text in lines {
        line += 1;
        let Some((found, number)) = text.split_once(' ') else {
            return Err(refuse(
                line,
                Fault::NotAPair {
                    found: shortened(text),
                },
            ));
        };
        let Some(&(reference, name)) = parameters.iter().find(|(_, name)| *name == found) else {
            return Err(refuse(
                line,
                Fault::UnknownName {
                    found: shortened(found),
                },
            ));
        };
        if given.contains(&reference) {
            return Err(refuse(line, Fault::Duplicate { name }));
        }
        let value = number.parse().ok().filter(|value: &f64| value.is_finite());
        let Some((slot, value)) = values.get_mut(reference).zip(value) else {
            return Err(refuse(
                line,
                Fault::NotFinite {
                    name,
                    found: shortened(number),
                },
            ));
        };
        *slot = value;
        given.push(reference);
    }
    match parameters
        .iter()
        .find(|(reference, _)| !given.contains(reference))
    {
        Some(&(_, name)) => Err(refuse(line, Fault::Missing { name })),
        None => Ok(values),
    }
}

/// The beginning of a line, so that a file of another kind does not fill the log.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        text.to_owned()
    } else {
        text.chars().take(LONGEST).chain("...".chars()).collect()
    }
}
