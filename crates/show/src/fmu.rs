//! An FMU of this program: which interface, for which platforms, and the joint in it. None of its code is run.

use std::path::Path;

use bolted_joint_check::inspect;
use serde_json::json;

use crate::shown::short;
use crate::{ShowError, Shown, joint};

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let found = inspect(path)?;
    let mut shown = Shown::of("FMU of this program");
    shown.fact("model", found.model_name.clone());
    shown.fact("interface", found.interface.summary());
    shown.fact("platforms", found.platforms.join(", "));
    if let Some(step_s) = found.step_size_max_s {
        shown.fact("steps", format!("RK4, {} s at most", short(step_s, 2)));
    }
    joint::tell(&found.joint, &mut shown);
    let findings = found.findings.iter();
    shown
        .warnings
        .extend(findings.map(|finding| format!("{finding} (`bolted-joint check` says more)")));
    shown.detail("model_name", found.model_name);
    shown.detail("platforms", json!(found.platforms));
    shown.detail("step_size_max_s", json!(found.step_size_max_s));
    shown.next = crate::command_for(crate::FileKind::Fmu, path);
    Ok(shown)
}
