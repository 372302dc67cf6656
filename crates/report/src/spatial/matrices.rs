//! K and C in blocks: translations, rotations, and what couples them.

use bolted_joint_figures::html::{beside, shown, spread, table};
use bolted_joint_space::Motions;
use bolted_joint_spatial::SpatialIdentification;
use nalgebra::Matrix6;

use super::{scaled, symbol};

const TRANSLATIONS: [&str; 3] = ["x", "y", "z"];
const ROTATIONS: [&str; 3] = ["rx", "ry", "rz"];

/// Standard deviations in an interval of 95 %.
const QUANTILE: f64 = 1.96;

/// A block of a matrix.
struct Block {
    name: &'static str,
    /// Of stiffness and of damping.
    units: [&'static str; 2],
    first: [usize; 2],
}

const BLOCKS: [Block; 3] = [
    Block {
        name: "Translations",
        units: ["N/m", "N·s/m"],
        first: [0, 0],
    },
    Block {
        name: "Rotations",
        units: ["N·m/rad", "N·m·s/rad"],
        first: [3, 3],
    },
    Block {
        name: "Coupling",
        units: ["N/rad", "N·s/rad"],
        first: [0, 3],
    },
];

pub(super) fn section(found: &SpatialIdentification, motions: Motions) -> String {
    let mut html = "<h2>Stiffness and damping</h2>\n<p>For the relative motion of the two virtual points, each value with its \
                    standard deviation and with the digits that this warrants. Both matrices are symmetric: what stands below \
                    the diagonal of a block is left out. Coupling has forces by rotations, and moments by translations across \
                    the diagonal. Set faint and in brackets: what the data do not determine, since its interval is as wide as \
                    what couples the two motions at most.</p>\n"
        .to_owned();
    let [of_stiffness, of_damping] = &found.deviations;
    for (part, (heading, letter, matrix, deviations)) in [
        ("Stiffness", "k", &found.stiffness, of_stiffness),
        ("Damping", "c", &found.damping, of_damping),
    ]
    .into_iter()
    .enumerate()
    {
        html += &format!("<h3>{heading}</h3>\n<div class=\"blocks\">\n");
        for block in &BLOCKS {
            html += &block.html(block.units[part], letter, [matrix, deviations], motions);
        }
        html += "</div>\n";
    }
    html
}

impl Block {
    /// A table of its rows and columns that are among these motions; nothing where there are none.
    fn html(
        &self,
        unit: &str,
        letter: &str,
        [matrix, deviations]: [&Matrix6<f64>; 2],
        motions: Motions,
    ) -> String {
        let own = |first: usize| -> Vec<usize> {
            let all = motions.rows().into_iter();
            all.filter(|motion| (first..first + 3).contains(motion))
                .collect()
        };
        let [own_rows, own_columns] = self.first.map(own);
        let is_symmetric = self.first[0] == self.first[1];
        let places = || {
            own_rows
                .iter()
                .flat_map(|&i| own_columns.iter().map(move |&j| (i, j)))
        };
        if places().next().is_none() {
            return String::new();
        }
        let largest = places()
            .map(|(i, j)| matrix[(i, j)].abs().max(deviations[(i, j)]))
            .fold(0.0, f64::max);
        if largest == 0.0 {
            return format!(
                "<div><p class=\"block\">{}</p><p>None in this model.</p></div>\n",
                self.name
            );
        }
        let (power, scaled) = scaled(largest, unit);
        let scale = 10_f64.powi(power);
        let of = |dof: usize| [TRANSLATIONS, ROTATIONS].concat()[dof];
        let row = |&i: &usize| {
            let cells = own_columns.iter().map(|&j| match is_symmetric && j < i {
                true => "<td></td>".to_owned(),
                false => {
                    let name = match i == j {
                        true => format!("{letter}_{}", of(i)),
                        false => format!("{letter}_{}_{}", of(i), of(j)),
                    };
                    let most = (matrix[(i, i)] * matrix[(j, j)]).abs().sqrt();
                    number(&name, [matrix[(i, j)], deviations[(i, j)], most], scale)
                }
            });
            format!(
                "<th scope=\"row\">{}</th>{}",
                of(i),
                cells.collect::<String>()
            )
        };
        let rows: Vec<String> = own_rows.iter().map(row).collect();
        let headings: Vec<String> = std::iter::once(String::new())
            .chain(own_columns.iter().map(|&j| of(j).to_owned()))
            .collect();
        let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
        let example = match (own_rows[0], own_columns[own_columns.len().min(2) - 1]) {
            (row, column) if row == column => format!("{letter}_{}", of(row)),
            (row, column) if is_symmetric => format!("{letter}_{}_{}", of(row), of(column)),
            (row, _) => format!("{letter}_{}_{}", of(row), of(own_columns[0])),
        };
        format!(
            "<div><p class=\"block\">{}, such as {}: {scaled}</p>\n{}</div>\n",
            self.name,
            symbol(&example),
            table(&headings, &rows)
        )
    }
}

/// The cell of a number with its deviation, in units of `scale`; `most` is what couples its motions at most.
fn number(name: &str, [value, deviation, most]: [f64; 3], scale: f64) -> String {
    if value == 0.0 && deviation == 0.0 {
        return "<td class=\"number\">0</td>".to_owned();
    }
    let is_determined = QUANTILE * deviation < most;
    let (class, [open, close]) = match is_determined {
        true => ("number", ["", ""]),
        false => ("number open", ["(", ")"]),
    };
    let [value, deviation] = [value, deviation].map(|number| number / scale);
    let digits = match deviation {
        0.0 => shown(value, 6),
        deviation => beside(value, deviation),
    };
    format!(
        "<td class=\"{class}\" title=\"{name}\">{open}{digits}{close}<br><small>± {}</small></td>",
        spread(deviation)
    )
}
