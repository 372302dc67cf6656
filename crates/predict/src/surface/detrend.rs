//! The form of a part under the roughness of its surface: a mean height, a slope, a curvature, taken off by least squares.

/// What is taken off heights before their spectrum is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detrend {
    /// Nothing.
    Nothing,
    /// The mean.
    Mean,
    /// A straight line.
    Line,
    /// A parabola.
    Parabola,
}

impl Detrend {
    fn terms(self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::Mean => 1,
            Self::Line => 2,
            Self::Parabola => 3,
        }
    }

    /// Takes it off evenly spaced values.
    #[must_use]
    pub fn apply(self, values: &[f64]) -> Vec<f64> {
        let mut rest = values.to_vec();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let middle = 0.5 * (values.len().saturating_sub(1)) as f64;
        for power in 0..self.terms() {
            // Powers of the distance from the middle, made orthogonal to the lower ones (Gram and Schmidt).
            let mut column: Vec<f64> = (0..values.len())
                .map(|point| {
                    let part = (point as f64 - middle) / middle.max(1.0);
                    (0..power).fold(1.0, |product, _| product * part)
                })
                .collect();
            for lower in &basis {
                remove(&mut column, lower);
            }
            remove(&mut rest, &column);
            basis.push(column);
        }
        rest
    }
}

/// Takes the part along `direction` off `values`.
fn remove(values: &mut [f64], direction: &[f64]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let square = dot(direction, direction);
    if square > 0.0 {
        let factor = dot(values, direction) / square;
        for (value, part) in values.iter_mut().zip(direction) {
            *value -= factor * part;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_takes_off_what_it_says() {
        let parabola: Vec<f64> = (0..50)
            .map(f64::from)
            .map(|k| 3.0 - 0.2 * k + 0.01 * k * k)
            .collect();
        let largest = |rest: Vec<f64>| rest.into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert_eq!(Detrend::Nothing.apply(&parabola), parabola);
        assert!(largest(Detrend::Parabola.apply(&parabola)) < 1e-12);
        let line = Detrend::Line.apply(&parabola);
        // Least squares leaves 0.01 (t² − (n² − 1)/12) with t counted from the middle.
        for (k, rest) in line.iter().enumerate() {
            let t = k as f64 - 24.5;
            assert!((rest - 0.01 * (t * t - 2499.0 / 12.0)).abs() < 1e-12);
        }
        assert!(Detrend::Mean.apply(&parabola).iter().sum::<f64>().abs() < 1e-10);
    }
}
