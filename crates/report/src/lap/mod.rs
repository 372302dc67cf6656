//! Reports of identified lap models.

mod curves;
mod response;
mod update;

pub use response::LapResponseReport;
pub use response::level_figure;
pub use update::LapUpdateReport;
pub use update::convergence_figure;

use bolted_joint_figures::html::{self, escaped};
use bolted_joint_files::Timestamp;

/// A page around finished sections.
pub(super) fn page(name: &str, what: &str, written: Timestamp, sections: &str) -> String {
    let name = escaped(name);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}: {what}</title>\n<style>\n{common}</style>\n</head>\n<body>\n<header>\n\
         <h1>{name}</h1>\n<p>{what} by {tool} {version}, <time>{written}</time>.</p>\n</header>\n\
         <main>\n{sections}</main>\n</body>\n</html>\n",
        common = html::STYLE,
        tool = bolted_joint_files::TOOL,
        version = bolted_joint_files::VERSION,
    )
}

/// A picture under its caption; both are finished.
pub(super) fn figure(id: &str, caption: &str, svg: &str) -> String {
    format!(
        "<figure id=\"{id}\">\n<figcaption>{caption}</figcaption>\n<div class=\"picture\">\n{svg}</div>\n</figure>\n"
    )
}

pub(super) fn warnings(warnings: &[String]) -> String {
    let each = warnings.iter();
    each.map(|warning| format!("<p class=\"warning\">{}</p>\n", escaped(warning)))
        .collect()
}
