//! The numbers of data set 58, gathered line by line and split into frequencies and values.

use std::io::BufRead;

use num_complex::Complex64;

use super::UffProblem;
use super::header::Layout;
use super::lines::Lines;
use super::numbers::parse_line;
use crate::frf::FrfError;

/// More numbers than this are not reserved in advance, whatever the header says.
const RESERVED_AT_MOST: usize = 1 << 16;

/// Reads the values of a data set that began at line `begun_at`, up to and including the closing `-1`.
///
/// Returns the frequencies (Hz) and the values in the file's units; real values have no imaginary part.
pub(super) fn read<R: BufRead>(
    lines: &mut Lines<R>,
    layout: Layout,
    begun_at: usize,
) -> Result<(Vec<f64>, Vec<Complex64>), FrfError> {
    let expected = layout.lines.saturating_mul(layout.numbers_per_line());
    let mut numbers: Vec<f64> = Vec::with_capacity(expected.min(RESERVED_AT_MOST));
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
        let (wanted, filling) = found.split_at(found.len().min(expected - numbers.len()));
        let is_filling = !wanted.is_empty() && filling.iter().all(|number| *number == 0.0);
        if !(filling.is_empty() || is_filling) {
            return Err(lines.problem(UffProblem::TooManyNumbers { expected, begun_at }));
        }
        numbers.extend_from_slice(wanted);
    }
    if numbers.len() < expected {
        let found = numbers.len();
        return Err(lines.problem(UffProblem::TooFewNumbers {
            found,
            expected,
            begun_at,
        }));
    }
    Ok(split(&numbers, layout))
}

fn split(numbers: &[f64], layout: Layout) -> (Vec<f64>, Vec<Complex64>) {
    numbers
        .chunks_exact(layout.numbers_per_line())
        .enumerate()
        .map(|(index, line)| {
            let (frequency_hz, ordinate) = match layout.even {
                Some((minimum, increment)) => (minimum + index as f64 * increment, line),
                None => (line[0], &line[1..]),
            };
            let imaginary = ordinate.get(1).copied().unwrap_or(0.0);
            (frequency_hz, Complex64::new(ordinate[0], imaginary))
        })
        .unzip()
}
