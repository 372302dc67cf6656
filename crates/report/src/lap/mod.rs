//! Reports of identified lap models.

mod curves;
mod response;
mod update;

pub use response::LapResponseReport;
pub use response::level_figure;
pub use update::LapUpdateReport;
pub use update::convergence_figure;

use bolted_joint_figures::html::escaped;

pub(super) fn warnings(warnings: &[String]) -> String {
    let each = warnings.iter();
    each.map(|warning| format!("<p class=\"warning\">{}</p>\n", escaped(warning)))
        .collect()
}
