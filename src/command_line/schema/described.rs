//! What each key of a study means, for editors: the rows of `docs/file-formats.md`, where the keys are documented, so that the
//! schema and the page say the same.

use bolted_joint::study::schema::Schema;

const PAGE: &str = include_str!("../../../docs/file-formats.md");
/// Section of keys that stand in no row of a method's own section.
const WITHIN_TABLES: &str = "Keys within tables";
/// Section whose tables other studies share.
const SHARED: &str = "Study";

/// A row of a table of keys.
struct Row {
    /// Headings around the table, the outermost first.
    headings: Vec<&'static str>,
    /// What stands before the table, its heading at least.
    before: String,
    /// Keys of the row, with the tables that they stand in where the row says so.
    keys: Vec<String>,
    words: String,
}

/// Rows of keys of the page.
pub(super) struct Keys(Vec<Row>);

impl Keys {
    /// Those of the page.
    pub(super) fn of_page() -> Self {
        let mut rows = Vec::new();
        let mut headings: Vec<(usize, &str)> = Vec::new();
        let mut before = String::new();
        let mut columns: Option<Vec<&str>> = None;
        let (mut is_code, mut is_at_end) = (false, true);
        for line in PAGE.lines() {
            is_code ^= line.starts_with("```");
            let depth = line.bytes().take_while(|byte| *byte == b'#').count();
            if is_code {
                columns = None;
            } else if depth > 0 {
                headings.retain(|(other, _)| *other < depth);
                headings.push((depth, line.trim_start_matches('#').trim()));
                before = line.to_owned();
                is_at_end = true;
            } else if line.starts_with('|') {
                let cells = cells_of(line);
                match &columns {
                    None => columns = Some(cells),
                    Some(_) if line.starts_with("|---") => {}
                    Some(columns) => rows.push(Row {
                        headings: headings.iter().map(|(_, text)| *text).collect(),
                        before: before.clone(),
                        keys: keys_of(cells[0]),
                        words: words(columns, &cells),
                    }),
                }
                is_at_end = true;
            } else {
                columns = None;
                // the last paragraph before a table, or its heading where there is none
                if is_at_end && !line.is_empty() {
                    before.clear();
                }
                is_at_end = line.is_empty();
                before += line;
                before += " ";
            }
        }
        rows.retain(|row| !row.words.is_empty());
        Self(rows)
    }

    /// What the key at the end of a path means in the study that a section describes.
    fn words(&self, path: &[String], section: &str) -> Option<&str> {
        let names: Vec<&str> = path.iter().map(String::as_str).collect();
        let sections = [section, WITHIN_TABLES, SHARED];
        let in_table = |section: &&str| self.in_section(&names, section);
        let of_part = |section: &&str| self.of_part(&names, section);
        // rows of the key's own table come first: keys of parts have the same names
        sections
            .iter()
            .find_map(in_table)
            .or_else(|| sections.iter().find_map(of_part))
            .or_else(|| self.anywhere(names.last()?))
    }

    fn rows(&self, section: &str) -> impl Iterator<Item = &Row> {
        self.0
            .iter()
            .filter(move |row| row.headings.contains(&section))
    }

    /// In a row that names the table, or in a table of rows that is the key's own.
    fn in_section(&self, path: &[&str], section: &str) -> Option<&str> {
        let (key, tables) = path.split_last()?;
        let rows = || self.rows(section);
        let dotted = dotted(path);
        let dotted = dotted
            .iter()
            .find_map(|dotted| rows().find(|row| row.keys.contains(dotted)));
        let named = || rows().filter(|row| row.keys.iter().any(|own| own == key));
        let at_top = || {
            named().find(|row| {
                let last = row.headings.last();
                tables.is_empty()
                    && matches!(last, Some(&own) if own == section || own == "Top level")
            })
        };
        let inner = tables.iter().rfind(|name| name.len() > 1);
        let in_table = || {
            named().find(|row| match (inner, tables.last()) {
                (Some(inner), _) if is_part(tables) => mentions(&row.before, inner),
                _ => row.headings.contains(&"`[a]` and `[b]`") && is_part(tables),
            })
        };
        let is_of = |row: &&Row, table: &str| {
            let heading = row.headings.last().map(|text| text.to_lowercase());
            mentions(&row.before, table) || heading.is_some_and(|text| text.contains(table))
        };
        let found = dotted.or_else(at_top).or_else(|| match inner {
            Some(inner) => named().find(|row| is_of(row, inner)),
            None => in_table(),
        });
        found.map(|row| row.words.as_str())
    }

    /// A key of a part, wherever that stands.
    fn of_part(&self, path: &[&str], section: &str) -> Option<&str> {
        let (key, tables) = path.split_last()?;
        let of_part = |row: &&Row| {
            let is_of_parts = row.headings.last() == Some(&"`[a]` and `[b]`");
            is_of_parts && row.keys.iter().any(|own| own == key)
        };
        let row = is_part(tables).then(|| self.rows(section).find(of_part))??;
        Some(row.words.as_str())
    }

    /// A key that means the same in every table.
    fn anywhere(&self, key: &str) -> Option<&str> {
        let mut rows = self.0.iter();
        let row = rows.find(|row| {
            row.headings.last() == Some(&WITHIN_TABLES) && row.keys.iter().any(|own| own == key)
        });
        row.map(|row| row.words.as_str())
    }

    /// Writes into a schema what its keys mean; `section` describes the study.
    pub(super) fn describe(&self, schema: &mut Schema, section: &str) {
        self.below(schema, &mut Vec::new(), section);
    }

    fn below(&self, schema: &mut Schema, path: &mut Vec<String>, section: &str) {
        match schema {
            Schema::Object(own) => {
                for (name, value) in own.iter_mut() {
                    match (name.as_str(), value) {
                        ("properties", Schema::Object(keys)) => {
                            for (key, value) in keys.iter_mut() {
                                path.push(key.clone());
                                self.below(value, path, section);
                                if let (Some(words), Schema::Object(value)) =
                                    (self.words(path, section), value)
                                {
                                    // beside what the reader says of a value
                                    let own = value.get("description").and_then(Schema::as_str);
                                    let both = own.map(|own| format!("{words}; {own}"));
                                    let both = both.unwrap_or_else(|| words.to_owned());
                                    value.insert("description".to_owned(), both.into());
                                }
                                path.pop();
                            }
                        }
                        ("anyOf" | "items" | "additionalProperties", value) => {
                            self.below(value, path, section);
                        }
                        _ => {}
                    }
                }
            }
            Schema::Array(list) => list
                .iter_mut()
                .for_each(|value| self.below(value, path, section)),
            _ => {}
        }
    }
}

/// Whether a path leads into one of the parts, which have the same keys.
fn is_part(tables: &[&str]) -> bool {
    matches!(tables.last(), Some(&("a" | "b" | "c" | "d" | "e" | "f")))
}

/// The end of a path as rows write it, the longest first: with its parts, with `a` in place of a further part, and without any.
fn dotted(path: &[&str]) -> Vec<String> {
    let further = |name: &&str| matches!(*name, "b" | "c" | "d" | "e" | "f");
    let as_a: Vec<&str> = path
        .iter()
        .enumerate()
        .map(
            |(place, name)| match further(name) && place + 1 < path.len() {
                true => "a",
                false => name,
            },
        )
        .collect();
    let without: Vec<&str> = as_a
        .iter()
        .enumerate()
        .filter(|(place, name)| !(matches!(**name, "a" | "far") && place + 1 < path.len()))
        .map(|(_, name)| *name)
        .collect();
    let mut all: Vec<String> = [path.to_vec(), as_a, without]
        .iter()
        .flat_map(|names| (0..names.len().saturating_sub(1)).map(|from| names[from..].join(".")))
        .collect();
    all.sort_by_key(|text| std::cmp::Reverse(text.matches('.').count()));
    all
}

/// Whether a text names a table or key in code.
fn mentions(text: &str, name: &str) -> bool {
    text.split('`')
        .skip(1)
        .step_by(2)
        .any(|code| code.trim_matches(['[', ']']) == name.trim_matches(['[', ']']))
}

/// The cells of a row, of which some may be empty.
fn cells_of(line: &str) -> Vec<&str> {
    let line = line.trim();
    let line = line.strip_prefix('|').unwrap_or(line);
    let line = line.strip_suffix('|').unwrap_or(line);
    let mut before = ' ';
    let ends = |c: char| std::mem::replace(&mut before, c) != '\\' && c == '|';
    line.split(ends).map(str::trim).collect()
}

/// The keys of a row's first cell: `` `a.x`, `.y` `` are `a.x` and `a.y`; NAME stands for any name.
fn keys_of(cell: &str) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for code in cell.split('`').skip(1).step_by(2) {
        let code = code.trim_matches(['[', ']']).replace(".NAME", "");
        let table = keys.last().and_then(|before| before.rsplit_once('.'));
        let key = match (code.strip_prefix('.'), table) {
            (Some(key), Some((table, _))) => format!("{table}.{key}"),
            _ => code,
        };
        keys.push(key);
    }
    keys
}

/// A row as one text: what the key means, its type or unit, and its default.
fn words(columns: &[&str], cells: &[&str]) -> String {
    let cell = |names: &[&str]| {
        let place = columns.iter().position(|column| names.contains(column));
        place
            .and_then(|place| cells.get(place))
            .map(|text| plain(text))
            .filter(|text| !text.is_empty())
    };
    let meaning = cell(&[
        "meaning",
        "what it is",
        "what it has",
        "what is not known exactly",
    ])
    .unwrap_or_default();
    let unit = cell(&["unit"]).filter(|unit| unit != "1");
    let kind = [cell(&["type", "value"]), unit];
    let kind: Vec<String> = kind.into_iter().flatten().collect();
    let kind = (!kind.is_empty()).then(|| kind.join(", "));
    let default = cell(&["default"]).map(|default| match default.starts_with("required") {
        true => default,
        false => format!("default: {default}"),
    });
    let details: Vec<String> = kind.into_iter().chain(default).collect();
    match (meaning.is_empty(), details.is_empty()) {
        (_, true) => meaning,
        (true, false) => details.join("; "),
        (false, false) => format!("{meaning} ({})", details.join("; ")),
    }
}

/// Without code marks, and links as their text.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, link)) = rest.split_once('[') {
        let parts = link
            .split_once("](")
            .and_then(|(name, after)| Some((name, after.split_once(')')?.1)));
        text += before;
        match parts {
            Some((name, after)) if !name.contains(['[', '\n']) => {
                text += name;
                rest = after;
            }
            _ => {
                text.push('[');
                rest = link;
            }
        }
    }
    (text + rest).replace(['`', '*'], "").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_a_sentence_with_type_and_default() {
        assert_eq!(
            plain("see [modes](#modal-data), `[a, b]`"),
            "see modes, [a, b]"
        );
        assert_eq!(
            keys_of("`motion.count`, `.pitch`"),
            ["motion.count", "motion.pitch"]
        );
        let columns = ["key", "type", "default", "meaning"];
        assert_eq!(
            words(&columns, &["`x`", "m", "required", "place"]),
            "place (m; required)"
        );
        assert_eq!(
            words(&columns, &["`x`", "m", "0", "place"]),
            "place (m; default: 0)"
        );
    }

    #[test]
    fn a_row_may_have_empty_cells() {
        assert_eq!(cells_of("| `x` | m | | place |"), ["`x`", "m", "", "place"]);
        assert_eq!(cells_of(r"| r | \|H\| | |"), ["r", r"\|H\|", ""]);
    }

    #[test]
    fn a_key_is_found_in_its_own_table() {
        let keys = Keys::of_page();
        let path = |text: &str| text.split('.').map(str::to_owned).collect::<Vec<_>>();
        for (at, section, expected) in [
            ("a.beam.length", "Study", "m"),
            ("frequency.to", "Study", "Hz"),
            (
                "contact.hardness",
                "Study of a prediction",
                "± Pa; required",
            ),
            (
                "surface.a.roughness",
                "Study of a prediction",
                "G of both surfaces together",
            ),
            ("motion.mode", "Study of a layered beam", "default: 1)"),
            ("load.on", "Study of a response", "default: \"b\""),
            (
                "structures.modes",
                "Assembly file",
                "how many modes are kept",
            ),
        ] {
            let found = keys.words(&path(at), section);
            assert!(
                found.is_some_and(|words| words.contains(expected)),
                "{at}: {found:?}"
            );
        }
    }
}
