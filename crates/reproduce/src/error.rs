//! Why a table cannot be computed anew.

use thiserror::Error;

use bolted_joint_frf::structure::{BeamError, CouplingError, ModalError, SpatialError};
use bolted_joint_identify::IdentifyError;
use bolted_joint_predict::MaterialError;
use bolted_joint_predict::layered_beam::LayeredBeamError;
use bolted_joint_predict::surface::RoughnessError;
use bolted_joint_predict::virtual_material::{FitError, VirtualMaterialError};
use bolted_joint_respond::PollutionError;

/// Why a table cannot be computed anew.
#[derive(Debug, Error)]
pub enum ReproduceError {
    /// The noise makes no sense.
    #[error(transparent)]
    Pollution(#[from] PollutionError),
    /// A lumped structure.
    #[error(transparent)]
    Spatial(#[from] SpatialError),
    /// A beam.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// Modal data.
    #[error(transparent)]
    Modal(#[from] ModalError),
    /// An assembly.
    #[error(transparent)]
    Coupling(#[from] CouplingError),
    /// A material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A layer that stands for a joint, or the fit of a surface to some.
    #[error(transparent)]
    Layer(Box<FitError>),
    /// An identification.
    #[error(transparent)]
    Identify(Box<IdentifyError>),
    /// A layered beam.
    #[error(transparent)]
    LayeredBeam(#[from] LayeredBeamError),
}

impl From<IdentifyError> for ReproduceError {
    fn from(error: IdentifyError) -> Self {
        Self::Identify(Box::new(error))
    }
}

impl From<FitError> for ReproduceError {
    fn from(error: FitError) -> Self {
        Self::Layer(Box::new(error))
    }
}

impl From<VirtualMaterialError> for ReproduceError {
    fn from(error: VirtualMaterialError) -> Self {
        FitError::from(error).into()
    }
}

impl From<RoughnessError> for ReproduceError {
    fn from(error: RoughnessError) -> Self {
        FitError::from(error).into()
    }
}
