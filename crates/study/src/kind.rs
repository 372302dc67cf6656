//! What a TOML file of this program is for: told by its keys, and where it cannot be parsed by its lines.

use bolted_joint_files::nearest;

use super::{Method, StudyText};

/// What a TOML file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextKind {
    /// A study, with its method where it names one that there is.
    Study(Option<Method>),
    /// An assembly: structures and the joints between them.
    Assembly,
    /// Modes of a structure.
    Modes,
}

impl StudyText {
    /// What the text is for; `None` if it has nothing that tells.
    ///
    /// A text with a mistake in it is told by its lines, so that the message is about the mistake and not about another kind of
    /// file.
    #[must_use]
    pub fn kind(&self) -> Option<TextKind> {
        match toml::from_str::<toml::Table>(self.text()) {
            Ok(table) => of_table(&table),
            Err(_) => self.text().lines().find_map(of_line),
        }
    }
}

fn of_table(table: &toml::Table) -> Option<TextKind> {
    let is_table = |key: &str| table.get(key).is_some_and(toml::Value::is_table);
    // a misspelt one is meant as well: the reader of modes says so
    let means_list = |wanted: &str| {
        let mut lists = table.iter().filter(|(_, value)| value.is_array());
        lists.any(|(key, _)| nearest(key, &[wanted]).is_some())
    };
    if let Some(toml::Value::String(method)) = table.get("method") {
        return Some(TextKind::Study(Method::named(method)));
    }
    if is_table("structures") {
        Some(TextKind::Assembly)
    } else if means_list("points") && means_list("mode") {
        Some(TextKind::Modes)
    } else {
        // misspelt: the reader of studies says so
        let mut values = table.iter();
        let means_study =
            values.any(|(key, value)| value.is_str() && nearest(key, &["method"]).is_some());
        means_study.then_some(TextKind::Study(None))
    }
}

fn of_line(line: &str) -> Option<TextKind> {
    let line = line.trim_start();
    if let Some((key, value)) = line.split_once('=')
        && key.trim_end() == "method"
    {
        let quoted = value.split('"').nth(1);
        return Some(TextKind::Study(quoted.and_then(Method::named)));
    }
    if line.starts_with("[structures") {
        Some(TextKind::Assembly)
    } else if line.starts_with("[[mode]]") {
        Some(TextKind::Modes)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn texts_are_told_by_their_keys_even_with_mistakes_in_them() {
        let assembly = "name = \"two\"\n[structures.a]\nmatrices = \"a.npz\"\n";
        let modes = "points = [\"1:+Y\"]\n[[mode]]\nfrequency_hz = 1\n";
        #[rustfmt::skip]
        let cases = [
            ("method = \"layered-beam\"\n", Some(TextKind::Study(Some(Method::LayeredBeam)))),
            ("method = \"weld\"\n", Some(TextKind::Study(None))),
            ("method = \"respond\"\n[time\n", Some(TextKind::Study(Some(Method::Respond)))),
            (assembly, Some(TextKind::Assembly)),
            ("name = \"two\n[structures.a]\n", Some(TextKind::Assembly)),
            ("joints = 1\n[structures.a]\nmatrices = a.npz\n", Some(TextKind::Assembly)),
            (modes, Some(TextKind::Modes)),
            ("points = [\"1:+Y\"\n[[mode]]\n", Some(TextKind::Modes)),
            ("pionts = [\"1:+Y\"]\n[[mode]]\nfrequency_hz = 1\n", Some(TextKind::Modes)),
            ("points = [\"1:+Y\"]\n[[modes]]\nfrequency_hz = 1\n", Some(TextKind::Modes)),
            ("method = 1\n", None),
            ("", None),
            ("{ \"format\": 1 }", None),
        ];
        for (text, expected) in cases {
            let found = StudyText::new(text, Path::new("x.toml")).kind();
            assert_eq!(found, expected, "{text}");
        }
    }
}
