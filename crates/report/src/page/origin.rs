//! Which files and which program the result comes from.

use bolted_joint_export::provenance;
use bolted_joint_joint::JointFile;

pub(super) fn section(file: &JointFile) -> String {
    let origin = file.provenance.as_ref().map(provenance);
    format!("<h2>Provenance</h2>\n{}", origin.unwrap_or_default())
}
