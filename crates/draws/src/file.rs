//! The file of a part of the draws: small, and in JSON with a draw on each line, so that people and scripts read it.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use serde::{Deserialize, Serialize};

use bolted_joint_files::text_file::{self, LONGEST_FILE};

use super::draw::Draw;
use super::error::{DrawsError, Numbers};
use super::origin::Origin;

/// The format's name and version.
pub const FORMAT: &str = "bolted-joint-draws/1";

/// What the name of every version begins with.
const FAMILY: &str = "bolted-joint-draws/";

/// Some of the draws, and what they were made from.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawsFile {
    /// What they were made from.
    pub origin: Origin,
    /// The number of the first.
    pub first: u64,
    /// Names of the results.
    pub results: Vec<String>,
    /// The draws, in their order.
    pub draws: Vec<Draw>,
}

/// The file as it is written.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    format: String,
    origin: Origin,
    first: u64,
    results: Vec<String>,
    draws: Vec<Draw>,
}

/// What tells the version of a file, whatever else is in it.
#[derive(Deserialize)]
struct Version {
    format: String,
}

impl DrawsFile {
    /// The numbers of its draws.
    #[must_use]
    pub fn numbers(&self) -> Range<u64> {
        self.first..self.first + self.draws.len() as u64
    }

    /// How many of its draws gave nothing.
    #[must_use]
    pub fn refused(&self) -> usize {
        let draws = self.draws.iter();
        draws.filter(|draw| draw.values().is_none()).count()
    }

    /// The text of the file.
    ///
    /// # Errors
    /// [`DrawsError::NotFinite`] for a number that JSON has no word for, [`DrawsError::TooLong`] for more than is read
    /// again.
    pub fn to_json(&self) -> Result<String, DrawsError> {
        for (number, draw) in self.numbers().zip(&self.draws) {
            let mut values = draw.values().unwrap_or_default().iter();
            if let Some(&value) = values.find(|value| !value.is_finite()) {
                return Err(DrawsError::NotFinite { number, value });
            }
        }
        let mut text = format!(
            "{{\n\"format\": \"{FORMAT}\",\n\"origin\": {},\n\"first\": {},\n\"results\": {},\n\"draws\": [",
            serde_json::to_string_pretty(&self.origin)?,
            self.first,
            serde_json::to_string(&self.results)?
        );
        for (place, draw) in self.draws.iter().enumerate() {
            let comma = if place == 0 { "" } else { "," };
            // writing to a String cannot fail
            let _ = write!(text, "{comma}\n{}", serde_json::to_string(draw)?);
        }
        text += "\n]\n}\n";
        let bytes = text.len() as u64;
        if bytes > LONGEST_FILE {
            return Err(DrawsError::TooLong {
                numbers: Numbers(self.numbers()),
                bytes,
                limit: LONGEST_FILE,
            });
        }
        Ok(text)
    }

    /// Reads a file of draws.
    ///
    /// # Errors
    /// [`DrawsError`] that names the file, and what in it cannot be used.
    pub fn read(path: &Path) -> Result<Self, DrawsError> {
        Self::of(&text_file::read(path, "a file of draws (JSON)")?, path)
    }

    fn of(text: &str, path: &Path) -> Result<Self, DrawsError> {
        let syntax = |error: serde_json::Error| DrawsError::Syntax {
            path: path.to_owned(),
            message: error.to_string(),
        };
        let Version { format } = serde_json::from_str(text).map_err(syntax)?;
        if !format.starts_with(FAMILY) {
            return Err(DrawsError::Syntax {
                path: path.to_owned(),
                message: format!("found format {format:?}"),
            });
        }
        if format != FORMAT {
            return Err(DrawsError::Format {
                path: path.to_owned(),
                found: format,
            });
        }
        let record: Record = serde_json::from_str(text).map_err(syntax)?;
        let all = record.origin.draws;
        let end = record.first.checked_add(record.draws.len() as u64);
        let damaged = |found: String, expected: String| DrawsError::Damaged {
            path: path.to_owned(),
            found,
            expected,
        };
        if end.is_none_or(|end| end > all) || record.draws.is_empty() {
            let found = format!(
                "{} draws from number {} on",
                record.draws.len(),
                record.first
            );
            return Err(damaged(found, format!("some of {}", Numbers(0..all))));
        }
        let count = record.results.len();
        for (number, draw) in (record.first..).zip(&record.draws) {
            if let Some(values) = draw.values()
                && values.len() != count
            {
                let found = format!("{} results of draw {number}", values.len());
                return Err(damaged(found, count.to_string()));
            }
        }
        Ok(Self {
            origin: record.origin,
            first: record.first,
            results: record.results,
            draws: record.draws,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn part(first: u64, draws: Vec<Draw>) -> DrawsFile {
        DrawsFile {
            origin: Origin {
                tool: "bolted-joint".to_owned(),
                version: "0.1.0".to_owned(),
                study: "a study".to_owned(),
                draws: 6,
                seed: 1,
                inputs: Vec::new(),
                joint_sha256: "0".repeat(64),
            },
            first,
            results: vec!["k_yy".to_owned(), "c_yy".to_owned()],
            draws,
        }
    }

    #[test]
    fn numbers_come_back_to_the_bit() {
        let least = f64::from_bits(1);
        let values = [0.1 + 0.2, -1e300 / 3.0, least, -0.0];
        let draws = vec![
            Draw::Values(values[..2].to_vec()),
            Draw::Refused("no contact".to_owned()),
            Draw::Values(values[2..].to_vec()),
        ];
        let file = part(2, draws);
        let read = DrawsFile::of(&file.to_json().unwrap(), Path::new("p")).unwrap();
        assert_eq!((read.numbers(), read.refused()), (2..5, 1));
        let bits = |file: &DrawsFile| -> Vec<u64> {
            let draws = file.draws.iter().filter_map(Draw::values);
            draws.flatten().map(|value| value.to_bits()).collect()
        };
        assert_eq!(bits(&read), values.map(f64::to_bits));
        assert_eq!(read, file);
    }

    #[test]
    fn what_is_no_file_of_draws_is_refused_with_its_name() {
        let good = part(0, vec![Draw::Values(vec![1.0, 2.0])]);
        let text = good.to_json().unwrap();
        let change = |from: &str, to: &str| {
            assert_eq!(text.matches(from).count(), 1, "{from}");
            text.replacen(from, to, 1)
        };
        for (text, said) in [
            ("[1]".to_owned(), "expected a file of draws"),
            (
                "{\"format\": \"bolted-joint/1\"}".to_owned(),
                "expected a file of draws",
            ),
            (
                change("draws/1", "draws/2"),
                "found format \"bolted-joint-draws/2\"",
            ),
            (
                change("[1.0,2.0]", "[1.0]"),
                "found 1 results of draw 0, expected 2",
            ),
            (change("\n[1.0,2.0]", ""), "found 0 draws from number 0 on"),
            (
                change("\"first\": 0", "\"first\": 6"),
                "expected some of 0..6",
            ),
            (
                change("\"first\": 0", "\"first\": 18446744073709551615"),
                "some of 0..6",
            ),
            (
                change("[1.0,2.0]", "[1.0,null]"),
                "did not match any variant",
            ),
            (change("\"seed\": 1", "\"sed\": 1"), "unknown field `sed`"),
            (text[..text.len() / 2].to_owned(), "EOF"),
        ] {
            let said_of = DrawsFile::of(&text, Path::new("p.json"))
                .unwrap_err()
                .to_string();
            assert!(
                said_of.starts_with("p.json: ") && said_of.contains(said),
                "{said_of}"
            );
        }
    }

    #[test]
    fn what_cannot_be_read_again_is_not_written() {
        let refused = part(3, vec![Draw::Values(vec![1.0, f64::NAN])]).to_json();
        assert_eq!(
            refused.unwrap_err().to_string(),
            "draw 3 gave NaN, expected finite numbers"
        );
    }
}
