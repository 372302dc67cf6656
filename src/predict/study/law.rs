//! What each element of an interface has per area, by the model that a study asks for.

use crate::predict::fractal::PerArea;
use crate::predict::patch::Contact;
use crate::predict::pressure::PressureField;
use crate::predict::virtual_material::{LayerContact, Layers, Loading, VirtualMaterial};

use super::contact_curve::{ContactCurve, ContactLaw};
use super::error::ModelError;

/// A contact model with its numbers.
#[derive(Debug, Clone)]
pub(super) enum Law {
    /// Zhao's: by the pressure on each element.
    Fractal(ContactLaw),
    /// Tian's layer: the same everywhere where there is pressure, by the load of the whole interface.
    Layer(LayerLaw),
}

/// The contact behind a layer, and what the model does not give: its thickness and its loss factor.
#[derive(Debug, Clone)]
pub(super) struct LayerLaw {
    pub(super) contact: LayerContact,
    pub(super) layers: Layers,
    pub(super) loss_factor: f64,
}

/// What a model says of a field, element by element.
#[derive(Debug, Clone)]
pub(super) struct OverField {
    pub(super) contacts: Vec<Contact>,
    /// None of the layer.
    pub(super) per_area: Vec<PerArea>,
    /// None of the fractal contact.
    pub(super) material: Option<VirtualMaterial>,
}

impl Law {
    /// At every element of a field, each computed on its own.
    pub(super) fn over(&self, field: &PressureField) -> Result<OverField, ModelError> {
        match self {
            Self::Fractal(law) => {
                let per_area = law.contact.over(field)?;
                Ok(OverField {
                    contacts: per_area.iter().map(|found| law.of(found)).collect(),
                    per_area,
                    material: None,
                })
            }
            Self::Layer(law) => {
                let elements = field.elements().iter();
                let pressures_pa: Vec<f64> = elements.map(|element| element.pressure_pa).collect();
                let (material, contact) = law.under(field.force_n())?;
                Ok(OverField {
                    contacts: where_pressed(&pressures_pa, contact).collect(),
                    per_area: Vec::new(),
                    material: Some(material),
                })
            }
        }
    }

    /// At these pressures (Pa), which carry a force (N) together: the fractal contact by its curve.
    pub(super) fn drawn(
        &self,
        pressures_pa: &[f64],
        force_n: f64,
    ) -> Result<Vec<Contact>, ModelError> {
        match self {
            Self::Fractal(law) => {
                let largest_pa = pressures_pa.iter().copied().fold(0.0, f64::max);
                let curve = ContactCurve::new(law, largest_pa)?;
                let contacts = pressures_pa.iter();
                let contacts = contacts.map(|&pressure_pa| curve.at(pressure_pa));
                Ok(contacts.collect::<Result<_, _>>()?)
            }
            Self::Layer(law) => {
                let (_, contact) = law.under(force_n)?;
                Ok(where_pressed(pressures_pa, contact).collect())
            }
        }
    }
}

impl LayerLaw {
    /// The layer under a force (N), and what it has per area.
    fn under(&self, force_n: f64) -> Result<(VirtualMaterial, Contact), ModelError> {
        let loading = Loading::Force(force_n);
        let material = VirtualMaterial::new(&self.contact, loading, &self.layers)?;
        // k = E/h and G_x/h
        let normal = material.youngs_modulus_pa / material.thickness_m;
        let tangential = material.shear_modulus_pa / material.thickness_m;
        let contact = Contact {
            normal_stiffness_n_per_m3: normal,
            tangential_stiffness_n_per_m3: tangential,
            normal_damping_n_per_m3: self.loss_factor * normal,
            tangential_damping_n_per_m3: self.loss_factor * tangential,
        };
        Ok((material, contact))
    }
}

/// A contact where there is pressure, and none elsewhere.
fn where_pressed(pressures_pa: &[f64], contact: Contact) -> impl Iterator<Item = Contact> {
    pressures_pa
        .iter()
        .map(move |&pressure_pa| match pressure_pa > 0.0 {
            true => contact,
            false => Contact::default(),
        })
}
