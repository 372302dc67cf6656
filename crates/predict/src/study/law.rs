//! What each element of an interface has per area, by the model that a study asks for.

use crate::ContactError;
use crate::fractal::PerArea;
use crate::patch::Contact;
use crate::pressure::PressureField;
use crate::virtual_material::{LayerContact, Layers, Loading, Moduli, VirtualMaterial};

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

/// A virtual layer under the load of its interface.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Young's modulus across it and shear modulus along it.
    pub moduli: Moduli,
    /// Its thickness, m.
    pub thickness_m: f64,
    /// The isotropic material of these moduli, or why there is none: the joint needs none.
    pub material: Result<VirtualMaterial, ContactError>,
}

/// What a model says of a field, element by element.
#[derive(Debug, Clone)]
pub(super) struct OverField {
    pub(super) contacts: Vec<Contact>,
    /// None of the layer.
    pub(super) per_area: Vec<PerArea>,
    /// None of the fractal contact.
    pub(super) layer: Option<Layer>,
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
                    layer: None,
                })
            }
            Self::Layer(law) => {
                let elements = field.elements().iter();
                let pressures_pa: Vec<f64> = elements.map(|element| element.pressure_pa).collect();
                let (layer, contact) = law.under(field.force_n())?;
                Ok(OverField {
                    contacts: where_pressed(&pressures_pa, contact).collect(),
                    per_area: Vec::new(),
                    layer: Some(layer),
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
    fn under(&self, force_n: f64) -> Result<(Layer, Contact), ModelError> {
        let moduli = self.contact.moduli(Loading::Force(force_n))?;
        let thickness_m = self.layers.thickness_m.iter().sum();
        // k = E/h and G_x/h
        let normal = moduli.youngs_modulus_pa / thickness_m;
        let tangential = moduli.shear_modulus_pa / thickness_m;
        let layer = Layer {
            moduli,
            thickness_m,
            material: VirtualMaterial::from_moduli(moduli, &self.layers),
        };
        let contact = Contact {
            normal_stiffness_n_per_m3: normal,
            tangential_stiffness_n_per_m3: tangential,
            normal_damping_n_per_m3: self.loss_factor * normal,
            tangential_damping_n_per_m3: self.loss_factor * tangential,
        };
        Ok((layer, contact))
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
