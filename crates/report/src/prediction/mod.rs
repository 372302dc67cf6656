//! The report of a prediction: what was assumed, what follows, how well it is known, and what to measure first.

mod assumptions;
mod matrices;
mod parameters;
mod slip;
mod surfaces;

use super::lap::warnings;
use super::page::page;
use bolted_joint_export::provenance;
use bolted_joint_files::Timestamp;
use bolted_joint_predict::study::Prediction;

/// The report of a prediction.
#[derive(Debug, Clone, Copy)]
pub struct PredictionReport<'a> {
    /// What was predicted.
    pub found: &'a Prediction<'a>,
    /// What the reader should know before using the result.
    pub warnings: &'a [String],
    /// When the report was written.
    pub written: Timestamp,
}

impl PredictionReport<'_> {
    /// The page as an HTML document, without any reference to the network.
    #[must_use]
    pub fn to_html(&self) -> String {
        let found = self.found;
        let origin = found.joint_file().provenance;
        let origin = origin.map_or_else(String::new, |origin| provenance(&origin));
        let sections = [
            warnings(self.warnings),
            parameters::section(found),
            matrices::section(found),
            parameters::contributions(found),
            slip::section(found),
            matrices::pressure(found),
            surfaces::section(found),
            assumptions::section(found),
            format!("<h2>Provenance</h2>\n{origin}"),
        ]
        .concat();
        page(
            &found.study.name,
            "joint predicted from surfaces, materials and bolts",
            self.written,
            &sections,
        )
    }
}
