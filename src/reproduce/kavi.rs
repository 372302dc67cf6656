//! `reproduce kavi`: the specimens, printed numbers and statements of Kavi's thesis beside what its equations give.

use std::fmt::Write as _;

use super::super::error::CliError;
use super::super::output::{print, write_file};
use super::super::table::{Table, number};
use super::ReproduceArguments;
use bolted_joint::reproduce::KaviFigure;
use bolted_joint::reproduce::{
    AMPLITUDE_M, Claim, KaviReproduction, PrintedNumber, SpecimenRow, kavi,
};

/// A table for people: its heading, its columns, how many of them are words, and its rows.
struct Section {
    heading: String,
    columns: &'static [&'static str],
    words: usize,
    rows: Vec<Vec<String>>,
    remarks: Vec<String>,
}

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let found = kavi()?;
    if let Some(path) = &arguments.figure {
        let figure = KaviFigure { found: &found }.to_svg().unwrap_or_default();
        write_file(path, figure.as_bytes())?;
    }
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    let sections = [
        specimens(&found.specimens),
        printed(&found.printed),
        claims(&found.claims),
    ];
    if arguments.markdown {
        return print(document(&found, &sections).trim_end());
    }
    let [specimens, ..] = &sections;
    let mut table = Table::new(specimens.columns);
    specimens
        .rows
        .iter()
        .for_each(|cells| table.row(cells.clone()));
    let mut text = format!("{}\n\n{}", specimens.heading, table.render());
    for remark in &specimens.remarks {
        let _ = writeln!(text, "  {remark}");
    }
    for section in &sections[1..] {
        let _ = writeln!(text, "\n{}:", section.heading);
        for cells in &section.rows {
            text += &entry(section, cells);
        }
    }
    print(text.trim_end())
}

/// A row with long texts as lines of its own: where, what; then the values by their names; then why.
fn entry(section: &Section, cells: &[String]) -> String {
    let [source, what, values @ .., why] = cells else {
        return String::new();
    };
    let mut text = format!("\n  {what} [{source}]\n");
    let named = section.columns.iter().skip(2).zip(values);
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

fn specimens(rows: &[SpecimenRow]) -> Section {
    let cells = rows.iter().flat_map(|row| {
        row.at.iter().enumerate().map(move |(place, at)| {
            let own = |text: String| if place == 0 { text } else { String::new() };
            let layers: Vec<String> = row.layers_mm.iter().map(f64::to_string).collect();
            let mut cells = vec![
                own(row.number.to_string()),
                own(format!(
                    "{} {}×{} mm",
                    row.material.symbol(),
                    row.length_mm,
                    layers.join("+")
                )),
                own(format!("{} × {} mm", row.rivets, row.diameter_mm)),
                own(number(row.normal_force_n, 5)),
                ["ff", "fs", "ss"][place.min(2)].to_owned(),
            ];
            cells.extend(
                at.frequency_hz
                    .iter()
                    .map(|frequency| format!("{frequency:.2}")),
            );
            cells.extend([number(at.damping, 5), number(at.finite_element_damping, 5)]);
            cells
        })
    });
    let deviation = rows.iter().flat_map(|row| &row.at);
    let deviation = deviation
        .map(|at| at.finite_element_deviation)
        .fold(0.0, f64::max);
    Section {
        heading: "Table 5.1: frequencies, and damping ratio of the first mode".to_owned(),
        columns: &[
            "", "specimen", "rivets", "N, N", "ends", "f1, Hz", "f2, Hz", "f3, Hz", "ζ/α′μ", "ζ/α′μ, FE",
        ],
        words: 3,
        rows: cells.collect(),
        remarks: vec![
            "ends: ff fixed–fixed, fs fixed–pinned, ss pinned–pinned, as the thesis's figures have them.".to_owned(),
            format!(
                "ζ/α′μ at an amplitude of {} mm of the largest deflection; ζ falls as 1/amplitude. α′μ is not printed in the thesis, nor are its measured ζ, which stand in figures.",
                1e3 * AMPLITUDE_M
            ),
            format!("Frequencies by finite elements are within {deviation:.1e} of those by the frequency equations."),
            "Not given in the thesis: density (7850 and 2700 kg/m³ here), positions of the rivets (middles of equal parts of the length here).".to_owned(),
        ],
    }
}

fn printed(rows: &[PrintedNumber]) -> Section {
    let cells = rows.iter().map(|row| {
        let error = row.printed.filter(|printed| *printed != 0.0);
        let error = error.map_or_else(
            || "-".to_owned(),
            |printed| {
                let error = 100.0 * (printed / row.obtained - 1.0);
                // no error has no sign
                format!("{:+.1} %", if error.abs() < 0.05 { 0.0 } else { error })
            },
        );
        vec![
            row.source.to_owned(),
            row.quantity.clone(),
            row.printed
                .map_or_else(|| "-".to_owned(), |printed| printed.to_string()),
            number(row.obtained, 5),
            row.unit.to_owned(),
            error,
            row.remark.clone(),
        ]
    });
    Section {
        heading: "Printed numbers".to_owned(),
        columns: &[
            "",
            "",
            "printed",
            "obtained",
            "unit",
            "error of the printed",
            "",
        ],
        words: 2,
        rows: cells.collect(),
        remarks: Vec::new(),
    }
}

fn claims(rows: &[Claim]) -> Section {
    let cells = rows.iter().map(|row| {
        let values: Vec<String> = row.obtained.iter().map(|value| number(*value, 4)).collect();
        vec![
            row.source.to_owned(),
            row.statement.to_owned(),
            row.compared.clone(),
            if values.is_empty() {
                "-".to_owned()
            } else {
                values.join(", ")
            },
            row.verdict.to_string(),
            row.remark.clone(),
        ]
    });
    Section {
        heading: "What chapters 5 to 7 say, and what the equations give".to_owned(),
        columns: &["", "statement", "compared", "obtained", "verdict", "why"],
        words: 3,
        rows: cells.collect(),
        remarks: Vec::new(),
    }
}

fn document(found: &KaviReproduction, sections: &[Section]) -> String {
    let mut text = format!(
        "# Kavi's riveted beams, computed anew\n\n\
         B. Kavi, *Dynamics and Damping of Thin Riveted Beam Composite Structures of Various Configurations*, PhD thesis, National Institute of \
         Technology Rourkela, 2014: the {} specimens of Table 5.1, numbers that the thesis prints, and what it says of its results, each checked \
         against its own equations ([theory](theory.md#19-from-physics-layered-beams)). Written by\n\n    bolted-joint reproduce kavi --markdown --figure docs/images/kavi.svg\n\n\
         ![Damping ratio over what the thesis varies](images/kavi.svg)\n",
        found.specimens.len()
    );
    for section in sections {
        let _ = writeln!(text, "\n## {}\n", section.heading);
        let _ = writeln!(text, "| {} |", section.columns.join(" | "));
        let rest = section.columns.len() - section.words;
        let _ = writeln!(
            text,
            "|{}{}",
            "---|".repeat(section.words),
            "---:|".repeat(rest)
        );
        for cells in &section.rows {
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        if !section.remarks.is_empty() {
            text.push('\n');
        }
        for remark in &section.remarks {
            let _ = writeln!(text, "* {remark}");
        }
    }
    text
}
