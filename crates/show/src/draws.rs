//! Draws of a bootstrap or a Monte Carlo simulation: which they are, and what they scatter by.

use std::path::Path;

use bolted_joint_draws::{Draw, DrawsFile, Numbers};
use serde_json::json;

use crate::shown::{short, some};
use crate::{FileKind, ShowError, Shown, command_for};

/// Results that are listed at most.
const LISTED: usize = 12;

pub(crate) fn shown(path: &Path) -> Result<Shown, ShowError> {
    let file = DrawsFile::read(path)?;
    let mut shown = Shown::of("draws, as `merge` takes them");
    let (origin, numbers) = (&file.origin, Numbers(file.numbers()));
    shown.fact("study", origin.study.clone());
    shown.fact(
        "draws",
        format!("{numbers} of {}, seed {}", origin.draws, origin.seed),
    );
    shown.fact("without", format!("{} have no result", file.refused()));
    shown.fact("made by", format!("{} {}", origin.tool, origin.version));
    let inputs: Vec<&str> = origin.inputs.iter().map(|own| own.file.as_str()).collect();
    shown.fact("from", some(&inputs, LISTED));
    let lines = file.results.iter().enumerate().map(|(place, name)| {
        let draws = file.draws.iter().filter_map(Draw::values);
        let values = draws.filter_map(|values| values.get(place).copied());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
            (low.min(own), high.max(own))
        });
        match low <= high {
            true => format!("{name} from {} to {}", short(low, 5), short(high, 5)),
            false => name.clone(),
        }
    });
    shown.facts_of_some("results", lines, LISTED);
    shown.detail("first", file.numbers().start);
    shown.detail("end", file.numbers().end);
    shown.detail("refused", file.refused());
    shown.detail("origin", json!(origin));
    shown.next = command_for(FileKind::Draws, path);
    Ok(shown)
}
