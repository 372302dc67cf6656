//! Under which terms the library in the FMU may be used.

use super::super::archive::File;

const MIT: &str = include_str!("../../../../LICENSE-MIT");
const APACHE: &str = include_str!("../../../../LICENSE-APACHE");

/// The folder's entry point, by the standard's name for it.
const ENTRY_POINT: &str = "\
The shared libraries in this FMU (binaries/) are part of bolted-joint, copyright of its developers,
and may be used under either of these licences, as you choose:

    MIT                   see MIT.txt
    Apache License 2.0    see Apache-2.0.txt

They contain parts of the Rust standard library, under the same choice of licences
(copyright of The Rust Project contributors).

The values of the joint (modelDescription.xml, resources/) belong to whoever exported this FMU.
";

/// The files of `documentation/licenses`, in the standard's spelling.
pub(in super::super) fn licences() -> [File; 3] {
    [
        File::text("documentation/licenses/license.txt", ENTRY_POINT),
        File::text("documentation/licenses/MIT.txt", MIT),
        File::text("documentation/licenses/Apache-2.0.txt", APACHE),
    ]
}

pub(super) fn section() -> String {
    "<h2>Licences</h2>\n<p>The shared libraries in this FMU may be used under the \
     <a href=\"licenses/MIT.txt\">MIT licence</a> or the <a href=\"licenses/Apache-2.0.txt\">Apache License 2.0</a>, \
     as you choose (<a href=\"licenses/license.txt\">details</a>). The values of the joint belong to whoever exported \
     the FMU.</p>\n"
        .to_owned()
}
