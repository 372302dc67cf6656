//! Writes the interfaces as Rust tables for the library to include.

use std::fmt::Write as _;

use crate::{
    interface::{Interface, Interfaces},
    variable::Variable,
};

impl Interfaces {
    /// Rust source of the tables: value references as constants, one array of variables for each FMU.
    ///
    /// The including module has to offer `Variable`, `ContinuousState` (with the fields written here), `Role` and `Dependence`.
    #[must_use]
    pub fn to_rust(&self) -> String {
        let mut source = String::from(
            "// Written by the build from modelDescription/*.xml: change those files, not this one.\n\n",
        );
        let count = self.reference_count();
        line(&mut source, "/// Number of value references.");
        line(
            &mut source,
            &format!("pub(crate) const REFERENCE_COUNT: usize = {count};"),
        );
        line(
            &mut source,
            "/// Value references of the inputs of either FMU, ascending.",
        );
        let inputs = self.input_references();
        line(
            &mut source,
            &format!(
                "pub(crate) const INPUT_REFERENCES: [usize; {}] = {inputs:?};",
                inputs.len()
            ),
        );
        line(&mut source, "/// Names of the log categories.");
        line(
            &mut source,
            &format!(
                "pub(crate) const LOG_CATEGORIES: &[&str] = &{:?};",
                self.lap.log_categories
            ),
        );
        line(&mut source, "/// Value references, as indices.");
        line(&mut source, "pub(crate) mod reference {");
        for variable in self.by_reference().into_iter().flatten() {
            line(
                &mut source,
                &format!("    /// `{}` in {}.", variable.name, variable.unit),
            );
            line(
                &mut source,
                &format!(
                    "    pub(crate) const {}: usize = {};",
                    constant_name(&variable.name),
                    variable.reference
                ),
            );
        }
        line(&mut source, "}");
        for (name, interface) in [("ELEMENT", &self.element), ("LAP", &self.lap)] {
            table(&mut source, name, interface, count);
            states(&mut source, name, interface);
        }
        source
    }

    /// The variable of either FMU at each value reference.
    fn by_reference(&self) -> Vec<Option<&Variable>> {
        let mut variables = vec![None; self.reference_count()];
        for variable in self.element.variables.iter().chain(&self.lap.variables) {
            variables[variable.reference as usize] = Some(variable);
        }
        variables
    }
}

fn table(source: &mut String, name: &str, interface: &Interface, count: usize) {
    line(
        source,
        &format!("/// Variables of `{}` by value reference.", interface.file),
    );
    line(
        source,
        &format!("pub(crate) static {name}: [Option<Variable>; REFERENCE_COUNT] = ["),
    );
    for reference in 0..count {
        let variable = interface
            .variables
            .iter()
            .find(|variable| variable.reference as usize == reference);
        match variable {
            None => line(source, "    None,"),
            Some(variable) => line(
                source,
                &format!(
                    "    Some(Variable {{ name: {:?}, unit: {:?}, role: Role::{:?}, start: {:?}, rotational: {}, dependence: Dependence::{:?}, intermediate: {} }}),",
                    variable.name,
                    variable.unit,
                    variable.role,
                    variable.start.unwrap_or(0.0),
                    variable.requires_rotation(),
                    variable.dependence(),
                    variable.intermediate_update,
                ),
            ),
        }
    }
    line(source, "];");
}

fn states(source: &mut String, name: &str, interface: &Interface) {
    line(
        source,
        &format!("/// Continuous states of `{}`.", interface.file),
    );
    line(
        source,
        &format!("pub(crate) static {name}_STATES: &[ContinuousState] = &["),
    );
    for state in &interface.continuous_states {
        line(
            source,
            &format!(
                "    ContinuousState {{ reference: {}, derivative: {}, nominal: {:?} }},",
                state.reference, state.derivative, state.nominal
            ),
        );
    }
    line(source, "];");
}

/// `a.theta` becomes `A_THETA`; letters that differ only by case (`a.m`, `a.M`) are kept apart by spelling loads out.
fn constant_name(name: &str) -> String {
    let words: Vec<&str> = name.split('.').collect();
    let spelled = words.iter().map(|word| match *word {
        "F" => "force",
        "M" => "moment",
        "J" => "moment_of_inertia",
        "m" => "mass",
        other => other,
    });
    spelled.collect::<Vec<_>>().join("_").to_uppercase()
}

fn line(source: &mut String, text: &str) {
    // writing to a String cannot fail
    let _ = writeln!(source, "{text}");
}
