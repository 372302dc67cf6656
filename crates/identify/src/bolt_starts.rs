//! Starts for bolts that differ: the joint that suits them all, and the same with one of them softer or stiffer.

use nalgebra::DVector;

use super::data::Data;
use super::layout::Layout;
use super::noise::Noise;
use super::search::{self, Effort};

/// Factors by which one of several bolts is softer or stiffer in a start than the joint that suits them all.
const UNLIKE: [f64; 2] = [0.2, 5.0];

/// `first` and, in a whole search for bolts that differ, the starts that an estimate with bolts that are alike gives.
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
    let given = given.into_iter().collect();
    let Ok(found) = search::best(data, &alike.places(), noise, given, Effort::Whole, None) else {
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
