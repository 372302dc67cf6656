//! What the FMU of a joint must declare, for whoever looks into one.

use bolted_joint_interface::{Dependence, Interface as Declared};

use super::description::Description;
use super::parameters::start_value;
use super::{ExportError, Interface, Timestamp};
use bolted_joint_joint::JointFile;

/// The variables that an FMU of the joint in `file` declares, with their start values.
pub fn declared(
    file: &JointFile,
    interface: Interface,
    step_size_max_s: Option<f64>,
) -> Result<Declared, ExportError> {
    let mut description = Description::new(interface, file.joint.dofs, dependence(file))?;
    description.set_parameters(|name| start_value(file, step_size_max_s, name))?;
    if let Some(table) = &file.joint.over_preload {
        description.set_preload(table.nominal, None);
    }
    let (_, declared) = description.finish("no token", Timestamp::from_epoch_text("0")?)?;
    Ok(declared)
}

/// Whether the FMU's joint is a constant one or one over the preload.
pub(super) fn dependence(file: &JointFile) -> Dependence {
    match file.joint.over_preload {
        Some(_) => Dependence::OverPreload,
        None => Dependence::Constant,
    }
}
