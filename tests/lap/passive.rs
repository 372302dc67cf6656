//! Joints whose free estimate would feed energy: the passive one that fits best, against SciPy on the same data.

use bolted_joint_testing::{close, has};

use bolted_joint::identify::lap::{LapResponse, LapResponseStudy, Limit, ResponseUnknown, Term};
use bolted_joint::joint::JointFile;

fn identified(csv: &str, noise: &str) -> (LapResponse, JointFile, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("backbone.csv"), csv).unwrap();
    let study = format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
         terms = [\"k3\", \"c2\", \"c4\"]\n[known]\nm = 2.0\n{noise}[[backbone]]\nfile = \"backbone.csv\"\n"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let found = LapResponse::of(&study, &|| {}).unwrap();
    let file = found.joint_file(&study);
    assert!(file.validate().is_empty(), "{:?}", file.validate());
    let warnings = found.warnings(&study);
    (found, file, warnings)
}

const STATED: &str = "[noise]\nfrequency = 1e-4\ndamping = 0.03\n";

/// A backbone with what SciPy 1.17 found for it: χ² of the free (`least_squares`) and of the passive joint (SLSQP), and
/// k12, c12, k3, c2, c4 of the latter.
struct Case {
    csv: &'static str,
    free: f64,
    passive: f64,
    values: [f64; 5],
    /// Where the damping touches zero, in parts of the largest displacement.
    touches: f64,
}

/// 20 (u/U − 0.4)² N·s/m: a dip that touches zero.
const DIP: Case = Case {
    csv: include_str!("../data/lap/damping-that-dips.csv"),
    free: 53.297_422_18,
    passive: 53.823_950_56,
    values: [
        4.999_725_060e5,
        3.221_890_404,
        -1.990_370_801e11,
        -1.871_195_673e8,
        2.716_862_467e15,
    ],
    touches: 0.618_537,
};

/// 2 (1 − u/U) N·s/m: nothing is left at the largest displacement.
const FADES: Case = Case {
    csv: include_str!("../data/lap/damping-that-fades.csv"),
    free: 35.639_966_52,
    passive: 35.824_573_40,
    values: [
        5.000_070_333e5,
        1.983_594_929,
        -1.998_154_429e11,
        -2.183_710_161e7,
        -2.253_800_563e12,
    ],
    touches: 1.0,
};

/// 2 (1 − 2u/U) N·s/m: it feeds energy at large displacements.
const FEEDS: Case = Case {
    csv: include_str!("../data/lap/damping-that-feeds.csv"),
    free: 35.734_914_83,
    passive: 65.846_431_03,
    values: [
        5.000_070_333e5,
        2.024_872_834,
        -1.998_154_541e11,
        -6.328_743_729e7,
        4.945_125_013e14,
    ],
    touches: 0.843_256,
};

const LARGEST_M: f64 = 3e-4;

#[track_caller]
fn assert_that_of_scipy(case: &Case) -> (LapResponse, JointFile, Vec<String>) {
    let (found, file, warnings) = identified(case.csv, STATED);
    let free = found.free.as_ref().expect("a free estimate that is active");
    close(free.chi_squared, case.free, 1e-6);
    close(found.fit.chi_squared, case.passive, 1e-6);
    close(found.price, case.passive - case.free, 1e-3);
    let [c2, c4] = ["c2", "c4"].map(|name| ResponseUnknown::Term(Term::named(name).unwrap()));
    let unknowns = [
        ResponseUnknown::JointStiffness,
        ResponseUnknown::JointDamping,
        ResponseUnknown::Term(Term::CUBIC),
        c2,
        c4,
    ];
    for (unknown, expected) in unknowns.into_iter().zip(case.values) {
        // as near as χ² tells, which is flat there
        let deviation = found.deviation(unknown);
        let off = (found.fit.values.of(unknown) - expected).abs();
        assert!(
            off < 2e-3 * deviation,
            "{}: {off} of {deviation}",
            unknown.symbol()
        );
    }
    let [at] = &found.fit.at_limits[..] else {
        panic!("{:?}", found.fit.at_limits);
    };
    let Limit::JointDamping(at_m) = at.limit else {
        panic!("{:?}", at.limit);
    };
    close(at_m / LARGEST_M, case.touches, 1e-3);
    // Karush, Kuhn and Tucker: the limit pushes, and nothing is left to win along it
    assert!(
        at.multiplier > 0.0 && found.fit.left < 1e-6,
        "{}",
        found.fit.left
    );
    // `export` takes it, and the intervals hold both estimates
    assert!(file.passivity().is_passive(), "{}", file.passivity());
    for own in &found.estimates {
        let [low, high] = own.interval_95;
        assert!(
            [own.value, own.free_value]
                .iter()
                .all(|value| (low..=high).contains(value))
        );
    }
    let uncertainty = file.uncertainty.as_ref().unwrap();
    let beside = uncertainty.free_estimate.as_ref().unwrap();
    assert_eq!(beside.unknowns.len(), 5);
    close(beside.price.unwrap(), found.price, 1e-12);
    let [low, high] = uncertainty.interval_95.as_ref().unwrap().damping[0][0];
    assert!((low..=high).contains(&file.joint.damping[0][0]));
    has(&warnings.join("\n"), &["free estimate would feed energy"]);
    (found, file, warnings)
}

#[test]
fn noise_that_makes_a_dip_active_is_taken_back() {
    let (.., warnings) = assert_that_of_scipy(&DIP);
    assert!(
        !warnings.join("\n").contains("the data themselves"),
        "{warnings:?}"
    );
}

#[test]
fn noise_that_makes_the_end_active_is_taken_back() {
    let (.., warnings) = assert_that_of_scipy(&FADES);
    assert!(
        !warnings.join("\n").contains("the data themselves"),
        "{warnings:?}"
    );
}

#[test]
fn data_that_feed_energy_give_a_passive_joint_and_are_named() {
    let (.., warnings) = assert_that_of_scipy(&FEEDS);
    has(&warnings.join("\n"), &["the data themselves feed energy"]);
}

/// Without a stated noise the level is that of the free estimate, and the price is told in the likelihood of both levels.
#[test]
fn a_level_that_is_not_stated_is_that_of_the_free_estimate() {
    let (found, file, _) = identified(FEEDS.csv, "");
    let free = found.free.as_ref().unwrap();
    close(found.inflation.powi(2), free.reduced_chi_squared(), 1e-12);
    let count = (free.degrees_of_freedom + 5) as f64;
    let expected = count * (found.fit.chi_squared / free.chi_squared).ln();
    close(found.price, expected, 1e-9);
    assert!(file.passivity().is_passive());
}
