//! The blocks of a step mode by mode: each takes a number of its own, e^{hλ} or φ_k(hλ), and no matrix.

use super::{
    coordinates::Parts,
    matrix::Matrix,
    modes::{Frame, Pair},
    phi::{COUNT, INVERSE_FACTORIALS, phi},
    propagator::{Blocks, Going, POWERS},
};
use crate::complex::Complex;

/// A function of hΛ: two rows of two numbers for each pair of coordinates.
#[derive(Clone, Debug)]
pub(super) struct Turns(Vec<[f64; 4]>);

impl Turns {
    /// φ₀(hΛ) to φ₉(hΛ) over a time (s).
    fn over(frame: &Frame, length_s: f64) -> [Self; COUNT] {
        let mut all = std::array::from_fn(|_| Self(Vec::with_capacity(frame.pairs().len())));
        for pair in frame.pairs() {
            match pair {
                Pair::Turning(lambda) => {
                    let own = phi(lambda.scaled(length_s));
                    for (turns, Complex { re, im }) in all.iter_mut().zip(own) {
                        turns.0.push([re, im, -im, re]);
                    }
                }
                // A² = 0, so that φ_k = 1/k! + hA/(k + 1)!
                Pair::Free => {
                    for (turns, own) in all.iter_mut().zip(INVERSE_FACTORIALS.windows(2)) {
                        turns.0.push([own[0], length_s * own[1], 0.0, own[0]]);
                    }
                }
            }
        }
        all
    }

    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        self.0.as_flattened().iter().all(|own| own.is_finite())
    }

    /// z ← Φ z
    pub(super) fn turn(&self, z: &mut [f64]) {
        for (pair, [a, b, c, d]) in z.chunks_exact_mut(2).zip(&self.0) {
            let [first, second] = [pair[0], pair[1]];
            pair[0] = a * first + b * second;
            pair[1] = c * first + d * second;
        }
    }

    /// R Φ of some rows.
    pub(super) fn seen_by(&self, rows: &Matrix) -> Matrix {
        let mut seen = rows.clone();
        for row in seen.rows_mut() {
            for (pair, [a, b, c, d]) in row.chunks_exact_mut(2).zip(&self.0) {
                let [first, second] = [pair[0], pair[1]];
                pair[0] = first * a + second * c;
                pair[1] = first * b + second * d;
            }
        }
        seen
    }

    /// (Φ X)ᵀ of the rows of Xᵀ, times a factor.
    fn of_rows(&self, rows: &Matrix, factor: f64) -> Matrix {
        let mut turned = rows.times(factor);
        turned.rows_mut().for_each(|row| self.turn(row));
        turned
    }
}

/// The blocks of a step of this length (s), in the coordinates of the modes.
pub(super) fn blocks(parts: &Parts, frame: &Frame, length_s: f64) -> Blocks {
    let (acting, seen) = (&parts.acting, &parts.sight.places);
    let phi = Turns::over(frame, length_s);
    let by = |k: usize| phi[k].of_rows(acting, length_s);
    let by_powers = std::array::from_fn(|power| by(power + 1));
    // as often as it is integrated, so much further is φ
    let moments = std::array::from_fn(|moment| phi[moment + 1].seen_by(seen));
    let moments_by = std::array::from_fn(|moment| {
        let seen = |power: usize| seen.product(&by(power + moment + 2).transposed());
        std::array::from_fn::<_, POWERS, _>(seen)
    });
    let [own, ..] = phi;
    Blocks::new(Going::Turning(own), by_powers, &moments, &moments_by)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{
        assembly::{Assembly, AssemblyJoint, propagator::Propagator, system::System},
        law::{DofLaws, Polynomial},
        random::Random,
    };

    /// Twelve coordinates, two of them of free motions, with dampers of the structures and of a joint.
    pub(in super::super) fn assembly(damper: f64) -> Assembly {
        const SIZE: usize = 12;
        let mut random = Random(7);
        let mut row = |scale: f64| -> Vec<f64> {
            (0..SIZE)
                .map(|_| scale * (2.0 * random.unit() - 1.0))
                .collect()
        };
        let (load, relative) = (row(1.0), row(1.5));
        let frequency = |i: usize| if i < 2 { 0.0 } else { 50.0 * (i * i) as f64 };
        Assembly {
            frequencies_rad_per_s: (0..SIZE).map(frequency).collect(),
            damping_per_s: Matrix::from_fn(SIZE, SIZE, |i, j| {
                if i == j { 0.02 * frequency(i) } else { 0.0 }
            }),
            loads: Matrix::from_fn(SIZE, 1, |i, _| load[i]),
            joints: vec![AssemblyJoint {
                relative: Matrix::from_fn(1, SIZE, |_, j| relative[j]),
                stiffness: Matrix::from_fn(1, 1, |_, _| 2e5),
                damping: Matrix::from_fn(1, 1, |_, _| damper),
                laws: vec![DofLaws::from(Polynomial::cubic(1e12))],
                over_preload: None,
            }],
        }
    }

    fn assert_near(found: &Matrix, expected: &Matrix) {
        let largest = expected
            .iter()
            .fold(0.0, |largest: f64, own| largest.max(own.abs()));
        let off = found.plus(-1.0, expected);
        let error = off.iter().fold(0.0, |error: f64, own| error.max(own.abs())) / largest;
        assert!(error < 1e-12, "{error}");
    }

    #[test]
    fn the_blocks_are_those_of_the_exponential() {
        let parts = Parts::of(System::of(&assembly(8.0)));
        let (system, frame) = (&parts.system, parts.frame.as_ref().unwrap());
        for length_s in [1e-6, 1e-3, 0.1] {
            let found = blocks(&parts, frame, length_s);
            let expected = Propagator::new(system, length_s, 0).unwrap().blocks();
            let out = frame.out_of_modes();
            let identity = Matrix::identity(2 * system.size);
            let state = found.state.seen_by(out).product(frame.to_modes());
            assert_near(&state, &expected.state.seen_by(&identity));
            for row in 0..found.by.rows() {
                let by = found.by.block([row, 0], 1, 2 * system.size);
                let expected = expected.by.block([row, 0], 1, 2 * system.size);
                assert_near(&by.product(&out.transposed()), &expected);
            }
            let moments = found.moments.product(frame.to_modes());
            for row in 0..moments.rows() {
                let pairs = [
                    (&moments, &expected.moments),
                    (&found.moments_by, &expected.moments_by),
                ];
                for (own, other) in pairs {
                    let [own, other] =
                        [own, other].map(|all| all.block([row, 0], 1, all.columns()));
                    assert_near(&own, &other);
                }
            }
        }
    }

    #[test]
    fn what_is_critically_damped_has_no_such_frame() {
        assert!(Frame::of(&System::of(&assembly(8.0))).is_some());
        assert!(Frame::of(&System::of(&assembly(2e4))).is_none());
    }

    #[test]
    fn a_frame_that_misses_a_mode_is_seen() {
        let (system, other) = (System::of(&assembly(8.0)), System::of(&assembly(8.1)));
        let scale = crate::assembly::propagator::scale(&system);
        let frame = Frame::of(&system).unwrap();
        assert!(frame.is_whole(&system, &scale));
        assert!(!frame.is_whole(&other, &scale));
    }
}
