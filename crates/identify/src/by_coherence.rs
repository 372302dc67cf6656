//! Variance of a measured function by its coherence: which |H|² the relative variance multiplies decides on a bias.

/// A measured |H|² counts for at least this part of the smaller one beside it: a value that got lost between others is not
/// exact for that. Noise alone is hardly ever so small.
const LEAST_OF_NEIGHBOURS: f64 = 1e-6;

/// σ² of a measured function at each line, from σ²/|H|² as coherence tells it there and its own |H|².
///
/// It is σ²/|H|² of coherence times the |H|² of the same measurement, which is Syy(1 − γ²)/(n Sff): what is left of the
/// response, and independent of the error of H₁. Times a computed |H|² a value that errs upwards would have a smaller variance
/// than one that errs downwards, and every estimate would err upwards.
#[must_use]
pub fn variances_by_coherence(relative: &[f64], power: impl Fn(usize) -> f64) -> Vec<f64> {
    let lines = relative.len();
    let absolute = |(line, relative): (usize, &f64)| {
        let beside = [line.checked_sub(1), Some(line + 1)];
        let beside = beside.into_iter().flatten();
        let beside = beside.filter(|&line| line < lines).map(&power);
        let least = LEAST_OF_NEIGHBOURS * beside.fold(f64::INFINITY, f64::min);
        let least = if least.is_finite() { least } else { 0.0 };
        relative * power(line).max(least)
    };
    relative.iter().enumerate().map(absolute).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_got_lost_is_not_exact() {
        let power = [4.0, 0.0, 9.0];
        let found = variances_by_coherence(&[0.1, 0.1, 0.2], |line| power[line]);
        assert!((found[0] - 0.4).abs() < 1e-15 && (found[2] - 1.8).abs() < 1e-15);
        assert!((found[1] - 0.1 * 4e-6).abs() < 1e-18, "{}", found[1]);
    }
}
