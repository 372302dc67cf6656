//! Means, variances and covariances of vectors as they come, without keeping them.

/// Running means and co-moments (Welford 1962, in the form for vectors): as exact as two passes, in one.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    count: f64,
    mean: Vec<f64>,
    /// Σ (x_i − x̄_i)(x_j − x̄_j), row by row.
    co_moments: Vec<f64>,
    /// Work space.
    before: Vec<f64>,
}

impl Moments {
    /// Of vectors of so many entries.
    pub(super) fn new(size: usize) -> Self {
        Self {
            count: 0.0,
            mean: vec![0.0; size],
            co_moments: vec![0.0; size * size],
            before: vec![0.0; size],
        }
    }

    /// One more vector.
    pub(super) fn add(&mut self, vector: &[f64]) {
        self.count += 1.0;
        let size = self.mean.len();
        for (place, (mean, value)) in self.mean.iter_mut().zip(vector).enumerate() {
            // x̄ₙ = x̄ₙ₋₁ + (x − x̄ₙ₋₁)/n
            let difference = value - *mean;
            self.before[place] = difference;
            *mean += difference / self.count;
        }
        for i in 0..size {
            // Mₙ = Mₙ₋₁ + (x_i − x̄ᵢ,ₙ₋₁)(x_j − x̄ⱼ,ₙ)
            let after = vector[i] - self.mean[i];
            for j in 0..=i {
                self.co_moments[i * size + j] += self.before[j] * after;
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    pub(super) fn mean(&self, i: usize) -> f64 {
        self.mean[i]
    }

    /// Standard deviation of entry `i`.
    pub(super) fn standard_deviation(&self, i: usize) -> f64 {
        (self.co_moment(i, i) / (self.count - 1.0).max(1.0)).sqrt()
    }

    /// Correlation of entries `i` and `j`; zero where one of them does not vary.
    pub(super) fn correlation(&self, i: usize, j: usize) -> f64 {
        if i == j {
            return 1.0;
        }
        let scale = (self.co_moment(i, i) * self.co_moment(j, j)).sqrt();
        match scale > 0.0 {
            true => (self.co_moment(i, j) / scale).clamp(-1.0, 1.0),
            false => 0.0,
        }
    }

    fn co_moment(&self, i: usize, j: usize) -> f64 {
        self.co_moments[i.max(j) * self.mean.len() + i.min(j)]
    }
}

#[cfg(test)]
mod tests {
    use super::Moments;

    #[test]
    fn they_are_those_of_two_passes() {
        // far from zero, where sums of squares would lose every digit
        let vectors: Vec<[f64; 2]> = (0..1000)
            .map(|k| {
                let t = f64::from(k);
                [1e6 + (0.37 * t).sin(), 1e6 - 2.0 * (0.37 * t + 0.4).sin()]
            })
            .collect();
        let mut moments = Moments::new(2);
        vectors.iter().for_each(|vector| moments.add(vector));
        let n = vectors.len() as f64;
        let mean = |i: usize| vectors.iter().map(|v| v[i] - 1e6).sum::<f64>() / n;
        let product = |i: usize, j: usize| {
            let terms = vectors
                .iter()
                .map(|v| (v[i] - 1e6 - mean(i)) * (v[j] - 1e6 - mean(j)));
            terms.sum::<f64>()
        };
        for i in 0..2 {
            assert!((moments.mean(i) - 1e6 - mean(i)).abs() < 1e-8);
            let expected = (product(i, i) / (n - 1.0)).sqrt();
            assert!((moments.standard_deviation(i) / expected - 1.0).abs() < 1e-7);
        }
        let expected = product(0, 1) / (product(0, 0) * product(1, 1)).sqrt();
        assert!((moments.correlation(0, 1) - expected).abs() < 1e-7);
        assert_eq!(moments.correlation(0, 1), moments.correlation(1, 0));
        assert_eq!(moments.count(), 1000);
    }
}
