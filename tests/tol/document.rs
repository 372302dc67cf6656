//! `docs/tol.md` is what the command writes.

use std::fs;
use std::path::Path;
use std::process::Command;

use bolted_joint::reproduce::PublishedTable;

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
fn quick_tables_are_in_the_document_as_the_command_writes_them() {
    let keys = ["4.2", "4.3", "two-m6x30"];
    let output = Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
        .args([&["reproduce", "--markdown"], keys.as_slice()].concat())
        .output()
        .unwrap();
    assert!(output.status.success());
    let written = String::from_utf8(output.stdout).unwrap();
    let document = document();
    let heading = "\n## ";
    let before = |text: &str| text[..text.find(heading).unwrap()].to_owned();
    assert_eq!(before(&written), before(&document));
    for key in keys {
        let table = key.parse().unwrap();
        assert_eq!(section(&written, table), section(&document, table));
    }
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
        for line in [&found.conditions, &found.differences, &found.not_given]
            .into_iter()
            .flatten()
        {
            assert!(written.contains(line.as_str()), "{table}: {line}");
        }
        for row in found.rows.iter().filter(|row| row.published.is_some()) {
            assert!(
                written.contains(&format!("| {} |", row.quantity)),
                "{row:?}"
            );
        }
    }
}
