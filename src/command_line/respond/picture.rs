//! The picture beside a response: an SVG, or the same on a page.

use std::path::PathBuf;

use bolted_joint::respond::ResponsePage;
use bolted_joint_figures::Drawn;
use bolted_joint_files::Timestamp;

use super::super::error::CliError;
use super::super::output::{check_output, has_extension};
use super::RespondArguments;

#[derive(Clone, Copy)]
enum Kind {
    Svg,
    Html,
}

/// A picture that was asked for.
#[derive(Clone, Copy)]
pub(super) struct Picture<'a> {
    path: &'a PathBuf,
    kind: Kind,
}

impl<'a> Picture<'a> {
    /// The picture that `--report` asks for, if it does.
    pub(super) fn asked(arguments: &'a RespondArguments) -> Result<Option<Self>, CliError> {
        let Some(path) = &arguments.report else {
            return Ok(None);
        };
        let kind = if has_extension(path, "svg") {
            Kind::Svg
        } else if has_extension(path, "html") {
            Kind::Html
        } else {
            let expected = "a name that ends in .svg or .html";
            return Err(CliError::option("--report", path.display(), expected));
        };
        let others: Vec<&PathBuf> = std::iter::once(&arguments.study)
            .chain(&arguments.output)
            .collect();
        check_output(path, &others)?;
        Ok(Some(Self { path, kind }))
    }

    /// Its file and its text, where one is asked for.
    pub(super) fn drawn(
        picture: Option<Self>,
        name: &str,
        study: &str,
        warnings: &[String],
        figure: impl FnOnce() -> Option<Drawn>,
    ) -> Result<Option<(&'a PathBuf, String)>, CliError> {
        let Some(Self { path, kind }) = picture else {
            return Ok(None);
        };
        let Some(drawn) = figure() else {
            let expected = "a response that can be drawn: all amplitudes are zero";
            return Err(CliError::option("--report", path.display(), expected));
        };
        let text = match kind {
            Kind::Svg => drawn.svg,
            Kind::Html => ResponsePage {
                name,
                warnings,
                drawn: &drawn,
                study,
                written: Timestamp::from_environment()?,
            }
            .to_html(),
        };
        Ok(Some((path, text)))
    }
}

/// Further files that were written, a line for each.
pub(super) fn also(files: &[Option<&PathBuf>]) -> String {
    let files = files.iter().flatten();
    files
        .map(|path| format!("\nwrote {}", path.display()))
        .collect()
}
