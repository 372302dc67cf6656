//! Integrals over an interval at whose ends a function may bend as a power does.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Step of the rule and number of steps to each side. The error is below 1e-13 where the function is a power with an exponent
/// above 1 at the ends.
const STEP: f64 = 1.0 / 14.0;
const STEPS: i32 = 46;

/// Places in (0, 1) and weights of the double exponential rule, which takes powers at both ends:
/// x = ½(1 + tanh(½π sinh t))   (Takahasi and Mori, Publ. RIMS 9 (1974) 721)
pub(super) static NODES: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let node = |step: i32| {
        let t = STEP * f64::from(step);
        let s = FRAC_PI_2 * t.sinh();
        // from the nearer end, without cancellation
        let from_end = 1.0 / (1.0 + (2.0 * s.abs()).exp());
        let place = if s < 0.0 { from_end } else { 1.0 - from_end };
        let weight = STEP * FRAC_PI_2 * t.cosh() / (2.0 * s.cosh() * s.cosh());
        (place, weight)
    };
    (-STEPS..=STEPS).map(node).collect()
});
