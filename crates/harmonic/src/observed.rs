//! What a sensor on the lap sees, and which of its amplitudes a test holds.

/// A motion of the lap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observed {
    /// x_a − x_b in a DOF.
    Relative(usize),
    /// x of a body in a DOF.
    Body(super::Side, usize),
}

impl Observed {
    /// Its DOF: 0 for translation, 1 for rotation.
    #[must_use]
    pub fn dof(self) -> usize {
        match self {
            Self::Relative(dof) | Self::Body(_, dof) => dof,
        }
    }
}

/// Whether an amplitude is one of displacement, of velocity or of acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Derivative {
    /// m, rad
    #[default]
    Displacement,
    /// m/s, rad/s
    Velocity,
    /// m/s², rad/s²
    Acceleration,
}

impl Derivative {
    /// How often it is differentiated.
    #[must_use]
    pub fn order(self) -> i32 {
        match self {
            Self::Displacement => 0,
            Self::Velocity => 1,
            Self::Acceleration => 2,
        }
    }
}

/// Amplitude of the fundamental of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The motion.
    pub observed: Observed,
    /// What of it.
    pub derivative: Derivative,
    /// Amplitude, in SI units.
    pub amplitude: f64,
}

impl Target {
    /// A displacement of the joint in a DOF (m, rad).
    #[must_use]
    pub fn relative(dof: usize, amplitude: f64) -> Self {
        Self {
            observed: Observed::Relative(dof),
            derivative: Derivative::Displacement,
            amplitude,
        }
    }

    /// The same of another amplitude.
    pub(super) fn times(self, factor: f64) -> Self {
        Self {
            amplitude: factor * self.amplitude,
            ..self
        }
    }
}
