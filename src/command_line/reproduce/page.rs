//! What the reproductions of papers have in common: tables with remarks, for people, for machines and as a document.

use std::fmt::Write as _;

use serde::Serialize;

use super::super::error::CliError;
use super::super::output::print;
use super::super::table::Table;
use super::ReproduceArguments;

/// A reproduction as it is shown.
pub(super) struct Page {
    /// Heading of the document.
    pub(super) title: &'static str,
    /// The source, and what of it is computed.
    pub(super) source: String,
    /// What the command line calls it, with its options.
    pub(super) command: &'static str,
    /// A figure in the document.
    pub(super) figure: Option<&'static str>,
    pub(super) sections: Vec<Section>,
}

/// A table with what is said about it.
pub(super) struct Section {
    pub(super) heading: String,
    pub(super) columns: &'static [&'static str],
    /// How many of the columns are words, from the left.
    pub(super) words: usize,
    pub(super) rows: Vec<Vec<String>>,
    /// Whether rows are too long for a terminal's line: source, what, values, why.
    pub(super) is_long: bool,
    /// Under headings, or under none.
    pub(super) remarks: Vec<(&'static str, Vec<String>)>,
}

/// Prints what was found as the arguments ask for.
pub(super) fn show(
    arguments: &ReproduceArguments,
    found: &impl Serialize,
    page: impl FnOnce() -> Page,
) -> Result<(), CliError> {
    if arguments.json {
        return print(&serde_json::to_string_pretty(found)?);
    }
    let text = match arguments.markdown {
        true => page().document(),
        false => page().text(),
    };
    print(text.trim_end())
}

impl Page {
    fn text(&self) -> String {
        let sections = self.sections.iter().map(Section::text);
        sections.collect::<Vec<_>>().join("\n")
    }

    fn document(&self) -> String {
        let mut text = format!(
            "# {}\n\n{} Written by\n\n    bolted-joint reproduce {}\n",
            self.title, self.source, self.command
        );
        if let Some(figure) = self.figure {
            let _ = writeln!(text, "\n{figure}");
        }
        for section in &self.sections {
            text += &section.document();
        }
        text
    }
}

impl Section {
    fn text(&self) -> String {
        let mut text = format!("{}\n\n", self.heading);
        if self.is_long {
            let entries: Vec<String> = self.rows.iter().map(|cells| self.entry(cells)).collect();
            text += &entries.join("\n");
        } else {
            let mut table = Table::new(self.columns);
            self.rows.iter().for_each(|cells| table.row(cells.clone()));
            text += &table.render();
        }
        text + &self.remarks("", "  ")
    }

    /// What is said, with what stands under a heading and before a line.
    fn remarks(&self, under: &str, before: &str) -> String {
        let mut text = String::new();
        for (heading, lines) in &self.remarks {
            let _ = match heading.is_empty() {
                true => writeln!(text),
                false => writeln!(text, "\n{heading}:{under}"),
            };
            for line in lines {
                let _ = writeln!(text, "{before}{line}");
            }
        }
        text
    }

    /// A row with long texts as lines of its own: where, what; then the values by their names; then why.
    fn entry(&self, cells: &[String]) -> String {
        let [source, what, values @ .., why] = cells else {
            return String::new();
        };
        let mut text = format!("  {what} [{source}]\n");
        let named = self.columns.iter().skip(2).zip(values);
        let named = named.filter(|(_, value)| !value.is_empty() && *value != "-");
        let named: Vec<String> = named
            .map(|(name, value)| format!("{name} {value}"))
            .collect();
        let _ = writeln!(text, "    {}", named.join("; "));
        if !why.is_empty() {
            let _ = writeln!(text, "    {why}");
        }
        text
    }

    fn document(&self) -> String {
        let numbers = self.columns.len() - self.words;
        let mut text = format!(
            "\n## {}\n\n| {} |\n|{}{}\n",
            self.heading,
            self.columns.join(" | "),
            "---|".repeat(self.words),
            "---:|".repeat(numbers)
        );
        for cells in &self.rows {
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text + &self.remarks("\n", "* ")
    }
}

/// An error in per cent, with so many decimals; no error has no sign.
pub(super) fn percent(value: f64, decimals: usize) -> String {
    let rounds_to_zero = value.abs() < 0.5 * 0.1_f64.powi(decimals as i32);
    let value = if rounds_to_zero { 0.0 } else { value };
    format!("{value:+.decimals$} %")
}
