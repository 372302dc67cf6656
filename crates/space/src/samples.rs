//! Numbers that tests share: the joint of the check values, and numbers without a pattern that are the same in each
//! run.

use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};
use num_complex::Complex64;

use crate::transported;

/// Diagonal of the stiffness of the check values: N/m, N·m/rad.
pub(crate) const CHECK_STIFFNESS: [f64; 6] = [2e7, 3e7, 5e7, 4e3, 6e3, 8e3];

/// Stiffness of the check values, with three couplings.
pub(crate) fn check_stiffness() -> Matrix6<f64> {
    let mut stiffness = Matrix6::from_diagonal(&Vector6::from(CHECK_STIFFNESS));
    for (row, column, value) in [(0, 4, 1e5), (1, 3, -5e4), (2, 5, 2e4)] {
        stiffness[(row, column)] = value;
        stiffness[(column, row)] = value;
    }
    stiffness
}

/// Numbers between −1 and 1: the high bits of a counter that SplitMix64 (Steele, Lea and Flood 2014) has mixed.
pub(crate) fn scattered<const N: usize>(seed: u64) -> [f64; N] {
    std::array::from_fn(|i| {
        let mut z = (seed * 1000 + i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    })
}

/// A positive definite matrix of translations (1e8) and rotations (4e4), without any symmetry of space.
pub(crate) fn definite(seed: u64) -> Matrix6<f64> {
    let root = Matrix6::from_row_slice(&scattered::<36>(seed));
    let scale = Matrix6::from_diagonal(&Vector6::new(1e4, 1e4, 1e4, 2e2, 2e2, 2e2));
    scale * (root * root.transpose() + Matrix6::identity() * 0.2) * scale
}

/// A symmetric matrix without sign.
pub(crate) fn any_symmetric(seed: u64) -> Matrix6<f64> {
    crate::symmetric(&scattered::<21>(seed))
}

/// sin(i² + √2·j·i + j): a matrix that another program can build as well.
pub(crate) fn sines(rows: usize, columns: usize, phase: f64) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |i, j| {
        let (i, j) = (i as f64, j as f64);
        (i * i + std::f64::consts::SQRT_2 * i * j + j + phase).sin()
    })
}

/// A matrix of six numbers.
pub(crate) fn diagonal(numbers: [f64; 6]) -> Matrix6<f64> {
    Matrix6::from_diagonal(&Vector6::from(numbers))
}

/// Dynamic stiffness of a structure of nodes with mass that springs without any symmetry connect, one of them to the
/// ground.
pub(crate) fn structure(seed: u64, nodes: usize, grounded: bool, omega: f64) -> DMatrix<Complex64> {
    let size = 6 * nodes;
    let mut stiffness = DMatrix::zeros(size, size);
    let mut inertia = DMatrix::zeros(size, size);
    for node in 0..nodes {
        let mass = diagonal([1.0, 1.0, 1.0, 1e-3, 2e-3, 3e-3]) * (1.0 + node as f64);
        let mass = transported(
            &mass,
            &(Vector3::from(scattered::<3>(seed + node as u64)) * 0.02),
        );
        inertia
            .view_mut((6 * node, 6 * node), (6, 6))
            .copy_from(&mass);
        if node > 0 {
            let spring = definite(seed + node as u64);
            let mut across = DMatrix::zeros(6, size);
            across.view_mut((0, 6 * node), (6, 6)).fill_with_identity();
            across
                .view_mut((0, 6 * node - 6), (6, 6))
                .copy_from(&-Matrix6::<f64>::identity());
            stiffness +=
                across.transpose() * DMatrix::from_column_slice(6, 6, spring.as_slice()) * across;
        }
    }
    if grounded {
        let mut corner = stiffness.view_mut((0, 0), (6, 6));
        corner += DMatrix::from_column_slice(6, 6, definite(seed + 30).as_slice());
    }
    stiffness.zip_map(&inertia, |k, m| {
        Complex64::new(k - omega * omega * m, 0.01 * k)
    })
}
