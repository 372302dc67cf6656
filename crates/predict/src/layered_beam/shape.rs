//! Shapes of a uniform beam's modes, written so that no hyperbolic function grows: high modes stay exact.

use std::f64::consts::SQRT_2;

use bolted_joint_frf::structure::Boundary;

use super::roots::root;

/// Samples of a half wave in the search for the largest deflection.
const SAMPLES: usize = 16;

/// Deflections that differ by less than this part are taken as equally large: the antinode is then the first of them.
const EQUAL: f64 = 1e-9;

/// A mode's shape φ over ξ = x/L, normalised to ∫₀¹ φ² dξ = 1:
/// φ = a e^(−λξ) + b e^(−λ(1−ξ)) + c cos λξ + s sin λξ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeShape {
    /// Whether ξ counts from the other end than the coefficients do.
    mirrored: bool,
    lambda: f64,
    decaying: f64,
    growing: f64,
    cosine: f64,
    sine: f64,
}

impl ModeShape {
    /// Shape of elastic mode `mode`, counted from one.
    #[must_use]
    pub fn new(boundary: Boundary, mode: usize) -> Self {
        let lambda = root(boundary, mode);
        let (sin, cos) = lambda.sin_cos();
        let e = (-lambda).exp();
        // φ = cosh λξ ∓ cos λξ − σ(sinh λξ ∓ sin λξ), where 1 − σ is of the order e^(−λ): the coefficient of e^(λξ) is
        // (1 − σ)/2 = growing · e^(−λ). Upper signs where ξ = 0 is fixed, lower ones where it is free.
        let (growing, upper) = match boundary {
            // σ = (cosh λ − cos λ)/(sinh λ − sin λ)   (Kavi 3.16, 3.17)
            Boundary::FixedFixed => ((cos - sin - e) / (1.0 - e * e - 2.0 * e * sin), 1.0),
            Boundary::FreeFree => ((cos - sin - e) / (1.0 - e * e - 2.0 * e * sin), -1.0),
            // σ = (sinh λ − sin λ)/(cosh λ + cos λ)
            Boundary::FixedFree | Boundary::FreeFixed => {
                ((cos + sin + e) / (1.0 + e * e + 2.0 * e * cos), 1.0)
            }
            // σ = coth λ
            Boundary::FixedPinned => (-e / (1.0 - e * e), 1.0),
            Boundary::PinnedPinned => {
                return Self {
                    mirrored: false,
                    lambda,
                    decaying: 0.0,
                    growing: 0.0,
                    cosine: 0.0,
                    sine: SQRT_2,
                };
            }
        };
        // σ = 1 − 2 growing e^(−λ)
        let sigma = 1.0 - 2.0 * growing * e;
        Self {
            mirrored: boundary == Boundary::FreeFixed,
            lambda,
            decaying: 0.5 * (1.0 + sigma),
            growing,
            cosine: -upper,
            sine: upper * sigma,
        }
    }

    /// Root λ = βL of the frequency equation.
    #[must_use]
    pub fn lambda(&self) -> f64 {
        self.lambda
    }

    /// φ at ξ = x/L from 0 to 1.
    #[must_use]
    pub fn deflection(&self, xi: f64) -> f64 {
        let [decaying, growing, cosine, sine] = self.parts(xi);
        decaying + growing + cosine + sine
    }

    /// dφ/dξ.
    #[must_use]
    pub fn slope(&self, xi: f64) -> f64 {
        let xi_own = self.own(xi);
        let (sin, cos) = (self.lambda * xi_own).sin_cos();
        let [decaying, growing, ..] = self.parts(xi);
        let slope = self.lambda * (growing - decaying + self.sine * cos - self.cosine * sin);
        if self.mirrored { -slope } else { slope }
    }

    /// d²φ/dξ².
    #[must_use]
    pub fn curvature(&self, xi: f64) -> f64 {
        let [decaying, growing, cosine, sine] = self.parts(xi);
        self.lambda * self.lambda * (decaying + growing - cosine - sine)
    }

    /// ξ of the largest |φ|; the one nearest to ξ = 0 where several are equal.
    #[must_use]
    pub fn antinode(&self) -> f64 {
        let count = SAMPLES * (2.0 + self.lambda / std::f64::consts::PI) as usize;
        let at = |k: usize| k as f64 / count as f64;
        let (mut best, mut largest) = (0.0, self.deflection(0.0).abs());
        let mut consider = |xi: f64| {
            let size = self.deflection(xi).abs();
            if size > largest * (1.0 + EQUAL) {
                (best, largest) = (xi, size);
            }
        };
        for k in 0..count {
            let (mut low, mut high) = (at(k), at(k + 1));
            let falls = self.slope(low) > 0.0;
            if falls == (self.slope(high) > 0.0) {
                continue;
            }
            // φ′ changes its sign once in an interval so short: halve it until it no longer gets shorter
            while {
                let middle = 0.5 * (low + high);
                let moves = middle > low && middle < high;
                if moves && (self.slope(middle) > 0.0) == falls {
                    low = middle;
                } else if moves {
                    high = middle;
                }
                moves
            } {}
            consider(low);
        }
        consider(1.0);
        best
    }

    fn own(&self, xi: f64) -> f64 {
        if self.mirrored { 1.0 - xi } else { xi }
    }

    fn parts(&self, xi: f64) -> [f64; 4] {
        let xi = self.own(xi);
        let (sin, cos) = (self.lambda * xi).sin_cos();
        [
            self.decaying * (-self.lambda * xi).exp(),
            self.growing * (-self.lambda * (1.0 - xi)).exp(),
            self.cosine * cos,
            self.sine * sin,
        ]
    }
}
