//! Which files and which program the result comes from.

use crate::html::provenance;
use crate::joint::JointFile;

pub(super) fn section(file: &JointFile) -> String {
    let origin = file.provenance.as_ref().map(provenance);
    format!("<h2>Provenance</h2>\n{}", origin.unwrap_or_default())
}
