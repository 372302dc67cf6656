//! Why a table cannot be computed anew.

use std::error::Error;

use thiserror::Error;

use bolted_joint_frf::structure::{SingularAssembly, StructureError};
use bolted_joint_identify::IdentifyError;
use bolted_joint_predict::layered_beam::LayeredBeamError;
use bolted_joint_predict::{ContactError, NumberError};
use bolted_joint_respond::RespondError;

/// Why a table cannot be computed anew: what one of the other crates says of it.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct ReproduceError(Box<dyn Error + Send + Sync>);

macro_rules! from_other_crates {
    ($($error:ty),+) => {
        $(impl From<$error> for ReproduceError {
            fn from(error: $error) -> Self {
                Self(Box::new(error))
            }
        })+
    };
}

from_other_crates!(
    ContactError,
    IdentifyError,
    LayeredBeamError,
    NumberError,
    RespondError,
    SingularAssembly,
    StructureError,
    toml::de::Error
);
