//! Joints beside each other: each number with its interval of 95 %, a column for each joint.

use bolted_joint_compare::{Comparison, Difference, HALF, Measured, Row, Together, UNLIKELY};
use bolted_joint_figures::html::{
    escaped, figure, number, number_cell, percent, shown, table, with_deviation,
};
use bolted_joint_figures::{COLOURS, Drawn};
use bolted_joint_files::Timestamp;
use bolted_joint_joint::with_symbols;

use crate::interval_figure::{Estimated, IntervalFigure, Panel};
use crate::page::symbol;

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
    // Each difference stands beside its joint: that of the second one is in sight on a telephone, too.
    let others = 2..=comparison.names.len();
    let headings: Vec<String> = [String::new(), "Joint 1".to_owned()]
        .into_iter()
        .chain(others.flat_map(|place| [format!("Joint {place}"), format!("{place} against 1")]))
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let rows: Vec<String> = comparison.rows.iter().map(table_row).collect();
    let together: String = comparison
        .together
        .iter()
        .enumerate()
        .filter_map(|(place, own)| own.map(|own| all_together(place + 2, own)))
        .collect();
    let notes: String = comparison
        .notes
        .iter()
        .map(|note| format!("<p>{}</p>\n", escaped(note)))
        .collect();
    let sections = format!(
        "<h2>Joints</h2>\n<ol>\n{items}</ol>\n<h2>Numbers</h2>\n{}\
         <p>In brackets behind a value: one standard deviation, in units of the last digit. Differences are parts of the first \
         value; in brackets they are in standard deviations σ of the difference of independent estimates.{}</p>\n\
         {together}{notes}<h2>Intervals</h2>\n{}",
        table(&headings, &rows),
        comparison
            .unknown_parts()
            .map_or_else(String::new, |why| format!(" {why}")),
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
    let unit = match row.unit.as_str() {
        "1" => String::new(),
        unit => format!(" <small>{}</small>", escaped(unit)),
    };
    let value = |own: &Measured| {
        number_cell(&match own.deviation {
            Some(deviation) => with_deviation(own.value, deviation),
            None => number(own.value),
        })
    };
    let mut html = format!("<th scope=\"row\">{}{unit}</th>", name(&row.name));
    let (first, others) = row.values.split_at(1.min(row.values.len()));
    html.extend(first.iter().map(value));
    for (own, difference) in others.iter().zip(&row.differences) {
        let text = difference.map_or_else(String::new, difference_of);
        html += &format!("{}<td class=\"number parts\">{text}</td>", value(own));
    }
    html
}

/// A part of the first value, and standard deviations; a telephone may set them below each other.
fn difference_of(difference: Difference) -> String {
    let relative = difference.relative.map_or_else(
        || "–".to_owned(),
        |own| signed(own, &percent(own)).replace(' ', "\u{a0}"),
    );
    let deviations = difference.deviations.map_or_else(String::new, |own| {
        let text = match own.abs() {
            0.0..100.0 => format!("{own:.1}"),
            _ => shown(own, 3),
        };
        let text = signed(own, &text.replace('-', "−"));
        format!(" ({}\u{a0}σ)", text.replace(' ', "\u{a0}"))
    });
    format!("{relative}{deviations}")
}

/// The text of a number with its sign; one that is shown as zero has none.
fn signed(value: f64, text: &str) -> String {
    let digits = text.split(" ×").next().unwrap_or_default();
    match digits.contains(|c: char| ('1'..='9').contains(&c)) {
        true if value > 0.0 => format!("+{text}"),
        true => text.to_owned(),
        false => text.trim_start_matches('−').to_owned(),
    }
}

fn all_together(place: usize, own: Together) -> String {
    let probability = match own.likely() {
        Some(known) => shown(known, 2),
        None => format!(
            "less than {}",
            shown(UNLIKELY, 1).trim_start_matches("1 × ")
        ),
    };
    format!(
        "<p>Joint {place} against joint 1, all {} unknowns together: <i>χ</i>² = {}, which joints that are the same exceed \
         with a probability of {probability}.</p>\n",
        own.unknowns,
        shown(own.chi_squared, 4),
    )
}

/// The name of a row as on the other pages: `k_yy` with its index set low, `jenkins.slip_force_y` in words.
fn name(name: &str) -> String {
    let (name, preload) = match name.split_once('@') {
        Some((name, preload)) => (name, format!(" at {preload} N·m")),
        None => (name, String::new()),
    };
    let name = match name.split_once('.') {
        Some((law, parameter)) => {
            let (key, dof) = parameter.rsplit_once('_').unwrap_or((parameter, ""));
            let key = key.replace('_', " ");
            escaped(&format!("{law}, {}: {key}", with_symbols(dof)))
        }
        // k3_y has its power before the underscore
        None => match name.split_once('_') {
            Some((letter, index)) if letter.len() > 1 => {
                let (letter, power) = letter.split_at(1);
                symbol(&format!("{letter}_{power},{index}"))
            }
            _ => symbol(name),
        },
    };
    name + &escaped(&preload)
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
            "<th scope=\"row\"><i>k</i><sub>yy</sub> <small>N/m</small></th>",
            ">100000(300)</td>",
            ">90000(300)</td>",
            "−10\u{a0}% (−23.6\u{a0}σ)",
            ">joint, in the order given</text>",
        ] {
            assert!(page.contains(expected), "{expected}");
        }
    }

    #[test]
    fn differences_have_their_sign() {
        for (relative, deviations, expected) in [
            (Some(0.465), Some(698.8), "+46.5 % (+699 σ)"),
            (Some(-0.1), None, "−10 %"),
            (Some(0.0), Some(-0.01), "0 % (0.0 σ)"),
            (None, Some(-123_456_789.0), "– (−1.23 × 10<sup>8</sup> σ)"),
        ] {
            let own = Difference {
                relative,
                deviations,
            };
            assert_eq!(difference_of(own).replace('\u{a0}', " "), expected);
        }
    }

    #[test]
    fn names_are_those_of_the_other_pages() {
        for (own, expected) in [
            ("c_ytheta", "<i>c</i><sub>yθ</sub>"),
            ("k3_y", "<i>k</i><sub>3,y</sub>"),
            ("k_yy@10.5", "<i>k</i><sub>yy</sub> at 10.5 N·m"),
            ("jenkins 2.slip_force_theta", "jenkins 2, θ: slip force"),
        ] {
            assert_eq!(name(own), expected);
        }
    }

    #[test]
    fn no_probability_is_zero() {
        let told = |probability| {
            all_together(
                2,
                Together {
                    chi_squared: 34_915_100.0,
                    unknowns: 6,
                    probability,
                },
            )
        };
        assert!(told(0.0).contains("a probability of less than 10<sup>−10</sup>."));
        assert!(told(0.0421).contains("= 3.492 × 10<sup>7</sup>, "));
        assert!(told(0.0421).contains("a probability of 0.042."));
    }
}
