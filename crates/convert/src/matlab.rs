//! A function for MATLAB and Octave: parameters by name, the load on side b, and where sliders stand.

use std::fmt::Write as _;

use bolted_joint_dynamics::law::Term;
use bolted_joint_joint::{JointFile, unit};

use crate::head::{Head, ascii};
use crate::linear::{beyond_linear, laws, matrices};
use crate::{ConvertError, Converted, Options, Target};

/// The laws of friction that the function has.
const LAWS: [&str; 1] = ["jenkins"];

pub(crate) fn function(
    file: &JointFile,
    options: &Options,
    mut head: Head,
) -> Result<Converted, ConvertError> {
    let name = &options.identifier;
    let is_strange = |own: &&bolted_joint_joint::Friction| !LAWS.contains(&own.law.name);
    if file.joint.friction.iter().any(|own| is_strange(&own)) && !options.at_rest {
        return Err(ConvertError::NotExpressible {
            found: laws(file),
            tool: Target::Matlab.name(),
            instead: "more than springs, dampers, their terms of higher order and Jenkins elements",
        });
    }
    head.note(format!("the file has to be called {name}.m"));
    let [stiffness, damping] = matrices(file, options.at_rest)?;
    let count = file.joint.dofs.count();
    let mut parameters = String::new();
    let mut equations = String::new();
    for (key, matrix) in [("k", &stiffness), ("c", &damping)] {
        // writing to a String cannot fail
        let _ = writeln!(parameters, "    p.{key} = {};", written(matrix));
    }
    if let Some(own) = &file.uncertainty {
        let own = &own.standard_deviation;
        for (key, matrix) in [
            ("k_deviation", &own.stiffness),
            ("c_deviation", &own.damping),
        ] {
            if !matrix.is_empty() {
                let _ = writeln!(parameters, "    p.{key} = {};", written(matrix));
            }
        }
    }
    let mut sliders = 0;
    if !options.at_rest {
        terms(file, &mut parameters, &mut equations);
        sliders = jenkins(file, &mut parameters, &mut equations);
    }
    let names: Vec<&str> = file.joint.dofs.names();
    let memory = match sliders {
        0 => "% memory is empty: this joint has no sliders.".to_owned(),
        sliders => format!(
            "% memory: places of {sliders} sliders, zeros at the start; give what came back at the end of the step before."
        ),
    };
    let text = format!(
        "function varargout = {name}(relative, rate, memory, p)\n{comments}%\n\
         % p = {name}() gives the parameters, SI units.\n\
         % [load_b, memory] = {name}(relative, rate, memory, p) gives the load on side b.\n\
         % relative = x_a - x_b and rate = v_a - v_b have {count} rows: {names}.\n{memory}\n\
         if nargin == 0\n{parameters}    varargout = {{p}};\n    return\nend\n\
         if nargin < 4 || isempty(p), p = {name}(); end\n\
         if nargin < 3 || isempty(memory), memory = zeros({sliders}, 1); end\n\
         relative = relative(:);\nrate = rate(:);\n\
         load_b = p.k * relative + p.c * rate;\n{equations}varargout = {{load_b, memory}};\nend\n",
        comments = head.comments("% "),
        names = names.join(", "),
    );
    debug_assert!(options.at_rest || beyond_linear(file).is_empty() || !equations.is_empty());
    Ok(Converted {
        text,
        notes: head.notes,
    })
}

/// A matrix as MATLAB has it.
fn written(matrix: &[Vec<f64>]) -> String {
    let rows = matrix.iter().map(|row| {
        let row: Vec<String> = row.iter().map(|own| format!("{own:E}")).collect();
        row.join(", ")
    });
    format!("[{}]", rows.collect::<Vec<_>>().join("; "))
}

fn terms(file: &JointFile, parameters: &mut String, equations: &mut String) {
    for term in Term::ALL {
        for ((place, dof), &value) in file
            .joint
            .dofs
            .rows()
            .enumerate()
            .zip(file.joint.term(term))
        {
            if value == 0.0 {
                continue;
            }
            let (key, row) = (format!("{}_{}", term.row().symbol, dof.name), place + 1);
            let unit = ascii(&unit(term.row().unit, dof.kind, dof.kind));
            let [of_r, of_rate] = term.powers();
            let rate = if of_rate == 1 {
                format!(" * rate({row})")
            } else {
                String::new()
            };
            // writing to a String cannot fail
            let _ = writeln!(parameters, "    p.{key} = {value:E}; % {unit}");
            let _ = writeln!(
                equations,
                "load_b({row}) = load_b({row}) + p.{key} * relative({row})^{of_r}{rate};"
            );
        }
    }
}

/// Return mapping of each Jenkins element from its slider's place s: it sticks while |k (r − s)| ≤ h.
fn jenkins(file: &JointFile, parameters: &mut String, equations: &mut String) -> usize {
    let all = file.joint.friction.iter().enumerate();
    for (place, own) in all.clone() {
        let (slider, dof) = (place + 1, own.dof.name);
        let Some(row) = file.joint.dofs.position(dof).map(|row| row + 1) else {
            continue;
        };
        let [stiffness, slip] =
            [0, 1].map(|own_place: usize| own.parameters.get(own_place).copied().unwrap_or(0.0));
        // writing to a String cannot fail
        let _ = write!(
            parameters,
            "    p.jenkins{slider}_k_{dof} = {stiffness:E};\n    p.jenkins{slider}_h_{dof} = {slip:E};\n"
        );
        let _ = write!(
            equations,
            "f = p.jenkins{slider}_k_{dof} * (relative({row}) - memory({slider}));\n\
             if abs(f) > p.jenkins{slider}_h_{dof}\n    f = sign(f) * p.jenkins{slider}_h_{dof};\n    \
             memory({slider}) = relative({row}) - f / p.jenkins{slider}_k_{dof};\nend\n\
             load_b({row}) = load_b({row}) + f;\n"
        );
    }
    all.count()
}
