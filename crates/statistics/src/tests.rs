//! Every function beside SciPy; the tables say by which command.

use super::*;

/// The numbers of a table, below its comments and the names of its columns.
fn table(text: &str) -> impl Iterator<Item = [f64; 3]> {
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let numbers: Vec<f64> = row
            .split(',')
            .map(|number| number.parse().unwrap())
            .collect();
        numbers.try_into().unwrap()
    })
}

#[test]
fn quantiles_are_those_of_scipy() {
    for [freedom, student, chi_squared] in table(include_str!("quantiles.csv")) {
        let freedom = freedom as usize;
        let error = student_975(freedom) / student - 1.0;
        assert!(error.abs() < 2e-12, "Student, {freedom}: {error:e}");
        let error = chi_squared_95(freedom) / chi_squared - 1.0;
        assert!(error.abs() < 2e-12, "χ², {freedom}: {error:e}");
    }
}

#[test]
fn without_freedom_nothing_is_known_and_with_all_of_it_the_distribution_is_normal() {
    assert_eq!(student_975(0), f64::INFINITY);
    assert_eq!(chi_squared_95(0), 0.0);
    assert_eq!(student_975(usize::MAX), NORMAL_975);
    // scipy.stats.norm.ppf(0.975)
    assert_eq!(NORMAL_975, 1.959_963_984_540_054);
}

#[test]
fn functions_of_the_logarithm_are_those_of_scipy() {
    for [x, digamma, second] in table(include_str!("gamma_functions.csv")) {
        let error = digamma_less_log(x) - digamma;
        assert!(error.abs() < 5e-15, "ψ({x}): {error:e}");
        let error = trigamma(x) / second - 1.0;
        assert!(error.abs() < 1e-12, "ψ′({x}): {error:e}");
    }
}

#[test]
fn quantiles_of_samples_are_those_of_numpy() {
    // numpy.quantile([1, 2, 4, 8, 16], q)
    let ascending = [1.0, 2.0, 4.0, 8.0, 16.0];
    for (share, expected) in [
        (0.0, 1.0),
        (0.025, 1.1),
        (0.5, 4.0),
        (0.975, 15.2),
        (1.0, 16.0),
    ] {
        assert!(
            (quantile(&ascending, share) - expected).abs() < 1e-14,
            "{share}"
        );
    }
    assert!(quantile(&[], 0.5).is_nan());
}
