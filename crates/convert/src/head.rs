//! What stands in the comments of every file: what it is, in which units, which signs, and how well it is known.

use bolted_joint_dynamics::law::{DAMPING, Parameter, STIFFNESS};
use bolted_joint_files::{TOOL, VERSION, number};
use bolted_joint_joint::{JointFile, unit};

use crate::linear::axis_of;
use crate::{Options, Target};

/// Digits of a deviation.
const DIGITS: usize = 2;
/// Columns of a comment's line: as many as Nastran reads, the fewest of all.
const COLUMNS: usize = 80;
/// What a line begins with that goes on with the one above.
const CONTINUED: &str = "  ";

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
            format!(
                "Units: {}; a model in other units needs other numbers",
                options.units.names()
            ),
            "Signs: load on side b = K (x_a - x_b) + C (v_a - v_b); on side a the opposite"
                .to_owned(),
        ];
        let names = file.joint.dofs.rows().map(|dof| {
            let axis = ["x", "y", "z"][axis_of(dof) % 3];
            match axis_of(dof) {
                0..=2 => format!(
                    "{}: displacement along {axis}, {}",
                    dof.name,
                    options.units.of_length()
                ),
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
        for matrix in file.passivity().active() {
            lines.push(format!("CAN FEED ENERGY INTO A SIMULATION: {matrix}"));
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
        lines.extend(origin(file).map(str::to_owned));
        let mut head = Self {
            lines,
            notes: Vec::new(),
        };
        if file.bodies.is_some() {
            head.note(
                "the two bodies of the joint file, their masses and supports, are no part of the joint and are not here: they are those of \
                 the model that it goes into",
            );
        }
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
        lines.map(|line| comment(prefix, line)).collect()
    }
}

/// What the joint file tells of where the joint comes from: its axes, what is held, what is missing.
pub(crate) fn origin(file: &JointFile) -> impl Iterator<Item = &str> {
    let own = file.provenance.iter();
    own.flat_map(|own| own.notes.iter().map(String::as_str))
}

/// A text as a comment, on as many lines as it takes.
pub(crate) fn comment(prefix: &str, text: &str) -> String {
    let mut comment = String::new();
    let mut line = prefix.to_owned();
    let mut is_empty = true;
    for word in text.split_whitespace().map(ascii) {
        if !is_empty && line.len() + 1 + word.len() > COLUMNS {
            comment += &line;
            comment.push('\n');
            line = format!("{prefix}{CONTINUED}");
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line += &word;
        is_empty = false;
    }
    comment + &line + "\n"
}

/// A line for K and C each, and for each law.
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
    let of_laws = own.friction.iter().filter_map(|law| {
        let of_parameter = |parameter: &Parameter| {
            let deviation = law.value(parameter).filter(|own| *own > 0.0)?;
            let unit = match unit(parameter.unit, law.dof.kind, law.dof.kind) {
                one if one == "1" => String::new(),
                unit => format!(" {unit}"),
            };
            Some(format!(
                "{} {}{unit}",
                parameter.key,
                number(deviation, DIGITS)
            ))
        };
        let entries: Vec<String> = law.law.parameters.iter().filter_map(of_parameter).collect();
        (!entries.is_empty()).then(|| {
            let (law, dof) = (law.law.name, law.dof.name);
            format!(
                "Standard deviations of {law} on {dof}: {}",
                entries.join(", ")
            )
        })
    });
    told.chain(of_laws).collect()
}

/// A text that every reader takes, on one line.
pub(crate) fn ascii(text: &str) -> String {
    let mut ascii = String::new();
    let mut is_raised = false;
    for c in text.chars() {
        let digit = RAISED.iter().position(|own| *own == c);
        if digit.is_some() && !is_raised {
            ascii.push('^');
        }
        is_raised = digit.is_some();
        match c {
            '·' => ascii.push('.'),
            '×' => ascii.push('x'),
            '−' | '–' => ascii.push('-'),
            '±' => ascii += "+-",
            'θ' => ascii += "theta",
            'σ' => ascii += "sigma",
            'χ' => ascii += "chi",
            'κ' => ascii += "kappa",
            // ends a command in APDL
            '$' => ascii.push('?'),
            ' '..='~' => ascii.push(c),
            _ => match digit {
                Some(digit) => ascii += &digit.to_string(),
                None => ascii.push('?'),
            },
        }
    }
    ascii
}

/// Digits of powers, from 0.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reader_takes_the_letters() {
        for (text, expected) in [
            ("N·m·s/rad⁵", "N.m.s/rad^5"),
            ("N/m¹¹", "N/m^11"),
            ("½ × θ ± 2 − $", "? x theta +- 2 - ?"),
        ] {
            assert_eq!(ascii(text), expected);
        }
    }

    #[test]
    fn comments_are_wrapped_between_words() {
        let text = "word ".repeat(40);
        let comment = comment("** ", &text);
        assert!(
            comment
                .lines()
                .all(|line| line.starts_with("** ") && line.len() <= COLUMNS)
        );
        assert_eq!(comment.matches("word").count(), 40);
        assert_eq!(super::comment("! ", "\n"), "! \n");
    }
}
