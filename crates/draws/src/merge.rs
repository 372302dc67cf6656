//! Parts of the draws put together, if they are all of them, each once, and made from the same.

use std::path::{Path, PathBuf};

use bolted_joint_joint::InputFile;

use super::draw::Draw;
use super::error::{DrawsError, Numbers};
use super::file::DrawsFile;
use super::origin::{self, Origin};

/// All draws, and what they were made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// What they were made from.
    pub origin: Origin,
    /// Names of their results.
    pub results: Vec<String>,
    /// The draws in their order.
    pub draws: Vec<Draw>,
    /// One of their files.
    path: PathBuf,
}

impl Merged {
    /// Refuses draws that were made from something else than this.
    ///
    /// # Errors
    /// [`DrawsError::Other`] that says what differs.
    pub fn check(&self, origin: &Origin, results: &[String]) -> Result<(), DrawsError> {
        let reference = format!("the study {:?} has it", origin.study);
        self.origin.check(&self.path, origin, &reference)?;
        same_results(&self.path, &self.results, results, &reference)
    }

    /// Refuses draws that were made from another study than this, before anything is computed.
    ///
    /// # Errors
    /// [`DrawsError::Other`] with both hashes.
    pub fn check_study(&self, study: &InputFile) -> Result<(), DrawsError> {
        let mut own = self.origin.inputs.iter();
        match own.find(|file| file.role == study.role) {
            Some(own) if own.sha256 != study.sha256 => Err(DrawsError::Other {
                path: self.path.clone(),
                what: "the file".to_owned(),
                found: origin::named(own),
                expected: origin::named(study),
                reference: "it is now".to_owned(),
            }),
            _ => Ok(()),
        }
    }
}

fn same_results(
    path: &Path,
    found: &[String],
    expected: &[String],
    reference: &str,
) -> Result<(), DrawsError> {
    match found == expected {
        true => Ok(()),
        false => Err(DrawsError::Other {
            path: path.to_owned(),
            what: "the results".to_owned(),
            found: found.join(", "),
            expected: expected.join(", "),
            reference: reference.to_owned(),
        }),
    }
}

/// All draws in their order, from parts in any order.
///
/// # Errors
/// [`DrawsError`] that names the file which does not belong to the others, the draws that are in two, or those in none.
pub fn merged(mut parts: Vec<(PathBuf, DrawsFile)>) -> Result<Merged, DrawsError> {
    let Some((path, first)) = parts.first() else {
        return Err(DrawsError::Nothing);
    };
    let (path, origin, results) = (path.clone(), first.origin.clone(), first.results.clone());
    let reference = format!("{} has it", path.display());
    for (other, file) in &parts[1..] {
        file.origin.check(other, &origin, &reference)?;
        same_results(other, &file.results, &results, &reference)?;
    }
    parts.sort_by_key(|(_, file)| file.first);
    let (mut missing, mut reached) = (Vec::new(), 0);
    let mut before: Option<&PathBuf> = None;
    for (path, file) in &parts {
        let numbers = file.numbers();
        match before {
            Some(other) if numbers.start < reached => {
                return Err(DrawsError::Overlap {
                    path: path.clone(),
                    other: other.clone(),
                    numbers: Numbers(numbers.start..reached.min(numbers.end)),
                });
            }
            _ => {}
        }
        if numbers.start > reached {
            missing.push(Numbers(reached..numbers.start));
        }
        (reached, before) = (numbers.end, Some(path));
    }
    if reached < origin.draws {
        missing.push(Numbers(reached..origin.draws));
    }
    if !missing.is_empty() {
        return Err(DrawsError::Missing {
            missing,
            all: Numbers(0..origin.draws),
        });
    }
    Ok(Merged {
        origin,
        results,
        draws: parts.into_iter().flat_map(|(_, file)| file.draws).collect(),
        path,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin() -> Origin {
        Origin {
            tool: "bolted-joint".to_owned(),
            version: "0.1.0".to_owned(),
            study: "a study".to_owned(),
            draws: 6,
            seed: 1,
            inputs: vec![InputFile {
                role: "study".to_owned(),
                file: "study.toml".to_owned(),
                sha256: "0123456789abcdef".to_owned(),
            }],
            joint_sha256: "0".repeat(64),
        }
    }

    fn part(name: &str, first: u64, count: u64) -> (PathBuf, DrawsFile) {
        let draws = (first..first + count).map(|number| Draw::Values(vec![number as f64]));
        let file = DrawsFile {
            origin: origin(),
            first,
            results: vec!["k_yy".to_owned()],
            draws: draws.collect(),
        };
        (PathBuf::from(name), file)
    }

    fn together(parts: Vec<(PathBuf, DrawsFile)>) -> Result<Vec<Draw>, String> {
        let found = merged(parts).map_err(|error| error.to_string());
        found.map(|found| found.draws)
    }

    #[test]
    fn parts_in_any_order_are_all_draws_in_theirs() {
        let found = together(vec![part("c", 5, 1), part("a", 0, 2), part("b", 2, 3)]).unwrap();
        let expected: Vec<Draw> = (0..6)
            .map(|number| Draw::Values(vec![f64::from(number)]))
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn draws_in_two_files_or_in_none_are_named() {
        for (parts, said) in [
            (
                vec![part("a", 0, 4), part("b", 2, 4)],
                "b: found the draws 2..4, which a has as well",
            ),
            (
                vec![part("a", 0, 6), part("b", 2, 1)],
                "b: found the draws 2..3, which a has as well",
            ),
            (
                vec![part("a", 0, 6), part("a", 0, 6)],
                "a: found the draws 0..6, which a has as well",
            ),
            (
                vec![part("b", 1, 2), part("a", 4, 1)],
                "the draws 0..1, 3..4, 5..6, expected all of 0..6",
            ),
            (Vec::new(), "found no file of draws"),
        ] {
            let refused = together(parts).unwrap_err();
            assert!(refused.contains(said), "{refused}");
        }
    }

    #[test]
    fn what_differs_is_named() {
        type Change = fn(&mut DrawsFile);
        let rows: [(Change, &str); 7] = [
            (
                |file| file.origin.version = "0.2.0".to_owned(),
                "the program bolted-joint 0.2.0, expected bolted-joint 0.1.0",
            ),
            (|file| file.origin.inputs.clear(), "the study \"a study\""),
            (
                |file| file.origin.inputs[0].sha256 = "f".repeat(64),
                "the file study.toml (study, SHA-256 ffffffffffff), expected study.toml (study, SHA-256 0123456789ab)",
            ),
            (
                |file| file.origin.draws = 7,
                "the number of all draws 7, expected 6",
            ),
            (|file| file.origin.seed = 2, "the seed 2, expected 1"),
            (
                |file| file.origin.joint_sha256 = "1".repeat(64),
                "a joint whose numbers have the SHA-256 111111111111",
            ),
            (
                |file| file.results[0] = "c_yy".to_owned(),
                "the results c_yy, expected k_yy",
            ),
        ];
        for (change, said) in rows {
            let (path, mut file) = part("p.json", 3, 3);
            change(&mut file);
            let refused = together(vec![part("a.json", 0, 3), (path, file)]).unwrap_err();
            assert!(
                refused.starts_with("p.json: ") && refused.contains(said),
                "{refused}"
            );
        }
    }
}
