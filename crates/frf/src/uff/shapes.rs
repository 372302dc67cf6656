//! Mode shapes in a universal file: data set 55, data at nodes, of normal and of complex modes.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use num_complex::Complex64;

use super::datasets::{Begun, Units};
use super::fields::columns;
use super::lines::Lines;
use super::numbers::parse_line;
use super::{UffProblem, UnitSystem};
use crate::{FrfError, shown};

/// Records of text before those of numbers.
const TEXTS: usize = 5;
/// Numbers in a line of data, each this wide.
const WIDTHS: [usize; 6] = [13; 6];
/// More numbers than records 7 may have.
const MOST_PARAMETERS: usize = 12;
/// Motions of a node.
const MOTIONS: usize = 6;

/// What the file says of how a mode vibrates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Vibration {
    /// Analysis type 2: Hz, modal mass in the file's unit, damping ratio, loss factor.
    Normal {
        frequency_hz: f64,
        mass: f64,
        viscous: f64,
        hysteretic: f64,
    },
    /// Analysis type 3: pole, 1/s, and modal A.
    Complex { pole: Complex64, modal_a: Complex64 },
}

/// One mode.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShapeSet {
    /// Where its data set begins.
    pub(crate) line: usize,
    pub(crate) vibration: Vibration,
    /// Motions of each node along X, Y, Z and about them; zero where the file has none.
    pub(crate) nodes: BTreeMap<u32, [Complex64; MOTIONS]>,
    /// Whether the file has rotations.
    pub(crate) has_rotations: bool,
}

/// All modes of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ShapeFile {
    pub(crate) modes: Vec<ShapeSet>,
    pub(crate) units: Option<UnitSystem>,
    /// Data sets 55 that are no mode shapes.
    pub(crate) passed_over: usize,
}

/// Whether the first data set of functions or shapes in a universal file is one of shapes.
#[must_use]
pub fn begins_with_shapes(path: &Path) -> bool {
    let Ok(file) = File::open(path) else {
        return false;
    };
    let mut lines = Lines::new(BufReader::new(file), path, None);
    let mut is_first = true;
    while let Ok(Some(begun)) = lines.next_dataset(is_first) {
        is_first = false;
        match begun.number.as_str() {
            "55" => return true,
            "58" | "58b" => return false,
            _ if lines.pass_over(&begun).is_err() => return false,
            _ => {}
        }
    }
    false
}

/// Reads the mode shapes of a universal file; `name` stands for the path in messages.
///
/// # Errors
/// [`FrfError::Uff`] with line and cause.
pub(crate) fn read_shapes(reader: impl BufRead, name: &Path) -> Result<ShapeFile, FrfError> {
    let mut lines = Lines::new(reader, name, None);
    let mut file = ShapeFile::default();
    let mut units: Units = None;
    let mut is_first = true;
    while let Some(begun) = lines.next_dataset(is_first)? {
        is_first = false;
        match begun.number.as_str() {
            "55" => match Header::read(&mut lines, &begun)? {
                Some(header) => {
                    let mode = header.with_nodes(&mut lines, &begun)?;
                    file.modes.push(mode);
                }
                None => {
                    lines.skip_rest("55", begun.at)?;
                    file.passed_over += 1;
                }
            },
            "164" => lines.read_units(&mut units, begun.at)?,
            _ => lines.pass_over(&begun)?,
        }
    }
    if is_first {
        return Err(lines.problem_at(1, UffProblem::Empty));
    }
    file.units = units.map(|(_, units)| units);
    Ok(file)
}

/// What stands above the nodes.
struct Header {
    vibration: Vibration,
    is_complex: bool,
    /// Motions of each node: 3 or 6.
    motions: usize,
}

impl Header {
    /// Records 1 to 8; nothing where the data set is no mode shape.
    fn read<R: BufRead>(lines: &mut Lines<R>, begun: &Begun) -> Result<Option<Self>, FrfError> {
        for record in 0..TEXTS {
            record_line(lines, begun, record)?;
        }
        record_line(lines, begun, TEXTS)?;
        let [_, analysis, characteristic, kind, data_type, motions] = integers(lines, 6)?;
        if !matches!(analysis, 2 | 3 | 7) || !matches!(kind, 0 | 1 | 8 | 11 | 12) {
            return Ok(None);
        }
        let refused = |lines: &Lines<R>, found: String, expected| {
            Err(lines.problem(UffProblem::Shape { found, expected }))
        };
        if analysis == 7 {
            let found = "a complex mode of second order (analysis type 7)".to_owned();
            let expected = "normal modes (2) or complex modes of first order (3); export the modes as one of these";
            return refused(lines, found, expected);
        }
        if matches!(kind, 11 | 12) {
            let found = format!("shapes of velocity or acceleration (specific data type {kind})");
            return refused(
                lines,
                found,
                "shapes of displacement (8); export them as these",
            );
        }
        let is_vector = matches!((characteristic, motions), (0 | 2, 3) | (0 | 3, 6));
        if !is_vector {
            let found =
                format!("data characteristic {characteristic} with {motions} values at each node");
            let expected =
                "motions in the global axes: characteristic 2 with 3 values, or 3 with 6";
            return refused(lines, found, expected);
        }
        if !matches!(data_type, 2 | 5) {
            let found = format!("data type {data_type}");
            return refused(lines, found, "2 (real) or 5 (complex)");
        }
        record_line(lines, begun, TEXTS + 1)?;
        let [_, count] = integers(lines, 7)?;
        let count = usize::try_from(count).unwrap_or(0);
        let needed = if analysis == 2 { 4 } else { 6 };
        if !(needed..=MOST_PARAMETERS).contains(&count) {
            let found = format!("{count} real parameters in record 7");
            let expected = "4 for a normal mode (frequency, modal mass, two dampings) or 6 for a complex one (pole, modal A, modal B)";
            return refused(lines, found, expected);
        }
        let parameters = numbers(lines, begun, count)?;
        let vibration = match analysis {
            2 => Vibration::Normal {
                frequency_hz: parameters[0],
                mass: parameters[1],
                viscous: parameters[2],
                hysteretic: parameters[3],
            },
            _ => Vibration::Complex {
                pole: Complex64::new(parameters[0], parameters[1]),
                modal_a: Complex64::new(parameters[2], parameters[3]),
            },
        };
        Ok(Some(Self {
            vibration,
            is_complex: data_type == 5,
            motions: if motions == 3 { 3 } else { MOTIONS },
        }))
    }

    /// The mode with its nodes, up to and with the closing `-1`.
    fn with_nodes<R: BufRead>(
        self,
        lines: &mut Lines<R>,
        begun: &Begun,
    ) -> Result<ShapeSet, FrfError> {
        let mut nodes = BTreeMap::new();
        loop {
            if !lines.advance()? {
                return Err(lines.ends_inside("55", begun.at));
            }
            if lines.is_delimiter() {
                break;
            }
            let text = lines.text();
            let node: u32 = text.trim().parse().map_err(|_| {
                lines.problem(UffProblem::Shape {
                    found: format!("\"{}\"", shown(&text)),
                    expected: "the number of a node, from 0 to 4294967295, alone on its line",
                })
            })?;
            let parts = if self.is_complex { 2 } else { 1 };
            let values = numbers(lines, begun, self.motions * parts)?;
            let mut motions = [Complex64::default(); MOTIONS];
            for (motion, value) in motions.iter_mut().zip(values.chunks(parts)) {
                *motion = Complex64::new(value[0], value.get(1).copied().unwrap_or(0.0));
            }
            if nodes.insert(node, motions).is_some() {
                return Err(lines.problem(UffProblem::Shape {
                    found: format!("node {node} twice"),
                    expected: "every node once in a mode",
                }));
            }
        }
        Ok(ShapeSet {
            line: begun.at,
            vibration: self.vibration,
            nodes,
            has_rotations: self.motions == MOTIONS,
        })
    }
}

/// On to the line of a record, counted from 0.
fn record_line<R: BufRead>(
    lines: &mut Lines<R>,
    begun: &Begun,
    record: usize,
) -> Result<(), FrfError> {
    if !lines.advance()? {
        return Err(lines.ends_inside("55", begun.at));
    }
    if record >= TEXTS && lines.is_delimiter() {
        return Err(lines.problem(UffProblem::HeaderEnds {
            dataset: 55,
            begun_at: begun.at,
            found: record,
            expected: TEXTS + 3,
        }));
    }
    Ok(())
}

/// The first whole numbers of the current line, by blanks or in columns of ten.
fn integers<R: BufRead, const N: usize>(
    lines: &Lines<R>,
    record: usize,
) -> Result<[i64; N], FrfError> {
    let text = lines.text();
    let by_blanks: Option<Vec<i64>> = text
        .split_whitespace()
        .take(N)
        .map(|field| field.parse().ok())
        .collect();
    let by_columns = || -> Option<Vec<i64>> {
        let fields = (0..N).map(|place| columns(&text, 10 * place, 10 * place + 10));
        fields.map(|field| field.parse().ok()).collect()
    };
    by_blanks
        .filter(|all| all.len() == N)
        .or_else(by_columns)
        .and_then(|all| <[i64; N]>::try_from(all).ok())
        .ok_or_else(|| {
            lines.problem(UffProblem::Field {
                record,
                field: "the numbers",
                found: shown(&text),
                expected: "whole numbers in columns of ten, as the standard has them for data set 55",
            })
        })
}

/// So many numbers from the lines that follow, six in each.
fn numbers<R: BufRead>(
    lines: &mut Lines<R>,
    begun: &Begun,
    count: usize,
) -> Result<Vec<f64>, FrfError> {
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        if !lines.advance()? {
            return Err(lines.ends_inside("55", begun.at));
        }
        if lines.is_delimiter() || lines.is_blank() {
            return Err(lines.problem(UffProblem::Shape {
                found: format!("{} numbers", all.len()),
                expected: "as many as the header says; the data set is cut short, export it again",
            }));
        }
        let own = parse_line(&lines.text(), &WIDTHS).map_err(|bad| {
            let (column, found) = (bad.column, bad.text);
            lines.problem(UffProblem::NotANumber { column, found })
        })?;
        all.extend(own);
        if let Some(bad) = all.iter().find(|value| !value.is_finite()) {
            return Err(lines.problem(UffProblem::Shape {
                found: bad.to_string(),
                expected: "finite numbers",
            }));
        }
    }
    match all.len() == count {
        true => Ok(all),
        false => Err(lines.problem(UffProblem::Shape {
            found: format!("{} numbers", all.len()),
            expected: "as many as the header says",
        })),
    }
}
