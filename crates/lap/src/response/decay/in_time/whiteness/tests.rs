//! White residuals, and others that each test is there for.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::*;
use crate::response::decay::motion::Release;
use crate::response::decay::recorded::Quantity;

const COUNT: usize = 3000;

/// Sums of twelve uniform numbers, less their mean.
fn white(seed: u64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut unit = || f64::from(generator.next_u32()) / f64::from(u32::MAX);
    let normal = (0..COUNT).map(|_| (0..12).map(|_| unit()).sum::<f64>() - 6.0);
    normal.collect()
}

fn told(residual: Vec<f64>) -> Option<Coloured> {
    let values = Values {
        mass: 2.0,
        joint_stiffness: 5e5,
        joint_damping: 4.0,
        ..Values::default()
    };
    let record = Recorded {
        interval_s: 2e-4,
        values: vec![0.0; COUNT],
        quantity: Quantity::Displacement,
        share: 1.0,
        noise: 3e-6,
        read_part: 1.0,
        has_band: false,
        others: Some(Vec::new()),
    };
    let grid = Grid::of(&record, COUNT, 707.0);
    let course = Course {
        release: Release {
            displacement_m: 3e-4,
            time_s: -1e-3,
        },
        residual: DVector::from_vec(residual),
    };
    coloured(&values, &[(&record, &grid, &course)], 4)
}

fn changed(by: impl Fn(usize, f64) -> f64) -> Option<Coloured> {
    let changed = white(1).into_iter().enumerate();
    told(changed.map(|(n, value)| by(n, value)).collect())
}

/// Four tests of a thousandth each: of 200 residuals about one may be said not to be white.
#[test]
fn white_noise_is_white() {
    let coloured = (0..200).filter(|&seed| told(white(seed)).is_some()).count();
    assert!(coloured <= 4, "{coloured}");
}

#[test]
fn what_is_not_white_is_named() {
    let angle = |n: usize| 707.0 * 2e-4 * n as f64;
    let over = |n: usize| n as f64 / COUNT as f64;
    assert_eq!(
        changed(|n, value| value + 0.4 * (angle(n) + 3.0 * over(n)).sin()),
        Some(Coloured::AlongMotion)
    );
    assert_eq!(
        changed(|n, value| value + 0.3 * (3.0 * angle(n)).sin()),
        Some(Coloured::Multiples)
    );
    assert_eq!(
        changed(|n, value| (1.3 - 0.6 * over(n)) * value),
        Some(Coloured::OverTime)
    );
    // another mode, at 1.7 times the frequency
    assert_eq!(
        changed(|n, value| value + 0.4 * (1.7 * angle(n)).sin()),
        Some(Coloured::Neighbours)
    );
    assert!(matches!(
        changed(|_, value| 2.0 * value),
        Some(Coloured::Large(_))
    ));
}
