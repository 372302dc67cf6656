//! The numbers of an ASCII data set 58, gathered line by line and made into frequencies and values as they come.

use std::io::BufRead;

use num_complex::Complex64;

use super::UffProblem;
use super::header::Layout;
use super::lines::Lines;
use super::numbers::parse_line;
use crate::gathered::Gathered;
use crate::{FrfError, Selection};

/// Reads the values of a data set that began at line `begun_at`, up to and including the closing `-1`.
///
/// Frequencies are Hz, values are in the file's units; real values have no imaginary part.
pub(super) fn read<R: BufRead>(
    lines: &mut Lines<R>,
    layout: Layout,
    begun_at: usize,
    selection: &Selection,
) -> Result<Gathered, FrfError> {
    let expected = layout.lines.saturating_mul(layout.numbers_per_line());
    let mut count = 0;
    let mut gathered = Gathered::default();
    let mut line = Vec::with_capacity(layout.numbers_per_line());
    loop {
        if !lines.advance()? {
            let dataset = "58".to_owned();
            return Err(lines.problem(UffProblem::EndsInside { dataset, begun_at }));
        }
        if lines.is_delimiter() {
            break;
        }
        let found = parse_line(&lines.text(), layout.widths()).map_err(|bad| {
            let (column, found) = (bad.column, bad.text);
            lines.problem(UffProblem::NotANumber { column, found })
        })?;
        if let Some(&found) = found.iter().find(|number| !number.is_finite()) {
            return Err(lines.problem(UffProblem::NotFinite { found }));
        }
        // Some writers fill the last line with zeros.
        let (wanted, filling) = found.split_at(found.len().min(expected - count));
        let is_filling = !wanted.is_empty() && filling.iter().all(|number| *number == 0.0);
        if !(filling.is_empty() || is_filling) {
            return Err(lines.problem(UffProblem::TooManyNumbers { expected, begun_at }));
        }
        for &number in wanted {
            line.push(number);
            count += 1;
            if line.len() == layout.numbers_per_line() {
                let index = count / layout.numbers_per_line() - 1;
                let (hz, value) = as_line(&line, index, layout);
                gathered.push(selection, hz, value);
                line.clear();
            }
        }
    }
    if count < expected {
        return Err(lines.problem(UffProblem::TooFewNumbers {
            found: count,
            expected,
            begun_at,
        }));
    }
    Ok(gathered)
}

fn as_line(numbers: &[f64], index: usize, layout: Layout) -> (f64, Complex64) {
    let (hz, ordinate) = match layout.even {
        Some((minimum, increment)) => (minimum + index as f64 * increment, numbers),
        None => (numbers[0], &numbers[1..]),
    };
    let imaginary = ordinate.get(1).copied().unwrap_or(0.0);
    (hz, Complex64::new(ordinate[0], imaginary))
}
