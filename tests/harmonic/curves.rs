//! Curves through folds: where they turn, where they end, and which of their motions persist.

use bolted_joint::harmonic::{
    CurveOptions, CurvePoint, HarmonicBalance, HarmonicError, HarmonicLoads, Harmonics, Observed,
    Target,
};
use bolted_joint_dynamics::{Body, Lap, Linear};
use bolted_joint_testing::close;
use num_complex::Complex64;

use super::duffing::{HARDENING, SOFTENING};
use super::laps::{Duffing, pirdayr, with_rotation};

const WITH_STABILITY: CurveOptions = CurveOptions {
    steps: bolted_joint::harmonic::Steps {
        first: 0.02,
        shortest: 1e-9,
        longest: 0.1,
        most: 20_000,
    },
    with_stability: true,
};

fn balance<const D: usize>(
    lap: &Lap<D>,
    harmonics: Result<Harmonics, HarmonicError>,
) -> HarmonicBalance<D> {
    HarmonicBalance::new(lap, harmonics.unwrap()).unwrap()
}

/// The fundamental of the relative motion.
fn relative(balance: &HarmonicBalance<1>, point: &CurvePoint<1>) -> Complex64 {
    balance.amplitude_of(&point.solution, Observed::Relative(0), 1)
}

fn is_stable<const D: usize>(point: &CurvePoint<D>) -> bool {
    point.stability.as_ref().unwrap().is_stable()
}

/// Squared frequencies at an amplitude by the formula of one harmonic, lower and upper.
fn squared_frequencies(duffing: Duffing, force: f64, amplitude: f64) -> [f64; 2] {
    // (k' − m u)² + c² u = (F/X)², u = ω², k' = k + ¾ k3 X²
    let Duffing {
        inertia: m,
        damping: c,
        stiffness,
        cubic,
    } = duffing;
    let k = stiffness + 0.75 * cubic * amplitude * amplitude;
    let half = k * m - 0.5 * c * c;
    let root = (half * half - m * m * (k * k - (force / amplitude).powi(2))).sqrt();
    [(half - root) / (m * m), (half + root) / (m * m)]
}

/// The amplitude within a range at which `value` is least, by the golden section.
fn least(mut low: f64, mut high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    while high - low > 1e-9 * high {
        let (one, other) = (high - part * (high - low), low + part * (high - low));
        // past the peak there is no frequency: the range ends before
        if value(one) < value(other) {
            high = other;
        } else {
            low = one;
        }
    }
    0.5 * (low + high)
}

#[test]
fn the_formula_of_one_harmonic_has_the_same_folds() {
    for (duffing, force, range) in [(HARDENING, 3.0, [2.0, 16.0]), (SOFTENING, 0.45, [9.0, 3.0])] {
        let balance = balance(&duffing.symmetric(), Harmonics::odd(1));
        let loads = HarmonicLoads::opposed(force);
        let curve = balance
            .forced_curve(range, &loads, &WITH_STABILITY)
            .unwrap();
        let folds: Vec<&CurvePoint<1>> = curve.iter().filter(|point| point.is_fold).collect();
        let [first, second] = folds.as_slice() else {
            panic!("{} folds", folds.len());
        };
        let amplitude = |point: &CurvePoint<1>| relative(&balance, point).norm();
        // The other fold is that of the branch on the far side of the resonance.
        let branch = usize::from(duffing.cubic > 0.0);
        let sign = if duffing.cubic > 0.0 { 1.0 } else { -1.0 };
        let on_branch = |x: f64| sign * squared_frequencies(duffing, force, x)[branch];
        let at_second = amplitude(second);
        let turned = least(0.3 * at_second, 2.0 * at_second, |x| {
            let value = on_branch(x);
            if value.is_nan() { f64::INFINITY } else { value }
        });
        let omega = (sign * on_branch(turned)).sqrt();
        close(second.solution.omega_rad_s(), omega, 1e-13);
        close(at_second, turned, 1e-6);
        // The first, near the tip, is where the same branch turns back.
        let at_first = amplitude(first);
        let highest = least(0.99 * at_first, 1.000_001 * at_first, |x| {
            let value = on_branch(x);
            if value.is_nan() {
                f64::INFINITY
            } else {
                -value
            }
        });
        let omega = (sign * on_branch(highest)).sqrt();
        close(first.solution.omega_rad_s(), omega, 1e-9);
    }
}

#[test]
fn a_curve_passes_both_folds_and_returns_to_the_linear_tail() {
    for (duffing, force, range) in [
        (HARDENING, 3.0, [2.0, 30.0]),
        (SOFTENING, 0.45, [30.0, 2.0]),
    ] {
        let balance = balance(&duffing.symmetric(), Harmonics::all(9));
        let loads = HarmonicLoads::opposed(force);
        let curve = balance
            .forced_curve(range, &loads, &WITH_STABILITY)
            .unwrap();
        let last = curve.last().unwrap();
        assert_eq!(curve.iter().filter(|point| point.is_fold).count(), 2);
        assert!((last.solution.omega_rad_s() - range[1]).abs() < 1e-12);
        // There the response is that of the linear oscillator but for k3 X³.
        let x = relative(&balance, last);
        let omega = range[1];
        let stiffness = duffing.stiffness - omega * omega * duffing.inertia;
        let linear = Complex64::from(force) / Complex64::new(stiffness, omega * duffing.damping);
        let bend = 0.75 * duffing.cubic * x.norm().powi(3) / force;
        assert!((x / linear - 1.0).norm() < 1.5 * bend.abs() + 1e-12);
        // Frequency goes on along the tangent only between folds, and stability flips exactly there.
        let mut stable = true;
        for pair in curve.windows(2) {
            if pair[0].is_fold {
                stable = !stable;
            }
            if pair[1].is_fold {
                let largest = pair[1].stability.as_ref().unwrap().multipliers[0];
                assert!((largest - 1.0).norm() < 2e-4, "{largest}");
            } else {
                assert_eq!(is_stable(&pair[1]), stable, "{:?}", pair[1]);
            }
        }
        assert!(stable);
    }
}

#[test]
fn the_same_curve_upwards_and_downwards() {
    let balance = balance(&HARDENING.symmetric(), Harmonics::odd(7));
    let loads = HarmonicLoads::opposed(3.0);
    let folds = |range| -> Vec<f64> {
        let curve = balance.forced_curve(range, &loads, &CurveOptions::default());
        let curve = curve.unwrap();
        let folds = curve.iter().filter(|point| point.is_fold);
        folds.map(|point| point.solution.omega_rad_s()).collect()
    };
    let (up, mut down) = (folds([3.0, 20.0]), folds([20.0, 3.0]));
    down.reverse();
    assert_eq!((up.len(), down.len()), (2, 2));
    for (up, down) in up.iter().zip(&down) {
        close(*up, *down, 1e-12);
    }
}

#[test]
fn multipliers_of_a_linear_lap_are_those_of_its_modes() {
    let lap: Lap<2> = Lap {
        joint: with_rotation().joint.linear.into(),
        ..with_rotation()
    };
    let balance = balance(&lap, Harmonics::odd(1));
    let omega = 700.0;
    let loads = HarmonicLoads::on_a(10.0);
    let solution = balance.forced(omega, &loads, None).unwrap();
    let found = balance.stability(&solution).unwrap().multipliers;
    let period = std::f64::consts::TAU / omega;
    let spectrum = lap.spectrum().unwrap();
    assert_eq!(found.len(), spectrum.eigenvalues().len());
    for eigenvalue in spectrum.eigenvalues() {
        let expected =
            Complex64::new(eigenvalue.real * period, eigenvalue.imaginary * period).exp();
        let distances = found.iter().map(|found| (found - expected).norm());
        let nearest = distances.fold(f64::MAX, f64::min);
        assert!(nearest < 2e-6, "{expected}: {nearest}");
    }
}

/// A passive oscillator that nothing holds: what drifts has two multipliers of 1, which rounding must not make unstable.
#[test]
fn a_free_lap_is_stable_where_it_is_linear() {
    let held = HARDENING.symmetric();
    let free = |body: Body<1>| Body {
        stiffness: [0.0],
        damping: [0.0],
        ..body
    };
    let lap = Lap {
        a: free(held.a),
        b: free(held.b),
        joint: Linear {
            stiffness: [[50.0]],
            damping: [[0.1]],
        }
        .into(),
    };
    let balance = balance(&lap, Harmonics::odd(1));
    for loads in [HarmonicLoads::opposed(1.0), HarmonicLoads::on_a(1.0)] {
        for n in 0..200 {
            let omega = 1.0 + 0.13 * f64::from(n);
            let solution = balance.forced(omega, &loads, None).unwrap();
            let stability = balance.stability(&solution).unwrap();
            assert!(stability.is_stable(), "{omega}: {stability:?}");
            let ones = stability.multipliers.iter();
            let ones = ones.filter(|multiplier| **multiplier == Complex64::from(1.0));
            assert_eq!(ones.count(), 2);
        }
    }
}

/// By the integral over a quarter of a period: T = 4 ∫ dx/√(2 (U(A) − U(x))/m), with x = A sin φ.
fn conservative_omega(duffing: Duffing, peak: f64) -> f64 {
    // U = ½ k x² + ¼ k3 x⁴: (U(A) − U(x))/(A² cos²φ) = ½ k + ¼ k3 A² (1 + sin²φ), which is smooth and periodic in φ
    let count = 400;
    let sum: f64 = (0..count)
        .map(|n| {
            let phase = std::f64::consts::PI * (f64::from(n) + 0.5) / f64::from(count);
            let part = 0.5 * duffing.stiffness
                + 0.25 * duffing.cubic * peak * peak * (1.0 + phase.sin().powi(2));
            (2.0 * part / duffing.inertia).sqrt().recip()
        })
        .sum();
    // over half a turn, twice for the period
    f64::from(count) / sum
}

#[test]
fn the_backbone_is_the_conservative_oscillator() {
    for duffing in [HARDENING, SOFTENING] {
        let undamped = Duffing {
            damping: 0.0,
            ..duffing
        };
        let balance = balance(&undamped.symmetric(), Harmonics::odd(25));
        let target = Target::relative(0, 1.0);
        let curve = balance.backbone([1e-3, 0.25], target, &CurveOptions::default());
        let curve = curve.unwrap();
        let end = relative(&balance, curve.last().unwrap());
        assert!((end.norm() - 0.25).abs() < 1e-12);
        for point in &curve {
            let peak = balance.peak_of(&point.solution, Observed::Relative(0));
            let expected = conservative_omega(undamped, peak);
            close(point.solution.omega_rad_s(), expected, 1e-10);
            assert!(point.solution.damping_ratio().abs() < 1e-12);
        }
    }
}

#[test]
fn phase_resonance_meets_the_forced_curve_and_the_backbone() {
    let lap = pirdayr(1e12);
    let balance = balance(&lap, Harmonics::odd(7));
    let loads = HarmonicLoads::opposed(1.0);
    let target = Target::relative(0, 2e-4);
    let resonance = balance.resonance(&loads, target, None).unwrap();
    let x = balance.amplitude_of(&resonance, Observed::Relative(0), 1);
    close(x.norm(), 2e-4, 1e-12);
    assert!((x.arg() + std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{x}");
    // The same loads at the same frequency give the same motion.
    let forced = balance.forced(
        resonance.omega_rad_s(),
        &resonance.loads(),
        Some(&resonance),
    );
    let forced = forced.unwrap();
    let again = balance.amplitude_of(&forced, Observed::Relative(0), 1);
    assert!((again / x - 1.0).norm() < 1e-9);
    // Light damping: the free motion has that frequency, and loses in a period what the loads put in.
    let free = balance.free(target, None).unwrap();
    close(free.omega_rad_s(), resonance.omega_rad_s(), 1e-6);
    // Both bodies alike: work of F on x_a and −F on x_b is π F |r|; the force 2ζω M ẋ takes 2ζω · ω · ½m · π ω |r|² a period.
    let omega = free.omega_rad_s();
    let work = resonance.load_factor() * 2e-4;
    let higher: f64 = [3, 5, 7]
        .map(|order| {
            let amplitude = balance.amplitude_of(&free, Observed::Relative(0), order);
            (order as f64 * amplitude.norm() / 2e-4).powi(2)
        })
        .iter()
        .sum();
    let taken = 2.0 * free.damping_ratio() * omega * omega * 0.5 * 2.35 * 2e-4_f64.powi(2);
    close(taken * (1.0 + higher), work, 1e-5);
}

#[test]
fn constant_amplitude_passes_where_constant_force_folds() {
    let balance = balance(&pirdayr(1e12), Harmonics::odd(7));
    let loads = HarmonicLoads::opposed(1.0);
    let target = Target::relative(0, 2e-4);
    let options = CurveOptions::default();
    let curve = balance.controlled_curve([1900.0, 2300.0], &loads, target, &options);
    let curve = curve.unwrap();
    assert!(curve.iter().all(|point| !point.is_fold));
    for point in &curve {
        close(relative(&balance, point).norm(), 2e-4, 1e-9);
    }
    // The least force is at phase resonance.
    let forces = curve.iter().map(|point| point.solution.load_factor());
    let least = forces.fold(f64::MAX, f64::min);
    let resonance = balance.resonance(&loads, target, None).unwrap();
    assert!(least >= resonance.load_factor() * (1.0 - 1e-6));
    assert!(least < resonance.load_factor() * 1.05);
}

#[test]
fn the_first_mode_of_like_bodies_is_followed_although_the_joint_does_not_move() {
    let lap = pirdayr(1e12);
    let balance = balance(&lap, Harmonics::odd(3));
    let loads = HarmonicLoads::on_b(1.0);
    let curve = balance.forced_curve([600.0, 750.0], &loads, &CurveOptions::default());
    let on_b = Observed::Body(bolted_joint::harmonic::Side::B, 0);
    let amplitude = |point: &CurvePoint<1>| balance.amplitude_of(&point.solution, on_b, 1).norm();
    let found = curve.unwrap().iter().map(amplitude).fold(0.0, f64::max);
    // x_a + x_b is linear and takes F, x_a − x_b is far below its resonance: at the peak x_b = F/(2 c ω) and little more.
    let (k, c, m): (f64, f64, f64) = (10.56e5, 1.39, 2.35);
    let expected = 1.0 / (2.0 * c * (k / m).sqrt());
    close(found, expected, 0.01);
}
