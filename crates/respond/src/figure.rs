//! The picture of a response: a panel for each lap and quantity, or one for all laps where there is one level.

use bolted_joint_figures::{Drawn, ResponseCurve, ResponseFigure, ResponsePanel, Scale};
use bolted_joint_files::number;

use super::study::{RespondStudy, Test};
use super::table::{Column, ResponseTable, Role, Series};

/// Significant digits of a total beside a curve's name.
const DIGITS: usize = 4;

impl RespondStudy {
    /// The response as a picture, and the same for a page; `None` if there is nothing that can be drawn.
    #[must_use]
    pub fn figure(&self, table: &ResponseTable) -> Option<Drawn> {
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
        let total = place(Role::Total);
        let curve = |name: String, series: &Series, up: Up| ResponseCurve {
            name: match total.zip(series.rows.last()) {
                Some((total, last)) => {
                    let Column { name: of, unit, .. } = &table.columns[total];
                    format!("{name}: {of} {} {unit}", number(last[total], DIGITS))
                }
                None => name,
            },
            points: series
                .rows
                .iter()
                .map(|row| (row[across], up.of(row)))
                .collect(),
            is_dashed: stable.map_or_else(Vec::new, |stable| {
                series.rows.iter().map(|row| row[stable] == 0.0).collect()
            }),
        };
        let ups = ups(&table.columns);
        let mut panels: Vec<(usize, ResponsePanel)> = Vec::new();
        for up in ups.iter().copied() {
            let Up { column, kind } = up;
            let is_logarithmic = self.is_logarithmic
                && !is_history
                && !is_loop
                && table.columns[column].name != "frequency"
                && table.columns[column].name != "damping ratio";
            let panel = |title: String, curves| ResponsePanel {
                title,
                across: (
                    label(across),
                    scale(is_over_amplitude && self.is_logarithmic),
                ),
                up: match kind {
                    Kind::Value => (label(column), scale(is_logarithmic)),
                    Kind::Phase | Kind::PhaseOfParts => ("phase, °".to_owned(), Scale::Phase),
                },
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
                        Some(level) => {
                            format!("{}, {} {}", series.lap, short(level), table.level_unit)
                        }
                        None => series.lap.clone(),
                    };
                    panels.push((0, panel(title, vec![curve(String::new(), series, up)])));
                }
            } else if is_single {
                let curves = table.series.iter();
                let curves = curves.map(|series| curve(series.lap.clone(), series, up));
                panels.push((0, panel(String::new(), curves.collect())));
            } else {
                for (place, group) in groups.into_iter().enumerate() {
                    let named = |series: &Series| {
                        let level = series.level.unwrap_or(f64::NAN);
                        curve(format!("{} {}", short(level), table.level_unit), series, up)
                    };
                    let title = match kind {
                        Kind::Value => group[0].lap.clone(),
                        Kind::Phase | Kind::PhaseOfParts => String::new(),
                    };
                    panels.push((place, panel(title, group.iter().map(named).collect())));
                }
            }
        }
        // A phase stands below its amplitude.
        panels.sort_by_key(|(lap, _)| *lap);
        ResponseFigure {
            title: &self.name,
            note: match total {
                Some(_) => Some("heat: of one cycle"),
                None => stable.map(|_| "dashed: unstable"),
            },
            panels: panels.into_iter().map(|(_, panel)| panel).collect(),
        }
        .drawn()
    }
}

/// What is drawn upwards.
#[derive(Clone, Copy)]
struct Up {
    column: usize,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    /// The column itself.
    Value,
    /// The column itself, an angle in degrees.
    Phase,
    /// The angle of a complex number, whose real part is in the column, whose imaginary part is in the next.
    PhaseOfParts,
}

impl Up {
    fn of(self, row: &[f64]) -> f64 {
        match self.kind {
            Kind::Value | Kind::Phase => row[self.column],
            Kind::PhaseOfParts => row[self.column + 1].atan2(row[self.column]).to_degrees(),
        }
    }
}

/// Amplitudes and phases, one after another; a modulus is followed by its real and its imaginary part.
fn ups(columns: &[Column]) -> Vec<Up> {
    let has_parts = |n: usize| {
        let ends = |place: usize, end| {
            let column: Option<&Column> = columns.get(place);
            column.is_some_and(|column| column.name.ends_with(end))
        };
        ends(n, " modulus") && ends(n + 1, " real") && ends(n + 2, " imaginary")
    };
    let each = columns.iter().enumerate().flat_map(|(n, column)| {
        let up = |column, kind| Some(Up { column, kind });
        match column.role {
            Role::Up if has_parts(n) => [up(n, Kind::Value), up(n + 1, Kind::PhaseOfParts)],
            Role::Up => [up(n, Kind::Value), None],
            Role::Phase => [up(n, Kind::Phase), None],
            Role::Across | Role::Stable | Role::Aside | Role::Total => [None, None],
        }
    });
    each.flatten().collect()
}

/// A level as people write it: small and large ones by a power of ten.
fn short(level: f64) -> String {
    match level.abs() {
        size if size == 0.0 || (1e-4..1e7).contains(&size) => level.to_string(),
        _ => format!("{level:e}"),
    }
}
