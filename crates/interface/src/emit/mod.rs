//! Writes the interfaces as Rust tables for the library to include.

mod outputs;
mod references;

use std::fmt::Write as _;

use crate::{
    frame::Expanded,
    interface::{Interface, Interfaces},
    scope::Joints,
};

/// Adds a line to the source.
macro_rules! line {
    ($source:expr, $($text:tt)*) => {{
        // writing to a String cannot fail
        let _ = writeln!($source, $($text)*);
    }};
}
use line;

impl Interfaces {
    /// Rust source of the tables: value references as constants, one array of variables for each FMU, and what each calculates.
    ///
    /// The including module has to offer `Variable`, `ContinuousState` (with the fields written here), `Role`, `Values`,
    /// `scatter` and the standard library's `Cow`.
    #[must_use]
    pub fn to_rust(&self) -> String {
        let mut source = String::new();
        line!(
            source,
            "// Written by the build from modelDescription/*.xml, the DOFs and the laws: change those files, not this one.\n"
        );
        let count = self.reference_count();
        line!(source, "/// Number of value references.");
        line!(source, "pub(crate) const REFERENCE_COUNT: usize = {count};");
        line!(
            source,
            "/// Value references of the inputs of either FMU, ascending."
        );
        let inputs = self.input_references();
        line!(
            source,
            "pub(crate) const INPUT_REFERENCES: [usize; {}] = {inputs:?};",
            inputs.len()
        );
        line!(source, "/// Names of the log categories.");
        line!(
            source,
            "pub(crate) const LOG_CATEGORIES: &[&str] = &{:?};",
            self.lap.log_categories
        );
        line!(source, "/// Joints whose law is given by parameters.");
        line!(
            source,
            "const CONSTANT_JOINTS: u32 = {};",
            Joints::CONSTANT.bits()
        );
        line!(source, "/// Joints whose law follows from the preload.");
        line!(
            source,
            "const JOINTS_OVER_PRELOAD: u32 = {};",
            Joints::OVER_PRELOAD.bits()
        );
        line!(
            source,
            "/// Joints over the preload whose laws with memory are a table."
        );
        line!(
            source,
            "const JOINTS_WITH_FRICTION_TABLE: u32 = {};",
            Joints::FRICTION_TABLE.bits()
        );
        line!(source, "/// What is a parameter of a law with memory.");
        line!(
            source,
            "const FRICTION_PARAMETERS: u32 = {};",
            Joints::FRICTION_PARAMETERS.bits()
        );
        memory_laws(&mut source, &self.memory_laws);
        references::write(&mut source, self);
        for (name, interface, expanded) in self.both() {
            let constant = name.to_uppercase();
            table(&mut source, &constant, interface, expanded, count);
            states(&mut source, &constant, interface);
            indicators(&mut source, &constant, interface);
            outputs::write(&mut source, name, interface, expanded);
        }
        source
    }

    /// Name in types, interface and its source of each FMU.
    fn both(&self) -> [(&'static str, &Interface, &Expanded); 2] {
        let [element, lap] = &self.expanded;
        [("Element", &self.element, element), ("Lap", &self.lap, lap)]
    }
}

/// The laws that remember the motion, with the kind of joints that has each.
fn memory_laws(source: &mut String, laws: &[(String, Joints)]) {
    let with_memory: Vec<(&str, u32)> = laws
        .iter()
        .map(|(name, joints)| (name.as_str(), joints.bits()))
        .collect();
    line!(
        source,
        "/// Laws that remember the motion, each with the joints that have it."
    );
    line!(
        source,
        "pub(crate) const MEMORY_LAWS: &[(&str, u32)] = &{with_memory:?};"
    );
}

fn table(
    source: &mut String,
    name: &str,
    interface: &Interface,
    expanded: &Expanded,
    count: usize,
) {
    line!(
        source,
        "/// Variables of `{}` by value reference.",
        interface.file
    );
    line!(
        source,
        "pub(crate) static {name}: [Option<Variable>; REFERENCE_COUNT] = ["
    );
    for reference in 0..count {
        let variable = interface
            .variables
            .iter()
            .find(|variable| variable.reference as usize == reference)
            .and_then(|variable| Some((variable, expanded.scope(&variable.name)?)));
        match variable {
            None => line!(source, "    None,"),
            Some((variable, scope)) => {
                let rows: Vec<u32> = scope.rows.iter().map(|rows| rows.bits()).collect();
                line!(
                    source,
                    "    Some(Variable {{ name: Cow::Borrowed({:?}), unit: Cow::Borrowed({:?}), role: Role::{:?}, start: {:?}, rows: &{rows:?}, joints: {}, intermediate: {} }}),",
                    variable.name,
                    variable.unit,
                    variable.role,
                    variable.start.unwrap_or(0.0),
                    scope.joints.bits(),
                    variable.intermediate_update
                );
            }
        }
    }
    line!(source, "];");
}

fn states(source: &mut String, name: &str, interface: &Interface) {
    line!(source, "/// Continuous states of `{}`.", interface.file);
    line!(
        source,
        "pub(crate) static {name}_STATES: &[ContinuousState] = &["
    );
    for state in &interface.continuous_states {
        line!(
            source,
            "    ContinuousState {{ reference: {}, derivative: {}, nominal: {:?} }},",
            state.reference,
            state.derivative,
            state.nominal
        );
    }
    line!(source, "];");
}

fn indicators(source: &mut String, name: &str, interface: &Interface) {
    line!(
        source,
        "/// Value references of the event indicators of `{}`.",
        interface.file
    );
    line!(
        source,
        "pub(crate) static {name}_INDICATORS: &[usize] = &{:?};",
        interface.event_indicators
    );
}

/// Name of a constant or, in small letters, of a field: `a.{load}` becomes `A_LOAD` and `a.k_{displacement}`, in which the
/// placeholder tells the DOF and no more, `A_K`.
fn constant_name(pattern: &str) -> String {
    pattern
        .replace("_{displacement}", "")
        .replace(['{', '}'], "")
        .replace('.', "_")
        .to_uppercase()
}
