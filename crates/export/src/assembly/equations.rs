//! The equations of an assembly as the library reads them from the start-value file; `crates/fmu/src/assembly_file.rs` says how.

use std::fmt::Write as _;

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_dynamics::{
    assembly::{Assembly, Matrix},
    law::dof_parameters,
};

use super::super::start_file::table_lines;
use super::variables::List;

/// Name of the model in the start-value file.
pub(super) const MODEL: &str = "assembly";

/// Adds a line; writing to a `String` cannot fail.
macro_rules! line {
    ($text:expr, $($words:tt)*) => {{
        let _ = writeln!($text, $($words)*);
    }};
}

/// The list of the variables, with their units and the states' nominal values by place.
pub(super) fn list_lines(
    list: &List,
    unit: impl Fn(usize) -> String,
    nominal: impl Fn(usize) -> f64,
) -> String {
    let mut text = String::new();
    line!(text, "variables {}", list.variables.len());
    for (place, own) in list.variables.iter().enumerate() {
        let (word, name, start) = (own.role.word(), &own.name, own.start);
        line!(text, "{word} {name} {} {start:?}", unit(place));
    }
    line!(text, "apart {}", list.apart);
    let states = list.states();
    line!(text, "states {}", states.len());
    for [state, derivative] in states {
        line!(text, "{state} {derivative} {:?}", nominal(state));
    }
    text
}

/// Structures and joints.
pub(super) fn equation_lines(
    model: &AssemblyModel,
    assembly: &Assembly,
    extrapolate: bool,
) -> String {
    let mut text = String::new();
    let size = assembly.size();
    line!(text, "coordinates {size}");
    line!(
        text,
        "{}",
        numbers(assembly.frequencies_rad_per_s.iter().copied())
    );
    let damping = &assembly.damping_per_s;
    let upper = (0..size).flat_map(|i| (i..size).map(move |j| (i, j)));
    let entries: Vec<_> = upper.filter(|&place| damping[place] != 0.0).collect();
    line!(text, "damping {}", entries.len());
    for (i, j) in entries {
        line!(text, "{i} {j} {:?}", damping[(i, j)]);
    }
    line!(text, "loads {}", assembly.loads.columns());
    rows(&mut text, &assembly.loads.transposed());
    let motions = model.output_rows();
    line!(text, "motions {}", motions.nrows());
    rows(
        &mut text,
        &Matrix::from_fn(motions.nrows(), size, |i, j| motions[(i, j)]),
    );
    line!(text, "joints {}", assembly.joints.len());
    for (joint, own) in assembly.joints.iter().zip(&model.joints) {
        let dofs = own.file.joint.dofs;
        let follows = joint.over_preload.is_some();
        line!(text, "joint {} {}", own.name, dofs.names().join(" "));
        for matrix in [&joint.relative, &joint.stiffness, &joint.damping] {
            rows(&mut text, matrix);
        }
        let parameters: Vec<(String, f64)> = joint
            .laws
            .iter()
            .zip(dofs.rows())
            .flat_map(|(laws, dof)| {
                let values = dof_parameters().zip(laws.parameters());
                // springs and dampers over the preload are in the table
                let values = values.filter(move |((law, _), _)| !follows || law.remembers());
                values.map(|((law, parameter), &value)| {
                    (law.variable(parameter.symbol, dof.name), value)
                })
            })
            .filter(|(_, value)| *value != 0.0)
            .collect();
        line!(text, "laws {}", parameters.len());
        for (name, value) in parameters {
            line!(text, "{name} {value:?}");
        }
        if let Some(whole) = &own.over_preload {
            text += &table_lines(&whole.joint, extrapolate);
        }
    }
    text
}

fn rows(text: &mut String, matrix: &Matrix) {
    for row in 0..matrix.rows() {
        line!(text, "{}", numbers(matrix.row(row).iter().copied()));
    }
}

/// Numbers in as few digits as read back to them, separated by spaces.
fn numbers(all: impl Iterator<Item = f64>) -> String {
    let words: Vec<String> = all.map(|number| format!("{number:?}")).collect();
    words.join(" ")
}
