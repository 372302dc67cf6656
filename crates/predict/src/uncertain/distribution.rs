//! How an uncertain value is drawn: the distribution that suits the kind of quantity.

use super::value::Uncertain;

/// The distribution of an uncertain value, as a function of a standard normal score.
///
/// A score keeps the drawing of all inputs alike, and their correlation simple: correlated scores give correlated values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    nominal: f64,
    spread: Spread,
    location: f64,
    scale: f64,
}

/// The kind of distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Normal: quantities of either sign.
    Normal,
    /// Lognormal, of the same mean and standard deviation: quantities that cannot be negative, such as a preload or a modulus.
    Lognormal,
    /// Normal, and refused where it leaves the open interval in which the quantity has a meaning, such as a fractal dimension.
    NormalWithin {
        /// Lower bound, itself not admissible.
        low: f64,
        /// Upper bound, itself not admissible.
        high: f64,
    },
}

impl Distribution {
    /// Of a value that is known as a study gives it. A positive value is required for [`Spread::Lognormal`]; a value that is
    /// known exactly may be zero.
    #[must_use]
    pub fn new(spread: Spread, of: Uncertain) -> Self {
        if of.is_exact() && spread == Spread::Lognormal {
            // not through logarithm and exponential, which would change the last digit
            return Self::new(Spread::Normal, of);
        }
        let (location, scale) = match spread {
            Spread::Lognormal => {
                // σ_ln² = ln(1 + (s/m)²), μ_ln = ln m − σ_ln²/2: mean m, standard deviation s
                let variance = (of.standard_deviation / of.value).powi(2).ln_1p();
                (of.value.ln() - 0.5 * variance, variance.sqrt())
            }
            Spread::Normal | Spread::NormalWithin { .. } => (of.value, of.standard_deviation),
        };
        Self {
            nominal: of.value,
            spread,
            location,
            scale,
        }
    }

    /// The lognormal distribution of this median whose logarithm has this standard deviation.
    #[must_use]
    pub fn of_logarithm(median: f64, standard_deviation_of_logarithm: f64) -> Self {
        Self {
            nominal: median,
            spread: Spread::Lognormal,
            location: median.ln(),
            scale: standard_deviation_of_logarithm,
        }
    }

    /// The value itself, as it was given.
    #[must_use]
    pub fn nominal(&self) -> f64 {
        self.nominal
    }

    /// Standard deviation of the draws before any is refused.
    #[must_use]
    pub fn standard_deviation(&self) -> f64 {
        match self.spread {
            // s = e^(μ + σ²/2) √(e^(σ²) − 1)
            Spread::Lognormal => {
                let variance = self.scale * self.scale;
                (self.location + 0.5 * variance).exp() * variance.exp_m1().sqrt()
            }
            Spread::Normal | Spread::NormalWithin { .. } => self.scale,
        }
    }

    /// Whether every draw is the same.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.scale == 0.0
    }

    /// The value at a standard normal score; `None` where the quantity has no meaning there.
    #[must_use]
    pub fn at(&self, score: f64) -> Option<f64> {
        // x = μ + σ z, or e^(μ + σ z)
        let linear = self.location + self.scale * score;
        match self.spread {
            Spread::Normal => Some(linear),
            Spread::Lognormal => Some(linear.exp()),
            Spread::NormalWithin { low, high } => (linear > low && linear < high).then_some(linear),
        }
    }

    /// In words, for a report.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match (self.is_exact(), self.spread) {
            (true, _) => "exact",
            (_, Spread::Normal) => "normal",
            (_, Spread::Lognormal) => "lognormal",
            (_, Spread::NormalWithin { .. }) => "normal, truncated",
        }
    }
}
