//! The measured Brake–Reuß beam: what it takes to describe it, and how well runs that were left out are predicted.

use bolted_joint_testing::{has, near};
use std::path::{Path, PathBuf};

use bolted_joint::identify::lap::{LapResponse, LapResponseStudy, Term};

const RUNS: [&str; 9] = [
    "response-control-1",
    "force-control-1",
    "response-control-2",
    "force-control-2",
    "response-control-4",
    "response-control-5",
    "force-control-4",
    "response-control-7",
    "response-control-8",
];

fn folder() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("../shared/data/brake-reuss");
    if folder.join("force-control-1.csv").is_file() {
        return Some(folder);
    }
    println!("skipped: {} is not there", folder.display());
    None
}

fn found(left_out: &[&str], phase_of: &str, more: &str) -> Option<LapResponse> {
    let folder = folder()?;
    let sines = RUNS.map(|run| {
        let used = if left_out.contains(&run) {
            "predict"
        } else {
            "fit"
        };
        let file = folder.join(format!("{run}.csv"));
        format!(
            "[[sine]]\nfile = {:?}\nphase_of = \"{phase_of}\"\nuse = \"{used}\"\n",
            file.display().to_string()
        )
    });
    let text = format!(
        "method = \"lap-response\"\nname = \"Brake-Reuss\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n{more}\n{}",
        sines.concat()
    );
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    Some(LapResponse::of(&study, &|| {}).unwrap())
}

#[test]
fn runs_left_out_are_predicted() {
    let left_out = ["response-control-2", "force-control-2", "force-control-4"];
    let Some(found) = found(&left_out, "displacement", "other_modes = true") else {
        return;
    };
    for row in found.predictions.iter().filter(|row| row.left_out) {
        let (hz, amplitude) = (
            row.frequency_error_hz().unwrap(),
            row.amplitude_error().unwrap(),
        );
        println!("{}: {hz:+.3} Hz, {:+.1} %", row.run, 100.0 * amplitude);
        assert!(
            hz.abs() < 0.1 && amplitude.abs() < 0.1,
            "{}: {hz} Hz, {amplitude}",
            row.run
        );
    }
    assert_eq!(found.predictions.len(), 9);
    // five numbers of nine act on the resonances of six runs: that leaves one
    let mut rows = found.predictions.iter();
    assert!(rows.all(|row| row.interval_95.is_none() && row.no_interval.is_some()));
    has(
        &found.without_interval().join("\n"),
        &["No run has an interval", "of the 6 fitted run(s)"],
    );
}

/// The resonances of the data's own description: frequency at −90° and acceleration over force there.
#[test]
fn measured_resonances_are_those_of_the_description() {
    let Some(found) = found(&[], "displacement", "") else {
        return;
    };
    for (run, hz, inertance) in [
        ("response-control-1", 80.365, 168.6),
        ("force-control-1", 80.270, 134.7),
        ("response-control-4", 80.108, 82.6),
        ("response-control-8", 80.438, 38.8),
    ] {
        let row = found.predictions.iter().find(|row| row.run == run).unwrap();
        let omega = std::f64::consts::TAU * row.measured.frequency_hz;
        let found = omega * omega * row.measured.displacement_m / row.measured.force_n;
        near(row.measured.frequency_hz, hz, 2e-3);
        assert!((found / inertance - 1.0).abs() < 5e-3, "{run}: {found}");
    }
}

fn term(symbol: &str) -> Term {
    Term::named(symbol).unwrap()
}

#[test]
fn a_cubic_spring_with_viscous_damping_does_not_do() {
    let Some(found) = found(&[], "displacement", "other_modes = true") else {
        return;
    };
    let bic = |terms: &str| {
        let mut models = found.comparison.iter();
        models
            .find(|model| model.terms.to_string() == terms)
            .unwrap()
            .bic_difference
    };
    // Strong evidence is a difference of 10.
    assert!(bic("linear") > bic("k3") && bic("k3") > 500.0);
    assert!(bic("k3, c2") > 100.0 && bic("k3, k5, c2") > 100.0);
    let terms = found.model.terms.terms();
    assert!(
        ["k3", "k5", "k7", "c2"]
            .iter()
            .all(|symbol| terms.contains(&term(symbol)))
    );
    // Softens first, stiffens then; local modal mass about 1.95 kg; damping grows.
    let values = &found.fit.values;
    assert!(values.term(Term::CUBIC) < 0.0 && values.term(term("k5")) > 0.0);
    near(0.5 * values.mass / 1.95, 1.0, 0.05);
    assert!(values.term(term("c2")) > 0.0 && (2.0..4.0).contains(&values.joint_damping));
}

#[test]
fn a_cubic_spring_alone_misses_runs_that_are_left_out() {
    let left_out = ["response-control-4", "response-control-1"];
    let Some(found) = found(
        &left_out,
        "displacement",
        "terms = [\"k3\"]\nother_modes = true",
    ) else {
        return;
    };
    let missed = found.predictions.iter().filter(|row| row.left_out);
    let missed = missed.filter(|row| row.amplitude_error().is_none_or(|error| error.abs() > 0.1));
    assert!(missed.count() >= 1);
}

#[test]
fn the_phase_of_the_acceleration_is_refused_as_active() {
    let Some(folder) = folder() else { return };
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("study.toml");
    let file = folder.join("force-control-1.csv").display().to_string();
    let text = format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n[[sine]]\nfile = {file:?}\n"
    );
    std::fs::write(&path, text).unwrap();
    let error = LapResponseStudy::read(&path).unwrap_err().to_string();
    has(&error, &["force-control-1.csv", "phase_of"]);
}

/// Every run but the highest level, which would be an extrapolation, left out alone.
#[test]
fn each_run_is_predicted_from_the_others() {
    if folder().is_none() {
        return;
    }
    let mut within = 0;
    for run in &RUNS[..8] {
        let found = found(&[run], "displacement", "other_modes = true").unwrap();
        let row = found.predictions.iter().find(|row| row.left_out).unwrap();
        let (hz, amplitude) = (
            row.frequency_error_hz().unwrap(),
            row.amplitude_error().unwrap(),
        );
        let expected = row.interval_95.unwrap();
        let [low, high] = expected.frequency_hz;
        let [least, most] = expected.displacement_m;
        let holds = [
            (low..=high).contains(&row.measured.frequency_hz),
            (least..=most).contains(&row.measured.displacement_m),
        ];
        println!(
            "{run}: {hz:+.3} Hz of ±{:.3}, {:+.1} % of ±{:.1}: {holds:?}",
            0.5 * (high - low),
            100.0 * amplitude,
            50.0 * (most / least).ln()
        );
        // that of the lowest level, too, which is missed by a third
        assert!(
            holds == [true; 2],
            "{run}: {expected:?} does not hold {:?}",
            row.measured
        );
        // The run of the lowest level is a quarter of the next: what damping is left there is an extrapolation.
        let is_lowest = *run == RUNS[0];
        // The turn from softening to stiffening at 50 m/s² is sharp without a run there.
        assert!(
            hz.abs() < 0.12 && (is_lowest || amplitude.abs() < 0.13),
            "{run}: {hz} Hz, {amplitude}"
        );
        within += usize::from(hz.abs() < 0.1);
    }
    assert!(within >= 7, "{within} of 8 within 0.1 Hz");
}
