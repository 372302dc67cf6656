//! The material as text for other programs, in SI units.

use thiserror::Error;

use super::VirtualMaterial;

/// Longest name that Abaqus takes.
const LONGEST_NAME: usize = 80;

/// A form of material card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Card {
    /// A table with a header: quantity, value, unit.
    Csv,
    /// Keywords of an Abaqus input file.
    Abaqus,
    /// Commands of Mechanical APDL for the material of this number.
    Ansys(u32),
}

/// A card that cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the {what}; expected {expected}")]
pub struct CardError {
    /// What is wrong with it.
    pub what: String,
    /// What was expected.
    pub expected: &'static str,
}

impl Card {
    /// The text of a material's card.
    ///
    /// # Errors
    /// The name or number is not one that the program takes.
    pub fn text(self, material: &VirtualMaterial, name: &str) -> Result<String, CardError> {
        let is_name = name.starts_with(|first: char| first.is_ascii_alphabetic())
            && name.len() <= LONGEST_NAME
            && name
                .chars()
                .all(|one| one.is_ascii_alphanumeric() || "_-".contains(one));
        if !is_name {
            return Err(CardError {
                what: format!("material's name is \"{name}\""),
                expected: "a letter, then letters, digits, \"_\" or \"-\", 80 characters at most",
            });
        }
        let young = number(material.youngs_modulus_pa);
        let shear = number(material.shear_modulus_pa);
        let poisson = number(material.poissons_ratio);
        let density = number(material.density_kg_per_m3);
        let thickness = number(material.thickness_m);
        match self {
            Self::Csv => Ok(format!(
                "quantity,value,unit\n\
                 youngs_modulus,{young},Pa\n\
                 shear_modulus,{shear},Pa\n\
                 poissons_ratio,{poisson},1\n\
                 density,{density},kg/m^3\n\
                 thickness,{thickness},m\n"
            )),
            Self::Abaqus => Ok(format!(
                "** Layer that stands for a bolted joint, {thickness} m thick. Units: N, m, kg, s.\n\
                 *MATERIAL, NAME={name}\n\
                 *ELASTIC\n\
                 {young}, {poisson}\n\
                 *DENSITY\n\
                 {density},\n"
            )),
            Self::Ansys(0) => Err(CardError {
                what: "number of the material is 0".to_owned(),
                expected: "1 or more",
            }),
            Self::Ansys(place) => Ok(format!(
                "! {name}: layer that stands for a bolted joint, {thickness} m thick. Units: N, m, kg, s.\n\
                 MP,EX,{place},{young}\n\
                 MP,PRXY,{place},{poisson}\n\
                 MP,DENS,{place},{density}\n"
            )),
        }
    }
}

/// Thirteen digits: with sign and exponent no more than the 20 characters that Abaqus reads.
fn number(value: f64) -> String {
    format!("{value:.12E}")
}
