//! How far the largest contact outgrows the critical one under a pressure.

/// ∫ e^(st) dt from 0 to x = (e^(sx) − 1)/s, which is x for s = 0 and continuous there.
///
/// Every sum over elastic contacts is such an integral over the logarithm of their size; the exceptions that the formulas make for
/// D = 1.5 and D = 5/3 are its s = 0.
pub(super) fn power_integral(exponent: f64, x: f64) -> f64 {
    if exponent == 0.0 {
        x
    } else {
        (exponent * x).exp_m1() / exponent
    }
}

/// Newton's method ends once a step is this part of x; the error is then of the order of its square.
const SMALL_STEP: f64 = 1e-8;
const MOST_STEPS: usize = 60;

/// The equation between pressure and largest contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Growth {
    /// D/2
    half_dimension: f64,
    /// s = 3/2 − D
    exponent: f64,
    /// 2/(2 − D)
    plastic: f64,
}

impl Growth {
    pub(super) fn new(fractal_dimension: f64) -> Self {
        Self {
            half_dimension: 0.5 * fractal_dimension,
            exponent: 1.5 - fractal_dimension,
            plastic: 2.0 / (2.0 - fractal_dimension),
        }
    }

    /// Part of the load that elastic contacts carry.
    pub(super) fn elastic_share(&self, x: f64) -> f64 {
        let elastic = power_integral(self.exponent, x);
        elastic / (elastic + self.plastic)
    }

    /// x = ln(a'_L/a'_c) under a pressure that is e^L, L ≥ 0, times that of the first elastic contact.
    ///
    /// With b = 2/(2−D) and φ the integral above, (12) is p/p_c = e^(Dx/2) (φ(3/2 − D, x) + b)/b, or
    ///
    ///     h(x) = D x/2 + ln(1 + φ/b) − L = 0.
    ///
    /// h' = D/2 + ρ with ρ = e^(sx)/(φ + b), and ρ' = ρ(s − ρ) is negative, since ρ falls from 1 − D/2 at x = 0, which is more than s,
    /// without reaching s. So h is concave, with a slope from 1 at x = 0 down to no less than 3/4: h(L) ≤ 0, and Newton's
    /// method from x = L rises to the root without passing it.
    pub(super) fn solve(&self, load: f64) -> f64 {
        let mut x = load;
        for _ in 0..MOST_STEPS {
            let elastic = power_integral(self.exponent, x);
            let rest = self.half_dimension * x + (elastic / self.plastic).ln_1p() - load;
            // e^(sx) = 1 + s φ
            let slope =
                self.half_dimension + (1.0 + self.exponent * elastic) / (elastic + self.plastic);
            let step = -rest / slope;
            x += step;
            if step.abs() <= SMALL_STEP * x {
                break;
            }
        }
        x.max(0.0)
    }
}
