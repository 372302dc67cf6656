//! What to know before a simulation: steps, modes, passivity, limits of the model.

use super::Page;
use crate::FmiVersion;
use crate::fmu::LapFacts;
use crate::step::StepChoice;
use bolted_joint_figures::html::{escaped, number, number_cell, quantity, table};
use bolted_joint_joint::{DofSet, MatrixPassivity};

pub(super) fn section(page: &Page<'_>) -> String {
    let steps = match page.lap {
        Some(lap) => format!("<h3>Step size</h3>\n{}{}", step_size(lap, page.version), modes(lap)),
        None => "<h3>Step size</h3>\n<p>The element takes no steps of its own: a communication step only passes time. \
                 Choose it so that the structures on both sides stay stable with the joint's stiffness between them; \
                 loads are exchanged at communication points only.</p>\n"
            .to_owned(),
    };
    let dofs = page.file.joint.dofs;
    let escape = page.lap.map(|lap| escape(lap, dofs)).unwrap_or_default();
    format!(
        "<h2>Running it</h2>\n{steps}{}<h3>Passivity</h3>\n{}<h3>Range of validity</h3>\n{}{escape}{}",
        status(page),
        passivity(page),
        validity(page),
        page.reference_tolerance
            .map(reference_run)
            .unwrap_or_default(),
    )
}

pub(super) fn reference_run(tolerance: f64) -> String {
    format!(
        "<h3>Reference run</h3>\n<p>The FMU carries inputs and the outputs that they lead to, with which an importer can \
         check itself: it should meet them to {} of their largest magnitudes. \
         <a href=\"fmi-ls-ref.txt\">How to run it</a>.</p>\n",
        number(tolerance)
    )
}

fn step_size(lap: &LapFacts, version: FmiVersion) -> String {
    let step = &lap.step;
    let reason = match step.choice {
        StepChoice::Accuracy => {
            "picked so that the fastest mode drifts by at most 10<sup>−6</sup> rad in one of its periods".to_owned()
        }
        StepChoice::AccuracyAtRest => "picked so that the fastest mode about rest drifts by at most 10<sup>−6</sup> rad in one of its \
             periods; how accurate it is where the joint slips is not known"
            .to_owned(),
        StepChoice::Given => "given by whoever exported the FMU".to_owned(),
        StepChoice::Error { found, .. } => format!(
            "picked so that motions and joint loads of the reference run are wrong by {} of their largest values",
            number(found)
        ),
        StepChoice::NoModes => "a guess, for nothing in this model moves by itself".to_owned(),
    };
    let limit = match step.stability_limit_s {
        Some(limit_s) => format!(
            " The largest eigenvalue about rest is |<i>λ</i>| = {}; steps longer than {} are unstable. \
             A hardening joint becomes faster with amplitude.",
            quantity(step.largest_modulus, "1/s"),
            quantity(limit_s, "s")
        ),
        None => String::new(),
    };
    format!(
        "<p>A communication step is divided into equal Runge–Kutta steps, none longer than <code>step_size_max</code> = \
         {}, {reason}.{limit} Loads are held over a communication step unless {} within it, so keep it well below the \
         periods that matter; {} is suggested.</p>\n",
        quantity(step.longest_s, "s"),
        match version {
            FmiVersion::V2 => "their derivatives say how they change",
            FmiVersion::V3 => "the importer sets them anew",
        },
        quantity(lap.experiment.communication_step_s, "s"),
    )
}

fn modes(lap: &LapFacts) -> String {
    if lap.modes.is_empty() {
        return String::new();
    }
    let rows: Vec<String> = lap
        .modes
        .iter()
        .map(|mode| {
            number_cell(&number(mode.frequency_hz)) + &number_cell(&number(mode.damping_ratio))
        })
        .collect();
    format!(
        "<p>Its modes about rest:</p>\n{}",
        table(&["Natural frequency, Hz", "Damping ratio"], &rows)
    )
}

/// What speaks against the joint, if anything does.
fn status(page: &Page<'_>) -> String {
    let reasons = page.file.reasons_against().iter();
    let reasons: String = reasons
        .map(|reason| format!("<li>{}</li>\n", escaped(reason)))
        .collect();
    match reasons.is_empty() {
        true => String::new(),
        false => format!(
            "<p class=\"warning\">This joint is not to be relied on. Whoever exported this FMU insisted.</p>\n<ul>\n{reasons}</ul>\n"
        ),
    }
}

fn passivity(page: &Page<'_>) -> String {
    let rows: Vec<String> = page.passivity.matrices.iter().map(row).collect();
    let table = table(
        &[
            "Matrix",
            "Eigenvalues in SI units",
            "Scaled to a unit diagonal",
            "",
        ],
        &rows,
    );
    let judgement = if page.passivity.is_passive() {
        "<p>The joint is passive: stiffness and damping are positive semidefinite, so it can store and take energy but \
         not give out more than it stored.</p>\n"
    } else {
        "<p class=\"warning\">The joint is active: it can feed energy into a simulation, which may then grow without \
         bound. Whoever exported this FMU insisted.</p>\n"
    };
    format!("{judgement}{table}")
}

fn row(matrix: &MatrixPassivity) -> String {
    let list = |eigenvalues: &[f64]| {
        let words: Vec<String> = eigenvalues.iter().copied().map(number).collect();
        number_cell(&words.join(", "))
    };
    let scaled = match &matrix.scaled_eigenvalues {
        Some(eigenvalues) => list(eigenvalues),
        None => "<td>zero on the diagonal</td>".to_owned(),
    };
    format!(
        "<td><code>{}</code></td>{}{scaled}<td>{}</td>",
        escaped(&matrix.path),
        list(&matrix.eigenvalues),
        if matrix.passive { "passive" } else { "active" },
    )
}

fn validity(page: &Page<'_>) -> String {
    match &page.file.validity {
        Some(validity) => {
            let [from_hz, to_hz] = validity.frequency_hz;
            format!(
                "<p>The parameters were determined from {} to {} Hz. Outside that band, and at amplitudes other than \
                 those of the measurement, they are an extrapolation.</p>\n",
                number(from_hz),
                number(to_hz)
            )
        }
        None => "<p class=\"faint\">The joint file gives no range of frequencies.</p>\n".to_owned(),
    }
}

fn escape(lap: &LapFacts, dofs: DofSet) -> String {
    let limits: Vec<String> = lap
        .escape_amplitude
        .iter()
        .zip(dofs.rows())
        .filter_map(|(amplitude, dof)| {
            let (motion, unit) = (dof.symbol, dof.kind.displacement_unit());
            amplitude.map(|amplitude| {
                format!(
                    "|<i>{motion}</i><sub>a</sub> − <i>{motion}</i><sub>b</sub>| = {}",
                    quantity(amplitude, unit)
                )
            })
        })
        .collect();
    if limits.is_empty() {
        return String::new();
    }
    format!(
        "<p class=\"warning\">The joint softens. Beyond {} nothing holds the bodies together any more and the \
         simulation stops with an error; the FMU warns once at 80 % of that, and has it as a calculated parameter.</p>\n",
        limits.join(" or ")
    )
}
