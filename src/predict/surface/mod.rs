//! Fractal dimension and roughness of a surface, from measured profiles.

mod roughness;

pub use roughness::{Roughness, RoughnessError};
