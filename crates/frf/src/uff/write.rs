//! A set of receptances as a universal file that any modal analysis program can read.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use bolted_joint_files::inputs;
use bolted_joint_files::whole_file::followed;
use num_complex::Complex64;

use super::ByteOrder;
use super::header::RECORDS;
use crate::{Direction, Dof, FrfError, FrfSet};

/// The longest ID line of the standard, characters.
const ID_LINE: usize = 80;

/// Largest deviation of an axis written as first frequency and increment, as a share of the frequency.
const EVEN_TOLERANCE: f64 = 1e-9;

/// Writes a set as a universal file: SI units (data set 164) and one data set 58 for each function.
///
/// Receptances are complex in double precision with 13 digits. Frequencies are written as first one and increment where
/// that reproduces them to 10⁻⁹, and one by one otherwise, with as many digits as 13 columns hold (10 or more between
/// 10⁻³ and 10⁹ Hz). `description` becomes the first ID line: its first 80 characters, with anything outside ASCII
/// replaced by `?`.
///
/// The file is written whole or not at all.
///
/// # Errors
/// [`FrfError::Write`].
pub fn write_uff58(
    set: &FrfSet,
    path: impl AsRef<Path>,
    description: &str,
) -> Result<(), FrfError> {
    whole_file(path.as_ref(), |writer| {
        write_uff58_to(set, writer, description)
    })
}

/// As [`write_uff58`], in binary (58b): IEEE 754, complex values and uneven frequencies in double precision.
///
/// Nothing is rounded but an even axis, which is written as in ASCII.
///
/// # Errors
/// [`FrfError::Write`].
pub fn write_uff58b(
    set: &FrfSet,
    path: impl AsRef<Path>,
    description: &str,
    order: ByteOrder,
) -> Result<(), FrfError> {
    whole_file(path.as_ref(), |writer| {
        write_uff58b_to(set, writer, description, order)
    })
}

/// Writes a file beside its place and moves it there when it is complete. A symbolic link keeps pointing where it did.
fn whole_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), FrfError> {
    let failed = |source| FrfError::Write {
        path: path.to_owned(),
        source,
    };
    let target = followed(path).map_err(failed)?;
    let mut temporary = target.clone().into_os_string();
    temporary.push(format!(".{}.part", std::process::id()));
    let temporary = Path::new(&temporary);
    let written = inputs::check(&target)
        .and_then(|()| File::create(temporary))
        .and_then(|file| {
            let mut writer = BufWriter::new(file);
            write(&mut writer)?;
            writer
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?
                .sync_all()
        })
        .and_then(|()| fs::rename(temporary, &target));
    written.map_err(|source| {
        // Best effort: the cause of the failure matters more than the left-over file.
        let _ = fs::remove_file(temporary);
        failed(source)
    })
}

/// As [`write_uff58`], to any writer.
///
/// # Errors
/// Those of the writer.
pub fn write_uff58_to(set: &FrfSet, writer: &mut impl Write, description: &str) -> io::Result<()> {
    write_units(writer)?;
    let axis = even_axis(set.frequency_hz());
    for (response, reference, receptance) in set.functions() {
        writeln!(writer, "{:>6}\n{:>6}", -1, 58)?;
        let lines = receptance.len();
        write_header(writer, description, (response, reference), lines, axis)?;
        match axis {
            Some(_) => write_even(writer, receptance)?,
            None => write_uneven(writer, set.frequency_hz(), receptance)?,
        }
        writeln!(writer, "{:>6}", -1)?;
    }
    writer.flush()
}

/// As [`write_uff58b`], to any writer.
///
/// # Errors
/// Those of the writer.
pub fn write_uff58b_to(
    set: &FrfSet,
    writer: &mut impl Write,
    description: &str,
    order: ByteOrder,
) -> io::Result<()> {
    write_units(writer)?;
    let axis = even_axis(set.frequency_hz());
    for (response, reference, receptance) in set.functions() {
        let numbers_per_line = if axis.is_some() { 2 } else { 3 };
        let bytes = receptance.len() * numbers_per_line * size_of::<f64>();
        // I6,1A1,I6,I6,I12,I12,I6,I6,I12,I12: byte order, IEEE 754, text lines, bytes
        let order_code = match order {
            ByteOrder::Little => 1,
            ByteOrder::Big => 2,
        };
        writeln!(
            writer,
            "{:>6}\n{:>6}b{order_code:>6}{:>6}{RECORDS:>12}{bytes:>12}{:>6}{:>6}{:>12}{:>12}",
            -1, 58, 2, 0, 0, 0, 0
        )?;
        let lines = receptance.len();
        write_header(writer, description, (response, reference), lines, axis)?;
        let mut number = |number: f64| {
            writer.write_all(&match order {
                ByteOrder::Little => number.to_le_bytes(),
                ByteOrder::Big => number.to_be_bytes(),
            })
        };
        for (&hz, value) in set.frequency_hz().iter().zip(receptance) {
            if axis.is_none() {
                number(hz)?;
            }
            number(value.re)?;
            number(value.im)?;
        }
        writeln!(writer, "{:>6}", -1)?;
    }
    writer.flush()
}

/// The eleven records before the values.
fn write_header(
    writer: &mut impl Write,
    description: &str,
    (response, reference): (Dof, Dof),
    lines: usize,
    axis: Option<(f64, f64)>,
) -> io::Result<()> {
    writeln!(writer, "{}", id_line(description))?;
    for _ in 2..=5 {
        writeln!(writer, "NONE")?;
    }
    // 2(I5,I10),2(1X,10A1,I10,I4)
    write!(writer, "{:>5}{:>10}{:>5}{:>10}", 4, 0, 0, 0)?;
    for dof in [response, reference] {
        let (node, code) = (dof.node(), dof.uff_direction_code());
        write!(writer, " {:<10}{node:>10}{code:>4}", "NONE")?;
    }
    writeln!(writer)?;
    // 3I10,3E13.5
    let (minimum, increment) = axis.unwrap_or((0.0, 0.0));
    writeln!(
        writer,
        "{:>10}{lines:>10}{:>10}{}{}{}",
        6,
        u8::from(axis.is_some()),
        columns_13(minimum),
        columns_13(increment),
        columns_13(0.0)
    )?;
    write_axis(writer, 18, "Frequency", "Hz")?;
    let (motion, motion_unit) = motion(response);
    write_axis(writer, 8, motion, motion_unit)?;
    let (load, load_unit) = load(reference);
    write_axis(writer, 13, load, load_unit)?;
    write_axis(writer, 0, "NONE", "NONE")
}

fn write_units(writer: &mut impl Write) -> io::Result<()> {
    writeln!(writer, "{:>6}\n{:>6}", -1, 164)?;
    // I10,20A1,I10: SI, temperatures relative
    writeln!(writer, "{:>10}{:<20}{:>10}", 1, "SI: Meter (newton)", 2)?;
    // 3D25.17: length, force, temperature; temperature offset
    for factors in [[1.0, 1.0, 1.0].as_slice(), &[273.15]] {
        for factor in factors {
            write!(writer, "{:>25}", exponential(*factor, 17, 'D'))?;
        }
        writeln!(writer)?;
    }
    writeln!(writer, "{:>6}", -1)
}

/// I10,3I5,2(1X,20A1); the unit exponents follow from data type and direction and stay zero.
fn write_axis(writer: &mut impl Write, data_type: u8, label: &str, unit: &str) -> io::Result<()> {
    writeln!(
        writer,
        "{data_type:>10}{:>5}{:>5}{:>5} {label:<20} {unit:<20}",
        0, 0, 0
    )
}

fn motion(response: Dof) -> (&'static str, &'static str) {
    match response.direction() {
        Direction::Scalar => ("NONE", "NONE"),
        direction if direction.is_rotation() => ("Rotation", "rad"),
        _ => ("Displacement", "m"),
    }
}

fn load(reference: Dof) -> (&'static str, &'static str) {
    match reference.direction() {
        Direction::Scalar => ("NONE", "NONE"),
        direction if direction.is_rotation() => ("Moment", "N.m"),
        _ => ("Force", "N"),
    }
}

/// 4E20.12
fn write_even(writer: &mut impl Write, receptance: &[Complex64]) -> io::Result<()> {
    for two in receptance.chunks(2) {
        for value in two {
            write!(
                writer,
                "{:>20}{:>20}",
                exponential(value.re, 12, 'E'),
                exponential(value.im, 12, 'E')
            )?;
        }
        writeln!(writer)?;
    }
    Ok(())
}

/// E13.5,2E20.12
fn write_uneven(
    writer: &mut impl Write,
    frequency_hz: &[f64],
    receptance: &[Complex64],
) -> io::Result<()> {
    for (&hz, value) in frequency_hz.iter().zip(receptance) {
        writeln!(
            writer,
            "{}{:>20}{:>20}",
            columns_13(hz),
            exponential(value.re, 12, 'E'),
            exponential(value.im, 12, 'E')
        )?;
    }
    Ok(())
}

/// First frequency and increment, if these as printed reproduce every line.
fn even_axis(frequency_hz: &[f64]) -> Option<(f64, f64)> {
    let (first, last) = (*frequency_hz.first()?, *frequency_hz.last()?);
    let steps = (frequency_hz.len() - 1).max(1) as f64;
    let increment = match frequency_hz.len() {
        1 => 1.0,
        _ => (last - first) / steps,
    };
    let printed = |number| columns_13(number).trim().parse::<f64>().ok();
    let (first, increment) = (printed(first)?, printed(increment)?);
    frequency_hz
        .iter()
        .enumerate()
        .all(|(index, &hz)| (first + index as f64 * increment - hz).abs() <= EVEN_TOLERANCE * hz)
        .then_some((first, increment))
}

/// A number that is not negative in 13 columns, the first blank, with as many digits as fit.
///
/// Fortran's E13.5 reads any number with a point in its 13 columns, so more digits than it would print do no harm.
fn columns_13(number: f64) -> String {
    let plain = |digits: usize| format!("{number:.digits$}");
    let scientific = |digits: usize| exponential(number, digits, 'E');
    let fits = |text: &String| text.len() <= 12;
    let shortest = format!("{number:?}");
    let exact =
        Some(shortest).filter(|text| fits(text) && text.contains('.') && !text.contains('e'));
    let text = exact
        .or_else(|| {
            let digits = (1..=10).rev();
            let readable = (1e-2..1e9).contains(&number);
            digits.clone().map(plain).find(fits).filter(|_| readable)
        })
        .or_else(|| (0..=7).rev().map(scientific).find(fits))
        .unwrap_or_else(|| scientific(5));
    format!("{text:>13}")
}

/// Fortran's `E` or `D` form: one digit before the point, at least two in the exponent.
fn exponential(number: f64, digits: usize, letter: char) -> String {
    let text = format!("{number:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = match exponent.strip_prefix('-') {
        Some(exponent) => ('-', exponent),
        None => ('+', exponent),
    };
    format!("{mantissa}{letter}{sign}{exponent:0>2}")
}

/// A description as an ID line, which may be neither blank nor longer than 80 characters.
fn id_line(description: &str) -> String {
    let line: String = description
        .trim()
        .chars()
        .map(|c| match c {
            _ if c.is_whitespace() => ' ',
            ' '..='~' => c,
            _ => '?',
        })
        .take(ID_LINE)
        .collect();
    match line.is_empty() {
        true => "NONE".to_owned(),
        false => line,
    }
}
