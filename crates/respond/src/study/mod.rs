//! A study of a response: which laps, which test, which sensors; checked before anything is computed.

mod check;
mod tables;

use std::path::{Path, PathBuf};

use bolted_joint_harmonic::{Derivative, Harmonics, Observed, Side};
use bolted_joint_joint::JointFile;
use bolted_joint_study::{Method, StudyText, schema};

use super::RespondError;
use tables::{Kind, Place, QuantityName, ScaleName, StudyFile};

/// A validated study of method `respond`.
#[derive(Clone, Debug)]
pub struct RespondStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Its name.
    pub name: String,
    /// The laps, all with the same DOFs.
    pub laps: Vec<StudyLap>,
    /// The motions that are written.
    pub motions: Vec<Observed>,
    /// What of them.
    pub quantity: Derivative,
    /// Whether amplitudes are drawn over a logarithmic axis.
    pub is_logarithmic: bool,
    /// What is done to the laps.
    pub test: Test,
}

/// A lap, by its joint file.
#[derive(Clone, Debug)]
pub struct StudyLap {
    /// Its name in tables and figures.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// The joint at its preload, and the bodies.
    pub file: JointFile,
}

/// Where a harmonic load acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadPlace {
    /// The body; `None` for one load on a and its opposite on b.
    pub body: Option<Side>,
    /// The DOF.
    pub dof: usize,
}

/// A range of frequencies, Hz, from the first to be visited to the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// First and last frequency, Hz.
    pub ends_hz: [f64; 2],
}

/// Times of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// s
    pub duration_s: f64,
    /// Between rows, s.
    pub interval_s: f64,
    /// Runge–Kutta steps in a period of the load or, without a load, of the fastest mode; `None` for the FMU's own step.
    pub steps_per_period: Option<f64>,
}

/// What is done to the laps.
#[derive(Clone, Debug)]
pub enum Test {
    /// Receptances of small motion.
    Linear {
        /// Frequencies.
        span: Span,
        /// How many.
        lines: usize,
        /// Where the load acts.
        load: LoadPlace,
    },
    /// Periodic responses under loads of several amplitudes, through folds.
    HarmonicBalance {
        /// Frequencies.
        span: Span,
        /// Where the load acts.
        load: LoadPlace,
        /// Amplitudes of the load, N or N·m.
        levels: Vec<f64>,
        /// Of the motion.
        harmonics: Harmonics,
    },
    /// Periodic responses of several amplitudes, the load following.
    ConstantAmplitude {
        /// Frequencies.
        span: Span,
        /// Where the load acts.
        load: LoadPlace,
        /// What is held.
        of: Observed,
        /// Its amplitudes.
        levels: Vec<f64>,
        /// Of the motion.
        harmonics: Harmonics,
    },
    /// Free motions: frequency and damping ratio over the amplitude.
    Backbone {
        /// Whose amplitude.
        of: Observed,
        /// From the first to the last.
        amplitudes: [f64; 2],
        /// Whether the dampers are left out.
        is_undamped: bool,
        /// Of the motion.
        harmonics: Harmonics,
    },
    /// Responses a quarter of a period from the load.
    PhaseResonance {
        /// Where the load acts.
        load: LoadPlace,
        /// Whose amplitude.
        of: Observed,
        /// From the first to the last.
        amplitudes: [f64; 2],
        /// Of the motion.
        harmonics: Harmonics,
    },
    /// One frequency after another in time, each until it has settled.
    SteppedSine {
        /// Frequencies.
        span: Span,
        /// How many.
        lines: usize,
        /// Where the load acts.
        load: LoadPlace,
        /// Amplitudes of the load, N or N·m.
        levels: Vec<f64>,
        /// Periods before each measurement; `None` for as long as the slowest mode takes to fall to a thousandth.
        settle: Option<f64>,
        /// Runge–Kutta steps in a period; `None` for the FMU's own step.
        steps_per_period: Option<f64>,
    },
    /// A frequency that moves steadily in time.
    Sweep {
        /// Frequencies.
        span: Span,
        /// Where the load acts.
        load: LoadPlace,
        /// Amplitudes of the load, N or N·m.
        levels: Vec<f64>,
        /// When.
        times: Times,
    },
    /// One frequency from rest.
    Dwell {
        /// Hz
        frequency_hz: f64,
        /// Where the load acts.
        load: LoadPlace,
        /// Amplitudes of the load, N or N·m.
        levels: Vec<f64>,
        /// When.
        times: Times,
    },
    /// Motion without loads.
    FreeDecay {
        /// Where it begins.
        start: Vec<Start>,
        /// When.
        times: Times,
    },
    /// Closed loops of load over displacement of the joint alone.
    Hysteresis {
        /// The relative DOF that is moved; the others rest.
        dof: usize,
        /// Amplitudes of the motion, m or rad.
        amplitudes: Vec<f64>,
        /// Hz; `None` for a motion so slow that dampers have no part in it.
        frequency_hz: Option<f64>,
    },
}

/// One number of the state that a free decay begins with; all others are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Of which body.
    pub side: Side,
    /// In which DOF.
    pub dof: usize,
    /// Whether it is a velocity.
    pub is_velocity: bool,
    /// m, rad, m/s or rad/s.
    pub value: f64,
}

impl RespondStudy {
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// Reads and checks a study and the joint files that it names.
    ///
    /// # Errors
    /// [`RespondError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, RespondError> {
        Self::of(&StudyText::read(path)?)
    }

    /// A study from its text.
    ///
    /// # Errors
    /// [`RespondError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, RespondError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::Respond])?;
        study.check_name("name", &file.name)?;
        check::tables(study, &file)?;
        let laps = check::laps(study, &file.lap, file.kind != Kind::Hysteresis)?;
        let dofs = laps[0].file.joint.dofs;
        let motions = match &file.motions {
            Some(motions) => check::motions(study, motions, dofs)?,
            None => vec![Observed::Relative(0)],
        };
        let quantity = match file.quantity {
            QuantityName::Displacement => Derivative::Displacement,
            QuantityName::Velocity => Derivative::Velocity,
            QuantityName::Acceleration => Derivative::Acceleration,
        };
        let is_time = matches!(
            file.kind,
            Kind::Sweep | Kind::Dwell | Kind::FreeDecay | Kind::Hysteresis
        );
        study.ensure(
            !is_time || quantity == Derivative::Displacement,
            "quantity",
            "one that is not in a time history",
            "displacement; velocities are written beside it",
        )?;
        Ok(Self {
            path: study.path().to_owned(),
            test: check::test(study, &file, &laps)?,
            name: file.name,
            laps,
            motions,
            quantity,
            is_logarithmic: file.scale != Some(ScaleName::Linear),
        })
    }
}

impl Place {
    fn body(self) -> Option<Side> {
        match self {
            Self::A => Some(Side::A),
            Self::B => Some(Side::B),
            Self::Opposed => None,
        }
    }
}
