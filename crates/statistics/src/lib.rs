//! Quantiles of distributions that intervals and tests need, for the crates that identify and that predict.
#![forbid(unsafe_code)]

/// Quantile of the standard normal distribution for an interval of 95 %.
const NORMAL_975: f64 = 1.959_963_984_540_054;

/// 97.5 % quantile of Student's distribution (expansion of Fisher and Cornish from three degrees of freedom on).
#[must_use]
pub fn student_975(degrees_of_freedom: usize) -> f64 {
    let z = NORMAL_975;
    let n = degrees_of_freedom as f64;
    match degrees_of_freedom {
        0 => f64::INFINITY,
        1 => 12.706_204_736,
        2 => 4.302_652_730,
        _ => {
            let (z3, z5, z7) = (z.powi(3), z.powi(5), z.powi(7));
            z + (z3 + z) / (4.0 * n)
                + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n)
                + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn students_quantile_is_that_of_the_tables() {
        for (freedom, table) in [
            (3, 3.182),
            (5, 2.571),
            (10, 2.228),
            (30, 2.042),
            (1000, 1.962),
        ] {
            let error = (student_975(freedom) / table - 1.0).abs();
            assert!(error < 1e-2, "{freedom}: {error}");
        }
    }
}
