//! Laws that slip, in balance with one harmonic, against values by mpmath with 30 digits (closed forms of Segalman's law).

use std::f64::consts::TAU;

use bolted_joint::harmonic::{
    CurveOptions, HarmonicBalance, HarmonicError, HarmonicLoads, Harmonics, Observed, Target,
};
use bolted_joint_dynamics::law::{BoucWen, Dahl, DofLaws, Iwan, Jenkins, LuGre, Valanis};
use bolted_joint_dynamics::{Body, JointLaw, Lap, LapMoment, LapState, LapStepper, Linear};
use num_complex::Complex64;
use rayon::prelude::*;

const SPAN: f64 = 1.316_129_032_258_1;

/// Relative motion of mass 1 on a spring of 0.75 and a damper, beside a law that slips.
fn oscillator(law: DofLaws, damping: f64) -> Lap<1> {
    let body = Body {
        inertia: [2.0],
        stiffness: [0.0],
        damping: [0.0],
    };
    let linear = Linear {
        stiffness: [[0.75]],
        damping: [[damping]],
    };
    Lap {
        joint: JointLaw { linear, on: [law] },
        a: body,
        b: body,
    }
}

fn iwan() -> DofLaws {
    DofLaws::from(Iwan {
        slip_force: 0.2,
        stiffness: 0.25,
        exponent: -0.3,
        ratio: 0.5,
    })
}

fn balance(lap: &Lap<1>) -> HarmonicBalance<1> {
    HarmonicBalance::new(lap, Harmonics::odd(1).unwrap()).unwrap()
}

#[test]
fn the_backbone_of_iwan_s_law_is_that_of_its_closed_forms() {
    let balance = balance(&oscillator(iwan(), 0.0));
    for (part, omega, ratio) in [
        (0.001, 0.999_605_279_803_4, 1.286_344_056_91e-4),
        (0.01, 0.998_020_143_284_9, 6.467_487_728_72e-4),
        (0.1, 0.990_037_407_121_6, 3.293_904_616_345e-3),
        (0.5, 0.968_934_281_279_1, 1.060_973_622_354e-2),
        (1.0, 0.949_017_890_960_5, 1.796_658_048_863e-2),
        (1.5, 0.922_218_680_490_5, 3.373_331_491_15e-2),
        (3.0, 0.889_038_730_481_5, 2.947_403_550_247e-2),
    ] {
        let found = balance
            .free(Target::relative(0, part * SPAN), None)
            .unwrap();
        let error = (found.omega_rad_s() / omega - 1.0).abs();
        assert!(error < 1e-10, "{part}: {} {omega}", found.omega_rad_s());
        let error = (found.damping_ratio() / ratio - 1.0).abs();
        assert!(error < 1e-8, "{part}: {} {ratio}", found.damping_ratio());
    }
}

#[test]
fn forced_responses_are_those_of_the_closed_forms() {
    let iwan = oscillator(iwan(), 0.002);
    let slider = DofLaws::from(Jenkins {
        stiffness: 0.25,
        slip_force: 0.06,
    });
    let jenkins = oscillator(slider, 0.01);
    for (lap, load, omega, amplitude) in [
        (&iwan, 0.02, 0.97, 0.771_529_062_046_8),
        (&iwan, 0.02, 0.93, 0.180_482_393_089_2),
        (&iwan, 0.2, 0.9, 3.814_635_338_624),
        (&jenkins, 0.1, 0.8, 0.307_069_589_340_1),
        (&jenkins, 0.1, 0.9, 1.627_318_291_414_8),
        (&jenkins, 0.1, 0.95, 0.837_231_193_699_5),
        (&jenkins, 0.1, 1.0, 0.573_524_611_062_6),
    ] {
        let balance = balance(lap);
        let loads = HarmonicLoads::opposed(load);
        let found = balance
            .forced(omega, &loads, None)
            .unwrap_or_else(|error| panic!("{load} {omega}: {error}"));
        let found = balance
            .amplitude_of(&found, Observed::Relative(0), 1)
            .norm();
        assert!(
            (found / amplitude - 1.0).abs() < 1e-9,
            "{omega}: {found} {amplitude}"
        );
    }
}

#[test]
fn curves_go_through_where_all_slips() {
    let balance = balance(&oscillator(iwan(), 0.002));
    let target = Target::relative(0, SPAN);
    let options = CurveOptions::default();
    let curve = balance
        .backbone([0.01 * SPAN, 3.0 * SPAN], target, &options)
        .unwrap();
    assert!(curve.len() > 10);
    let falls = |pair: &[_]| {
        let [before, after]: &[bolted_joint::harmonic::CurvePoint<1>; 2] = pair.try_into().unwrap();
        after.solution.omega_rad_s() < before.solution.omega_rad_s()
    };
    assert!(curve.windows(2).all(falls));
}

#[test]
fn friction_that_knows_time_is_refused() {
    let lugre = DofLaws::from(LuGre {
        stiffness: 1.0,
        bristle_damping: 0.0,
        damping: 0.0,
        slip_force: 1.0,
        static_force: 1.0,
        stribeck_velocity: 1.0,
    });
    let refused = HarmonicBalance::new(&oscillator(lugre, 0.0), Harmonics::odd(1).unwrap());
    assert_eq!(refused.unwrap_err(), HarmonicError::Rate);
}

/// Each law with a load and a frequency under which it slips.
fn laws() -> [(DofLaws, f64, f64); 5] {
    [
        (iwan(), 0.02, 0.97),
        (
            Jenkins {
                stiffness: 0.25,
                slip_force: 0.06,
            }
            .into(),
            0.1,
            0.85,
        ),
        (
            Valanis {
                stiffness: 0.3,
                slip_stiffness: 0.05,
                slip_force: 0.06,
                kappa: 0.7,
            }
            .into(),
            0.1,
            0.85,
        ),
        (
            Dahl {
                stiffness: 0.25,
                slip_force: 0.06,
            }
            .into(),
            0.1,
            0.85,
        ),
        (
            BoucWen {
                stiffness: 0.25,
                slip_force: 0.06,
                exponent: 1.5,
                beta: 0.6,
                gamma: -0.2,
            }
            .into(),
            0.1,
            0.85,
        ),
    ]
}

/// Fundamental and third harmonic of the relative motion to which RK4 settles, starting near it.
fn settled(lap: &Lap<1>, start: LapState<1>, load: f64, omega: f64) -> [Complex64; 2] {
    let steps = 1600;
    let mut moment = LapStepper::new(lap).begin(start);
    follow(lap, &mut moment, load, omega, [399, steps], |_, _| {});
    let mut sums = [Complex64::ZERO; 2];
    follow(lap, &mut moment, load, omega, [1, steps], |n, r| {
        for (sum, order) in sums.iter_mut().zip([1, 3]) {
            let turn = Complex64::cis(-TAU * (order * n) as f64 / steps as f64);
            *sum += 2.0 / steps as f64 * r * turn;
        }
    });
    sums
}

/// RK4 over so many periods of so many steps; tells the relative displacement before each.
fn follow(
    lap: &Lap<1>,
    moment: &mut LapMoment<1>,
    load: f64,
    omega: f64,
    [periods, steps]: [usize; 2],
    mut tell: impl FnMut(usize, f64),
) {
    let loads = HarmonicLoads::opposed(load);
    let at = |half: usize| loads.at_phase(TAU * half as f64 / (2 * steps) as f64);
    let all: Vec<_> = (0..=2 * steps).map(at).collect();
    let stepper = LapStepper::new(lap);
    for _ in 0..periods {
        for n in 0..steps {
            let state = &moment.state;
            tell(n, state.a.displacement[0] - state.b.displacement[0]);
            let loads = [all[2 * n], all[2 * n + 1], all[2 * n + 2]];
            stepper.step(moment, &loads, TAU / omega / steps as f64);
        }
    }
}

#[test]
fn several_harmonics_are_those_of_the_time_history() {
    laws().into_par_iter().for_each(|(law, load, omega)| {
        let lap = oscillator(law, 0.01);
        // the low frequency beside has a third harmonic near resonance
        for omega in [omega, 0.31] {
            let balance = HarmonicBalance::new(&lap, Harmonics::odd(15).unwrap()).unwrap();
            let loads = HarmonicLoads::opposed(load);
            let found = balance.forced(omega, &loads, None).unwrap();
            let start = balance.state_at(&found, 0.0);
            let expected = settled(&lap, start, load, omega);
            let size = expected[0].norm();
            for (expected, order) in expected.into_iter().zip([1, 3]) {
                let found = balance.amplitude_of(&found, Observed::Relative(0), order);
                let error = (found - expected).norm() / size;
                assert!(
                    error < 1e-4,
                    "{law:?} {omega} {order}: {found} {expected} {error:e}"
                );
            }
        }
    });
}

/// By 800 sliders in place of the law and 1024 samples of two periods, in Python. Fewer sliders are further away: 200 give
/// 0.771481.
#[test]
fn five_harmonics_are_those_of_many_sliders() {
    let lap = oscillator(iwan(), 0.002);
    let balance = HarmonicBalance::new(&lap, Harmonics::odd(9).unwrap()).unwrap();
    let found = balance
        .forced(0.97, &HarmonicLoads::opposed(0.02), None)
        .unwrap();
    let [first, third] = [1, 3].map(|order| {
        balance
            .amplitude_of(&found, Observed::Relative(0), order)
            .norm()
    });
    assert!((first / 0.771_500_16 - 1.0).abs() < 5e-6, "{first}");
    assert!((third / first / 5.662_87e-4 - 1.0).abs() < 2e-4, "{third}");
}

/// How the distance of two histories of the relative motion goes on from period to period.
fn distances(lap: &Lap<1>, start: LapState<1>, load: f64, omega: f64) -> Vec<[f64; 2]> {
    let steps = 2000;
    let mut own = LapStepper::new(lap).begin(start);
    follow(lap, &mut own, load, omega, [150, steps], |_, _| {});
    let mut other = own;
    other.state.a.displacement[0] += 1e-5;
    other.state.b.displacement[0] -= 1e-5;
    let mut distances = Vec::new();
    for _ in 0..6 {
        for moment in [&mut own, &mut other] {
            follow(lap, moment, load, omega, [1, steps], |_, _| {});
        }
        let of = |moment: &LapMoment<1>| moment.state.a.relative_to(&moment.state.b);
        let (own, other) = (of(&own), of(&other));
        distances.push([
            other.displacement[0] - own.displacement[0],
            other.velocity[0] - own.velocity[0],
        ]);
    }
    distances
}

#[test]
fn multipliers_are_those_of_two_histories() {
    let (stiffness, damping) = (0.2, 0.8);
    for (law, load, omega) in laws() {
        let mut lap = oscillator(law, 0.01);
        for body in [&mut lap.a, &mut lap.b] {
            body.stiffness = [stiffness];
            body.damping = [damping];
        }
        let balance = HarmonicBalance::new(&lap, Harmonics::odd(15).unwrap()).unwrap();
        let loads = HarmonicLoads::opposed(load);
        let solution = balance.forced(omega, &loads, None).unwrap();
        let stability = balance.stability(&solution).unwrap();
        assert!(stability.is_stable());
        let mut own = stability.multipliers;
        // the common motion of both bodies of 2 kg: e^((−δ ± jω_d) T)
        let decay = 0.5 * damping / 2.0;
        let turns = (stiffness / 2.0 - decay * decay).sqrt();
        for sign in [-1.0, 1.0] {
            let common = (Complex64::new(-decay, sign * turns) * TAU / omega).exp();
            let before = own.len();
            own.retain(|one| (one - common).norm() > 1e-6);
            assert_eq!(own.len() + 1, before, "{common} is not there");
        }
        // Π (E − λ) of the distances vanishes, E being a period's step
        own.retain(|one| one.norm() > 1e-6);
        let start = balance.state_at(&solution, 0.0);
        let mut left: Vec<[Complex64; 2]> = distances(&lap, start, load, omega)
            .into_iter()
            .map(|distance| distance.map(Complex64::from))
            .collect();
        let size = |distances: &[[Complex64; 2]]| distances[0][0].norm() + distances[0][1].norm();
        let mut scale = size(&left);
        for multiplier in &own {
            scale *= multiplier.norm();
            left = left
                .windows(2)
                .map(|pair| [0, 1].map(|k| pair[1][k] - multiplier * pair[0][k]))
                .collect();
        }
        let error = size(&left) / scale;
        assert!(error < 3e-3, "{law:?}: {own:?} {error:e}");
    }
}

/// Dry friction without a spring before it is what a slider tends to as its spring gets stiff: Den Hartog's amplitude of motion
/// without stops, X = (F/k) √(V² − (F_f/F)² U²) with V = 1/(1−r²), U = sin(π/r)/(r (1 + cos(π/r)))
/// (Trans. ASME 53 (1931) 107).
#[test]
fn a_stiff_slider_tends_to_den_hartog_s_dry_friction() {
    let friction = 0.3;
    for (ratio, expected) in [
        (0.8, 2.626_104_875_723),
        (1.5, 0.721_110_255_093),
        (2.0, 0.297_676_184_992),
    ] {
        let error = |stiffness: f64| {
            let law = Jenkins {
                stiffness,
                slip_force: friction,
            };
            let mut lap = oscillator(law.into(), 0.0);
            lap.joint.linear.stiffness = [[1.0]];
            let mut moment = LapStepper::new(&lap).begin(LapState::REST);
            let steps = 3000;
            follow(&lap, &mut moment, 1.0, ratio, [100, steps], |_, _| {});
            let mut largest: f64 = 0.0;
            follow(&lap, &mut moment, 1.0, ratio, [1, steps], |_, r| {
                largest = largest.max(r.abs());
            });
            largest / expected - 1.0
        };
        // the spring's stiffness at the turns goes with √(h/k)
        let [soft, stiff] = [error(300.0), error(3000.0)];
        let root = 10.0_f64.sqrt();
        assert!(stiff.abs() < 2e-2, "{ratio}: {stiff:e}");
        assert!(
            (soft / stiff / root - 1.0).abs() < 0.1,
            "{ratio}: {soft:e} {stiff:e}"
        );
        let limit = (root * stiff - soft) / (root - 1.0);
        assert!(limit.abs() < 5e-4, "{ratio}: {limit:e}");
    }
}
