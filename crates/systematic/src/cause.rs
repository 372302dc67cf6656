//! The causes of systematic errors, by name.

use std::fmt;

/// One of the two structures that the joint connects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Substructure A.
    A,
    /// Substructure B, which has the points of the assembly.
    B,
}

/// A set of functions that were measured together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeasuredSet {
    /// Those of a substructure.
    Of(Side),
    /// Those of an assembly; there may be several.
    Assembly(usize),
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "A",
            Self::B => "B",
        })
    }
}

impl fmt::Display for MeasuredSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(side) => side.fmt(f),
            Self::Assembly(0) => f.write_str("the assembly"),
            Self::Assembly(number) => write!(f, "assembly {}", number + 1),
        }
    }
}

/// Something about the set-up that is not known exactly. Numbers count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// Gain of all functions of a set; relative.
    Gain(MeasuredSet),
    /// Gain that all sets have in common; relative.
    CommonGain,
    /// Gain of a response channel of a set; relative.
    ChannelGain(MeasuredSet, usize),
    /// Delay that all sets have in common, s.
    CommonDelay,
    /// Delay of a set, s.
    Delay(MeasuredSet),
    /// Constant phase of a set, rad.
    Phase(MeasuredSet),
    /// Mass of an accelerometer that moves from point to point, beyond what the data are corrected for, kg.
    Accelerometer(MeasuredSet),
    /// Position of a point of the assemblies, m.
    Position(usize),
    /// Position of the joint at a bolt of a structure, m.
    JointPosition(Side, usize),
    /// Length of a structure that bends between the joint at a bolt and where it was taken to be, m.
    JointBending(Side, usize),
    /// Frequencies of a structure in the assembly over those in its own test; relative.
    Frequency(Side),
    /// Young's modulus of a computed structure; relative.
    YoungsModulus(Side),
    /// Density of a computed structure; relative.
    Density(Side),
    /// Damping of a computed structure; relative.
    StructureDamping(Side),
    /// Mass at a bolt of a structure that only the assembly has, kg.
    JointMass(Side, usize),
    /// Moment of inertia at a bolt of a structure that only the assembly has, kg·m².
    JointInertia(Side, usize),
    /// Loss factor of the joint beside its damping.
    LossFactor,
    /// Bending stiffness that the correction of a rotation by differences is made with; relative.
    DifferenceStiffness(Side),
    /// Distance between the points that a rotation is the difference of; relative.
    DifferenceSpacing(Side),
}

/// Causes that one calibration would settle together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// Gains of the sets, and what they have in common.
    Gains,
    /// Gains of single channels.
    Channels,
    /// Delays and phases.
    Timing,
    /// Masses of accelerometers.
    Accelerometers,
    /// Positions of points and of the joint.
    Positions,
    /// Frequencies of the structures after they were clamped again.
    Clamping,
    /// Material and damping of computed structures, and bending stiffness of corrections.
    Material,
    /// Mass at the joint.
    JointMass,
    /// Loss factor of the joint.
    LossFactor,
}

impl Group {
    /// Every group.
    pub const ALL: [Self; 9] = [
        Self::Gains,
        Self::Channels,
        Self::Timing,
        Self::Accelerometers,
        Self::Positions,
        Self::Clamping,
        Self::Material,
        Self::JointMass,
        Self::LossFactor,
    ];

    /// What it is, for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Gains => "gains",
            Self::Channels => "channel gains",
            Self::Timing => "delays",
            Self::Accelerometers => "accelerometers",
            Self::Positions => "positions",
            Self::Clamping => "frequencies",
            Self::Material => "material",
            Self::JointMass => "joint mass",
            Self::LossFactor => "loss factor",
        }
    }

    /// What would make it smaller.
    #[must_use]
    pub fn remedy(self) -> &'static str {
        match self {
            Self::Gains | Self::Channels => {
                "calibrate the sensors against each other with a known mass"
            }
            Self::Timing => "measure the delay between the channels",
            Self::Accelerometers => "weigh the accelerometers and correct the data for them",
            Self::Positions => "measure the positions of the sensors and of the joint",
            Self::Clamping => "measure the substructures again after the assembly was taken apart",
            Self::Material => "fit the material to the structure's own resonances",
            Self::JointMass => "weigh the bolt and the washers",
            Self::LossFactor => {
                "measure at several levels or over a wider range to tell damping and loss factor apart"
            }
        }
    }
}

impl Cause {
    /// The group that it belongs to.
    #[must_use]
    pub fn group(self) -> Group {
        match self {
            Self::Gain(_) | Self::CommonGain => Group::Gains,
            Self::ChannelGain(..) => Group::Channels,
            Self::CommonDelay | Self::Delay(_) | Self::Phase(_) => Group::Timing,
            Self::Accelerometer(_) => Group::Accelerometers,
            Self::Position(_)
            | Self::JointPosition(..)
            | Self::JointBending(..)
            | Self::DifferenceSpacing(_) => Group::Positions,
            Self::Frequency(_) => Group::Clamping,
            Self::YoungsModulus(_)
            | Self::Density(_)
            | Self::StructureDamping(_)
            | Self::DifferenceStiffness(_) => Group::Material,
            Self::JointMass(..) | Self::JointInertia(..) => Group::JointMass,
            Self::LossFactor => Group::LossFactor,
        }
    }

    /// Whether it equals a change of the joint, or nearly so, and data hardly tell it from one: it makes intervals wider, and never
    /// stands out.
    #[must_use]
    pub fn is_hidden(self) -> bool {
        matches!(
            self,
            Self::CommonGain | Self::CommonDelay | Self::JointBending(..)
        )
    }

    /// A value of it in a unit that people read, and that unit.
    #[must_use]
    pub fn shown(self, value: f64) -> (f64, &'static str) {
        match self {
            Self::CommonDelay | Self::Delay(_) => (1e6 * value, "µs"),
            Self::Phase(_) => (value.to_degrees(), "°"),
            Self::Accelerometer(_) | Self::JointMass(..) => (1e3 * value, "g"),
            Self::JointInertia(..) => (1e6 * value, "kg·mm²"),
            Self::Position(_) | Self::JointPosition(..) | Self::JointBending(..) => {
                (1e3 * value, "mm")
            }
            Self::Gain(_)
            | Self::CommonGain
            | Self::ChannelGain(..)
            | Self::Frequency(_)
            | Self::YoungsModulus(_)
            | Self::Density(_)
            | Self::StructureDamping(_)
            | Self::LossFactor
            | Self::DifferenceStiffness(_)
            | Self::DifferenceSpacing(_) => (1e2 * value, "%"),
        }
    }
}
