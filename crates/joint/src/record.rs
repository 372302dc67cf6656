//! The records of the joint file, format "bolted-joint/1", as plain data.

#[cfg(test)]
use bolted_joint_dynamics::SPACE_COUNT;
#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use super::schema::{
    entries_above_zero, with_friction, with_friction_deviations, with_friction_over_preload,
};
use super::{About, DofSet, Friction, HigherTerms, Status};

/// A bolted joint, with what is known about it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(title = "Joint file of bolted-joint"))]
pub struct JointFile {
    /// Version of the format.
    pub format: Format,
    /// Name of the joint, one line.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub name: String,
    /// Who stands behind the joint, and what others may do with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<About>,
    /// Whether the joint may be relied on; without it, it may.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub status: Option<Status>,
    /// The joint itself: stiffness and damping, linear and beyond.
    pub joint: Joint,
    /// The two bodies of a lap model that the joint connects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bodies: Option<Bodies>,
    /// How well the joint's parameters are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<Uncertainty>,
    /// Where the joint's parameters hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validity: Option<Validity>,
    /// How far the model is from the measurement that it was identified from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<Residual>,
    /// Where the parameters come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

/// Version of the joint file's format.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub enum Format {
    /// The first and only version.
    #[default]
    #[serde(rename = "bolted-joint/1")]
    V1,
}

impl Format {
    /// The version as it stands in the file.
    pub const NAME: &'static str = "bolted-joint/1";
}

/// The massless joint: load on side b = K (x_a - x_b) + C d/dt(x_a - x_b) + k3 (x_a - x_b)^3 and the terms of `higher`, on
/// side a the opposite.
///
/// `stiffness` and `damping` are required unless `over_preload` is there, which replaces them and `cubic`; `higher` cannot
/// be combined with it, and of `friction` a law whose slip force goes with the preload, stated at the nominal one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("anyOf" = [{ "required": ["stiffness", "damping"] }, { "required": ["over_preload"] }])))]
#[cfg_attr(test, schemars(transform = with_friction))]
pub struct Joint {
    /// Relative motions that the joint resists.
    pub dofs: DofSet,
    /// K, symmetric: N/m, N/rad; N·m/m, N·m/rad.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT), inner(length(min = 1, max = SPACE_COUNT))))]
    pub stiffness: Vec<Vec<f64>>,
    /// C, symmetric: N·s/m, N·s/rad; N·m·s/m, N·m·s/rad.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT), inner(length(min = 1, max = SPACE_COUNT))))]
    pub damping: Vec<Vec<f64>>,
    /// k3 on each relative DOF, N/m³ and N·m/rad³: positive hardens, negative softens. Left out, it is zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT)))]
    pub cubic: Vec<f64>,
    /// Terms of higher order on each relative DOF. Left out, there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub higher: Option<HigherTerms>,
    /// Laws with parameters of their own, at most one of a kind on each relative DOF.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(skip))]
    pub friction: Vec<Friction>,
    /// Stiffness, damping and cubic stiffness over the bolt's preload, in their place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_preload: Option<OverPreload>,
}

impl Joint {
    /// The joint that has nothing but these matrices.
    #[must_use]
    pub fn linear(dofs: DofSet, stiffness: Vec<Vec<f64>>, damping: Vec<Vec<f64>>) -> Self {
        Self {
            dofs,
            stiffness,
            damping,
            cubic: Vec::new(),
            higher: None,
            friction: Vec::new(),
            over_preload: None,
        }
    }
}

/// Stiffness, damping and cubic stiffness at several preloads of the bolt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(transform = with_friction_over_preload))]
#[serde(deny_unknown_fields)]
pub struct OverPreload {
    /// Tightening torques, N·m, strictly increasing.
    #[cfg_attr(test, schemars(length(min = 2), inner(range(min = 0))))]
    pub preload: Vec<f64>,
    /// Tightening torque at the start, N·m, within the range of `preload`.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub nominal: f64,
    /// K at each preload, in the units of the joint's own.
    #[cfg_attr(test, schemars(length(min = 2), inner(length(min = 1, max = SPACE_COUNT))))]
    pub stiffness: Vec<Vec<Vec<f64>>>,
    /// C at each preload, in the units of the joint's own.
    #[cfg_attr(test, schemars(length(min = 2), inner(length(min = 1, max = SPACE_COUNT))))]
    pub damping: Vec<Vec<Vec<f64>>>,
    /// k3 at each preload, in the units of the joint's own. Left out, it is zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cubic: Vec<Vec<f64>>,
    /// Laws at each preload, the same ones at all: they take the place of `joint.friction`, of which slip forces alone follow
    /// the preload. Between two preloads their parameters are interpolated linearly. Left out, there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(skip))]
    pub friction: Vec<Vec<Friction>>,
}

/// The two bodies of a lap model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Bodies {
    /// Body on side a.
    pub a: Body,
    /// Body on side b.
    pub b: Body,
}

/// A rigid body on its own support, one entry for each DOF of the joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass in kg, moment of inertia in kg·m²; greater than zero.
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT), transform = entries_above_zero))]
    pub inertia: Vec<f64>,
    /// Support stiffness in N/m, N·m/rad; zero for a free body.
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT), inner(range(min = 0))))]
    pub stiffness: Vec<f64>,
    /// Support damping in N·s/m, N·m·s/rad.
    #[cfg_attr(test, schemars(length(min = 1, max = SPACE_COUNT), inner(range(min = 0))))]
    pub damping: Vec<f64>,
}

/// How well the joint's parameters are known.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// One standard deviation of each entry of the joint's matrices.
    pub standard_deviation: StandardDeviation,
    /// What the standard deviations rest on, in words.
    pub basis: String,
    /// Correlation of the unknowns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation: Option<Correlation>,
    /// Interval of 95 % of each entry of the joint's matrices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval_95: Option<Intervals>,
    /// By how much the standard deviations were raised because the residual is not the assumed noise, at most of all unknowns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub inflation: Option<f64>,
    /// What errors of the set-up do to the standard deviations, where they take part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<BudgetRecord>,
    /// Unknowns that the data do not determine: their values are not to be believed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_identified: Vec<String>,
    /// The estimate without the constraint that the joint be passive, where that is another one. The intervals are about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_estimate: Option<FreeEstimate>,
    /// Scatter of the estimate over data drawn from the fitted model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bootstrap: Option<BootstrapRecord>,
    /// The same at every preload of `joint.over_preload`; what stands beside it holds at the nominal one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_preload: Option<UncertaintyOverPreload>,
}

/// What errors of the set-up do to the standard deviations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BudgetRecord {
    /// One standard deviation of each entry if the set-up were known exactly.
    pub noise_alone: StandardDeviation,
    /// What each group of causes does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<GroupRecord>,
    /// Causes whose limits the data contradict, with their sizes; they were widened.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contradicted: Vec<String>,
}

/// What a group of causes does: parts that the variance of each entry would fall by if it were known exactly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroupRecord {
    /// Name of the group.
    pub group: String,
    /// Of the entries of K, from 0 to 1.
    pub stiffness: Vec<Vec<f64>>,
    /// Of the entries of C, from 0 to 1.
    pub damping: Vec<Vec<f64>>,
}

/// How well the joint's parameters are known over the bolt's preload.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct UncertaintyOverPreload {
    /// One entry for each of `joint.over_preload.preload`, in its order.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub at: Vec<UncertaintyAtPreload>,
    /// Correlation of the unknowns of all preloads, which measured substructures in common bring about. Their names have the
    /// preload behind them, such as `k_yy@10`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation: Option<Correlation>,
}

/// How well the joint's parameters are known at one preload.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct UncertaintyAtPreload {
    /// The preload as in `joint.over_preload.preload`, N·m.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub preload: f64,
    /// One standard deviation of each entry of the joint's matrices.
    pub standard_deviation: StandardDeviation,
    /// Interval of 95 % of each entry of the joint's matrices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval_95: Option<Intervals>,
    /// What errors of the set-up do to the standard deviations, where they take part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<BudgetRecord>,
    /// Unknowns that the data do not determine: their values are not to be believed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_identified: Vec<String>,
    /// The estimate without the constraint that the joint be passive, where that is another one. The intervals are about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_estimate: Option<FreeEstimate>,
    /// Scatter of the estimate over data drawn from the fitted model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bootstrap: Option<BootstrapRecord>,
}

/// Correlation of the unknowns of a joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Correlation {
    /// Names of the unknowns, such as `k_yy`, in the order of the rows.
    pub unknowns: Vec<String>,
    /// The matrix, symmetric with a unit diagonal.
    #[cfg_attr(test, schemars(inner(inner(range(min = -1, max = 1)))))]
    pub matrix: Vec<Vec<f64>>,
}

/// Lower and upper end of an interval for each entry of the joint's matrices; entries that are no unknowns have `[0, 0]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Intervals {
    /// Of K, in its units.
    pub stiffness: Vec<Vec<[f64; 2]>>,
    /// Of C, in its units.
    pub damping: Vec<Vec<[f64; 2]>>,
}

/// A joint that may be active.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FreeEstimate {
    /// K, in its units.
    pub stiffness: Vec<Vec<f64>>,
    /// C, in its units.
    pub damping: Vec<Vec<f64>>,
    /// All unknowns in the order of `correlation.unknowns`, in SI units, where the matrices are not all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unknowns: Vec<f64>,
    /// χ² per degree of freedom.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reduced_chi_squared: Option<f64>,
    /// By how much −2 ln L of the passive estimate is above that of this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub price: Option<f64>,
}

/// What a bootstrap draws.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Drawn {
    /// Noise alone.
    #[default]
    Noise,
    /// Noise, and errors of the set-up within the error budget.
    NoiseAndSetUp,
}

/// A parametric bootstrap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BootstrapRecord {
    /// What differs from draw to draw.
    #[serde(default)]
    pub drawn: Drawn,
    /// Draws from the fitted model.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Draws whose estimate converged.
    pub converged: usize,
    /// One standard deviation of each entry over them.
    pub standard_deviation: StandardDeviation,
    /// From the 2.5th to the 97.5th percentile of each entry.
    pub interval_95: Intervals,
}

/// One standard deviation of each entry of the joint's matrices, and of the numbers of its laws.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(transform = with_friction_deviations))]
#[serde(deny_unknown_fields)]
pub struct StandardDeviation {
    /// Of K, in its units.
    #[cfg_attr(test, schemars(
        length(min = 1, max = SPACE_COUNT),
        inner(length(min = 1, max = SPACE_COUNT), inner(range(min = 0)))
    ))]
    pub stiffness: Vec<Vec<f64>>,
    /// Of C, in its units.
    #[cfg_attr(test, schemars(
        length(min = 1, max = SPACE_COUNT),
        inner(length(min = 1, max = SPACE_COUNT), inner(range(min = 0)))
    ))]
    pub damping: Vec<Vec<f64>>,
    /// Of the laws that remember, as these stand in `joint.friction` or at the same preload in its table: each number's
    /// deviation in place of the number, 0 where none is known. Left out, none is known of any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(skip))]
    pub friction: Vec<Friction>,
}

/// Where the joint's parameters hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Validity {
    /// Lowest and highest frequency that the parameters were determined from, Hz.
    #[serde(deserialize_with = "super::read::pair")]
    #[cfg_attr(test, schemars(inner(range(min = 0))))]
    pub frequency_hz: [f64; 2],
    /// Lowest and highest tightening torque of the assemblies measured, N·m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_n_m: Option<[f64; 2]>,
    /// Level of force or response at which was measured, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
}

/// How far the model is from the measurement that it was identified from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Residual {
    /// Root mean square of |measured - computed| / |computed| over all lines and functions.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub relative_rms: f64,
    /// Number of spectral lines compared.
    pub lines: usize,
    /// The same for each function compared.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub functions: Vec<FunctionResidual>,
    /// χ² over degrees of freedom, where the noise was stated, or coherence or records told it: about 1 if the model fits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub reduced_chi_squared: Option<f64>,
    /// Correlation of the weighted residuals of neighbouring lines: about 0 if they are noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line_correlation: Option<f64>,
    /// Values that noise cannot have made, found before the fit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<OutlierRecord>,
    /// Lines that were left out for them; `lines` are without these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines_left_out: Option<usize>,
    /// Noise of the assembly's functions, unless coherence told it line by line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<NoiseRecord>,
}

/// A measured value that noise cannot have made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct OutlierRecord {
    /// Whose function it is of: `A`, `B`, `assembly`, or `assembly 2` where there are several.
    pub set: String,
    /// Response DOF.
    pub response: String,
    /// Reference DOF.
    pub reference: String,
    /// Its line.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub frequency_hz: f64,
}

/// Noise of measured functions: standard deviation √((relative·|H|)² + floor²) of the complex error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NoiseRecord {
    /// Fraction of the receptance.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub relative: f64,
    /// Part that does not depend on it, in its unit (m/N).
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub floor: f64,
    /// Whether the study stated it; else it was estimated from the residual.
    pub stated: bool,
}

/// How far the model is from one measured function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FunctionResidual {
    /// Response DOF, such as `11:+Y`.
    pub response: String,
    /// Reference DOF, such as `12:+Y`.
    pub reference: String,
    /// Root mean square of |measured - computed| / |computed| over the lines.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub relative_rms: f64,
}

/// Where the joint's parameters come from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Program that wrote the file.
    pub tool: String,
    /// Version of that program.
    pub version: String,
    /// Method, such as `frf-decoupling`.
    pub method: String,
    /// Joint model, such as `full`.
    pub model: String,
    /// Files that the parameters were determined from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<InputFile>,
    /// Names of the bolts at each of which the joint is, where the structure has several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bolts: Vec<String>,
    /// Bands of the averages that the search started from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bands: Option<BandsRecord>,
    /// Receptances of substructures that come from modes because they were not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub from_modes: Vec<FromModesRecord>,
    /// What a reader should know before using the joint.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

/// Bands over which the decoupled values of each entry were averaged.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BandsRecord {
    /// For k_yy and c_yy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yy: Option<BandRecord>,
    /// For k_ytheta and c_ytheta.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ytheta: Option<BandRecord>,
    /// For k_thetatheta and c_thetatheta.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thetatheta: Option<BandRecord>,
}

/// Bands of one entry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BandRecord {
    /// Where they come from.
    pub origin: BandOriginRecord,
    /// Lowest and highest frequency of each, Hz; none for the median over all lines.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frequency_hz: Vec<[f64; 2]>,
}

/// Where the bands of an average come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum BandOriginRecord {
    /// The study gives them.
    Study,
    /// Chosen by sensitivity and distance to the substructures' own resonances.
    Automatic,
    /// The median over all lines.
    Median,
}

/// Receptances of a substructure that its modes supplied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FromModesRecord {
    /// `a` or `b`.
    pub substructure: String,
    /// Name of the file with the modes, as the study gives it.
    pub file: String,
    /// Response and reference of each, such as `["1:+Y", "3:+Y"]`; its transpose is the same.
    pub functions: Vec<[String; 2]>,
}

/// A file that the parameters were determined from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InputFile {
    /// What the file was used for, such as `a.frf`.
    pub role: String,
    /// Its name, as the study gives it.
    pub file: String,
    /// SHA-256 of its contents, 64 lower-case hexadecimal digits.
    #[cfg_attr(test, schemars(regex(pattern = "^[0-9a-f]{64}$")))]
    pub sha256: String,
}
