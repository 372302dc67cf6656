//! Fractal dimension and roughness of a surface, from measured profiles.

mod bands;
mod detrend;
mod error;
mod fit;
mod profile;
mod roughness;
mod special;
mod synthetic;
mod welch;

pub use detrend::Detrend;
pub use error::FitError;
pub use fit::{BandMean, FitSettings, FitWarning, ProfileFit};
pub use profile::{Profile, ProfileError, ProfileFileError};
pub use roughness::{Roughness, RoughnessError};
pub use synthetic::Synthetic;
pub use welch::{Spectrum, Welch, Window};
