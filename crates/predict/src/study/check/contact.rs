//! The numbers of the contact model that a study asks for.

use super::{Checked, Checker, ContactInputs};
use crate::study::tables::StudyFile;
use crate::uncertain::{InputPlace, Uncertain};
use crate::virtual_material::Layers;
use bolted_joint_study::Method;

impl Checker<'_> {
    /// The numbers of the method's contact; those of the other method are refused.
    pub(super) fn contact(&mut self, file: &StudyFile) -> Checked<ContactInputs> {
        let table = &file.contact;
        let hardness = self.positive("contact.hardness", "hardness", table.hardness)?;
        match file.method {
            Method::VirtualMaterial => {
                for (key, found) in [
                    ("contact.friction", table.friction),
                    ("contact.shear_strength", table.shear_strength),
                ] {
                    if let Some(found) = found {
                        let expected = "none of method \"virtual-material\", which takes contact.friction_ratio";
                        return self.study.refuse(key, found, expected);
                    }
                }
                let expected = "none of method \"virtual-material\", which takes layer.loss_factor";
                let damping = &file.damping;
                for (key, is_given) in [
                    ("damping.loss_factor", damping.loss_factor.is_some()),
                    ("damping.stored_energy", damping.stored_energy.is_some()),
                ] {
                    self.study.ensure(!is_given, key, "a word", expected)?;
                }
                self.layer(file, hardness)
            }
            _ => {
                if let Some(found) = table.friction_ratio {
                    let expected = "none of method \"fractal-contact\", where it follows from friction and shear_strength";
                    return self.study.refuse("contact.friction_ratio", found, expected);
                }
                let expected = "none: only method \"virtual-material\" has a layer";
                self.study
                    .ensure(file.layer.is_none(), "layer", "a table", expected)?;
                let expected = "the coefficient of static friction";
                let friction = self
                    .study
                    .needed("contact.friction", table.friction, expected)?;
                let key = "contact.shear_strength";
                let expected = "the shear strength of the softer part in Pa, or 0 for a joint without tangential load";
                let shear_strength = match (file.microslip.is_some(), table.shear_strength) {
                    (true, None) => Uncertain::exact(0.0),
                    (_, given) => self.study.needed(key, given, expected)?,
                };
                let expected = "0, or nothing: with [microslip] the load along the interface is that of the joint's motion";
                let good = file.microslip.is_none() || shear_strength.value == 0.0;
                self.study.ensure(good, key, shear_strength, expected)?;
                Ok(ContactInputs::Fractal {
                    hardness,
                    friction: self.positive("contact.friction", "friction", friction)?,
                    shear_strength: self.not_negative(
                        "contact.shear_strength",
                        "shear strength",
                        shear_strength,
                    )?,
                })
            }
        }
    }

    fn layer(&mut self, file: &StudyFile, hardness: InputPlace) -> Checked<ContactInputs> {
        let (study, key) = (self.study, "layer.thickness");
        let expected =
            "thickness = [a, b], of the part of each side that the layer takes the place of, m";
        let layer = study.needed(key, file.layer.as_ref(), expected)?;
        let is_thick = |thickness: &f64| thickness.is_finite() && *thickness > 0.0;
        let good = layer.thickness.iter().all(is_thick);
        let found = format!("{:?}", layer.thickness);
        study.ensure(good, key, found, "two lengths in m above zero")?;
        let [a, b] = [&file.materials.a, &file.materials.b].map(|part| part.density);
        let (Some(a), Some(b)) = (a, b) else {
            let side = if a.is_none() { "a" } else { "b" };
            let expected = "kg/m³, for the density of the layer";
            return self
                .study
                .refuse(format!("materials.{side}.density"), "nothing", expected);
        };
        let friction_ratio = file.contact.friction_ratio.unwrap_or(Uncertain::exact(0.0));
        Ok(ContactInputs::Layer {
            hardness,
            friction_ratio: self.not_negative(
                "contact.friction_ratio",
                "friction ratio",
                friction_ratio,
            )?,
            layers: Layers {
                thickness_m: layer.thickness,
                density_kg_per_m3: [a, b],
            },
            loss_factor: self.not_negative(
                "layer.loss_factor",
                "loss factor",
                layer.loss_factor.unwrap_or(Uncertain::exact(0.0)),
            )?,
        })
    }
}
