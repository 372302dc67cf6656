//! The surfaces: fractal dimension and roughness, and the spectra that they were fitted to.

use crate::spectrum_figure::spectrum;
use bolted_joint_figures::html::figure;
use bolted_joint_figures::html::{
    beside, cell, escaped, number, number_cell, shown, table, with_deviation,
};
use bolted_joint_predict::study::Prediction;
use bolted_joint_predict::surface::ProfileFit;

pub(super) fn section(found: &Prediction<'_>) -> String {
    let [dimension, roughness_m] = found.roughness;
    let mut html = format!(
        "<h2>Surfaces</h2>\n<p>Both surfaces together: <i>D</i> = {}, <i>G</i> = {} m.</p>\n",
        number(dimension),
        number(roughness_m)
    );
    for (place, (whose, fit)) in found.study.fits.iter().enumerate() {
        html += &fitted(place, whose, fit);
    }
    html
}

fn fitted(place: usize, whose: &str, fit: &ProfileFit) -> String {
    let roughness = fit.roughness;
    let interval = |[low, high]: [f64; 2], deviation: f64| {
        format!("{} … {}", beside(low, deviation), beside(high, deviation))
    };
    let of_dimension = fit.dimension_standard_deviation();
    let of_roughness = fit.roughness_standard_deviation_m();
    let rows = vec![
        [
            cell("<i>D</i>"),
            number_cell(&with_deviation(roughness.fractal_dimension(), of_dimension)),
            number_cell(&interval(fit.dimension_interval, of_dimension)),
        ]
        .concat(),
        [
            cell("<i>G</i>, m"),
            number_cell(&with_deviation(roughness.roughness_m(), of_roughness)),
            number_cell(&interval(fit.roughness_interval_m, of_roughness)),
        ]
        .concat(),
    ];
    let [shortest_m, longest_m] = fit.wavelength_band_m;
    let warnings: String = fit
        .warnings
        .iter()
        .map(|warning| {
            format!(
                "<p class=\"warning\">{}</p>\n",
                escaped(&warning.to_string())
            )
        })
        .collect();
    let drawing = spectrum(fit).drawn().map_or_else(String::new, |drawn| {
        figure(
            &format!("spectrum-{}", place + 1),
            "<b>Spectrum of the profiles</b> (Welch), the means of its bands, and the line fitted to them.",
            &drawn,
        )
    });
    format!(
        "<h3>{}</h3>\n{warnings}{}<p>Fitted over wavelengths from {} to {} µm; <i>D</i> and ln <i>G</i> are correlated by {} and drawn \
         together.</p>\n{drawing}",
        escaped(&bolted_joint_figures::html::capitalised(whose)),
        table(&["", "Estimate (std. dev.)", "95 % interval"], &rows),
        number(1e6 * shortest_m),
        number(1e6 * longest_m),
        shown(fit.correlation(), 3),
    )
}
