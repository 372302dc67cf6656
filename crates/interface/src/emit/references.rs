//! Writes the value references as constants: one by name for what there is once, an array over the DOFs for what each DOF has,
//! arrays over DOFs and laws for what the laws bring.

use std::{collections::BTreeMap, fmt::Write as _};

use super::{constant_name, line};
use crate::{
    frame::{At, Origin},
    interface::Interfaces,
    variable::Role,
};

/// What is nowhere in an FMU, such as an entry of a matrix between two DOFs that no joint has at the same time.
const NOWHERE: usize = usize::MAX;

/// Value references of both FMUs.
#[derive(Default)]
struct References {
    alone: BTreeMap<usize, String>,
    /// By the reference of their first DOF: pattern, and a reference for each DOF.
    dofs: Vec<(String, Vec<usize>)>,
    /// By symbol: rows and columns.
    matrices: Vec<(String, Vec<Vec<usize>>)>,
    /// Place in the list of laws and that among its parameters, and a reference for each DOF.
    parameters: BTreeMap<[usize; 2], Vec<usize>>,
    /// Likewise for what is remembered.
    memory: BTreeMap<[usize; 2], Vec<usize>>,
    /// Likewise for the inner states among that, and for their rates.
    inner: [BTreeMap<[usize; 2], Vec<usize>>; 2],
}

pub(super) fn write(source: &mut String, interfaces: &Interfaces) {
    let count = interfaces.dof_count;
    let found = References::of(interfaces);
    line!(source, "/// Value references, as indices.");
    line!(source, "pub(crate) mod reference {{");
    for (reference, name) in &found.alone {
        line!(source, "    /// `{name}`.");
        line!(
            source,
            "    pub(crate) const {}: usize = {reference};",
            constant_name(name)
        );
    }
    for (pattern, references) in &found.dofs {
        line!(source, "    /// `{pattern}` of each DOF.");
        line!(
            source,
            "    pub(crate) const {}: [usize; {count}] = {references:?};",
            constant_name(pattern)
        );
    }
    for (symbol, rows) in &found.matrices {
        line!(
            source,
            "    /// Entries of the law's matrix {symbol}, by DOFs."
        );
        line!(
            source,
            "    pub(crate) const JOINT_{}: [[usize; {count}]; {count}] = {rows:?};",
            symbol.to_uppercase()
        );
    }
    let [states, rates] = &found.inner;
    for (name, what, places) in [
        ("LAW_PARAMETERS", "The laws' parameters", &found.parameters),
        ("LAW_MEMORY", "What the laws remember", &found.memory),
        ("INNER_STATES", "The laws' inner states", states),
        ("INNER_RATES", "The rates of these states", rates),
    ] {
        let rows: Vec<Vec<usize>> = (0..count)
            .map(|row| places.values().map(|references| references[row]).collect())
            .collect();
        line!(
            source,
            "    /// {what} on each DOF, in the order of their declarations."
        );
        line!(
            source,
            "    pub(crate) const {name}: [[usize; {}]; {count}] = {rows:?};",
            places.len()
        );
    }
    line!(source, "}}");
}

impl References {
    fn of(interfaces: &Interfaces) -> Self {
        let count = interfaces.dof_count;
        let nowhere = || vec![NOWHERE; count];
        let mut found = Self::default();
        for (_, interface, expanded) in interfaces.both() {
            for declared in expanded.variables() {
                let Some(variable) = interface.variable(&declared.name) else {
                    continue;
                };
                let reference = variable.reference as usize;
                for origin in &declared.origins {
                    match origin {
                        Origin::Alone => {
                            found.alone.insert(reference, declared.name.clone());
                        }
                        Origin::Dof { pattern, row } => {
                            entry(&mut found.dofs, pattern, nowhere)[*row] = reference;
                        }
                        Origin::Parameter { place, symbol, at } => match *at {
                            At::Dof(row) => {
                                let of_dofs =
                                    found.parameters.entry(*place).or_insert_with(nowhere);
                                of_dofs[row] = reference;
                            }
                            At::Pair(one, other) => {
                                let matrix =
                                    entry(&mut found.matrices, symbol, || vec![nowhere(); count]);
                                matrix[one][other] = reference;
                                matrix[other][one] = reference;
                            }
                        },
                        Origin::Memory([law, number, row]) => {
                            let place = [*law, *number];
                            found.memory.entry(place).or_insert_with(nowhere)[*row] = reference;
                            if variable.role == Role::InnerState {
                                let [states, _] = &mut found.inner;
                                states.entry(place).or_insert_with(nowhere)[*row] = reference;
                            }
                        }
                        Origin::Rate([law, number, row]) => {
                            let [_, rates] = &mut found.inner;
                            let of_dofs = rates.entry([*law, *number]).or_insert_with(nowhere);
                            of_dofs[*row] = reference;
                        }
                    }
                }
            }
        }
        found
    }
}

/// The entry of this name, made where there is none.
fn entry<'a, T>(list: &'a mut Vec<(String, T)>, name: &str, new: impl Fn() -> T) -> &'a mut T {
    let place = list
        .iter()
        .position(|(other, _)| other == name)
        .unwrap_or_else(|| {
            list.push((name.to_owned(), new()));
            list.len() - 1
        });
    &mut list[place].1
}
