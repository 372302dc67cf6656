//! How well the joint fits, which joint model the data call for, and whether the joint is passive.

use super::parameters::place;
use super::{IdentificationReport, counted, over_torque};
use bolted_joint_figures::html::{
    above_the_best, capitalised, cell, escaped, number_cell, percent, quantity, shown, table,
};
use bolted_joint_identify::{JointEstimate, JointMatrices};
use bolted_joint_joint::JointFile;

/// The result in a few sentences, and what to beware of.
pub(super) fn summary(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    let found = report.found;
    let assemblies = report.assemblies();
    let functions: usize = assemblies.iter().map(|one| one.fits.len()).sum();
    let lines = assemblies.iter().map(|one| one.lines.frequency_hz.len());
    let lines: usize = lines.sum();
    let is_passive = files.iter().all(|file| file.passivity().is_passive());
    let verdict = match (files.len(), is_passive) {
        (1, true) => "the joint is passive",
        (1, false) => "the joint is active",
        (_, true) => "all joints are passive",
        (_, false) => "not all joints are passive",
    };
    let joints = &found.estimate.joints;
    let identified = || joints.iter().flat_map(|joint| &joint.covariance.identified);
    let determined = match identified().filter(|identified| !**identified).count() {
        0 => "the data determine every parameter".to_owned(),
        open => {
            let all = identified().count();
            format!("{open} of {all} parameters are not identified")
        }
    };
    let mut html = format!(
        "<p>From {} and {}: the regenerated functions are within {} r.m.s. of the measured ones; {determined}; \
         {verdict}.</p>\n",
        counted(functions, "function"),
        counted(lines, "line"),
        percent(found.relative_rms)
    );
    if !report.warnings.is_empty() {
        let items: String = report
            .warnings
            .iter()
            .map(|warning| format!("<li>{}</li>\n", escaped(&capitalised(warning))))
            .collect();
        html += &format!(
            "<div class=\"warning\"><b>Before using the result</b>\n<ul>\n{items}</ul></div>\n"
        );
    }
    html
}

pub(super) fn section(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    format!(
        "<h2>How well it fits</h2>\n{}{}{}{}",
        fit(report),
        choice(report),
        over_torque::choice(report),
        passivity(report, files)
    )
}

fn fit(report: &IdentificationReport<'_>) -> String {
    let found = report.found;
    let assessment = &found.estimate.assessment;
    let (tried, agreeing) = found.starts;
    let residual = percent(found.relative_rms);
    let typical = found
        .median_difference
        .map_or_else(|| "–".to_owned(), percent);
    let starts = format!("{agreeing} of {tried}");
    let lines = match found.estimate.lines_used {
        (used, measured) if used < measured => format!(
            "{used} of {measured}; at the others the noise of the structures’ functions moves what is computed too far"
        ),
        (_, measured) => format!("all {measured}"),
    };
    let chi_squared = match (found.reduced_chi_squared, assessment.noise_is_stated) {
        (Some(chi_squared), true) => format!(
            "{}, {} of its standard deviations from 1",
            shown(chi_squared, 4),
            shown(assessment.chi_squared_excess, 2)
        ),
        (Some(chi_squared), false) => format!(
            "{}, with the noise that coherence tells; no test, because coherence is an estimate itself: with <i>n</i> averages \
             <i>n</i>/(<i>n</i> − 2) is to be expected",
            shown(chi_squared, 4)
        ),
        (None, _) => {
            "no test: the study does not state the noise, its level follows from the residual"
                .to_owned()
        }
    };
    let mut rows = vec![
        row("Residual, r.m.s. of the receptance", &residual),
        row("Half of the values are within", &typical),
        row("Starts that led to this estimate", &starts),
        row("Lines that it rests on", &lines),
        row("χ² per degree of freedom", &chi_squared),
    ];
    if assessment.line_correlation.is_finite() {
        rows.push(row(
            "Correlation of the residuals of neighbouring lines",
            &format!(
                "{}, {} of its standard deviations from 0",
                shown(assessment.line_correlation, 2),
                shown(assessment.line_correlation_excess, 2)
            ),
        ));
    }
    let verdict = match assessment.complaint() {
        None if assessment.is_exact => {
            "What the joint leaves of the measurement is rounding: the data are exact.".to_owned()
        }
        None if !assessment.has_power => {
            "There are too few lines to test whether the residual is noise.".to_owned()
        }
        None => "What the joint leaves of the measurement cannot be told from noise.".to_owned(),
        Some(complaint) => format!(
            "What the joint leaves of the measurement is not noise: {}. Either the joint model or the substructures do not fit, \
             or every start ended in a local minimum.",
            escaped(&complaint)
        ),
    };
    let class = if assessment.fits() {
        ""
    } else {
        " class=\"warning\""
    };
    let about = found
        .about_the_residual()
        .map(|about| format!("<p>{}</p>\n", escaped(&about)))
        .unwrap_or_default();
    format!("{}<p{class}>{verdict}</p>\n{about}", bare_table(&rows))
}

fn row(name: &str, html: &str) -> String {
    format!("<th scope=\"row\">{name}</th>{}", cell(html))
}

fn bare_table(rows: &[String]) -> String {
    table(&[], rows).replace("<thead><tr></tr></thead>\n", "")
}

/// One of several ways to see the data, which are compared by BIC.
pub(super) struct Compared<'a> {
    pub(super) name: &'a str,
    pub(super) unknowns: usize,
    pub(super) bic_difference: f64,
    pub(super) reduced_chi_squared: Option<f64>,
    pub(super) adequate: bool,
    pub(super) is_used: bool,
    pub(super) is_recommended: bool,
}

impl Compared<'_> {
    /// Its row below [`COMPARED`].
    pub(super) fn row(&self, any_is_adequate: bool) -> String {
        let recommended = match any_is_adequate {
            true => "recommended",
            false => "comes closest",
        };
        let remarks = [(self.is_used, "used"), (self.is_recommended, recommended)];
        let remarks = remarks
            .into_iter()
            .filter_map(|(is, word)| is.then_some(word));
        let chi_squared = self.reduced_chi_squared.map(|chi| shown(chi, 4));
        let leaves = match self.adequate {
            true => "noise",
            false => "more than noise",
        };
        [
            cell(self.name),
            number_cell(&self.unknowns.to_string()),
            number_cell(&above_the_best(self.bic_difference)),
            number_cell(chi_squared.as_deref().unwrap_or("–")),
            cell(leaves),
            cell(&remarks.collect::<Vec<_>>().join(", ")),
        ]
        .concat()
    }
}

/// Headings of what is compared, after that of the first column.
pub(super) const COMPARED: [&str; 5] = ["Unknowns", "BIC", "χ²/ν", "Leaves", ""];

fn choice(report: &IdentificationReport<'_>) -> String {
    if let Some(reason) = report.study.models_not_compared() {
        return format!(
            "<h3>Choice of the joint model</h3>\n<p>The joint models are not compared: {}.</p>\n",
            escaped(&reason)
        );
    }
    let Some(choice) = report.found.estimate.model_choice() else {
        return String::new();
    };
    let used = report.found.model;
    let rows: Vec<String> = choice
        .models
        .iter()
        .map(|fit| {
            Compared {
                name: &fit.model.to_string(),
                unknowns: fit.unknowns,
                bic_difference: fit.bic_difference,
                reduced_chi_squared: fit.reduced_chi_squared,
                adequate: fit.adequate,
                is_used: fit.model == used,
                is_recommended: fit.model == choice.recommended,
            }
            .row(choice.any_is_adequate)
        })
        .collect();
    let advice = if !choice.any_is_adequate {
        "No joint model leaves noise alone.".to_owned()
    } else if choice.recommended == used {
        "The model used is the simplest adequate one.".to_owned()
    } else {
        format!(
            "The model “{}” is the simplest adequate one: consider it instead of “{used}”.",
            choice.recommended
        )
    };
    format!(
        "<h3>Choice of the joint model</h3>\n{}<p>{advice} BIC is Schwarz's criterion, −2 ln <i>L</i> + <i>p</i> ln <i>n</i>, \
         less that of the best model; the lowest is best.</p>\n",
        table(&[&["Model"], &COMPARED[..]].concat(), &rows)
    )
}

fn passivity(report: &IdentificationReport<'_>, files: &[JointFile]) -> String {
    let found = report.found;
    let bolts = found.bolts.with_own_joint();
    let mut verdicts = String::new();
    for (joint, file) in files.iter().enumerate() {
        let bolt = bolts.get(joint).map(|bolt| format!("{}: ", escaped(bolt)));
        let bolt = bolt.unwrap_or_default();
        for matrix in &file.passivity().matrices {
            verdicts += &format!("<li>{bolt}{}</li>\n", escaped(&matrix.to_string()));
        }
    }
    let mut html = format!(
        "<h3>Passivity</h3>\n<p>A passive joint stores energy or takes it: its matrices are positive semidefinite.</p>\n\
         <ul>\n{verdicts}</ul>\n"
    );
    let joints = found.estimate.by_torque();
    let active: Vec<String> = joints
        .iter()
        .filter(|joint| joint.free_is_active())
        .map(|joint| place(joint))
        .collect();
    if active.is_empty() {
        html += "<p>The free estimate is passive already: free and passive estimate are the same.</p>\n";
        return html;
    }
    let tables = joints.iter().filter(|joint| joint.free != joint.bolts());
    html += &tables
        .map(|joint| free_and_passive(report, joint))
        .collect::<String>();
    html + &format!(
        "<p>The free estimate is active{}. The passive one, K = LLᵀ and C = LLᵀ with the same likelihood, is what the joint file \
         holds.</p>\n",
        active.join(" and")
    )
}

/// Both estimates of a joint.
fn free_and_passive(report: &IdentificationReport<'_>, joint: &JointEstimate) -> String {
    let covariance = &joint.covariance;
    let rows: Vec<String> = covariance
        .unknowns
        .iter()
        .zip(&covariance.identified)
        .map(|(unknown, identified)| {
            let value = |joints: &[JointMatrices]| match identified {
                true => number_cell(&shown(unknown.value(&joints[unknown.joint]), 5)),
                false => "<td class=\"open\">not identified</td>".to_owned(),
            };
            format!(
                "<th scope=\"row\">{}</th>{}{}{}",
                report.symbol(unknown),
                value(&joint.free),
                value(joint.bolts()),
                cell(unknown.unit)
            )
        })
        .collect();
    let heading = joint
        .torque_n_m
        .map(|torque| format!("<p>At {}:</p>\n", quantity(torque, "N·m")))
        .unwrap_or_default();
    format!(
        "{heading}{}",
        table(&["", "Free estimate", "Passive estimate", "Unit"], &rows)
    )
}
