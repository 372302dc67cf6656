//! A quick look at how well any joint fits: enough to tell data that belong together from such as do not.

use nalgebra::DVector;

use super::data::Data;
use super::estimator::{Free, estimate, first_levels};
use super::layout::Place;
use super::noise::Noise;
use super::robust::robust;

/// Starts of the grid that are tried where few others are.
const FEW_OF_GRID: usize = 16;

/// Where a quick look begins.
#[derive(Clone, Copy)]
pub(super) enum Beginning<'s> {
    /// At a joint, and at those that the data give.
    At(&'s DVector<f64>),
    /// At some of the grid.
    Grid,
}

/// The least mean square of what a joint leaves of few lines: beside the variances where the noise is stated, else beside the
/// receptances. The corrections follow the joint, but the joint does not follow them: that tells one that belongs to the data from
/// one that does not, soon.
pub(super) fn least_left(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    beginning: Beginning<'_>,
) -> Option<f64> {
    let thinned = data.thinned.objective(entries);
    let thinned = &thinned;
    let levels = first_levels(noise);
    let whole = data.thinned_whole.as_ref();
    let whole = whole.map(|whole| whole.objective(entries));
    let left = |start: &DVector<f64>| {
        let Some(whole) = &whole else {
            let found = estimate(thinned, noise, Some(levels), &Free, start, None)?;
            return Some(found.cost / found.measurements as f64);
        };
        let robust = robust(thinned, whole, noise, start)?;
        let used = data.few_near(entries, robust.place());
        let few = used.assemblies.objective(entries);
        let (_, state) = few.renewed(levels, robust.unknowns, None)?;
        // Lines that it cannot use count against it, since they say nothing for it.
        let unused = whole.measurements() as f64 / few.measurements() as f64;
        Some(state.normal.cost / few.measurements() as f64 * unused.powi(4))
    };
    let starts = match beginning {
        Beginning::At(start) => {
            let mut starts = data.thinned.linear_starts(entries, &[None]);
            starts.push(start.clone());
            starts
        }
        Beginning::Grid => {
            let mut grid = data.thinned.grid(entries);
            grid.truncate(FEW_OF_GRID);
            grid
        }
    };
    starts.iter().filter_map(left).min_by(f64::total_cmp)
}
