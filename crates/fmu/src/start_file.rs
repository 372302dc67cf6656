//! The start-value file `resources/start.txt`: which model the FMU is, its token and its parameters, or its equations.

use std::{fmt, str::Lines, sync::Arc};

use bolted_joint_dynamics::{Beyond, TableDefect, law::Declaration};

use crate::{
    assembly_file::{self, AssemblyFile},
    interface::{BuiltVariables, Dependence, Dofs, Kind, Name, Role, Values, Variables, reference},
    preload_table::{PreloadTable, TableFriction, columns},
};

/// First line of every start-value file.
pub(crate) const HEADER: &str = "bolted-joint-start/1";

/// What the file says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StartFile {
    /// Kind and degrees of freedom of the FMU.
    pub(crate) variables: Variables,
    /// Token that the importer has to give at instantiation.
    pub(crate) token: String,
    /// Start values of all variables: parameters and preload from the file, the rest from the model description.
    pub(crate) values: Values,
    /// What beside the parameters gives its equations.
    pub(crate) equations: Equations,
}

/// What a model's equations come from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Equations {
    /// From the parameters of an element or a lap.
    Parameters(BuiltVariables),
    /// From them and from the table of a joint over the preload.
    OverPreload(BuiltVariables, PreloadTable),
    /// From the structures and joints of an assembly.
    Assembly(Box<AssemblyFile>),
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
    Duplicate { name: Name },
    /// The value is not a finite number.
    NotFinite { name: Name, found: String },
    /// The file ends without this parameter.
    Missing { name: Name },
    /// A line has not so many finite numbers.
    NotNumbers { found: String, count: usize },
    /// What the file lists does not belong together.
    Contradiction { what: &'static str },
    /// A line of the table has not the numbers that it must have.
    NotARow { found: String, columns: usize },
    /// The table gives no joint.
    Table(TableDefect),
    /// The preload at the start is not one of the table.
    Preload {
        found_n_m: f64,
        first_n_m: f64,
        last_n_m: f64,
    },
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
            Fault::NotNumbers { found, count } => write!(
                f,
                "found \"{found}\", expected {count} finite numbers, separated by spaces"
            )?,
            Fault::Contradiction { what } => write!(f, "{what}")?,
            Fault::NotARow { found, columns } => write!(
                f,
                "found \"{found}\", expected a line of the table: {columns} finite numbers, separated by spaces"
            )?,
            Fault::Table(defect) => write!(f, "{defect}")?,
            Fault::Preload {
                found_n_m,
                first_n_m,
                last_n_m,
            } => write!(
                f,
                "preload is {found_n_m} N.m, expected {first_n_m} to {last_n_m} N.m, as in the table"
            )?,
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
        let expected = "\"model element\", \"model lap\" or \"model assembly\"";
        let kind = header.next("model ", expected, |found| {
            let mut kinds = [Kind::Element, Kind::Lap].into_iter();
            match kinds.find(|kind| kind.name() == found) {
                None if found == assembly_file::NAME => Some(None),
                kind => kind.map(Some),
            }
        })?;
        let Some(kind) = kind else {
            return Self::of_assembly(header);
        };
        let expected =
            "\"dofs 1\", \"dofs 2\", or \"dofs\" and some of x y z rx ry rz in this order";
        let dofs = header.next("dofs ", expected, Dofs::from_text)?;
        let token = header.token()?;
        let dependence = header.laws()?.unwrap_or(Dependence::Constant);
        let laws: Vec<&'static Declaration> = dependence.laws().collect();
        let table = header.table(dofs, &laws)?;
        let dependence = match &table {
            Some(table) => dependence.over_preload(table.has_friction()),
            None => dependence,
        };
        let built = BuiltVariables {
            kind,
            dofs,
            dependence,
        };
        let variables = Variables::Built(built);
        let last = header.line;
        let values = parse_parameters(header, &variables)?;
        if let Some(table) = &table
            && !table.covers(values[reference::PRELOAD])
        {
            let [first_n_m, last_n_m] = table.range_n_m();
            let fault = Fault::Preload {
                found_n_m: values[reference::PRELOAD],
                first_n_m,
                last_n_m,
            };
            return Err(refuse(path, last + 1, fault));
        }
        Ok(Self {
            variables,
            token,
            values,
            equations: match table {
                Some(table) => Equations::OverPreload(built, table),
                None => Equations::Parameters(built),
            },
        })
    }

    fn of_assembly(mut header: Header<'_>) -> Result<Self, StartFileError> {
        let token = header.token()?;
        let (listed, file) = assembly_file::parse(&mut header)?;
        let variables = Variables::Listed(Arc::new(listed));
        Ok(Self {
            values: variables.start(),
            variables,
            token,
            equations: Equations::Assembly(Box::new(file)),
        })
    }
}

/// The lines of fixed meaning at the top.
pub(crate) struct Header<'a> {
    path: &'a str,
    lines: Lines<'a>,
    line: usize,
}

impl Header<'_> {
    /// What a line that begins with `prefix` has behind it, read.
    pub(crate) fn next<T>(
        &mut self,
        prefix: &str,
        expected: &'static str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, StartFileError> {
        self.line += 1;
        let found = self.lines.next().unwrap_or("");
        let value = found.strip_prefix(prefix).and_then(read);
        value.ok_or_else(|| {
            let found = shortened(found);
            self.refuse(self.line, Fault::Unexpected { found, expected })
        })
    }

    /// So many lines, each read.
    pub(crate) fn lines<T>(
        &mut self,
        count: usize,
        expected: &'static str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<Vec<T>, StartFileError> {
        // as long as there are lines, whatever the file says of their number
        let mut all = Vec::new();
        for _ in 0..count {
            all.push(self.next("", expected, &read)?);
        }
        Ok(all)
    }

    /// A line of so many finite numbers.
    pub(crate) fn numbers(&mut self, count: usize) -> Result<Vec<f64>, StartFileError> {
        self.line += 1;
        let found = self.lines.next().unwrap_or("");
        finite_numbers(found)
            .filter(|numbers| numbers.len() == count)
            .ok_or_else(|| {
                let found = shortened(found);
                self.refuse(self.line, Fault::NotNumbers { found, count })
            })
    }

    fn token(&mut self) -> Result<String, StartFileError> {
        self.next("token ", "\"token\" and the instantiation token", |found| {
            (!found.trim().is_empty()).then(|| found.to_owned())
        })
    }

    /// Whether there are no more lines.
    pub(crate) fn is_at_end(&self) -> bool {
        self.lines.clone().next().is_none()
    }

    /// Why the file is refused at the line that was read last.
    pub(crate) fn refuse_here(&self, fault: Fault) -> StartFileError {
        self.refuse(self.line, fault)
    }

    /// Whether the line that comes next begins like this.
    pub(crate) fn goes_on_with(&self, prefix: &str) -> bool {
        let next = self.lines.clone().next();
        next.is_some_and(|line| line.starts_with(prefix))
    }

    /// The line with the joint's laws that remember the motion, if there is one.
    fn laws(&mut self) -> Result<Option<Dependence>, StartFileError> {
        if !self.goes_on_with("laws ") {
            return Ok(None);
        }
        let expected = "\"laws\" and names of laws with memory that this library has";
        self.next("laws ", expected, Dependence::on_memory_of)
            .map(Some)
    }

    /// The table of a joint over the preload, if there is one: how many lines, what is beyond them, of a joint that remembers
    /// by these laws the preload that they are stated at or that they are in the lines, and the lines.
    fn table(
        &mut self,
        dofs: Dofs,
        laws: &[&'static Declaration],
    ) -> Result<Option<PreloadTable>, StartFileError> {
        self.table_of(dofs.count(), laws, |rows, beyond, friction| {
            PreloadTable::new(dofs, rows, beyond, friction)
        })
    }

    /// The same of so many degrees of freedom, and what `of` makes of its lines, of what is beyond, and of its friction.
    pub(crate) fn table_of<T>(
        &mut self,
        dofs: usize,
        laws: &[&'static Declaration],
        of: impl FnOnce(&[Vec<f64>], Beyond, TableFriction<'_>) -> Result<T, TableDefect>,
    ) -> Result<Option<T>, StartFileError> {
        const EXPECTED: &str = "\"table\", the number of its lines, \"refused\" or \"held\", and with laws the preload of these or \
                                \"friction\"";
        if !self.goes_on_with("table ") {
            return Ok(None);
        }
        let (count, beyond, friction) = self.next("table ", EXPECTED, |found| {
            let mut words = found.split(' ');
            let count = words.next()?.parse::<u32>().ok()?;
            let beyond = match words.next()? {
                "refused" => Beyond::Refused,
                "held" => Beyond::Held,
                _ => return None,
            };
            let friction = match (words.next(), laws) {
                (None, []) => TableFriction::None,
                (None, _) | (Some(_), []) => return None,
                (Some("friction"), laws) => TableFriction::InLines(laws),
                (Some(nominal_n_m), _) => {
                    let nominal_n_m = nominal_n_m.parse().ok()?;
                    let is_good = nominal_n_m > 0.0 && f64::is_finite(nominal_n_m);
                    TableFriction::At(is_good.then_some(nominal_n_m)?)
                }
            };
            words.next().is_none().then_some((count, beyond, friction))
        })?;
        let heading = self.line;
        let columns = columns(dofs, friction);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for _ in 0..count {
            self.line += 1;
            let line = self.lines.next().unwrap_or("");
            match finite_numbers(line) {
                Some(row) if row.len() == columns => rows.push(row),
                _ => {
                    let found = shortened(line);
                    return Err(self.refuse(self.line, Fault::NotARow { found, columns }));
                }
            }
        }
        let table = of(&rows, beyond, friction);
        table
            .map(Some)
            .map_err(|defect| self.refuse(heading, Fault::Table(defect)))
    }

    fn refuse(&self, line: usize, fault: Fault) -> StartFileError {
        refuse(self.path, line, fault)
    }
}

fn refuse(path: &str, line: usize, fault: Fault) -> StartFileError {
    StartFileError {
        path: path.to_owned(),
        line,
        fault,
    }
}

/// Finite numbers, separated by spaces.
fn finite_numbers(line: &str) -> Option<Vec<f64>> {
    line.split(' ')
        .map(|number| number.parse().ok().filter(|value: &f64| value.is_finite()))
        .collect()
}

fn parse_parameters(header: Header<'_>, variables: &Variables) -> Result<Values, StartFileError> {
    let Header {
        path,
        lines,
        mut line,
    } = header;
    let refuse = |line: usize, fault: Fault| refuse(path, line, fault);
    let parameters: Vec<(usize, &Name)> = variables
        .iter()
        .filter(|(index, variable)| {
            variable.role == Role::Parameter || *index == reference::PRELOAD
        })
        .map(|(reference, variable)| (reference, &variable.name))
        .collect();
    let mut values = variables.start();
    let mut given: Vec<usize> = Vec::with_capacity(parameters.len());
    for text in lines {
        line += 1;
        let Some((found, number)) = text.split_once(' ') else {
            let found = shortened(text);
            return Err(refuse(line, Fault::NotAPair { found }));
        };
        let Some((reference, name)) = parameters
            .iter()
            .find(|(_, name)| *name == found)
            .map(|&(reference, name)| (reference, name.clone()))
        else {
            let found = shortened(found);
            return Err(refuse(line, Fault::UnknownName { found }));
        };
        if given.contains(&reference) {
            return Err(refuse(line, Fault::Duplicate { name }));
        }
        let value = number.parse().ok().filter(|value: &f64| value.is_finite());
        let Some((slot, value)) = values.get_mut(reference).zip(value) else {
            let found = shortened(number);
            return Err(refuse(line, Fault::NotFinite { name, found }));
        };
        *slot = value;
        given.push(reference);
    }
    match parameters
        .iter()
        .find(|(reference, _)| !given.contains(reference))
    {
        Some(&(_, name)) => Err(refuse(line, Fault::Missing { name: name.clone() })),
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
