//! Layers that stand for joints: Tian's equations.

mod cards;
mod equations;
mod fits;
mod joints;
mod refusals;

use bolted_joint::predict::ContactError;
use bolted_joint::predict::surface::Roughness;
use bolted_joint::predict::virtual_material::LayerContact;
use bolted_joint::predict::{Material, Pair};

/// Steel on grey cast iron, as in `layer_references.py`.
pub(crate) fn pair() -> Pair {
    Pair {
        a: Material::new(2.1e11, 0.3).unwrap(),
        b: Material::new(1.1e11, 0.26).unwrap(),
    }
}

pub(crate) const HARDNESS_PA: f64 = 1.96e9;
pub(crate) const FRICTION_RATIO: f64 = 0.3;

pub(crate) fn try_contact(
    dimension: f64,
    roughness_m: f64,
    hardness_pa: f64,
) -> Result<LayerContact, ContactError> {
    let roughness = Roughness::new(dimension, roughness_m).unwrap();
    LayerContact::new(&pair(), roughness, hardness_pa, FRICTION_RATIO)
}

pub(crate) fn contact(dimension: f64, roughness_m: f64) -> LayerContact {
    try_contact(dimension, roughness_m, HARDNESS_PA).unwrap()
}
