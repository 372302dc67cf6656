//! An FMU: of a joint or of an assembly, with what is in it, or of another tool, as far as it says what it is. None of its code is
//! run.

use std::path::Path;

use bolted_joint_check::{AssemblyInspection, ForeignFmu, foreign, inspect, inspect_assembly};
use serde_json::json;

use crate::shown::{counted, short, some};
use crate::{ShowError, Shown, joint};

/// Variables that are listed at most.
const LISTED: usize = 12;

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    if let Some(found) = foreign(path)? {
        return Ok(of_another_tool(found));
    }
    let mut shown = match inspect_assembly(path)? {
        Some(found) => of_assembly(found),
        None => of_joint(path)?,
    };
    shown.next = crate::command_for(crate::FileKind::Fmu, path);
    Ok(shown)
}

fn of_joint(path: &Path) -> Result<Shown, ShowError> {
    let found = inspect(path)?;
    let mut shown = Shown::of("FMU of this program");
    shown.fact("model", found.model_name.clone());
    shown.fact("interface", found.interface.summary());
    shown.fact("platforms", found.platforms.join(", "));
    if let Some(step_s) = found.step_size_max_s {
        shown.fact("steps", format!("RK4, {} s at most", short(step_s, 2)));
    }
    joint::tell(&found.joint, &mut shown);
    warn(&mut shown, &found.findings);
    shown.detail("model_name", found.model_name);
    shown.detail("platforms", json!(found.platforms));
    shown.detail("step_size_max_s", json!(found.step_size_max_s));
    Ok(shown)
}

fn of_assembly(found: AssemblyInspection) -> Shown {
    let mut shown = Shown::of("FMU of a whole assembly, of this program");
    shown.fact("model", found.model_name.clone());
    shown.fact("platforms", found.platforms.join(", "));
    let [loads, outputs, coordinates] = found.counts;
    shown.fact(
        "holds",
        format!(
            "{}, {}, {} of the structures",
            counted(loads, "load"),
            counted(outputs, "output"),
            counted(coordinates, "coordinate"),
        ),
    );
    if let Some(step_s) = found.suggested_step_s {
        shown.fact("steps", format!("{} s suggested", short(step_s, 2)));
    }
    shown.facts_of("parts", found.parts);
    warn(&mut shown, &found.findings);
    shown.detail("model_name", found.model_name);
    shown.detail("platforms", json!(found.platforms));
    shown.detail("suggested_step_s", json!(found.suggested_step_s));
    shown
}

fn warn(shown: &mut Shown, findings: &[String]) {
    let told = findings.iter();
    shown
        .warnings
        .extend(told.map(|finding| format!("{finding} (`bolted-joint check` says more)")));
}

fn of_another_tool(found: ForeignFmu) -> Shown {
    let mut shown = Shown::of("FMU of another tool");
    shown.fact("model", found.model_name.clone());
    if let Some(tool) = &found.tool {
        shown.fact("tool", tool);
    }
    let kinds = found.kinds.join(", ");
    shown.fact("interface", format!("FMI {}, {kinds}", found.version));
    shown.fact("platforms", found.platforms.join(", "));
    let variables = [("inputs", &found.inputs), ("outputs", &found.outputs)];
    for (label, names) in variables {
        shown.fact(label, some(names, LISTED));
    }
    shown.fact("parameters", found.parameters.to_string());
    shown.detail("model_name", found.model_name);
    shown.detail("inputs", json!(found.inputs));
    shown.detail("outputs", json!(found.outputs));
    shown.detail("platforms", json!(found.platforms));
    shown
}
