//! Harmonic balance against time: SciPy's shooting, and the same RK4 as in the FMU.

use std::f64::consts::TAU;

use bolted_joint::harmonic::{
    CurveOptions, HarmonicBalance, HarmonicLoads, Harmonics, Observed, Side, Solution, Steps,
};
use bolted_joint_dynamics::{Lap, LapIntegrator, LapState};
use num_complex::Complex64;

use super::duffing::HARDENING;
use super::laps::{Duffing, with_rotation};

/// See `shooting.py`.
const SHOOTING: &str = include_str!("data/duffing.csv");

#[test]
fn duffing_agrees_with_shooting() {
    let rows: Vec<Vec<f64>> = SHOOTING
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|number| number.parse().unwrap())
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 20);
    for row in rows {
        let [cubic, force, omega, x, v] = [0, 1, 2, 3, 4].map(|place| row[place]);
        let [cosine, sine, cosine_3, sine_3, largest] = [5, 6, 7, 8, 9].map(|place| row[place]);
        let lap = Duffing { cubic, ..HARDENING }.symmetric();
        let balance = HarmonicBalance::new(&lap, Harmonics::odd(25).unwrap()).unwrap();
        let loads = HarmonicLoads::opposed(force);
        let fundamental = Complex64::new(cosine, -sine);
        // The point of the whole curve that is nearest, brought to the frequency.
        let curve = balance.forced_curve([2.5, 15.0], &loads, &CurveOptions::default());
        let curve = curve.unwrap();
        let far = |solution: &Solution<1>| {
            let there = balance.amplitude_of(solution, Observed::Relative(0), 1);
            (solution.omega_rad_s() / omega - 1.0).abs() + (there / fundamental - 1.0).norm()
        };
        let nearest = curve
            .iter()
            .map(|point| &point.solution)
            .min_by(|one, other| far(one).total_cmp(&far(other)))
            .unwrap();
        let solution = balance.forced(omega, &loads, Some(nearest)).unwrap();
        let amplitude = |order| balance.amplitude_of(&solution, Observed::Relative(0), order);
        let found = amplitude(1);
        let error = (found / fundamental - 1.0).norm();
        assert!(error < 1e-8, "{omega}: {found}");
        let third = Complex64::new(cosine_3, -sine_3);
        assert!((amplitude(3) - third).norm() < 1e-8 * found.norm());
        let state = balance.state_at(&solution, 0.0);
        let start = state.a.relative_to(&state.b);
        assert!((start.displacement[0] - x).abs() < 1e-8 * found.norm());
        assert!((start.velocity[0] - v).abs() < 1e-8 * found.norm() * omega);
        let stability = balance.stability(&solution).unwrap();
        // The lap has two multipliers more, those of both bodies moving together.
        let distances = stability
            .multipliers
            .iter()
            .map(|one| (one.norm() - largest).abs());
        let distance = distances.fold(f64::MAX, f64::min);
        assert!(
            distance < 2e-6 * largest,
            "{omega}: {stability:?} {largest}"
        );
        assert_eq!(stability.is_stable(), largest < 1.0);
    }
}

/// RK4 from a state, so many periods of so many steps.
fn integrated<const D: usize>(
    lap: &Lap<D>,
    mut state: LapState<D>,
    loads: &HarmonicLoads<D>,
    omega: f64,
    [periods, steps]: [usize; 2],
    mut each: impl FnMut(usize, &LapState<D>),
) -> LapState<D> {
    let integrator = LapIntegrator::new(lap);
    let step = TAU / omega / steps as f64;
    let at = |half: usize| loads.at_phase(TAU * half as f64 / (2 * steps) as f64);
    let all: Vec<_> = (0..=2 * steps).map(at).collect();
    for _ in 0..periods {
        for n in 0..steps {
            each(n, &state);
            state = integrator.step_with_loads(
                &state,
                &[all[2 * n], all[2 * n + 1], all[2 * n + 2]],
                step,
            );
        }
    }
    state
}

/// Largest difference of two states, relative to the size of the second's motion.
fn difference<const D: usize>(one: &LapState<D>, other: &LapState<D>, omega: f64) -> f64 {
    let mut largest: f64 = 0.0;
    for dof in 0..D {
        for (one, other) in [(&one.a, &other.a), (&one.b, &other.b)] {
            let (x, v) = (other.displacement[dof], other.velocity[dof] / omega);
            let size = x.hypot(v);
            let apart = (one.displacement[dof] - x).hypot(one.velocity[dof] / omega - v);
            largest = largest.max(apart / size);
        }
    }
    largest
}

#[test]
fn rk4_ends_on_the_stable_branches_and_leaves_the_unstable_one() {
    for (duffing, force) in [
        (HARDENING, 3.0),
        (
            Duffing {
                cubic: -300.0,
                ..HARDENING
            },
            0.45,
        ),
    ] {
        let lap = duffing.symmetric();
        let balance = HarmonicBalance::new(&lap, Harmonics::odd(21).unwrap()).unwrap();
        let loads = HarmonicLoads::opposed(force);
        let options = CurveOptions {
            steps: Steps {
                longest: 0.03,
                ..Steps::default()
            },
            with_stability: true,
        };
        let curve = balance.forced_curve([3.0, 20.0], &loads, &options).unwrap();
        let mut unstable = 0;
        for (n, point) in curve.iter().enumerate() {
            let omega = point.solution.omega_rad_s();
            let periodic = balance.state_at(&point.solution, 0.0);
            let mut state = periodic;
            state.a.displacement[0] *= 1.001;
            // 2π ζ for a period, ζ = 0.024: thirteen periods a decade
            let after = |periods| integrated(&lap, state, &loads, omega, [periods, 600], |_, _| {});
            let multiplier = point.stability.as_ref().unwrap().multipliers[0].norm();
            if multiplier < 0.98 && n % 12 == 0 {
                let end = difference(&after(400), &periodic, omega);
                assert!(end < 1e-6, "{omega} {multiplier}: {end}");
            } else if multiplier > 1.05 {
                unstable += 1;
                let end = difference(&after(400), &periodic, omega);
                assert!(end > 0.05, "{omega} {multiplier}: {end}");
            }
        }
        assert!(unstable > 0, "no motion of the curve is unstable enough");
    }
}

/// Harmonics of what RK4 settles to, by the discrete Fourier transform of its last period.
#[test]
fn a_lap_with_rotation_has_the_harmonics_of_its_time_history() {
    let lap = with_rotation();
    let balance = HarmonicBalance::new(&lap, Harmonics::all(15).unwrap()).unwrap();
    let mut loads = HarmonicLoads::on_b(60.0);
    loads.a[1] = Complex64::new(0.3, -0.2);
    loads.constant.a = [25.0, 0.0];
    for omega in [450.0, 1250.0, 1500.0] {
        let solution = balance.forced(omega, &loads, None).unwrap();
        assert!(balance.stability(&solution).unwrap().is_stable());
        let steps = 1600;
        let start = balance.state_at(&solution, 0.0);
        let settled = integrated(&lap, start, &loads, omega, [400, steps], |_, _| {});
        let end = difference(&settled, &start, omega);
        assert!(end < 1e-6, "{omega}: {end}");
        let mut sums = [[Complex64::ZERO; 4]; 4];
        integrated(&lap, settled, &loads, omega, [1, steps], |n, state| {
            for (order, sums) in sums.iter_mut().enumerate() {
                let turn = Complex64::cis(-TAU * (order * n) as f64 / steps as f64);
                let weight = if order == 0 { 1.0 } else { 2.0 } / steps as f64;
                for (place, sum) in sums.iter_mut().enumerate() {
                    let body = if place % 2 == 0 { &state.a } else { &state.b };
                    *sum += turn * weight * body.displacement[place / 2];
                }
            }
        });
        let bodies = [(Side::A, 0), (Side::B, 0), (Side::A, 1), (Side::B, 1)];
        for (n, (side, dof)) in bodies.into_iter().enumerate() {
            let observed = Observed::Body(side, dof);
            let size = balance.amplitude_of(&solution, observed, 1).norm();
            for (order, sums) in sums.iter().enumerate() {
                let found = balance.amplitude_of(&solution, observed, order);
                assert!(
                    (found - sums[n]).norm() < 1e-6 * size,
                    "{omega} {observed:?} {order}: {found} {}",
                    sums[n]
                );
            }
            // The constant load and the cubic spring make even harmonics.
            let second = balance.amplitude_of(&solution, observed, 2).norm();
            assert!(second > 1e-5 * size, "{observed:?}: {second} of {size}");
        }
    }
}
