//! `reproduce pirdayr`: the frequencies of Pirdayr's paper beside those of its own parameters and of its own bounds.

use serde_json::json;

use super::super::error::CliError;
use super::ReproduceArguments;
use super::page::{Page, Section, percent, show};
use bolted_joint::reproduce::{PirdayrRow, RATIO_OF_TABLE_2, pirdayr};

const COLUMNS: [&str; 11] = [
    "torque, N·m",
    "",
    "measured",
    "printed",
    "error",
    "from Table 3",
    "error",
    "within Table 2",
    "error",
    "wide bounds",
    "error",
];

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let rows = pirdayr();
    let value = json!({ "ratio_of_table_2": RATIO_OF_TABLE_2, "rows": rows });
    show(arguments, &value, || {
        Page {
        title: "Pirdayr's updated lap joint, computed anew",
        source: "A. Pirdayr, M. Mohammadi, M. J. Kazemzadeh-Parsi and M. Rajabi, *Analytical Study on Effect of Loosening on Nonlinear Vibration \
                 Behavior of Bolted Joints*, Amirkabir J. Mech. Eng. 53(12), 2022: frequencies as measured and as updated (Table 4), of the \
                 parameters in Table 3, and of least squares on the objective (4) within the bounds of Table 2 and within wide ones."
            .to_owned(),
        command: "pirdayr --markdown",
        figure: None,
        sections: vec![Section {
            heading: "Tables 3 and 4: natural frequencies in rad/s".to_owned(),
            columns: &COLUMNS,
            words: 2,
            rows: lines(&rows),
            is_long: false,
            remarks: vec![("", remarks(&rows))],
        }],
    }
    })
}

fn lines(rows: &[PirdayrRow]) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for row in rows {
        for mode in 0..2 {
            let measured = row.measured[mode];
            let mut cells = vec![
                if mode == 0 {
                    row.torque_n_m.to_string()
                } else {
                    String::new()
                },
                format!("ω{}", mode + 1),
                format!("{measured:.0}"),
            ];
            for found in [
                row.published,
                row.from_table_3,
                row.within_table_2,
                row.within_wide_bounds,
            ] {
                let error = 100.0 * (found[mode] / measured - 1.0);
                cells.extend([format!("{:.0}", found[mode]), percent(error, 2)]);
            }
            all.push(cells);
        }
    }
    all
}

fn remarks(rows: &[PirdayrRow]) -> Vec<String> {
    let [low, high] = RATIO_OF_TABLE_2;
    let list = |of: fn(&PirdayrRow) -> f64| {
        rows.iter()
            .map(|row| format!("{:.2}", of(row)))
            .collect::<Vec<_>>()
            .join(", ")
    };
    vec![
        "Table 4 prints Hz; the numbers are rad/s.".to_owned(),
        format!(
            "The measured frequencies say k12/k = ½((ω2/ω1)² − 1) = {}; the bounds of Table 2 admit {low:.2} to {high:.2}. No parameters within \
             them have the measured frequencies: the best lie at the upper bound of k and the lower one of k12.",
            list(|row| row.measured_ratio)
        ),
        format!(
            "Table 3 has k12/k = {}, so that its parameters do not give the updated frequencies of Table 4; k of 6 and 8 N·m are beyond the \
             bounds, too.",
            list(|row| row.ratio_of_table_3)
        ),
        "Two frequencies determine k/m and k12/m alone; c, c12 and kN of Table 3 are not determined by them at all.".to_owned(),
        "The paper sums its objective (4) over three frequencies; the model has two.".to_owned(),
    ]
}
