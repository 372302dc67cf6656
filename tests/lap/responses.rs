//! kN, c and c12 from responses at several levels: scatter over draws of the noise beside the Cramér–Rao bound.

use bolted_joint_testing::close;
use std::f64::consts::FRAC_1_SQRT_2;
use std::path::PathBuf;

use bolted_joint::identify::lap::{
    Fit, Model, Noise, Place, ResponseUnknown, SineLine, SineRun, Term, TermSet, Use, Values,
    fit_responses,
};
use bolted_joint_dynamics::Polynomial;
use nalgebra::SMatrix;
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::oscillator::{Truth, response};

const NOISE: f64 = 0.02;
const DRAWS: usize = 120;
const FORCES: [f64; 3] = [2.0, 5.0, 10.0];
const UNKNOWNS: [ResponseUnknown; 6] = [
    ResponseUnknown::Mass,
    ResponseUnknown::SupportStiffness,
    ResponseUnknown::SupportDamping,
    ResponseUnknown::JointStiffness,
    ResponseUnknown::JointDamping,
    ResponseUnknown::Term(Term::CUBIC),
];

fn truth(cubic: f64) -> Truth {
    [2.35, 10.56e5, 14.0, 4.56e6, 17.0, cubic]
}

/// Lines around both resonances, 670 and 2081 rad/s.
fn omegas() -> Vec<f64> {
    let around = |middle: f64, lines: i32| {
        (-lines..=lines).map(move |n| middle * (1.0 + 0.03 * f64::from(n) / f64::from(lines)))
    };
    around(670.3, 15).chain(around(2080.6, 25)).collect()
}

fn model() -> Model {
    Model {
        drive: Place::B,
        response: Place::B,
        terms: TermSet::of(&[Term::CUBIC]),
        unknowns: UNKNOWNS.to_vec(),
        harmonics: 1,
    }
}

fn exact(truth: &Truth) -> Vec<Vec<Complex64>> {
    let at = |omega, force| response(truth, omega, force)[1];
    let run = |force: f64| omegas().iter().map(|&omega| at(omega, force)).collect();
    FORCES.map(run).to_vec()
}

fn runs(exact: &[Vec<Complex64>], generator: &mut ChaCha8Rng) -> Vec<SineRun> {
    let runs = FORCES.into_iter().zip(exact).map(|(force_n, exact)| {
        let lines = omegas().into_iter().zip(exact).map(|(omega, exact)| {
            let mut normal = || {
                let sample: f64 = StandardNormal.sample(generator);
                NOISE * FRAC_1_SQRT_2 * sample
            };
            line(
                omega,
                force_n,
                exact * Complex64::new(1.0 + normal(), normal()),
            )
        });
        run(force_n, lines.collect())
    });
    runs.collect()
}

fn line(omega: f64, force_n: f64, displacement: Complex64) -> SineLine {
    let (displacement_m, phase_rad) = displacement.to_polar();
    SineLine {
        omega,
        force_n,
        displacement_m,
        phase_rad,
    }
}

fn run(force_n: f64, lines: Vec<SineLine>) -> SineRun {
    SineRun {
        name: format!("{force_n} N"),
        path: PathBuf::new(),
        used_for: Use::Fit,
        lines,
    }
}

/// Where the noise is stated as it is.
fn fitted(runs: &[SineRun], noise: &Noise) -> Fit {
    fit_responses(&model(), runs, noise, &Values::default()).unwrap()
}

/// The bound on the standard deviations, by central differences of the independent model.
fn bound(truth: &Truth) -> [f64; 6] {
    let central = exact(truth);
    let derivatives: Vec<Vec<Complex64>> = (0..6)
        .map(|place| {
            let step = 1e-4 * truth[place].abs();
            let side = |sign: f64| {
                let mut moved = *truth;
                moved[place] += sign * step;
                exact(&moved).concat()
            };
            let (plus, minus) = (side(1.0), side(-1.0));
            let pairs = plus.into_iter().zip(minus);
            pairs
                .map(|(plus, minus)| (plus - minus) / (2.0 * step))
                .collect()
        })
        .collect();
    let central = central.concat();
    // Each part of the complex error has the variance ½ σ² |x|². Scaled, since the unknowns differ by twelve decades.
    let information = SMatrix::<f64, 6, 6>::from_fn(|i, j| {
        let lines = central.iter().enumerate();
        let sum: f64 = lines
            .map(|(n, x)| {
                (derivatives[i][n].conj() * derivatives[j][n]).re
                    / (0.5 * NOISE * NOISE * x.norm_sqr())
            })
            .sum();
        sum * truth[i].abs() * truth[j].abs()
    });
    let covariance = information.try_inverse().unwrap();
    std::array::from_fn(|i| covariance[(i, i)].sqrt() * truth[i].abs())
}

fn scatter_is_near_the_bound(cubic: f64) {
    let truth = truth(cubic);
    let (exact, bound) = (exact(&truth), bound(&truth));
    let mut generator = ChaCha8Rng::seed_from_u64(7);
    let noise = Noise::stated(NOISE, 0.0);
    let mut squares = [0.0; 6];
    let mut sums = [0.0; 6];
    for _ in 0..DRAWS {
        let fit = fitted(&runs(&exact, &mut generator), &noise);
        let reduced = fit.chi_squared / fit.degrees_of_freedom as f64;
        assert!((0.7..1.3).contains(&reduced), "χ²/ν {reduced}");
        for (place, unknown) in UNKNOWNS.into_iter().enumerate() {
            let error = fit.values.of(unknown) - truth[place];
            squares[place] += error * error;
            sums[place] += error;
        }
    }
    for (place, unknown) in UNKNOWNS.into_iter().enumerate() {
        let root = (squares[place] / DRAWS as f64).sqrt();
        let bias = sums[place] / DRAWS as f64;
        let ratio = root / bound[place];
        println!(
            "{}: true {:.4e}, bound {:.2e}, r.m.s. error {root:.2e} ({ratio:.2} of the bound), bias {bias:.1e}",
            unknown.symbol(),
            truth[place],
            bound[place]
        );
        let symbol = unknown.symbol();
        assert!((0.75..1.3).contains(&ratio), "{symbol}: {ratio}");
    }
    // The cubic spring is not only bounded but seen, with its sign.
    assert!(bound[5] < 0.2 * cubic.abs(), "{}", bound[5]);
}

#[test]
fn a_hardening_spring_is_found_as_well_as_can_be() {
    scatter_is_near_the_bound(2e12);
}

#[test]
fn a_softening_spring_is_found_as_well_as_can_be() {
    scatter_is_near_the_bound(-2e12);
}

#[test]
fn exact_responses_give_the_exact_model() {
    for cubic in [2e12, -2e12] {
        let truth = truth(cubic);
        let mut runs = runs(&exact(&truth), &mut ChaCha8Rng::seed_from_u64(1));
        for (run, exact) in runs.iter_mut().zip(exact(&truth)) {
            for (line, exact) in run.lines.iter_mut().zip(exact) {
                (line.displacement_m, line.phase_rad) = exact.to_polar();
            }
        }
        for noise in [Noise::stated(NOISE, 0.0), Noise::stated(NOISE, NOISE)] {
            let fit = fitted(&runs, &noise);
            for (place, unknown) in UNKNOWNS.into_iter().enumerate() {
                let error = fit.values.of(unknown) / truth[place] - 1.0;
                assert!(error.abs() < 1e-6, "{}: {error}", unknown.symbol());
            }
        }
    }
}

/// A strong cubic spring integrated in time by Runge and Kutta until it is periodic: many harmonics are needed to find it again.
#[test]
fn many_harmonics_find_what_time_integration_gives() {
    let truth = Values {
        mass: 2.0,
        joint_stiffness: 1e4,
        joint_damping: 4.0,
        terms: Polynomial::with(&[4e9], &[3e5]),
        ..Values::default()
    };
    let runs = [4.0, 12.0].map(|force_n| {
        let omegas = [40.0, 60.0, 80.0, 130.0, 150.0, 180.0, 220.0];
        let lines = omegas.map(|omega| line(omega, force_n, steady_state(&truth, omega, force_n)));
        run(force_n, lines.to_vec())
    });
    let terms = [Term::CUBIC, Term::named("c2").unwrap()];
    let unknowns = [
        ResponseUnknown::Mass,
        ResponseUnknown::JointStiffness,
        ResponseUnknown::JointDamping,
    ];
    let error_of = |harmonics: usize| {
        let model = Model {
            drive: Place::Relative,
            response: Place::Relative,
            terms: TermSet::of(&terms),
            unknowns: unknowns
                .into_iter()
                .chain(terms.map(ResponseUnknown::Term))
                .collect(),
            harmonics,
        };
        let noise = Noise::stated(1e-3, 1e-3);
        let fit = fit_responses(&model, &runs, &noise, &Values::default()).unwrap();
        let errors = model
            .unknowns
            .iter()
            .map(|&unknown| (fit.values.of(unknown) / truth.of(unknown) - 1.0).abs());
        errors.fold(0.0, f64::max)
    };
    let (one, many) = (error_of(1), error_of(21));
    println!("largest relative error with one harmonic {one:.1e}, with 21 {many:.1e}");
    assert!(many < 1e-5 && one > 1e3 * many, "{one} {many}");
}

/// Fundamental of r of (m/2) r̈ + c12 ṙ + k12 r + k3 r³ + c2 r² ṙ = F cos ωt.
fn steady_state(values: &Values, omega: f64, force: f64) -> Complex64 {
    const STEPS: usize = 1000;
    let rate = |t: f64, [r, v]: [f64; 2]| {
        let load = force * (omega * t).cos();
        let spring = values.joint_stiffness * r + values.terms.springs[0] * r.powi(3);
        let damper = (values.joint_damping + values.terms.dampers[0] * r * r) * v;
        [v, (load - spring - damper) / (0.5 * values.mass)]
    };
    let h = std::f64::consts::TAU / omega / STEPS as f64;
    let mut state = [0.0; 2];
    let mut sum = Complex64::ZERO;
    // Damping forgets the start: e^(−c t/m) with c/m above 2 1/s after 25 s.
    let periods = (25.0 * omega / std::f64::consts::TAU).ceil() as usize;
    for n in 0..periods * STEPS {
        let t = n as f64 * h;
        if n >= (periods - 1) * STEPS {
            sum += 2.0 * state[0] * Complex64::from_polar(1.0, -omega * t) / STEPS as f64;
        }
        let moved = |by: f64, k: [f64; 2]| [state[0] + by * k[0], state[1] + by * k[1]];
        let k1 = rate(t, state);
        let k2 = rate(t + 0.5 * h, moved(0.5 * h, k1));
        let k3 = rate(t + 0.5 * h, moved(0.5 * h, k2));
        let k4 = rate(t + h, moved(h, k3));
        for i in 0..2 {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    sum
}

/// The covariance is the bound where the noise is stated: the information matrix against the independent one.
#[test]
fn the_information_is_that_of_the_bound() {
    let truth = truth(2e12);
    let bound = bound(&truth);
    let mut generator = ChaCha8Rng::seed_from_u64(3);
    let runs = runs(&exact(&truth), &mut generator);
    let fit = fitted(&runs, &Noise::stated(NOISE, 0.0));
    let scaled = SMatrix::<f64, 6, 6>::from_fn(|i, j| {
        fit.information[(i, j)] * truth[i].abs() * truth[j].abs()
    });
    let covariance = scaled.try_inverse().unwrap();
    for place in 0..6 {
        let deviation = covariance[(place, place)].sqrt() * truth[place].abs();
        close(deviation, bound[place], 0.1);
    }
}
