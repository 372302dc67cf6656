//! Bands that a study names: one without a line has no part in its average, which nobody would notice.

use bolted_joint_study::StudyError;

use super::super::bands::{BandChoice, name};
use super::super::lines::Lines;
use super::super::study::Study;

/// Warnings of bands that hold no line of any assembly.
///
/// # Errors
/// Where an entry has no other bands, and so no average.
pub(super) fn warnings(study: &Study, all: &[Lines]) -> Result<Vec<String>, StudyError> {
    let lines = || all.iter().flat_map(|lines| &lines.frequency_hz);
    let is_empty = |&&[from, to]: &&[f64; 2]| !lines().any(|hz| (from..=to).contains(hz));
    let first = lines().copied().fold(f64::INFINITY, f64::min);
    let last = lines().copied().fold(0.0, f64::max);
    let mut warnings = Vec::new();
    for &entry in study.model.entries() {
        let BandChoice::Given(bands) = study.bands.of_entry(entry) else {
            continue;
        };
        let empty: Vec<String> = bands
            .iter()
            .filter(is_empty)
            .map(|[from, to]| format!("[{from}, {to}]"))
            .collect();
        if empty.is_empty() {
            continue;
        }
        let key = format!("bands.{}", name(entry));
        let found = format!("no line in {}", empty.join(", "));
        let used = format!("the lines that are used go from {first} to {last} Hz");
        if empty.len() == bands.len() {
            let expected = format!("bands with lines: {used}");
            return Err(StudyError::value(&study.path, key, found, expected));
        }
        warnings.push(format!("`{key}`: found {found}: {used}"));
    }
    Ok(warnings)
}
