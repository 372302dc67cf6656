//! What stands in the comments of every file: what it is, in which units, which signs, and how well it is known.

use bolted_joint_dynamics::law::{DAMPING, Parameter, STIFFNESS};
use bolted_joint_files::{TOOL, VERSION, number};
use bolted_joint_joint::JointFile;

use crate::linear::axis_of;
use crate::{Options, Target};

/// Digits of a deviation.
const DIGITS: usize = 2;

/// Lines for people, and notes that are told beside them.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    lines: Vec<String>,
    pub(crate) notes: Vec<String>,
}

impl Head {
    pub(crate) fn of(file: &JointFile, target: Target, options: &Options) -> Self {
        let mut lines = vec![
            file.name.clone(),
            format!("Joint for {}, written by {TOOL} {VERSION}", target.name()),
            "Units: N, m, rad, s, kg; a model in other units needs other numbers".to_owned(),
            "Signs: load on side b = K (x_a - x_b) + C (v_a - v_b); on side a the opposite"
                .to_owned(),
        ];
        let names = file.joint.dofs.rows().map(|dof| {
            let axis = ["x", "y", "z"][axis_of(dof) % 3];
            match axis_of(dof) {
                0..=2 => format!("{}: displacement along {axis}, m", dof.name),
                _ => format!("{}: rotation about {axis}, rad", dof.name),
            }
        });
        lines.push(format!(
            "Degrees of freedom: {}; the joint does not resist others",
            names.collect::<Vec<_>>().join("; ")
        ));
        for reason in file.reasons_against() {
            lines.push(format!("NOT TO BE RELIED ON: {reason}"));
        }
        lines.extend(deviations(file));
        if let Some(validity) = &file.validity {
            let [low, high] = validity.frequency_hz;
            lines.push(format!(
                "Holds from {} to {} Hz",
                number(low, 5),
                number(high, 5)
            ));
        }
        let mut head = Self {
            lines,
            notes: Vec::new(),
        };
        let left = crate::linear::beyond_linear(file);
        if options.at_rest && !left.is_empty() {
            head.note(format!(
                "taken at rest: of {} only the stiffness and damping of small motion are here, so nothing slips and no load depends \
                 on the amplitude",
                left.join(", ")
            ));
        }
        head
    }

    /// Something that the user should know, said in the file and on the terminal.
    pub(crate) fn note(&mut self, note: impl Into<String>) {
        let note = note.into();
        self.lines.push(note.clone());
        self.notes.push(note);
    }

    /// The lines as comments.
    pub(crate) fn comments(&self, prefix: &str) -> String {
        let lines = self.lines.iter();
        lines
            .map(|line| format!("{prefix}{}\n", ascii(line)))
            .collect()
    }
}

/// A line for K and C each.
fn deviations(file: &JointFile) -> Vec<String> {
    let Some(uncertainty) = &file.uncertainty else {
        return Vec::new();
    };
    let own = &uncertainty.standard_deviation;
    let kinds: [(&Parameter, &Vec<Vec<f64>>); 2] =
        [(STIFFNESS, &own.stiffness), (DAMPING, &own.damping)];
    let told = kinds.into_iter().filter_map(|(parameter, matrix)| {
        let dofs = file.joint.dofs;
        let entries = dofs.entries().filter_map(|[i, j]| {
            let deviation = matrix.get(i)?.get(j).filter(|own| **own > 0.0)?;
            let names = [i, j].map(|place| dofs.row(place).name).concat();
            let unit = dofs.unit(parameter.unit, [i, j]);
            Some(format!(
                "{}_{names} {} {unit}",
                parameter.symbol,
                number(*deviation, DIGITS)
            ))
        });
        let entries: Vec<String> = entries.collect();
        (!entries.is_empty()).then(|| format!("Standard deviations: {}", entries.join(", ")))
    });
    told.collect()
}

/// A text that every reader takes, on one line.
pub(crate) fn ascii(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '·' => '.',
            '×' => 'x',
            '−' | '–' => '-',
            // ends a command in APDL
            '$' => '?',
            ' '..='~' => c,
            _ => '?',
        })
        .collect()
}
