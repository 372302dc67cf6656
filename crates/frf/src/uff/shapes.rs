//! Mode shapes in a universal file: data sets 55 (data at nodes) and 2414 (analysis data), of normal and of complex modes.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;

use bolted_joint_files::inputs;
use num_complex::Complex64;

use super::datasets::{Begun, Units};
use super::fields::columns;
use super::lines::Lines;
use super::numbers::parse_line;
use super::{UffProblem, UnitSystem};
use crate::{FrfError, shown};

/// Records of text before those of numbers, in data set 55.
const TEXTS: usize = 5;
/// Records 1 and 2 of data set 2414, before the one that says where the data are; and the texts after it.
const LABELS: usize = 2;
/// Where data set 2414 has data at nodes.
const AT_NODES: i64 = 1;
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
    /// Data sets 55 and 2414 that are no mode shapes.
    pub(crate) passed_over: usize,
}

/// Data sets of shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// 55, data at nodes.
    Nodes,
    /// 2414, analysis data.
    Analysis,
}

impl Kind {
    fn of(begun: &Begun) -> Option<Self> {
        match begun.number.as_str() {
            "55" => Some(Self::Nodes),
            "2414" => Some(Self::Analysis),
            _ => None,
        }
    }

    fn number(self) -> &'static str {
        match self {
            Self::Nodes => "55",
            Self::Analysis => "2414",
        }
    }

    /// Records before the nodes.
    fn records(self) -> usize {
        match self {
            Self::Nodes => TEXTS + 3,
            Self::Analysis => LABELS + 1 + TEXTS + 5,
        }
    }
}

/// Whether the first data set of functions or shapes in a universal file is one of shapes.
#[must_use]
pub fn begins_with_shapes(path: &Path) -> bool {
    let Ok(file) = inputs::open(path) else {
        return false;
    };
    let mut lines = Lines::new(BufReader::new(file), path, None);
    let mut is_first = true;
    // Analysis data may be anything beside functions, and are shapes where there are none.
    let mut has_analysis = false;
    while let Ok(Some(begun)) = lines.next_dataset(is_first) {
        is_first = false;
        match begun.number.as_str() {
            "55" => return true,
            "58" | "58b" => return false,
            number => has_analysis |= number == "2414",
        }
        if lines.pass_over(&begun).is_err() {
            return false;
        }
    }
    has_analysis
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
        let header = match Kind::of(&begun) {
            Some(Kind::Nodes) => Header::read(&mut lines, &begun)?,
            Some(Kind::Analysis) => Header::read_analysis(&mut lines, &begun)?,
            None if begun.number == "164" => {
                lines.read_units(&mut units, begun.at)?;
                continue;
            }
            None => {
                lines.pass_over(&begun)?;
                continue;
            }
        };
        match header {
            Some(header) => file.modes.push(header.with_nodes(&mut lines, &begun)?),
            None => {
                lines.skip_rest(&begun.number, begun.at)?;
                file.passed_over += 1;
            }
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
    kind: Kind,
    vibration: Vibration,
    layout: Layout,
}

/// What is at each node.
#[derive(Clone, Copy)]
struct Layout {
    is_complex: bool,
    /// 3 or 6.
    motions: usize,
}

impl Layout {
    /// By the record that both kinds of data sets have, from analysis type on; nothing where it is no mode shape.
    fn read<R: BufRead>(
        lines: &Lines<R>,
        kind: Kind,
        record: [i64; 6],
    ) -> Result<Option<Self>, FrfError> {
        let [_, analysis, characteristic, result, data_type, motions] = record;
        let refused =
            |found: String, expected| Err(lines.problem(UffProblem::Shape { found, expected }));
        // 93, 95 and 96 of data set 2414 are vectors of unknown kind, as 0 and 1 are.
        let is_motion = match kind {
            Kind::Nodes => matches!(result, 0 | 1 | 8 | 11 | 12),
            Kind::Analysis => matches!(result, 0 | 8 | 11 | 12 | 93 | 95 | 96),
        };
        if !matches!(analysis, 2 | 3 | 7) || !is_motion {
            return Ok(None);
        }
        if analysis == 7 {
            let found = "a complex mode of second order (analysis type 7)".to_owned();
            let expected = "normal modes (2) or complex modes of first order (3); export the modes as one of these";
            return refused(found, expected);
        }
        if matches!(result, 11 | 12) {
            let found = format!("shapes of velocity or acceleration (specific data type {result})");
            return refused(found, "shapes of displacement (8); export them as these");
        }
        let is_vector = matches!((characteristic, motions), (0 | 2, 3) | (0 | 3, 6));
        if !is_vector {
            let found =
                format!("data characteristic {characteristic} with {motions} values at each node");
            let expected =
                "motions in the global axes: characteristic 2 with 3 values, or 3 with 6";
            return refused(found, expected);
        }
        let is_complex = match (kind, data_type) {
            (_, 2) | (Kind::Analysis, 4) => false,
            (_, 5) | (Kind::Analysis, 6) => true,
            _ => {
                let found = format!("data type {data_type}");
                let expected = match kind {
                    Kind::Nodes => "2 (real) or 5 (complex)",
                    Kind::Analysis => "2 or 4 (real), or 5 or 6 (complex)",
                };
                return refused(found, expected);
            }
        };
        Ok(Some(Self {
            is_complex,
            motions: if motions == 3 { 3 } else { MOTIONS },
        }))
    }
}

impl Header {
    /// Records 1 to 8 of data set 55; nothing where it is no mode shape.
    fn read<R: BufRead>(lines: &mut Lines<R>, begun: &Begun) -> Result<Option<Self>, FrfError> {
        let kind = Kind::Nodes;
        for record in 0..=TEXTS {
            record_line(lines, begun, kind, record, record >= TEXTS)?;
        }
        let record: [i64; 6] = integers(lines, kind, 6)?;
        let Some(layout) = Layout::read(lines, kind, record)? else {
            return Ok(None);
        };
        record_line(lines, begun, kind, TEXTS + 1, true)?;
        let [_, count] = integers(lines, kind, 7)?;
        let count = usize::try_from(count).unwrap_or(0);
        let is_normal = record[1] == 2;
        let needed = if is_normal { 4 } else { 6 };
        if !(needed..=MOST_PARAMETERS).contains(&count) {
            let found = format!("{count} real parameters in record 7");
            let expected = "4 for a normal mode (frequency, modal mass, two dampings) or 6 for a complex one (pole, modal A, modal B)";
            return Err(lines.problem(UffProblem::Shape { found, expected }));
        }
        let parameters = numbers(lines, begun, count)?;
        let vibration = match is_normal {
            true => normal(&parameters),
            false => complex(&parameters),
        };
        Ok(Some(Self {
            kind,
            vibration,
            layout,
        }))
    }

    /// Records 1 to 13 of data set 2414; nothing where it is no mode shape at nodes.
    fn read_analysis<R: BufRead>(
        lines: &mut Lines<R>,
        begun: &Begun,
    ) -> Result<Option<Self>, FrfError> {
        let kind = Kind::Analysis;
        let place = LABELS;
        for record in 0..=place {
            record_line(lines, begun, kind, record, record == place)?;
        }
        let [location] = integers(lines, kind, place + 1)?;
        if location != AT_NODES {
            return Ok(None);
        }
        let analysis = place + 1 + TEXTS;
        for record in place + 1..=analysis {
            record_line(lines, begun, kind, record, record == analysis)?;
        }
        let record: [i64; 6] = integers(lines, kind, analysis + 1)?;
        let Some(layout) = Layout::read(lines, kind, record)? else {
            return Ok(None);
        };
        // numbers of sets and modes: nothing that is needed
        for record in analysis + 1..=analysis + 2 {
            record_line(lines, begun, kind, record, true)?;
        }
        // time, frequency, eigenvalue, modal mass, two dampings; pole, modal A, modal B
        let first = numbers(lines, begun, WIDTHS.len())?;
        let second = numbers(lines, begun, WIDTHS.len())?;
        let vibration = match record[1] {
            2 => normal(&[first[1], first[3], first[4], first[5]]),
            _ => complex(&second),
        };
        Ok(Some(Self {
            kind,
            vibration,
            layout,
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
                return Err(lines.ends_inside(self.kind.number(), begun.at));
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
            let parts = if self.layout.is_complex { 2 } else { 1 };
            let values = numbers(lines, begun, self.layout.motions * parts)?;
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
            has_rotations: self.layout.motions == MOTIONS,
        })
    }
}

/// Frequency in Hz, modal mass, damping ratio, loss factor.
fn normal(parameters: &[f64]) -> Vibration {
    Vibration::Normal {
        frequency_hz: parameters[0],
        mass: parameters[1],
        viscous: parameters[2],
        hysteretic: parameters[3],
    }
}

/// Real and imaginary part of the pole and of modal A.
fn complex(parameters: &[f64]) -> Vibration {
    Vibration::Complex {
        pole: Complex64::new(parameters[0], parameters[1]),
        modal_a: Complex64::new(parameters[2], parameters[3]),
    }
}

/// On to the line of a record, counted from 0; one of numbers is no end of the data set.
fn record_line<R: BufRead>(
    lines: &mut Lines<R>,
    begun: &Begun,
    kind: Kind,
    record: usize,
    has_numbers: bool,
) -> Result<(), FrfError> {
    if !lines.advance()? {
        return Err(lines.ends_inside(kind.number(), begun.at));
    }
    if has_numbers && lines.is_delimiter() {
        return Err(lines.problem(UffProblem::HeaderEnds {
            dataset: kind.number().parse().unwrap_or(0),
            begun_at: begun.at,
            found: record,
            expected: kind.records(),
        }));
    }
    Ok(())
}

/// The first whole numbers of the current line, by blanks or in columns of ten.
fn integers<R: BufRead, const N: usize>(
    lines: &Lines<R>,
    kind: Kind,
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
                expected: match kind {
                    Kind::Nodes => "whole numbers in columns of ten, as the standard has them for data set 55",
                    Kind::Analysis => "whole numbers in columns of ten, as the standard has them for data set 2414",
                },
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
            return Err(lines.ends_inside(&begun.number, begun.at));
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
