//! The domain extension factor, by which contacts are more than the islands of a cut through the surface.

/// Newton's method ends once a step is this small; the error is then of the order of its square.
const SMALL_STEP: f64 = 1e-9;
const MOST_STEPS: usize = 50;

/// Domain extension factor ψ of a profile of fractal dimension D, 1 < D < 2: from 2.618 at D = 1 to 1.718 at D = 2.
///
/// Zhao (3): ψ^((2−D)/2) − (1 + ψ^(−D/2))^(−(2−D)/D) = (2−D)/D. Of other D the result has no meaning.
#[must_use]
pub fn domain_extension_factor(fractal_dimension: f64) -> f64 {
    // ψ = e^(2w/D)
    (2.0 * exponent(fractal_dimension) / fractal_dimension).exp()
}

/// ψ^((2−D)/2), the factor of all sums over contacts.
pub(super) fn weight_of_contacts(fractal_dimension: f64) -> f64 {
    (ratio(fractal_dimension) * exponent(fractal_dimension)).exp()
}

/// σ = (2 − D)/D
fn ratio(fractal_dimension: f64) -> f64 {
    (2.0 - fractal_dimension) / fractal_dimension
}

/// w = (D/2) ln ψ, in which (3) reads e^(σw) − (1 + e^(−w))^(−σ) = σ.
fn exponent(fractal_dimension: f64) -> f64 {
    let sigma = ratio(fractal_dimension);
    // The root for σ → 0, where ln(1 + e^w) = 1; for σ = 1 it is the logarithm of the golden ratio, 0.48.
    let mut w = (1.0_f64.exp() - 1.0).ln();
    for _ in 0..MOST_STEPS {
        // Divided by σ, with the ones of both powers taken away: nothing cancels when D nears 2.
        let rest = ((sigma * w).exp_m1() - (-sigma * (-w).exp().ln_1p()).exp_m1()) / sigma - 1.0;
        let slope = (sigma * w).exp() * (1.0 - (1.0 + w.exp()).powf(-1.0 - sigma));
        let step = rest / slope;
        w -= step;
        if step.abs() < SMALL_STEP {
            break;
        }
    }
    w
}
