//! Laws that slip from free decays of an oscillator with sliders, which velocity Verlet supplies step by step, with noise.

use std::fmt::Write as _;

use bolted_joint_testing::{close, has};

use bolted_joint::identify::lap::{
    Estimate, InTime, LapResponse, LapResponseStudy, ResponseUnknown, SliderParameter,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tempfile::TempDir;

/// M = m/2 of the relative motion, kg.
const MASS: f64 = 1.0;
const K0: f64 = 5.0e5;
const C12: f64 = 2.0;
const LARGEST_M: f64 = 3.0e-4;
const INTERVAL_S: f64 = 1e-4;
const SAMPLES: usize = 12_000;
/// Of the first amplitude.
const NOISE: f64 = 0.01;
/// Relative error without noise.
const EXACT: f64 = 2e-3;
/// Root of the mean square error in standard deviations. Of four numbers two go together: 60 draws are 180 that do not, which
/// leave 5 % of it open and 1.6 % of the intervals that hold.
const DEVIATIONS: std::ops::Range<f64> = 0.8..1.2;
const HELD: std::ops::RangeInclusive<f64> = 0.92..=0.98;

/// Part of the first record's amplitude that the second, which is left out, is released at.
const LEFT_OUT: f64 = 0.7;
/// Part of the frequencies and damping ratios of a record left out that lie in their intervals. Those of one record share the
/// errors of the unknowns.
const PREDICTED: std::ops::RangeInclusive<f64> = 0.92..=0.98;
/// Part of the durations that do: one for each draw, so that 60 leave 2.8 % of it open.
const LASTING: std::ops::RangeInclusive<f64> = 0.88..=1.0;
/// Part of the draws in which the law's own curve lies where the model's is said to be. Both places of one draw go together, so that
/// 60 leave 2.8 % of it open.
const CURVE: std::ops::RangeInclusive<f64> = 0.87..=1.0;
/// Part of the draws in which a run left out may be said not to be of the law, though it is.
const WARNED: f64 = 0.05;

/// Sliders: stiffness (N/m) and the displacement at which each slips (m).
type Sliders = Vec<[f64; 2]>;

/// Segalman's density R φ^χ up to φ_max in cells that grow: each has the stiffness of its cell, and its slip force.
fn iwan(density: f64, exponent: f64, span: f64) -> Sliders {
    let count = 150;
    let edge = |n: i32| match n {
        0 => 0.0,
        _ => span * 1e-5_f64.powf(1.0 - f64::from(n - 1) / f64::from(count - 1)),
    };
    let moment =
        |from: f64, to: f64, power: f64| density * (to.powf(power) - from.powf(power)) / power;
    let cell = |n: i32| {
        let (from, to) = (edge(n), edge(n + 1));
        let stiffness = moment(from, to, exponent + 1.0);
        [stiffness, moment(from, to, exponent + 2.0) / stiffness]
    };
    (0..count).map(cell).collect()
}

/// Displacements after a release, to which the sliders have come straight from rest.
fn decay(sliders: &Sliders, released_m: f64) -> Vec<f64> {
    let steps = 20;
    let h = INTERVAL_S / f64::from(steps);
    let spring = K0 - sliders.iter().map(|[stiffness, _]| stiffness).sum::<f64>();
    let (mut u, mut v) = (released_m, 0.0);
    let mut stuck: Vec<f64> = sliders.iter().map(|[_, slips]| u.min(*slips)).collect();
    let load = |u: f64, stuck: &[f64]| {
        let of_sliders = sliders.iter().zip(stuck);
        spring * u
            + of_sliders
                .map(|([stiffness, _], z)| stiffness * z)
                .sum::<f64>()
    };
    let mut a = -load(u, &stuck) / MASS;
    let mut found = Vec::with_capacity(SAMPLES);
    for _ in 0..SAMPLES {
        found.push(u);
        for _ in 0..steps {
            let change = h * v + 0.5 * h * h * a;
            u += change;
            for (z, [_, slips]) in stuck.iter_mut().zip(sliders) {
                *z = (*z + change).clamp(-slips, *slips);
            }
            let load = load(u, &stuck);
            // v′ = v + ½h (a + a′), a′ = −(f + c v′)/M
            v = (v + 0.5 * h * (a - load / MASS)) / (1.0 + 0.5 * h * C12 / MASS);
            a = -(load + C12 * v) / MASS;
        }
    }
    found
}

/// Of the first record of each draw, and of the second, which is left out.
struct Records {
    fitted: Vec<f64>,
    left_out: Vec<f64>,
}

impl Records {
    /// Released at these parts of the largest amplitude.
    fn of(sliders: &Sliders, released: [f64; 2]) -> Self {
        let [fitted, left_out] = released.map(|part| decay(sliders, part * LARGEST_M));
        Self { fitted, left_out }
    }

    /// A study of these, in its folder, with noise of its own; `terms` are as a study has them.
    fn study(&self, terms: &str, noise: (u64, f64)) -> (TempDir, LapResponseStudy) {
        let folder = self.written(terms, noise);
        let study = LapResponseStudy::read(&folder.path().join("study.toml"));
        (folder, study.unwrap_or_else(|error| panic!("{error}")))
    }

    /// The same before it is read.
    fn written(&self, terms: &str, (seed, noise): (u64, f64)) -> TempDir {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let folder = tempfile::tempdir().unwrap();
        for (name, samples) in [("fitted", &self.fitted), ("left-out", &self.left_out)] {
            let mut csv = "time_s,displacement_m\n".to_owned();
            for (n, u) in samples.iter().enumerate() {
                let normal: f64 = StandardNormal.sample(&mut generator);
                let measured = u + noise * LARGEST_M * normal;
                writeln!(csv, "{:e},{measured:e}", INTERVAL_S * n as f64).unwrap();
            }
            std::fs::write(folder.path().join(format!("{name}.csv")), csv).unwrap();
        }
        let study = format!(
            "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
             terms = [{terms}]\ncompare = false\n[known]\nm = {}\n[[decay]]\nfile = \"fitted.csv\"\n\
             [[decay]]\nfile = \"left-out.csv\"\nuse = \"predict\"\n",
            2.0 * MASS
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        folder
    }
}

fn of(found: &LapResponse, parameter: SliderParameter) -> &Estimate {
    let unknown = ResponseUnknown::Slider(parameter);
    let mut all = found.estimates.iter();
    all.find(|own| own.unknown == unknown).unwrap()
}

fn identified(study: &LapResponseStudy) -> LapResponse {
    LapResponse::of(study, &|| {}).unwrap()
}

/// How many numbers of runs left out were expected, and how many of them lie where.
#[derive(Default)]
struct Told {
    numbers: [usize; 2],
    durations: [usize; 2],
    warned: usize,
}

impl Told {
    fn count(&mut self, study: &LapResponseStudy, found: &LapResponse) {
        let run = found.backbones.iter().find(|run| run.left_out).unwrap();
        let (all, outside) = run.outside();
        assert_eq!(all, 2 * run.points.len());
        self.numbers[0] += all;
        self.numbers[1] += all - outside;
        let fall = run.fall.as_ref().unwrap();
        self.durations[0] += 1;
        self.durations[1] += usize::from(fall.duration_s.holds().unwrap());
        let is_of_run = |text: &String| text.starts_with(&run.run) && text.contains("outside of");
        self.warned += usize::from(found.warnings(study).iter().any(is_of_run));
    }
}

/// How often what is read of the law's record without noise lies where the model's own curve is said to be, in the middle and at its
/// end: frequencies, and damping ratios. At its beginning one slider begins to slip, and the law's curve is too steep to be taken
/// between the amplitudes that it was read at.
fn held_by_curve(found: &LapResponse, law: &LapResponse) -> [f64; 2] {
    let of = |response: &'_ LapResponse| {
        let run = response.backbones.iter().find(|run| !run.left_out);
        run.unwrap().points.clone()
    };
    let (own, law) = (of(found), of(law));
    // both fall; amplitudes differ by the noise
    let at = |amplitude_m: f64, value: &dyn Fn(usize) -> f64| {
        let below = law.partition_point(|point| point.amplitude_m > amplitude_m);
        let after = below.clamp(1, law.len() - 1);
        let [from, to] = [after - 1, after].map(|place| law[place].amplitude_m);
        let part = (amplitude_m - from) / (to - from);
        value(after - 1) + part * (value(after) - value(after - 1))
    };
    let places = [own.len() / 2, own.len() - 1];
    let mut held = [0.0; 2];
    for place in places {
        let point = &own[place];
        let frequency = at(point.amplitude_m, &|at| law[at].frequency_hz.measured);
        let ratio = at(point.amplitude_m, &|at| {
            law[at].damping_ratio.unwrap().measured
        });
        let told = [
            (point.frequency_hz.curve_95.unwrap(), frequency),
            (point.damping_ratio.unwrap().curve_95.unwrap(), ratio),
        ];
        for (held, ([low, high], exact)) in held.iter_mut().zip(told) {
            *held += f64::from(u8::from((low..=high).contains(&exact))) / places.len() as f64;
        }
    }
    held
}

/// Without noise the numbers are there; with it their errors are what is said of them.
#[track_caller]
fn assert_known(sliders: &Sliders, name: &str, truth: &[(ResponseUnknown, f64)], draws: u64) {
    let records = Records::of(sliders, [1.0, LEFT_OUT]);
    let terms = format!("\"{name}\"");
    let (_folder, study) = records.study(&terms, (0, 0.0));
    let exact = identified(&study);
    // the model's own decay takes as long as that of the sliders
    for run in &exact.backbones {
        let lasts = run.fall.as_ref().unwrap().duration_s;
        assert!(
            (lasts.predicted / lasts.measured - 1.0).abs() < 1e-4,
            "{lasts:?}"
        );
    }
    for (unknown, expected) in truth {
        let found = exact.fit.values.of(*unknown);
        let symbol = unknown.symbol();
        assert!(
            (found / expected - 1.0).abs() < EXACT,
            "{symbol}: {found} {expected}"
        );
    }
    let (mut squares, mut held) = (0.0, 0.0);
    let mut told = Told::default();
    let mut of_curve = [0.0; 2];
    let share = ((draws as usize * truth.len()) as f64).recip();
    for seed in 0..draws {
        let (_folder, study) = records.study(&terms, (seed, NOISE));
        let found = identified(&study);
        told.count(&study, &found);
        let own = held_by_curve(&found, &exact);
        of_curve = std::array::from_fn(|kind| of_curve[kind] + own[kind] / draws as f64);
        let reduced = found.fit.reduced_chi_squared();
        assert!((0.2..3.0).contains(&reduced), "{name}: {reduced}");
        for (unknown, expected) in truth {
            let mut estimates = found.estimates.iter();
            let own = estimates.find(|own| own.unknown == *unknown).unwrap();
            let error = (own.free_value - expected) / own.standard_deviation;
            squares += share * error.powi(2);
            let [low, high] = own.interval_95;
            held += share * f64::from(u8::from((low..=high).contains(expected)));
        }
    }
    let deviations = f64::sqrt(squares);
    println!("{name}: {deviations:.3} deviations, intervals hold {held:.3}");
    assert!(DEVIATIONS.contains(&deviations), "{name}: {deviations}");
    assert!(HELD.contains(&held), "{name}: {held}");
    println!("{name}, curve: intervals hold {of_curve:.3?}");
    for held in of_curve {
        assert!(CURVE.contains(&held), "{name}: {held}");
    }
    let [numbers, durations] =
        [told.numbers, told.durations].map(|[all, held]| held as f64 / all as f64);
    println!(
        "{name}, left out: intervals hold {numbers:.3} of {} numbers, {durations:.3} of {draws} durations; {} warnings",
        told.numbers[0], told.warned
    );
    assert!(PREDICTED.contains(&numbers), "{name}: {numbers}");
    assert!(LASTING.contains(&durations), "{name}: {durations}");
    assert!(
        told.warned as f64 <= WARNED * draws as f64,
        "{}",
        told.warned
    );
}

fn slider(parameter: SliderParameter) -> ResponseUnknown {
    ResponseUnknown::Slider(parameter)
}

#[test]
fn one_slider_is_known_from_a_decay_as_well_as_it_is_said() {
    let (k, h) = (6e4, 6.0);
    let truth = [
        (ResponseUnknown::JointStiffness, K0),
        (ResponseUnknown::JointDamping, C12),
        (slider(SliderParameter::Stiffness), k),
        (slider(SliderParameter::SlipForce), h),
    ];
    assert_known(&vec![[k, h / k]], "jenkins", &truth, 60);
}

#[test]
fn many_sliders_are_known_from_a_decay_as_well_as_it_is_said() {
    let (density, exponent) = (1e7, -0.4);
    let truth = [
        (ResponseUnknown::JointStiffness, K0),
        (ResponseUnknown::JointDamping, C12),
        (slider(SliderParameter::Density), density),
        (slider(SliderParameter::Exponent), exponent),
    ];
    assert_known(&iwan(density, exponent, 2e-3), "micro-slip", &truth, 120);
}

/// A slider that sticks while it is fitted is a spring. A record in which it slips is not where that expects it, though nothing
/// was wrong with the fit.
#[test]
fn a_decay_beyond_what_was_fitted_is_not_where_it_is_expected() {
    let records = Records::of(&vec![[8e3, 1e-4]], [0.33, 1.0]);
    let (_folder, study) = records.study("", (1, 0.2 * NOISE));
    let found = identified(&study);
    assert!((0.3..1.5).contains(&found.fit.reduced_chi_squared()));
    let run = found.backbones.iter().find(|run| run.left_out).unwrap();
    let (all, outside) = run.outside();
    assert!(4 * outside > all, "{outside} of {all}");
    let lasts = &run.fall.as_ref().unwrap().duration_s;
    assert_eq!(lasts.holds(), Some(false), "{lasts:?}");
    has(
        &found.warnings(&study).join("\n"),
        &["left-out", "outside of what is expected", "were fitted"],
    );
}

/// The residual of a wrong law is said, and is in the file, with the noise of the record for which it is too large.
#[test]
fn a_law_that_is_wrong_for_a_decay_is_said() {
    let records = Records::of(&iwan(1e7, -0.4, 2e-3), [1.0, LEFT_OUT]);
    let (_folder, study) = records.study("\"k3\", \"c2\"", (1, NOISE));
    let found = identified(&study);
    has(
        &found.warnings(&study).join("\n"),
        &[
            "what the noise of the decays' records explains",
            "no cure for a wrong law",
        ],
    );
    let file = found.joint_file(&study);
    let (uncertainty, residual) = (file.uncertainty.unwrap(), file.residual.unwrap());
    has(&uncertainty.basis, &["no cure for a wrong law"]);
    let reduced = residual.reduced_chi_squared.unwrap();
    close(uncertainty.inflation.unwrap().powi(2), reduced, 1e-12);
    let functions = residual.functions.iter();
    let names: Vec<&str> = functions.map(|own| own.response.as_str()).collect();
    assert_eq!(names, ["fitted, frequency", "fitted, damping ratio"]);
    assert!(residual.lines == all_lines(&found) && residual.relative_rms > 0.0);
}

/// A narrow band asks for a long window, which a quick beginning does not outlast. Fitted sample by sample nothing of it is lost,
/// as little as without a band.
#[test]
fn a_beginning_that_is_not_read_is_said() {
    let records = Records::of(&vec![[0.3 * K0, 0.2 * LARGEST_M]], [1.0, LEFT_OUT]);
    let (folder, study) = records.study("\"jenkins\"", (1, 0.002));
    let says = "of what the record begins with: nothing is known of larger ones";
    let path = folder.path().join("study.toml");
    let plain = std::fs::read_to_string(&path).unwrap();
    let banded = plain.replacen(
        "file = \"fitted.csv\"",
        "file = \"fitted.csv\"\nband = [80, 150]",
        1,
    );
    let told = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let study = LapResponseStudy::read(&path).unwrap();
        let found = identified(&study);
        let stiffness = of(&found, SliderParameter::Stiffness).value;
        (found.warnings(&study).join("\n"), stiffness)
    };
    assert!(
        !identified(&study)
            .warnings(&study)
            .join("\n")
            .contains(says)
    );
    let (warnings, stiffness) = told(&banded);
    assert!(!warnings.contains(says), "{warnings}");
    close(stiffness, 0.3 * K0, 0.02);
    // errors that are stated are of what is read, and so is the fit
    let stated =
        "[noise]\nfrequency = 1e-3\ndamping = 0.02\n[[decay]]\nfile = \"fitted.csv\"\nband";
    let (warnings, _) = told(&banded.replacen("[[decay]]\nfile = \"fitted.csv\"\nband", stated, 1));
    has(&warnings, &[says, "make `band` as wide as"]);
}

/// Two other modes beside it, which the record has from its beginning: within a band the law is found as without them.
#[test]
fn other_modes_are_taken_out_of_a_record() {
    let mut records = Records::of(&vec![[0.2 * K0, 0.3 * LARGEST_M]], [1.0, LEFT_OUT]);
    let (folder, study) = records.study("\"jenkins\"", (3, 0.002));
    let alone = identified(&study);
    drop(folder);
    for (n, value) in records.fitted.iter_mut().enumerate() {
        let time_s = INTERVAL_S * n as f64;
        for (part, hz, ratio, phase) in [(0.5, 61.0, 0.004, 0.4), (0.3, 233.0, 0.006, -1.1)] {
            let omega = std::f64::consts::TAU * hz;
            *value +=
                part * LARGEST_M * (-ratio * omega * time_s).exp() * (omega * time_s + phase).cos();
        }
    }
    let folder = records.written("\"jenkins\"", (3, 0.002));
    let path = folder.path().join("study.toml");
    let plain = std::fs::read_to_string(&path).unwrap();
    let banded = plain.replacen("\"fitted.csv\"", "\"fitted.csv\"\nband = [85, 150]", 1);
    std::fs::write(&path, banded).unwrap();
    let study = LapResponseStudy::read(&path).unwrap();
    let found = identified(&study);
    assert_eq!(found.in_time, InTime::Fitted, "{:?}", found.in_time);
    for (parameter, truth) in [
        (SliderParameter::Stiffness, 0.2 * K0),
        (SliderParameter::SlipForce, 0.2 * K0 * 0.3 * LARGEST_M),
    ] {
        let Estimate {
            value,
            standard_deviation,
            ..
        } = of(&found, parameter);
        let error = (value - truth) / standard_deviation;
        assert!(error.abs() < 3.5, "{parameter:?}: {error}");
        // what the other modes take is little
        let without = of(&alone, parameter).standard_deviation;
        assert!(
            *standard_deviation < 2.0 * without,
            "{parameter:?}: {without}"
        );
    }
}

fn all_lines(found: &LapResponse) -> usize {
    let fitted = found.backbones.iter().filter(|run| !run.left_out);
    fitted.map(|run| 2 * run.points.len()).sum()
}
