//! The layer as a material of a finite-element model.

use super::{LayerContact, Loading, Moduli};
use crate::ContactError;
use crate::number::positive;

/// The slices of both parts that the layer takes the place of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layers {
    /// Their thicknesses h₁ and h₂, in m.
    pub thickness_m: [f64; 2],
    /// Their densities ρ₁ and ρ₂, in kg/m³.
    pub density_kg_per_m3: [f64; 2],
}

/// An isotropic elastic material that stands for a joint, and the thickness of its layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualMaterial {
    /// Young's modulus E, in Pa.
    pub youngs_modulus_pa: f64,
    /// Shear modulus G_x = E/(2(1 + ν)), in Pa.
    pub shear_modulus_pa: f64,
    /// Poisson's ratio ν.
    pub poissons_ratio: f64,
    /// Density ρ, in kg/m³.
    pub density_kg_per_m3: f64,
    /// Thickness h = h₁ + h₂ of the layer, in m.
    pub thickness_m: f64,
}

impl VirtualMaterial {
    /// The material of a contact under a load.
    ///
    /// # Errors
    /// No contact is elastic, Poisson's ratio comes out beyond (−1, 0.5), or a thickness or density is not positive.
    pub fn new(
        contact: &LayerContact,
        loading: Loading,
        layers: &Layers,
    ) -> Result<Self, ContactError> {
        Self::from_moduli(contact.moduli(loading)?, layers)
    }

    /// The material of given moduli.
    ///
    /// # Errors
    /// As [`VirtualMaterial::new`].
    pub fn from_moduli(moduli: Moduli, layers: &Layers) -> Result<Self, ContactError> {
        let quantities = [
            ("thickness (m)", layers.thickness_m),
            ("density (kg/m³)", layers.density_kg_per_m3),
        ];
        for (quantity, values) in quantities {
            for (side, found) in ['a', 'b'].into_iter().zip(values) {
                let quantity = format!("the {quantity} of side {side}");
                positive(quantity, found, "", "a positive number")?;
            }
        }
        let poissons_ratio = moduli.poissons_ratio();
        if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
            return Err(ContactError::PoissonsRatio {
                found: poissons_ratio,
                youngs_modulus_pa: moduli.youngs_modulus_pa,
                shear_modulus_pa: moduli.shear_modulus_pa,
            });
        }
        let [h1, h2] = layers.thickness_m;
        let [rho1, rho2] = layers.density_kg_per_m3;
        Ok(Self {
            youngs_modulus_pa: moduli.youngs_modulus_pa,
            shear_modulus_pa: moduli.shear_modulus_pa,
            poissons_ratio,
            // (3): ρ = (ρ₁h₁ + ρ₂h₂)/(h₁ + h₂)
            density_kg_per_m3: (rho1 * h1 + rho2 * h2) / (h1 + h2),
            thickness_m: h1 + h2,
        })
    }

    /// Its two moduli.
    #[must_use]
    pub fn moduli(&self) -> Moduli {
        Moduli {
            youngs_modulus_pa: self.youngs_modulus_pa,
            shear_modulus_pa: self.shear_modulus_pa,
        }
    }
}
