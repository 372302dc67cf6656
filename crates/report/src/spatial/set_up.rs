//! What the errors of the set-up came to, and what they add to the deviations.

use bolted_joint_figures::html::{beside, cell, escaped, number_cell, shown, spread, table};
use bolted_joint_spatial::{SetUpError, SpatialIdentification};
use bolted_joint_virtual_point::Change;

/// Errors that are listed.
const LISTED: usize = 12;

pub(super) fn section(found: &SpatialIdentification) -> String {
    let mut html = "<h2>Errors of the set-up</h2>\n".to_owned();
    let Some(used) = found.budget_used else {
        return html
            + "<p>Positions, directions and gains of sensors and impacts were taken as exact.</p>\n";
    };
    html += &format!(
        "<p>Positions, directions and gains of all sensors and impacts were estimated with the joint. Together they come to {} of \
         what the budget says, r.m.s. A pull is an error over the budget's deviation; from 2.5 on it speaks against the budget.</p>\n",
        shown(used.sqrt(), 2)
    );
    let rows: Vec<String> = found
        .groups
        .iter()
        .map(|group| {
            let own: Vec<&SetUpError> = found
                .errors
                .iter()
                .filter(|error| group.has(error))
                .collect();
            let pull = |kind: fn(Change) -> bool| {
                let own: Vec<f64> = own
                    .iter()
                    .filter(|error| kind(error.change))
                    .map(|error| error.pull().powi(2))
                    .collect();
                let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
                number_cell(&shown(mean.sqrt(), 2))
            };
            [
                cell(&escaped(&group.name)),
                number_cell(&own.len().to_string()),
                pull(|change| matches!(change, Change::Pose(dof) if !dof.is_rotation())),
                pull(|change| matches!(change, Change::Pose(dof) if dof.is_rotation())),
                pull(|change| matches!(change, Change::Gain(_))),
                number_cell(&format!("{:.0} %", 100.0 * group.largest_share)),
            ]
            .concat()
        })
        .collect();
    html += &table(
        &[
            "Group",
            "Errors",
            "Pull of positions, r.m.s.",
            "of directions",
            "of gains",
            "Part of a variance, at most",
        ],
        &rows,
    );
    let mut errors: Vec<&SetUpError> = found.errors.iter().collect();
    errors.sort_by(|one, other| other.pull().abs().total_cmp(&one.pull().abs()));
    let rows: Vec<String> = errors.iter().take(LISTED).map(|error| row(error)).collect();
    html += &format!(
        "<h3>Largest pulls</h3>\n<p>The first {} of {}.</p>\n{}",
        rows.len(),
        errors.len(),
        table(
            &[
                "Where",
                "What",
                "Found",
                "Std. dev.",
                "Budget",
                "Unit",
                "Pull"
            ],
            &rows
        )
    );
    html
}

fn row(error: &SetUpError) -> String {
    let (what, unit, scale) = match error.change {
        Change::Pose(dof) if dof.is_rotation() => {
            (format!("turned about {}", &dof.symbol()[1..]), "mrad", 1e3)
        }
        Change::Pose(dof) => (format!("moved along {dof}"), "mm", 1e3),
        Change::Gain(channel) => (format!("gain of channel {}", channel + 1), "%", 1e2),
    };
    let [value, deviation, expected] =
        [error.value, error.deviation, error.expected].map(|number| scale * number);
    [
        cell(&escaped(&error.key)),
        cell(&what),
        number_cell(&beside(value, deviation)),
        number_cell(&spread(deviation)),
        number_cell(&shown(expected, 3)),
        cell(unit),
        number_cell(&format!("{:.1}", error.pull()).replace('-', "−")),
    ]
    .concat()
}
