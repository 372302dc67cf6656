//! Functions of one frequency axis and one unit: magnitude over phase over coherence, for a page and for an SVG.

use bolted_joint_figures::curve::{self, Sample};
use bolted_joint_figures::html::escaped;
use bolted_joint_figures::{Axis, COLOURS, Look, ResponseCurve, ResponsePanel, Scale};
use num_complex::Complex64;

use crate::chart::{Chart, ChartStrip, Curve};
use crate::frf_figure::MAGNITUDE_DECADES;
use crate::page::figure::figure;

const MAGNITUDE: f64 = 260.0;
const PHASE: f64 = 120.0;
const COHERENCE: f64 = 80.0;

/// A function that is drawn.
#[derive(Debug, Clone)]
pub struct DrawnFunction {
    /// Between which degrees of freedom.
    pub label: String,
    /// One for each frequency.
    pub values: Vec<Complex64>,
    /// γ², one for each frequency, where it is known.
    pub coherence: Option<Vec<f64>>,
}

/// Functions that share frequencies and unit.
#[derive(Debug, Clone)]
pub struct FunctionGroup {
    /// What they have in common.
    pub title: String,
    /// Unit of the values, as in "m/N".
    pub unit: &'static str,
    /// Frequencies of the lines, ascending, Hz.
    pub frequency_hz: Vec<f64>,
    /// The functions.
    pub functions: Vec<DrawnFunction>,
}

/// What a strip shows of a function, one value for each line.
type Shows = fn(&[f64], &DrawnFunction) -> Vec<Sample>;

/// Name and unit of each strip, and what it shows.
const STRIPS: [(&str, &str, Shows); 3] = [
    ("magnitude", "", |hz, own| curve::magnitude(hz, &own.values)),
    ("phase", "°", |hz, own| curve::phase(hz, &own.values)),
    ("coherence γ²", "", |hz, own| {
        let gamma_squared = own.coherence.iter().flatten().copied();
        hz.iter().copied().zip(gamma_squared).collect()
    }),
];

impl FunctionGroup {
    /// As many functions at a time as there are colours.
    fn chunks(&self) -> impl Iterator<Item = (String, &[DrawnFunction])> {
        let all = self.functions.chunks(COLOURS.len());
        let count = all.len();
        all.enumerate().map(move |(number, chunk)| {
            let part = match count {
                1 => String::new(),
                _ => format!(", {} of {count}", number + 1),
            };
            (format!("{}{part}", self.title), chunk)
        })
    }

    /// Charts that can be zoomed; `id` is their name on the page.
    pub(super) fn charts(&self, id: &str) -> String {
        let charts = self
            .chunks()
            .enumerate()
            .map(|(number, (title, functions))| {
                let strips =
                    STRIPS
                        .iter()
                        .enumerate()
                        .filter_map(|(place, &(name, unit, shows))| {
                            let curves: Vec<Curve> = functions
                                .iter()
                                .zip(COLOURS)
                                .map(|(own, colour)| Curve {
                                    name: own.label.clone(),
                                    look: Look::line(colour, 1.3),
                                    values: self.padded(shows(&self.frequency_hz, own)),
                                })
                                .collect();
                            let values =
                                || curves.iter().flat_map(|curve| curve.values.iter().copied());
                            let (axis, height) = match place {
                                0 => (Axis::logarithmic(values(), MAGNITUDE_DECADES), MAGNITUDE),
                                1 => (Some(Axis::Phase), PHASE),
                                _ if values().all(f64::is_nan) => return None,
                                _ => (
                                    Some(Axis::linear(
                                        values().chain([1.0]).filter(|own| own.is_finite()),
                                    )),
                                    COHERENCE,
                                ),
                            };
                            Some(ChartStrip {
                                name: name.to_owned(),
                                unit: if place == 0 { self.unit } else { unit }.to_owned(),
                                height,
                                axis,
                                curves,
                                bands: Vec::new(),
                                level: None,
                            })
                        });
                let chart = Chart {
                    id: format!("{id}-{}", number + 1),
                    title: format!("{title}: magnitude, phase and coherence over frequency"),
                    frequency_hz: &self.frequency_hz,
                    strips: strips.collect(),
                    resonating: None,
                };
                figure(&chart, &format!("<b>{}</b>", escaped(&title)))
            });
        charts.collect()
    }

    /// One value for each line, NaN where there is none.
    fn padded(&self, samples: Vec<Sample>) -> Vec<f64> {
        let mut values: Vec<f64> = samples.into_iter().map(|sample| sample.1).collect();
        values.resize(self.frequency_hz.len(), f64::NAN);
        values
    }

    /// The same as panels below one another.
    pub(super) fn panels(&self) -> Vec<ResponsePanel> {
        let mut panels = Vec::new();
        for (title, functions) in self.chunks() {
            let what = match functions.iter().any(|own| own.coherence.is_some()) {
                true => "magnitude, phase, coherence",
                false => "magnitude, phase",
            };
            for (place, &(name, unit, shows)) in STRIPS.iter().enumerate() {
                let curves: Vec<ResponseCurve> = functions
                    .iter()
                    .map(|own| ResponseCurve {
                        // the key stands above the magnitude and holds for all
                        name: if place == 0 {
                            own.label.clone()
                        } else {
                            String::new()
                        },
                        points: with_gaps(shows(&self.frequency_hz, own), place == 1),
                        is_dashed: Vec::new(),
                    })
                    .collect();
                if curves.iter().all(|curve| curve.points.is_empty()) {
                    continue;
                }
                let unit = if place == 0 { self.unit } else { unit };
                let up = match unit {
                    "" => name.to_owned(),
                    unit => format!("{name}, {unit}"),
                };
                panels.push(ResponsePanel {
                    title: if place == 0 {
                        format!("{title}: {what}")
                    } else {
                        String::new()
                    },
                    across: ("frequency, Hz".to_owned(), Scale::Linear),
                    up: (
                        up,
                        if place == 0 {
                            Scale::Logarithmic
                        } else {
                            Scale::Linear
                        },
                    ),
                    curves,
                });
            }
        }
        panels
    }
}

/// Samples with a gap where a phase passes ±180°.
fn with_gaps(samples: Vec<Sample>, wraps: bool) -> Vec<Sample> {
    if !wraps {
        return samples;
    }
    curve::unwrapped_pieces(&samples)
        .into_iter()
        .flat_map(|piece| piece.into_iter().chain([(f64::NAN, f64::NAN)]))
        .collect()
}
