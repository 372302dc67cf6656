//! Iwan's law in the closed loop of a sinusoidal motion, in closed form: what it adds to a dynamic stiffness, with derivatives.
//!
//! A search asks for it at every line of the data and in every step, so that a quadrature of the loop would be most of its work.

use std::f64::consts::PI;

use bolted_joint_statistics::gamma_ratio;
use num_complex::Complex64;

use super::{MOST, Slipping};

/// Terms of a series at most.
const TERMS: u32 = 2000;
/// Part of a sum below which a term is none.
const NONE: f64 = 1e-17;
/// The series about rest is taken where (p + ½) ln(1/x) is above this: beyond that point that about the corner is shorter, and
/// loses no digits.
const ABOUT_REST: f64 = 2.0;

/// Iwan's law with its numbers: the density R φ^χ of sliders up to φ_max, and S = β K_l there.
pub(super) struct ManySliders {
    /// K_A: stiffness that is lost at the reference A while nothing slips through, N/m.
    lost_n_per_m: f64,
    reference_m: f64,
    /// χ + 1.
    above: f64,
    /// φ_max/A and β, where everything can slip through.
    end: Option<[f64; 2]>,
    /// Γ(χ + 5/2)/Γ(χ + 3), and how its logarithm grows with χ.
    gamma: [f64; 2],
}

/// A number with its derivatives by χ, β and ln x of x = φ_max/U.
struct Changing {
    value: f64,
    by_exponent: f64,
    by_ratio: f64,
    by_log_part: f64,
}

impl ManySliders {
    /// From the logarithms that a search has for unknowns; the law of small motion has no end.
    pub(super) fn new(
        [first, second, third, fourth]: [f64; MOST],
        reference_m: f64,
        is_small: bool,
    ) -> Self {
        let above = second.exp();
        let [ratio, slope] = gamma_ratio(above + 1.5, above + 2.0);
        Self {
            lost_n_per_m: first.exp(),
            reference_m,
            above,
            end: (!is_small).then(|| [third.exp(), fourth.exp()]),
            gamma: [ratio, slope / ratio],
        }
    }

    /// z − K_T at an amplitude U > 0, m.
    pub(super) fn slipping(&self, amplitude_m: f64) -> Slipping {
        let relative = amplitude_m / self.reference_m;
        match self.end {
            Some([span, ratio]) if relative > span => self.beyond(span / relative, span, ratio),
            _ => self.before(relative),
        }
    }

    /// While nothing slips through; `relative` is U/A.
    fn before(&self, relative: f64) -> Slipping {
        let above = self.above;
        // K_l = K_A (U/A)^(χ+1)
        let lost = self.lost_n_per_m * relative.powf(above);
        // (4/√π) Γ(χ+5/2)/Γ(χ+4)
        let [gamma, growth] = self.gamma;
        let part = 4.0 / PI.sqrt() * gamma / (above + 2.0);
        let part_grows = growth - (above + 2.0).recip();
        // D/(πU²) = (4/π) K_l (χ+1)/((χ+2)(χ+3))
        let loss = 4.0 / PI * above / ((above + 1.0) * (above + 2.0));
        let loss_grows = above.recip() - (above + 1.0).recip() - (above + 2.0).recip();
        let value = lost * Complex64::new(-part, loss);
        // χ + 1 is an exponential of its unknown
        let by_second = above
            * (value * relative.ln()
                + lost * Complex64::new(-part * part_grows, loss * loss_grows));
        Slipping {
            value,
            by_log_amplitude: above * value,
            by_unknown: [value, by_second, Complex64::ZERO, Complex64::ZERO],
        }
    }

    /// Where everything slips through: x = φ_max/U < 1, with φ_max/A and β.
    fn beyond(&self, x: f64, span: f64, ratio: f64) -> Slipping {
        let above = self.above;
        // K_l = K_A (φ_max/A)^(χ+1)
        let lost = self.lost_n_per_m * span.powf(above);
        let real = self.stays(x, ratio);
        // D/(πU²K_l) = (4/π) [x ((χ+1)/(χ+2) + β) − x² ((χ+1)/(χ+3) + β)]
        let (one, two) = (above + 1.0, above + 2.0);
        let of_force = above / one + ratio;
        let of_square = above / two + ratio;
        let scale = 4.0 / PI * x;
        let imaginary = Changing {
            value: scale * (of_force - x * of_square),
            by_exponent: scale * ((one * one).recip() - 2.0 * x / (two * two)),
            by_ratio: scale * (1.0 - x),
            by_log_part: scale * (of_force - 2.0 * x * of_square),
        };
        let both =
            |part: fn(&Changing) -> f64| lost * Complex64::new(part(&real), part(&imaginary));
        let value = both(|own| own.value);
        let by_log_part = both(|own| own.by_log_part);
        Slipping {
            value,
            by_log_amplitude: -by_log_part,
            by_unknown: [
                value,
                above * (value * span.ln() + both(|own| own.by_exponent)),
                above * value + by_log_part,
                ratio * both(|own| own.by_ratio),
            ],
        }
    }

    /// (a₁/U − K_T)/K_l = −(4/π) [(1+β) G(1) − x^(−χ−1) G(χ+2)/(χ+2) − 2x √(x(1−x)) ((χ+1)/(χ+2) + β)] − (1+β)
    /// with G(q) = ∫₀ˣ t^(q−½) (1−t)^(−½) (1−2t) dt.
    fn stays(&self, x: f64, ratio: f64) -> Changing {
        let p = self.above + 1.0;
        let of_force = self.above / p + ratio;
        let root = (x * (1.0 - x)).sqrt();
        // G(1), from sin² for t
        let angle = x.sqrt().atan2((1.0 - x).sqrt());
        let first = 0.5 * (2.0 * angle).sin() - 0.5 * angle - 0.125 * (4.0 * angle).sin();
        // G(p) = x^(p+½) g,  g = (2 √(1−x) − p h)/(p+1),  h = x^(−p−½) ∫₀ˣ t^(p−½) (1−t)^(−½) dt
        let [h, h_by_p] = self.incomplete(x);
        let g = (2.0 * (1.0 - x).sqrt() - p * h) / (p + 1.0);
        let g_by_p = -(h + p * h_by_p + g) / (p + 1.0);
        let scale = x * x.sqrt() / p;
        let bracket = (1.0 + ratio) * first - scale * g - 2.0 * x * root * of_force;
        Changing {
            value: -4.0 / PI * bracket - (1.0 + ratio),
            by_exponent: 4.0 / PI * (scale * (g_by_p - g / p) + 2.0 * x * root / (p * p)),
            by_ratio: -4.0 / PI * (first - 2.0 * x * root) - 1.0,
            // what is under the integrals cancels, since the load has no jump at the corner
            by_log_part: -4.0 / PI * (self.above * scale * g - 2.0 * x * root * of_force),
        }
    }

    /// h = x^(−a) ∫₀ˣ t^(a−1) (1−t)^(−½) dt with a = χ + 5/2, and its derivative by a.
    fn incomplete(&self, x: f64) -> [f64; 2] {
        let a = self.above + 1.5;
        let log = x.ln();
        if -a * log > ABOUT_REST {
            // Σ (½)ₙ/n! xⁿ/(a + n)
            let (mut sums, mut power) = ([0.0; 2], 1.0);
            for n in 0..TERMS {
                let n = f64::from(n);
                let term = power / (a + n);
                sums = [sums[0] + term, sums[1] - term / (a + n)];
                if term < NONE * sums[0] {
                    break;
                }
                power *= x * (n + 0.5) / (n + 1.0);
            }
            return sums;
        }
        // x^(−a) B(a, ½) − 2 √y Σ (a+½)ₙ/(3/2)ₙ yⁿ,  y = 1 − x   (DLMF 8.17.4 and 8.17.8)
        let y = 1.0 - x;
        let [gamma, growth] = self.gamma;
        let whole = PI.sqrt() * gamma * (-a * log).exp();
        let (mut sums, mut term, mut change) = ([0.0; 2], 1.0, 0.0);
        for n in 1..=TERMS {
            sums = [sums[0] + term, sums[1] + change];
            if term <= NONE * sums[0] && change <= NONE * sums[1] {
                break;
            }
            let n = f64::from(n);
            let (factor, next) = (a - 0.5 + n, y / (n + 0.5));
            change = (change * factor + term) * next;
            term *= factor * next;
        }
        let [rest, rest_by_a] = sums.map(|sum| 2.0 * y.sqrt() * sum);
        [whole - rest, whole * (growth - log) - rest_by_a]
    }
}
