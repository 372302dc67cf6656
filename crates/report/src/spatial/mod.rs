//! The report of a joint in space: forty-two numbers in blocks, what they say of the joint, and how well the data tell them.

mod axes;
mod consistency;
mod functions;
mod matrices;
mod numbers;
mod set_up;

pub use functions::spatial_figure;

use bolted_joint_export::provenance;
use bolted_joint_figures::html::{escaped, percent, shown};
use bolted_joint_files::Timestamp;
use bolted_joint_spatial::{Level, Misfit, SideConsistency, SpatialIdentification, SpatialStudy};

use super::page::{counted, page};

/// The report of an identification in space.
#[derive(Debug, Clone, Copy)]
pub struct SpatialReport<'a> {
    /// What was asked for.
    pub study: &'a SpatialStudy,
    /// What was found.
    pub found: &'a SpatialIdentification,
    /// How rigidly the interfaces move.
    pub consistency: &'a [SideConsistency],
    /// Sensors and impacts that do not fit the others.
    pub misfits: &'a [Misfit],
    /// When the report was written.
    pub written: Timestamp,
}

impl SpatialReport<'_> {
    /// The page as an HTML document, without any reference to the network.
    #[must_use]
    pub fn to_html(&self) -> String {
        let origin = self.found.joint_file(self.study).provenance;
        let origin = origin.map_or_else(String::new, |origin| provenance(&origin));
        let motions = self.study.motions();
        let sections = [
            self.summary(),
            matrices::section(self.found, motions),
            match motions.are_all() {
                true => axes::section(self.found),
                // a plane has no axes to be found
                false => String::new(),
            },
            consistency::section(self),
            set_up::section(self.found),
            functions::section(self.found),
            numbers::section(self.found),
            format!("<h2>Provenance</h2>\n{origin}"),
        ]
        .concat();
        page(
            &self.study.name,
            &format!("identification of a joint {}", self.study.whereabouts()),
            self.written,
            &sections,
        )
    }

    /// The result in a few sentences, and what to beware of.
    fn summary(&self) -> String {
        let found = self.found;
        let all = found.unknowns.len();
        let determined = found.unknowns.iter().filter(|one| one.is_determined);
        let determined = match all - determined.count() {
            0 => format!("the data determine all {all} numbers of its model"),
            open => format!("the data do not determine {open} of the {all} numbers of its model"),
        };
        let mut html = format!(
            "<p>Model <i>{}</i>, from {} of the assembly at {}: the computed functions are within {} r.m.s. of the measured \
             ones; {determined}. Starts that came to the same minimum: {} of {}.</p>\n",
            escaped(&self.study.model),
            counted(found.functions, "function"),
            counted(found.lines, "line"),
            percent(found.relative_rms),
            found.starts[1],
            found.starts[0],
        );
        if let Some(chi) = found.reduced_chi_squared {
            html += &format!(
                "<p>χ² over degrees of freedom is {}: 1 where the noise {} explains the residuals.</p>\n",
                shown(chi, 3),
                match self.study.level {
                    Level::OfCoherence => "that coherence tells",
                    Level::Relative(_) | Level::OfResiduals => "that is stated",
                }
            );
        }
        if let Some(substructures) = &found.substructures {
            html += &format!(
                "<p>Noise of the substructures' functions is taken into account. It moves the assembly's functions by {} \
                 r.m.s.; {} at which it would move them too far {} left out.</p>\n",
                percent(substructures.moves),
                counted(substructures.lines_left_out, "line"),
                if substructures.lines_left_out == 1 {
                    "is"
                } else {
                    "are"
                },
            );
        }
        html += &match &found.free {
            Some(_) => "<p>The free estimate would feed energy. The joint is the passive one that is nearest to it in the metric \
                        of its information; intervals are about the free one. Both stand side by side under \
                        <a href=\"#numbers\">all numbers</a>.</p>\n"
                .to_owned(),
            None => "<p>The free estimate is passive.</p>\n".to_owned(),
        };
        let warning = |text: &String| format!("<p class=\"warning\">{}</p>\n", escaped(text));
        let misfits = self
            .misfits
            .iter()
            .map(|misfit| warning(&misfit.to_string()))
            .chain(found.warnings.iter().map(warning));
        let reasons = found.reasons_against.iter();
        let reasons = reasons.map(|reason| warning(&format!("Not to be relied on: {reason}.")));
        let noise = found.overstated_noise(self.study);
        let noise = noise.iter().map(warning);
        html + &misfits.chain(noise).chain(reasons).collect::<String>()
    }
}

/// A name with its index set low: `k_x_ry` becomes k with index x,ry.
fn symbol(name: &str) -> String {
    match name.split_once('_') {
        Some((letter, index)) => format!(
            "<i>{}</i><sub>{}</sub>",
            escaped(letter),
            escaped(&index.replace('_', ","))
        ),
        None => escaped(name),
    }
}

/// A power of a thousand that makes numbers up to this size short, and the unit with it.
fn scaled(largest: f64, unit: &str) -> (i32, String) {
    let power = match largest > 0.0 {
        true => 3 * (largest.log10() / 3.0).floor() as i32,
        false => 0,
    };
    match power {
        0 => (0, unit.to_owned()),
        power => {
            let digits = power.to_string().replace('-', "−");
            (power, format!("10<sup>{digits}</sup> {unit}"))
        }
    }
}
