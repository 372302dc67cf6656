//! What the interface's patches do under the motion of each relative DOF of the joint, where they slip.

use bolted_joint_dynamics::{
    Dof, DofKind,
    law::{Iwan, Law, Parameter},
};
use bolted_joint_joint::unit;

use super::error::ModelError;
use super::results::Unknown;
use crate::microslip::{Amplitudes, MicroslipLaw, Patch, Patches};
use crate::patch::{Axis, Contact, InterfaceJoint, Motion, Motions};
use crate::pressure::Element;

/// How much of its own stiffness a motion may share with another one's slip.
const COUPLED: f64 = 1e-6;

/// That an interface slips under the joint's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microslip {
    /// Amplitudes that the law is fitted in; from hardly any slip to much of it where there are none.
    pub amplitudes: Option<Amplitudes>,
}

/// The friction of one relative DOF.
#[derive(Debug, Clone, PartialEq)]
pub struct Slip {
    /// The DOF.
    pub dof: &'static Dof,
    /// All patches that slip under its motion.
    pub patches: Patches,
    /// The law in their place.
    pub fitted: MicroslipLaw,
}

/// Slip force and stiffness of one relative DOF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SlipSums {
    pub(super) slip_force: f64,
    pub(super) stiffness: f64,
}

impl SlipSums {
    pub(super) fn of(patches: Option<&Option<Patches>>) -> Self {
        let patches = patches.and_then(Option::as_ref);
        Self {
            slip_force: patches.map_or(0.0, Patches::slip_force),
            stiffness: patches.map_or(0.0, Patches::stiffness),
        }
    }
}

/// Which relative DOFs of a joint slide patches along the interface, about a reference point at this place (m).
pub(super) fn slipping(motions: Motions, reference_m: [f64; 3]) -> impl Iterator<Item = usize> {
    (0..motions.dofs().count()).filter(move |&index| slides(&motions.each()[index], reference_m))
}

/// Whether a motion about a reference point at this place (m) slides patches along the interface.
fn slides(motion: &Motion, reference_m: [f64; 3]) -> bool {
    match motion.kind {
        DofKind::Translation => motion.axis.axis != Axis::Z,
        DofKind::Rotation => motion.axis.axis == Axis::Z || reference_m[2] != 0.0,
    }
}

/// The patches of each relative DOF that slips: `None` of one along which nothing does.
///
/// Each DOF slips by itself: that the friction of a patch is shared by motions at the same time is left out.
///
/// # Errors
/// [`ModelError::CoupledSlip`] where a motion slides the patches along that of another one.
pub(super) fn patches<'e>(
    parts: impl Iterator<Item = (&'e Element, f64, Contact)> + Clone,
    interface: &InterfaceJoint,
    motions: Motions,
    friction: f64,
) -> Result<Vec<Option<Patches>>, ModelError> {
    let arm = |element: &Element, motion: &Motion| {
        interface.tangential_arm(element, motion.axis.axis, motion.kind == DofKind::Rotation)
    };
    let along = |motion: &Motion| {
        let parts = parts.clone().map(|(element, pressure_pa, contact)| {
            let arm = arm(element, motion);
            let length = arm[0].hypot(arm[1]);
            Patch {
                // what it resists with at a unit of the motion: k_t |t|² ΔA and μ p |t| ΔA, t its tangential displacement
                stiffness: contact.tangential_stiffness_n_per_m3
                    * length
                    * length
                    * element.area_m2,
                slip_force: friction * pressure_pa * length * element.area_m2,
            }
        });
        Patches::new(parts)
    };
    let found: Vec<Option<Patches>> = motions.each().iter().map(along).collect();
    let slipping: Vec<(&Motion, &Patches)> = motions
        .each()
        .iter()
        .zip(&found)
        .filter_map(|(motion, patches)| Some((motion, patches.as_ref()?)))
        .collect();
    for (place, (one, first)) in slipping.iter().enumerate() {
        for (other, second) in &slipping[..place] {
            let shared: f64 = parts
                .clone()
                .map(|(element, _, contact)| {
                    let [a, b] = [one, other].map(|motion| arm(element, motion));
                    let density = contact.tangential_stiffness_n_per_m3 * element.area_m2;
                    density * (a[0] * b[0] + a[1] * b[1])
                })
                .sum();
            let part = shared.abs() / (first.stiffness() * second.stiffness()).sqrt();
            if part > COUPLED {
                return Err(ModelError::CoupledSlip { part });
            }
        }
    }
    Ok(found)
}

/// The law of each DOF that slips.
pub(super) fn fitted(
    patches: Vec<Option<Patches>>,
    motions: Motions,
    microslip: Microslip,
) -> Vec<Slip> {
    let dofs = motions.dofs();
    let is_translation = |index: usize| motions.each()[index].kind == DofKind::Translation;
    let translates =
        (0..patches.len()).any(|index| is_translation(index) && patches[index].is_some());
    let of = |(index, patches): (usize, Option<Patches>)| {
        let patches = patches?;
        // amplitudes of a study are those of translations, unless rotations slip alone
        let of_study = is_translation(index) || !translates;
        let given = microslip.amplitudes.filter(|_| of_study);
        let amplitudes = given.unwrap_or_else(|| Amplitudes::of(&patches));
        Some(Slip {
            dof: dofs.row(index),
            fitted: MicroslipLaw::of(&patches, amplitudes),
            patches,
        })
    };
    patches.into_iter().enumerate().filter_map(of).collect()
}

impl Slip {
    /// The law's numbers, by the names of the FMU's variables.
    pub(super) fn unknowns(&self) -> impl Iterator<Item = Unknown> {
        let mut values = [0.0; <Iwan as Law<f64>>::DECLARATION.parameters.len()];
        self.fitted.law.write(&mut values);
        let dof = self.dof;
        parameters().zip(values).map(|(parameter, value)| Unknown {
            name: name(parameter, dof),
            value,
            unit: unit(parameter.unit, dof.kind, dof.kind),
        })
    }
}

/// Names of slip force and stiffness on a DOF.
pub(super) fn sum_names(dof: &Dof) -> impl Iterator<Item = String> {
    parameters().take(2).map(|parameter| name(parameter, dof))
}

fn parameters() -> impl Iterator<Item = &'static Parameter> {
    <Iwan as Law<f64>>::DECLARATION.parameters.iter()
}

/// Name of a number of the law on a DOF.
pub(super) fn name(parameter: &Parameter, dof: &Dof) -> String {
    format!("{}_{}", parameter.symbol, dof.name)
}
