//! The table of the FMU's variables.

use bolted_joint_interface::{Interface as Declared, Role};

use bolted_joint_figures::html::{cell, escaped, number, number_cell, table};

pub(super) fn section(declared: &Declared) -> String {
    let rows: Vec<String> = declared
        .variables
        .iter()
        .map(|variable| {
            let role = match variable.role {
                Role::Independent => "independent",
                Role::Parameter => "parameter",
                Role::Input => "input",
                Role::State | Role::InnerState => "output, state",
                Role::Output => "output",
                Role::CalculatedParameter => "calculated parameter",
                Role::Derivative => "local, derivative of a state",
                Role::Indicator => "local, event indicator",
            };
            [
                format!(
                    "<td class=\"name\"><code>{}</code></td>",
                    escaped(&variable.name)
                ),
                number_cell(&variable.reference.to_string()),
                cell(role),
                format!("<td class=\"name\">{}</td>", escaped(&variable.unit)),
                number_cell(&variable.start.map(number).unwrap_or_default()),
                cell(&escaped(&variable.description)),
            ]
            .concat()
        })
        .collect();
    let table = table(
        &[
            "Name",
            "Reference",
            "Causality",
            "Unit",
            "Start",
            "Description",
        ],
        &rows,
    );
    let has_parameters = declared
        .variables
        .iter()
        .any(|own| own.role == Role::Parameter);
    let tunable = if has_parameters {
        "<p>Every parameter is tunable.</p>\n"
    } else {
        ""
    };
    format!("<h2>Variables</h2>\n{tunable}{table}")
}
