//! Motions whose samples are known in closed form, or as those of finer steps.

use nalgebra::DVector;

use super::*;
use crate::response::slider::SliderValues;

fn record(quantity: Quantity, interval_s: f64) -> Recorded {
    Recorded {
        interval_s,
        values: vec![0.0; 2000],
        quantity,
        share: 0.5,
        noise: 1e-6,
        read_part: 1.0,
        has_band: false,
        others: Some(Vec::new()),
    }
}

fn values() -> Values {
    Values {
        mass: 2.0,
        joint_stiffness: 5e5,
        joint_damping: 4.0,
        ..Values::default()
    }
}

/// u = A e^(−δt) (cos ω_d t + (δ/ω_d) sin ω_d t), δ = C/(2M), M = m/2.
#[test]
fn a_linear_motion_is_its_closed_form() {
    let (released_m, time_s) = (3e-4, -1.3e-3);
    let (rate, square) = (2.0, 5e5);
    let damped = f64::sqrt(square - rate * rate);
    for quantity in [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::Acceleration,
    ] {
        let record = record(quantity, 2e-4);
        let grid = Grid::of(&record, 2000, f64::sqrt(square));
        let release = Release {
            displacement_m: released_m,
            time_s,
        };
        let found = sampled(&values(), &release, &record, &grid).unwrap();
        for (n, found) in found.iter().enumerate() {
            let t = 2e-4 * n as f64 - time_s;
            let (sine, cosine) = (damped * t).sin_cos();
            let fall = released_m * (-rate * t).exp();
            let u = fall * (cosine + rate / damped * sine);
            let v = -fall * square / damped * sine;
            let (expected, size) = match quantity {
                Quantity::Displacement => (u, released_m),
                Quantity::Velocity => (v, released_m * damped),
                Quantity::Acceleration => (-square * u - 2.0 * rate * v, released_m * square),
            };
            let error = (found - 0.5 * expected).abs() / size;
            assert!(error < 2e-6, "{quantity:?} {n}: {error:e}");
        }
    }
}

/// Steps that are cut at turns and corners: four times as many change little, and the law's memory is that of the release.
#[test]
fn a_slider_s_motion_is_that_of_finer_steps() {
    let mut own = values();
    own.slider = Some(SliderValues::jenkins(6e4, 6.0, 3e-4));
    let release = Release {
        displacement_m: -3e-4,
        time_s: -1e-3,
    };
    let record = record(Quantity::Displacement, 1.3e-4);
    let grid = Grid::of(&record, 2000, 707.0);
    let finer = Grid {
        steps: 4 * grid.steps,
        step_s: 0.25 * grid.step_s,
        ..grid
    };
    let [coarse, fine] = [grid, finer].map(|grid| sampled(&own, &release, &record, &grid).unwrap());
    let pairs = coarse.iter().zip(&fine);
    let largest = pairs.fold(0.0_f64, |most, (one, other)| most.max((one - other).abs()));
    assert!(largest < 2e-5 * 1.5e-4, "{largest:e}");
}

/// A release just behind the first sample: what is before it is the mirror of what follows.
#[test]
fn what_is_before_the_release_is_its_mirror() {
    let record = record(Quantity::Displacement, 2e-4);
    let grid = Grid::of(&record, 2000, 707.0);
    let release = Release {
        displacement_m: 3e-4,
        time_s: 1e-4,
    };
    let found = sampled(&values(), &release, &record, &grid).unwrap();
    assert!((found[0] / found[1] - 1.0).abs() < 1e-5, "{found:?}");
}

#[test]
fn a_motion_that_grows_is_none_of_a_decay() {
    let mut own = values();
    own.joint_damping = -40.0;
    let record = record(Quantity::Displacement, 2e-4);
    let grid = Grid::of(&record, 2000, 707.0);
    let release = Release {
        displacement_m: 3e-4,
        time_s: 0.0,
    };
    assert_eq!(sampled(&own, &release, &record, &grid), None);
}

/// By central differences of the samples themselves, of each kind of law and quantity, with a release before the first sample and
/// one just behind it. The motion turns some sixty times, and its first loops pass the corner of the load.
#[test]
fn changes_are_those_of_differences() {
    use crate::response::slider::{Slider, SliderParameter as Of};
    use ResponseUnknown::{
        JointDamping, JointStiffness, Mass, Slider as OfSlider, SupportDamping, SupportStiffness,
        Term as OfTerm,
    };
    use bolted_joint_dynamics::law::Term;
    let base = Values {
        support_stiffness: 2e4,
        support_damping: 0.5,
        ..values()
    };
    let cubic = |mut own: Values| {
        *own.terms.coefficient_mut(Term::CUBIC) = 1e11;
        *own.terms.coefficient_mut(Term::ALL[3]) = 1e6;
        own
    };
    let beside = |slider| Values {
        slider: Some(slider),
        ..base
    };
    let bodies = [
        Mass,
        SupportStiffness,
        SupportDamping,
        JointStiffness,
        JointDamping,
    ];
    let of = |more: &[ResponseUnknown]| [&bodies, more].concat();
    let iwan = [Of::SlipForce, Of::Stiffness, Of::Exponent, Of::Ratio].map(OfSlider);
    let cases = [
        (
            cubic(base),
            of(&[OfTerm(Term::CUBIC), OfTerm(Term::ALL[3])]),
            Quantity::Velocity,
        ),
        (
            beside(SliderValues::jenkins(6e4, 6.0, 3e-4)),
            of(&[Of::Stiffness, Of::SlipForce].map(OfSlider)),
            Quantity::Displacement,
        ),
        (
            beside(SliderValues::iwan(
                Slider::MicroSlip,
                2e4,
                -0.4,
                [1.0, 1.0],
                3e-4,
            )),
            of(&[Of::Density, Of::Exponent].map(OfSlider)),
            Quantity::Acceleration,
        ),
        (
            cubic(beside(SliderValues::iwan(
                Slider::Iwan,
                2e4,
                -0.4,
                [0.6, 0.5],
                3e-4,
            ))),
            of(&[&iwan[..], &[OfTerm(Term::CUBIC)]].concat()),
            Quantity::Acceleration,
        ),
    ];
    for (number, (own, unknowns, quantity)) in cases.into_iter().enumerate() {
        let record = record(quantity, 1.3e-4);
        let grid = Grid::of(&record, 2000, 707.0);
        for time_s in [-1e-3, 1e-4] {
            let release = Release {
                displacement_m: -3e-4,
                time_s,
            };
            let at = |own: &Values, release: &Release| {
                let samples = sampled(own, release, &record, &grid);
                DVector::from_vec(samples.unwrap())
            };
            let directions = unknowns.iter().copied().map(Direction::Unknown);
            let of_release = [Direction::Displacement, Direction::Time];
            let directions: Vec<Direction> = directions.chain(of_release).collect();
            let found = changes(&own, &release, &record, &grid, &directions).unwrap();
            for (column, direction) in found.column_iter().zip(&directions) {
                let mut sides = [(own, release); 2];
                let step = match direction {
                    Direction::Unknown(OfSlider(_)) => 1e-5,
                    Direction::Unknown(unknown) => 1e-5 * own.of(*unknown).abs(),
                    Direction::Displacement => 1e-9,
                    Direction::Time => 1e-8,
                };
                for ((values, release), sign) in sides.iter_mut().zip([1.0, -1.0]) {
                    *match direction {
                        Direction::Unknown(unknown) => values.place(*unknown).unwrap(),
                        Direction::Displacement => &mut release.displacement_m,
                        Direction::Time => &mut release.time_s,
                    } += sign * step;
                }
                let [above, below] = sides.map(|(values, release)| at(&values, &release));
                let expected = (above - below) / (2.0 * step);
                let error = (column - &expected).norm() / expected.norm();
                assert!(error < 1e-4, "{number} {time_s} {direction:?}: {error:e}");
            }
        }
    }
}
