//! Roots λ = βL of the frequency equations of uniform beams, to machine precision in every mode.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use bolted_joint_frf::structure::Boundary;

/// More iterations than Newton's method takes from any start.
const MOST_ITERATIONS: usize = 30;

/// Root λ of the frequency equation of elastic mode `mode`, counted from one; ω = (λ/L)² √(EI/ρA).
///
/// Free–free counts as fixed–fixed does, without the two rigid-body modes. Hyperbolic functions would overflow from the 226th
/// mode on; here each root is written as its asymptote and what is left, which tends to zero.
#[must_use]
pub fn root(boundary: Boundary, mode: usize) -> f64 {
    let n = mode as f64;
    // (−1)^(n+1)
    let sign = if mode.is_multiple_of(2) { -1.0 } else { 1.0 };
    match boundary {
        // cosh λ cos λ = 1 with λ = (n + ½)π + δ: sin δ = (−1)^(n+1) sech λ   (Kavi 3.15)
        Boundary::FixedFixed | Boundary::FreeFree => beside(n * PI + FRAC_PI_2, sign),
        // cosh λ cos λ = −1 with λ = (n − ½)π + δ: sin δ = (−1)^(n+1) sech λ
        Boundary::FixedFree | Boundary::FreeFixed => beside(n * PI - FRAC_PI_2, sign),
        // sin λ = 0   (Kavi 3.22n)
        Boundary::PinnedPinned => n * PI,
        // tan λ = tanh λ with λ = (n + ¼)π − δ: tan δ = e^(−2λ)   (Kavi 3.24d)
        Boundary::FixedPinned => {
            let asymptote = n * PI + FRAC_PI_4;
            let mut delta = 0.0_f64;
            for _ in 0..MOST_ITERATIONS {
                let next = (-2.0 * (asymptote - delta)).exp().atan();
                if next == delta {
                    break;
                }
                delta = next;
            }
            asymptote - delta
        }
    }
}

/// `asymptote` + δ where sin δ = `sign` sech(asymptote + δ), by Newton's method.
fn beside(asymptote: f64, sign: f64) -> f64 {
    let mut delta = 0.0_f64;
    for _ in 0..MOST_ITERATIONS {
        let lambda = asymptote + delta;
        // sech λ = 2 e^(−λ)/(1 + e^(−2λ)), which only underflows
        let decay = (-lambda).exp();
        let sech = sign * 2.0 * decay / (1.0 + decay * decay);
        let change = (delta.sin() - sech) / (delta.cos() + sech * lambda.tanh());
        let next = delta - change;
        if next == delta {
            break;
        }
        delta = next;
    }
    asymptote + delta
}
