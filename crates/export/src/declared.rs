//! What the FMU of a joint must declare, for whoever looks into one.

use bolted_joint_dynamics::law::{DECLARATIONS, Declaration};
use bolted_joint_interface::{Interface as Declared, Joints};

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
    let mut description = Description::new(interface, file.joint.dofs, kind(file))?;
    description.set_parameters(|name| start_value(file, step_size_max_s, name))?;
    if let Some(table) = &file.joint.over_preload {
        description.set_preload(table.nominal, None);
    }
    let (_, declared) = description.finish("no token", Timestamp::from_epoch_text("0")?)?;
    Ok(declared)
}

/// Whether the FMU's joint is a constant one, or one over the preload, or with memory, or both.
pub(super) fn kind(file: &JointFile) -> Joints {
    let of_laws = Joints::of_memory_laws(DECLARATIONS);
    let own = file.joint.laws_with_memory();
    let own: Vec<String> = own.map(Declaration::numbered_name).collect();
    of_laws
        .into_iter()
        .filter(|(name, _)| own.contains(name))
        .map(|(_, joints)| joints)
        .chain(
            file.joint
                .over_preload
                .as_ref()
                .map(|table| match table.friction.is_empty() {
                    true => Joints::OVER_PRELOAD,
                    false => Joints::OVER_PRELOAD.with(Joints::FRICTION_TABLE),
                }),
        )
        .reduce(Joints::with)
        .unwrap_or(Joints::CONSTANT)
}
