//! `reproduce 2.2`: the joint laws of chapter 2.2 of Tol's thesis as closed loops, beside results without the program's laws.

use super::super::error::CliError;
use super::super::output::write_file;
use super::super::table::number;
use super::ReproduceArguments;
use super::page::{Page, Section, percent, show};
use bolted_joint::reproduce::{
    ChapterFigure, ChapterLaw, FrictionFigure, FrictionLoop, FrictionReproduction, LawParameter,
    LoopReading, friction,
};

const DIGITS: usize = 5;

pub(super) fn run(arguments: &ReproduceArguments) -> Result<(), CliError> {
    let found = friction();
    if let Some(path) = &arguments.figure {
        let figure = FrictionFigure { found: &found }.to_svg();
        write_file(path, figure.unwrap_or_default().as_bytes())?;
    }
    show(arguments, &found, || page(&found))
}

fn page(found: &FrictionReproduction) -> Page {
    Page {
        title: "The joint laws of Tol's chapter 2.2, drawn anew",
        source: "Ş. Tol, *Dynamic Modeling of Structural Joints*, MSc thesis, Middle East Technical University, 2012, chapter 2.2: its laws of joint \
                 friction as closed loops of this program's laws ([theory](theory.md#friction)), each beside a result that these had no part in."
            .to_owned(),
        command: "tol 2.2 --markdown --figure docs/images/tol-friction.svg",
        figure: Some("![Force over displacement of the chapter's laws](images/tol-friction.svg)"),
        sections: vec![loops(found), readings(found)],
    }
}

fn loops(found: &FrictionReproduction) -> Section {
    let mut last = None;
    let rows = found.loops.iter().map(|row| {
        let title = first(&mut last, row.law);
        vec![
            title,
            row.case.clone(),
            number(1e3 * row.amplitude_m, 4),
            number(row.force_at_tip_n, DIGITS),
            number(row.heat_j, DIGITS),
            number(row.reference_heat_j, DIGITS),
            difference(row.relative_difference),
        ]
    });
    let of_tips = found.loops.iter().map(|row| {
        let part = row.force_at_tip_n / row.reference_force_at_tip_n - 1.0;
        part.abs()
    });
    let of_tips = of_tips.fold(0.0, f64::max);
    let rows = rows.collect();
    let figures = found.figures.iter().map(|of| {
        let ChapterFigure {
            number,
            shows,
            drawn,
        } = of;
        format!("{number}: {shows}. Drawn here: {drawn}.")
    });
    let differences = found.differences.iter().map(|&line| line.to_owned());
    let differences = differences.chain([format!(
        "Where the velocity matters (LuGre at 20 Hz) the loop is stepped, 512 times a period; the others are exact at any step. Forces at the tip \
         agree with their references to {of_tips:.1e}."
    )]);
    Section {
        heading: "Loops: heat of a cycle".to_owned(),
        columns: &[
            "law",
            "loop",
            "amplitude, mm",
            "force at the tip, N",
            "heat, J",
            "reference, J",
            "difference",
        ],
        words: 2,
        rows,
        is_long: false,
        remarks: vec![
            ("Figures, by their captions and the text", figures.collect()),
            (
                "Parameters, all of them ours, as the thesis prints none",
                of_each(&found.loops, parameters),
            ),
            (
                "References",
                of_each(&found.loops, |row| row.reference.to_owned()),
            ),
            (
                "Not given in the thesis",
                found
                    .not_given
                    .iter()
                    .map(|&line| line.to_owned())
                    .collect(),
            ),
            ("Differences", differences.collect()),
        ],
    }
}

/// The law's name where it is another one than in the row before.
fn first(last: &mut Option<ChapterLaw>, law: ChapterLaw) -> String {
    let is_same = last.replace(law) == Some(law);
    if is_same { "" } else { law.title() }.to_owned()
}

/// A line for each law, or for each of its loops where their words differ.
fn of_each(loops: &[FrictionLoop], words: impl Fn(&FrictionLoop) -> String) -> Vec<String> {
    let mut lines = Vec::new();
    for of_law in loops.chunk_by(|one, next| one.law == next.law) {
        let title = of_law[0].law.title();
        let said: Vec<String> = of_law.iter().map(&words).collect();
        if said.iter().all(|one| *one == said[0]) {
            lines.push(format!("{title}: {}", said[0]));
            continue;
        }
        let said = of_law.iter().zip(said);
        lines.extend(said.map(|(row, words)| format!("{title}, {}: {words}", row.case)));
    }
    lines
}

/// Parameters that all loops of a law share; κ stands in the table.
fn parameters(row: &FrictionLoop) -> String {
    let shared = row.parameters.iter().filter(|of| of.symbol != "κ");
    let all: Vec<String> = shared.map(parameter).collect();
    all.join(", ")
}

fn parameter(of: &LawParameter) -> String {
    let value = match of.value {
        value if value.abs() < 1e5 => value.to_string(),
        value => format!("{value:e}"),
    };
    format!("{} = {value} {}", of.symbol, of.unit)
        .trim_end()
        .to_owned()
}

/// A relative difference, or that it is lost in rounding.
fn difference(value: f64) -> String {
    if value.abs() < 1e-9 {
        "< 1e-9".to_owned()
    } else {
        format!("{value:+.1e}")
    }
}

fn readings(found: &FrictionReproduction) -> Section {
    let mut last = None;
    let rows = found.readings.iter().map(|row: &LoopReading| {
        vec![
            first(&mut last, row.law),
            row.case.clone(),
            row.symbol.to_owned(),
            number(row.taken, DIGITS),
            number(row.read, DIGITS),
            row.unit.to_owned(),
            percent(100.0 * (row.read / row.taken - 1.0), 1),
        ]
    });
    let valanis = found
        .loops
        .iter()
        .filter(|row| row.law == ChapterLaw::Valanis);
    let more: Vec<String> = valanis
        .map(|row| {
            let part = row.heat_j / found.heat_without_micro_slip_j - 1.0;
            format!("{} ({})", percent(100.0 * part, 1), row.case)
        })
        .collect();
    Section {
        heading: "Parameters read from the loops".to_owned(),
        columns: &["law", "loop", "", "taken", "read", "unit", "error"],
        words: 3,
        rows: rows.collect(),
        is_long: false,
        remarks: vec![(
            "",
            vec![
                "Read by tangents: E_0, K_T and k_0 + k_1 are the slope behind the reversal, E_t is that before it, and σ_0 is half of the way in \
                 force from the lower tip to where the two tangents meet."
                    .to_owned(),
                "\"These parameters can be identified from a measured hysteresis\": from its tangents only where κ is near 1. Behind a reversal the \
                 slope is E_t + (E_0 − E_t) (1 + w)/(1 + cw), with c = κ (E_0 − E_t)/(E_0 − κ E_t) and w the part of the slider's load that the tip has \
                 reached: for κ = 0 nearly twice E_0, which is the slope of the first loading alone. E_t is too high as long as w < 1."
                    .to_owned(),
                format!(
                    "\"High values of κ correspond to small influence of micro-slip\": so it is. Beside the parallelogram of κ = 1, {} J, the \
                     heat is {}.",
                    number(found.heat_without_micro_slip_j, 4),
                    more.join(", ")
                ),
                "\"The slope of the hysteresis curve gives [...] the total stiffness\" (figure 2.4): behind a reversal, and the closer to it the better, as \
                 the weakest sliders slip at once."
                    .to_owned(),
            ],
        )],
    }
}
