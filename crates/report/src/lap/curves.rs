//! Backbones and free decays beside the model: frequency and damping over the amplitude, and how long a decay takes.

use bolted_joint_figures::html::{self, cell, columns, escaped, number_cell, shown, table};
use bolted_joint_figures::{Drawn, Line, LineFigure, Scale};
use bolted_joint_lap::{BackbonePrediction, CurvePoint, Expected, LapResponse};

/// Curves of a picture of several runs at most, each with the model's.
const RUNS: usize = 2;

/// The section of the report; nothing where there are no such runs.
pub(super) fn section(found: &LapResponse) -> String {
    if found.backbones.is_empty() {
        return String::new();
    }
    let rows = found.backbones.iter().map(|run| {
        let (all, outside) = run.outside();
        let within = match all {
            0 => String::new(),
            _ => format!("{} of {all}", all - outside),
        };
        let fall = run.fall.as_ref().map(|fall| &fall.duration_s);
        [
            cell(&escaped(&run.run)),
            cell(match run.left_out {
                true => "<b>left out</b>",
                false => "fitted",
            }),
            number_cell(&shown(run.frequency_error_hz, 2)),
            number_cell(&run.damping_error.map_or_else(String::new, |error| {
                format!("{} %", shown(100.0 * error, 2))
            })),
            number_cell(&within),
            number_cell(&fall.map_or_else(String::new, |fall| shown(fall.measured, 4))),
            number_cell(&fall.map_or_else(String::new, |fall| shown(fall.predicted, 4))),
            number_cell(
                &fall
                    .and_then(|fall| fall.interval_95)
                    .map_or_else(String::new, |[low, high]| {
                        format!("{} … {}", shown(low, 4), shown(high, 4))
                    }),
            ),
        ]
        .concat()
    });
    let rows: Vec<String> = rows.collect();
    let between = found.between_runs.as_ref();
    let between = between.map_or_else(String::new, |own| format!("<p>{}</p>\n", own.words()));
    let header = columns(
        "Run||Frequency, Hz r.m.s.|Damping, r.m.s.|Within 95 %|Falls in, s|Model, s|Expected, 95 %",
    );
    let pictures = found.backbones.iter().enumerate().map(|(place, run)| {
        let both = [
            ("frequency", frequency(run)),
            ("damping ratio", damping(run)),
        ];
        let both = both.into_iter().enumerate();
        both.filter_map(|(kind, (what, drawn))| {
            let caption = format!("<b>{}</b>: {what} over the amplitude.", escaped(&run.run));
            Some(html::figure(
                &format!("curve-{place}-{kind}"),
                &caption,
                &drawn?,
            ))
        })
        .collect::<String>()
    });
    format!(
        "<h2>Backbones and decays</h2>\n<p>Measured, and of the model at the amplitudes that were measured; of a decay as the model’s own \
         decay is read. Around the curve of a run that was fitted is where that may be by the deviations of the unknowns alone, with 95 %. \
         Around that of a run that was left out is where its points are expected: by these, the noise of the run, the errors of its \
         amplitudes{}. A law that is wrong beyond the amplitudes that were fitted is not in them.</p>\n{between}{}{}",
        match between.is_empty() {
            true =>
                "; what makes runs differ as a whole is told by several fitted runs at the same amplitudes, and is not in them here",
            false => ", and what runs differ by as a whole",
        },
        table(&header, &rows),
        pictures.collect::<String>()
    )
}

/// The model's curves over the amplitudes at which stepped sines resonate, beside what was measured there.
pub(super) fn of_sines(found: &LapResponse) -> String {
    if found.curve.is_empty() {
        return String::new();
    }
    let kind = |measured: Vec<(f64, f64)>, of: &dyn Fn(&CurvePoint) -> [f64; 3], times: f64| {
        let curve = |place: usize| {
            let points = found.curve.iter();
            points.map(move |own| (1e6 * own.amplitude_m, times * of(own)[place]))
        };
        let measured = measured.into_iter();
        let measured = measured.map(|(amplitude_m, own)| (1e6 * amplitude_m, times * own));
        let lines = [
            Line::marks("measured (−90°)", measured),
            Line::curve("95 %, from", curve(1)),
            Line::curve("95 %, to", curve(2)),
            Line::curve("model", curve(0)),
        ];
        lines
            .into_iter()
            .filter(|line| !line.points.is_empty())
            .collect::<Vec<_>>()
    };
    let frequency = |own: &CurvePoint| [own.frequency_hz, own.frequency_95[0], own.frequency_95[1]];
    let damping = |own: &CurvePoint| [own.damping_ratio, own.damping_95[0], own.damping_95[1]];
    let pictures = [
        (
            "backbone",
            "<b>Backbone</b>: the frequency of resonance",
            drawn(
                "Frequency of resonance over amplitude",
                "frequency, Hz",
                kind(found.measured_backbone(), &frequency, 1.0),
            ),
        ),
        (
            "damping",
            "<b>Damping</b>: the damping ratio",
            drawn(
                "Damping over amplitude",
                "damping ratio, %",
                kind(found.measured_damping(), &damping, 100.0),
            ),
        ),
    ];
    let pictures = pictures.into_iter().filter_map(|(id, what, drawn)| {
        let caption = format!(
            "{what} over the amplitude of the relative displacement, without other modes; around it where the model’s own curve may be by \
             the deviations of the unknowns, with 95 %."
        );
        Some(html::figure(id, &caption, &drawn?))
    });
    pictures.collect()
}

/// Frequencies of one run.
fn frequency(run: &BackbonePrediction) -> Option<Drawn> {
    let points = run.points.iter();
    let points = points.map(|point| (point.amplitude_m, point.frequency_hz));
    drawn(
        "Frequency over amplitude",
        "frequency, Hz",
        beside_model(points.collect(), 1.0),
    )
}

/// Damping ratios of one run.
fn damping(run: &BackbonePrediction) -> Option<Drawn> {
    let points = run.points.iter();
    let points = points.filter_map(|point| Some((point.amplitude_m, point.damping_ratio?)));
    drawn(
        "Damping over amplitude",
        "damping ratio, %",
        beside_model(points.collect(), 100.0),
    )
}

/// What was measured, the model, and both ends of what is expected or, of a run that was fitted, of the model's curve, in a unit of
/// 1/`times`.
fn beside_model(points: Vec<(f64, Expected)>, times: f64) -> Vec<Line> {
    let each = |of: &dyn Fn(&Expected) -> Option<f64>| {
        let points = points.iter();
        sorted(points.filter_map(|(amplitude_m, own)| Some((1e6 * amplitude_m, times * of(own)?))))
    };
    let end = |side: usize| each(&|own| Some(own.interval_95.or(own.curve_95)?[side]));
    // the model above the ends of a narrow band
    let all = [
        Line::marks("measured", each(&|own| Some(own.measured))),
        Line::curve("95 %, from", end(0)),
        Line::curve("95 %, to", end(1)),
        Line::curve("model", each(&|own| Some(own.predicted))),
    ];
    all.into_iter()
        .filter(|line| !line.points.is_empty())
        .collect()
}

/// Ascending in amplitude: a decay falls.
fn sorted(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = points.collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    points
}

fn drawn(title: &str, ordinate: &str, lines: Vec<Line>) -> Option<Drawn> {
    LineFigure {
        title,
        across: ("relative displacement, µm", Scale::Logarithmic),
        up: (ordinate, Scale::Linear),
        lines,
    }
    .drawn()
}

/// Frequencies of the first runs, for a picture of its own.
pub(super) fn frequencies(runs: &[BackbonePrediction]) -> Option<String> {
    let lines = runs.iter().take(RUNS).flat_map(|run| {
        let points = || run.points.iter();
        let at = |of: fn(&Expected) -> f64| {
            points().map(move |point| (1e6 * point.amplitude_m, of(&point.frequency_hz)))
        };
        [
            Line::marks(escaped(&run.run), sorted(at(|own| own.measured))),
            Line::curve(
                format!("{}, model", escaped(&run.run)),
                sorted(at(|own| own.predicted)),
            ),
        ]
    });
    drawn("Frequency over amplitude", "frequency, Hz", lines.collect()).map(|drawn| drawn.svg)
}
