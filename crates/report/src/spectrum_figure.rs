//! The spectrum of a surface's profiles and the straight line that gives its fractal dimension.

use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_predict::surface::ProfileFit;

/// The spectrum over spatial frequency, the means over bands and the fitted line, all logarithmic, as an SVG document; `None` if nothing
/// can be drawn.
#[must_use]
pub fn spectrum_figure(fit: &ProfileFit) -> Option<String> {
    spectrum(fit).to_svg()
}

/// The same, to be drawn in several ways.
pub(crate) fn spectrum(fit: &ProfileFit) -> LineFigure<'static> {
    let spectrum = &fit.spectrum;
    let points = spectrum.frequency_per_m.iter().copied();
    let points = points.zip(spectrum.density_m3.iter().copied()).skip(1);
    let bands = fit.bands.iter();
    let means = bands.map(|band| (band.frequency_per_m, band.density_m3));
    let [shortest_m, longest_m] = fit.wavelength_band_m;
    let ends = [1.0 / longest_m, 1.0 / shortest_m];
    LineFigure {
        title: "Power spectral density of the profiles, and the fitted line",
        across: ("spatial frequency, cycles per m", Scale::Logarithmic),
        up: ("S, m³", Scale::Logarithmic),
        lines: vec![
            Line::curve(format!("Welch, {} segments", spectrum.segments), points),
            Line::curve(
                format!(
                    "fit, D = {:.3} ± {:.3}",
                    fit.roughness.fractal_dimension(),
                    fit.dimension_standard_deviation()
                ),
                ends.map(|f| (f, fit.density_m3(f))),
            ),
            Line::marks("means over bands", means),
        ],
    }
}
