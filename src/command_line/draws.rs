//! Draws in parts: `--draws 0..1000` writes some of them, `merge` puts them together.

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::json;

use bolted_joint::draws::{Draw, DrawsFile, Merged, Numbers, Origin, merged};

use super::error::CliError;
use super::output::{Wrote, print, write_file};

/// What `--draws` takes.
pub(super) fn numbers(text: &str) -> Result<Range<u64>, String> {
    let expected = "expected two numbers, such as 0..1000 for the first thousand draws";
    let (first, end) = text.split_once("..").ok_or(expected)?;
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| expected);
    let (first, end) = (number(first)?, number(end)?);
    match first < end {
        true => Ok(first..end),
        false => Err(format!(
            "found no draw between {first} and {end}, {expected}"
        )),
    }
}

/// Refuses draws that are not among `all`; `expected` says where their number is from.
pub(super) fn among(
    numbers: &Range<u64>,
    all: u64,
    expected: &'static str,
) -> Result<(), CliError> {
    match numbers.end <= all {
        true => Ok(()),
        false => {
            let found = format!("{} of {all}", Numbers(numbers.clone()));
            Err(CliError::option("--draws", found, expected))
        }
    }
}

/// Refuses outputs that a part of the draws does not have.
pub(super) fn alone(asked: &[(&'static str, bool)]) -> Result<(), CliError> {
    let mut asked = asked.iter();
    match asked.find(|(_, is_asked)| *is_asked) {
        Some((option, _)) => {
            let expected = "none beside --draws: `merge` has all draws";
            Err(CliError::option(option, "it", expected))
        }
        None => Ok(()),
    }
}

/// Writes a part of the draws and says so.
pub(super) fn write_part(
    output: &Path,
    origin: Origin,
    results: Vec<String>,
    first: u64,
    draws: Vec<Draw>,
    as_json: bool,
) -> Result<(), CliError> {
    let file = DrawsFile {
        origin,
        first,
        results,
        draws,
    };
    write_file(output, file.to_json()?.as_bytes())?;
    let numbers = file.numbers();
    if as_json {
        let value = json!({
            "output": output.display().to_string(),
            "first": numbers.start,
            "end": numbers.end,
            "refused": file.refused(),
            "draws": file.origin.draws,
            "seed": file.origin.seed,
        });
        return print(&serde_json::to_string_pretty(&value)?);
    }
    print(&format!(
        "{}\ndraws {} of {}, seed {}, {} of them without a result\n\n{}\n",
        file.origin.study,
        Numbers(numbers),
        file.origin.draws,
        file.origin.seed,
        file.refused(),
        Wrote(output)
    ))
}

/// Reads parts of the draws and puts them together.
pub(super) fn read_parts(paths: &[PathBuf]) -> Result<Merged, CliError> {
    let files = paths
        .iter()
        .map(|path| Ok((path.clone(), DrawsFile::read(path)?)));
    Ok(merged(files.collect::<Result<_, CliError>>()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_a_range() {
        assert_eq!(numbers("1000..2000"), Ok(1000..2000));
        for text in ["", "1000", "2..2", "3..2", "-1..2", "0..x", "0..=3"] {
            assert!(
                numbers(text).unwrap_err().contains("such as 0..1000"),
                "{text}"
            );
        }
    }
}
