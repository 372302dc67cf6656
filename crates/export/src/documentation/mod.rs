//! The FMU's documentation: one page that needs no network, and the licences.

mod assembly;
mod curves;
mod licences;
mod model;
mod origin;
mod over_preload;
mod parameters;
mod running;
mod variables;

use bolted_joint_interface::Interface as Declared;

use super::description::generation_tool;
use super::fmu::LapFacts;
use super::{FmiVersion, Interface, Timestamp};
use bolted_joint_figures::html::{self, escaped};
use bolted_joint_joint::{JointFile, OverPreload, Passivity};

pub(super) use assembly::{AssemblyPage, html as assembly_html};
pub use curves::joint_curves;
pub(super) use licences::licences;

/// What the page tells.
pub(super) struct Page<'a> {
    pub(super) file: &'a JointFile,
    pub(super) interface: Interface,
    pub(super) version: FmiVersion,
    pub(super) declared: &'a Declared,
    /// `None` for the element.
    pub(super) lap: Option<&'a LapFacts>,
    pub(super) passivity: &'a Passivity,
    /// How closely the reference run is to be met; `None` if there is none.
    pub(super) reference_tolerance: Option<f64>,
    /// The table of a joint over the preload where the preload is an input; `file` is then that joint at its nominal preload.
    pub(super) over_preload: Option<&'a OverPreload>,
    /// Whether the FMU also has the joint over the preload that it was taken from.
    pub(super) has_table_beside: bool,
    pub(super) token: &'a str,
    pub(super) date: Timestamp,
}

/// The page `documentation/index.html`.
pub(super) fn html(page: &Page<'_>) -> String {
    let sections = [
        model::section(page),
        parameters::section(page),
        over_preload::section(page),
        curves::section(page),
        running::section(page),
        variables::section(page.declared),
        origin::section(page),
        licences::section(),
    ]
    .concat();
    whole(
        &page.file.name,
        page.interface.summary(),
        &sections,
        (page.version, page.token, page.date),
    )
}

/// The page with these sections.
fn whole(
    name: &str,
    summary: &str,
    sections: &str,
    (version, token, date): (FmiVersion, &str, Timestamp),
) -> String {
    let name = escaped(name);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}</title>\n<style>\n{css}</style>\n</head>\n<body>\n<header>\n<h1>{name}</h1>\n\
         <p>{summary}. {version} for Co-Simulation and Model Exchange, written by {tool} on <time>{date}</time>.</p>\n</header>\n\
         <main>\n{sections}</main>\n<footer><p>{token_name} <code>{token}</code></p></footer>\n\
         </body>\n</html>\n",
        css = html::STYLE,
        summary = html::capitalised(summary),
        tool = escaped(&generation_tool()),
        token_name = match version {
            FmiVersion::V2 => "GUID",
            FmiVersion::V3 => "Instantiation token",
        },
    )
}
