//! What a layer amounts to as a joint between two parts.

use super::Moduli;
use crate::number::{NumberError, positive};
use crate::pressure::{PressureError, PressureField};

/// The face of the layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interface {
    /// Area A, in m².
    pub area_m2: f64,
    /// Its centre along both in-plane axes, in m.
    pub centre_m: [f64; 2],
    /// Second moments ∫ y² dA and ∫ x² dA about the centre, which rotations about the x and about the y axis feel, in m⁴.
    pub second_moments_m4: [f64; 2],
}

impl Interface {
    /// A rectangle about the origin, `width_m` along x and `depth_m` along y.
    ///
    /// # Errors
    /// A length is not positive.
    pub fn rectangle(width_m: f64, depth_m: f64) -> Result<Self, NumberError> {
        length("the width", width_m)?;
        length("the depth", depth_m)?;
        let area_m2 = width_m * depth_m;
        Ok(Self {
            area_m2,
            centre_m: [0.0; 2],
            // I = b h³/12
            second_moments_m4: [depth_m, width_m].map(|length| area_m2 * length * length / 12.0),
        })
    }

    /// The elements of a field that touch, each with its area at its centre.
    ///
    /// # Errors
    /// No element has a pressure.
    pub fn in_contact(field: &PressureField) -> Result<Self, PressureError> {
        let touching = || {
            field
                .elements()
                .iter()
                .filter(|element| element.pressure_pa > 0.0)
        };
        let area_m2: f64 = touching().map(|element| element.area_m2).sum();
        if area_m2 == 0.0 {
            return Err(PressureError::Apart);
        }
        let [x, y] = touching()
            .fold([0.0; 2], |[x, y], element| {
                [
                    x + element.area_m2 * element.x_m,
                    y + element.area_m2 * element.y_m,
                ]
            })
            .map(|sum| sum / area_m2);
        let second_moments_m4 = touching().fold([0.0; 2], |[about_x, about_y], element| {
            [
                about_x + element.area_m2 * (element.y_m - y).powi(2),
                about_y + element.area_m2 * (element.x_m - x).powi(2),
            ]
        });
        Ok(Self {
            area_m2,
            centre_m: [x, y],
            second_moments_m4,
        })
    }
}

/// Stiffnesses of a layer between two parts that are rigid at its faces, about the centre of its face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointStiffness {
    /// Across the layer, E A/h, in N/m.
    pub normal_n_per_m: f64,
    /// Along the layer, G_x A/h, in N/m.
    pub tangential_n_per_m: f64,
    /// Rotation about the in-plane x and y axes, E I/h, in N·m/rad.
    pub bending_n_m_per_rad: [f64; 2],
    /// Rotation about the normal, G_x (I_x + I_y)/h, in N·m/rad.
    pub torsion_n_m_per_rad: f64,
}

impl JointStiffness {
    /// Of a layer of moduli and thickness (m) with a face. Sideways contraction, which the parts hinder, is left out.
    ///
    /// # Errors
    /// The thickness is not positive.
    pub fn new(
        moduli: Moduli,
        thickness_m: f64,
        interface: &Interface,
    ) -> Result<Self, NumberError> {
        length("the thickness", thickness_m)?;
        let [young, shear] = [moduli.youngs_modulus_pa, moduli.shear_modulus_pa]
            .map(|modulus| modulus / thickness_m);
        let [about_x, about_y] = interface.second_moments_m4;
        Ok(Self {
            normal_n_per_m: young * interface.area_m2,
            tangential_n_per_m: shear * interface.area_m2,
            bending_n_m_per_rad: [young * about_x, young * about_y],
            torsion_n_m_per_rad: shear * (about_x + about_y),
        })
    }
}

fn length(quantity: &'static str, found: f64) -> Result<(), NumberError> {
    positive(quantity, found, " m", "a positive length")
}
