//! The picture of a response: a panel for each lap and quantity, or one for all laps where there is one level.

use bolted_joint_figures::{ResponseCurve, ResponseFigure, ResponsePanel, Scale};

use super::study::{RespondStudy, Test};
use super::table::{ResponseTable, Role, Series};

impl RespondStudy {
    /// The response as a picture (SVG); `None` if there is nothing that can be drawn.
    #[must_use]
    pub fn figure(&self, table: &ResponseTable) -> Option<String> {
        let is_history = matches!(
            self.test,
            Test::Sweep { .. } | Test::Dwell { .. } | Test::FreeDecay { .. }
        );
        let is_loop = matches!(self.test, Test::Hysteresis { .. });
        let place = |role| table.columns.iter().position(|column| column.role == role);
        let (across, stable) = (place(Role::Across)?, place(Role::Stable));
        let label = |n: usize| {
            let column = &table.columns[n];
            match column.unit {
                "" => column.name.clone(),
                unit => format!("{}, {unit}", column.name),
            }
        };
        let scale = |is_logarithmic| match is_logarithmic {
            true => Scale::Logarithmic,
            false => Scale::Linear,
        };
        let is_over_amplitude = matches!(
            self.test,
            Test::Backbone { .. } | Test::PhaseResonance { .. }
        );
        let curve = |name: String, series: &Series, up: usize| ResponseCurve {
            name,
            points: series
                .rows
                .iter()
                .map(|row| (row[across], row[up]))
                .collect(),
            is_dashed: stable.map_or_else(Vec::new, |stable| {
                series.rows.iter().map(|row| row[stable] == 0.0).collect()
            }),
        };
        let ups = (0..table.columns.len()).filter(|&n| table.columns[n].role == Role::Up);
        let mut panels = Vec::new();
        for up in ups {
            let is_logarithmic = self.is_logarithmic
                && !is_history
                && !is_loop
                && table.columns[up].name != "frequency"
                && table.columns[up].name != "damping ratio";
            let panel = |title: String, curves| ResponsePanel {
                title,
                across: (
                    label(across),
                    scale(is_over_amplitude && self.is_logarithmic),
                ),
                up: (label(up), scale(is_logarithmic)),
                curves,
            };
            let groups: Vec<&[Series]> = table
                .series
                .chunk_by(|one, other| one.lap == other.lap)
                .collect();
            let is_single = groups.iter().all(|group| group.len() == 1);
            if is_history {
                for series in &table.series {
                    let title = match series.level {
                        Some(level) => format!("{}, {level} {}", series.lap, table.level_unit),
                        None => series.lap.clone(),
                    };
                    panels.push(panel(title, vec![curve(String::new(), series, up)]));
                }
            } else if is_single {
                let curves = table.series.iter();
                let curves = curves.map(|series| curve(series.lap.clone(), series, up));
                panels.push(panel(String::new(), curves.collect()));
            } else {
                for group in groups {
                    let named = |series: &Series| {
                        let level = series.level.unwrap_or(f64::NAN);
                        curve(format!("{level} {}", table.level_unit), series, up)
                    };
                    panels.push(panel(
                        group[0].lap.clone(),
                        group.iter().map(named).collect(),
                    ));
                }
            }
        }
        ResponseFigure {
            title: &self.name,
            note: stable.map(|_| "dashed: unstable"),
            panels,
        }
        .to_svg()
    }
}
