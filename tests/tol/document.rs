//! Every table of `docs/tol.md` says what comes out.

use std::fs;
use std::path::Path;

use bolted_joint::reproduce::PublishedTable;
use bolted_joint_testing::has;

use crate::reproduced::chapter_5;

fn document() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(folder.join("docs/tol.md")).unwrap()
}

/// What a document says under the heading of a table.
fn section(document: &str, table: PublishedTable) -> &str {
    let heading = format!("\n## {table}\n");
    let start = document.find(&heading).unwrap() + heading.len();
    let rest = &document[start..];
    rest[..rest.find("\n## ").unwrap_or(rest.len())].trim()
}

#[test]
fn every_table_of_the_document_says_what_the_command_says() {
    let document = document();
    for &table in PublishedTable::ALL {
        let written = section(&document, table);
        assert!(written.contains("| published |"), "{table}");
        if table.key().starts_with('4') {
            continue;
        }
        let found = chapter_5(table.key());
        for lines in [&found.conditions, &found.differences, &found.not_given] {
            has(written, lines);
        }
        for row in found.rows.iter().filter(|row| row.published.is_some()) {
            has(written, &[format!("| {} |", row.quantity)]);
        }
    }
}
