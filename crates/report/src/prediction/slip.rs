//! What slips under the joint's motion: loops and heat of the interface's patches, and of the law in their place.

use bolted_joint_figures::html::{number, shown};
use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_joint::{unit_for_people, with_symbols};
use bolted_joint_predict::study::{Prediction, Slip};

use bolted_joint_figures::html::figure;

/// Points of a half cycle.
const POINTS: usize = 100;
/// Amplitudes of the heat's curve.
const AMPLITUDES: usize = 40;
/// Loops that are drawn, as parts of slip force over stiffness: some slip, and nearly all.
const LOOPS: [f64; 2] = [0.75, 2.0];
/// Displacements are drawn in µm or µrad.
const MICRO: f64 = 1e6;

/// The section, empty where nothing slips.
pub(super) fn section(found: &Prediction<'_>) -> String {
    let slips = &found.nominal().slips;
    if slips.is_empty() {
        return String::new();
    }
    let each: String = slips.iter().map(of_dof).collect();
    format!(
        "<h2>Slip</h2>\n<p>Each patch of the interface slips through at <i>μ p</i> Δ<i>A</i> and follows Mindlin's contact up to there, so that its \
         slip grows with the load. One law of Iwan with four parameters stands for all of them in the joint file.</p>\n{each}"
    )
}

fn of_dof(slip: &Slip) -> String {
    let fitted = &slip.fitted;
    let name = with_symbols(slip.dof.name);
    let length = slip.dof.kind.displacement_unit();
    let load = unit_for_people(slip.dof.kind.load_unit());
    let id = |what: &str| format!("{what}-{}", slip.dof.name);
    let across = format!("{name}, µ{length}");
    let loops = LineFigure {
        title: "Load over displacement",
        across: (&across, Scale::Linear),
        up: (&format!("load, {load}"), Scale::Linear),
        lines: loops(slip),
    };
    let amplitude = format!("amplitude of {name}, µ{length}");
    let heat = LineFigure {
        title: "Heat of a cycle",
        across: (&amplitude, Scale::Logarithmic),
        up: ("heat of a cycle, J", Scale::Logarithmic),
        lines: heat(slip),
    };
    let loops = loops.drawn().map_or_else(String::new, |drawn| {
        figure(
            &id("loops"),
            "<b>Loops</b> with some slip and with nearly all: of the patches, and of the law in their place.",
            &drawn,
        )
    });
    let heat = heat.drawn().map_or_else(String::new, |drawn| {
        figure(
            &id("heat"),
            &format!(
                "<b>Heat of a cycle</b> over the amplitude: {} patches, and the law in their place.",
                slip.patches.count()
            ),
            &drawn,
        )
    });
    format!(
        "<p>From {} to {} {length} the law's heat is within {} % of the patches' ({} % r.m.s.), its load within {} %.</p>\n{loops}{heat}",
        number(fitted.amplitudes.from),
        number(fitted.amplitudes.to),
        shown(100.0 * fitted.worst_heat_error, 2),
        shown(100.0 * fitted.heat_error, 2),
        shown(100.0 * fitted.worst_load_error, 2),
    )
}

/// Closed loops by Masing's rule, f = F(U) − 2F((U − u)/2) on the way back.
fn loops(slip: &Slip) -> Vec<Line> {
    let (patches, fitted) = (&slip.patches, &slip.fitted);
    let size = patches.slip_force() / patches.stiffness();
    let closed = |amplitude: f64, load: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let back = |k: usize| {
            let u = amplitude * (1.0 - 2.0 * k as f64 / POINTS as f64);
            let f = load(amplitude) - 2.0 * load(0.5 * (amplitude - u));
            (MICRO * u, f)
        };
        let way_back: Vec<(f64, f64)> = (0..=POINTS).map(back).collect();
        let forth = way_back.iter().map(|&(u, f)| (-u, -f));
        way_back.iter().copied().chain(forth).collect()
    };
    LOOPS
        .iter()
        .flat_map(|part| {
            let amplitude = part * size;
            let of_law = |u: f64| fitted.heat_and_load(u)[1];
            let length = slip.dof.kind.displacement_unit();
            let of_patches = format!("{:.2} µ{length}", MICRO * amplitude);
            [
                Line::curve(of_patches, closed(amplitude, &|u| patches.load(u))),
                Line::curve("its law", closed(amplitude, &of_law)),
            ]
        })
        .collect()
}

fn heat(slip: &Slip) -> Vec<Line> {
    let (patches, fitted) = (&slip.patches, &slip.fitted);
    let points = || fitted.amplitudes.points(AMPLITUDES);
    vec![
        Line::curve(
            "patches",
            points().map(|u| (MICRO * u, patches.cycle_heat(u))),
        ),
        Line::curve(
            "law",
            points().map(|u| (MICRO * u, fitted.heat_and_load(u)[0])),
        ),
    ]
}
