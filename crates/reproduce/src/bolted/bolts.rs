//! The bolts of chapter 5: published joints, and the beams that they join, of `bolts.toml`.

use serde::Deserialize;

use crate::error::ReproduceError;
use bolted_joint_frf::structure::Beam;
use bolted_joint_identify::Lines;

use super::structures::{self, SubstructureA, joint};

/// Noise on the synthesised assemblies: the lowest of section 4.3. That of the measurements is not published.
pub(super) const LEVEL: f64 = 0.01;

/// What chapter 5 identifies.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bolts {
    pub(crate) m10x16: Bolt,
    pub(crate) m8x16: Bolt,
    pub(crate) m10x35: Bolt,
    pub(crate) m8x35: Bolt,
    pub(crate) m6x30: Bolt,
    /// M8x35 at four torques.
    pub(crate) torques: Vec<State>,
    /// M6x30 of two qualities.
    pub(crate) qualities: Vec<State>,
}

/// A bolt that chapter 5 identifies.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bolt {
    /// Modes of substructure A.
    pub(super) modes: SubstructureA,
    /// Substructure B.
    pub(super) beam: Beam,
    /// Published initial estimates: k_Fy, k_Fθ, k_Mθ, c_Fy, c_Fθ, c_Mθ.
    pub(super) initial: [f64; 6],
    /// Published updated values.
    pub(super) updated: [f64; 6],
    /// Points of B that the identification uses: 0 to 2 are 1s to 3s.
    pub(super) used: Vec<usize>,
    /// Published resonances, Hz, by their number from 1.
    #[serde(default)]
    pub(super) resonances_hz: Vec<(usize, f64)>,
}

/// A bolt at a torque, or of a quality, and its published joint.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct State {
    pub(super) name: String,
    pub(super) joint: [f64; 6],
}

impl Bolts {
    pub(crate) fn published() -> Result<Self, ReproduceError> {
        Ok(toml::from_str(include_str!("bolts.toml"))?)
    }
}

impl Bolt {
    /// A, B and their assembly by the published updated joint, at points 1s to 3s, without noise.
    pub(super) fn lines(&self) -> Result<Lines, ReproduceError> {
        structures::assembled(self.modes, &self.beam, &joint(self.updated))
    }
}
