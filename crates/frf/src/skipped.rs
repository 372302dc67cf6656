//! What a universal file has beside frequency response functions, and how that is told.

use std::collections::BTreeMap;

use super::Dof;

/// A function of a file that is no frequency response function and was passed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SkippedFunction {
    /// The line at which its data set begins.
    pub line: usize,
    /// The standard's name of its function type, such as "auto spectrum".
    pub kind: &'static str,
    /// Response and reference, where its header can be read.
    pub between: Option<(Dof, Dof)>,
}

/// Data sets of one number that were passed over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SkippedDatasets {
    /// The number, such as `2411`.
    pub number: String,
    /// What such data sets hold, where that is known.
    pub holds: Option<&'static str>,
    /// How many there are.
    pub count: usize,
}

/// Responses that are named for each kind of function.
const NAMED: usize = 6;

/// A line for each kind of function and each number of data set.
pub(super) fn in_words(functions: &[SkippedFunction], datasets: &[SkippedDatasets]) -> Vec<String> {
    let mut kinds: BTreeMap<&str, Vec<&SkippedFunction>> = BTreeMap::new();
    for function in functions {
        kinds.entry(function.kind).or_default().push(function);
    }
    let functions = kinds.into_iter().map(|(kind, all)| {
        let count = all.len();
        format!("{count} × {kind} (data set 58){}", responses(&all))
    });
    let mut numbers: BTreeMap<(&str, Option<&str>), usize> = BTreeMap::new();
    for own in datasets {
        *numbers.entry((&own.number, own.holds)).or_default() += own.count;
    }
    let datasets = numbers.into_iter().map(|((number, holds), count)| {
        let holds = holds.map_or_else(String::new, |holds| format!(" ({holds})"));
        format!("{count} × data set {number}{holds}")
    });
    functions.chain(datasets).collect()
}

/// Where the functions of one kind were measured.
fn responses(functions: &[&SkippedFunction]) -> String {
    let mut all: Vec<Dof> = functions
        .iter()
        .filter_map(|own| own.between.map(|(response, _)| response))
        .collect();
    all.sort_unstable();
    all.dedup();
    let named: Vec<String> = all.iter().take(NAMED).map(Dof::to_string).collect();
    match (named.is_empty(), all.len().saturating_sub(NAMED)) {
        (true, _) => String::new(),
        (false, 0) => format!(" at {}", named.join(" ")),
        (false, more) => format!(" at {} and {more} more", named.join(" ")),
    }
}
