//! Why values give no joint.

use thiserror::Error;

use crate::patch::PlanarError;
use crate::pressure::PressureError;
use crate::surface::SurfaceError;
use crate::uncertain::MonteCarloError;
use crate::{ContactError, NumberError};

/// Why values give no joint.
#[derive(Debug, Error)]
pub enum ModelError {
    /// Elastic constants.
    #[error(transparent)]
    Material(NumberError),
    /// Fractal dimension and roughness.
    #[error(transparent)]
    Roughness(NumberError),
    /// Profiles that give no fractal dimension.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The contact, or the virtual layer in its place.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A model without a virtual layer.
    #[error("found no layer: only method \"virtual-material\" has a material")]
    NoLayer,
    /// Bolts and the pressure that they make.
    #[error(transparent)]
    Pressure(#[from] PressureError),
    /// From torque to preload.
    #[error(transparent)]
    Tightening(NumberError),
    /// A pressure field from elsewhere.
    #[error(transparent)]
    Field(PressureError),
    /// Frequency or mass of the damping.
    #[error(transparent)]
    Damping(NumberError),
    /// Axes of the joint.
    #[error(transparent)]
    Planar(#[from] PlanarError),
    /// Translation and rotation of the joint slide the same patches the same way.
    #[error(
        "translation and rotation slide the interface the same way (by {part:.2e} of their stiffness): expected a reference point at the \
         centre of the tangential stiffness, in the interface, or no rotation"
    )]
    CoupledSlip {
        /// What they share, 0 to 1.
        part: f64,
    },
    /// A correlation of inputs.
    #[error(transparent)]
    Correlation(NumberError),
    /// The draws.
    #[error(transparent)]
    MonteCarlo(#[from] MonteCarloError),
}
