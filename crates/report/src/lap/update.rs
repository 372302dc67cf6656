//! The report of a lap model updated from natural frequencies.

use bolted_joint_export::provenance;
use bolted_joint_figures::html::{
    self, beside, cell, columns, escaped, number, number_cell, table,
};
use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_files::Timestamp;
use bolted_joint_lap::{LapParameter, LapUpdate, TorqueUpdate};

/// The report of an updated lap model.
#[derive(Debug, Clone, Copy)]
pub struct LapUpdateReport<'a> {
    /// What was found.
    pub found: &'a LapUpdate,
    /// What the reader should know before using the result.
    pub warnings: &'a [String],
    /// When the report was written.
    pub written: Timestamp,
}

impl LapUpdateReport<'_> {
    /// The page as an HTML document.
    #[must_use]
    pub fn to_html(&self) -> String {
        let found = self.found;
        let sections = [
            super::warnings(self.warnings),
            self.parameters(),
            self.determined(),
            self.frequencies(),
            self.search(),
            format!("<h2>Provenance</h2>\n{}", provenance(&found.provenance)),
        ]
        .concat();
        crate::page::page(
            &found.name,
            "lap model updated from natural frequencies",
            self.written,
            &sections,
        )
    }

    /// What the frequencies determine by themselves.
    fn determined(&self) -> String {
        let rows = self.found.torques.iter().flat_map(|torque| {
            let found = &torque.identifiability;
            let pairs = found.combinations.iter().zip(&found.updated);
            pairs.map(|(combination, updated)| {
                let deviation = combination.standard_deviation;
                [
                    number_cell(&place(torque)),
                    cell(combination.formula),
                    number_cell(&deviation.map_or_else(
                        || number(combination.value),
                        |deviation| beside(combination.value, deviation),
                    )),
                    number_cell(&deviation.map_or_else(|| "not stated".to_owned(), number)),
                    number_cell(&number(*updated)),
                ]
                .concat()
            })
        });
        let rows: Vec<String> = rows.collect();
        format!(
            "<h2>What the frequencies determine</h2>\n<p>Two natural frequencies determine two ratios, whatever the bounds: \
             k/m = ω₁² and k<sub>12</sub>/m = (ω₂² − ω₁²)/2. They do not depend on c, c<sub>12</sub> and k<sub>N</sub>. A mass that is \
             stated makes both stiffnesses known. Where the last column differs, the bounds do not admit the measured frequencies.</p>\n{}",
            table(
                &columns("Torque, N·m|Ratio|Measured, 1/s²|± std. dev.|Updated model, 1/s²"),
                &rows
            )
        )
    }

    fn parameters(&self) -> String {
        let mut rows = Vec::new();
        for torque in &self.found.torques {
            for parameter in LapParameter::ALL {
                let knowledge = torque.knowledge(parameter);
                let shown = |value: f64| match knowledge.is_known() {
                    true => format!("<b>{}</b>", number(value)),
                    false => format!("<span class=\"faint\">({})</span>", number(value)),
                };
                rows.push(
                    [
                        number_cell(&place(torque)),
                        cell(parameter.symbol()),
                        number_cell(&shown(torque.solution.of(parameter))),
                        number_cell(&shown(torque.firefly.parameters.of(parameter))),
                        cell(parameter.unit()),
                        cell(knowledge.words()),
                    ]
                    .concat(),
                );
            }
        }
        format!(
            "<h2>Parameters</h2>\n<p>Values in brackets are not results: of all values that fit as well least squares have those \
             nearest to the prior, and the fireflies others, which depend on their seed.</p>\n{}",
            table(
                &columns("Torque, N·m||Least squares|Fireflies|Unit|What the frequencies say"),
                &rows
            )
        )
    }

    fn frequencies(&self) -> String {
        let mut rows = Vec::new();
        for torque in &self.found.torques {
            let updated = torque.frequencies(&torque.solution);
            let firefly = torque.frequencies(&torque.firefly.parameters);
            for (mode, &measured) in torque.data.omega_rad_per_s.iter().enumerate() {
                let error = |value: f64| {
                    format!("{:+.2} %", 100.0 * (value / measured - 1.0)).replace('-', "−")
                };
                rows.push(
                    [
                        number_cell(&place(torque)),
                        cell(&format!("ω<sub>{}</sub>", mode + 1)),
                        number_cell(&number(measured)),
                        number_cell(&number(updated[mode])),
                        number_cell(&error(updated[mode])),
                        number_cell(&number(firefly[mode])),
                        number_cell(&error(firefly[mode])),
                    ]
                    .concat(),
                );
            }
        }
        format!(
            "<h2>Frequencies</h2>\n{}",
            table(
                &columns("Torque, N·m||Measured, rad/s|Least squares|Error|Fireflies|Error"),
                &rows
            )
        )
    }

    /// How the fireflies converged.
    fn search(&self) -> String {
        let settings = &self.found.firefly;
        let picture = convergence(self.found).drawn().map_or_else(String::new, |drawn| {
            html::figure(
                "convergence",
                "<b>Convergence of the fireflies</b>: the lowest objective so far over the generations.",
                &drawn,
            )
        });
        let rows: Vec<String> = self
            .found
            .torques
            .iter()
            .map(|torque| {
                [
                    number_cell(&place(torque)),
                    number_cell(&number(torque.firefly.objective)),
                    number_cell(&number(torque.objective)),
                ]
                .concat()
            })
            .collect();
        format!(
            "<h2>Search</h2>\n<p>{} fireflies, {} generations, β<sub>0</sub> = {}, γ = {}, α = {} times {} from one generation to the \
             next, seed {}, in the normalised logarithms of the parameters.</p>\n{picture}{}",
            settings.population,
            settings.iterations,
            number(settings.attractiveness),
            number(settings.absorption),
            number(settings.step),
            number(settings.decay),
            settings.seed,
            table(
                &[
                    "Torque, N·m",
                    "Objective, fireflies",
                    "Objective, least squares"
                ],
                &rows
            )
        )
    }
}

fn place(torque: &TorqueUpdate) -> String {
    torque
        .data
        .torque_n_m
        .map_or_else(|| "–".to_owned(), number)
}

/// The lowest objective over the generations, at four torques at most; `None` if it was zero all along.
pub fn convergence_figure(found: &LapUpdate) -> Option<String> {
    convergence(found).to_svg()
}

fn convergence(found: &LapUpdate) -> LineFigure<'static> {
    let lines = found.torques.iter().take(4).map(|torque| {
        let history = torque.firefly.history.iter().enumerate();
        let name = torque.data.torque_n_m.map_or_else(
            || "objective".to_owned(),
            |torque| escaped(&format!("{torque} N·m")),
        );
        let above_zero = history.filter(|(_, objective)| **objective > 0.0);
        Line::curve(
            name,
            above_zero.map(|(generation, objective)| (generation as f64, *objective)),
        )
    });
    LineFigure {
        title: "Convergence of the fireflies",
        across: ("generation", Scale::Linear),
        up: ("objective", Scale::Logarithmic),
        lines: lines.collect(),
    }
}
