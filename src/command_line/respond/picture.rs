//! The picture beside a response: an SVG, or the same on a page.

use std::path::PathBuf;

use bolted_joint_figures::html;

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
        figure: impl FnOnce() -> Option<String>,
    ) -> Result<Option<(&'a PathBuf, String)>, CliError> {
        let Some(Self { path, kind }) = picture else {
            return Ok(None);
        };
        let Some(svg) = figure() else {
            let expected = "a response that can be drawn: all amplitudes are zero";
            return Err(CliError::option("--report", path.display(), expected));
        };
        Ok(Some((path, text(kind, name, svg))))
    }
}

fn text(kind: Kind, name: &str, svg: String) -> String {
    match kind {
        Kind::Svg => svg,
        Kind::Html => {
            let name = html::escaped(name);
            format!(
                "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{name}</title>\n<style>\n{}</style>\n\
                 </head>\n<body>\n<main>\n{svg}</main>\n</body>\n</html>\n",
                html::STYLE
            )
        }
    }
}
