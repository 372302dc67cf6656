//! Why numbers are no profile, and why profiles give no fractal dimension.

use std::path::PathBuf;

use thiserror::Error;

use crate::NumberError;
use bolted_joint_files::text_file::TextFileError;

/// Why there is no profile or no fit of it. Points count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// No profile.
    #[error("found no profiles; at least one is needed")]
    NoProfiles,
    /// Segments that do not fit.
    #[error(
        "found segments of {found} points; expected at least 8 and no more than the shortest profile has, {points}"
    )]
    Segment {
        /// Points in a segment.
        found: usize,
        /// Points in the shortest profile.
        points: usize,
    },
    /// Segments that do not move on.
    #[error("found an overlap of {found} points; expected less than a segment, {segment}")]
    Overlap {
        /// Points shared.
        found: usize,
        /// Points in a segment.
        segment: usize,
    },
    /// A setting outside its range, or a step that is no length.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// Profiles with different steps.
    #[error(
        "profile {number} has the step {found_m} m, the first one {first_m} m; expected the same for all: fit them apart, or resample them"
    )]
    Steps {
        /// Which profile, from 1.
        number: usize,
        /// Its step.
        found_m: f64,
        /// The first one's.
        first_m: f64,
    },
    /// A band in which no line can be fitted.
    #[error(
        "wavelengths from {} to {} m hold {found} bands at a ratio of {ratio}; expected at least 3: widen the band (from {shortest_m} m, two steps, \
         to {longest_m} m, a segment), lengthen the segments, or narrow the ratio",
        wavelength_m[0], wavelength_m[1]
    )]
    Band {
        /// Shortest and longest.
        wavelength_m: [f64; 2],
        /// Bands in them.
        found: usize,
        /// Ratio of neighbouring bands.
        ratio: f64,
        /// Shortest wavelength that the sampling has.
        shortest_m: f64,
        /// Longest wavelength that the segments have.
        longest_m: f64,
    },
    /// A band without any power.
    #[error("the profiles are flat between the wavelengths {} and {} m: no power there to fit", wavelength_m[0], wavelength_m[1])]
    Flat {
        /// Shortest and longest of the band.
        wavelength_m: [f64; 2],
    },
    /// A slope that no fractal profile has.
    #[error(
        "the spectrum falls as frequency to the power {slope:.3}, which is D = {dimension:.3} ± {standard_deviation:.3}; expected D inside (1, 2), a power between -3 and \
         -1: the profile is {}; check the band of wavelengths ({} to {} m), the form that is taken off, and what filters the instrument used",
        if *dimension <= 1.0 { "smoother than a fractal" } else { "rougher than a fractal, like noise" },
        wavelength_m[0], wavelength_m[1]
    )]
    Dimension {
        /// D = (5 + slope)/2.
        dimension: f64,
        /// Of D.
        standard_deviation: f64,
        /// Of log density over log frequency.
        slope: f64,
        /// Shortest and longest of the band.
        wavelength_m: [f64; 2],
    },
    /// D too near 1 for G to have an interval.
    #[error(
        "D = {dimension:.3} ± {standard_deviation:.3} cannot be told from 1, and G follows from a division by D − 1: \
         expected D − 1 of at least two standard deviations; measure more profiles or widen the band"
    )]
    Undetermined {
        /// D.
        dimension: f64,
        /// Of D.
        standard_deviation: f64,
    },
    /// Fewer points than any spectrum needs.
    #[error("found {found} points; expected at least 3, and some hundreds for a fractal dimension")]
    TooFewPoints {
        /// Points.
        found: usize,
    },
    /// Distances and heights that differ in number.
    #[error("found {distances} distances and {heights} heights; expected as many of each")]
    Lengths {
        /// Distances.
        distances: usize,
        /// Heights.
        heights: usize,
    },
    /// A number that is not finite.
    #[error("point {point}: found {found}; expected finite numbers")]
    NotFinite {
        /// Which point.
        point: usize,
        /// The number.
        found: f64,
    },
    /// A distance that does not grow.
    #[error(
        "point {point}: its distance, {found_m} m, is not beyond the one before; expected growing distances"
    )]
    NotGrowing {
        /// Which point.
        point: usize,
        /// Its distance.
        found_m: f64,
    },
    /// A step unlike the others.
    #[error(
        "point {point}: its step is {found_m} m, the mean step {mean_m} m; expected even spacing within {percent} %: \
         export the profile at even steps, or resample it, which smooths its shortest waves"
    )]
    Uneven {
        /// Which point.
        point: usize,
        /// Its step.
        found_m: f64,
        /// Mean step.
        mean_m: f64,
        /// What is allowed.
        percent: f64,
    },
    /// A profile's table.
    #[error(transparent)]
    Table(#[from] TextFileError),
    /// The numbers of a table.
    #[error("{}, line {line}: {reason}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// Line of the point, or the last one.
        line: usize,
        /// What is wrong.
        reason: Box<SurfaceError>,
    },
}
