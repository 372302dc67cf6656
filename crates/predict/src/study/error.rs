//! Why a joint cannot be predicted.

use std::path::PathBuf;

use thiserror::Error;

use crate::MaterialError;
use crate::fractal::FractalError;
use crate::layered_beam;
use crate::patch::{DampingError, PlanarError};
use crate::pressure::{FieldError, FieldFileError, PressureError, TighteningError};
use crate::surface::{FitError, ProfileFileError, RoughnessError};
use crate::uncertain::{InputError, MonteCarloError};
use crate::virtual_material::VirtualMaterialError;
use bolted_joint_files::text_file::TextFileError;

/// Why a joint cannot be predicted.
#[derive(Debug, Error)]
pub enum PredictError {
    /// A text file cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// The study is not TOML, or has keys or types that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The study.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A value in the study cannot be used.
    #[error("{}: `{key}`: found {found}, expected {expected}", path.display())]
    Study {
        /// The study.
        path: PathBuf,
        /// Key in the study.
        key: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// What the study says gives no joint.
    #[error("{}: `{key}`: {reason}", path.display())]
    Model {
        /// The study.
        path: PathBuf,
        /// Key in the study.
        key: String,
        /// Why not.
        reason: Box<ModelError>,
    },
    /// A profile's file.
    #[error(transparent)]
    Profile(#[from] ProfileFileError),
    /// A pressure field's file.
    #[error(transparent)]
    FieldFile(#[from] FieldFileError),
    /// The study of a layered beam.
    #[error(transparent)]
    LayeredBeam(#[from] layered_beam::StudyError),
}

/// Why values give no joint.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// Elastic constants.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// Fractal dimension and roughness.
    #[error(transparent)]
    Roughness(#[from] RoughnessError),
    /// Profiles that give no fractal dimension.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The contact.
    #[error(transparent)]
    Fractal(#[from] FractalError),
    /// The virtual layer.
    #[error(transparent)]
    VirtualMaterial(#[from] VirtualMaterialError),
    /// A model without a virtual layer.
    #[error("found no layer: only method \"virtual-material\" has a material")]
    NoLayer,
    /// Bolts and the pressure that they make.
    #[error(transparent)]
    Pressure(#[from] PressureError),
    /// From torque to preload.
    #[error(transparent)]
    Tightening(#[from] TighteningError),
    /// A pressure field from elsewhere.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// Frequency or mass of the damping.
    #[error(transparent)]
    Damping(#[from] DampingError),
    /// Axes of the joint.
    #[error(transparent)]
    Planar(#[from] PlanarError),
    /// A correlation of inputs.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The draws.
    #[error(transparent)]
    MonteCarlo(#[from] MonteCarloError),
}
