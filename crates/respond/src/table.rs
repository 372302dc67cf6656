//! What a response is written as: numbers in named columns, one series for each lap and level.

use std::fmt::Write as _;

/// What a column holds, which tells how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Frequency, time or amplitude: drawn across.
    Across,
    /// Drawn upwards.
    Up,
    /// An angle in degrees, drawn below the amplitude before it.
    Phase,
    /// 1 where a motion persists, 0 where it does not.
    Stable,
    /// Written alone.
    Aside,
    /// A sum along the curve: its last value is told beside the curve's name.
    Total,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit, empty for a plain number.
    pub unit: &'static str,
    /// What it holds.
    pub role: Role,
}

/// The rows of one lap at one level.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name of the lap.
    pub lap: String,
    /// Amplitude that is held, of the load or of a motion; `None` where nothing is.
    pub level: Option<f64>,
    /// One number for each column; what does not exist is NaN.
    pub rows: Vec<Vec<f64>>,
    /// Largest relative displacement of each DOF, m and rad; zero in linear responses, which scale.
    pub largest: Vec<f64>,
}

/// A response.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseTable {
    /// Unit of the levels.
    pub level_unit: &'static str,
    /// Columns after lap and level.
    pub columns: Vec<Column>,
    /// By lap, then by level.
    pub series: Vec<Series>,
}

impl ResponseTable {
    /// As CSV: a line of names with units in brackets, then the rows of all series.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = "lap".to_owned();
        let has_level = self.series.iter().any(|series| series.level.is_some());
        if has_level {
            let _ = write!(text, ",level [{}]", self.level_unit);
        }
        for column in &self.columns {
            let _ = write!(text, ",{}", column.heading());
        }
        text.push('\n');
        for series in &self.series {
            let lap = quoted(&series.lap);
            for row in &series.rows {
                text.push_str(&lap);
                if has_level {
                    text.push(',');
                    push(series.level.unwrap_or(f64::NAN), &mut text);
                }
                for &number in row {
                    text.push(',');
                    push(number, &mut text);
                }
                text.push('\n');
            }
        }
        text
    }
}

impl Column {
    /// Its name, with its unit in brackets.
    fn heading(&self) -> String {
        match self.unit {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}

/// Rows under these columns as CSV.
pub(super) fn csv(columns: &[Column], rows: &[Vec<f64>]) -> String {
    let headings: Vec<String> = columns
        .iter()
        .map(|column| quoted(&column.heading()))
        .collect();
    let mut text = headings.join(",");
    text.push('\n');
    for row in rows {
        for (place, &number) in row.iter().enumerate() {
            if place > 0 {
                text.push(',');
            }
            push(number, &mut text);
        }
        text.push('\n');
    }
    text
}

/// A number in the fewest digits that give it back; nothing where there is none.
fn push(number: f64, text: &mut String) {
    let size = number.abs();
    if number.is_nan() {
        return;
    }
    let _ = if size == 0.0 || (1e-4..1e6).contains(&size) {
        write!(text, "{number}")
    } else {
        write!(text, "{number:e}")
    };
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_and_what_is_missing_is_empty() {
        let table = ResponseTable {
            level_unit: "N",
            columns: vec![Column {
                name: "frequency".to_owned(),
                unit: "Hz",
                role: Role::Across,
            }],
            series: vec![Series {
                lap: "M8, \"loose\"".to_owned(),
                level: Some(1.5),
                rows: vec![vec![2e-7], vec![f64::NAN]],
                largest: vec![0.0],
            }],
        };
        assert_eq!(
            table.to_csv(),
            "lap,level [N],frequency [Hz]\n\"M8, \"\"loose\"\"\",1.5,2e-7\n\"M8, \"\"loose\"\"\",1.5,\n"
        );
    }
}
