//! Bands that a study names: one without a line has no part in its average, which nobody would notice.

use bolted_joint_study::StudyError;

use super::super::bands::{BandChoice, name};
use super::super::lines::Lines;
use super::super::study::Study;

/// Warnings of bands that hold no line of any assembly.
///
/// # Errors
/// Where none does.
pub(super) fn warnings(study: &Study, all: &[Lines]) -> Result<Vec<String>, StudyError> {
    let lines = || all.iter().flat_map(|lines| &lines.frequency_hz);
    let is_empty = |&&[from, to]: &&[f64; 2]| !lines().any(|hz| (from..=to).contains(hz));
    let first = lines().copied().fold(f64::INFINITY, f64::min);
    let last = lines().copied().fold(0.0, f64::max);
    let used = format!("the lines that are used go from {first} to {last} Hz");
    let mut warnings = Vec::new();
    let mut any_holds_lines = false;
    for &entry in study.model.entries() {
        let BandChoice::Given(bands) = study.bands.of_entry(entry) else {
            continue;
        };
        let empty: Vec<String> = bands
            .iter()
            .filter(is_empty)
            .map(|[from, to]| format!("[{from}, {to}]"))
            .collect();
        let has_none = empty.len() == bands.len();
        any_holds_lines |= !has_none;
        if !empty.is_empty() {
            let (key, list) = (name(entry), empty.join(", "));
            let so = if has_none {
                ", so that it has no average"
            } else {
                ""
            };
            warnings.push(format!(
                "`bands.{key}`: found no line in {list}: {used}{so}"
            ));
        }
    }
    if !warnings.is_empty() && !any_holds_lines {
        let expected = format!("bands with lines: {used}");
        let found = "no line in any band";
        return Err(StudyError::value(&study.path, "bands", found, expected));
    }
    Ok(warnings)
}
