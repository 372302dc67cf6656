//! Joint models that are too far from the data for a search of their own.

use nalgebra::DVector;

use super::estimator::{Estimate, minimum};
use super::layout::Layout;
use super::objective::Weights;
use super::robust::robust;
use super::torque::Problem;

/// An excess of −2 ln L that no other start makes up for, and no noise.
const HOPELESS: f64 = 1000.0;

impl Problem<'_> {
    /// By how much −2 ln L of another joint model is above that of an estimate, where that is too much for any search to make up
    /// for: told on few lines, with what the errors of measured substructures add to the variances at the estimate. `None`
    /// where it is not.
    pub(super) fn hopeless_excess(
        &self,
        own: &Layout,
        found: &Estimate,
        other: &Layout,
        start: &DVector<f64>,
    ) -> Option<f64> {
        let data = &self.data;
        let whole = data.thinned_whole.as_ref().unwrap_or(&data.thinned);
        if self.joints() > 1 {
            return None;
        }
        let cost = |layout: &Layout, weights: &[Weights], unknowns: DVector<f64>| {
            let entries = layout.places();
            let state = self
                .data
                .thinned
                .objective(&entries)
                .at(weights, unknowns, None)?;
            Some(state.normal.cost)
        };
        let weights = {
            let entries = own.places();
            let whole = whole.objective(&entries);
            whole.marginal_weights(found.levels, &found.unknowns)?
        };
        let entries = other.places();
        let exact = self.data.thinned.objective(&entries);
        let whole = whole.objective(&entries);
        let robust = robust(&exact, &whole, self.noise, start);
        let robust = robust.map_or_else(|| start.clone(), |robust| robust.unknowns);
        let other_unknowns = minimum(&exact, &weights, &robust)?.unknowns;
        let excess = 2.0
            * (cost(other, &weights, other_unknowns)?
                - cost(own, &weights, found.unknowns.clone())?);
        let numbers = 2.0 * exact.measurements() as f64;
        let of_all = found.measurements as f64 / exact.measurements() as f64;
        (excess > HOPELESS.max(numbers)).then_some(excess * of_all)
    }
}
