//! A table from its first line to its last, one line at a time.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader};
use std::path::Path;

use bolted_joint_files::Decimal;
use bolted_joint_files::text_table::{Cells, is_blank, is_for_excel};
use num_complex::Complex64;

use super::column::{Columns, Form};
use super::header::{Above, Header, Keys, Names};
use super::phase::Phases;
use super::row::Row;
use super::rows::Rows;
use crate::gathered::Gathered;
use crate::read::opened;
use crate::statement::{Stated, Statement};
use crate::summary::Statements;
use crate::{Coherence, FileFormat, FrfError, FrfReading, ReadOptions, TableProblem};

/// The last line on which a title may stand above the names.
const TITLES: usize = 50;

/// Reads the functions of a table (CSV).
///
/// The first row names the columns: `frequency [Hz]`, then for each function two columns such as
/// `11:+Y/2:+Y real [m/N]` and `11:+Y/2:+Y imaginary [m/N]`, or `… magnitude [m/N]` and `… phase [deg]`, or one column
/// `… complex [m/N]`, and perhaps `… coherence`. Units may stand in a row of their own below the names, and a magnitude may be
/// in decibels, `[dB re 1 m/N]`. A table of coherences alone gives these and no function. Lines that begin with `#` are comments, and
/// so are titles above the names; `# quantity = …`, `# unit = …` and `# averages = …` hold for all functions that do not say otherwise,
/// with and without the `#`. Values become receptances in SI units.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Csv`] with line and cause if it cannot be used.
pub fn read_csv(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    let path = path.as_ref();
    let file = opened(path)?;
    read_csv_from(BufReader::new(file), path, options)
}

/// As [`read_csv`], from any reader; `name` stands for the path in messages.
///
/// ```
/// use bolted_joint_frf::{ReadOptions, read_csv_from};
///
/// let table = "frequency [Hz],1:+Y/2:+Y real [mm/s^2/N],1:+Y/2:+Y imaginary\n\
///              10,-3947.8418,0\n20,-15791.367,0\n";
/// let set = read_csv_from(table.as_bytes(), "tap.csv", &ReadOptions::default())?.into_set()?;
/// // What was measured becomes receptances in SI: x/F = a/(−ω² F)
/// let receptance = set.receptance("1:Y".parse()?, "2:Y".parse()?)?;
/// assert!((receptance.values()[1].re - 1e-3).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`read_csv`].
pub fn read_csv_from(
    reader: impl BufRead,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    let path = name.as_ref();
    let mut rows = Rows::of(reader, path);
    let mut keys = Keys::default();
    // what was refused first of the rows above the names
    let mut title = None;
    let mut names = loop {
        if !rows.advance()? {
            return Err(title.unwrap_or_else(|| {
                rows.problem(TableProblem::whole(
                    "no header row",
                    "column names such as \"frequency [Hz]\" and \"11:+Y/2:+Y real [m/N]\"; write them above the numbers",
                ))
            }));
        }
        let text = rows.text();
        match text.trim() {
            blank if is_blank(blank) => {}
            first if rows.number == 1 && is_for_excel(first) => {}
            comment if comment.starts_with('#') => {
                keys.read(comment)
                    .map_err(|problem| rows.problem(problem))?;
            }
            row => match Names::read(row) {
                Ok(names) => break names,
                Err(problem) => {
                    let refused = rows.problem(problem);
                    match Above::of(row) {
                        Above::Names => return Err(refused),
                        Above::Title if rows.number <= TITLES => {
                            keys.read(row).map_err(|problem| rows.problem(problem))?;
                            title.get_or_insert(refused);
                        }
                        _ => return Err(title.unwrap_or(refused)),
                    }
                }
            },
        }
    };
    let header_line = rows.number;
    let mut is_any = rows.advance_to_cells()?;
    if is_any && names.are_parts(&rows.text()) {
        names
            .take_parts(&rows.text())
            .map_err(|problem| rows.problem(problem))?;
        is_any = rows.advance_to_cells()?;
    }
    if is_any {
        let text = rows.text();
        rows.held = !names.are_units(&text);
        if !rows.held {
            names
                .take_units(&text)
                .map_err(|problem| rows.problem(problem))?;
        }
    }
    let at_header = |problem| FrfError::Csv {
        path: path.to_owned(),
        line: header_line,
        problem: Box::new(problem),
    };
    let header = names.grouped(&keys).map_err(at_header)?;
    let mut not_selected = BTreeSet::new();
    let mut wanted = Vec::new();
    for columns in header.functions.iter() {
        let (response, reference) = (columns.response, columns.reference);
        if !options.selection.wants(response, reference) {
            not_selected.insert((response, reference));
            continue;
        }
        let statement = Statement {
            response,
            reference,
            quantity: columns.quantity,
            unit: columns.unit.as_deref(),
        };
        let stated = match columns.form {
            Form::None => None,
            _ => Some(statement.decide(options).map_err(at_header)?),
        };
        wanted.push(Wanted {
            columns,
            stated,
            lines: Gathered::default(),
            phases: Phases::default(),
            coherence: Gathered::default(),
        });
    }
    rows.read_all(&header, &mut wanted, options)?;
    let function = |source| match source {
        // No fault of the function: the file has other lines than those that are asked for.
        source @ FrfError::EmptyBand { .. } => FrfError::InFile {
            path: path.to_owned(),
            source: Box::new(source),
        },
        source => at_header(TableProblem::Function(Box::new(source))),
    };
    let (mut functions, mut coherences) = (Vec::new(), Vec::new());
    let mut statements = Statements::default();
    for Wanted {
        columns,
        stated,
        lines,
        phases,
        coherence,
    } in wanted
    {
        let wrong = columns
            .form
            .phases_at()
            .and_then(|(place, in_radian)| match in_radian {
                true => phases.degrees(place + 1),
                false => phases.radians(place + 1),
            });
        if let Some((line, problem)) = wrong {
            return Err(FrfError::Csv {
                path: path.to_owned(),
                line,
                problem: Box::new(problem),
            });
        }
        let pair = (columns.response, columns.reference);
        if let Some(stated) = stated {
            functions.push(
                lines
                    .into_frf(pair, stated.quantity.0, stated.to_si, &options.selection)
                    .map_err(function)?,
            );
            statements.add(FileFormat::Table, stated.quantity, stated.units);
        } else {
            statements.add_coherence(FileFormat::Table);
        }
        if columns.coherence.is_some() {
            let gamma_squared = coherence.values.iter().map(|value| value.re).collect();
            coherences.push(
                Coherence::new(pair.0, pair.1, coherence.frequency_hz, gamma_squared)
                    .map_err(function)?,
            );
        }
    }
    Ok(FrfReading {
        path: path.to_owned(),
        functions,
        coherences,
        averages: options.averages_or(keys.averages),
        not_selected,
        skipped_functions: Vec::new(),
        skipped_datasets: Vec::new(),
        coherence_files: Vec::new(),
        statements,
        taken: Vec::new(),
    })
}

/// A function that is asked for, as far as it has been read.
struct Wanted<'header> {
    columns: &'header Columns,
    /// Nothing for a coherence alone.
    stated: Option<Stated>,
    lines: Gathered,
    phases: Phases,
    coherence: Gathered,
}

impl<R: BufRead> Rows<'_, R> {
    fn read_all(
        &mut self,
        header: &Header,
        wanted: &mut [Wanted<'_>],
        options: &ReadOptions,
    ) -> Result<(), FrfError> {
        let mut decimal = Decimal::beside(header.separator);
        let mut tokeniser = Cells::separated_by(header.separator).of_columns(header.column_count);
        let mut before_hz = None;
        while self.advance_to_cells()? {
            let text = self.text();
            let cells = tokeniser.of(text.trim_end_matches(['\n', '\r']));
            if cells.len() != header.column_count {
                return Err(self.problem(TableProblem::whole(
                    format_args!("{} fields", cells.len()),
                    format_args!(
                        "{} as in the header row; with decimal commas, separate the columns by semicolons",
                        header.column_count
                    ),
                )));
            }
            let mut row = Row {
                cells: &cells,
                decimal: &mut decimal,
            };
            let hz = row.real(0).map_err(|problem| self.problem(problem))?;
            if !hz.is_finite() || hz < 0.0 || before_hz.is_some_and(|before| hz <= before) {
                let after = before_hz.map(|before| format!(" after {before} Hz"));
                return Err(self.problem(TableProblem::at(
                    "column 1",
                    format_args!("frequency {hz} Hz{}", after.unwrap_or_default()),
                    "finite frequencies, not negative and strictly increasing; sort the lines and remove repeated ones",
                )));
            }
            before_hz = Some(hz);
            for function in &mut *wanted {
                let value = row.value(function.columns.form);
                let value = value.map_err(|problem| self.problem(problem))?;
                if !value.is_finite() && options.selection.wants_line(hz) {
                    return Err(self.problem(TableProblem::of_function(
                        (function.columns.response, function.columns.reference),
                        format_args!("value {value} at {hz} Hz"),
                        "a finite number; remove the line from the measurement",
                    )));
                }
                if let Some((place, _)) = function.columns.form.phases_at() {
                    let phase = row.real(place).map_err(|problem| self.problem(problem))?;
                    function.phases.push(phase, value.norm(), self.number);
                }
                function.lines.push(&options.selection, hz, value);
                if let Some(column) = function.columns.coherence {
                    let found = row.real(column).map_err(|problem| self.problem(problem))?;
                    let gamma_squared = Complex64::from(found);
                    function
                        .coherence
                        .push(&options.selection, hz, gamma_squared);
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: &str = "frequency [Hz];1:+Y/1:+Y accelerance real [m/s^2/N];1:+Y/1:+Y imaginary";

    /// First and last frequency and value of what is written so, by the only function.
    fn read(text: &str) -> Result<(usize, Complex64), String> {
        let reading = read_csv_from(text.as_bytes(), "t.csv", &ReadOptions::default());
        let reading = reading.map_err(|refused| refused.to_string())?;
        let own = &reading.functions()[0];
        Ok((own.receptance().len(), own.receptance()[0]))
    }

    #[test]
    fn what_spreadsheets_add_to_a_table_is_passed_over() {
        let plain = read(&format!("{NAMES}\n5;1,5;0,25\n6;1,6;0,26\n")).unwrap();
        assert_eq!(plain.0, 2);
        for text in [
            format!("sep=;\n{NAMES}\n5;1,5;0,25\n6;1,6;0,26\n"),
            format!("{NAMES}\n5;1,5;0,25\n6;1,6;0,26\n;;\n;;\n"),
            format!(";;\n{NAMES}\n5;1,5;0,25;;\n;;\n6;1,6;0,26\n"),
            format!("{NAMES};\n5;1,5;0,25;\n6;1,6;0,26;\n"),
            format!("{NAMES};\nHz;m/s^2/N;;\n5;1,5;0,25;\n6;1,6;0,26;\n"),
            format!("{NAMES}\r5;1,5;0,25\r6;1,6;0,26\r"),
            format!("{NAMES}\r\n5;1,5;0,25\r\n6;1,6;0,26"),
            format!("Export of 3 May\nUser: me;;\n\n{NAMES}\n5;1,5;0,25\n6;1,6;0,26\n"),
            format!("# averages = 10;;\n{NAMES}\r\r\n5;1,5;0,25\r\r\n6;1,6;0,26"),
        ] {
            assert_eq!(read(&text), Ok(plain), "{text:?}");
        }
        for (text, refused) in [
            (
                format!("Measured\nBeam; 2\n1;2;3\n{NAMES}\n5;1,5;0,25\n"),
                "line 1: column 1: found \"Measured\"",
            ),
            (
                format!("Measured\nquantity: work\n{NAMES}\n5;1,5;0,25\n"),
                "line 2: found quantity = \"work\"",
            ),
            (
                format!("Measured\n{}\n5;1,5;0,25\n", NAMES.replace("[Hz]", "[kHz]")),
                "line 2: column 1: found \"frequency [kHz]\"",
            ),
            (
                format!("{NAMES}\n5;1,5;0,25;7\n"),
                "line 2: found 4 fields, expected 3",
            ),
            (
                format!("{NAMES}\r5;1,5;0,25\r6;x;0,26\r"),
                "line 3: column 2: found \"x\"",
            ),
            (
                format!("{NAMES}\r\n5;1,5;0,25\r\n6;x;0,26\r\n"),
                "line 3: column 2: found \"x\"",
            ),
        ] {
            let found = read(&text).unwrap_err();
            assert!(found.contains(refused), "{found}");
        }
    }
}
