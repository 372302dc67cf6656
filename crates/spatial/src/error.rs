//! Why no joint can be identified from functions that were read.

use bolted_joint_frf::Dof;
use bolted_joint_space::SpaceError;
use bolted_joint_study::StudyError;
use bolted_joint_virtual_point::VirtualPointError;
use thiserror::Error;

use crate::side::OfInterface;

impl From<OfInterface> for SpatialError {
    fn from(OfInterface { name, source }: OfInterface) -> Self {
        Self::Interface { name, source }
    }
}

/// Why no joint can be identified.
#[derive(Debug, Error)]
pub enum SpatialError {
    /// The joint's matrices.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// Too few numbers for the unknowns.
    #[error(
        "found {found} functions of the assembly at {lines} lines, {} numbers, expected more than the {unknowns} unknowns of the joint; \
         measure more, or take a model with fewer unknowns (joint.model)",
        2 * found * lines
    )]
    TooFewFunctions {
        /// Functions of the assembly.
        found: usize,
        /// Lines.
        lines: usize,
        /// Unknowns of the joint.
        unknowns: usize,
    },
    /// Noise of the substructures is too large nearly everywhere.
    #[error(
        "of {lines} lines, {kept} are left at which noise of the substructures moves the assembly's functions by less than {percent} %; \
         measure a and b with less noise, or state less (noise.a, noise.b)"
    )]
    TooMuchNoise {
        /// Lines of the study.
        lines: usize,
        /// Those that could be used.
        kept: usize,
        /// What noise may move, in percent of the functions.
        percent: f64,
    },
    /// No start leads anywhere.
    #[error(
        "no start of the search gives finite functions of the assembly; check the units of the files and the interface's length"
    )]
    NoStart,
    /// No start leads to a minimum, and where the search ended the functions say nothing of some unknowns.
    #[error(
        "{} led to a joint that explains the functions; check directions, positions, signs and gains of the set-up \
         (warnings name what fits least), or state larger errors of it in budget",
        match tried {
            1 => "the only search has not".to_owned(),
            tried => format!("none of {tried} searches has"),
        }
    )]
    NothingFound {
        /// Searches.
        tried: usize,
    },
    /// Noise and budget explain the functions with a joint of all numbers, and with none of the model's.
    #[error(
        "a joint of all numbers explains the functions, and none of {tried} searches for one with the numbers of the model does: the \
         joint is not what its model says, or not where; take model = \"full\", or state in budget.joint how far it may be beside its point"
    )]
    NotOfModel {
        /// Searches for the model's numbers.
        tried: usize,
    },
    /// An interface of a chain.
    #[error("{name}: {source}")]
    Interface {
        /// The table of the study with its sensors and impacts: `a`, `b.far`.
        name: String,
        /// What is wrong with it.
        source: VirtualPointError,
    },
    /// Places in mirrored coordinates.
    #[error(
        "{name}: the {places} look mirrored along {axis}: as they are written a rigid interface leaves {:.1} % of the functions, with \
         the other sign of {axis} {:.1} %; write their places in the right-handed axes that the directions are in", percent[0], percent[1]
    )]
    Mirrored {
        /// The table of the study with them.
        name: String,
        /// Sensors, impacts, or both.
        places: &'static str,
        /// Along which axis.
        axis: &'static str,
        /// What a rigid interface leaves of the functions, r.m.s. in percent: as they are, and mirrored.
        percent: [f64; 2],
    },
    /// Motions that no structure has.
    #[error(
        "{joint}: neither of its structures moves in {motions} where they meet, as structures in a plane do; seek the joint in the motions \
         that there are, with motions = [{has}] at the head of the study and the sensors and impacts that see them, or give structures \
         in space"
    )]
    Motionless {
        /// Its table in the study.
        joint: String,
        /// These motions.
        motions: String,
        /// Those that there are.
        has: String,
    },
    /// Two joints look the same.
    #[error(
        "the functions do not tell {} and {} apart (canonical correlation {correlation}): the part between them is as good as rigid and \
         without mass, and nothing is measured on it; measure on that part, or state one of the joints (known)", joints[0], joints[1]
    )]
    NotToldApart {
        /// Their tables in the study.
        joints: [String; 2],
        /// Largest canonical correlation of what changes of both do.
        correlation: f64,
    },
    /// Errors of a set-up beside several joints.
    #[error(
        "budget: found errors of sensors and impacts beside {sought} joints that are sought, expected budget = \"none\": they are \
         estimated with one joint, and known ones"
    )]
    BudgetOfSeveral {
        /// Joints that are sought.
        sought: usize,
    },
    /// A plan without noise.
    #[error(
        "noise.relative: found nothing, expected the noise of the test to be planned, in parts of each function's r.m.s., such as 0.01"
    )]
    NoNoise,
    /// A joint that is not said.
    #[error(
        "{joint}.expected: found nothing, expected what the joint is taken to be: a joint file, or {{ stiffness, damping }} with \
         a row and a column for each motion"
    )]
    NotExpected {
        /// Its table in the study.
        joint: String,
    },
    /// An expected joint that lacks what is sought.
    #[error(
        "{joint}.expected: found nothing in a motion of {name}, expected stiffness and damping in every motion of the model: a plan needs \
         to know how large they are; take a model without that motion, or state what it may be"
    )]
    NothingExpected {
        /// Its table in the study.
        joint: String,
        /// The unknown.
        name: String,
    },
    /// No sensors, or no impacts.
    #[error(
        "assembly: found no {what}, expected some: sensors and impacts near the interfaces, or responses and references elsewhere on the \
         parts"
    )]
    NoneOf {
        /// `sensors` or `impacts`.
        what: &'static str,
    },
    /// A DOF that nobody has.
    #[error("assembly: found {dof}, expected DOFs of the {what} of the parts")]
    NotThere {
        /// `sensors` or `impacts`.
        what: &'static str,
        /// The DOF.
        dof: Dof,
    },
    /// A candidate that cannot be.
    #[error("{key}: there is no such candidate: {source}")]
    Candidate {
        /// Its key in the study.
        key: String,
        /// Why not.
        source: Box<SpatialError>,
    },
    /// An unknown that there is not.
    #[error("--for: found {found}, expected some of {expected}")]
    NoSuchNumber {
        /// What was asked for.
        found: String,
        /// What there is.
        expected: String,
    },
    /// The study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Every joint is known.
    #[error(
        "joint: found every one known, expected one with a model to be sought; what the assembly answers says `bolted-joint respond`"
    )]
    AllKnown,
    /// The information matrix cannot be inverted.
    #[error(
        "the functions of the assembly do not tell the unknowns of the joint apart; measure with sensors on both sides, or take a model \
         with fewer unknowns (joint.model)"
    )]
    NotDetermined,
}
