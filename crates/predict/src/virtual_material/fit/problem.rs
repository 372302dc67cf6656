//! How far the layers of a surface are from the known ones.

use super::{Magnitudes, Observation};
use crate::ContactError;
use crate::Pair;
use crate::number::positive;
use crate::surface::Roughness;
use crate::virtual_material::{LayerContact, Loading};

/// D, and the logarithm of the margin of ln G.
pub(super) type Unknowns = [f64; 2];

pub(super) struct Problem<'a> {
    pub(super) observations: &'a [Observation],
    pub(super) pair: &'a Pair,
    pub(super) hardness_pa: f64,
    pub(super) friction_ratio: f64,
    pub(super) magnitudes: Magnitudes,
}

impl Problem<'_> {
    pub(super) fn check(&self) -> Result<(), ContactError> {
        let unknowns = self.unknowns();
        let found = self.observations.len();
        if 2 * found < unknowns {
            return Err(ContactError::TooFewLayers {
                found,
                unknowns,
                expected: unknowns / 2,
            });
        }
        for (index, observation) in self.observations.iter().enumerate() {
            let quantities = [
                ("load or area", observation.loading.value()),
                ("Young's modulus", observation.moduli.youngs_modulus_pa),
                ("shear modulus", observation.moduli.shear_modulus_pa),
            ];
            for (quantity, found) in quantities {
                let quantity = format!("layer {}: the {quantity}", index + 1);
                positive(quantity, found, "", "a positive number")?;
            }
        }
        // Whether hardness and friction make sense does not depend on the roughness.
        LayerContact::new(
            self.pair,
            Roughness::new(1.5, 1e-9)?,
            self.hardness_pa,
            self.friction_ratio,
        )?;
        Ok(())
    }

    pub(super) fn unknowns(&self) -> usize {
        match self.magnitudes {
            Magnitudes::Stated => 2,
            Magnitudes::Free => 4,
        }
    }

    pub(super) fn contact(&self, d: f64, roughness_m: f64) -> Option<LayerContact> {
        let roughness = Roughness::new(d, roughness_m).ok()?;
        LayerContact::new(self.pair, roughness, self.hardness_pa, self.friction_ratio).ok()
    }

    /// The roughness with which the least loaded layer is critical.
    pub(super) fn greatest_roughness(&self, d: f64) -> Option<f64> {
        // Critical loads and areas go with G².
        let reference_m = 1e-9;
        let contact = self.contact(d, reference_m)?;
        let least = self
            .observations
            .iter()
            .map(|observation| match observation.loading {
                Loading::Force(load) => load / contact.critical_load_n(),
                Loading::RealArea(area) => area / contact.critical_real_area_m2(),
            })
            .fold(f64::INFINITY, f64::min);
        Some(reference_m * least.sqrt())
    }

    pub(super) fn roughness_at(&self, [d, margin]: Unknowns) -> Option<f64> {
        Some(self.greatest_roughness(d)? * (-margin.exp()).exp())
    }

    /// ln(computed/known) of E and G_x, layer by layer, without their means where magnitudes are free.
    pub(super) fn residuals(&self, at: Unknowns) -> Option<Vec<[f64; 2]>> {
        self.residuals_of(self.contact(at[0], self.roughness_at(at)?)?)
    }

    pub(super) fn residuals_of(&self, contact: LayerContact) -> Option<Vec<[f64; 2]>> {
        let (mut all, means) = self.differences(contact)?;
        if self.magnitudes == Magnitudes::Free {
            for differences in &mut all {
                differences[0] -= means[0];
                differences[1] -= means[1];
            }
        }
        Some(all)
    }

    /// ln(computed/known) of E and G_x, and their means over the layers.
    pub(super) fn differences(&self, contact: LayerContact) -> Option<(Vec<[f64; 2]>, [f64; 2])> {
        let mut all = Vec::with_capacity(self.observations.len());
        let mut means = [0.0; 2];
        for observation in self.observations {
            let computed = contact.moduli(observation.loading).ok()?;
            let known = observation.moduli;
            let differences = [
                (computed.youngs_modulus_pa / known.youngs_modulus_pa).ln(),
                (computed.shear_modulus_pa / known.shear_modulus_pa).ln(),
            ];
            for (mean, difference) in means.iter_mut().zip(differences) {
                *mean += difference / self.observations.len() as f64;
            }
            all.push(differences);
        }
        Some((all, means))
    }
}
