//! A measured profile: height over distance, evenly spaced.

use std::fmt::Write as _;
use std::path::Path;

use super::SurfaceError;
use crate::columns::{self, Column, LENGTHS};
use crate::number::{self, positive};

/// Heights of a surface along a straight line, at even steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    start_m: f64,
    step_m: f64,
    height_m: Vec<f64>,
}

/// How far a step may be from the mean step, part of it.
const EVEN: f64 = 0.05;
const FEWEST: usize = 3;
const STEP: &str = "a positive length";

impl Profile {
    /// A profile of heights (m) at `step_m` (m), beginning at distance zero.
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than three points, numbers that are not finite or a step that is not positive.
    pub fn new(step_m: f64, height_m: Vec<f64>) -> Result<Self, SurfaceError> {
        positive("the step", step_m, " m", STEP)?;
        check(&height_m)?;
        Ok(Self {
            start_m: 0.0,
            step_m,
            height_m,
        })
    }

    /// A profile of heights over distances (m), which must be evenly spaced: each step within 5 % of the mean one.
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than three points, numbers that are not finite, distances that do not grow or are uneven.
    pub fn from_points(distance_m: &[f64], height_m: Vec<f64>) -> Result<Self, SurfaceError> {
        let mean_m = check_points(distance_m, &height_m)?;
        let uneven = distance_m
            .windows(2)
            .position(|pair| ((pair[1] - pair[0]) / mean_m - 1.0).abs() > EVEN);
        match uneven {
            Some(before) => Err(SurfaceError::Uneven {
                point: before + 2,
                found_m: distance_m[before + 1] - distance_m[before],
                mean_m,
                percent: 100.0 * EVEN,
            }),
            None => Ok(Self {
                start_m: distance_m[0],
                step_m: mean_m,
                height_m,
            }),
        }
    }

    /// A profile from points that are not evenly spaced, by straight lines between them at their mean step.
    ///
    /// Straight lines smooth: waves shorter than about ten of the longest steps lose height, so leave them out of the band.
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than three points, numbers that are not finite or distances that do not grow.
    pub fn resampled(distance_m: &[f64], height_m: &[f64]) -> Result<Self, SurfaceError> {
        let step_m = check_points(distance_m, height_m)?;
        let mut behind = 0;
        let even = (0..height_m.len()).map(|point| {
            let at = distance_m[0] + step_m * point as f64;
            while behind + 2 < distance_m.len() && distance_m[behind + 1] < at {
                behind += 1;
            }
            let (from, to) = (distance_m[behind], distance_m[behind + 1]);
            let part = ((at - from) / (to - from)).clamp(0.0, 1.0);
            height_m[behind] * (1.0 - part) + height_m[behind + 1] * part
        });
        Ok(Self {
            start_m: distance_m[0],
            step_m,
            height_m: even.collect(),
        })
    }

    /// Reads a table (CSV) with the columns `distance_mm` and `height_um`, or other units of length.
    ///
    /// # Errors
    /// [`SurfaceError`] with file, line, what was found and what was expected.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SurfaceError> {
        let (distance_m, height_m, locate) = read_points(path.as_ref())?;
        Self::from_points(&distance_m, height_m).map_err(locate)
    }

    /// As [`Profile::read`] and then [`Profile::resampled`], for profiles with uneven steps.
    ///
    /// # Errors
    /// [`SurfaceError`] with file, line, what was found and what was expected.
    pub fn read_resampled(path: impl AsRef<Path>) -> Result<Self, SurfaceError> {
        let (distance_m, height_m, locate) = read_points(path.as_ref())?;
        Self::resampled(&distance_m, &height_m).map_err(locate)
    }

    /// The profile as [`Profile::read`] reads it, `comment` above it line by line.
    #[must_use]
    pub fn to_csv(&self, comment: &str) -> String {
        let mut text = String::new();
        for line in comment.lines() {
            let _ = writeln!(text, "# {line}");
        }
        text.push_str("distance_mm,height_um\n");
        for (point, height_m) in self.height_m.iter().enumerate() {
            // Picometres and femtometres are finer than any instrument.
            let rounded = |value: f64| (1e9 * value).round() / 1e9;
            let distance_mm = rounded(1e3 * (self.start_m + self.step_m * point as f64));
            let _ = writeln!(text, "{distance_mm},{}", rounded(1e6 * height_m));
        }
        text
    }

    /// Distance between neighbouring points, in m.
    #[must_use]
    pub fn step_m(&self) -> f64 {
        self.step_m
    }

    /// Heights, in m.
    #[must_use]
    pub fn height_m(&self) -> &[f64] {
        &self.height_m
    }

    /// Distances of the points, in m.
    pub fn distance_m(&self) -> impl Iterator<Item = f64> {
        (0..self.height_m.len()).map(|point| self.start_m + self.step_m * point as f64)
    }

    /// Number of steps times their length, in m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.step_m * (self.height_m.len() - 1) as f64
    }
}

type Points = (
    Vec<f64>,
    Vec<f64>,
    Box<dyn Fn(SurfaceError) -> SurfaceError>,
);

fn read_points(path: &Path) -> Result<Points, SurfaceError> {
    let column = |name| Column {
        name,
        units: LENGTHS,
    };
    let wanted = [column("distance"), column("height")];
    let table = columns::read(path, "a surface profile (CSV)", wanted)?;
    let distance_m = table.rows.iter().map(|(_, [distance, _])| *distance);
    let height_m = table.rows.iter().map(|(_, [_, height])| *height);
    let points = (distance_m.collect(), height_m.collect());
    let lines: Vec<usize> = table.rows.iter().map(|(line, _)| *line).collect();
    let (path, header_line) = (table.path, table.header_line);
    let locate = move |reason: SurfaceError| {
        let line = match reason {
            SurfaceError::NotFinite { point, .. }
            | SurfaceError::NotGrowing { point, .. }
            | SurfaceError::Uneven { point, .. } => lines.get(point - 1),
            _ => lines.last(),
        };
        SurfaceError::InFile {
            path: path.clone(),
            line: line.copied().unwrap_or(header_line),
            reason: Box::new(reason),
        }
    };
    Ok((points.0, points.1, Box::new(locate)))
}

fn check(values: &[f64]) -> Result<(), SurfaceError> {
    if values.len() < FEWEST {
        return Err(SurfaceError::TooFewPoints {
            found: values.len(),
        });
    }
    match (1..).zip(values).find(|(_, value)| !value.is_finite()) {
        Some((point, &found)) => Err(SurfaceError::NotFinite { point, found }),
        None => Ok(()),
    }
}

/// The mean step of points that are a profile but for the evenness.
fn check_points(distance_m: &[f64], height_m: &[f64]) -> Result<f64, SurfaceError> {
    if distance_m.len() != height_m.len() {
        return Err(SurfaceError::Lengths {
            distances: distance_m.len(),
            heights: height_m.len(),
        });
    }
    check(distance_m)?;
    check(height_m)?;
    match distance_m.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(SurfaceError::NotGrowing {
            point: before + 2,
            found_m: distance_m[before + 1],
        }),
        None => {
            let last = distance_m.len() - 1;
            let step_m = (distance_m[last] - distance_m[0]) / last as f64;
            number::check(step_m.is_normal(), "the step", step_m, " m", STEP)?;
            Ok(step_m)
        }
    }
}
