//! What can be wrong with the numbers of a joint file that is well formed otherwise.

use thiserror::Error;

use super::DofSet;

/// One thing that is wrong in a joint file, by the path of its key.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum JointProblem {
    /// A key that is needed here is not there.
    #[error("{path}: not found, expected {expected}")]
    Missing {
        /// Path of the key.
        path: String,
        /// What should be there.
        expected: &'static str,
    },
    /// A joint that may be used for reasons, or may not be used for none.
    #[error(
        "status: found usable = {usable} with {reasons} reasons, expected reasons where the joint is not usable, and none where it is"
    )]
    Status {
        /// Whether it may be used.
        usable: bool,
        /// Number of reasons.
        reasons: usize,
    },
    /// An author or a licence that is not one line of text.
    #[error("about.{key}: found {found:?}, expected one line of text")]
    About {
        /// Key of the text.
        key: &'static str,
        /// The text.
        found: String,
    },
    /// A reason that is not one line of text.
    #[error("status.reasons: found {found:?}, expected one line of text each")]
    Reason {
        /// The reason.
        found: String,
    },
    /// A list has not one entry for each DOF.
    #[error(
        "{path}: found {found} {}, expected {}, one for each of joint.dofs = {dofs}",
        if *found == 1 { "entry" } else { "entries" },
        dofs.count()
    )]
    Length {
        /// Path of the list.
        path: String,
        /// Its number of entries.
        found: usize,
        /// DOFs of the joint.
        dofs: DofSet,
    },
    /// Something beside a table over the preload.
    #[error(
        "{path}: found beside joint.over_preload, expected one of the two: the {what} are not known over the preload; take \
         one of them out"
    )]
    BesideTable {
        /// Path of the key.
        path: &'static str,
        /// What stands there.
        what: &'static str,
    },
    /// A joint with friction whose nominal preload is nothing.
    #[error(
        "joint.over_preload.nominal: found 0 beside joint.friction, expected a preload above 0: friction is in proportion to it"
    )]
    NothingPresses,
    /// Laws of a joint over the preload in two places.
    #[error(
        "joint.friction: found beside joint.over_preload.friction, expected one of the two: the first has slip forces in \
         proportion to the preload, the second a table of all parameters; take one of them out"
    )]
    FrictionTwice,
    /// Laws at one preload that are not those at the first.
    #[error("{path}: found {found:?}, expected {expected:?} as at the first preload")]
    OtherLaws {
        /// Path of the list.
        path: String,
        /// Its laws, with their DOFs.
        found: String,
        /// Those at the first preload.
        expected: String,
    },
    /// Deviations of other laws than the joint has.
    #[error("{path}: found {found:?}, expected the laws of the joint in their order, {expected:?}")]
    DeviationsOfOtherLaws {
        /// Path of the list.
        path: String,
        /// Its laws, with their DOFs.
        found: String,
        /// Those of the joint.
        expected: String,
    },
    /// A law that would give energy between two preloads at which it takes it.
    #[error(
        "{path}: found {law} parameters that are linear from {low:?} to {high:?} N·m and at {between:?} N·m outside of the law's range, \
         expected {expected}; give an entry between the two"
    )]
    OutsideBetween {
        /// Path of the law at the lower preload.
        path: String,
        /// Name of the law.
        law: &'static str,
        /// The two preloads, N·m.
        low: f64,
        /// The upper one.
        high: f64,
        /// Where it is farthest outside, N·m.
        between: f64,
        /// What it takes there.
        expected: String,
    },
    /// A law on a DOF that the joint has not.
    #[error("{path}: found {found:?}, expected one of joint.dofs = {dofs}")]
    OtherDof {
        /// Path of the name.
        path: String,
        /// Name of the DOF.
        found: &'static str,
        /// DOFs of the joint.
        dofs: DofSet,
    },
    /// One law more of a kind than there is room for on a DOF.
    #[error(
        "{path}: found \"{law}\" number {found} on \"{dof}\", expected {at_most} of that kind at the most on a degree of freedom; \
         take one of them out, or let fewer stand for all"
    )]
    TooManyLaws {
        /// Path of the law.
        path: String,
        /// Name of the law.
        law: &'static str,
        /// Name of the DOF.
        dof: &'static str,
        /// Which of its kind it is there, from 1.
        found: usize,
        /// How many there can be.
        at_most: usize,
    },
    /// A parameter that is outside of the range of its law, in which alone the law takes energy.
    #[error("{path}: found {found:?}, expected {expected}")]
    OutsideLaw {
        /// Path of the parameter.
        path: String,
        /// The parameter.
        found: f64,
        /// What the law takes.
        expected: String,
    },
    /// An amplitude that is not positive.
    #[error("{path}: found {found:?}, expected an amplitude greater than zero")]
    Amplitude {
        /// Path of the number.
        path: String,
        /// The number, m or rad.
        found: f64,
    },
    /// A list has not one entry for each entry of another.
    #[error("{path}: found {found} entries, expected {expected}, one for each of {of}")]
    TableLength {
        /// Path of the list.
        path: String,
        /// Its number of entries.
        found: usize,
        /// Number of entries of the other.
        expected: usize,
        /// Path of the other.
        of: &'static str,
    },
    /// A table with too few preloads to interpolate.
    #[error(
        "joint.over_preload.preload: found {found}, expected at least 2 preloads; \
         for one preload give joint.stiffness and joint.damping instead"
    )]
    TooFewPreloads {
        /// Number of preloads.
        found: usize,
    },
    /// A number that is infinite or not a number.
    #[error("{path}: found {found}, expected a finite number")]
    NotFinite {
        /// Path of the number.
        path: String,
        /// The number.
        found: f64,
    },
    /// A matrix is not symmetric.
    #[error(
        "{path}: found {upper:?} at [{row}][{column}] and {lower:?} at [{column}][{row}], \
         expected a symmetric matrix; give both entries the same value"
    )]
    Asymmetric {
        /// Path of the matrix.
        path: String,
        /// Row of the entry above the diagonal.
        row: usize,
        /// Its column.
        column: usize,
        /// Entry above the diagonal.
        upper: f64,
        /// Entry below the diagonal.
        lower: f64,
    },
    /// A number that must not be negative.
    #[error("{path}: found {found:?}, expected {what} of zero or more")]
    Negative {
        /// Path of the number.
        path: String,
        /// The number.
        found: f64,
        /// What the number is.
        what: &'static str,
    },
    /// An inertia that is not positive.
    #[error("{path}: found {found:?}, expected an inertia greater than zero")]
    Inertia {
        /// Path of the number.
        path: String,
        /// The number, kg or kg·m².
        found: f64,
    },
    /// A preload that is not above the one before it.
    #[error(
        "{path}: found {found:?} N·m after {previous:?} N·m, expected strictly increasing preloads"
    )]
    PreloadNotIncreasing {
        /// Path of the preload.
        path: String,
        /// The preload, N·m.
        found: f64,
        /// The one before it, N·m.
        previous: f64,
    },
    /// The nominal preload lies outside the table.
    #[error(
        "joint.over_preload.nominal: found {found:?} N·m, expected a preload within the table, \
         from {first:?} to {last:?} N·m"
    )]
    NominalOutside {
        /// The nominal preload, N·m.
        found: f64,
        /// First preload of the table, N·m.
        first: f64,
        /// Last preload of the table, N·m.
        last: f64,
    },
    /// A preload that is not the one at the same place of the joint's table.
    #[error(
        "{path}: found {found:?} N·m, expected {expected:?} N·m as in joint.over_preload.preload"
    )]
    OtherPreload {
        /// Path of the preload.
        path: String,
        /// The preload, N·m.
        found: f64,
        /// The joint's, N·m.
        expected: f64,
    },
    /// A frequency band that ends before it begins.
    #[error(
        "validity.frequency_hz: found {from_hz:?} to {to_hz:?} Hz, expected the lower frequency first"
    )]
    Band {
        /// First entry, Hz.
        from_hz: f64,
        /// Second entry, Hz.
        to_hz: f64,
    },
    /// A name that is blank or does not fit on a line.
    #[error("name: found {found:?}, expected one line of text")]
    Name {
        /// The name.
        found: String,
    },
    /// A hash that cannot be one.
    #[error("{path}: found {found:?}, expected 64 lower-case hexadecimal digits")]
    Hash {
        /// Path of the hash.
        path: String,
        /// What is there.
        found: String,
    },
}

impl JointProblem {
    /// Each on a line of its own.
    pub(super) fn list(problems: &[Self]) -> String {
        let lines: Vec<String> = problems.iter().map(Self::to_string).collect();
        lines.join("\n  ")
    }
}
