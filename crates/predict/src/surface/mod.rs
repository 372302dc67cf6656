//! Fractal dimension and roughness of a surface, from measured profiles.

mod bands;
mod detrend;
mod error;
mod fit;
mod fractal;
mod line;
mod profile;
mod roughness;
mod synthetic;
mod warning;
mod welch;

pub use detrend::Detrend;
pub use error::FitError;
pub use fit::{BandMean, FitSettings, ProfileFit};
pub use profile::{Profile, ProfileError, ProfileFileError};
pub use roughness::{Roughness, RoughnessError};
pub use synthetic::Synthetic;
pub use warning::FitWarning;
pub use welch::{Spectrum, Welch, Window};
