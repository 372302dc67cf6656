//! The bolts of chapter 5: published estimates, and the beams that they join.

use crate::error::ReproduceError;
use crate::published::PublishedTable;
use bolted_joint_frf::structure::Beam;
use bolted_joint_identify::Lines;

use super::structures::{self, PublishedModes, joint};

/// Noise on the synthesised assemblies: the lowest of section 4.3. That of the measurements is not published.
pub(super) const LEVEL: f64 = 0.01;

/// A bolt that chapter 5 identifies.
pub(super) struct Bolt {
    /// The table that holds its estimates.
    pub(super) table: PublishedTable,
    /// Modes of substructure A.
    pub(super) modes: PublishedModes,
    /// Substructure B.
    pub(super) beam: Beam,
    /// Published initial estimates: k_Fy, k_Fθ, k_Mθ, c_Fy, c_Fθ, c_Mθ.
    pub(super) initial: [f64; 6],
    /// Published updated values.
    pub(super) updated: [f64; 6],
    /// Points of B that the identification uses: 0 to 2 are 1s to 3s.
    pub(super) used: &'static [usize],
    /// Published resonances, Hz, by their number from 1.
    pub(super) resonances_hz: &'static [(usize, f64)],
}

impl Bolt {
    /// A, B and their assembly by the published updated joint, at points 1s to 3s, without noise.
    pub(super) fn lines(&self) -> Result<Lines, ReproduceError> {
        structures::assembled(self.modes, &self.beam, &joint(self.updated))
    }
}

/// Table 5.3.
pub(super) fn m10x16() -> Bolt {
    Bolt {
        table: PublishedTable::M10x16,
        modes: structures::ALUMINIUM_M10,
        beam: structures::aluminium_b(),
        initial: [1.71e5, -7.68e3, 1.31e3, 10.8, -0.84, 0.28],
        updated: [5.73e5, 5.82e3, 1.29e3, 10.83, -0.83, 0.083],
        used: &[0, 1, 2],
        resonances_hz: &[(2, 112.5), (3, 344.0)],
    }
}

/// Table 5.4.
pub(super) fn m8x16() -> Bolt {
    Bolt {
        table: PublishedTable::M8x16,
        modes: structures::ALUMINIUM_M8,
        beam: structures::aluminium_b(),
        initial: [2.12e5, -1.17e4, 7.80e2, 6.09, -0.978, 0.0],
        updated: [5.04e5, -1.21e4, 1.22e3, 5.04, 1.20, 0.0],
        used: &[1],
        resonances_hz: &[],
    }
}

/// Table 5.5.
pub(super) fn m10x35() -> Bolt {
    Bolt {
        table: PublishedTable::M10x35,
        modes: structures::STEEL_M10,
        beam: structures::steel_b_m10(),
        initial: [1.71e6, 5.12e4, 2.5e3, 34.72, 0.646, 0.073],
        updated: [2.02e6, 2.47e4, 2.8e3, 34.41, 0.635, 0.077],
        used: &[1],
        resonances_hz: &[],
    }
}

/// Table 5.6.
pub(super) fn m8x35() -> Bolt {
    Bolt {
        table: PublishedTable::M8x35,
        modes: structures::STEEL_M8,
        beam: structures::steel_b_m8(),
        initial: [1.83e6, 5.53e4, 2.9e3, 42.2, 0.848, 0.139],
        updated: [2.14e6, 2.66e4, 3.2e3, 41.2, 0.845, 0.119],
        used: &[1],
        resonances_hz: &[],
    }
}

/// Table 5.9.
pub(super) fn m6x30() -> Bolt {
    Bolt {
        table: PublishedTable::M6x30,
        modes: structures::STEEL_M6,
        beam: structures::steel_b_m6(),
        initial: [2.06e6, 7.40e4, 2.9e3, 80.4, 2.52, 0.139],
        updated: [2.27e6, 3.89e4, 3.7e3, 75.7, 0.94, 0.164],
        used: &[1],
        resonances_hz: &[],
    }
}
