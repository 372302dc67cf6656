//! Functions of statistics that the spectrum's distribution needs.

/// ψ(x) − ln x for x > 0: the mean of the logarithm of a gamma variable of shape x and mean 1.
pub(super) fn digamma_less_log(x: f64) -> f64 {
    // Abramowitz and Stegun 6.3.5 (recurrence) and 6.3.18 (asymptotic)
    let (mut shifted, mut sum) = (x, 0.0);
    while shifted < 10.0 {
        sum -= 1.0 / shifted;
        shifted += 1.0;
    }
    let square = 1.0 / (shifted * shifted);
    let series = square
        * (1.0 / 12.0
            - square
                * (1.0 / 120.0 - square * (1.0 / 252.0 - square * (1.0 / 240.0 - square / 132.0))));
    sum - 0.5 / shifted - series + (shifted / x).ln()
}

/// ψ′(x) for x > 0: the variance of that logarithm.
pub(super) fn trigamma(x: f64) -> f64 {
    // Abramowitz and Stegun 6.4.6 and 6.4.12
    let (mut shifted, mut sum) = (x, 0.0);
    while shifted < 10.0 {
        sum += 1.0 / (shifted * shifted);
        shifted += 1.0;
    }
    let square = 1.0 / (shifted * shifted);
    let series = 1.0 / 6.0
        - square
            * (1.0 / 30.0 - square * (1.0 / 42.0 - square * (1.0 / 30.0 - square * 5.0 / 66.0)));
    sum + 1.0 / shifted + 0.5 * square + series * square / shifted
}

/// 97.5 % of the normal distribution.
pub(super) const NORMAL_975: f64 = 1.959_963_984_540_054;

/// χ² that is exceeded with 5 % probability: the approximation of Wilson and Hilferty, within 2.5 % with 1 degree of freedom,
/// 0.5 % with 3 and 0.1 % with 9.
pub(super) fn chi_squared_95(degrees_of_freedom: f64) -> f64 {
    const NORMAL_95: f64 = 1.644_853_626_951_472;
    let part = 2.0 / (9.0 * degrees_of_freedom);
    degrees_of_freedom * (1.0 - part + NORMAL_95 * part.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_the_tables() {
        let euler = 0.577_215_664_901_532_9;
        let pi_squared = std::f64::consts::PI.powi(2);
        // ψ(1) = −γ, ψ(½) = −γ − 2 ln 2, ψ′(1) = π²/6, ψ′(½) = π²/2; ψ(12) by the recurrence from 1.
        assert!((digamma_less_log(1.0) + euler).abs() < 1e-13);
        assert!((digamma_less_log(0.5) + 2_f64.ln() + euler).abs() < 1e-13);
        let harmonic: f64 = (1..12).map(|k| 1.0 / f64::from(k)).sum();
        assert!((digamma_less_log(12.0) - (harmonic - euler - 12_f64.ln())).abs() < 1e-13);
        assert!((trigamma(1.0) - pi_squared / 6.0).abs() < 1e-12);
        assert!((trigamma(0.5) - pi_squared / 2.0).abs() < 1e-12);
        // χ² of 0.95: 3.841, 7.815 and 16.919 with 1, 3 and 9 degrees of freedom.
        for (freedom, table, error) in
            [(1.0, 3.841, 0.025), (3.0, 7.815, 6e-3), (9.0, 16.919, 1e-3)]
        {
            assert!((chi_squared_95(freedom) / table - 1.0).abs() < error);
        }
    }
}
