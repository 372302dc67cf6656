//! Which surface would give moduli that are known of a layer.

use super::{Loading, Moduli};
use crate::surface::Roughness;

mod problem;
mod result;
mod search;

pub use result::fit;

/// A layer whose moduli are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Its load, or its real area.
    pub loading: Loading,
    /// Its moduli.
    pub moduli: Moduli,
}

/// What is taken from the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Magnitudes {
    /// Both moduli as they are.
    Stated,
    /// Only how they go with the load: each modulus is multiplied by a factor, the same for all layers, that is found too.
    Free,
}

/// The surface that comes closest.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Fractal dimension and roughness.
    pub roughness: Roughness,
    /// Standard deviation of D, from the residual and the curvature there; `None` if the moduli do not determine it or there is no residual to tell.
    pub dimension_deviation: Option<f64>,
    /// The same of ln G.
    pub log_roughness_deviation: Option<f64>,
    /// Factors of E and G_x; 1 with [`Magnitudes::Stated`].
    pub magnitudes: [f64; 2],
    /// Root mean square of ln(fitted/known) over both moduli of all layers.
    pub log_residual: f64,
    /// Whether the best is at the edge of what was searched: the moduli then follow from no surface inside.
    pub is_at_bound: bool,
    /// The layers, in their order.
    pub layers: Vec<FittedLayer>,
}

/// A layer of the fitted surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedLayer {
    /// Fitted moduli, factors included.
    pub moduli: Moduli,
    /// Real over critical real area, A_t/A_rc; more than 1.
    pub area_ratio: f64,
}
