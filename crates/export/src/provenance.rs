//! Which files and which program a joint comes from.

use bolted_joint_figures::html::{cell, escaped, number, table};
use bolted_joint_joint::{BandOriginRecord, Provenance};

/// Bolts, bands of the averages, and what came from modes, a sentence each.
fn beside(provenance: &Provenance) -> String {
    let mut sentences = Vec::new();
    match provenance.bolts.as_slice() {
        [] => {}
        [bolt] => sentences.push(format!("The joint is that of bolt {}.", escaped(bolt))),
        bolts => sentences.push(format!(
            "The same joint is at each of the bolts {}.",
            escaped(&bolts.join(", "))
        )),
    }
    if let Some(bands) = &provenance.bands {
        let entries = [
            ("yy", &bands.yy),
            ("yθ", &bands.ytheta),
            ("θθ", &bands.thetatheta),
        ];
        let entries = entries.into_iter().filter_map(|(name, band)| {
            let band = band.as_ref()?;
            let ranges = band.frequency_hz.iter();
            let ranges =
                ranges.map(|[from, to]| format!("{} to {} Hz", number(*from), number(*to)));
            let ranges = ranges.collect::<Vec<_>>().join(", ");
            Some(match band.origin {
                BandOriginRecord::Study => format!("{name} over {ranges} (given)"),
                BandOriginRecord::Automatic => format!("{name} over {ranges} (chosen)"),
                BandOriginRecord::Median => format!("{name} by the median over all lines"),
            })
        });
        let entries: Vec<String> = entries.collect();
        sentences.push(format!(
            "Averages of the decoupled values: {}.",
            entries.join("; ")
        ));
    }
    for found in &provenance.from_modes {
        if found.functions.is_empty() {
            continue;
        }
        let functions = found.functions.iter();
        let functions: Vec<String> = functions.map(|[p, q]| format!("{p} / {q}")).collect();
        sentences.push(format!(
            "Of substructure {}, {} come from the modes in <code>{}</code>, taken as exact.",
            escaped(&found.substructure.to_uppercase()),
            escaped(&functions.join(", ")),
            escaped(&found.file)
        ));
    }
    match sentences.is_empty() {
        true => String::new(),
        false => format!("<p>{}</p>\n", sentences.join(" ")),
    }
}

/// Method and tool in a sentence, the files with their hashes in a table, the notes in a list.
pub fn provenance(provenance: &Provenance) -> String {
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
    html += &beside(provenance);
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
