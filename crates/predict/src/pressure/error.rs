//! What can be wrong with bolts, plates and the fields that are asked of them.

use std::path::PathBuf;

use thiserror::Error;

use crate::NumberError;
use bolted_joint_files::text_file::TextFileError;

/// Why there is no pressure field.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PressureError {
    /// A rectangle without an inside.
    #[error(
        "the interface goes from x = {} to {} m and from y = {} to {} m; expected finite ends, the second larger than the first",
        x_m[0], x_m[1], y_m[0], y_m[1]
    )]
    Outline {
        /// Along x.
        x_m: [f64; 2],
        /// Along y.
        y_m: [f64; 2],
    },
    /// No cells, or more than a field is good for.
    #[error(
        "found {} × {} cells; expected at least 1 along each side and at most {most} in all", cells[0], cells[1]
    )]
    Cells {
        /// Along x and along y.
        cells: [usize; 2],
        /// The most cells of a field.
        most: usize,
    },
    /// No bolt at all.
    #[error("found no bolts; at least one is needed")]
    NoBolts,
    /// A number that no bolt, zone, field or load has.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// Preloads and bolts that differ in number.
    #[error("found {found} preloads for {bolts} bolts; expected one each")]
    Preloads {
        /// Preloads.
        found: usize,
        /// Bolts.
        bolts: usize,
    },
    /// A moment that bolts on one line cannot carry.
    #[error(
        "the bolts lie on one line and cannot carry the moments {} and {} N·m about x and y; \
         only a moment with a lever arm along that line changes their preloads", moments_n_m[0], moments_n_m[1]
    )]
    CannotBend {
        /// About x and about y.
        moments_n_m: [f64; 2],
    },
    /// A bolt that a moment relieves altogether.
    #[error(
        "bolt {number}: the moment takes its preload of {preload_n} N to {found_n} N; expected 0 N or more: \
         raise the preload or lower the moment"
    )]
    BoltSlack {
        /// Its place in the list, from 1.
        number: usize,
        /// Before.
        preload_n: f64,
        /// After.
        found_n: f64,
    },
    /// A ratio of thicknesses without constants.
    #[error(
        "layers {first_m} m and {second_m} m thick; expected a ratio of 1, 1.5 or 2, for which the table of constants has an entry: \
         take the nearest on purpose, or a cone"
    )]
    ThicknessRatio {
        /// One thickness.
        first_m: f64,
        /// The other.
        second_m: f64,
    },
    /// A zone that does not reach beyond its hole.
    #[error(
        "bolt {number}: the zone of pressure has the radius {zone_m} m, its hole {hole_m} m; expected the zone to be wider"
    )]
    ZoneInHole {
        /// Its place in the list, from 1.
        number: usize,
        /// Radius of the zone.
        zone_m: f64,
        /// Radius of the hole.
        hole_m: f64,
    },
    /// A hole that goes beyond the edge.
    #[error(
        "bolt {number}: its hole, of radius {hole_m} m about ({x_m}, {y_m}) m, goes beyond the edge of the interface; \
         expected it inside"
    )]
    HoleAtEdge {
        /// Its place in the list, from 1.
        number: usize,
        /// Its x.
        x_m: f64,
        /// Its y.
        y_m: f64,
        /// Radius of the hole.
        hole_m: f64,
    },
    /// Two holes that run into each other.
    #[error("bolts {first} and {second}: their holes overlap; the axes are {distance_m} m apart")]
    HolesOverlap {
        /// One of them, from 1.
        first: usize,
        /// The other.
        second: usize,
        /// Distance of their axes.
        distance_m: f64,
    },
    /// A resultant that pressure alone cannot have on this area.
    #[error(
        "no pressure without tension has the force {force_n} N and the moments {} and {} N·m about x and y: its line of action, \
         x = {} m and y = {} m, must pass through the area in contact; the joint would open altogether",
        moments_n_m[0], moments_n_m[1], -moments_n_m[1] / force_n, moments_n_m[0] / force_n
    )]
    Opens {
        /// Normal force.
        force_n: f64,
        /// About x and about y.
        moments_n_m: [f64; 2],
    },
    /// A field without elements.
    #[error("the pressure field has no elements; at least one is needed")]
    NoElements,
    /// The pressure is zero everywhere.
    #[error("no element of the pressure field has a pressure: the parts do not touch")]
    Apart,
    /// A field's table, or a number in it.
    #[error(transparent)]
    Table(#[from] TextFileError),
    /// The field in a file.
    #[error("{}: {reason}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: Box<PressureError>,
    },
    /// Areas that do not add up to the interface's.
    #[error(
        "the areas of its {rows} rows add up to {found_m2} m², expected the nominal area, {nominal_m2} m², within {percent} %: \
         check the unit of the area column, and that nodes at edges have their part of an element only"
    )]
    Area {
        /// Rows in it.
        rows: usize,
        /// Sum of areas.
        found_m2: f64,
        /// What was stated.
        nominal_m2: f64,
        /// How far they may differ.
        percent: f64,
    },
}
