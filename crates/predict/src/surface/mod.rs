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
pub use error::SurfaceError;
pub use fit::{BandMean, FitSettings, ProfileFit};
pub use profile::Profile;
pub use roughness::Roughness;
pub use synthetic::Synthetic;
pub use warning::FitWarning;
pub use welch::{Spectrum, Welch, Window};
