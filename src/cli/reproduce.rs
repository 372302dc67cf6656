//! `reproduce`: the tables of Tol's thesis computed anew.

use std::fmt::Write as _;

use crate::reproduce::{Draws, PublishedTable, Reproduction, Row, reproduce};

use super::ReproduceArguments;
use super::error::CliError;
use super::output::{message, print};
use super::table::{Table, number};

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    if arguments.draws == 0 {
        return Err(CliError::Option {
            option: "--draws",
            found: "0".to_owned(),
            expected: "at least one draw of the noise",
        });
    }
    let draws = Draws {
        count: arguments.draws,
        seed: arguments.seed,
        samples: arguments.samples.clone(),
    };
    let tables = if arguments.tables.is_empty() {
        PublishedTable::ALL.to_vec()
    } else {
        arguments.tables.clone()
    };
    let mut found = Vec::new();
    for (index, &table) in tables.iter().enumerate() {
        if tables.len() > 1 {
            message(&format!("{} of {}: {table}", index + 1, tables.len()));
        }
        found.push(reproduce(table, &draws)?);
    }
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    let texts: Vec<String> = found.iter().map(text).collect();
    print(&texts.join("\n"))
}

/// One table for people.
fn text(found: &Reproduction) -> String {
    let mut text = format!("{}\n\n", found.table);
    let mut table = Table::new(&[
        "",
        "",
        "true",
        "published",
        "error",
        "obtained",
        "± std. dev.",
        "error",
        "median",
        "unit",
    ]);
    let mut last_case = "";
    for row in &found.rows {
        let case = if row.case == last_case { "" } else { &row.case };
        table.row(cells(case, row));
        last_case = &row.case;
    }
    text += &table.render();
    for (heading, lines) in [
        ("Computed with", &found.conditions),
        ("Not given in the thesis", &found.not_given),
        ("Differences", &found.differences),
    ] {
        if !lines.is_empty() {
            let _ = writeln!(text, "\n{heading}:");
        }
        for line in lines {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

fn cells(case: &str, row: &Row) -> Vec<String> {
    let optional = |value: Option<f64>, digits| {
        value.map_or_else(|| "-".to_owned(), |value| number(value, digits))
    };
    let error = |value: Option<f64>| match (value, row.truth) {
        (Some(value), Some(truth)) if truth != 0.0 => {
            format!("{:+.1} %", 100.0 * (value / truth - 1.0))
        }
        _ => "-".to_owned(),
    };
    let obtained = row.obtained;
    let noisy = obtained.filter(|spread| spread.draws > 1);
    vec![
        case.to_owned(),
        row.quantity.clone(),
        optional(row.truth, 4),
        optional(row.published, 4),
        error(row.published),
        optional(obtained.map(|spread| spread.mean), 4),
        optional(noisy.map(|spread| spread.standard_deviation), 2),
        error(obtained.map(|spread| spread.mean)),
        optional(noisy.map(|spread| spread.median), 4),
        row.unit.to_owned(),
    ]
}
