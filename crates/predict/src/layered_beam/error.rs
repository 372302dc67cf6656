//! What cannot be a layered beam, or is outside of what the model says.

use thiserror::Error;

use super::super::uncertain::MonteCarloError;
use bolted_joint_frf::structure::BeamError;

/// Why a layered beam, its fasteners or its damping make no sense.
#[derive(Debug, Error, PartialEq)]
pub enum LayeredBeamError {
    /// Something that has a size has none.
    #[error("`{key}`: found {found} {unit}, expected a positive number")]
    NotPositive {
        /// Key in a study.
        key: &'static str,
        /// Value found.
        found: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Fewer than two layers have no interface.
    #[error(
        "`beam.layer`: found {found}, expected at least two: a solid beam has no interface that slips"
    )]
    Layers {
        /// Number found.
        found: usize,
    },
    /// A jointed beam stiffer than the solid one.
    #[error(
        "`beam.stiffness_ratio`: found {found}, expected more than 0 and at most 1: the stiffness of the jointed beam over that of the solid one"
    )]
    StiffnessRatio {
        /// Value found.
        found: f64,
    },
    /// A beam higher than it is long.
    #[error(
        "`beam.layer.thickness`: found {height_m} m in all on a length of {length_m} m, expected a slender beam: shear and rotary inertia are left out"
    )]
    NotSlender {
        /// Sum of the thicknesses, m.
        height_m: f64,
        /// Length, m.
        length_m: f64,
    },
    /// Adjacent layers too different for the pressure's table.
    #[error(
        "`beam.layer.thickness`: found layers {interface} and {} with a thickness ratio of {ratio:.4}, expected 1 to 2: the pressure is known between these ratios", interface + 1
    )]
    ThicknessRatio {
        /// The interface, counted from one.
        interface: usize,
        /// Thicker over thinner layer.
        ratio: f64,
    },
    /// No fastener, or one that is not on the beam.
    #[error("`fasteners.positions`: found {found}, expected positions between 0 and {length_m} m")]
    Position {
        /// What was found.
        found: String,
        /// Length of the beam, m.
        length_m: f64,
    },
    /// A hole wider than the beam.
    #[error(
        "`fasteners.diameter`: found {diameter_m} m on a beam {width_m} m wide, expected less than the width"
    )]
    Diameter {
        /// Diameter, m.
        diameter_m: f64,
        /// Width of the beam, m.
        width_m: f64,
    },
    /// Modes count from one.
    #[error("`motion.mode`: found {found}, expected 1 to {most}")]
    Mode {
        /// Value found.
        found: usize,
        /// Highest.
        most: usize,
    },
    /// The mode does not move where it is driven.
    #[error(
        "`motion.drive_point`: found {x_m} m, where mode {mode} moves by {share:.1e} of its largest deflection, expected a point that it moves, such as {antinode_m:.4} m"
    )]
    Node {
        /// The point, m.
        x_m: f64,
        /// The mode.
        mode: usize,
        /// |φ| over the largest.
        share: f64,
        /// Where the deflection is largest, m.
        antinode_m: f64,
    },
    /// A drive point off the beam.
    #[error("`motion.drive_point`: found {x_m} m, expected 0 to {length_m} m")]
    DrivePoint {
        /// The point, m.
        x_m: f64,
        /// Length of the beam, m.
        length_m: f64,
    },
    /// A beam that is held nowhere has no static stiffness.
    #[error(
        "`motion.stored_energy`: found \"static\" for a beam that is held nowhere, expected \"modal\""
    )]
    NoStaticStiffness,
    /// No fastener is where the layers slip.
    #[error(
        "`fasteners.positions`: found no fastener where mode {mode} has a slope, expected one: without slip there is no damping to compute or to calibrate"
    )]
    NoSlip {
        /// The mode.
        mode: usize,
    },
    /// A range of amplitudes that is none.
    #[error(
        "`{key}`: found {from} to {to} m, expected positive amplitudes from a smaller to a larger one"
    )]
    Range {
        /// Key in a study.
        key: &'static str,
        /// First, m.
        from: f64,
        /// Last, m.
        to: f64,
    },
    /// Nothing follows from the draws.
    #[error("`uncertainty`: {0}")]
    MonteCarlo(MonteCarloError),
    /// The finite elements fail.
    #[error(transparent)]
    FiniteElements(#[from] BeamError),
}

/// Refuses what is not a positive number.
pub(super) fn positive(
    key: &'static str,
    found: f64,
    unit: &'static str,
) -> Result<(), LayeredBeamError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(LayeredBeamError::NotPositive { key, found, unit })
    }
}
