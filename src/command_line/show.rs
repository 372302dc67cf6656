//! `show`: what is in a measurement, a study, a joint file, an FMU, modes or an assembly.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use bolted_joint::export::Timestamp;
use bolted_joint::report::{ShownFile, shown_page, shown_svg};
use bolted_joint::show::{Shown, show};

use super::error::CliError;
use super::output::{check_plot, has_extension, message, print, warn, write_file};

/// `show`
#[derive(Debug, Args)]
pub(super) struct ShowArguments {
    /// Files: measured functions (universal file, CSV, NPZ, MAT), tables of responses, modes, matrices, studies, assemblies, joint
    /// files, FMUs, SSPs
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Also draw it: functions with magnitude, phase and coherence, the curves of joints
    #[arg(long, value_name = "NAME.html|NAME.svg")]
    plot: Option<PathBuf>,
    /// Print what was found as JSON
    #[arg(long)]
    json: bool,
}

/// Columns that the names of facts take.
const LABEL: usize = 14;

pub(super) fn run(arguments: &ShowArguments) -> Result<(), CliError> {
    check_plot(arguments.plot.as_ref(), &arguments.files)?;
    let mut all: Vec<Shown> = Vec::new();
    let mut refused: Vec<CliError> = Vec::new();
    for path in &arguments.files {
        match show(path) {
            Ok(shown) => all.push(shown),
            Err(error) => refused.push(error.into()),
        }
    }
    // what can be shown is; the last error ends the command
    if !all.is_empty() {
        tell(arguments, &mut all)?;
    }
    if let Some(last) = refused.pop() {
        for error in refused {
            message(&format!("error: {error}"));
        }
        return Err(last);
    }
    let mut all = all.iter();
    all.try_for_each(|shown| CliError::unless_usable(&shown.path, &shown.reasons_against))
}

/// Draws and prints what was read, and warns of it.
fn tell(arguments: &ShowArguments, all: &mut [Shown]) -> Result<(), CliError> {
    if let Some(path) = &arguments.plot {
        let drawing = drawn(path, all)?;
        write_file(path, drawing.as_bytes())?;
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&as_json(all))?)?;
    } else {
        let mut text = all.iter().map(told).collect::<Vec<_>>().join("\n");
        if let Some(path) = &arguments.plot {
            let _ = writeln!(text, "wrote {}", path.display());
        }
        print(&text)?;
    }
    for shown in &*all {
        let of = |warning: &String| match all.len() {
            1 => warning.clone(),
            _ => format!("{}: {warning}", shown.path.display()),
        };
        warn(&shown.warnings.iter().map(of).collect::<Vec<_>>());
    }
    Ok(())
}

fn told(shown: &Shown) -> String {
    let mut text = format!("{}: {}\n", shown.path.display(), shown.kind);
    for fact in &shown.facts {
        for (number, line) in fact.lines.iter().enumerate() {
            let label = if number == 0 { fact.label } else { "" };
            let _ = writeln!(text, "  {label:<LABEL$}{line}");
        }
    }
    if let Some(next) = &shown.next {
        let _ = writeln!(text, "  {:<LABEL$}{next}", "next");
    }
    text
}

fn drawn(path: &Path, all: &mut [Shown]) -> Result<String, CliError> {
    let title = match &*all {
        [one] => one.path.display().to_string(),
        all => format!("{} files", all.len()),
    };
    if has_extension(path, "svg") {
        let pictures: Vec<_> = all
            .iter_mut()
            .flat_map(|shown| std::mem::take(&mut shown.pictures))
            .collect();
        return shown_svg(&title, &pictures).ok_or_else(|| {
            let expected =
                "files with something to draw: functions, modes, assemblies, joint files or FMUs";
            CliError::option("--plot", path.display(), expected)
        });
    }
    let facts = |shown: &Shown| -> Vec<(String, String)> {
        let kind = ("kind".to_owned(), shown.kind.clone());
        let facts = shown.facts.iter();
        let facts = facts.map(|fact| (fact.label.to_owned(), fact.lines.join("\n")));
        let warnings = shown
            .warnings
            .iter()
            .map(|own| ("warning".to_owned(), own.clone()));
        let against = shown.reasons_against.iter();
        let against = against.map(|own| ("not to be relied on".to_owned(), own.clone()));
        [kind]
            .into_iter()
            .chain(facts)
            .chain(warnings)
            .chain(against)
            .collect()
    };
    let names: Vec<String> = all
        .iter()
        .map(|own| own.path.display().to_string())
        .collect();
    let facts: Vec<_> = all.iter().map(facts).collect();
    let files = names.iter().zip(&facts).zip(all.iter());
    let files: Vec<ShownFile<'_>> = files
        .map(|((name, facts), shown)| ShownFile {
            name,
            facts,
            pictures: &shown.pictures,
        })
        .collect();
    Ok(shown_page(&title, &files, Timestamp::from_environment()?))
}

fn as_json(all: &[Shown]) -> Value {
    let each = all.iter().map(|shown| {
        let facts = shown
            .facts
            .iter()
            .map(|fact| (fact.label.to_owned(), json!(fact.lines)));
        json!({
            "file": shown.path.display().to_string(),
            "kind": shown.kind,
            "facts": facts.collect::<serde_json::Map<_, _>>(),
            "warnings": shown.warnings,
            "usable": shown.reasons_against.is_empty(),
            "reasons_against": shown.reasons_against,
            "next": shown.next,
            "details": shown.details,
        })
    });
    Value::Array(each.collect())
}
