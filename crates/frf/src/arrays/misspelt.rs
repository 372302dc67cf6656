//! Arrays that may be there or not: one whose name is misspelt would be passed over, and the functions would be others without a word.
//!
//! Other arrays may have any name. So an array is taken to be misspelt only where it also holds what one of the right name would.

use bolted_joint_files::nearest;

use super::functions::{AVERAGES, AXES, COHERENCE, QUANTITY, UNITS, is_known};
use super::members::Members;
use super::{Array, ArrayFile, Kind};
use crate::TableProblem;

/// Names that are shorter resemble too much.
const SHORTEST: usize = 4;

impl<F: ArrayFile> Members<'_, F> {
    /// Refuses an array that seems to be one of those that may be left out, beside a matrix of so many elements.
    pub(super) fn refuse_misspelt(&mut self, elements: usize) -> Result<(), TableProblem> {
        let wanted: [(&[&str], Kind, Option<usize>); 5] = [
            (AXES, Kind::Text, Some(1)),
            (QUANTITY, Kind::Text, Some(1)),
            (UNITS, Kind::Text, None),
            (COHERENCE, Kind::Real, Some(elements)),
            (AVERAGES, Kind::Real, Some(1)),
        ];
        for (names, kind, count) in wanted {
            if self.find(names).is_ok_and(|found| found.is_some()) {
                continue;
            }
            for own in self.0.names().to_vec() {
                let meant = nearest(&own, names).filter(|_| own.chars().count() >= SHORTEST);
                let Some(meant) = meant.filter(|_| !is_known(&own)) else {
                    continue;
                };
                let holds_it = |array: F::Array<'_>| {
                    let length: usize = array.shape().iter().product();
                    array.kind() == kind && count.is_none_or(|count| count == length)
                };
                // what cannot be read is none of them
                if self.0.array(&own).is_ok_and(holds_it) {
                    return Err(TableProblem::at(
                        format_args!("array {}", crate::shown(&own)),
                        "a name that means nothing here",
                        format_args!(
                            "another one, did you mean `{meant}`? Rename the array, or leave it out if it is something else"
                        ),
                    ));
                }
            }
        }
        Ok(())
    }
}
