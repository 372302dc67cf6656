//! Lobatto's five nodes of a step, and polynomials of time through values at them.
//!
//! Both ends are among the nodes, so that a step begins with the forces at which the one before ended. The integral of what is
//! interpolated is exact up to the seventh power of time.

/// Number of nodes, and of coefficients of the polynomials.
pub(super) const NODES: usize = 5;
/// √(3/7)
const INNER: f64 = 0.654_653_670_707_977_1;
/// θ of the nodes.
pub(super) const THETA: [f64; NODES] = [0.0, 0.5 - 0.5 * INNER, 0.5, 0.5 + 0.5 * INNER, 1.0];
/// Weights of the integral over θ.
pub(super) const WEIGHTS: [f64; NODES] = [
    1.0 / 20.0,
    49.0 / 180.0,
    16.0 / 45.0,
    49.0 / 180.0,
    1.0 / 20.0,
];

/// Legendre's polynomials P₀ to P₄ of 2θ − 1 at the nodes.
const LEGENDRE: [[f64; NODES]; NODES] = [
    [1.0; NODES],
    [-1.0, -INNER, 0.0, INNER, 1.0],
    [1.0, 1.0 / 7.0, -0.5, 1.0 / 7.0, 1.0],
    [-1.0, 3.0 / 7.0 * INNER, 0.0, -3.0 / 7.0 * INNER, 1.0],
    [1.0, -3.0 / 7.0, 0.375, -3.0 / 7.0, 1.0],
];
/// 1/Σ wⱼ Pₖ(θⱼ)²: 2k + 1, and for the last one, of which the square is beyond the rule, 4.
const INVERSE_NORMS: [f64; NODES] = [1.0, 3.0, 5.0, 7.0, 4.0];
/// Pₖ = Σ uₚₖ θᵖ/p!: row p, column k.
const POWERS_OF_LEGENDRE: [[f64; NODES]; NODES] = [
    [1.0, -1.0, 1.0, -1.0, 1.0],
    [0.0, 2.0, -6.0, 12.0, -20.0],
    [0.0, 0.0, 12.0, -60.0, 180.0],
    [0.0, 0.0, 0.0, 120.0, -840.0],
    [0.0, 0.0, 0.0, 0.0, 1680.0],
];

/// aₖ of Σ aₖ Pₖ(2θ − 1) through values at the nodes.
pub(super) fn legendre_coefficients(values: [f64; NODES]) -> [f64; NODES] {
    std::array::from_fn(|k| {
        let term = |j: usize| WEIGHTS[j] * LEGENDRE[k][j] * values[j];
        INVERSE_NORMS[k] * (0..NODES).map(term).sum::<f64>()
    })
}

/// w_p of Σ w_p θᵖ/p! = Σ aₖ Pₖ(2θ − 1).
pub(super) fn powers(coefficients: [f64; NODES]) -> [f64; NODES] {
    std::array::from_fn(|p| {
        let own = POWERS_OF_LEGENDRE[p].iter().zip(coefficients);
        own.map(|(own, a)| own * a).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(powers: [f64; NODES], theta: f64) -> f64 {
        // Σ w_p θᵖ/p!, Horner's way
        powers
            .iter()
            .enumerate()
            .rev()
            .fold(0.0, |sum, (p, own)| own + theta * sum / (p + 1) as f64)
    }

    #[test]
    fn the_polynomial_goes_through_its_values() {
        let values = [1.0, -2.0, 0.25, 7.0, -3.0];
        let powers = powers(legendre_coefficients(values));
        for (theta, value) in THETA.into_iter().zip(values) {
            assert!((at(powers, theta) - value).abs() < 1e-13, "{theta}");
        }
    }

    #[test]
    fn a_legendre_polynomial_has_its_own_coefficient_alone() {
        for k in 0..NODES {
            let found = legendre_coefficients(LEGENDRE[k]);
            for (other, found) in found.into_iter().enumerate() {
                let expected = if other == k { 1.0 } else { 0.0 };
                assert!((found - expected).abs() < 1e-14, "{k} {other}");
            }
        }
    }

    #[test]
    fn integrals_are_exact_up_to_the_seventh_power() {
        for power in 0..=8 {
            let term = |(theta, weight): (f64, f64)| weight * theta.powi(power);
            let found: f64 = THETA.into_iter().zip(WEIGHTS).map(term).sum();
            let error = found * f64::from(power + 1) - 1.0;
            assert_eq!(error.abs() < 1e-14, power <= 7, "{power} {error}");
        }
    }
}
