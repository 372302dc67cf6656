//! Kavi's thesis on riveted layered beams: its 22 specimens, the numbers that it prints, and what it says of them, each checked
//! against its own equations.

mod claims;
mod printed;
mod specimens;

use serde::Serialize;

use super::ReproduceError;

pub use claims::{Claim, Verdict};
pub use printed::PrintedNumber;
pub use specimens::{
    AMPLITUDE_M, AtBoundary, BOUNDARIES, Material as SpecimenMaterial, SpecimenRow,
};

/// What comes out of the thesis.
#[derive(Clone, Debug, Serialize)]
pub struct KaviReproduction {
    /// Table 5.1 computed.
    pub specimens: Vec<SpecimenRow>,
    /// Printed numbers beside those that come out here.
    pub printed: Vec<PrintedNumber>,
    /// What chapters 5 to 7 say of the results.
    pub claims: Vec<Claim>,
}

/// Computes everything anew.
///
/// # Errors
/// None of the thesis's own numbers gives one.
pub fn kavi() -> Result<KaviReproduction, ReproduceError> {
    Ok(KaviReproduction {
        specimens: specimens::all()?,
        printed: printed::all()?,
        claims: claims::all()?,
    })
}

#[cfg(test)]
mod tests;
