//! Whether noise explains a joint at the lines of the estimate, too: a few lines may say nothing of it.

use super::Beside;
use super::search::{EXPLAINED, Given, estimated};
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::problem::Unknowns;
use crate::search::{BY_CHANCE, CLEARLY};

/// What a search came to at these lines.
pub(super) struct AtMore {
    pub(super) unknowns: Unknowns,
    /// χ² over numbers; of the assembly by itself where the functions may have other joints.
    pub(super) left: f64,
    pub(super) is_explained: bool,
    /// Likewise beyond doubt.
    pub(super) is_clear: bool,
}

impl AtMore {
    pub(super) fn of(
        given: &Given<'_>,
        unknowns: Unknowns,
        is_in_doubt: bool,
    ) -> Result<Self, SpatialError> {
        let &Given {
            problem,
            level,
            noise,
        } = given;
        let lines = estimated(problem, level, noise, &unknowns)?;
        let mut squares = Beside::of(&lines, level, noise, &unknowns)?;
        let effort = if is_in_doubt {
            Effort::Near
        } else {
            Effort::Coarse
        };
        let fit = Fit::by(&mut squares, unknowns, effort)?;
        let of_all = fit.cost / squares.numbers() as f64;
        let is_explained = of_all < EXPLAINED;
        if !is_in_doubt {
            return Ok(Self {
                unknowns: fit.unknowns,
                left: of_all,
                is_explained,
                is_clear: is_explained,
            });
        }
        let own = Beside::of(&lines, level, noise, &fit.unknowns)?;
        let left = own.left_in_assembly(&fit.unknowns, fit.cost)?;
        let free = lines.free_numbers() as f64;
        // χ² of ν numbers is ν ± √(2 ν)
        let beyond = (left - 1.0) / (2.0 / free).sqrt();
        Ok(Self {
            unknowns: fit.unknowns,
            left,
            is_explained: is_explained && beyond < BY_CHANCE,
            is_clear: is_explained && beyond < CLEARLY,
        })
    }
}
