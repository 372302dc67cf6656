//! The report of a lap model identified from responses.

use std::f64::consts::TAU;

use bolted_joint_export::provenance;
use bolted_joint_figures::html::{
    above_the_best, beside, cell, columns, escaped, number_cell, shown, table, with_deviation,
};
use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_files::Timestamp;
use bolted_joint_lap::{LapResponse, LapResponseStudy, NoiseIs, SineLine, SineRun, Use};
use num_complex::Complex64;

use crate::page::functions::{self as function, Function};

/// The report of a lap model identified from responses.
#[derive(Debug, Clone, Copy)]
pub struct LapResponseReport<'a> {
    /// What was asked for.
    pub study: &'a LapResponseStudy,
    /// What was found.
    pub found: &'a LapResponse,
    /// What the reader should know before using the result.
    pub warnings: &'a [String],
    /// When the report was written.
    pub written: Timestamp,
}

impl LapResponseReport<'_> {
    /// The page as an HTML document.
    #[must_use]
    pub fn to_html(&self) -> String {
        let sections = [
            super::warnings(self.warnings),
            self.parameters(),
            self.resonances(),
            super::curves::section(self.found),
            self.models(),
            self.runs(),
            format!(
                "<h2>Provenance</h2>\n{}",
                provenance(&self.found.provenance)
            ),
        ]
        .concat();
        crate::page::page(
            &self.found.name,
            "lap model identified from responses at several levels",
            self.written,
            &sections,
        )
    }

    fn parameters(&self) -> String {
        let rows = self.found.estimates.iter().map(|estimate| {
            let deviation = estimate.standard_deviation;
            let [low, high] = estimate.interval_95;
            let values = match estimate.is_identified {
                true => [
                    number_cell(&with_deviation(estimate.value, deviation)),
                    number_cell(&format!(
                        "{} … {}",
                        beside(low, deviation),
                        beside(high, deviation)
                    )),
                ]
                .concat(),
                false => "<td colspan=\"2\">not identified</td>".to_owned(),
            };
            let free = match &self.found.free {
                Some(_) => number_cell(&beside(estimate.free_value, deviation)),
                None => String::new(),
            };
            format!(
                "<th scope=\"row\">{}</th>{}{values}{free}",
                escaped(estimate.unknown.symbol()),
                cell(&estimate.unknown.unit())
            )
        });
        let rows: Vec<String> = rows.collect();
        let mut header = vec!["", "Unit", "Estimate (std. dev.)", "95 % interval"];
        let free = self.found.free.as_ref().map_or_else(String::new, |free| {
            header.push("Free estimate");
            format!(
                "<p>The free estimate is active: χ² per degree of freedom {}, −2 ln L {} lower. The passive joint that fits best is \
                 the estimate, and is what the joint file holds. The intervals are about the free one, and reach to it.</p>\n",
                shown(free.reduced_chi_squared(), 4),
                shown(self.found.price, 3)
            )
        });
        let reduced = self.found.fit.reduced_chi_squared();
        let parts: Vec<String> = self
            .study
            .noise_by_kind()
            .into_iter()
            .map(|(kind, part)| format!("{} % of the {kind}", shown(100.0 * part, 3)))
            .collect();
        let noise = match self.study.noise_is() {
            NoiseIs::Stated => "stated",
            NoiseIs::OfRecords => "that of the records, and the intervals follow the residual",
            NoiseIs::Nominal => "nominal, and the intervals follow the residual",
        };
        let of = match parts.is_empty() {
            true => String::new(),
            false => format!(" of {}", parts.join(", ")),
        };
        let of_decays = self.found.of_decays();
        let of_decays = of_decays.map_or_else(String::new, |own| format!(" {}", escaped(&own)));
        format!(
            "<h2>Identified parameters</h2>\n{}{free}<p>Terms that depend on amplitude: {}. χ² per degree of freedom {} with a noise{of} \
             ({noise}); {} of {} starts agree.{of_decays}</p>\n",
            table(&header, &rows),
            escaped(&self.found.model.terms.to_string()),
            shown(reduced, 4),
            self.found.starts.1,
            self.found.starts.0,
        )
    }

    fn resonances(&self) -> String {
        let without = self.found.without_interval().into_iter();
        let without = without.map(|reason| format!("<p>{}</p>\n", escaped(&reason)));
        let without: String = without.collect();
        if self.found.predictions.is_empty() {
            return without;
        }
        let signed = |value: String| value.replace('-', "−");
        let rows = self.found.predictions.iter().map(|row| {
            let optional = |value: Option<String>| value.unwrap_or_else(|| "none".to_owned());
            [
                cell(&escaped(&self.found.named(row))),
                cell(if row.left_out {
                    "<b>left out</b>"
                } else {
                    "fitted"
                }),
                number_cell(&shown(row.measured.force_n, 3)),
                number_cell(&format!("{:.3}", row.measured.frequency_hz)),
                number_cell(&optional(
                    row.predicted.map(|at| format!("{:.3}", at.frequency_hz)),
                )),
                number_cell(&optional(row.interval_95.map(|at| {
                    let [low, high] = at.frequency_hz;
                    format!("{low:.3} … {high:.3}")
                }))),
                number_cell(&optional(
                    row.frequency_error_hz()
                        .map(|error| signed(format!("{error:+.3}"))),
                )),
                number_cell(&shown(1e6 * row.measured.displacement_m, 4)),
                number_cell(&optional(
                    row.predicted.map(|at| shown(1e6 * at.displacement_m, 4)),
                )),
                number_cell(&optional(row.interval_95.map(|at| {
                    let [low, high] = at.displacement_m.map(|m| shown(1e6 * m, 3));
                    format!("{low} … {high}")
                }))),
                number_cell(&optional(
                    row.amplitude_error()
                        .map(|error| signed(format!("{:+.1} %", 100.0 * error))),
                )),
            ]
            .concat()
        });
        let rows: Vec<String> = rows.collect();
        format!(
            "<h2>Resonances</h2>\n<p>Where the displacement lags the force by 90° (of the bodies’ relative motion, driven on one and \
             seen on the other: leads by 90°): measured, and of the model at the force that was \
             measured there. Expected is what the unknowns’ deviations and the scatter of the fitted runs about the model leave open. \
             The last column is the error of the acceleration’s amplitude.</p>\n{}{without}{}",
            table(
                &columns(
                    "Run||Force, N|Measured, Hz|Model, Hz|Expected, 95 %|Error, Hz|Measured, µm|Model, µm|Expected, 95 %|Error"
                ),
                &rows
            ),
            super::curves::of_sines(self.found)
        )
    }

    fn models(&self) -> String {
        let rows = self.found.comparison.iter().map(|model| {
            [
                cell(&escaped(&model.terms.to_string())),
                number_cell(&model.unknowns.to_string()),
                number_cell(&shown(model.reduced_chi_squared, 4)),
                number_cell(&above_the_best(model.bic_difference)),
                number_cell(&match model.is_passive {
                    true => String::new(),
                    false => format!("{:.1}", model.price),
                }),
                cell(match model.terms == self.found.model.terms {
                    true => "used",
                    false => "",
                }),
            ]
            .concat()
        });
        let rows: Vec<String> = rows.collect();
        format!(
            "<h2>Models by likelihood</h2>\n{}",
            table(
                &[
                    "Terms",
                    "Unknowns",
                    "χ²/ν",
                    "BIC above the best",
                    "Price of passivity in −2 ln L",
                    ""
                ],
                &rows
            )
        )
    }

    fn runs(&self) -> String {
        if self.study.sines.is_empty() {
            return String::new();
        }
        let residuals = self.found.run_residuals(self.study);
        let runs = self.study.sines.iter().enumerate().map(|(place, run)| {
            let residual = residuals
                .iter()
                .find(|(name, ..)| *name == run.name && run.used_for == Use::Fit);
            let remark = residual.map_or_else(
                || "left out of the estimate".to_owned(),
                |(_, lines, rms)| {
                    format!(
                        "{lines} lines, residual of the receptance {} % r.m.s.",
                        shown(100.0 * rms, 3)
                    )
                },
            );
            run_figure(
                self.found,
                run,
                &format!("run-{place}"),
                &format!(": {remark}."),
            )
        });
        format!(
            "<h2>Runs</h2>\n<p>Receptance measured and regenerated at the measured amplitude of each line.</p>\n{}",
            runs.collect::<String>()
        )
    }
}

/// The receptance of one run over frequency, measured and regenerated.
fn run_figure(found: &LapResponse, run: &SineRun, id: &str, remark: &str) -> String {
    let mut lines: Vec<_> = run.lines.iter().zip(found.regenerated(run)).collect();
    // A run may have gone down.
    lines.sort_by(|(one, _), (other, _)| one.omega.total_cmp(&other.omega));
    let measured =
        |line: &SineLine| Complex64::from_polar(line.displacement_m / line.force_n, line.phase_rad);
    function::drawn(&Function {
        id,
        name: &run.name,
        unit: "m/N",
        remark,
        frequency_hz: &lines
            .iter()
            .map(|(line, _)| line.omega / TAU)
            .collect::<Vec<_>>(),
        measured: &lines
            .iter()
            .map(|(line, _)| measured(line))
            .collect::<Vec<_>>(),
        regenerated: &lines.iter().map(|(_, value)| *value).collect::<Vec<_>>(),
    })
}

/// Receptances regenerated of up to four runs, of the lowest to the highest level; without such runs frequencies over the
/// amplitude.
pub fn level_figure(study: &LapResponseStudy, found: &LapResponse) -> Option<String> {
    if study.sines.is_empty() {
        return super::curves::frequencies(&found.backbones);
    }
    let mut runs: Vec<&SineRun> = study.sines.iter().collect();
    runs.sort_by(|a, b| a.amplitude_m().total_cmp(&b.amplitude_m()));
    let stride = runs.len().div_ceil(4).max(1);
    let lines = runs.iter().step_by(stride).map(|run| {
        let regenerated = found.regenerated(run);
        let lines = run.lines.iter().zip(regenerated);
        let points = lines.map(|(line, value)| (line.omega / TAU, value.norm()));
        Line::curve(escaped(&run.name), points)
    });
    LineFigure {
        title: "Receptances of the identified model",
        across: ("frequency, Hz", Scale::Linear),
        up: ("receptance, m/N", Scale::Logarithmic),
        lines: lines.collect(),
    }
    .to_svg()
}
