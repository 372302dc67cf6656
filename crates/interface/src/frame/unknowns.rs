//! The model structure of a frame: unknowns and what they depend on, by names.
//!
//! An attribute for each kind of dependency lists names. `{load}` in them is the name for the line's own DOF, `{load:every}` are
//! those of all DOFs and `{load:other}` those of the others; `@load`, `@stored_energy`, `@dissipated_power` and `@escape` are
//! the parameters of laws that act on that (`@load`: on the load of the line's DOF), `@own` those of the line's own law;
//! `@state` are the inner states of laws on the line's DOF, `@state:own` that of its own law, `@state:every` all.

use std::collections::HashMap;

use super::{
    filling::Filling,
    instance::Instance,
    laws::{LawMemory, LawParameter},
    line::Line,
    words::Quantity,
};
use crate::error::InterfaceProblem;

/// Kinds of dependencies, as attributes of an unknown in a frame.
const KINDS: [&str; 3] = ["dependent", "tunable", "constant"];

/// Unknown for which FMI forbids most kinds, and for which the frames say none.
pub(super) const INITIAL: &str = "InitialUnknown";

/// An unknown of one list of the model structure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unknown {
    pub(super) tag: String,
    pub(super) name: String,
    /// Names of what it depends on, each with its kind; `None` where they are those of an earlier line.
    known: Option<Vec<(String, &'static str)>>,
    line: usize,
}

impl Unknown {
    /// The unknown that the `line` with this number gives for one DOF, or for what a law remembers there.
    pub(super) fn new(
        line: &Line,
        number: usize,
        name: String,
        instance: &Instance<'_>,
        laws: &Laws<'_>,
    ) -> Result<Self, InterfaceProblem> {
        let mut known: Option<Vec<(String, &'static str)>> = None;
        for kind in KINDS {
            let Some(tokens) = line.get(kind) else {
                continue;
            };
            let known = known.get_or_insert_default();
            for token in tokens.split_whitespace() {
                let names = laws.names(token, instance);
                for name in names.map_err(InterfaceProblem::placeholder(number))? {
                    add(known, name, kind);
                }
            }
        }
        Ok(Self {
            tag: line.tag.clone(),
            name,
            known,
            line: number,
        })
    }

    /// Takes over what an earlier line says of the same unknown.
    ///
    /// What is calculated at first is no known of what else is.
    pub(super) fn complete(
        &mut self,
        earlier: &[Self],
        laws: &Laws<'_>,
    ) -> Result<(), InterfaceProblem> {
        if self.known.is_none() {
            let same = earlier.iter().find(|other| other.name == self.name);
            let same = same.ok_or_else(|| InterfaceProblem::NothingDependedOn {
                line: self.line,
                name: self.name.clone(),
            })?;
            self.known.clone_from(&same.known);
        }
        if let (INITIAL, Some(known)) = (self.tag.as_str(), &mut self.known) {
            known.retain(|(name, _)| !laws.is_state(name));
        }
        Ok(())
    }

    /// Whether both are from one line and of one variable.
    pub(super) fn is_same_as(&self, other: &Self) -> bool {
        (self.line, &self.name) == (other.line, &other.name)
    }

    /// Takes over what the same unknown depends on for another DOF.
    pub(super) fn depend_also_as(&mut self, other: Self) {
        for (name, kind) in other.known.into_iter().flatten() {
            add(self.known.get_or_insert_default(), name, kind);
        }
    }

    /// The element of FMI, dependencies in the order of their value references.
    pub(super) fn element(
        &self,
        references: &HashMap<String, u32>,
    ) -> Result<String, InterfaceProblem> {
        let reference = |name: &String| {
            references
                .get(name.as_str())
                .copied()
                .ok_or_else(|| InterfaceProblem::UndefinedName {
                    line: self.line,
                    name: name.clone(),
                })
        };
        let mut known = self
            .known
            .iter()
            .flatten()
            .map(|(name, kind)| reference(name).map(|number| (number, *kind)))
            .collect::<Result<Vec<_>, _>>()?;
        known.sort_unstable();
        let numbers: Vec<String> = known.iter().map(|(number, _)| number.to_string()).collect();
        let kinds: Vec<&str> = known.iter().map(|&(_, kind)| kind).collect();
        let mut element = Line::new(&self.tag);
        element.push("valueReference", reference(&self.name)?.to_string());
        element.push("dependencies", numbers.join(" "));
        if self.tag != INITIAL {
            element.push("dependenciesKind", kinds.join(" "));
        }
        Ok(element.to_string())
    }
}

/// Adds a name that is not yet there.
fn add(known: &mut Vec<(String, &'static str)>, name: String, kind: &'static str) {
    if !known.iter().any(|(earlier, _)| *earlier == name) {
        known.push((name, kind));
    }
}

/// What names in the model structure can stand for.
pub(super) struct Laws<'a> {
    pub(super) filling: &'a Filling<'a>,
    pub(super) parameters: &'a [LawParameter],
    pub(super) memory: &'a [LawMemory],
}

impl Laws<'_> {
    /// The names that a word stands for, or the placeholder that stands for nothing.
    fn names(&self, token: &str, instance: &Instance<'_>) -> Result<Vec<String>, String> {
        if let Some(whose) = token.strip_prefix("@state") {
            return self.states(whose, instance);
        }
        if let Some(effect) = token.strip_prefix('@') {
            return self.acting_on(effect, instance);
        }
        let Some((prefix, rest)) = token.split_once('{') else {
            return Ok(vec![token.to_owned()]);
        };
        let (placeholder, suffix) = rest.split_once('}').ok_or(rest)?;
        let (quantity, which) = placeholder.split_once(':').unwrap_or((placeholder, ""));
        let quantity = Quantity::parse(quantity).ok_or(placeholder)?;
        let rows: Vec<usize> = match (which, instance.row()) {
            ("", Some(row)) => vec![row],
            ("every", _) => (0..self.filling.dofs.len()).collect(),
            ("other", Some(row)) => (0..self.filling.dofs.len())
                .filter(|&other| other != row && self.filling.are_together(row, other))
                .collect(),
            _ => return Err(placeholder.to_owned()),
        };
        let name = |row: usize| quantity.name(&self.filling.dofs[row]);
        Ok(rows
            .into_iter()
            .map(|row| format!("{prefix}{}{suffix}", name(row)))
            .collect())
    }

    /// Inner states: of the line's own law, of its DOF, or all of them.
    fn states(&self, whose: &str, instance: &Instance<'_>) -> Result<Vec<String>, String> {
        let here = |memory: &LawMemory| instance.row().is_none_or(|row| memory.row == row);
        let is_meant = |memory: &&LawMemory| match whose {
            ":own" => instance.law() == Some(memory.law) && here(memory),
            ":every" => true,
            _ => here(memory),
        };
        let stands_for_something = match whose {
            "" => instance.row().is_some(),
            ":own" => instance.law().is_some(),
            ":every" => true,
            _ => false,
        };
        if !stands_for_something {
            return Err(format!("@state{whose}"));
        }
        let states = self.memory.iter().filter(|memory| memory.rate.is_some());
        Ok(states
            .filter(is_meant)
            .map(|memory| memory.name.clone())
            .collect())
    }

    /// Whether this is the name of an inner state.
    pub(super) fn is_state(&self, name: &str) -> bool {
        let mut states = self.memory.iter().filter(|memory| memory.rate.is_some());
        states.any(|memory| memory.name == name)
    }

    fn acting_on(&self, effect: &str, instance: &Instance<'_>) -> Result<Vec<String>, String> {
        let here =
            |parameter: &LawParameter| instance.row().is_some_and(|row| parameter.at.touches(row));
        let acts = |parameter: &&LawParameter| match effect {
            "load" => parameter.acts_on.load && here(parameter),
            "own" => instance.law() == Some(parameter.law) && here(parameter),
            "stored_energy" => parameter.acts_on.stored_energy,
            "dissipated_power" => parameter.acts_on.dissipated_power,
            _ => parameter.acts_on.escape,
        };
        let stands_for_something = match effect {
            "load" => instance.row().is_some(),
            "own" => instance.law().is_some(),
            "stored_energy" | "dissipated_power" | "escape" => true,
            _ => false,
        };
        if !stands_for_something {
            return Err(format!("@{effect}"));
        }
        let acting = self.parameters.iter().filter(acts);
        Ok(acting.map(|parameter| parameter.name.clone()).collect())
    }
}
