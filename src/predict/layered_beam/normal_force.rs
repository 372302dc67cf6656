//! Normal force that one rivet or bolt puts on an interface: the polynomial pressure of Minakuchi's measurements, integrated.

/// Thickness ratios of adjacent layers at which the pressure is known.
pub const THICKNESS_RATIOS: [f64; 3] = [1.0, 1.5, 2.0];

/// R_M/R_v, the radius of the pressure's zone over that of the rivet, at each of them.
const ZONE_RADIUS: [f64; 3] = [4.125, 5.0, 5.6];

/// A1 to A6 of p/σ_s = A1 ρ¹⁰ + A2 ρ⁸ + A3 ρ⁶ + A4 ρ⁴ + A5 ρ² + A6 with ρ = R/R_v (Kavi 3.32, Table 3.1). A2 of ratio 2 is
/// printed as 7.45e-04, with which the pressure at the rim of the zone is 713 σ_s instead of 0.
const COEFFICIENTS: [[f64; 6]; 3] = [
    [1.45e-6, -5.80e-5, 6.04e-4, 3.09e-3, -9.58e-2, 5.38e-1],
    [-1.74e-7, 1.40e-5, -4.59e-4, 8.17e-3, -8.77e-2, 4.88e-1],
    [-7.42e-8, 7.45e-6, -2.98e-4, 6.22e-3, -7.46e-2, 4.60e-1],
];

/// P/(σ_s π R_v²): the area under a rivet's head is π((1.75 R_v)² − R_v²).
const HEAD_AREA: f64 = 2.0625;

/// N/P: normal force on an interface over the fastener's tension, at a thickness ratio from 1 to 2; linear between the ratios
/// of [`THICKNESS_RATIOS`]. `None` beyond.
#[must_use]
pub fn normal_force_ratio(thickness_ratio: f64) -> Option<f64> {
    between(thickness_ratio, at_ratio)
}

/// R_M/R_v at a thickness ratio from 1 to 2, in the same way.
#[must_use]
pub fn zone_radius_ratio(thickness_ratio: f64) -> Option<f64> {
    between(thickness_ratio, |place| ZONE_RADIUS[place])
}

fn between(ratio: f64, at: impl Fn(usize) -> f64) -> Option<f64> {
    // thicknesses in decimals leave a rounding on either side
    let rounding = 1e-9;
    let [low, .., high] = THICKNESS_RATIOS;
    if !(ratio >= low - rounding && ratio <= high + rounding) {
        return None;
    }
    let after = THICKNESS_RATIOS.partition_point(|&known| known <= ratio);
    let right = after.clamp(1, THICKNESS_RATIOS.len() - 1);
    let (a, b) = (THICKNESS_RATIOS[right - 1], THICKNESS_RATIOS[right]);
    let share = ((ratio - a) / (b - a)).clamp(0.0, 1.0);
    Some(at(right - 1) + share * (at(right) - at(right - 1)))
}

/// N/P from the rivet's shank to the rim of the zone.
fn at_ratio(place: usize) -> f64 {
    // N = 2π ∫ p R dR:  N/P = (1/2.0625) Σ A_i (ρ_M^(n+2) − 1)/(n/2 + 1), n the power of A_i   (Kavi 3.34, both lines
    // multiplied by P/2.0625)
    let squared = ZONE_RADIUS[place].powi(2);
    let terms = COEFFICIENTS[place].iter().zip([6, 5, 4, 3, 2, 1]);
    let sum: f64 = terms
        .map(|(a, half)| a / f64::from(half) * (squared.powi(half) - 1.0))
        .sum();
    sum / HEAD_AREA
}
