//! Why a draw gives no joint, in words that are the same for all draws with that reason.

use super::error::ModelError;
use crate::fractal::FractalError;
use crate::pressure::PressureError;
use crate::uncertain::Refusal;
use crate::virtual_material::VirtualMaterialError;

impl From<ModelError> for Refusal {
    fn from(error: ModelError) -> Self {
        let reason = match &error {
            ModelError::Fractal(error) => of_contact(error),
            ModelError::Pressure(PressureError::BoltSlack { .. }) => {
                "the moment takes a bolt's whole preload"
            }
            ModelError::VirtualMaterial(error) => match error {
                VirtualMaterialError::NoElasticContact { .. } => "no contact is elastic",
                VirtualMaterialError::PoissonsRatio { .. } => "no elastic layer",
                VirtualMaterialError::FrictionRatio(_) => "β/f of 1 or more",
                _ => "outside the layer's model",
            },
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

fn of_contact(error: &FractalError) -> &'static str {
    match error {
        FractalError::Element { reason, .. } => of_contact(reason),
        FractalError::FrictionRatio { .. } => "q = T/(μP) beyond the model",
        FractalError::RealArea { .. } => "more real than nominal area",
        FractalError::BeyondHardness { .. } => "pressure beyond the hardness",
        FractalError::CriticalArea { .. } => "no critical contact area",
        _ => "outside the contact model",
    }
}
