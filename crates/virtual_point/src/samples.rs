//! Numbers that tests share: the set-up of the check values, and numbers without a pattern that are the same in each
//! run.

use bolted_joint_space::Axes;
use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};
use num_complex::Complex64;

use crate::{Impact, Sensor, SetUp, Tolerance, VirtualPoint, Weights};

/// Positions of three triaxial sensors, m.
pub(crate) const SENSORS: [[f64; 3]; 3] = [
    [0.02, 0.01, 0.03],
    [-0.02, 0.015, 0.03],
    [0.0, -0.025, 0.02],
];

/// Positions and directions of seven impacts.
pub(crate) const IMPACTS: [([f64; 3], [f64; 3]); 7] = [
    ([0.03, 0.0, 0.01], [0.0, 0.0, 1.0]),
    ([-0.03, 0.01, 0.01], [0.0, 0.0, 1.0]),
    ([0.0, 0.03, 0.02], [0.0, 0.0, 1.0]),
    ([0.03, 0.02, 0.0], [0.0, 1.0, 0.0]),
    ([-0.02, 0.03, 0.01], [0.0, 1.0, 0.0]),
    ([0.0, 0.02, 0.03], [1.0, 0.0, 0.0]),
    ([0.01, -0.02, 0.03], [0.6, 0.0, 0.8]),
];

/// Three triaxial sensors along the axes, with these gains.
pub(crate) fn triaxials(gains: [[f64; 3]; 3]) -> Vec<Sensor> {
    let both = SENSORS.iter().zip(gains);
    both.map(|(&position, gains)| {
        Sensor::triaxial(Vector3::from(position), &Axes::identity(), gains).unwrap()
    })
    .collect()
}

/// Gains of the check values: 1.05 for channel 4.
pub(crate) const CHECK_GAINS: [[f64; 3]; 3] = [[1.0; 3], [1.0, 1.05, 1.0], [1.0; 3]];

/// The channels of the same sensors, each by itself.
pub(crate) fn uniaxials(gains: [[f64; 3]; 3]) -> Vec<Sensor> {
    (0..9)
        .map(|i| {
            let (sensor, axis) = (i / 3, i % 3);
            let position = Vector3::from(SENSORS[sensor]);
            Sensor::uniaxial(position, Vector3::ith(axis, 1.0), gains[sensor][axis]).unwrap()
        })
        .collect()
}

pub(crate) fn impacts() -> Vec<Impact> {
    IMPACTS
        .iter()
        .map(|&(position, direction)| {
            Impact::new(Vector3::from(position), Vector3::from(direction), 1.0).unwrap()
        })
        .collect()
}

/// The set-up of the check values.
pub(crate) fn check_set_up() -> SetUp {
    SetUp::new(&triaxials(CHECK_GAINS), &impacts()).unwrap()
}

/// All weights equal.
pub(crate) fn equal(set_up: SetUp) -> VirtualPoint {
    VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal).unwrap()
}

/// (K + jωC − ω²M)⁻¹ of the check values: six oscillators.
pub(crate) fn check_receptance(frequency_hz: f64) -> Matrix6<Complex64> {
    let omega = std::f64::consts::TAU * frequency_hz;
    let stiffness = Vector6::new(1e6, 2e6, 3e6, 4e3, 5e3, 6e3);
    let inertia = Vector6::new(2.0, 2.0, 2.0, 0.01, 0.02, 0.03);
    let diagonal = stiffness.zip_map(&inertia, |k, m| {
        Complex64::new(k - omega * omega * m, omega * 1e-4 * k).inv()
    });
    Matrix6::from_diagonal(&diagonal)
}

/// Functions of the check values: row 0 is 10 % too large, so that the interface is not rigid.
pub(crate) fn check_functions() -> DMatrix<Complex64> {
    let mut functions = check_set_up().functions(&check_receptance(100.0));
    functions.row_mut(0).scale_mut(1.1);
    functions
}

/// A symmetric receptance with all couplings, different at each line.
pub(crate) fn full_receptance(line: u64) -> Matrix6<Complex64> {
    let numbers = scattered::<72>(line + 500);
    let root = Matrix6::from_fn(|i, j| Complex64::new(numbers[6 * i + j], numbers[36 + 6 * i + j]));
    let scale = [1e-3, 1e-3, 1e-3, 3e-2, 3e-2, 3e-2];
    let symmetric = root + root.transpose();
    Matrix6::from_fn(|i, j| symmetric[(i, j)] * scale[i] * scale[j])
}

/// Numbers between −1 and 1: the high bits of a counter that SplitMix64 (Steele, Lea and Flood 2014) has mixed.
pub(crate) fn scattered<const N: usize>(seed: u64) -> [f64; N] {
    let mut mixed = Mixed(seed * 1000);
    std::array::from_fn(|_| mixed.next())
}

/// The same numbers, one after the other.
pub(crate) struct Mixed(pub(crate) u64);

impl Mixed {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 += 1;
        let mut z = self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Complex and normal, E|ε|² = 1 (Box and Muller 1958).
    pub(crate) fn normal(&mut self) -> Complex64 {
        let [radius, angle] = [self.next(), self.next()].map(|number| 0.5 * (number + 1.0));
        let radius = (-(1.0 - radius).ln()).sqrt();
        Complex64::from_polar(radius, std::f64::consts::TAU * angle)
    }

    /// Functions of such noise.
    pub(crate) fn noise(&mut self, rows: usize, columns: usize) -> DMatrix<Complex64> {
        DMatrix::from_fn(rows, columns, |_, _| self.normal())
    }

    /// A positive definite matrix without zeros.
    pub(crate) fn definite(&mut self, count: usize) -> DMatrix<f64> {
        let root = DMatrix::from_fn(count, count, |_, _| self.next());
        &root * root.transpose() + DMatrix::identity(count, count)
    }
}

/// Twelve sensors of one channel and twelve impacts without any order within 30 mm.
pub(crate) fn disordered(seed: u64) -> SetUp {
    let mut mixed = Mixed(seed * 100_000);
    let mut vector = || Vector3::from_fn(|_, _| mixed.next());
    let sensors: Vec<_> = (0..12)
        .map(|_| Sensor::uniaxial(vector() * 0.03, vector().normalize(), 1.0).unwrap())
        .collect();
    let impacts: Vec<_> = (0..12)
        .map(|_| Impact::new(vector() * 0.03, vector().normalize(), 1.0).unwrap())
        .collect();
    SetUp::new(&sensors, &impacts).unwrap()
}

/// |a − b| is less than a share of |b|.
#[track_caller]
pub(crate) fn same(found: Complex64, expected: Complex64, tolerance: f64) {
    let error = (found - expected).norm() / expected.norm();
    assert!(error < tolerance, "{found} is {error:e} off {expected}");
}

/// Largest difference of two matrices over the largest entry of the second.
pub(crate) fn apart(found: &DMatrix<Complex64>, expected: &DMatrix<Complex64>) -> f64 {
    let largest = |matrix: &DMatrix<Complex64>| matrix.iter().map(|v| v.norm()).fold(0.0, f64::max);
    largest(&(found - expected)) / largest(expected)
}

/// S Sᵀ + I of sines of the indices: a matrix of weights that another program can build as well.
pub(crate) fn sine_weights(count: usize, phase: f64) -> Weights {
    let root = DMatrix::from_fn(count, count, |i, j| {
        let (i, j) = (i as f64, j as f64);
        (i * i + std::f64::consts::SQRT_2 * i * j + j + phase).sin()
    });
    Weights::Full(&root * root.transpose() + DMatrix::identity(count, count))
}

/// Sensors and impacts at random places; functions of a set-up with errors of these sizes, in deviations, and noise.
pub(crate) fn trial(
    seed: u64,
    bad: Option<(usize, f64)>,
) -> (VirtualPoint, Vec<DMatrix<Complex64>>) {
    let mut mixed = Mixed(seed);
    let mut place = || Vector3::from_fn(|_, _| 0.03 * mixed.next());
    let sensors: Vec<_> = (0..3)
        .map(|_| Sensor::triaxial(place(), &Axes::identity(), [1.0; 3]).unwrap())
        .collect();
    let impacts: Vec<_> = (0..9)
        .map(|_| Impact::new(place(), place().normalize(), 1.0).unwrap())
        .collect();
    let set_up = SetUp::new(&sensors, &impacts).unwrap();
    let tolerance = Tolerance::TYPICAL;
    let mut errors: Vec<f64> = (set_up.parameters().iter())
        .map(|one| 1.7 * mixed.next() * tolerance.of(one.change))
        .collect();
    if let Some((parameter, size)) = bad {
        errors[parameter] = size;
    }
    let displaced = set_up.displaced(&errors).unwrap();
    let lines = (0..8).map(|_| {
        let scale = |i: usize| if i < 3 { 1.0 } else { 30.0 };
        let receptance = Matrix6::from_fn(|i, j| {
            Complex64::new(mixed.next(), mixed.next()) * scale(i) * scale(j)
        });
        displaced
            .functions(&receptance)
            .map(|value| value * (1.0 + 0.002 * mixed.next()))
    });
    let lines = lines.collect();
    let point = VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal).unwrap();
    (point, lines)
}
