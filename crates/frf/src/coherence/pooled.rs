//! Variances of neighbouring lines taken together, where few averages tell each of them badly.
//!
//! The variance that γ² and n averages give is what is left of the response, and has 2 (n − 1) degrees of freedom: it does not
//! depend on the error of the function, so that it biases nothing, but it scatters. An estimate that is weighed by it leans on the
//! lines where it happens to be small, and deviations are too short: by √((n − 3)/n), so that of three averages they say nothing.
//! Noise of neighbouring lines is alike, so that as many of them are taken together as tell it well enough.

/// Pairs of degrees of freedom N that tell a variance well enough: deviations are short by √((N − 2)/(N − 1)), 3 % at most.
const ENOUGH: f64 = 20.0;
/// Those without which it is not told at all.
const FEWEST: f64 = 4.0;

/// How many lines are taken together, an odd number where there are so many; `None` where all of them are too few.
pub(crate) fn window(lines: usize, averages: f64) -> Option<usize> {
    let of_one = averages - 1.0;
    let wanted = (ENOUGH / of_one).ceil().clamp(1.0, lines as f64) as usize;
    let wanted = (wanted | 1).min(lines);
    (wanted as f64 * of_one >= FEWEST).then_some(wanted)
}

/// Variances of lines that are taken together with their neighbours.
pub(crate) fn pooled(own: &[f64], averages: f64) -> Option<Vec<f64>> {
    let wide = window(own.len(), averages)?;
    // n v̂ is v times a gamma variable of n − 1, and that of lines together of N = lines (n − 1). With v = n Σ v̂/(N − 1) is
    // E(1/v) that of the true variance, and so is E χ²
    let factor = averages / (wide as f64 * (averages - 1.0) - 1.0);
    let of_line = |line: usize| {
        let first = line.saturating_sub(wide / 2).min(own.len() - wide);
        factor * own[first..first + wide].iter().sum::<f64>()
    };
    Some((0..own.len()).map(of_line).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_averages_take_neighbours_along() {
        assert_eq!(window(100, 21.0), Some(1));
        assert_eq!(window(100, 10.0), Some(3));
        assert_eq!(window(100, 5.0), Some(5));
        assert_eq!(window(100, 2.0), Some(21));
        assert_eq!(window(6, 2.0), Some(6));
        assert_eq!((window(3, 2.0), window(100, 1.0)), (None, None));
    }

    /// Of n v̂ = v g with g of a gamma distribution of N, E 1/g = 1/(N − 1).
    #[test]
    fn the_mean_of_chi_squared_is_1() {
        // 5 averages, 5 lines of the same variance 3: N = 20
        let averages = 5.0;
        let mean_of_own = 3.0 * (averages - 1.0) / averages;
        let found = pooled(&[mean_of_own; 9], averages).unwrap();
        for own in found {
            assert!((own - 3.0 * 20.0 / 19.0).abs() < 1e-12, "{own}");
        }
        // at an end those that there are
        let found = pooled(&[1.0, 2.0, 3.0, 4.0], 10.0).unwrap();
        let expected = [6.0, 6.0, 9.0, 9.0].map(|sum: f64| sum * 10.0 / 26.0);
        for (own, expected) in found.iter().zip(expected) {
            assert!((own - expected).abs() < 1e-12, "{own} {expected}");
        }
    }
}
