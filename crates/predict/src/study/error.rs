//! Why values give no joint: the key of the study that it is about, and in short what draws are counted by.

use std::error::Error;

use thiserror::Error;

use crate::ContactError;
use crate::pressure::PressureError;
use crate::uncertain::{MonteCarloError, Refusal};

/// Why values give no joint.
#[derive(Debug, Error)]
#[error("{reason}")]
pub struct ModelError {
    /// The key of the study.
    pub(super) key: &'static str,
    /// The same words for all draws with that reason.
    in_short: &'static str,
    reason: Box<dyn Error + Send + Sync>,
}

impl ModelError {
    /// For a reason that is about a key.
    pub(super) fn about<E: Error + Send + Sync + 'static>(
        key: &'static str,
        in_short: &'static str,
    ) -> impl FnOnce(E) -> Self {
        move |reason| Self {
            key,
            in_short,
            reason: Box::new(reason),
        }
    }
}

impl From<ContactError> for ModelError {
    fn from(error: ContactError) -> Self {
        Self::about("contact", of_contact(&error))(error)
    }
}

impl From<PressureError> for ModelError {
    fn from(error: PressureError) -> Self {
        let in_short = match &error {
            PressureError::BoltSlack { .. } => "the moment takes a bolt's whole preload",
            _ => "outside the model",
        };
        Self::about("pressure", in_short)(error)
    }
}

impl From<MonteCarloError> for ModelError {
    fn from(error: MonteCarloError) -> Self {
        Self::about("uncertainty", "outside the model")(error)
    }
}

impl From<ModelError> for Refusal {
    fn from(error: ModelError) -> Self {
        Self {
            reason: error.in_short.to_owned(),
        }
    }
}

fn of_contact(error: &ContactError) -> &'static str {
    match error {
        ContactError::Element { reason, .. } => of_contact(reason),
        ContactError::FrictionRatio { .. } => "q = T/(μP) beyond the model",
        ContactError::RealArea { .. } => "more real than nominal area",
        ContactError::BeyondHardness { .. } => "pressure beyond the hardness",
        ContactError::CriticalArea { .. } => "no critical contact area",
        ContactError::NoElasticContact { .. } => "no contact is elastic",
        ContactError::PoissonsRatio { .. } => "no elastic layer",
        ContactError::LayerSlips(_) => "β/f of 1 or more",
        ContactError::Overflow(_) => "outside the layer's model",
        _ => "outside the contact model",
    }
}
