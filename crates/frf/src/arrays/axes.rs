//! Which axis of a matrix of functions is which: told by the lengths, or by the file, and never guessed.

use std::fmt;

use crate::TableProblem;

/// What an axis of the matrix runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Over {
    Response,
    Reference,
    Frequency,
}

impl fmt::Display for Over {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Response => "response",
            Self::Reference => "reference",
            Self::Frequency => "frequency",
        })
    }
}

/// How many responses, references and frequencies there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) responses: usize,
    pub(super) references: usize,
    pub(super) frequencies: usize,
}

impl Counts {
    /// Of the matrix.
    pub(super) fn elements(self) -> usize {
        let functions = self.responses.saturating_mul(self.references);
        functions.saturating_mul(self.frequencies)
    }

    fn of(self, over: Over) -> usize {
        match over {
            Over::Response => self.responses,
            Over::Reference => self.references,
            Over::Frequency => self.frequencies,
        }
    }
}

const ORDERS: [[Over; 3]; 6] = {
    use Over::{Frequency, Reference, Response};
    [
        [Response, Reference, Frequency],
        [Reference, Response, Frequency],
        [Frequency, Response, Reference],
        [Frequency, Reference, Response],
        [Response, Frequency, Reference],
        [Reference, Frequency, Response],
    ]
};

/// The order that a text such as `frequency,response,reference` names.
pub(super) fn named(text: &str) -> Result<Vec<Over>, TableProblem> {
    let order: Option<Vec<Over>> = text
        .split(|c: char| !c.is_alphabetic())
        .filter(|word| !word.is_empty())
        .map(|word| {
            ORDERS[0]
                .into_iter()
                .find(|over| over.to_string() == word.to_lowercase())
        })
        .collect();
    let distinct = |order: &Vec<Over>| (1..order.len()).all(|i| !order[..i].contains(&order[i]));
    order
        .filter(|order| order.contains(&Over::Frequency) && distinct(order))
        .ok_or_else(|| {
            TableProblem::at(
                "array axes",
                format_args!("\"{}\"", crate::shown(text)),
                "the words response, reference and frequency, each once, in the order of the matrix's axes, such as \
                 \"frequency,response,reference\"",
            )
        })
}

/// The order of the axes of a matrix of this `shape`.
///
/// Axes of length one may be missing from it.
pub(super) fn order(
    array: &str,
    shape: &[usize],
    counts: Counts,
    stated: Option<&[Over]>,
) -> Result<Vec<Over>, TableProblem> {
    let fits = |order: &[Over]| {
        order.len() == shape.len()
            && order
                .iter()
                .zip(shape)
                .all(|(&over, &length)| counts.of(over) == length)
            && ORDERS[0]
                .iter()
                .all(|over| order.contains(over) || counts.of(*over) == 1)
    };
    let wrong_shape = || {
        let Counts {
            responses,
            references,
            frequencies,
        } = counts;
        TableProblem::at(
            format_args!("array {array}"),
            format_args!("shape {shape:?}"),
            format_args!(
                "{responses} responses, {references} references and {frequencies} frequencies in any order, \
                 as the arrays with their names have them{}",
                if stated.is_some() {
                    ", in the order of the array axes"
                } else {
                    ""
                }
            ),
        )
    };
    if let Some(stated) = stated {
        // those that fit differ at most in which axes of length one they name
        let found = with_some_missing(stated).find(|order| fits(order));
        return found.ok_or_else(wrong_shape);
    }
    let mut found: Vec<Vec<Over>> = Vec::new();
    for full in ORDERS {
        for candidate in with_some_missing(&full).filter(|order| fits(order)) {
            if !found
                .iter()
                .any(|known| same_elements(known, &candidate, counts))
            {
                found.push(candidate);
            }
        }
    }
    match found.as_slice() {
        [] => Err(wrong_shape()),
        [one] => Ok(one.clone()),
        [first, second, ..] => {
            let [first, second] = [list(first), list(second)];
            Err(TableProblem::at(
                format_args!("array {array}"),
                format_args!("shape {shape:?}, which is either ({first}) or ({second})"),
                format_args!(
                    "one reading. Add the order of its axes when saving, such as axes=\"{first}\""
                ),
            ))
        }
    }
}

/// An order, and what is left of it where axes are missing, as MATLAB leaves out those of length one at the end.
fn with_some_missing(order: &[Over]) -> impl Iterator<Item = Vec<Over>> {
    (0..1_u8 << order.len()).map(|missing| {
        let there = (0..order.len()).filter(|index| missing & (1 << index) == 0);
        there.map(|index| order[index]).collect()
    })
}

/// Whether two orders differ at most in where axes of length one stand.
fn same_elements(first: &[Over], second: &[Over], counts: Counts) -> bool {
    let longer = |order: &[Over]| -> Vec<Over> {
        order
            .iter()
            .copied()
            .filter(|&over| counts.of(over) != 1)
            .collect()
    };
    longer(first) == longer(second)
}

fn list(order: &[Over]) -> String {
    let words: Vec<String> = order.iter().map(Over::to_string).collect();
    words.join(",")
}

#[cfg(test)]
mod tests {
    use super::Over::{Frequency, Reference, Response};
    use super::*;

    fn counts(responses: usize, references: usize, frequencies: usize) -> Counts {
        Counts {
            responses,
            references,
            frequencies,
        }
    }

    #[test]
    fn lengths_that_differ_tell_the_axes() {
        let found = |shape: &[usize]| order("frf", shape, counts(3, 2, 100), None);
        assert_eq!(
            found(&[3, 2, 100]).unwrap(),
            [Response, Reference, Frequency]
        );
        assert_eq!(
            found(&[100, 3, 2]).unwrap(),
            [Frequency, Response, Reference]
        );
        assert_eq!(
            found(&[2, 100, 3]).unwrap(),
            [Reference, Frequency, Response]
        );
        for shape in [[3, 3, 100].as_slice(), &[3, 100], &[100], &[6, 100], &[]] {
            let refused = found(shape).unwrap_err().to_string();
            assert!(refused.contains("in any order"), "{shape:?}: {refused}");
        }
    }

    #[test]
    fn an_axis_of_one_may_be_missing_and_does_not_make_it_ambiguous() {
        let column = counts(3, 1, 100);
        assert_eq!(
            order("frf", &[3, 100], column, None).unwrap(),
            [Response, Frequency]
        );
        assert_eq!(
            order("frf", &[100, 3], column, None).unwrap(),
            [Frequency, Response]
        );
        assert!(order("frf", &[1, 3, 100], column, None).is_ok());
        assert_eq!(
            order("frf", &[100], counts(1, 1, 100), None).unwrap(),
            [Frequency]
        );
        assert!(order("frf", &[1, 1, 1], counts(1, 1, 1), None).is_ok());
    }

    #[test]
    fn an_axis_of_one_that_the_file_names_may_be_missing_too() {
        let stated = named("frequency,response,reference").unwrap();
        let found = |shape: &[usize], counts| order("frf", shape, counts, Some(&stated));
        assert_eq!(
            found(&[100, 3], counts(3, 1, 100)).unwrap(),
            [Frequency, Response]
        );
        // three responses at three frequencies: only the file tells which axis is which
        assert_eq!(
            found(&[3, 3], counts(3, 1, 3)).unwrap(),
            [Frequency, Response]
        );
        assert!(found(&[3, 100], counts(3, 1, 100)).is_err());
        assert!(found(&[100, 3], counts(3, 2, 100)).is_err());
    }

    #[test]
    fn equal_lengths_are_ambiguous_unless_the_file_says() {
        let square = counts(3, 3, 100);
        let problem = order("frf", &[100, 3, 3], square, None).unwrap_err();
        let message = problem.to_string();
        assert!(
            message.contains("(frequency,response,reference) or (frequency,reference,response)"),
            "{message}"
        );
        let stated = named("frequency, response, reference").unwrap();
        assert_eq!(
            order("frf", &[100, 3, 3], square, Some(&stated)).unwrap(),
            stated
        );
        assert!(order("frf", &[3, 3, 100], square, Some(&stated)).is_err());
        let refused = order("frf", &[3, 3], counts(3, 1, 3), None).unwrap_err();
        assert!(refused.to_string().contains("which is either"), "{refused}");
        for text in [
            "",
            "response,reference",
            "frequency,response,response",
            "frequency,node",
        ] {
            let refused = named(text).unwrap_err().to_string();
            assert!(refused.starts_with("array axes: "), "{text}: {refused}");
        }
    }
}
