//! Writes what each FMU calculates as structures, so that the library cannot be built before it calculates every variable that
//! is declared.

use std::fmt::Write as _;

use super::{constant_name, line};
use crate::{
    frame::{Expanded, Origin},
    interface::Interface,
    scope::Joints,
    variable::Role,
};

/// What is calculated together: of the same kinds of joints, as outputs, as event indicators or as parameters.
struct Group {
    joints: Joints,
    kind: &'static str,
    fields: Vec<Field>,
}

/// One variable, or one on each DOF.
#[derive(PartialEq)]
struct Field {
    pattern: String,
    of_each_dof: bool,
}

pub(super) fn write(source: &mut String, fmu: &str, interface: &Interface, expanded: &Expanded) {
    for group in groups(interface, expanded) {
        let name = format!("{fmu}{}{}", group.joints.label(), group.kind);
        let generic = group.fields.iter().any(|field| field.of_each_dof);
        let [declared, used] = if generic {
            ["<const D: usize>", "<D>"]
        } else {
            ["", ""]
        };
        line!(source, "/// What is calculated of `{}`.", interface.file);
        line!(source, "#[derive(Clone, Copy, Debug)]");
        line!(source, "pub(crate) struct {name}{declared} {{");
        for field in &group.fields {
            let of = if field.of_each_dof { "[f64; D]" } else { "f64" };
            line!(source, "    /// `{}`.", field.pattern);
            line!(source, "    pub(crate) {}: {of},", field.name());
        }
        line!(source, "}}");
        line!(source, "impl{declared} {name}{used} {{");
        line!(source, "    /// Writes all of it to the variables.");
        line!(source, "    #[inline]");
        line!(
            source,
            "    pub(crate) fn write(&self, values: &mut Values) {{"
        );
        for field in &group.fields {
            let (constant, name) = (constant_name(&field.pattern), field.name());
            if field.of_each_dof {
                line!(
                    source,
                    "        scatter(values, &reference::{constant}, &self.{name});"
                );
            } else {
                line!(
                    source,
                    "        values[reference::{constant}] = self.{name};"
                );
            }
        }
        line!(source, "    }}");
        line!(source, "}}");
    }
}

impl Field {
    fn name(&self) -> String {
        constant_name(&self.pattern).to_lowercase()
    }
}

/// What a frame declares as calculated; what laws remember has a table of its own.
fn groups(interface: &Interface, expanded: &Expanded) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for declared in expanded.variables() {
        let role = interface
            .variable(&declared.name)
            .map(|variable| variable.role);
        let kind = match role {
            Some(Role::Output | Role::Derivative) => "Outputs",
            Some(Role::Indicator) => "Indicators",
            Some(Role::CalculatedParameter) => "CalculatedParameters",
            _ => continue,
        };
        for origin in &declared.origins {
            let field = match origin {
                Origin::Alone => Field {
                    pattern: declared.name.clone(),
                    of_each_dof: false,
                },
                Origin::Dof { pattern, .. } => Field {
                    pattern: pattern.clone(),
                    of_each_dof: true,
                },
                Origin::Parameter { .. } | Origin::Memory(_) | Origin::Rate(_) => continue,
            };
            let joints = declared.scope.joints;
            let same = |group: &&mut Group| group.joints == joints && group.kind == kind;
            match groups.iter_mut().find(same) {
                Some(group) if group.fields.contains(&field) => {}
                Some(group) => group.fields.push(field),
                None => groups.push(Group {
                    joints,
                    kind,
                    fields: vec![field],
                }),
            }
        }
    }
    groups
}
