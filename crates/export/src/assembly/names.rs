//! Names that the variables of an FMU can have.

use std::collections::BTreeMap;

use bolted_joint_assembly::AssemblyModel;

use super::super::ExportError;

/// First words that the FMU has variables of its own under.
const TAKEN: [&str; 4] = ["time", "modal", "energy", "power"];

/// Refuses names that are no words of structured names, and two variables of one name.
pub(super) fn check(model: &AssemblyModel) -> Result<(), ExportError> {
    let mut owners: BTreeMap<String, String> = BTreeMap::new();
    let mut add =
        |variable: String, owner: &str| match owners.insert(variable.clone(), owner.to_owned()) {
            None => Ok(()),
            Some(other) => Err(ExportError::SameName {
                variable,
                one: other,
                other: owner.to_owned(),
            }),
        };
    for joint in &model.joints {
        let owner = format!("joints: name = \"{}\"", joint.name);
        check_word(&owner, &joint.name)?;
        for dof in joint.file.joint.dofs.rows() {
            add(format!("{}.{}", joint.name, dof.load), &owner)?;
        }
        if joint.table().is_some() {
            add(format!("{}.preload", joint.name), &owner)?;
        }
    }
    for input in &model.inputs {
        let owner = format!("inputs.{}", input.name);
        check_word(&owner, &input.name)?;
        add(format!("{}.{}", input.name, input.letters().load), &owner)?;
    }
    for output in &model.outputs {
        let owner = format!("outputs.{}", output.name);
        check_word(&owner, &output.name)?;
        let dof = output.letters();
        for quantity in [dof.name, dof.rate] {
            add(format!("{}.{quantity}", output.name), &owner)?;
        }
    }
    Ok(())
}

pub(crate) fn check_word(key: &str, name: &str) -> Result<(), ExportError> {
    let is_word = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_word && !TAKEN.contains(&name) {
        return Ok(());
    }
    Err(ExportError::NotAWord {
        key: key.to_owned(),
        found: name.to_owned(),
        taken: TAKEN.join(", "),
    })
}
