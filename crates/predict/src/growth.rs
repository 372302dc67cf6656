//! How far the largest contact outgrows the critical one under a load.

/// ∫ e^(st) dt from 0 to x = (e^(sx) − 1)/s, which is x for s = 0 and continuous there.
///
/// Every sum over elastic contacts is such an integral over the logarithm of their size; the exceptions that the formulas make for
/// D = 1.5 and D = 5/3 are its s = 0.
pub(crate) fn power_integral(exponent: f64, x: f64) -> f64 {
    if exponent == 0.0 {
        x
    } else {
        (exponent * x).exp_m1() / exponent
    }
}

/// Newton's method ends once a step is this part of x; the error is then of the order of its square.
const SMALL_STEP: f64 = 1e-8;
const MOST_STEPS: usize = 60;

/// The equation between load and largest contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Growth {
    /// D/2
    half_dimension: f64,
    /// s = 3/2 − D
    exponent: f64,
    /// κ
    elastic: f64,
}

impl Growth {
    /// Contacts of dimension D that carry, up to x = ln(a_L/a_c), the load e^(Dx/2) (1 + κφ(3/2 − D, x)) times that at x = 0, of which
    /// the 1 is what plastic contacts carry.
    ///
    /// κ must be more than 3/2 − D, as it is where (2 − D)/2 ≤ κ.
    pub(crate) fn new(fractal_dimension: f64, elastic: f64) -> Self {
        Self {
            half_dimension: 0.5 * fractal_dimension,
            exponent: 1.5 - fractal_dimension,
            elastic,
        }
    }

    /// Part of the load that elastic contacts carry.
    pub(crate) fn elastic_share(&self, x: f64) -> f64 {
        let elastic = self.elastic * power_integral(self.exponent, x);
        elastic / (1.0 + elastic)
    }

    /// Logarithm of the load over that at x = 0.
    pub(crate) fn log_load(&self, x: f64) -> f64 {
        self.half_dimension * x + (self.elastic * power_integral(self.exponent, x)).ln_1p()
    }

    /// The x at which the load is e^L times that at x = 0, L ≥ 0.
    ///
    /// To solve is h(x) = D x/2 + ln(1 + κφ) − L = 0. Its slope is h' = D/2 + ρ with ρ = κe^(sx)/(1 + κφ), s = 3/2 − D, and
    /// ρ' = ρ(s − ρ) is negative, since ρ falls from κ at x = 0, which is more than s, without reaching s. So h is concave and its slope
    /// falls from D/2 + κ to no less than 3/4: h is not positive at x = L/(D/2 + κ), and Newton's method rises from there to the root
    /// without passing it.
    pub(crate) fn solve(&self, log_load: f64) -> f64 {
        let mut x = log_load / (self.half_dimension + self.elastic);
        for _ in 0..MOST_STEPS {
            let integral = power_integral(self.exponent, x);
            let elastic = self.elastic * integral;
            let rest = self.half_dimension * x + elastic.ln_1p() - log_load;
            // e^(sx) = 1 + sφ
            let slope = self.half_dimension
                + self.elastic * (1.0 + self.exponent * integral) / (1.0 + elastic);
            let step = -rest / slope;
            x += step;
            if step.abs() <= SMALL_STEP * x {
                break;
            }
        }
        x.max(0.0)
    }
}
