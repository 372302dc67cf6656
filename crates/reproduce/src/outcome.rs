//! What a reproduction found: published and obtained values side by side, and why they differ.

use serde::Serialize;

use super::published::PublishedTable;

/// A published table computed anew.
#[derive(Clone, Debug, Serialize)]
pub struct Reproduction {
    /// Which one.
    pub table: PublishedTable,
    /// What it was computed with, where the source gives it.
    pub conditions: Vec<String>,
    /// The values.
    pub rows: Vec<Row>,
    /// Why obtained and published values differ.
    pub differences: Vec<String>,
    /// What the source does not give, and what was taken instead.
    pub not_given: Vec<String>,
}

/// One number of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Row of the table: an equation, an approach, a noise level.
    pub case: String,
    /// Name of the quantity, as in the FMU.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// What the data were made from.
    pub truth: Option<f64>,
    /// What the source prints.
    pub published: Option<f64>,
    /// What comes out here.
    pub obtained: Option<Spread>,
}

impl Row {
    /// A quantity that the source does not print.
    pub(super) fn computed(
        case: &str,
        quantity: &str,
        unit: &'static str,
        obtained: Option<Spread>,
    ) -> Self {
        Self {
            case: case.to_owned(),
            quantity: quantity.to_owned(),
            unit,
            truth: None,
            published: None,
            obtained,
        }
    }

    /// The resonances of an assembly, Hz, beside those that the source prints by their number from 1.
    pub(super) fn resonances(
        case: &str,
        published: &[(usize, f64)],
        found_hz: &[f64],
    ) -> Vec<Self> {
        let row = |(index, &hz): (usize, &f64)| {
            let number = index + 1;
            let published = published.iter().find(|(of, _)| *of == number);
            Self {
                published: published.map(|(_, hz)| *hz),
                ..Self::computed(case, &format!("f_{number}"), "Hz", Some(Spread::exact(hz)))
            }
        };
        found_hz.iter().enumerate().map(row).collect()
    }
}

/// Mean and spread over draws of the noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Mean over the draws.
    pub mean: f64,
    /// Standard deviation of one draw; zero if there is no noise.
    pub standard_deviation: f64,
    /// Median over the draws, which single far-off lines do not move.
    pub median: f64,
    /// Number of draws; one if there is no noise.
    pub draws: usize,
}

impl Spread {
    /// A value without noise.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self {
            mean: value,
            standard_deviation: 0.0,
            median: value,
            draws: 1,
        }
    }

    /// Of several draws; `None` without any.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 {
            sorted[middle]
        } else {
            0.5 * (sorted[middle - 1] + sorted[middle])
        };
        Some(Self {
            mean,
            standard_deviation: (squares / (count - 1.0).max(1.0)).sqrt(),
            median,
            draws: values.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_is_that_of_the_textbook() {
        let spread = Spread::of(&[1.0, 2.0, 4.0, 9.0]).unwrap();
        assert_eq!((spread.mean, spread.median, spread.draws), (4.0, 3.0, 4));
        // Σ(x − 4)² = 9 + 4 + 0 + 25 = 38, divided by 3.
        assert!((spread.standard_deviation - (38.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Spread::of(&[5.0]), Some(Spread::exact(5.0)));
    }
}
