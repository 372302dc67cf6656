//! Shapes that a beam bends in where nothing acts on it but its own inertia: w⁗ = κ⁴ w, κ⁴ = ω² ρA/EI.
//!
//! C₀ to C₃ are Krylov's functions, C_n(x) = Σ κ^(4m) x^(4m+n)/(4m+n)! over m ≥ 0: xⁿ/n! where nothing moves, and
//! C′_n = C_(n−1), C′₀ = κ⁴ C₃. Those beyond C₃ answer loads along the beam that grow with a power of x.

/// Terms of a series: of κ|x| up to [`REACH`], the next one is below the rounding of the sum.
const TERMS: usize = 8;
/// κ times a length beyond which shapes between its ends are no guide: at 4.73 a beam that is held at both ends resonates.
const REACH: f64 = 3.0;

/// C_n(x) with κ⁴.
pub(crate) fn shape(n: usize, x: f64, fourth_power: f64) -> f64 {
    let mut term = (1..=n).fold(1.0, |term, i| term * x / i as f64);
    let mut sum = term;
    for m in 0..TERMS {
        let first = 4 * m + n;
        let product = ((first + 1) * (first + 2) * (first + 3) * (first + 4)) as f64;
        term *= fourth_power * x * x * x * x / product;
        sum += term;
    }
    sum
}

/// C′_n(x) with κ⁴.
pub(crate) fn slope_of_shape(n: usize, x: f64, fourth_power: f64) -> f64 {
    match n.checked_sub(1) {
        Some(before) => shape(before, x, fourth_power),
        None => fourth_power * shape(3, x, fourth_power),
    }
}

/// How a beam's inertia bends it at one frequency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waves {
    /// κ⁴, 1/m⁴
    fourth_power: f64,
}

impl Waves {
    /// Of a beam with ρA/EI (s²/m⁴) at an angular frequency, rad/s.
    pub(crate) const fn new(inertia: f64, omega: f64) -> Self {
        Self {
            fourth_power: inertia * omega * omega,
        }
    }

    /// κ⁴, 1/m⁴
    pub(crate) fn anywhere(self) -> f64 {
        self.fourth_power
    }

    /// κ⁴, 1/m⁴, as far as shapes over this length are a guide.
    pub(crate) fn over(self, length_m: f64) -> f64 {
        self.fourth_power.min((REACH / length_m).powi(4))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_krylov_s_functions() {
        let kappa: f64 = 5.0;
        let fourth = kappa.powi(4);
        for x in [-0.6_f64, -0.1, 0.0, 0.3, 0.6] {
            let (c, s) = ((kappa * x).cos(), (kappa * x).sin());
            let (ch, sh) = ((kappa * x).cosh(), (kappa * x).sinh());
            let exact = [
                (ch + c) / 2.0,
                (sh + s) / (2.0 * kappa),
                (ch - c) / (2.0 * kappa * kappa),
                (sh - s) / (2.0 * kappa.powi(3)),
                (ch + c - 2.0) / (2.0 * fourth),
            ];
            for (n, exact) in exact.into_iter().enumerate() {
                let found = shape(n, x, fourth);
                assert!(
                    (found - exact).abs() < 1e-12,
                    "C_{n}({x}): {found}, not {exact}"
                );
                let by = 1e-6;
                let slope = (shape(n, x + by, fourth) - shape(n, x - by, fourth)) / (2.0 * by);
                assert!((slope_of_shape(n, x, fourth) - slope).abs() < 1e-6 * (1.0 + slope.abs()));
            }
        }
    }

    #[test]
    fn at_rest_they_are_powers() {
        assert_eq!(shape(3, 2.0, 0.0), 8.0 / 6.0);
        assert_eq!(slope_of_shape(5, 2.0, 0.0), 16.0 / 24.0);
        assert_eq!(slope_of_shape(0, 2.0, 0.0), 0.0);
    }
}
