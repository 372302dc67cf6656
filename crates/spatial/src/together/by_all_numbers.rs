//! Searches by way of a joint of all numbers.
//!
//! A joint of few numbers gives way to errors of the set-up in few directions, and a search may end where wrong errors make up for
//! a wrong joint. One of all numbers takes up most of what the errors leave. Beside errors that it leads to, the joint of few
//! numbers is found as if the set-up were known.

use super::{Searches, Start, Way, lags};
use crate::error::SpatialError;
use crate::fit::Fit;
use crate::richer::of_all_numbers;
use crate::starts::starts;

/// Searches for all numbers, and those of the model beside the errors of each.
const MOST: usize = 4;
const BESIDE_EACH: usize = 3;

/// Joints of all numbers that noise and budget explain, after which it is the model that explains nothing.
const REFUTED: usize = 2;

impl Searches<'_> {
    /// Follows these until there is no need of more; says whether that is so. No where the model has all numbers.
    ///
    /// # Errors
    /// [`SpatialError::NotOfModel`] where joints of all numbers explain the functions, and those beside their errors come nowhere near.
    pub(super) fn by_all_numbers(&mut self, likely: &[Vec<f64>; 2]) -> Result<bool, SpatialError> {
        let Some(all) = of_all_numbers(self.problem)? else {
            return Ok(false);
        };
        let of_all = Searches::new(&all, likely, self.level, self.is_stated)?;
        let alone = of_all.lowest_first(starts(&of_all.thin, self.level)?.all);
        let beside = of_all.beside(likely)?;
        let both = std::iter::zip(alone, beside).flat_map(|(alone, beside)| [alone, beside]);
        let mut explained = 0;
        for (residual, start) in both.take(MOST) {
            let fit = of_all.let_down(Way::Straight, residual, start);
            self.step.done();
            let Some(fit) = fit else {
                continue;
            };
            explained += usize::from(self.is_stated && of_all.explains(&fit));
            let own = self.beside(&all.errors(&fit.unknowns))?;
            let straight = |start: Start| (Way::Straight, start);
            if self.follow(own.into_iter().take(BESIDE_EACH).map(straight)) {
                return Ok(true);
            }
            let is_far = |best: &Fit| lags(&self.thin, best.cost);
            if explained >= REFUTED && self.best.as_ref().is_some_and(is_far) {
                return Err(SpatialError::NotOfModel { tried: self.tried });
            }
        }
        Ok(false)
    }
}
