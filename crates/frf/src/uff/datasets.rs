//! From one data set of a universal file to the next, whatever is in them.

use std::io::BufRead;

use super::lines::Lines;
use super::{UffProblem, UnitSystem};
use crate::{FrfError, shown};

/// Records of data set 164 that are looked at.
const MOST_UNIT_RECORDS: usize = 8;

/// Where a data set begins, and what it is; the current line is the one with its number.
pub(super) struct Begun {
    /// The line of its opening `-1`.
    pub(super) at: usize,
    /// Its number in small letters, such as `58b`.
    pub(super) number: String,
}

/// Units of the first data set 164 of a file, and the line at which it begins.
pub(super) type Units = Option<(usize, UnitSystem)>;

impl<R: BufRead> Lines<R> {
    /// On to the next data set; nothing at the end of the file. `is_first` while none has been met.
    pub(super) fn next_dataset(&mut self, is_first: bool) -> Result<Option<Begun>, FrfError> {
        loop {
            if !self.advance()? {
                return Ok(None);
            }
            if self.is_delimiter() {
                break;
            }
            if !self.is_blank() {
                let found = shown(&self.text());
                return Err(self.problem(match is_first {
                    true => UffProblem::NotUniversalFile { found },
                    false => UffProblem::BetweenDatasets { found },
                }));
            }
        }
        let at = self.number();
        if !self.advance()? {
            return Err(self.ends_inside("without a number", at));
        }
        let text = self.text();
        let number = text.split_whitespace().next().unwrap_or_default();
        Ok(Some(Begun {
            at,
            number: number.to_lowercase(),
        }))
    }

    /// The error for a file that ends within a data set.
    pub(super) fn ends_inside(&self, dataset: &str, begun_at: usize) -> FrfError {
        let dataset = dataset.to_owned();
        self.problem(UffProblem::EndsInside { dataset, begun_at })
    }

    /// Passes over a data set of a kind that is not read, up to and with its closing `-1`.
    pub(super) fn pass_over(&mut self, begun: &Begun) -> Result<(), FrfError> {
        if is_binary(&begun.number) {
            if !self.skip_to_delimiter()? {
                return Err(self.ends_inside(&begun.number, begun.at));
            }
        } else if !begun.number.starts_with(|c: char| c.is_ascii_digit()) {
            let found = shown(&self.text());
            return Err(self.problem(UffProblem::DatasetNumber { found }));
        }
        self.skip_rest(&begun.number, begun.at)
    }

    /// Goes on to the closing `-1`.
    pub(super) fn skip_rest(&mut self, dataset: &str, begun_at: usize) -> Result<(), FrfError> {
        loop {
            if !self.advance()? {
                return Err(self.ends_inside(dataset, begun_at));
            }
            if self.is_delimiter() {
                return Ok(());
            }
        }
    }

    /// Reads a data set 164, which has to agree with the one before.
    pub(super) fn read_units(
        &mut self,
        known: &mut Units,
        begun_at: usize,
    ) -> Result<(), FrfError> {
        let mut records = Vec::new();
        loop {
            if !self.advance()? {
                return Err(self.ends_inside("164", begun_at));
            }
            if self.is_delimiter() {
                break;
            }
            // Two records are what the standard has; more than a few are not looked at, however long the data set is.
            if records.len() < MOST_UNIT_RECORDS {
                records.push(self.text().into_owned());
            }
        }
        if records.len() < 2 {
            return Err(self.problem(UffProblem::HeaderEnds {
                dataset: 164,
                begun_at,
                found: records.len(),
                expected: 2,
            }));
        }
        // The first record is two lines below the opening `-1`.
        let units = UnitSystem::from_records(&records)
            .map_err(|(index, problem)| self.problem_at(begun_at + 2 + index, problem))?;
        match *known {
            None => *known = Some((begun_at, units)),
            Some((_, first)) if first.agrees_with(units) => {}
            Some((first_line, _)) => {
                return Err(self.problem_at(begun_at, UffProblem::SecondUnits { first_line }));
            }
        }
        Ok(())
    }
}

/// Whether a data set's number is that of a binary one, such as `2414b`.
fn is_binary(number: &str) -> bool {
    number.strip_suffix('b').is_some_and(|digits| {
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    })
}
