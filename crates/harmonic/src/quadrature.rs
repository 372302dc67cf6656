//! Integrals over an interval at whose ends a function may bend as a power does.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

/// Step of the rule and number of steps to each side. The error is below 1e-13 where the function is a power with an exponent
/// above 1 at the ends.
const STEP: f64 = 1.0 / 14.0;
const STEPS: i32 = 46;
/// Phase (rad) of the fastest wave in the function over the interval up to which the error of that step is below 1e-8.
const PHASE: f64 = 30.0;
/// The finest rule has 2¹⁵ times as many steps.
const RULES: usize = 16;

static NODES: [OnceLock<Vec<(f64, f64)>>; RULES] = [const { OnceLock::new() }; RULES];

/// Places in (0, 1) and weights of the double exponential rule for a function whose fastest wave goes through this phase (rad)
/// over the interval. The rule takes powers at both ends:
/// x = ½(1 + tanh(½π sinh t))   (Takahasi and Mori, Publ. RIMS 9 (1974) 721)
pub(super) fn nodes(phase: f64) -> &'static [(f64, f64)] {
    let mut finer = 0;
    while finer + 1 < RULES && phase > PHASE * f64::from(1_u32 << finer) {
        finer += 1;
    }
    NODES[finer].get_or_init(|| {
        let parts = 1 << finer;
        let node = |step: i32| {
            let step_length = STEP / f64::from(parts);
            let t = step_length * f64::from(step);
            let s = FRAC_PI_2 * t.sinh();
            // from the nearer end, without cancellation
            let from_end = 1.0 / (1.0 + (2.0 * s.abs()).exp());
            let place = if s < 0.0 { from_end } else { 1.0 - from_end };
            let weight = step_length * FRAC_PI_2 * t.cosh() / (2.0 * s.cosh() * s.cosh());
            (place, weight)
        };
        (-STEPS * parts..=STEPS * parts).map(node).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_of_any_phase_are_integrated() {
        for phase in [1.0, 20.0, 29.0, 31.0, 59.0, 150.0, 950.0, 6000.0] {
            let rule = nodes(phase).iter();
            // ∫ √x³ dx, and ∫ cos φx dx
            let [power, wave] = rule.fold([0.0; 2], |[power, wave], &(x, weight)| {
                [
                    power + weight * x.powf(1.5),
                    wave + weight * (phase * x).cos(),
                ]
            });
            assert!((power - 0.4).abs() < 1e-12, "{phase}: {power}");
            let expected = phase.sin() / phase;
            assert!((wave - expected).abs() < 1e-8, "{phase}: {wave} {expected}");
        }
    }
}
