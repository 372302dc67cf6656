//! What the caller knows better than a file of functions, and how much of the file is wanted.

use super::summary::StatedBy;
use super::{Quantity, Selection, UnitSystem};

/// How to read a file of functions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Takes the place of data types and labels: needed where they contradict each other or say nothing.
    pub quantity: Option<Quantity>,
    /// Takes the place of data set 164 and unit labels: needed where they contradict each other or are wrong.
    pub units: Option<UnitSystem>,
    /// Averages behind every function, where the file does not state them.
    pub averages: Option<f64>,
    /// Functions and lines to keep.
    pub selection: Selection,
}

impl ReadOptions {
    /// Averages by the caller's word, else by the file's.
    pub(super) fn averages_or(&self, of_file: Option<f64>) -> Option<(f64, StatedBy)> {
        let stated = self.averages.map(|averages| (averages, StatedBy::Caller));
        stated.or(of_file.map(|averages| (averages, StatedBy::File)))
    }
}
