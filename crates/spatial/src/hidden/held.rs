//! Whether noise explains a joint at the lines of the estimate, too: a few lines may say nothing of it.

use super::Beside;
use super::search::{EXPLAINED, Given, estimated};
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::problem::Unknowns;

impl Given<'_> {
    /// What these come to at those lines, if noise explains it.
    pub(super) fn held(&self, unknowns: Unknowns) -> Result<Option<Unknowns>, SpatialError> {
        let &Self {
            problem,
            level,
            noise,
        } = self;
        let lines = estimated(problem, level, noise, &unknowns)?;
        let mut squares = Beside::of(&lines, level, noise, &unknowns)?;
        let fit = Fit::by(&mut squares, unknowns, Effort::Coarse)?;
        let is_explained = fit.cost < EXPLAINED * squares.numbers() as f64;
        Ok(is_explained.then_some(fit.unknowns))
    }
}
