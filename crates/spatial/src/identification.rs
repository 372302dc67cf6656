//! What was found, with its deviations.

use bolted_joint_frf::Dof;
use bolted_joint_virtual_point::Change;
use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::spread::WHOLES;

/// 97.5 % quantile of the normal distribution.
pub(crate) const QUANTILE: f64 = 1.959_963_984_540_054;

/// One number of the joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its name in the model's axes, such as `k_x` or `c_x_ry`.
    pub name: String,
    /// SI units, of a passive joint.
    pub value: f64,
    /// Without that constraint.
    pub free: f64,
    /// Standard deviation, with the errors of the set-up.
    pub deviation: f64,
    /// That of noise alone.
    pub deviation_by_noise: f64,
    /// Whether the functions determine it: its deviation is smaller than what couples its motions at most.
    pub is_determined: bool,
}

impl Unknown {
    /// Whether it is a stiffness of one motion, and none between two.
    pub(crate) fn is_stiffness(&self) -> bool {
        let motion = self.name.strip_prefix("k_");
        motion.is_some_and(|motion| !motion.contains('_'))
    }

    /// Interval of 95 %, about the free estimate and with the passive one in it.
    #[must_use]
    pub fn interval_95(&self) -> [f64; 2] {
        let [low, high] = [-1.0, 1.0].map(|sign| self.free + sign * QUANTILE * self.deviation);
        [low.min(self.value), high.max(self.value)]
    }
}

/// Noise of the substructures' functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Substructures {
    /// Lines at which it moves the assembly's functions too far; they do not take part.
    pub lines_left_out: usize,
    /// What it moves at the others, in parts of the functions, r.m.s.
    pub moves: f64,
}

/// What one kind of errors of the set-up adds.
#[derive(Clone, Debug)]
pub struct Group {
    /// `sensors of a` and so on.
    pub name: String,
    /// Standard deviations of the entries of K and of C that it makes by itself.
    pub deviations: [Matrix6<f64>; 2],
    /// Largest part of an unknown's variance that is its.
    pub largest_share: f64,
}

impl Group {
    /// Whether an error is one of them.
    #[must_use]
    pub fn has(&self, error: &SetUpError) -> bool {
        let side = self.name.rsplit(' ').next().unwrap_or_default();
        let key = match self.name.starts_with("sensors") {
            true => format!("{side}.sensors["),
            false => format!("{side}.impacts["),
        };
        match self.name == WHOLES {
            true => error.is_whole,
            false => error.key.starts_with(&key),
        }
    }
}

/// An error of the set-up, as it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct SetUpError {
    /// The sensor's or impact's key in the study, such as `a.sensors[0]`; or what is off as a whole, such as `a as a whole`.
    pub key: String,
    /// Whether it is one of all places of an interface, or of the joint, and not of one sensor or impact.
    pub is_whole: bool,
    /// Which number of it.
    pub change: Change,
    /// m, rad or parts of the gain.
    pub value: f64,
    /// Its standard deviation with all data.
    pub deviation: f64,
    /// That of the budget.
    pub expected: f64,
}

/// An error is told where its deviation is less than this part of the budget's.
const TOLD: f64 = 0.95;

impl SetUpError {
    /// Whether the functions tell more of it than the budget does.
    #[must_use]
    pub fn is_told(&self) -> bool {
        self.deviation < TOLD * self.expected
    }

    /// Value over the budget's deviation.
    #[must_use]
    pub fn pull(&self) -> f64 {
        self.value / self.expected
    }
}

/// One function of the assembly, measured and computed with the joint that was found.
#[derive(Clone, Debug)]
pub struct FunctionFit {
    /// Response.
    pub response: Dof,
    /// Reference.
    pub reference: Dof,
    /// Receptance at each line of the study.
    pub measured: Vec<Complex64>,
    /// Likewise.
    pub computed: Vec<Complex64>,
    /// |measured − computed| over |computed|, r.m.s. over the lines that took part.
    pub relative_rms: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct SpatialIdentification {
    /// The unknowns of stiffness, then those of damping.
    pub unknowns: Vec<Unknown>,
    /// K, N/m, N/rad, N·m/rad.
    pub stiffness: Matrix6<f64>,
    /// C, in the units of K times s.
    pub damping: Matrix6<f64>,
    /// K and C without the constraint that the joint be passive, where that is another estimate.
    pub free: Option<[Matrix6<f64>; 2]>,
    /// Standard deviations of the entries of K and of C.
    pub deviations: [Matrix6<f64>; 2],
    /// Those of noise alone.
    pub deviations_by_noise: [Matrix6<f64>; 2],
    /// Covariances of the 21 numbers of K and of those of C, in the order of [`Entry::ALL`](bolted_joint_space::Entry::ALL).
    pub covariances: [DMatrix<f64>; 2],
    /// Correlation of the unknowns.
    pub correlation: DMatrix<f64>,
    /// Root mean square of |measured − computed|/|computed|'s r.m.s. of each function.
    pub relative_rms: f64,
    /// Functions of the assembly and lines that were compared.
    pub functions: usize,
    /// Lines.
    pub lines: usize,
    /// Where noise of the substructures takes part, what it does.
    pub substructures: Option<Substructures>,
    /// Frequencies of the study, Hz.
    pub frequency_hz: Vec<f64>,
    /// The strongest functions, from both sides where they have any.
    pub fits: Vec<FunctionFit>,
    /// χ² over degrees of freedom where the noise is stated.
    pub reduced_chi_squared: Option<f64>,
    /// Squares of the errors of the set-up that were found, over those of the budget; `None` without errors.
    pub budget_used: Option<f64>,
    /// Searches, from one start or on one way each, and how many came to the same minimum.
    pub starts: [usize; 2],
    /// What errors of the set-up add to the deviations: of sensors and of impacts of each side, where they take part.
    pub groups: Vec<Group>,
    /// Errors of the set-up: of the sensors and impacts of a, then of b.
    pub errors: Vec<SetUpError>,
    /// What to know about the result that does not speak against relying on it.
    pub warnings: Vec<String>,
    /// Why the result is not to be relied on.
    pub reasons_against: Vec<String>,
}
