//! Starts for bolts with joints of their own: from the one joint that suits them all.

use nalgebra::DVector;

use super::layout::Layout;
use super::lines_estimate::Options;
use super::search::{self, Data, Effort};

/// Factors by which one of several bolts is softer or stiffer in a start than the joint that suits them all.
const UNLIKE: [f64; 2] = [0.2, 5.0];

/// The starts that `first` and the bolts give: for bolts that differ, the estimate in which they are alike, and that with
/// one of them softer or stiffer.
pub(super) fn bolt_starts<const N: usize>(
    data: &Data<N>,
    layout: &Layout,
    options: &Options<'_>,
    mut first: Vec<DVector<f64>>,
) -> Vec<DVector<f64>> {
    if layout.joints() == 1 {
        return first;
    }
    let alike = layout.with_bolts_alike();
    let given = options.start.as_ref().map(std::slice::from_ref);
    let given = given
        .and_then(|start| alike.unknowns_of(start))
        .map(DVector::from_vec);
    let given: Vec<DVector<f64>> = given.into_iter().collect();
    let (places, noise) = (alike.places(), &options.noise);
    // Its own starts only: where they lead nowhere, the search proper has a grid.
    let Ok(found) = search::best(data, &places, noise, given, Effort::Related) else {
        return first;
    };
    let joint = alike.matrices(found.estimate.unknowns.as_slice());
    let Some(start) = layout.unknowns_of(&joint).map(DVector::from_vec) else {
        return first;
    };
    for joint in 0..layout.joints() {
        for factor in UNLIKE {
            let mut start = start.clone();
            for index in layout.indices_of(joint) {
                start[index] *= factor;
            }
            first.push(start);
        }
    }
    first.push(start);
    first
}
