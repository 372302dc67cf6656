//! The joint's numbers with their intervals, over the torque where there is a table, and where the scatter comes from.

use super::super::interval_figure::{Estimated, IntervalFigure, Panel};
use crate::page::symbol;
use bolted_joint_figures::html::figure;
use bolted_joint_figures::html::{
    beside, cell, escaped, number, number_cell, table, with_deviation,
};
use bolted_joint_joint::{DofSet, with_symbols};
use bolted_joint_predict::study::{Prediction, State, Unknown};

/// Shares below this are not worth a row.
const WORTH_A_ROW: f64 = 0.005;
/// The palette of Okabe and Ito: stiffness blue, damping vermilion.
const COLOURS: [&str; 2] = ["#0072b2", "#d55e00"];

pub(super) fn section(found: &Prediction<'_>) -> String {
    let states = found.states.iter();
    let tables: String = states
        .map(|state| {
            let heading = state
                .torque_n_m
                .map(|torque| format!("<h3>At {} N·m</h3>\n", number(torque)))
                .unwrap_or_default();
            heading + &at_state(found, state)
        })
        .collect();
    format!(
        "<h2>The joint</h2>\n<p>{}</p>\n{tables}{}",
        motions(found),
        over_torque(found)
    )
}

fn motions(found: &Prediction<'_>) -> String {
    let study = found.study;
    let [x, y, z] = study.reference_m.map(number);
    let others = match study.motions.dofs() == DofSet::SPACE {
        true => "",
        false => " The other relative motions are held at zero.",
    };
    let basis = match &found.outcome {
        Some(outcome) => format!(
            " Standard deviations and intervals are those of {} draws of the uncertain inputs (seed {}, {} refused); the model's own error is not in \
             them.",
            outcome.of.draws,
            outcome.of.seed,
            outcome.of.draws - outcome.accepted
        ),
        None => " No input is uncertain, so that there are no intervals.".to_owned(),
    };
    format!(
        "{}, at <i>x</i> = {x} m, <i>y</i> = {y} m, <i>z</i> = {z} m of the interface, whose normal is <i>z</i>.{others} \
         Damping is viscous as at {} Hz.{basis}",
        with_symbols(&study.motions.described()),
        number(study.frequency_hz),
    )
}

fn at_state(found: &Prediction<'_>, state: &State) -> String {
    let rows: Vec<String> = found
        .unknowns(state)
        .iter()
        .map(|unknown| {
            let head = format!("<th scope=\"row\">{}</th>", symbol(&unknown.name));
            let cells = match found.estimate(&unknown.name, state.torque_n_m) {
                Some(estimate) => {
                    let deviation = estimate.standard_deviation;
                    let [low, high] = estimate.interval_95.map(|end| beside(end, deviation));
                    [
                        number_cell(&beside(unknown.value, deviation)),
                        number_cell(&with_deviation(estimate.mean, deviation)),
                        number_cell(&format!("{low} … {high}")),
                    ]
                    .concat()
                }
                None => {
                    let unknown_to = if found.outcome.is_some() { 2 } else { 0 };
                    number_cell(&number(unknown.value)) + &number_cell("–").repeat(unknown_to)
                }
            };
            format!("{head}{}{cells}", cell(&unknown.unit))
        })
        .collect();
    let headings: &[&str] = match found.outcome {
        Some(_) => &[
            "",
            "Unit",
            "At the values given",
            "Mean (std. dev.)",
            "95 % interval",
        ],
        None => &["", "Unit", "Value"],
    };
    table(headings, &rows)
}

/// Every number over the torque, with its interval.
fn over_torque(found: &Prediction<'_>) -> String {
    if found.states.len() < 2 {
        return String::new();
    }
    let unknowns = found.unknowns(found.nominal());
    let panels = unknowns.iter().enumerate().map(|(place, unknown)| Panel {
        name: with_symbols(&unknown.name),
        unit: unknown.unit.to_owned(),
        colour: COLOURS[usize::from(unknown.name.starts_with('c'))],
        values: found
            .states
            .iter()
            .map(|state| Estimated {
                at: state.torque_n_m.unwrap_or(0.0),
                value: found.unknowns(state).get(place).map(|at: &Unknown| {
                    let estimate = found.estimate(&at.name, state.torque_n_m);
                    (at.value, estimate.map_or([at.value; 2], |e| e.interval_95))
                }),
            })
            .collect(),
    });
    let drawing = IntervalFigure {
        title: "Stiffness and damping over the torque",
        across: "torque, N·m",
        is_counted: false,
        panels: panels.collect(),
    };
    figure(
        "over-torque",
        "<b>Over the torque</b>: the values given, with intervals of 95 %.",
        &drawing.drawn(),
    )
}

/// How much of each number's scatter each input accounts for, and how the numbers go together.
pub(super) fn contributions(found: &Prediction<'_>) -> String {
    let Some(outcome) = &found.outcome else {
        return String::new();
    };
    let state = found.nominal();
    let mut unknowns = found.unknowns(state);
    unknowns.retain(|unknown| found.estimate(&unknown.name, state.torque_n_m).is_some());
    let estimates: Vec<_> = unknowns
        .iter()
        .filter_map(|unknown| found.estimate(&unknown.name, state.torque_n_m))
        .collect();
    let mut inputs: Vec<usize> = (0..outcome.inputs.len()).collect();
    let largest = |input: usize| {
        let shares = estimates.iter().map(|estimate| estimate.shares[input]);
        shares.fold(0.0, f64::max)
    };
    inputs.retain(|&input| largest(input) >= WORTH_A_ROW);
    inputs.sort_by(|&a, &b| largest(b).total_cmp(&largest(a)));
    let percent = |share: f64| number_cell(&format!("{:.1} %", 100.0 * share));
    let rows: Vec<String> = inputs
        .iter()
        .map(|&input| {
            let shares = estimates
                .iter()
                .map(|estimate| percent(estimate.shares[input]));
            format!(
                "<th scope=\"row\">{}</th>{}",
                escaped(&outcome.inputs[input]),
                shares.collect::<String>()
            )
        })
        .collect();
    let symbols: Vec<String> = unknowns
        .iter()
        .map(|unknown| symbol(&unknown.name))
        .collect();
    let headings: Vec<&str> = std::iter::once("Input")
        .chain(symbols.iter().map(String::as_str))
        .collect();
    let place = |name: &str| {
        let mut estimates = outcome.estimates.iter();
        estimates.position(|estimate| estimate.name == name)
    };
    let places: Vec<usize> = estimates
        .iter()
        .filter_map(|estimate| place(&estimate.name))
        .collect();
    let correlations: Vec<String> = places
        .iter()
        .zip(&symbols)
        .map(|(&i, symbol)| {
            let row = places.iter().map(|&j| {
                number_cell(&format!("{:.3}", outcome.correlation[i][j]).replace('-', "−"))
            });
            format!("<th scope=\"row\">{symbol}</th>{}", row.collect::<String>())
        })
        .collect();
    let headings_of_correlations: Vec<&str> = std::iter::once("")
        .chain(symbols.iter().map(String::as_str))
        .collect();
    format!(
        "<h2>What the uncertainty comes from</h2>\n<p>Share of each number's variance that a straight line through one input accounts for: the \
         squared correlation. What has the largest share is what to measure better. Inputs that are correlated with each other share theirs, so \
         that a column can add up to more than 100 %.</p>\n{}<h3>Correlations</h3>\n{}",
        table(&headings, &rows),
        table(&headings_of_correlations, &correlations)
    )
}
