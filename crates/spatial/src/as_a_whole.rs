//! Whether places that are off as a whole explain what sensors or hits of the assembly that are elsewhere were taken for.
//!
//! Few places leave both open: each hit of the assembly anew makes up for all places of a side that were measured from another
//! point, and the joint is another one. The likelihood tells them apart.

use crate::budget::{TYPICAL_WHOLE, beside_wholes};
use crate::error::SpatialError;
use crate::estimate::Found;
use crate::level::{first, of_residuals};
use crate::normal::{Deviations, cost, squares_of_errors};
use crate::prior::Common;
use crate::study::SpatialStudy;

impl SpatialStudy {
    /// Why the estimate that `with` is, of the study `anew`, is not the joint, if places as a whole explain the functions better.
    pub(crate) fn better_as_a_whole(
        &self,
        rms: &Deviations,
        anew: &Self,
        with: &Found,
    ) -> Option<String> {
        // beside noise of the parts both have lines of their own
        if self.problem.common.origin.is_some() || self.has_noise() {
            return None;
        }
        let whole = self.with_wholes()?;
        let begun = with.for_anew(&anew.problem, &whole.problem);
        let found = whole.found_from(rms, begun).ok()?;
        if !matches!(whole.is_explained(&found), Ok(true)) {
            return None;
        }
        let lines = with.estimated.frequency_hz.len();
        let of_anew = anew.badness(with, lines, rms).ok()?;
        let of_whole = whole.badness(&found, lines, rms).ok()?;
        (of_whole < of_anew).then(|| {
            format!(
                "places of a side that are off as a whole explain the functions better than sensors or hits of the assembly that are elsewhere \
                 (−2 ln L is lower by {:.0}), and make it another joint: state positions and directions of both sides from one point, in the \
                 same axes, or in budget.origin how well these are known",
                of_anew - of_whole
            )
        })
    }

    /// With places that may be off as a whole; `None` where nothing may be off.
    fn with_wholes(&self) -> Option<Self> {
        let mut own = self.clone();
        let tolerances = own.problem.tolerances.as_mut()?;
        for tolerance in [&mut tolerances.sensors, &mut tolerances.impacts] {
            *tolerance = beside_wholes(tolerance);
        }
        own.problem.common = Common {
            origin: Some(TYPICAL_WHOLE),
            ..own.problem.common
        };
        Some(own)
    }

    /// −2 ln L of what was found at so many lines, but for what is the same of all, with the errors of the set-up that it takes.
    pub(crate) fn badness(
        &self,
        found: &Found,
        lines: usize,
        rms: &Deviations,
    ) -> Result<f64, SpatialError> {
        let problem = self.problem.thinned(lines);
        let unknowns = &found.best.unknowns;
        if self.level.is_known() {
            return cost(&problem, unknowns, &first(&self.problem, self.level, rms));
        }
        let level = of_residuals(&problem, unknowns, rms)?;
        let of_functions: f64 = level.iter().map(|own| own.powi(2).ln()).sum();
        let lines = problem.frequency_hz.len() as f64;
        Ok(2.0 * lines * of_functions + squares_of_errors(&problem, unknowns))
    }
}
