//! A published backbone of a beam with friction, which no code of this project has made, identified as a lap.

use bolted_joint::harmonic::{HarmonicBalance, Harmonics, Target};
use bolted_joint::identify::lap::{LapResponse, LapResponseStudy};
use bolted_joint::joint::JointFile;

const FLAT: &str = include_str!("../data/backbones/brake-reuss-model-flat.csv");

/// The model that the data choose, or that of these terms.
fn identified(terms: &str) -> JointFile {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("flat.csv"), FLAT).unwrap();
    // twice the modal mass: only the relative motion counts
    let study = format!(
        "method = \"lap-response\"\nname = \"flat\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n{terms}\n\
         [known]\nm = 2.1107\n[noise]\nfrequency = 0.002\ndamping = 0.1\n[[backbone]]\nfile = \"flat.csv\"\n"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    LapResponse::of(&study, &|| {}).unwrap().joint_file(&study)
}

/// Largest relative error of ω, and root mean square of that of ζ, by harmonic balance of the joint file.
fn errors(file: &JointFile) -> [f64; 2] {
    let lap = file.lap::<1>().unwrap();
    let balance = HarmonicBalance::new(&lap, Harmonics::odd(1).unwrap()).unwrap();
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0.0);
    for line in FLAT.lines().skip(1) {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|number| number.parse().unwrap())
            .collect();
        let [omega, amplitude, ratio] = numbers[..] else {
            panic!("{line}");
        };
        let found = balance.free(Target::relative(0, amplitude), None).unwrap();
        largest = largest.max((found.omega_rad_s() / omega - 1.0).abs());
        squares += (found.damping_ratio() / ratio - 1.0).powi(2);
        count += 1.0;
    }
    assert_eq!(count, 23.0);
    [largest, (squares / count).sqrt()]
}

#[test]
fn friction_follows_it_and_a_polynomial_does_not() {
    let chosen = identified("");
    let [law] = &chosen.joint.friction[..] else {
        panic!("{:?}", chosen.joint.friction);
    };
    assert_eq!(law.law.name, "iwan");
    assert!(chosen.status.is_none());
    let [omega, ratio] = errors(&chosen);
    println!("chosen: {omega:e} {ratio:e}");
    assert!(omega < 3e-3 && ratio < 0.12, "{omega} {ratio}");
    // as many terms as there are, with seven unknowns in place of four
    let [omega, ratio] = errors(&identified(
        "terms = [\"k3\", \"k5\", \"k7\", \"c2\", \"c4\"]",
    ));
    println!("polynomial: {omega:e} {ratio:e}");
    assert!(ratio > 0.25, "{omega} {ratio}");
}
