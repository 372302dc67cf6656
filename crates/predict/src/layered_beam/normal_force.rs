//! Normal force that one rivet or bolt puts on an interface of two layers, from the polynomial pressure around it.

use super::super::pressure::ThicknessRatio;

/// Thickness ratios of two layers at which the pressure is known.
const KNOWN: [(f64, ThicknessRatio); 3] = [
    (1.0, ThicknessRatio::One),
    (1.5, ThicknessRatio::OneAndAHalf),
    (2.0, ThicknessRatio::Two),
];

/// N/P: normal force on an interface over the fastener's tension, at a thickness ratio from 1 to 2; linear between 1, 1.5 and 2,
/// where the pressure is known. `None` beyond.
#[must_use]
pub fn normal_force_ratio(thickness_ratio: f64) -> Option<f64> {
    between(thickness_ratio, ThicknessRatio::normal_force_over_preload)
}

/// R_M/R_v, the radius of a rivet's zone of pressure over its own, in the same way.
#[must_use]
pub fn zone_radius_ratio(thickness_ratio: f64) -> Option<f64> {
    between(thickness_ratio, ThicknessRatio::rim_over_rivet_radius)
}

fn between(ratio: f64, at: impl Fn(ThicknessRatio) -> f64) -> Option<f64> {
    // thicknesses in decimals leave a rounding on either side
    let rounding = 1e-9;
    let [(low, _), .., (high, _)] = KNOWN;
    if !(ratio >= low - rounding && ratio <= high + rounding) {
        return None;
    }
    let after = KNOWN.partition_point(|(known, _)| *known <= ratio);
    let right = after.clamp(1, KNOWN.len() - 1);
    let ((a, below), (b, above)) = (KNOWN[right - 1], KNOWN[right]);
    let share = ((ratio - a) / (b - a)).clamp(0.0, 1.0);
    let (below, above) = (at(below), at(above));
    Some(below + share * (above - below))
}
