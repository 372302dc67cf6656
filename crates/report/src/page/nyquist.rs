//! The most prominent resonance in the complex plane: a mode draws a circle there, and a residual that is no noise is seen at once.

use num_complex::Complex64;

use super::super::legend::{Key, REGENERATED_COLOUR};
use super::{Assembly, IdentificationReport};
use bolted_joint_figures::html::{self, escaped, number};
use bolted_joint_figures::{
    Axis, Drawn, FONTS, LABELS_BELOW, PathData, Plot, PlotCurve, PlotPanel, PlotPoints, Strip, Svg,
    VALUE_LABELS, draw_path,
};
use bolted_joint_frf::{receptance_unit, resonances};
use bolted_joint_joint::superscript;

/// Side of the square that is drawn, pixels.
const SIDE: f64 = 380.0;
const MARGIN: f64 = 14.0;
/// Half-power bandwidths that are drawn on each side of a resonance: nine tenths of its circle.
const BANDWIDTHS: f64 = 3.0;
/// Length of an axis over that of what it shows.
const ROOM: f64 = 1.1;
/// Fewer measured lines than this show no circle.
const FEWEST: usize = 5;

/// The most prominent resonance at the first point of excitation of each assembly.
pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let assemblies = report.assemblies();
    let figures: String = (assemblies.iter().enumerate())
        .filter_map(|(index, assembly)| figure(assembly, index + 1))
        .collect();
    match figures.is_empty() {
        true => String::new(),
        false => format!(
            "<h3>Resonances in the complex plane</h3>\n<p>A mode draws a circle. Dots are measured, the line is regenerated: dots \
             on another circle mean another damping, dots turned about the origin a wrong phase.</p>\n{figures}"
        ),
    }
}

fn figure(assembly: &Assembly<'_>, assembly_number: usize) -> Option<String> {
    let fit = &assembly.fits[*assembly.drive_points_first().first()?];
    let frequency_hz = &assembly.lines.frequency_hz;
    let regenerated: Vec<Complex64> = assembly.regenerated.iter().map(|h| h[fit.place]).collect();
    let shown = around_resonance(frequency_hz, &regenerated)?;
    let measured = assembly.lines.assembly[shown.clone()].iter();
    let measured: Vec<Complex64> = measured.map(|h| h[fit.place]).collect();
    let name = format!("{} / {}", fit.response, fit.reference);
    let title = format!("{name} around its most prominent resonance, imaginary over real part");
    let unit = receptance_unit(fit.response, fit.reference);
    let drawn = draw(&title, unit, &measured, &regenerated[shown.clone()])?;
    let [from, to] = [shown.start, shown.end - 1].map(|line| number(frequency_hz[line]));
    Some(html::figure(
        &format!("nyquist-{assembly_number}"),
        &format!("<b>{}</b> from {from} to {to} Hz", escaped(&name)),
        &drawn,
    ))
}

/// The lines around the resonance that stands out most; `None` if it has too few of them.
fn around_resonance(
    frequency_hz: &[f64],
    function: &[Complex64],
) -> Option<std::ops::Range<usize>> {
    let most_prominent = resonances(frequency_hz, function)
        .into_iter()
        .max_by(|one, other| one.prominence_decades.total_cmp(&other.prominence_decades))?;
    let peak = frequency_hz.partition_point(|&hz| hz < most_prominent.frequency_hz);
    let peak = (peak.saturating_sub(1)..=peak)
        .filter(|&line| line < function.len())
        .max_by(|&one, &other| function[one].norm().total_cmp(&function[other].norm()))?;
    // half the power: |H| ≥ |H|max/√2
    let is_inside =
        |value: &Complex64| value.norm() * std::f64::consts::SQRT_2 >= function[peak].norm();
    let below = function[..peak]
        .iter()
        .rev()
        .take_while(|h| is_inside(h))
        .count();
    let above = function[peak..].iter().take_while(|h| is_inside(h)).count();
    let half_width = (BANDWIDTHS * (below + above) as f64).ceil() as usize;
    let shown = peak.saturating_sub(half_width)..(peak + half_width + 1).min(function.len());
    (shown.len() >= FEWEST).then_some(shown)
}

/// Both axes have the same scale, so that a circle is one.
fn draw(
    title: &str,
    unit: &str,
    measured: &[Complex64],
    regenerated: &[Complex64],
) -> Option<Drawn> {
    let parts = measured
        .iter()
        .chain(regenerated)
        .flat_map(|h| [h.re, h.im]);
    let largest = parts.map(f64::abs).fold(0.0, f64::max);
    if !(largest.is_normal() && largest.is_finite()) {
        return None;
    }
    // numbers from 1 to 1000 beside a power of a thousand
    let power = 3 * (largest.log10() / 3.0).floor() as i32;
    let scale = 10_f64.powi(-power);
    let shown = || measured.iter().chain(regenerated);
    let [across, up] = [
        shown().map(|h| h.re * scale).collect::<Vec<_>>(),
        shown().map(|h| h.im * scale).collect(),
    ]
    .map(|values| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        (low, values.into_iter().fold(low, f64::max))
    });
    let half = ROOM * 0.5 * (across.1 - across.0).max(up.1 - up.0);
    let [across, up] = [across, up].map(|(low, high)| Axis::Linear {
        low: 0.5 * (low + high) - half,
        high: 0.5 * (low + high) + half,
    });
    let strip = Strip {
        // Half a pixel off, thin lines are sharp.
        left: MARGIN + VALUE_LABELS + 0.5,
        top: MARGIN + 0.5,
        width: SIDE,
        height: SIDE,
        frequency: across,
        value: Some(up),
    };
    let [width, height] = [
        2.0 * MARGIN + VALUE_LABELS + SIDE,
        MARGIN + SIDE + LABELS_BELOW,
    ];
    let mut svg = Svg::new(width, height, title);
    svg.paper(width, height, Some(6.0), FONTS);
    strip.draw_grid(&mut svg);
    let places = |values: &[Complex64]| -> Vec<_> {
        values
            .iter()
            .filter_map(|h| strip.place((h.re * scale, h.im * scale)))
            .collect()
    };
    let mut line = PathData::default();
    line.polyline(&places(regenerated));
    draw_path(&mut svg, &line, REGENERATED_COLOUR, 1.5);
    let mut dots = PathData::default();
    for place in places(measured) {
        dots.move_to(place);
        dots.dot();
    }
    Key::Measured.draw(&dots, &mut svg);
    let [name_across, name_up] =
        ["real", "imaginary"].map(|part| format!("{part} part, 10{} {unit}", raised(power)));
    strip.draw_axes(&name_across, &name_up, &mut svg);
    let curve = |key: Key, values: &[Complex64]| {
        let points = values.iter().map(|h| (h.re * scale, h.im * scale));
        PlotCurve {
            name: key.name().to_owned(),
            look: key.look(),
            points: PlotPoints::Path(points.collect(), Vec::new()),
        }
    };
    let curves = vec![
        curve(Key::Measured, measured),
        curve(Key::Regenerated, regenerated),
    ];
    let mut panel = PlotPanel::new("", SIDE, (name_across, across), (name_up, Some(up)), curves);
    panel.is_square = true;
    let plot = Plot {
        title: title.to_owned(),
        columns: 1,
        lines: Vec::new(),
        panels: vec![panel],
    };
    Some(Drawn {
        svg: svg.finish(),
        plot,
    })
}

/// A power of ten, raised.
fn raised(power: i32) -> String {
    let sign = if power < 0 { "⁻" } else { "" };
    format!("{sign}{}", superscript(power.unsigned_abs() as u8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    /// One mode on lines of 0.25 Hz: (k (1 + jη) − ω² m)⁻¹ with f₀ = 100 Hz and η = 0.02, which is a circle to the last digit.
    fn mode() -> (Vec<f64>, Vec<Complex64>) {
        let frequency_hz: Vec<f64> = (0..400).map(|line| 50.0 + 0.25 * f64::from(line)).collect();
        let function = frequency_hz.iter().map(|hz| {
            let ratio = hz / 100.0;
            1e-6 / Complex64::new(1.0 - ratio * ratio, 0.02)
        });
        let function = function.collect();
        (frequency_hz, function)
    }

    #[test]
    fn three_bandwidths_on_each_side_of_the_resonance_are_shown() {
        let (frequency_hz, function) = mode();
        let shown = around_resonance(&frequency_hz, &function).unwrap();
        // the half-power bandwidth is ηf₀ = 2 Hz
        let [from, to] = [frequency_hz[shown.start], frequency_hz[shown.end - 1]];
        assert!(
            (93.0..94.5).contains(&from) && (105.5..107.0).contains(&to),
            "{from} {to}"
        );
    }

    /// Points of the longest line of a picture, in pixels.
    fn longest_line(svg: &str) -> Vec<(f64, f64)> {
        let paths = svg.split(" d=\"m").skip(1);
        let path = paths.max_by_key(|path| path.matches('l').count()).unwrap();
        let steps = path.split('"').next().unwrap().split('l');
        let mut pen = (0.0, 0.0);
        steps
            .map(|step| {
                let numbers = step.replace('-', " -");
                let mut numbers = numbers
                    .split_whitespace()
                    .map(|n| n.parse::<f64>().unwrap());
                pen.0 += numbers.next().unwrap();
                pen.1 += numbers.next().unwrap();
                pen
            })
            .collect()
    }

    #[test]
    fn a_mode_is_a_circle_of_equal_scales() {
        let (_, function) = mode();
        let svg = draw("mode", "m/N", &function, &function).unwrap().svg;
        let points = longest_line(&svg);
        assert_eq!(points.len(), function.len());
        // through three points of it, [x y 1] (2x₀, 2y₀, r² − x₀² − y₀²)ᵀ = x² + y²
        let three = [0, 196, 204].map(|line| points[line]);
        let rows = Matrix3::from_fn(|i, j| [three[i].0, three[i].1, 1.0][j]);
        let squares = Vector3::from_fn(|i, _| three[i].0.powi(2) + three[i].1.powi(2));
        let found = rows.lu().solve(&squares).unwrap();
        let (x0, y0) = (0.5 * found.x, 0.5 * found.y);
        let radius = (found.z + x0 * x0 + y0 * y0).sqrt();
        assert!(radius > 100.0);
        for &(x, y) in &points {
            let distance = (x - x0).hypot(y - y0);
            assert!(
                (distance - radius).abs() < 0.05,
                "{x} {y}: {distance}, not {radius}"
            );
        }
        assert!(
            svg.contains("real part, 10⁻⁶ m/N") && svg.contains(">−40</text>"),
            "{svg}"
        );
        assert_eq!(raised(-12), "⁻¹²");
        assert_eq!(draw("mode", "m/N", &[], &[]), None);
    }

    #[test]
    fn without_a_resonance_nothing_is_drawn() {
        let flat = vec![Complex64::new(1.0, -0.1); 50];
        let frequency_hz: Vec<f64> = (1..=50).map(f64::from).collect();
        assert_eq!(around_resonance(&frequency_hz, &flat), None);
    }
}
