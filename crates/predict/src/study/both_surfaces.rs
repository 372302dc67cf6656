//! Two rough surfaces as one: what a rigid flat one would have to press on.

use crate::NumberError;
use crate::surface::Roughness;

/// Ratio γ of successive frequencies of the profiles.
const FREQUENCY_RATIO: f64 = 1.5;
/// Wavelengths at which the sum of two spectra is fitted, evenly over their logarithm.
const POINTS: usize = 65;

/// The roughness whose spectrum is the sum of both: heights that know nothing of each other add up in power.
///
/// Surfaces of the same fractal dimension give one of that dimension, G^(2(D−1)) = G_a^(2(D−1)) + G_b^(2(D−1)), whatever the
/// band. The sum of others is no power of the frequency: it is fitted by one, by least squares of the logarithms over the
/// band of wavelengths (m).
///
/// # Errors
/// The fit is no fractal profile.
pub(super) fn both(a: Roughness, b: Roughness, band_m: [f64; 2]) -> Result<Roughness, NumberError> {
    let [from, to] = band_m.map(|wavelength_m| -wavelength_m.ln());
    let points = (0..POINTS).map(|point| {
        let log_frequency = from + (to - from) * point as f64 / (POINTS - 1) as f64;
        let [a, b] = [a, b].map(|surface| log_spectrum(surface, log_frequency));
        // ln(e^a + e^b)
        let log_sum = a.max(b) + (-(a - b).abs()).exp().ln_1p();
        (log_frequency, log_sum)
    });
    let points: Vec<(f64, f64)> = points.collect();
    let count = POINTS as f64;
    let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / count;
    let [xx, xy] = points.iter().fold([0.0; 2], |[xx, xy], (x, y)| {
        [xx + (x - mean_x).powi(2), xy + (x - mean_x) * (y - mean_y)]
    });
    let slope = xy / xx;
    let intercept = mean_y - slope * mean_x;
    // slope 2D − 5, intercept 2(D − 1) ln G − ln(2 ln γ): (30), (31)
    let dimension = 0.5 * (5.0 + slope);
    let log_roughness = (intercept + (2.0 * FREQUENCY_RATIO.ln()).ln()) / (2.0 * (dimension - 1.0));
    Roughness::new(dimension, log_roughness.exp())
}

/// ln P of (30), P = G^(2(D−1)) f^(2D−5)/(2 ln γ), f the inverse of the wavelength.
fn log_spectrum(surface: Roughness, log_frequency: f64) -> f64 {
    let d = surface.fractal_dimension();
    2.0 * (d - 1.0) * surface.roughness_m().ln() + (2.0 * d - 5.0) * log_frequency
        - (2.0 * FREQUENCY_RATIO.ln()).ln()
}

#[cfg(test)]
mod tests {
    use super::both;
    use crate::surface::Roughness;

    const BAND_M: [f64; 2] = [5e-6, 5e-4];

    fn surface(fractal_dimension: f64, roughness_m: f64) -> Roughness {
        Roughness::new(fractal_dimension, roughness_m).unwrap()
    }

    #[test]
    fn surfaces_of_one_dimension_add_up_in_power() {
        let found = both(surface(1.42, 1.2e-8), surface(1.42, 3e-9), BAND_M).unwrap();
        let exponent = 2.0 * 0.42;
        let expected = (1.2e-8_f64.powf(exponent) + 3e-9_f64.powf(exponent)).powf(1.0 / exponent);
        assert!((found.fractal_dimension() - 1.42).abs() < 1e-12);
        assert!((found.roughness_m() / expected - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_polished_surface_leaves_the_other_as_it_is() {
        let rough = surface(1.55, 2e-9);
        let found = both(rough, surface(1.4, 1e-18), BAND_M).unwrap();
        assert!((found.fractal_dimension() - 1.55).abs() < 1e-3);
        assert!((found.roughness_m().ln() - 2e-9_f64.ln()).abs() < 0.02);
    }

    #[test]
    fn which_is_a_and_which_b_does_not_matter() {
        let (a, b) = (surface(1.35, 2e-10), surface(1.6, 8e-9));
        let (ab, ba) = (both(a, b, BAND_M).unwrap(), both(b, a, BAND_M).unwrap());
        assert!((ab.fractal_dimension() - ba.fractal_dimension()).abs() < 1e-12);
        let between = a.fractal_dimension()..b.fractal_dimension();
        assert!(between.contains(&ab.fractal_dimension()));
    }
}
