//! `reproduce kavi`: the specimens, printed numbers and statements of Kavi's thesis beside what its equations give.

use super::super::error::CliError;
use super::super::output::write_file;
use super::super::table::number;
use super::ReproduceArguments;
use super::page::{Page, Section, percent, show};
use bolted_joint::reproduce::KaviFigure;
use bolted_joint::reproduce::{
    AMPLITUDE_M, Claim, KaviReproduction, PrintedNumber, SpecimenRow, kavi,
};

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let found = kavi()?;
    if let Some(path) = &arguments.figure {
        let figure = KaviFigure { found: &found }.to_svg().unwrap_or_default();
        write_file(path, figure.as_bytes())?;
    }
    show(arguments, &found, || page(&found))
}

fn page(found: &KaviReproduction) -> Page {
    Page {
        title: "Kavi's riveted beams, computed anew",
        source: format!(
            "B. Kavi, *Dynamics and Damping of Thin Riveted Beam Composite Structures of Various Configurations*, PhD thesis, National Institute of \
             Technology Rourkela, 2014: the {} specimens of Table 5.1, numbers that the thesis prints, and what it says of its results, each checked \
             against its own equations ([theory](theory.md#19-from-physics-layered-beams)).",
            found.specimens.len()
        ),
        command: "kavi --markdown --figure docs/images/kavi.svg",
        figure: Some("![Damping ratio over what the thesis varies](images/kavi.svg)"),
        sections: vec![
            specimens(&found.specimens),
            printed(&found.printed),
            claims(&found.claims),
        ],
    }
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
        is_long: false,
        remarks: vec![("", vec![
            "ends: ff fixed–fixed, fs fixed–pinned, ss pinned–pinned, as the thesis's figures have them.".to_owned(),
            format!(
                "ζ/α′μ at an amplitude of {} mm of the largest deflection; ζ falls as 1/amplitude. α′μ is not printed in the thesis, nor are its measured ζ, which stand in figures.",
                1e3 * AMPLITUDE_M
            ),
            format!("Frequencies by finite elements are within {deviation:.1e} of those by the frequency equations."),
            "Not given in the thesis: density (7850 and 2700 kg/m³ here), positions of the rivets (middles of equal parts of the length here).".to_owned(),
        ])],
    }
}

fn printed(rows: &[PrintedNumber]) -> Section {
    let cells = rows.iter().map(|row| {
        let error = row.printed.filter(|printed| *printed != 0.0);
        let error = error.map_or_else(
            || "-".to_owned(),
            |printed| percent(100.0 * (printed / row.obtained - 1.0), 1),
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
        is_long: true,
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
        is_long: true,
        remarks: Vec::new(),
    }
}
