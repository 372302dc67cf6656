//! `respond` with an assembly file: how structures answer that joints connect.

use std::fmt::Write as _;

use serde_json::json;

use bolted_joint::assembly::{AssemblyModel, Response};
use bolted_joint::respond::AssemblyAnswer;
use bolted_joint::study::StudyText;

use super::super::error::CliError;
use super::super::output::{Wrote, check_output, has_extension, note, print, warn, write_file};
use super::super::progress::Progress;
use super::RespondArguments;
use super::picture::{Picture, also};

/// Modes that are told; the table has all.
const MODES_TOLD: usize = 12;

pub(super) fn run(arguments: &RespondArguments, text: &StudyText) -> Result<(), CliError> {
    for (option, given) in [
        ("--joint", arguments.joint.is_some()),
        ("--plan", arguments.plan),
        ("--deviations", arguments.deviations.is_some()),
        ("--step", arguments.step.is_some()),
        ("noise", arguments.noise.is_some()),
    ] {
        if given {
            let expected =
                "none: an assembly file names its joints, and says in [response] what is computed";
            return Err(CliError::option(option, "it", expected));
        }
    }
    let output = super::output(arguments)?;
    if !has_extension(output, "csv") {
        let expected = "a name that ends in .csv";
        return Err(CliError::option("--output", output.display(), expected));
    }
    check_output(output, &[&arguments.study])?;
    let picture = Picture::asked(arguments)?;
    let model = AssemblyModel::of(text)?;
    let Some(response) = &model.response else {
        let expected = "a table such as [response] with kind = \"linear\", from = 5 and to = 2000";
        return Err(text.refusal("response", "nothing", expected).into());
    };
    if let (Response::Modes, Some(report)) = (response, &arguments.report) {
        let expected = "none: modes are a list of frequencies and damping ratios, without a picture; leave it out, or choose another \
                        response.kind";
        return Err(CliError::option("--report", report.display(), expected));
    }
    let progress = Progress::of_share("responding");
    let answer = AssemblyAnswer::of(&model, response, &|share| progress.reached(share))?;
    drop(progress);
    let warnings = answer.warnings(&model);
    let drawing = Picture::drawn(picture, &model.name, text.text(), &warnings, || {
        answer.figure(&model.name)
    })?;
    write_file(output, answer.to_csv().as_bytes())?;
    if let Some((path, drawing)) = &drawing {
        write_file(path, drawing.as_bytes())?;
    }
    warn(&warnings);
    note(&model.notes);
    if arguments.json {
        let modes = answer.modes.iter().map(|mode| json!({ "frequency_hz": mode.frequency_hz, "damping_ratio": mode.damping_ratio }));
        let value = json!({
            "output": output.display().to_string(),
            "report": drawing.as_ref().map(|(path, _)| path.display().to_string()),
            "rows": answer.rows.len(),
            "structures": model.structures.iter().map(|own| json!({
                "name": own.name, "modes": own.form.modes, "cut": own.form.cut, "coordinates": own.form.size(), "free": own.form.rigid(),
            })).collect::<Vec<_>>(),
            "modes": modes.collect::<Vec<_>>(),
            "warnings": warnings,
            "notes": model.notes,
        });
        print(&serde_json::to_string_pretty(&value)?)?;
    } else {
        print(&format!(
            "{}{}{}",
            told(&model, &answer),
            Wrote(output),
            also(&[arguments.report.as_ref()])
        ))?;
    }
    judged(&model)
}

fn told(model: &AssemblyModel, answer: &AssemblyAnswer) -> String {
    let mut text = format!("{}\n", model.name);
    for own in &model.structures {
        let form = &own.form;
        let free = match form.rigid() {
            0 => String::new(),
            free => format!(", {free} of them free motions"),
        };
        let cut = match form.cut {
            0 => String::new(),
            cut => format!(
                "; {} residual vectors for {cut} more",
                form.size() - form.modes
            ),
        };
        let _ = writeln!(
            text,
            "  structure {}: {} modes{free}{cut}",
            own.name, form.modes
        );
    }
    for joint in &model.joints {
        let _ = writeln!(text, "  joint {}: {}", joint.name, joint.file.name);
    }
    let _ = writeln!(text, "modes of small motion:");
    for mode in answer.modes.iter().take(MODES_TOLD) {
        let _ = match mode.frequency_hz {
            0.0 => writeln!(text, "  {:>10} Hz, moves freely", 0),
            frequency_hz => writeln!(
                text,
                "  {frequency_hz:>10.3} Hz, damping ratio {:.3e}",
                mode.damping_ratio
            ),
        };
    }
    if let Some(more) = answer
        .modes
        .len()
        .checked_sub(MODES_TOLD)
        .filter(|&more| more > 0)
    {
        let _ = writeln!(text, "  and {more} more");
    }
    text
}

/// Says of joints that are not to be relied on that they are not.
fn judged(model: &AssemblyModel) -> Result<(), CliError> {
    model.joints.iter().try_for_each(|joint| {
        let passivity = joint.file.passivity();
        let active = passivity.active().map(|matrix| {
            format!("{matrix}: the joint can feed energy, and what is computed with it may grow without bounds")
        });
        let stated = joint.file.reasons_against().iter().cloned();
        CliError::unless_usable(&joint.path, &stated.chain(active).collect::<Vec<_>>())
    })
}
