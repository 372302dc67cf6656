//! Why a draw gives no joint, in words that are the same for all draws with that reason.

use super::error::ModelError;
use crate::ContactError;
use crate::pressure::PressureError;
use crate::uncertain::Refusal;

impl From<ModelError> for Refusal {
    fn from(error: ModelError) -> Self {
        let reason = match &error {
            ModelError::Contact(error) => of_contact(error),
            ModelError::Pressure(PressureError::BoltSlack { .. }) => {
                "the moment takes a bolt's whole preload"
            }
            ModelError::Material(_) => "no elastic material",
            ModelError::Roughness(_) => "no fractal surface",
            ModelError::Tightening(_) => "no preload follows from the torque",
            _ => "outside the model",
        };
        Self {
            reason: reason.to_owned(),
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
        ContactError::Overflow(_) => "outside the layer's model",
        ContactError::LayerSlips(_) => "β/f of 1 or more",
        _ => "outside the contact model",
    }
}
