//! The part of the start-value file that gives an assembly: the list of its variables, and its equations.
//!
//! | lines | content |
//! |---|---|
//! | `variables N`, then N lines | role, name, unit and start value of each |
//! | `apart P` | place of the first that is calculated apart from other outputs |
//! | `states N`, then N lines | places of a state and of its derivative, and its typical magnitude |
//! | `coordinates n` and 1 line | ω of each coordinate |
//! | `damping N`, then N lines | row, column and value of C, where it is not zero; each pair once |
//! | `loads N`, then N lines | how each load acts on the coordinates |
//! | `motions N`, then N lines | what the coordinates are of each motion |
//! | `joints N` | each: `joint`, its name and its DOFs; as many lines of S; K and C row by row; `laws N`, then N lines of the \
//!   name of a parameter and its value; of a joint over the preload its table as in the files of other models, and what stands \
//!   before of it are laws that remember |

use bolted_joint_dynamics::{
    DOFS, DofLaws, SPACE,
    assembly::{Assembly, AssemblyJoint, LawOverPreload, Matrix},
    law::{DOF_PARAMETER_COUNT, Declaration, dof_parameters},
};

use crate::{
    interface::{ContinuousState, FIRST_LISTED, ListedVariables, Name, Role, Variable},
    models::AssemblyLayout,
    preload_table::{self, TableFriction},
    start_file::{Fault, Header, StartFileError},
};

/// Name of the model in the start-value file.
pub(crate) const NAME: &str = "assembly";

/// More coordinates than a step could be prepared for.
const MOST_COORDINATES: usize = 2000;

/// What gives the equations of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AssemblyFile {
    /// Structures and joints.
    pub(crate) assembly: Assembly,
    /// Names of the joints.
    pub(crate) joints: Vec<String>,
    /// What the coordinates are of each motion that is an output.
    pub(crate) motions: Matrix,
}

/// Reads that part, to the end of the file.
pub(crate) fn parse(
    header: &mut Header<'_>,
) -> Result<(ListedVariables, AssemblyFile), StartFileError> {
    let count = count(header, "variables ", "\"variables\" and their number")?;
    let expected = "role, name, unit and start value of a variable";
    let variables = header.lines(count, expected, variable)?;
    let apart = header.next("apart ", "\"apart\" and a place", |text| text.parse().ok())?;
    let states = self::count(header, "states ", "\"states\" and their number")?;
    let expected = "places of a state and of its derivative, and its typical magnitude";
    let states = header.lines(states, expected, state)?;
    let mut file = AssemblyFile::parse(header)?;
    if !header.is_at_end() {
        return header.next("", "the end of the file", |_| None);
    }
    let remembering = file.assembly.laws().count() + file.assembly.over_preload().count();
    let layout = AssemblyLayout::of(&file);
    let preloads = variables.get(layout.preloads.clone()).unwrap_or_default();
    let preloads: Vec<f64> = preloads.iter().map(|own| own.start).collect();
    let are_covered = {
        let mut pairs = file.assembly.over_preload().zip(&preloads);
        pairs.all(|(law, &preload_n_m)| law.covers(preload_n_m))
    };
    if !are_covered {
        return Err(header.refuse_here(Fault::Contradiction {
            what: "found a preload at the start that is beyond its table, expected one within",
        }));
    }
    file.assembly = file.assembly.about(&preloads);
    let roles: Vec<Role> = variables.iter().map(|own| own.role).collect();
    let listed = ListedVariables::new(variables, states, apart, remembering);
    match listed.filter(|_| layout.agrees(&roles, apart)) {
        Some(listed) => Ok((listed, file)),
        None => Err(header.refuse_here(Fault::Contradiction {
            what: "the list of the variables does not belong to these structures and joints",
        })),
    }
}

fn count(
    header: &mut Header<'_>,
    prefix: &str,
    expected: &'static str,
) -> Result<usize, StartFileError> {
    header.next(prefix, expected, |text| text.parse().ok())
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

fn variable(line: &str) -> Option<Variable> {
    let mut words = line.split(' ');
    let role = match words.next()? {
        "input" => Role::Input,
        "limited" => Role::LimitedInput,
        "state" => Role::State,
        "inner" => Role::InnerState,
        "output" => Role::Output,
        "derivative" => Role::Derivative,
        "indicator" => Role::Indicator,
        _ => return None,
    };
    let [name, unit] = [words.next()?, words.next()?].map(|word| Name::Owned(word.to_owned()));
    let start = finite(words.next()?)?;
    let is_whole = words.next().is_none() && !name.is_empty();
    is_whole.then_some(Variable {
        name,
        unit,
        role,
        start,
        rows: &[0],
        joints: u32::MAX,
        intermediate: role != Role::Indicator,
    })
}

fn state(line: &str) -> Option<ContinuousState> {
    let mut words = line.split(' ');
    let mut place = || words.next()?.parse::<usize>().ok();
    let [reference, derivative] = [place()?, place()?];
    let nominal = finite(words.next()?).filter(|&nominal| nominal > 0.0)?;
    let state = ContinuousState {
        reference: FIRST_LISTED.checked_add(reference)?,
        derivative: FIRST_LISTED.checked_add(derivative)?,
        nominal,
    };
    words.next().is_none().then_some(state)
}

impl AssemblyFile {
    fn parse(header: &mut Header<'_>) -> Result<Self, StartFileError> {
        let expected = "\"coordinates\" and their number, 1 to 2000";
        let size = header.next("coordinates ", expected, |text| {
            let size = text.parse().ok()?;
            (1..=MOST_COORDINATES).contains(&size).then_some(size)
        })?;
        let frequencies = header.numbers(size)?;
        if frequencies.iter().any(|&frequency| frequency < 0.0) {
            return Err(header.refuse_here(Fault::Contradiction {
                what: "found a frequency below zero, expected none",
            }));
        }
        let entries = count(header, "damping ", "\"damping\" and the number of entries")?;
        let expected = "row, column and value of an entry of the damping";
        let entries = header.lines(entries, expected, |line| entry(line, size))?;
        let mut damping = Matrix::zeros(size, size);
        for (i, j, value) in entries {
            damping[(i, j)] = value;
            damping[(j, i)] = value;
        }
        let loads = count(header, "loads ", "\"loads\" and their number")?;
        let loads = rows(header, loads, size)?.transposed();
        let motions = count(header, "motions ", "\"motions\" and their number")?;
        let motions = rows(header, motions, size)?;
        let joints = count(header, "joints ", "\"joints\" and their number")?;
        let mut names = Vec::new();
        let mut all = Vec::new();
        for _ in 0..joints {
            let (name, joint) = joint(header, size)?;
            names.push(name);
            all.push(joint);
        }
        Ok(Self {
            assembly: Assembly {
                frequencies_rad_per_s: frequencies,
                damping_per_s: damping,
                loads,
                joints: all,
            },
            joints: names,
            motions,
        })
    }
}

fn entry(line: &str, size: usize) -> Option<(usize, usize, f64)> {
    let mut words = line.split(' ');
    let mut place = || {
        words
            .next()?
            .parse::<usize>()
            .ok()
            .filter(|&place| place < size)
    };
    let (i, j) = (place()?, place()?);
    let value = finite(words.next()?)?;
    words.next().is_none().then_some((i, j, value))
}

fn rows(header: &mut Header<'_>, count: usize, columns: usize) -> Result<Matrix, StartFileError> {
    let mut rows = Vec::new();
    for _ in 0..count {
        rows.push(header.numbers(columns)?);
    }
    Ok(Matrix::from_fn(rows.len(), columns, |i, j| rows[i][j]))
}

fn joint(header: &mut Header<'_>, size: usize) -> Result<(String, AssemblyJoint), StartFileError> {
    let expected = "\"joint\", its name and its degrees of freedom";
    let (name, dofs) = header.next("joint ", expected, |text| {
        let (name, dofs) = text.split_once(' ')?;
        Some((name.to_owned(), dof_rows(dofs)?))
    })?;
    let count = dofs.len();
    let relative = rows(header, count, size)?;
    let stiffness = rows(header, count, count)?;
    let damping = rows(header, count, count)?;
    let parameters = self::count(
        header,
        "laws ",
        "\"laws\" and the number of their parameters",
    )?;
    let expected =
        "the name of a parameter of a law on one of the joint's degrees of freedom, and its value";
    let parameters = header.lines(parameters, expected, |line| {
        let (name, value) = line.split_once(' ')?;
        let (dof, place) = parameter(name, &dofs)?;
        Some((dof, place, finite(value)?))
    })?;
    let mut laws = vec![[0.0; DOF_PARAMETER_COUNT]; count];
    for (dof, place, value) in parameters {
        laws[dof][place] = value;
    }
    let laws: Vec<DofLaws> = laws.into_iter().map(DofLaws::new).collect();
    if laws.iter().any(|laws| laws.outside().is_some()) {
        return Err(header.refuse_here(Fault::Contradiction {
            what: "found a parameter outside of the range of its law",
        }));
    }
    let remembering = laws_with_memory(&laws);
    let over_preload = header.table_of(count, &remembering, |rows, beyond, friction| {
        let places: Vec<usize> = (0..count).collect();
        let law: LawOverPreload = preload_table::joint(&places, rows, beyond, friction)?;
        Ok(match friction {
            TableFriction::At(nominal_n_m) => {
                let on = std::array::from_fn(|i| laws.get(i).copied().unwrap_or(DofLaws::NONE));
                law.with_friction(on, nominal_n_m)
            }
            TableFriction::None | TableFriction::InLines(_) => law,
        })
    })?;
    let joint = AssemblyJoint {
        relative,
        stiffness,
        damping,
        laws,
        over_preload: over_preload.map(Box::new),
    };
    Ok((name, joint))
}

/// Rows of the table of DOFs: those in a plane, or those in space, in their order.
fn dof_rows(names: &str) -> Option<Vec<usize>> {
    let of_plane = matches!(names, "y" | "y theta");
    let first = if of_plane { 0 } else { SPACE };
    let mut rows: Vec<usize> = Vec::new();
    for name in names.split(' ') {
        let row = first + DOFS[first..].iter().position(|dof| dof.name == name)?;
        if rows.last().is_some_and(|&last| last >= row) {
            return None;
        }
        rows.push(row);
    }
    Some(rows)
}

/// The DOF and the place among its laws' parameters of the one with this name.
fn parameter(name: &str, dofs: &[usize]) -> Option<(usize, usize)> {
    dofs.iter().enumerate().find_map(|(dof, &row)| {
        let named = |(law, parameter): (
            &bolted_joint_dynamics::law::Declaration,
            &bolted_joint_dynamics::law::Parameter,
        )| { law.variable(parameter.symbol, DOFS[row].name) == name };
        Some((dof, dof_parameters().position(named)?))
    })
}

/// The laws that remember which have a parameter on any of these degrees of freedom, in the order in which laws are declared.
fn laws_with_memory(on: &[DofLaws]) -> Vec<&'static Declaration> {
    let mut all: Vec<&'static Declaration> = Vec::new();
    for (place, (law, _)) in dof_parameters().enumerate() {
        let is_there = on.iter().any(|laws| laws.parameters()[place] != 0.0);
        let is_new = |last: &&Declaration| (last.name, last.number) != (law.name, law.number);
        if law.remembers() && is_there && all.last().is_none_or(is_new) {
            all.push(law);
        }
    }
    all
}
