//! Discrete Fourier transforms of any length, by `rustfft`.
//!
//! The library is generic, and each crate that calls it compiles all of its butterflies again: here they are compiled once.
#![forbid(unsafe_code)]

use std::fmt;
use std::sync::Arc;

use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

/// A transform of one length, made ready.
#[derive(Clone)]
pub struct Transform(Arc<dyn Fft<f64>>);

impl Transform {
    /// X_k = Σ x_n e^(−2πi kn/N).
    #[must_use]
    pub fn forward(length: usize) -> Self {
        Self(FftPlanner::new().plan_fft_forward(length))
    }

    /// x_n = Σ X_k e^(2πi kn/N), which is N times what the forward one began with.
    #[must_use]
    pub fn inverse(length: usize) -> Self {
        Self(FftPlanner::new().plan_fft_inverse(length))
    }

    /// Transforms values in place, as many as the length at a time.
    pub fn apply(&self, values: &mut [Complex64]) {
        self.0.process(values);
    }
}

impl fmt::Debug for Transform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Transform of {}", self.0.len())
    }
}
