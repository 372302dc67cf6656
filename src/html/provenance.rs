//! Which files and which program a joint comes from.

use super::{cell, escaped, table};
use crate::joint::Provenance;

/// Method and tool in a sentence, the files with their hashes in a table, the notes in a list.
pub(crate) fn provenance(provenance: &Provenance) -> String {
    let mut html = format!(
        "<p>Method <code>{}</code>, joint model <code>{}</code>, by {} {}.</p>\n",
        escaped(&provenance.method),
        escaped(&provenance.model),
        escaped(&provenance.tool),
        escaped(&provenance.version),
    );
    if !provenance.inputs.is_empty() {
        let rows: Vec<String> = provenance
            .inputs
            .iter()
            .map(|input| {
                format!(
                    "{}{}<td class=\"hash\">{}</td>",
                    cell(&escaped(&input.role)),
                    cell(&escaped(&input.file)),
                    escaped(&input.sha256)
                )
            })
            .collect();
        html += &table(&["Role", "File", "SHA-256"], &rows);
    }
    if !provenance.notes.is_empty() {
        let notes: String = provenance
            .notes
            .iter()
            .map(|note| format!("<li>{}</li>\n", escaped(note)))
            .collect();
        html += &format!("<ul>\n{notes}</ul>\n");
    }
    html
}
