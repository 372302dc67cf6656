//! Tables of numbers that are no functions: told by the names of their columns, with the range of each.

use std::fmt;
use std::path::Path;

use bolted_joint_files::Decimal;
use bolted_joint_files::text_file::{self, TextFileError};
use bolted_joint_files::text_table::{Cells, rows, separator};
use serde_json::json;

use crate::Shown;
use crate::shown::short;

/// Columns that are listed at most.
const LISTED: usize = 20;

/// What a table is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableKind {
    /// Stepped sines at a level.
    Sine,
    /// Frequencies and damping over the amplitude.
    Backbone,
    /// A free decay.
    Decay,
    /// Values over time, such as a reference run of an FMU.
    History,
    /// What `respond` writes of laps.
    Responses,
    /// What `respond` writes of assemblies, but histories.
    OfAssembly,
    /// What `predict --matrix-csv` writes.
    Matrices,
    /// What `predict --damping-csv` writes.
    Damping,
    /// Heights along a surface.
    Profile,
    /// Pressures in an interface.
    Pressures,
}

impl TableKind {
    /// What the table that begins so is for; `None` where its columns do not tell.
    pub(crate) fn told_by(beginning: &str) -> Option<Self> {
        let names = names(beginning)?;
        let has = |wanted: &[&str]| names.iter().any(|name| wanted.contains(&name.as_str()));
        let begins = |wanted: &str| names.iter().any(|name| name.starts_with(wanted));
        let has_frequency = has(&["frequency_hz", "omega_rad_per_s"]);
        let has_response = has(&[
            "displacement_m",
            "velocity_m_per_s",
            "acceleration_m_per_s2",
        ]);
        if has_frequency && has_response {
            return Some(match has(&["phase_rad", "phase_deg"]) {
                true => Self::Sine,
                false => Self::Backbone,
            });
        }
        if has(&["time_s"]) && has_response {
            Some(Self::Decay)
        } else if ["time", "time [s]"].contains(&names[0].as_str()) {
            Some(Self::History)
        } else if names[0] == "lap" {
            Some(Self::Responses)
        } else if names[..names.len().min(2)] == ["matrix", "row"] {
            Some(Self::Matrices)
        } else if names[0] == "mode" && has(&["damping ratio"]) {
            Some(Self::Damping)
        } else if is_of_assembly(&names) {
            Some(Self::OfAssembly)
        } else if begins("distance") && begins("height") {
            Some(Self::Profile)
        } else if begins("pressure") && begins("area") {
            Some(Self::Pressures)
        } else {
            None
        }
    }

    /// Who takes it.
    pub(crate) fn taken_by(self) -> Option<&'static str> {
        match self {
            Self::Sine => Some("[[sine]] of a study of method \"lap-response\""),
            Self::Backbone => Some("[[backbone]] of a study of method \"lap-response\""),
            Self::Decay => Some("[[decay]] of a study of method \"lap-response\""),
            Self::Profile => Some("surface.profiles of a study for `predict`"),
            Self::Pressures => Some("interface.field of a study for `predict`"),
            Self::History | Self::Responses | Self::OfAssembly | Self::Matrices | Self::Damping => {
                None
            }
        }
    }
}

impl fmt::Display for TableKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sine => "a table of stepped sines (CSV)",
            Self::Backbone => "a table of a backbone (CSV)",
            Self::Decay => "a table of a free decay (CSV)",
            Self::History => "a table over time (CSV)",
            Self::Responses => "a table of responses of laps (CSV)",
            Self::OfAssembly => "a table of responses of an assembly (CSV)",
            Self::Matrices => "a table of an interface's matrices (CSV)",
            Self::Damping => "a table of a layered beam's damping (CSV)",
            Self::Profile => "a surface profile (CSV)",
            Self::Pressures => "a pressure field (CSV)",
        })
    }
}

/// Whether these are the columns of a backbone, of modes or of a response at outputs that have names in place of nodes.
fn is_of_assembly(names: &[String]) -> bool {
    let [across, others @ ..] = names else {
        return false;
    };
    let is_of_output = |name: &String| {
        let is_function = name.contains('/') && !name.contains(" receptance ");
        let parts = [" real [", " imaginary [", " largest ["];
        !is_function && !name.contains(':') && parts.iter().any(|part| name.contains(part))
    };
    match across.as_str() {
        "frequency [hz]" if others == ["damping ratio"] => true,
        "frequency [hz]" => !others.is_empty() && others.iter().all(is_of_output),
        across => {
            across.starts_with("amplitude of ") && others == ["frequency [hz]", "damping ratio"]
        }
    }
}

/// The names of the columns, in small letters.
fn names(text: &str) -> Option<Vec<String>> {
    let (_, header) = rows(text).next()?;
    let mut cells = Cells::separated_by(separator(header));
    Some(
        cells
            .names(header)
            .iter()
            .map(|name| name.to_lowercase())
            .collect(),
    )
}

/// Its rows, and the range of each column of numbers.
pub(crate) fn shown(path: &Path, kind: TableKind) -> Result<Shown, TextFileError> {
    let text = text_file::read(path, "a table (CSV)")?;
    let name = kind.to_string();
    let mut shown = Shown::of(name.trim_start_matches("a "));
    let mut lines = rows(&text);
    let header = lines.next().map_or("", |(_, header)| header);
    let separator = separator(header);
    let mut cells = Cells::separated_by(separator);
    let names: Vec<String> = cells.names(header).into_iter().map(str::to_owned).collect();
    let mut ranges: Vec<Option<[f64; 2]>> = vec![None; names.len()];
    let mut decimal = Decimal::beside(separator);
    let mut count = 0;
    for (_, line) in lines {
        count += 1;
        for (range, cell) in ranges.iter_mut().zip(cells.of(line)) {
            let Some((value, used)) = decimal.parse(cell).filter(|(own, _)| own.is_finite()) else {
                continue;
            };
            decimal = used;
            let [low, high] = range.unwrap_or([value, value]);
            *range = Some([low.min(value), high.max(value)]);
        }
    }
    shown.fact("rows", count.to_string());
    let told = names.iter().zip(&ranges).map(|(name, range)| match range {
        Some([low, high]) => format!("{name} from {} to {}", short(*low, 5), short(*high, 5)),
        None => name.clone(),
    });
    shown.facts_of_some("columns", told, LISTED);
    if let Some(study) = kind.taken_by() {
        shown.fact("taken by", study);
    }
    shown.detail("rows", count);
    let columns = names.iter().zip(&ranges);
    let columns = columns.map(|(name, range)| json!({ "name": name, "range": range }));
    shown.detail("columns", columns.collect::<Vec<_>>());
    Ok(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_told_by_their_columns() {
        let sine = "# a run\nfrequency_hz;force_n;displacement_m;phase_rad\n";
        for (text, expected) in [
            (sine, Some(TableKind::Sine)),
            (
                "omega_rad_per_s,velocity_m_per_s\n",
                Some(TableKind::Backbone),
            ),
            ("time_s,acceleration_m_per_s2\n", Some(TableKind::Decay)),
            ("\"time\",\"b.F\"\n", Some(TableKind::History)),
            ("lap,level [N]\n", Some(TableKind::Responses)),
            ("time [s],push [N],tip [m]\n", Some(TableKind::History)),
            (
                "frequency [Hz],tip/push receptance real [m/N]\n",
                Some(TableKind::OfAssembly),
            ),
            (
                "frequency [Hz],tip real [m],tip largest [m]\n",
                Some(TableKind::OfAssembly),
            ),
            (
                "frequency [Hz],damping ratio\n",
                Some(TableKind::OfAssembly),
            ),
            (
                "amplitude of tip [m],frequency [Hz],damping ratio\n",
                Some(TableKind::OfAssembly),
            ),
            ("frequency [Hz],2:+Y/1:+Y receptance real [m/N]\n", None),
            ("# mine\nmatrix,row,x\n", Some(TableKind::Matrices)),
            (
                "mode,frequency [Hz],damping ratio\n",
                Some(TableKind::Damping),
            ),
            ("distance_um,height_um\n", Some(TableKind::Profile)),
            (
                "node,x_mm,y_mm,area_mm2,pressure_MPa\n",
                Some(TableKind::Pressures),
            ),
            ("frequency [Hz],1:+Y/1:+Y real\n", None),
            ("1,2\n", None),
            ("", None),
        ] {
            assert_eq!(TableKind::told_by(text), expected, "{text}");
        }
    }
}
