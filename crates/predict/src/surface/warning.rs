//! What is doubtful about a fit of a spectrum.

use std::fmt;

/// Steps in the shortest wavelength of the default band: there the folded spectrum is a few per cent.
pub(super) const DEFAULT_STEPS: f64 = 8.0;
/// Waves in a segment at the longest wavelength of the default band.
pub(super) const DEFAULT_WAVES: f64 = 6.0;

/// What is doubtful about a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FitWarning {
    /// Waves that the sampling hardly resolves.
    NearSampling {
        /// Shortest wavelength over the step.
        steps: f64,
    },
    /// Waves of which a segment has few.
    NearSegment {
        /// Segment over the longest wavelength.
        waves: f64,
    },
    /// A spectrum that is no straight line within its scatter.
    NotStraight {
        /// χ² of the fit.
        chi_squared: f64,
        /// Bands less two.
        degrees_of_freedom: usize,
    },
    /// An interval of D that goes beyond what a profile can have.
    DimensionNearEnd {
        /// 95 % interval of D.
        interval: [f64; 2],
    },
}

impl fmt::Display for FitWarning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NearSampling { steps } => write!(
                formatter,
                "the shortest wavelength of the fit is {steps:.1} steps: shorter waves fold into it, and instruments smooth it; \
                 use {DEFAULT_STEPS} steps or more"
            ),
            Self::NearSegment { waves } => write!(
                formatter,
                "the longest wavelength of the fit is in a segment only {waves:.1} times, where the window and the line taken off bias it; \
                 lengthen the segments or shorten the band to {DEFAULT_WAVES} times"
            ),
            Self::NotStraight {
                chi_squared,
                degrees_of_freedom,
            } => write!(
                formatter,
                "the spectrum is no straight line within its scatter (χ² = {chi_squared:.1} with {degrees_of_freedom} degrees of freedom): \
                 the surface is no fractal over this band; the intervals are widened accordingly"
            ),
            Self::DimensionNearEnd {
                interval: [low, high],
            } => write!(
                formatter,
                "the 95 % interval of D, {low:.3} to {high:.3}, goes beyond (1, 2)"
            ),
        }
    }
}
