//! Starts for bolts that differ: the joints that suit them all, and the best of them with one bolt softer or stiffer.

use nalgebra::DVector;

use super::data::Data;
use super::estimator::Estimate;
use super::layout::{Layout, Place};
use super::noise::Noise;
use super::parallel;
use super::search::{Effort, STARTS_AT_A_TIME};
use super::trials::{best_trials, rough, same};

/// Factors by which one of several bolts is softer or stiffer in a start than the joint that suits them all.
const UNLIKE: [f64; 2] = [0.2, 5.0];

/// Starts that agree on the joint that suits all bolts: more of them would not tell more.
const ENOUGH: usize = 4;

/// `first` and, in a whole search for bolts that differ, the starts that an estimate with bolts that are alike gives. Bolts that
/// are in truth alike have their global minimum there, and others beside it that may pass for noise.
pub(super) fn bolt_starts(
    data: &Data<'_>,
    layout: &Layout,
    noise: &Noise,
    mut first: Vec<DVector<f64>>,
    effort: Effort,
) -> Vec<DVector<f64>> {
    if layout.joints() == 1 || effort == Effort::Related {
        return first;
    }
    let alike = layout.with_bolts_alike();
    let given = first.first().and_then(|start| {
        let joints = layout.matrices(start.as_slice());
        alike.unknowns_of(&joints).map(DVector::from_vec)
    });
    let found = joints_for_all(data, &alike.places(), noise, given);
    let best = best_trials(&found).into_iter().filter_map(|one| {
        let joint = alike.matrices(one.unknowns.as_slice());
        layout.unknowns_of(&joint).map(DVector::from_vec)
    });
    let best: Vec<DVector<f64>> = best.collect();
    for joint in (0..layout.joints()).rev() {
        for factor in UNLIKE {
            first.extend(best.first().cloned().map(|mut start| {
                for index in layout.indices_of(joint) {
                    start[index] *= factor;
                }
                start
            }));
        }
    }
    first.extend(best.into_iter().rev());
    first
}

/// Where the starts of bolts that are alike lead on few lines, until enough of them agree.
fn joints_for_all(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    given: Option<DVector<f64>>,
) -> Vec<Estimate> {
    let guesses = [None, given.clone()];
    let mut starts: Vec<DVector<f64>> = given.into_iter().collect();
    starts.extend(data.thinned.linear_starts(entries, &guesses));
    starts.extend(data.thinned.grid(entries));
    let mut found: Vec<Estimate> = Vec::new();
    for part in starts.chunks(STARTS_AT_A_TIME) {
        let ends = parallel::map(part, |start| rough(data, entries, noise, start));
        found.extend(ends.into_iter().flatten());
        let best = best_trials(&found).first().copied();
        let agrees = |best: &Estimate| found.iter().filter(|one| same(one, best)).count();
        if best.is_some_and(|best| agrees(best) >= ENOUGH) {
            break;
        }
    }
    found
}
