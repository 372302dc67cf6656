//! From one set of values to the joint: the contact, the pressure, and their sum over the interface.

use crate::fractal::{FractalContact, Friction, PerArea};
use crate::microslip::Patches;
use crate::patch::{Contact, InterfaceJoint, PartOfInterface};
use crate::pressure::{Balance, Bolt, Element, PressureField};
use crate::surface::Roughness;
use crate::uncertain::{Drawn as Values, InputPlace};
use crate::virtual_material::LayerContact;
use crate::{Material, Pair};
use bolted_joint_dynamics::Dof;

use super::both_surfaces::both;
use super::check::{ContactInputs, InterfaceStudy, MaterialInputs, SurfaceInput, SurfaceInputs};
use super::contact_curve::ContactLaw;
use super::error::ModelError;
use super::geometry::Plate;
use super::law::{Law, Layer, LayerLaw, OverField};
use super::slip::{self, Slip, SlipSums};

/// The joint at one torque, or at the only tightness.
#[derive(Debug, Clone)]
pub struct State {
    /// Torque of the table, N·m.
    pub torque_n_m: Option<f64>,
    /// The bolts with their preloads.
    pub bolts: Vec<Bolt>,
    /// The pressure.
    pub field: PressureField,
    /// What it carries of the preloads, where there are bolts.
    pub balance: Option<Balance>,
    /// What each element of the field has per area.
    pub contacts: Vec<Contact>,
    /// What a fractal contact amounts to at each element; none of other models.
    pub per_area: Vec<PerArea>,
    /// The layer that stands for the interface, of method `virtual-material`.
    pub layer: Option<Layer>,
    /// The joint.
    pub interface: InterfaceJoint,
    /// The part of it in the joint file's matrices: all, or what does not slip.
    pub part: PartOfInterface,
    /// The friction of each relative DOF of the joint that slips, where the study asks for it.
    pub slips: Vec<Slip>,
}

/// What a draw comes to.
#[derive(Debug, Clone)]
pub(super) struct Drawn {
    pub(super) interface: InterfaceJoint,
    pub(super) part: PartOfInterface,
    pub(super) slips: Vec<SlipSums>,
}

impl State {
    /// Largest pressure, Pa.
    #[must_use]
    pub fn largest_pressure_pa(&self) -> f64 {
        let elements = self.field.elements().iter();
        elements.fold(0.0, |largest, element| largest.max(element.pressure_pa))
    }

    /// Part of the area that is under pressure.
    #[must_use]
    pub fn area_under_pressure(&self) -> f64 {
        let elements = self.field.elements().iter();
        let pressed = elements.filter(|element| element.pressure_pa > 0.0);
        pressed.map(|element| element.area_m2).sum::<f64>() / self.field.area_m2()
    }

    /// Largest real over nominal area of all elements.
    #[must_use]
    pub fn largest_real_area(&self) -> f64 {
        let elements = self.per_area.iter();
        elements.fold(0.0, |largest, at| largest.max(at.real_area_fraction))
    }
}

impl InterfaceStudy {
    /// The rectangle that the pressure is computed on; none of a field from elsewhere.
    #[must_use]
    pub fn plate(&self) -> Option<Plate> {
        self.geometry.plate()
    }

    /// Torques at which there is a joint each; one `None` where there is no table.
    pub(super) fn torques(&self) -> Vec<Option<f64>> {
        match self.torques_n_m.as_slice() {
            [] => vec![None],
            torques => torques.iter().map(|&torque| Some(torque)).collect(),
        }
    }

    /// The contact of these values.
    pub(super) fn law(&self, values: &Values) -> Result<Law, ModelError> {
        let of = |place: InputPlace| values.of(place);
        let material = |inputs: &MaterialInputs| {
            let material = Material::new(of(inputs.youngs_modulus), of(inputs.poissons_ratio));
            material.map_err(ModelError::Material)
        };
        let [a, b] = &self.materials;
        let pair = Pair {
            a: material(a)?,
            b: material(b)?,
        };
        let roughness = self.roughness(values)?;
        match self.contact {
            ContactInputs::Fractal {
                hardness,
                friction,
                shear_strength,
            } => {
                let friction = Friction {
                    coefficient: of(friction),
                    shear_strength_pa: of(shear_strength),
                };
                let area_m2 = self.geometry.area_m2();
                let contact =
                    FractalContact::new(&pair, roughness, of(hardness), friction, area_m2)?;
                Ok(Law::Fractal(ContactLaw {
                    contact: contact.with_stored_energy(self.stored_energy),
                    loss_factor: self.loss_factor,
                }))
            }
            ContactInputs::Layer {
                hardness,
                friction_ratio,
                layers,
                loss_factor,
            } => Ok(Law::Layer(LayerLaw {
                contact: LayerContact::new(&pair, roughness, of(hardness), of(friction_ratio))?,
                layers,
                loss_factor: of(loss_factor),
            })),
        }
    }

    /// The roughness of both surfaces together.
    pub(super) fn roughness(&self, values: &Values) -> Result<Roughness, ModelError> {
        let of = |input: &SurfaceInput| {
            Roughness::new(
                values.of(input.fractal_dimension),
                values.of(input.roughness),
            )
        };
        let roughness = match &self.surfaces {
            SurfaceInputs::Together(surface) => of(surface),
            SurfaceInputs::Each([a, b], band_m) => of(a).and_then(|a| both(a, of(b)?, *band_m)),
        };
        roughness.map_err(ModelError::Roughness)
    }

    /// All that follows from these values at a torque, every element computed on its own.
    pub(super) fn state(
        &self,
        values: &Values,
        law: &Law,
        torque_n_m: Option<f64>,
    ) -> Result<State, ModelError> {
        let bolts = self.clamping.bolts(values, torque_n_m)?;
        let (field, balance) = self.geometry.field(&bolts)?;
        let OverField {
            contacts,
            per_area,
            layer,
        } = law.over(&field)?;
        let elements = field.elements().iter();
        let parts = elements
            .zip(&contacts)
            .map(|(element, contact)| (element, element.pressure_pa, *contact));
        let (interface, part, patches) = self.joint(values, parts)?;
        let slips = match self.microslip {
            Some(microslip) => slip::fitted(patches, self.motions, microslip),
            None => Vec::new(),
        };
        Ok(State {
            torque_n_m,
            bolts,
            field,
            balance,
            contacts,
            per_area,
            layer,
            interface,
            part,
            slips,
        })
    }

    /// The joint of these values at a torque, for draws: the contact is computed at the knots of a curve over the pressure.
    pub(super) fn drawn_joint(
        &self,
        values: &Values,
        law: &Law,
        torque_n_m: Option<f64>,
    ) -> Result<Drawn, ModelError> {
        let bolts = self.clamping.bolts(values, torque_n_m)?;
        let mut pressures_pa = Vec::new();
        self.geometry.pressures(&bolts, &mut pressures_pa);
        let force_n = self.geometry.force_n(&pressures_pa);
        let contacts = law.drawn(&pressures_pa, force_n)?;
        let elements = self.geometry.elements().iter().zip(&pressures_pa);
        let parts = elements
            .zip(contacts)
            .map(|((element, &pressure_pa), contact)| (element, pressure_pa, contact));
        let parts: Vec<_> = parts.collect();
        let (interface, part, patches) = self.joint(values, parts.iter().copied())?;
        let slips = match self.microslip {
            Some(_) => slip::slipping(self.motions, self.reference_m)
                .map(|index| SlipSums::of(patches.get(index)))
                .collect(),
            None => Vec::new(),
        };
        Ok(Drawn {
            interface,
            part,
            slips,
        })
    }

    /// The interface of these elements with their pressures (Pa) and contacts, its part in the joint file's matrices, and the
    /// patches of each relative DOF that slips.
    fn joint<'e>(
        &self,
        values: &Values,
        parts: impl Iterator<Item = (&'e Element, f64, Contact)> + Clone,
    ) -> Result<(InterfaceJoint, PartOfInterface, Vec<Option<Patches>>), ModelError> {
        let of = |slips: bool| {
            let parts = parts.clone().map(move |(element, _, contact)| {
                let contact = if slips {
                    contact.along_normal()
                } else {
                    contact
                };
                (element, contact)
            });
            InterfaceJoint::new(parts, self.reference_m, self.normal_damping)
                .map_err(ModelError::Damping)
        };
        let interface = of(false)?;
        let part = |interface: &InterfaceJoint| {
            let part = self.motions.of(interface, self.frequency_hz);
            part.map_err(ModelError::Damping)
        };
        match (self.microslip, &self.contact) {
            (Some(_), ContactInputs::Fractal { friction, .. }) => {
                let coefficient = values.of(*friction);
                let patches = slip::patches(parts.clone(), &interface, self.motions, coefficient)?;
                // what slips is the law's, stiffness and heat
                Ok((interface, part(&of(true)?)?, patches))
            }
            _ => {
                let part = part(&interface)?;
                Ok((interface, part, Vec::new()))
            }
        }
    }

    /// The relative DOFs of the joint that slip.
    pub(super) fn slipping_dofs(&self) -> Vec<&'static Dof> {
        if self.microslip.is_none() {
            return Vec::new();
        }
        slip::slipping(self.motions, self.reference_m)
            .map(|index| self.motions.dofs().row(index))
            .collect()
    }
}
