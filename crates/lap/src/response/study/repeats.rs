//! Rows that stand in the data more than once: they would count as measurements of their own, and make intervals too narrow.

use std::collections::HashSet;
use std::path::Path;

use bolted_joint_study::{StudyError, StudyText};

use crate::response::backbone::{BackboneLine, BackboneRun};
use crate::response::data::{SineLine, SineRun, Use};

/// What was found, a sentence each.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::response) struct Repeats {
    pub(in crate::response) found: Vec<String>,
}

/// A run as it is compared with others.
struct Run<'r> {
    name: &'r str,
    path: &'r Path,
    used_for: Use,
    lines: Vec<[u64; 4]>,
}

impl Repeats {
    /// Rows of one table, which were taken away.
    pub(super) fn of_table(&mut self, run: String, repeated: usize) {
        if repeated > 0 {
            self.found.push(format!(
                "{run}: {repeated} row(s) equal an earlier one in all columns, and count once: a repeated row is no measurement of its own"
            ));
        }
    }

    /// Rows that several stepped sines have.
    pub(super) fn between_sines(
        &mut self,
        study: &StudyText,
        runs: &[SineRun],
    ) -> Result<(), StudyError> {
        let key = |line: &SineLine| {
            let numbers = [
                line.omega,
                line.force_n,
                line.displacement_m,
                line.phase_rad,
            ];
            numbers.map(f64::to_bits)
        };
        let runs = runs.iter().map(|run| Run {
            name: &run.name,
            path: &run.path,
            used_for: run.used_for,
            lines: run.lines.iter().map(key).collect(),
        });
        self.between(study, "sine.file", &runs.collect::<Vec<_>>())
    }

    /// Points that several backbones or decays have.
    pub(super) fn between_backbones(
        &mut self,
        study: &StudyText,
        runs: &[BackboneRun],
    ) -> Result<(), StudyError> {
        let key = |line: &BackboneLine| {
            let numbers = [
                line.amplitude_m,
                line.omega,
                line.damping_ratio.unwrap_or(f64::NAN),
                line.force_n.unwrap_or(f64::NAN),
            ];
            numbers.map(f64::to_bits)
        };
        let of = |is_decay: bool| {
            let runs = runs.iter();
            let runs = runs.filter(move |run| run.recorded.is_some() == is_decay);
            runs.map(|run| Run {
                name: &run.name,
                path: &run.path,
                used_for: run.used_for,
                lines: run.lines.iter().map(key).collect(),
            })
            .collect::<Vec<_>>()
        };
        self.between(study, "backbone.file", &of(false))?;
        self.between(study, "decay.file", &of(true))
    }

    fn between(
        &mut self,
        study: &StudyText,
        key: &str,
        runs: &[Run<'_>],
    ) -> Result<(), StudyError> {
        for (place, run) in runs.iter().enumerate() {
            let own: HashSet<&[u64; 4]> = run.lines.iter().collect();
            for earlier in &runs[..place] {
                let common = earlier
                    .lines
                    .iter()
                    .filter(|line| own.contains(line))
                    .count();
                let are_fitted = [run, earlier].map(|run| run.used_for == Use::Fit);
                let is_same = common == run.lines.len() && common == earlier.lines.len();
                if is_same && are_fitted == [true, true] {
                    let [first, second] = [earlier, run].map(|run| run.path.display());
                    let found = format!("\"{first}\" and \"{second}\" with the same rows");
                    study.refuse::<()>(
                        key,
                        found,
                        "every measurement once: it would count as two",
                    )?;
                }
                if common > 0 && are_fitted != [false, false] {
                    let why = match are_fitted {
                        [true, true] => "they count twice in the estimate",
                        _ => "what was fitted is no test of a prediction",
                    };
                    self.found.push(format!(
                        "{common} row(s) of {} stand in {}, too: {why}",
                        run.name, earlier.name
                    ));
                }
            }
        }
        Ok(())
    }
}
