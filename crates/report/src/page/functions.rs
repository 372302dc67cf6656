//! The measured functions: measured, regenerated, and what is left between them.

use num_complex::Complex64;

use super::super::chart::{Chart, ChartStrip, Curve};
use super::super::frf_figure::{MAGNITUDE_DECADES, residual_axis};
use super::super::legend::Key;
use super::figure::figure;
use super::{Assembly, IdentificationReport, counted};
use bolted_joint_figures::Axis;
use bolted_joint_figures::curve::{self, Sample};
use bolted_joint_figures::html::{cell, escaped, number_cell, percent, table};
use bolted_joint_frf::receptance_unit;

/// Functions that are drawn at most.
const MOST_FIGURES: usize = 9;

const MAGNITUDE: f64 = 250.0;
const PHASE: f64 = 110.0;
const RESIDUAL: f64 = 90.0;

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let assemblies = report.assemblies();
    let several = assemblies.len() > 1;
    let mut html = "<h2>Frequency response functions</h2>\n<p>Measured, and regenerated with the identified joint. The residual is \
                    |measured − regenerated| / |regenerated|. Dotted uprights mark resonances of the regenerated function.</p>\n"
        .to_owned();
    html += &residuals(&assemblies, several);
    let shares = shares(&assemblies, MOST_FIGURES);
    let all: usize = assemblies.iter().map(|assembly| assembly.fits.len()).sum();
    let drawn: usize = shares.iter().sum();
    if drawn < all {
        html += &format!(
            "<p>{drawn} of {} are drawn below, those at the points of excitation first; all were used.</p>\n",
            counted(all, "function")
        );
    }
    for (number, (assembly, share)) in assemblies.iter().zip(shares).enumerate() {
        if several {
            html += &format!("<h3>Assembly {}</h3>\n", number + 1);
        }
        for fit in assembly.drive_points_first().into_iter().take(share) {
            html += &function(assembly, fit, &format!("frf-{}-{}", number + 1, fit + 1));
        }
    }
    html
}

/// How many functions of each assembly are drawn: as equal as can be.
pub(super) fn shares(assemblies: &[Assembly<'_>], most: usize) -> Vec<usize> {
    let mut shares = vec![0; assemblies.len()];
    let mut left = most;
    while left > 0 {
        let mut grew = false;
        for (share, assembly) in shares.iter_mut().zip(assemblies) {
            if left > 0 && *share < assembly.fits.len() {
                *share += 1;
                left -= 1;
                grew = true;
            }
        }
        if !grew {
            break;
        }
    }
    shares
}

fn residuals(assemblies: &[Assembly<'_>], several: bool) -> String {
    let mut rows = Vec::new();
    for (number, assembly) in assemblies.iter().enumerate() {
        for fit in assembly.fits {
            let mut row = String::new();
            if several {
                row += &cell(&(number + 1).to_string());
            }
            row += &cell(&escaped(&fit.response.to_string()));
            row += &cell(&escaped(&fit.reference.to_string()));
            row += &number_cell(&percent(fit.relative_rms));
            rows.push(row);
        }
    }
    let headings: &[&str] = match several {
        true => &["Assembly", "Response", "Reference", "Residual, r.m.s."],
        false => &["Response", "Reference", "Residual, r.m.s."],
    };
    table(headings, &rows)
}

fn function(assembly: &Assembly<'_>, fit: usize, id: &str) -> String {
    let fit = &assembly.fits[fit];
    let frequency_hz = &assembly.lines.frequency_hz;
    let of = |matrices: &[bolted_joint_frf::structure::ComplexMatrix]| -> Vec<Complex64> {
        matrices.iter().map(|matrix| matrix[fit.place]).collect()
    };
    drawn(&Function {
        id,
        name: &format!("{} / {}", fit.response, fit.reference),
        unit: receptance_unit(fit.response, fit.reference),
        remark: &format!(" residual {} r.m.s.", percent(fit.relative_rms)),
        frequency_hz,
        measured: &of(&assembly.lines.assembly),
        regenerated: &of(assembly.regenerated),
    })
}

/// A function that is drawn.
pub(crate) struct Function<'a> {
    /// Name within the page.
    pub(crate) id: &'a str,
    /// What it is called.
    pub(crate) name: &'a str,
    /// Unit of the values.
    pub(crate) unit: &'a str,
    /// What follows its name in the caption, in HTML.
    pub(crate) remark: &'a str,
    pub(crate) frequency_hz: &'a [f64],
    pub(crate) measured: &'a [Complex64],
    pub(crate) regenerated: &'a [Complex64],
}

/// Magnitude, phase and residual over frequency.
pub(crate) fn drawn(function: &Function<'_>) -> String {
    let Function {
        id,
        name,
        unit,
        remark,
        frequency_hz,
        measured,
        regenerated,
    } = *function;
    let values = |samples: Vec<Sample>| samples.into_iter().map(|sample| sample.1).collect();
    let curve = |key: Key, samples| Curve {
        name: key.name().to_owned(),
        look: key.look(),
        values: values(samples),
    };
    let phase = curve::phase(frequency_hz, regenerated);
    let measured_phase = curve::turned_towards(&phase, curve::phase(frequency_hz, measured));
    let residual = curve::residual(frequency_hz, measured, regenerated);
    let both = measured.iter().chain(regenerated);
    let strip = |name: &str, unit: &str, height, axis, curves| ChartStrip {
        name: name.to_owned(),
        unit: unit.to_owned(),
        height,
        axis,
        curves,
        bands: Vec::new(),
        level: None,
    };
    let chart = Chart {
        id: id.to_owned(),
        title: format!("{name}: magnitude, phase and residual over frequency"),
        frequency_hz,
        strips: vec![
            strip(
                "magnitude",
                unit,
                MAGNITUDE,
                Axis::logarithmic(both.map(|value| value.norm()), MAGNITUDE_DECADES),
                vec![
                    curve(Key::Measured, curve::magnitude(frequency_hz, measured)),
                    curve(
                        Key::Regenerated,
                        curve::magnitude(frequency_hz, regenerated),
                    ),
                ],
            ),
            strip(
                "phase",
                "°",
                PHASE,
                Some(Axis::Phase),
                vec![
                    curve(Key::Measured, measured_phase),
                    curve(Key::Regenerated, phase),
                ],
            ),
            strip(
                "residual",
                "%",
                RESIDUAL,
                residual_axis(residual.iter().map(|sample| sample.1)),
                vec![curve(Key::Residual, residual)],
            ),
        ],
        resonating: Some(regenerated),
    };
    let caption = format!("<b>{}</b>{remark}", escaped(name));
    figure(&chart, &caption)
}
