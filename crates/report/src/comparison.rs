//! Joints beside each other: each number with its interval of 95 %, a column for each joint.

use bolted_joint_compare::{Comparison, Measured, Row};
use bolted_joint_figures::html::{
    beside, cell, escaped, figure, number, number_cell, percent, spread, table,
};
use bolted_joint_figures::{COLOURS, Drawn};
use bolted_joint_files::Timestamp;
use bolted_joint_joint::with_symbols;

use crate::interval_figure::{Estimated, IntervalFigure, Panel};

/// Half an interval of 95 % in standard deviations.
const HALF: f64 = 1.959_963_984_540_054;

/// The numbers with their intervals as an SVG document, a panel each; joints are numbered from 1.
#[must_use]
pub fn comparison_figure(comparison: &Comparison) -> String {
    drawn(comparison).svg
}

fn drawn(comparison: &Comparison) -> Drawn {
    let panel = |(place, row): (usize, &Row)| Panel {
        name: with_symbols(&row.name),
        unit: row.unit.clone(),
        colour: COLOURS[place % COLOURS.len()],
        values: row
            .values
            .iter()
            .enumerate()
            .map(|(place, own)| {
                let half = HALF * own.deviation.unwrap_or(0.0);
                Estimated {
                    at: (place + 1) as f64,
                    value: Some((own.value, [own.value - half, own.value + half])),
                }
            })
            .collect(),
    };
    let names = comparison.names.iter().enumerate();
    let names: Vec<String> = names
        .map(|(place, name)| format!("{}: {name}", place + 1))
        .collect();
    IntervalFigure {
        title: &format!("Numbers of the joints {}", names.join(", ")),
        across: "joint, in the order given",
        is_counted: true,
        panels: comparison.rows.iter().enumerate().map(panel).collect(),
    }
    .drawn()
}

/// The comparison as a page.
#[must_use]
pub fn comparison_page(comparison: &Comparison, written: Timestamp) -> String {
    let names = comparison.names.iter().enumerate();
    let items: String = names
        .map(|(place, name)| format!("<li value=\"{}\">{}</li>\n", place + 1, escaped(name)))
        .collect();
    let headings: Vec<String> = ["".to_owned(), "Unit".to_owned()]
        .into_iter()
        .chain((1..=comparison.names.len()).map(|place| format!("Joint {place}")))
        .chain((2..=comparison.names.len()).map(|place| format!("{place} against 1")))
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let rows: Vec<String> = comparison.rows.iter().map(table_row).collect();
    let together: String = comparison
        .together
        .iter()
        .enumerate()
        .filter_map(|(place, own)| {
            let own = (*own)?;
            Some(format!(
                "<p>Joint {} against joint 1, all {} unknowns together: <i>χ</i>² = {}, which joints that are the same exceed \
                 with a probability of {}.</p>\n",
                place + 2,
                own.unknowns,
                number(own.chi_squared),
                number(format!("{:.2e}", own.probability).parse().unwrap_or(own.probability)),
            ))
        })
        .collect();
    let notes: String = comparison
        .notes
        .iter()
        .map(|note| format!("<p>{}</p>\n", escaped(note)))
        .collect();
    let sections = format!(
        "<h2>Joints</h2>\n<ol>\n{items}</ol>\n<h2>Numbers</h2>\n{}\
         <p>± one standard deviation. Differences are parts of the first value and, in brackets, standard deviations of the \
         difference of independent estimates.</p>\n{together}{notes}<h2>Intervals</h2>\n{}",
        table(&headings, &rows),
        figure(
            "intervals",
            "Values with intervals of 95 %, where the files give deviations.",
            &drawn(comparison)
        ),
    );
    crate::page::page(
        "Joints beside each other",
        "comparison of joint files",
        written,
        &sections,
    )
}

fn table_row(row: &Row) -> String {
    let value = |own: &Measured| match own.deviation {
        Some(deviation) => format!("{} ± {}", beside(own.value, deviation), spread(deviation)),
        None => number(own.value),
    };
    let values = row.values.iter().map(|own| number_cell(&value(own)));
    let differences = row.differences.iter().map(|own| {
        let text = own.map_or_else(String::new, |own| {
            let relative = own.relative.map_or_else(|| "—".to_owned(), percent);
            let deviations = own
                .deviations
                .map_or_else(String::new, |own| format!(" ({own:+.1})"));
            format!("{relative}{}", deviations.replace('-', "−"))
        });
        number_cell(&text)
    });
    [
        cell(&escaped(&with_symbols(&row.name))),
        cell(&escaped(&row.unit)),
    ]
    .into_iter()
    .chain(values)
    .chain(differences)
    .collect()
}

#[cfg(test)]
mod tests {
    use bolted_joint_joint::JointFile;

    use super::*;

    #[test]
    fn values_and_differences_stand_in_the_table() {
        let joint = |k: f64| {
            let text = format!(
                r#"{{"format": "bolted-joint/1", "name": "x", "joint": {{"dofs": ["y"], "stiffness": [[{k}]], "damping": [[2]]}},
                "uncertainty": {{"standard_deviation": {{"stiffness": [[300]], "damping": [[0]]}}, "basis": "made up"}}}}"#
            );
            JointFile::from_json(&text, "x").unwrap()
        };
        let joints = [
            ("new <1>".to_owned(), joint(1e5)),
            ("worn".to_owned(), joint(0.9e5)),
        ];
        let comparison = Comparison::of(&joints).unwrap();
        let page = comparison_page(&comparison, Timestamp::from_environment().unwrap());
        // 1e4/√(2·300²) = 23.57
        for expected in [
            "new &lt;1&gt;",
            "100000 ± 300",
            "90000 ± 300",
            "−10 % (−23.6)",
            ">joint, in the order given</text>",
        ] {
            assert!(page.contains(expected), "{expected}");
        }
    }
}
