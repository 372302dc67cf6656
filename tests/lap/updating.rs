//! Updating from natural frequencies: closed forms, SciPy's bounded least squares, and what is not identifiable.

use bolted_joint_testing::close;
use std::f64::consts::TAU;
use std::path::Path;

use bolted_joint::identify::lap::{Knowledge, LapParameter, LapUpdate, LapUpdateStudy};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn silent() {}

fn updated(text: &str) -> LapUpdate {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    let study = LapUpdateStudy::read(&path).unwrap();
    LapUpdate::of(&study, &silent).unwrap()
}

fn example(name: &str) -> LapUpdate {
    let study = LapUpdateStudy::read(&root().join("examples/pirdayr-update").join(name)).unwrap();
    LapUpdate::of(&study, &silent).unwrap()
}

/// `scipy.optimize.least_squares` (SciPy 1.17) in the same logarithms and bounds, best of ten starts: the objective (4), and m.
const SCIPY: [(f64, f64); 4] = [
    (0.003_985_833_810_766_084, 2.694_259),
    (0.000_401_680_113_858_995_2, 2.481_998_5),
    (0.001_440_880_299_960_921_4, 2.273_517_41),
    (0.000_262_913_435_543_093_3, 2.143_754_54),
];

#[test]
fn within_table_2_the_objective_is_that_of_scipy() {
    let found = example("study.toml");
    for (torque, (objective, mass)) in found.torques.iter().zip(SCIPY) {
        close(torque.objective, objective, 1e-9);
        assert!((torque.solution.of(LapParameter::Mass) / mass - 1.0).abs() < 1e-7);
        // The fireflies come close from above.
        let excess = torque.firefly.objective / objective - 1.0;
        assert!((0.0..0.02).contains(&excess), "{excess}");
    }
}

/// With k at its upper and k12 at its lower bound ω₂ = 3 ω₁, so that (4) is a parabola in ω₁.
#[test]
fn within_table_2_the_frequencies_are_those_of_the_parabola() {
    let found = example("study.toml");
    for torque in &found.torques {
        let omegas = &torque.data.omega_rad_per_s;
        let [a, b] = [omegas[0], omegas[1] / 3.0];
        // d/dω [(ω/a − 1)² + (ω/b − 1)²] = 0
        let omega = (a.recip() + b.recip()) / (a.powi(-2) + b.powi(-2));
        let [first, second] = torque.solution.natural_frequencies();
        assert!((first / omega - 1.0).abs() < 1e-9 && (second / first - 3.0).abs() < 1e-9);
        for stiffness in [LapParameter::SupportStiffness, LapParameter::JointStiffness] {
            assert_eq!(torque.knowledge(stiffness), Knowledge::AtBound);
        }
        assert_eq!(torque.knowledge(LapParameter::Mass), Knowledge::FromBounds);
        assert_eq!(torque.not_identified(), ["k", "m", "k12", "c", "c12", "kN"]);
        assert!(torque.missed().unwrap().contains("k, k12 at a bound"));
    }
}

#[test]
fn a_known_mass_makes_the_stiffnesses_known() {
    let found = example("with-a-mass.toml");
    for torque in &found.torques {
        let [first, second] = [0, 1].map(|mode| torque.data.omega_rad_per_s[mode]);
        let (m, sigma) = (1.41, 0.005);
        // k = m ω₁², k₁₂ = ½ m (ω₂² − ω₁²)
        let k = m * first * first;
        let k12 = 0.5 * m * (second * second - first * first);
        close(torque.solution.of(LapParameter::SupportStiffness), k, 1e-9);
        close(torque.solution.of(LapParameter::JointStiffness), k12, 1e-9);
        // σ(k₁₂) = m √(ω₁⁴ + ω₂⁴) σ by propagation
        let deviation = m * sigma * first.powi(2).hypot(second.powi(2));
        let found = torque.identifiability.standard_deviation[2].unwrap();
        close(found, deviation, 1e-6);
        assert_eq!(torque.not_identified(), ["kN"]);
    }
}

#[test]
fn without_a_mass_only_ratios_are_known_and_the_rest_stays_nearest_to_the_prior() {
    let found = updated(
        "method = \"lap-update\"\nname = \"x\"\n[[assembly]]\nfrequency_hz = [100, 300]\nrelative_deviation = 0.01\n\
         [bounds]\nk = [1e5, 1e7]\nm = [0.5, 8]\nk12 = [1e5, 1e8]\nc = [0.1, 10]\nc12 = [0.1, 10]\nkN = [1e3, 1e5]\n",
    );
    let torque = &found.torques[0];
    let omega = [TAU * 100.0, TAU * 300.0];
    let [k, m, k12, c, c12, cubic] = torque.solution.0;
    assert!((k / m / omega[0].powi(2) - 1.0).abs() < 1e-9);
    assert!((k12 / m / (0.5 * (omega[1].powi(2) - omega[0].powi(2))) - 1.0).abs() < 1e-9);
    // Of all (k, m, k12) with these ratios the nearest to the middles of the bounds in ln-units of their widths:
    // s minimises Σ ((ln p_i + s − mid_i)/w_i)².
    let at_one: [f64; 3] = [
        omega[0].powi(2),
        1.0,
        0.5 * (omega[1].powi(2) - omega[0].powi(2)),
    ];
    let bounds = [[1e5, 1e7], [0.5, 8.0], [1e5, 1e8]];
    let (mut up, mut down) = (0.0, 0.0);
    for (value, [low, high]) in at_one.into_iter().zip(bounds) {
        let width = f64::ln(high / low);
        up += (0.5 * f64::ln(low * high) - value.ln()) / width.powi(2);
        down += width.powi(-2);
    }
    let mass = (up / down).exp();
    assert!((m / mass - 1.0).abs() < 1e-5, "{m} {mass}");
    for (value, middle) in [(c, 1.0), (c12, 1.0), (cubic, 1e4)] {
        assert!((value / middle - 1.0_f64).abs() < 1e-9);
    }
    assert_eq!(torque.not_identified(), ["k", "m", "k12", "c", "c12", "kN"]);
    let together = [
        LapParameter::SupportStiffness,
        LapParameter::Mass,
        LapParameter::JointStiffness,
    ];
    assert!(
        together
            .iter()
            .all(|&parameter| torque.knowledge(parameter) == Knowledge::Together)
    );
    for unseen in [
        LapParameter::SupportDamping,
        LapParameter::JointDamping,
        LapParameter::JointCubic,
    ] {
        assert_eq!(torque.knowledge(unseen), Knowledge::NoInfluence);
    }
    // σ(ω₁²) = 2 ω₁² σ, σ(½(ω₂² − ω₁²)) = √(ω₁⁴ + ω₂⁴) σ
    let combinations = &torque.identifiability.combinations;
    let deviations = [
        2.0 * omega[0].powi(2) * 0.01,
        0.01 * omega[0].powi(2).hypot(omega[1].powi(2)),
    ];
    for (combination, deviation) in combinations.iter().zip(deviations) {
        assert!((combination.standard_deviation.unwrap() / deviation - 1.0).abs() < 1e-12);
    }
    // The file does not hold a cubic spring that nothing is known of.
    let (_, file) = &found.joint_files()[0];
    assert_eq!(file.joint.cubic, [0.0]);
}

#[test]
fn fireflies_depend_on_their_seed_alone_and_never_get_worse() {
    let [one, again] = [(); 2].map(|()| example("study.toml"));
    for (one, again) in one.torques.iter().zip(&again.torques) {
        assert_eq!(one.firefly, again.firefly);
        assert_eq!(one.firefly.history.len(), 121);
        assert!(
            one.firefly
                .history
                .windows(2)
                .all(|pair| pair[1] <= pair[0])
        );
    }
}

#[test]
fn bodies_that_are_the_same_at_all_torques_have_one_file_over_the_preload() {
    let assemblies = [(2, 639, 1753), (8, 639, 2026)].map(|(torque, first, second)| {
        format!("[[assembly]]\ntorque = {torque}\nomega_rad_per_s = [{first}, {second}]\n")
    });
    let found = updated(&format!(
        "method = \"lap-update\"\nname = \"x\"\n{}[known]\nm = 2\nk = {}\nc = 1\nc12 = 0.5\n[bounds]\nk12 = [1e5, 1e8]\n",
        assemblies.concat(),
        2.0 * 639.0 * 639.0
    ));
    let files = found.joint_files();
    assert_eq!(files.len(), 1);
    let over = files[0].1.joint.over_preload.as_ref().unwrap();
    assert_eq!(over.preload, [2.0, 8.0]);
    for (stiffness, omega) in over.stiffness.iter().zip([1753.0_f64, 2026.0]) {
        assert!((stiffness[0][0] / (omega * omega - 639.0 * 639.0) - 1.0).abs() < 1e-9);
    }
    assert!(files[0].1.to_json().is_ok());
}

#[test]
fn one_frequency_alone_gives_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    let text = "method = \"lap-update\"\nname = \"one\"\n[[assembly]]\nfrequency_hz = [102.07]\nrelative_deviation = 0.002\n\
                [known]\nm = 2\nk12 = 394784\nc = 1\nc12 = 1\n[bounds]\nk = [1e4, 1e7]\n";
    std::fs::write(&path, text).unwrap();
    let study = LapUpdateStudy::read(&path).unwrap();
    let found = LapUpdate::of(&study, &silent).unwrap();
    let (_, file) = &found.joint_files()[0];
    assert_eq!(file.validate(), []);
    let [from_hz, to_hz] = file.validity.as_ref().unwrap().frequency_hz;
    assert_eq!(from_hz, to_hz);
}
