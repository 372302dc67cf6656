//! `respond` with a study of method `frf-space`: what an assembly answers whose joints are known, such as at the tool of a chain.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::json;

use bolted_joint::identify::space::{Answer, Answers, ChainStudy};
use bolted_joint::respond::with_noise;
use bolted_joint::study::StudyText;
use bolted_joint_figures::{Drawn, ResponseCurve, ResponseFigure, ResponsePanel, Scale};

use super::super::error::CliError;
use super::super::output::{CSV, Ending, Wrote, check_outputs, print, warn, write_file};
use super::picture::{Picture, also};
use super::{RespondArguments, RespondNoise, format, output, pollution};

/// 97.5 % quantile of the normal distribution.
const QUANTILE: f64 = 1.96;

/// Functions that are drawn at most.
const MOST_DRAWN: usize = 12;

pub(super) fn run(arguments: &RespondArguments, study: &StudyText) -> Result<(), CliError> {
    if let Some(joint) = &arguments.joint {
        let expected =
            "none: a study of method \"frf-space\" names its joint files (known, or expected)";
        return Err(CliError::option("--joint", joint.display(), expected));
    }
    let output = output(arguments)?;
    let format = format(output)?;
    check_outputs(
        &arguments.study,
        &[
            ("--output", Some(output), Ending::Any),
            ("--report", arguments.report.as_ref(), Ending::Any),
            ("--deviations", arguments.deviations.as_ref(), CSV),
        ],
    )?;
    let noise = match &arguments.noise {
        Some(RespondNoise::Noise(noise)) => Some((noise, pollution(noise)?.checked()?)),
        None => None,
    };
    let picture = Picture::asked(arguments)?;
    let text = study;
    let study = ChainStudy::of(text, arguments.step)?;
    warn(study.assumed());
    let answers = study.answers()?;
    let exact = answers.set()?;
    let measured = match noise {
        Some((noise, pollution)) => with_noise(&exact, &pollution, noise.seed)?,
        None => exact,
    };
    if !answers.without_deviations.is_empty()
        && (arguments.deviations.is_some() || arguments.report.is_some())
    {
        warn(&[format!(
            "{}: no file with deviations and correlation of each number by itself, so no band is given",
            answers.without_deviations.join(", ")
        )]);
    }
    let drawing = Picture::drawn(picture, &study.name, text.text(), &[], || {
        figure(&study.name, &answers)
    })?;
    format.write(&measured, output, &study.name)?;
    if let Some((path, drawing)) = &drawing {
        write_file(path, drawing.as_bytes())?;
    }
    if let Some(path) = &arguments.deviations {
        let Some(text) = deviations(&answers) else {
            let expected = "joint files with deviations and correlation of each number by itself";
            return Err(CliError::option("--deviations", path.display(), expected));
        };
        write_file(path, text.as_bytes())?;
    }
    let largest = |one: &Answer| {
        let own = one.deviation.as_ref()?.iter().zip(&one.values);
        Some(
            own.map(|(deviation, value)| deviation / value.norm())
                .fold(0.0, f64::max),
        )
    };
    if arguments.json {
        let functions: Vec<_> = answers
            .functions
            .iter()
            .map(|one| {
                json!({
                    "response": one.response.to_string(),
                    "reference": one.reference.to_string(),
                    "largest_relative_deviation": largest(one),
                })
            })
            .collect();
        let shown = |path: &Path| path.display().to_string();
        return print(&serde_json::to_string_pretty(&json!({
            "output": shown(output),
            "report": arguments.report.as_deref().map(shown),
            "deviations": arguments.deviations.as_deref().map(shown),
            "lines": answers.frequency_hz.len(),
            "functions": functions,
            "without_deviations": answers.without_deviations,
        }))?);
    }
    print(&format!(
        "{}: {} functions of {} lines\n{}{}",
        study.name,
        answers.functions.len(),
        answers.frequency_hz.len(),
        Wrote(output),
        also(&[arguments.report.as_ref(), arguments.deviations.as_ref()])
    ))
}

/// Magnitudes with bands of 95 %.
fn figure(name: &str, answers: &Answers) -> Option<Drawn> {
    let panel = |one: &Answer| {
        let magnitudes = answers.frequency_hz.iter().zip(&one.values);
        let points: Vec<(f64, f64)> = magnitudes.map(|(&hz, value)| (hz, value.norm())).collect();
        let ends = one.deviation.iter().flat_map(|deviation| {
            [-1.0, 1.0].map(|sign| {
                let own = points.iter().zip(deviation);
                let end = own.map(|(&(hz, value), own)| (hz, value + sign * QUANTILE * own));
                let points: Vec<(f64, f64)> = end.filter(|&(_, value)| value > 0.0).collect();
                ResponseCurve {
                    name: match sign < 0.0 {
                        true => "lower end".to_owned(),
                        false => "upper end".to_owned(),
                    },
                    is_dashed: vec![true; points.len()],
                    points,
                }
            })
        });
        let ends: Vec<ResponseCurve> = ends.collect();
        let curve = ResponseCurve {
            name: "magnitude".to_owned(),
            points,
            is_dashed: Vec::new(),
        };
        ResponsePanel {
            title: format!("{}/{}", one.response, one.reference),
            across: ("frequency, Hz".to_owned(), Scale::Linear),
            up: ("receptance, SI units".to_owned(), Scale::Logarithmic),
            curves: std::iter::once(curve).chain(ends).collect(),
        }
    };
    ResponseFigure {
        title: name,
        note: Some("dashed: 95 % by the joints' deviations"),
        panels: answers
            .functions
            .iter()
            .take(MOST_DRAWN)
            .map(panel)
            .collect(),
    }
    .drawn()
}

/// Standard deviations of the magnitudes.
fn deviations(answers: &Answers) -> Option<String> {
    let mut text = "frequency [Hz]".to_owned();
    let mut columns = Vec::new();
    for one in &answers.functions {
        let _ = write!(
            text,
            ",{}/{} standard deviation of the magnitude",
            one.response, one.reference
        );
        columns.push(one.deviation.as_ref()?);
    }
    text.push('\n');
    for (line, hz) in answers.frequency_hz.iter().enumerate() {
        let _ = write!(text, "{hz}");
        for column in &columns {
            let _ = write!(text, ",{:e}", column[line]);
        }
        text.push('\n');
    }
    Some(text)
}
