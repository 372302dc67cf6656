//! The report of an identification: one page without any reference to the network, for a screen and for paper.

mod beside;
mod budget;
mod decoupled;
pub(crate) mod figure;
mod files;
pub(crate) mod functions;
mod judgement;
mod measured;
mod nyquist;
mod origin;
mod over_torque;
mod parameters;
mod sensitivity;

use bolted_joint_figures::html;
use bolted_joint_files::Timestamp;
use bolted_joint_identify::{Identification, Study};
use bolted_joint_joint::{JointFile, with_symbols};

/// The report of an identification.
#[derive(Debug, Clone, Copy)]
pub struct IdentificationReport<'a> {
    /// What was asked for.
    pub study: &'a Study,
    /// What was found.
    pub found: &'a Identification,
    /// What the reader should know before using the result.
    pub warnings: &'a [String],
    /// When the report was written.
    pub written: Timestamp,
}

impl IdentificationReport<'_> {
    /// The page as an HTML document. Its figures are drawn without the script that it contains; the script adds a cursor
    /// and lets the reader zoom.
    #[must_use]
    pub fn to_html(&self) -> String {
        let files: Vec<JointFile> = self
            .found
            .joint_files()
            .into_iter()
            .map(|(_, file)| file)
            .collect();
        let sections = [
            judgement::summary(self, &files),
            parameters::section(self),
            budget::section(self),
            judgement::section(self, &files),
            functions::section(self),
            nyquist::section(self),
            decoupled::section(self),
            sensitivity::section(self),
            measured::section(self),
            files.first().map(origin::section).unwrap_or_default(),
        ]
        .concat();
        page(
            &self.found.name,
            "identification of a bolted joint",
            self.written,
            &sections,
        )
    }

    /// The first assembly and the further ones: their lines, receptances with the estimated joint, and fits.
    fn assemblies(&self) -> Vec<Assembly<'_>> {
        let found = self.found;
        let first = Assembly {
            lines: &found.lines,
            regenerated: &found.regenerated,
            fits: &found.fits,
        };
        let further = found.further.iter().map(|assembly| Assembly {
            lines: &assembly.lines,
            regenerated: &assembly.regenerated,
            fits: &assembly.fits,
        });
        std::iter::once(first).chain(further).collect()
    }
}

/// A page around finished sections.
pub(crate) fn page(name: &str, what: &str, written: Timestamp, sections: &str) -> String {
    html::page(
        &format!("{name}: {what}"),
        name,
        &format!(
            "{} by {} {}, <time>{written}</time>.",
            html::capitalised(what),
            bolted_joint_files::TOOL,
            bolted_joint_files::VERSION
        ),
        sections,
    )
}

/// One assembly of a study.
#[derive(Clone, Copy)]
struct Assembly<'a> {
    lines: &'a bolted_joint_identify::Lines,
    regenerated: &'a [bolted_joint_frf::structure::ComplexMatrix],
    fits: &'a [bolted_joint_identify::FunctionFit],
}

impl Assembly<'_> {
    /// Numbers of its fits, those at the points of excitation first.
    fn drive_points_first(&self) -> Vec<usize> {
        let is_drive_point =
            |&index: &usize| self.fits[index].response == self.fits[index].reference;
        let (drive, others): (Vec<usize>, Vec<usize>) =
            (0..self.fits.len()).partition(is_drive_point);
        drive.into_iter().chain(others).collect()
    }
}

/// A parameter's name with its index set low: `k_yy` becomes k with index yy.
pub(crate) fn symbol(name: &str) -> String {
    match name.split_once('_') {
        Some((letter, index)) => format!(
            "<i>{}</i><sub>{}</sub>",
            html::escaped(letter),
            html::escaped(&with_symbols(index))
        ),
        None => html::escaped(name),
    }
}

/// A number and the thing it counts.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{ending}")
}
