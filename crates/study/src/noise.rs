//! Noise that a study states, beside what a fit leaves.

/// Stated noise over what a fit leaves beyond which it was meant otherwise: nobody's estimate of it is that far off.
const TOO_LARGE: f64 = 3.0;

/// What is said of `noise.relative` that is far above the residual, whose χ² over degrees of freedom is given.
#[must_use]
pub fn overstated_noise(relative: f64, reduced_chi_squared: f64) -> Option<String> {
    let times = reduced_chi_squared.max(f64::MIN_POSITIVE).sqrt().recip();
    (times > TOO_LARGE).then(|| {
        let many = match times > MANY {
            true => format!("more than {MANY}"),
            false => format!("{times:.0}"),
        };
        format!(
            "noise.relative: the stated noise, {} % of each function, is {many} times as large as what the fit leaves: the deviations \
             are as much too large; noise is stated in parts, 0.01 for 1 %",
            shown(100.0 * relative)
        )
    })
}

/// Beyond this nobody counts.
const MANY: f64 = 1000.0;

/// Three digits at most.
fn shown(value: f64) -> String {
    let rounded = format!("{value:.2e}").parse::<f64>().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_far_above_the_residual_is_told() {
        let told = overstated_noise(1.0, 2.2e-4).unwrap_or_default();
        assert!(
            told.contains("100 % of each function, is 67 times"),
            "{told}"
        );
        let told = overstated_noise(0.003, 1e-20).unwrap_or_default();
        assert!(
            told.contains("0.3 % of each function, is more than 1000 times"),
            "{told}"
        );
        assert_eq!(overstated_noise(0.01, 0.2), None);
        assert_eq!(overstated_noise(0.01, 1.0), None);
    }
}
