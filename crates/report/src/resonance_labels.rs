//! Frequencies of resonances written above a strip, where there is room for them.

use num_complex::Complex64;

use super::legend::REGENERATED_COLOUR;
use bolted_joint_figures::{Lettering, Manner, Strip, Svg, text};
use bolted_joint_frf::{Resonance, resonances};

/// Room that the labels take above the strip (pixels).
pub(super) const RESONANCE_LABELS: f64 = 18.0;
const FONT: f64 = 11.5;
/// Distance between the labels of two resonances (pixels).
const BETWEEN: f64 = 6.0;

/// Writes the frequencies of the resonances (Hz) of `function` above `strip`, the most prominent first, as long as there is
/// room beside those already there. Returns the marked ones.
pub(super) fn draw_resonance_labels(
    frequency_hz: &[f64],
    function: &[Complex64],
    strip: &Strip,
    svg: &mut Svg,
) -> Vec<Resonance> {
    let mut found = resonances(frequency_hz, function);
    found.sort_by(|a, b| b.prominence_decades.total_cmp(&a.prominence_decades));
    let mut taken: Vec<(f64, f64)> = Vec::new();
    found.retain(|resonance| {
        let Some(x) = strip.place_frequency(resonance.frequency_hz) else {
            return false;
        };
        let label = format!("{:.1}", resonance.frequency_hz);
        let half = 0.5 * text::width(&label, FONT);
        let middle = x.min(strip.width - half).max(half);
        let (start, end) = (middle - half, middle + half + BETWEEN);
        if taken.iter().any(|&(from, to)| start < to && end > from) {
            return false;
        }
        taken.push((start, end));
        svg.text(
            (strip.left + middle, strip.top - 6.0),
            Lettering::new(FONT, Manner::Middle).in_colour(REGENERATED_COLOUR),
            &label,
        );
        true
    });
    found
}
