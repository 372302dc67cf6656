//! One row of numbers, made into values of functions.

use num_complex::Complex64;

use super::column::Form;
use super::number::parse_complex;
use crate::TableProblem;
use bolted_joint_files::Decimal;

/// The cells of a row, and how decimals are marked in the file so far.
pub(super) struct Row<'row> {
    pub(super) cells: &'row [&'row str],
    pub(super) decimal: &'row mut Decimal,
}

impl Row<'_> {
    /// The number in the cell at this place, counted from 0.
    pub(super) fn real(&mut self, place: usize) -> Result<f64, TableProblem> {
        let found = self.decimal.parse(self.cells[place]);
        let (number, used) = found.ok_or_else(|| self.no_number(place, "1.25e-3"))?;
        *self.decimal = used;
        Ok(number)
    }

    fn complex(&mut self, place: usize) -> Result<Complex64, TableProblem> {
        let found = parse_complex(*self.decimal, self.cells[place]);
        let (number, used) = found.ok_or_else(|| self.no_number(place, "1.2+3.4j"))?;
        *self.decimal = used;
        Ok(number)
    }

    /// A function's value in its own unit; zero where there is none.
    pub(super) fn value(&mut self, form: Form) -> Result<Complex64, TableProblem> {
        match form {
            Form::Cartesian { real, imaginary } => {
                Ok(Complex64::new(self.real(real)?, self.real(imaginary)?))
            }
            Form::Complex(place) => self.complex(place),
            Form::Polar {
                magnitude,
                phase,
                radians,
                zero_db,
            } => {
                let found = self.real(magnitude)?;
                let size = match zero_db {
                    // |H| = reference · 10^(L/20)
                    Some(reference) => reference * 10_f64.powf(found / 20.0),
                    None if found < 0.0 => {
                        return Err(TableProblem::at(
                            format_args!("column {}", magnitude + 1),
                            format_args!("magnitude {found}"),
                            "a number that is not negative; for decibels state the unit, such as [dB re 1 m/s^2/N]",
                        ));
                    }
                    None => found,
                };
                Ok(Complex64::from_polar(size, self.real(phase)? * radians))
            }
            Form::None => Ok(Complex64::default()),
        }
    }

    fn no_number(&self, place: usize, such: &str) -> TableProblem {
        let cell = self.cells[place];
        let more = match cell.contains(',') || *self.decimal == Decimal::Comma {
            true => {
                "; commas and points for decimals in one file are not read, nor are separators of thousands"
            }
            false => "",
        };
        TableProblem::at(
            format_args!("column {}", place + 1),
            format_args!("\"{}\"", crate::shown(cell)),
            format_args!("a number such as {such}{more}"),
        )
    }
}
