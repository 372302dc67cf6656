//! The loads that keep a lap vibrating.

use bolted_joint_dynamics::LapLoads;
use num_complex::Complex64;

/// Loads on both bodies: Re(F e^{jωt}) with a complex amplitude F for each DOF, and a constant part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicLoads<const D: usize> {
    /// Complex amplitudes of the load on body a, N and N·m.
    pub a: [Complex64; D],
    /// Complex amplitudes of the load on body b, N and N·m.
    pub b: [Complex64; D],
    /// Constant loads, N and N·m.
    pub constant: LapLoads<D>,
}

impl<const D: usize> HarmonicLoads<D> {
    /// No loads.
    pub const NONE: Self = Self {
        a: [Complex64::ZERO; D],
        b: [Complex64::ZERO; D],
        constant: LapLoads {
            a: [0.0; D],
            b: [0.0; D],
        },
    };

    /// `amplitude_n` · cos ωt on body a in translation.
    #[must_use]
    pub fn on_a(amplitude_n: f64) -> Self {
        let mut loads = Self::NONE;
        loads.a[0] = amplitude_n.into();
        loads
    }

    /// `amplitude_n` · cos ωt on body b in translation.
    #[must_use]
    pub fn on_b(amplitude_n: f64) -> Self {
        let mut loads = Self::NONE;
        loads.b[0] = amplitude_n.into();
        loads
    }

    /// `amplitude_n` · cos ωt on body a and its opposite on body b, in translation: they drive the relative motion alone where
    /// the bodies are alike.
    #[must_use]
    pub fn opposed(amplitude_n: f64) -> Self {
        let mut loads = Self::on_a(amplitude_n);
        loads.b[0] = (-amplitude_n).into();
        loads
    }

    /// The loads times a real factor, the constant part as it is.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            a: self.a.map(|load| load * factor),
            b: self.b.map(|load| load * factor),
            constant: self.constant,
        }
    }

    /// Loads at the time t: the phase ωt in rad.
    #[must_use]
    pub fn at_phase(&self, phase_rad: f64) -> LapLoads<D> {
        let turn = Complex64::cis(phase_rad);
        let at = |amplitude: &[Complex64; D], constant: &[f64; D]| {
            std::array::from_fn(|i| (amplitude[i] * turn).re + constant[i])
        };
        LapLoads {
            a: at(&self.a, &self.constant.a),
            b: at(&self.b, &self.constant.b),
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let harmonic = self.a.iter().chain(&self.b);
        let mut constant = self.constant.a.iter().chain(&self.constant.b);
        harmonic.copied().all(Complex64::is_finite) && constant.all(|load| load.is_finite())
    }

    pub(super) fn has_constant(&self) -> bool {
        let mut constant = self.constant.a.iter().chain(&self.constant.b);
        constant.any(|&load| load != 0.0)
    }

    /// The largest amplitude, whose phase stands for that of the loads.
    pub(super) fn largest(&self) -> Complex64 {
        let loads = self.a.iter().chain(&self.b);
        loads.fold(Complex64::ZERO, |largest, &load| {
            if load.norm() > largest.norm() {
                load
            } else {
                largest
            }
        })
    }
}
