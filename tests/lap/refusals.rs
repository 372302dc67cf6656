//! Studies and tables that cannot be used: each message names the file, the key or line, and what to do.

use bolted_joint_testing::has;
use std::f64::consts::TAU;
use std::fs;
use std::path::PathBuf;

use bolted_joint::identify::Study;
use bolted_joint::identify::lap::{LapResponseStudy, LapUpdateStudy};
use bolted_joint::study::{Method, StudyText};
use tempfile::TempDir;

const UPDATE: &str = "method = \"lap-update\"\nname = \"x\"\n[[assembly]]\nfrequency_hz = [100, 300]\n[bounds]\nk = [1e5, 1e7]\nm = [1, 3]\nk12 = [1e5, 1e8]\n";
const RESPONSE: &str = "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n[[sine]]\nfile = \"run.csv\"\n";
const HEADER: &str = "frequency_hz,force_n,displacement_m,phase_rad";

fn written(name: &str, text: &str, folder: &TempDir) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path
}

/// What is said of a study with `from` replaced by `to`, beside a table of this text.
fn refusal(study: &str, (from, to): (&str, &str), table: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    written("run.csv", table, &folder);
    assert!(study.contains(from));
    let path = written("study.toml", &study.replace(from, to), &folder);
    match study.starts_with("method = \"lap-update\"") {
        true => LapUpdateStudy::read(&path).unwrap_err().to_string(),
        false => LapResponseStudy::read(&path).unwrap_err().to_string(),
    }
}

#[test]
fn damaged_updates_are_refused_by_their_key() {
    #[rustfmt::skip]
    let cases = [
        ("k = [1e5, 1e7]", "k = [1e7, 1e5]", ["bounds.k", "upside down: write [100000, 10000000]"]),
        ("m = [1, 3]", "m = [0, 3]", ["bounds.m", "0 < low < high"]),
        ("[100, 300]", "[300, 100]", ["assembly[1].frequency_hz", "write [100, 300]"]),
        ("[100, 300]", "[100, 300, 500]", ["assembly[1].frequency_hz", "two degrees of freedom"]),
        ("[100, 300]", "[]", ["assembly[1].frequency_hz", "one or two frequencies"]),
        ("[100, 300]", "[100, 300]\nweights = [1]", ["assembly[1].weights", "2 number(s)"]),
        ("[100, 300]", "[100, 300]\nomega_rad_per_s = [1, 2]", ["assembly[1].frequency_hz", "one of them"]),
        ("frequency_hz", "frequency_khz", ["unknown field", "frequency_hz"]),
        ("k12 = [1e5, 1e8]", "", ["bounds.k12", "found nothing"]),
        ("k12 = [1e5, 1e8]", "k12 = [1e5, 1e8]\n[prior]\nk12 = 1", ["prior.k12", "within bounds.k12"]),
        ("k12 = [1e5, 1e8]", "k12 = [1e5, 1e8]\n[known]\nk12 = 1e6", ["known.k12", "in [known] alone"]),
        ("k12 = [1e5, 1e8]", "k12 = [1e5, 1e8]\n[firefly]\npopulation = 1", ["firefly.population", "from 2"]),
        ("[100, 300]", "[100, 300]\n[[assembly]]\nfrequency_hz = [1, 2]", ["assembly[1].torque", "N·m"]),
    ];
    for (from, to, parts) in cases {
        let error = refusal(UPDATE, (from, to), "");
        has(&error, &["study.toml"]);
        has(&error, &parts);
    }
}

#[test]
fn damaged_tables_are_refused_by_their_line() {
    let row = "80,1,1e-4,-1.5\n81,1,1e-4,-2\n";
    #[rustfmt::skip]
    let cases = [
        ("frequency_hz,force_n,displacement_m\n80,1,1e-4\n".to_owned(), ["line 1", "a level without phase"]),
        (format!("{HEADER}\n80,1,1e-4,\n81,1,1e-4,-1\n"), ["line 2", "a level without phase"]),
        (format!("{HEADER}\n80,1,1e-4,-1\n81,1,1e-4\n"), ["line 3", "3 cells"]),
        (format!("{HEADER}\n80,1,1e-4,-1\n81,0,1e-4,-1\n"), ["line 3", "a force of 0"]),
        (format!("{HEADER}\n80,1,x,-1\n"), ["line 2", "\"x\""]),
        ("frequency_hz,force_n,phase_rad\n80,1,-1\n".to_owned(), ["line 1", "displacement_m or velocity_m_per_s or acceleration_m_per_s2"]),
        (format!("{HEADER},force_n\n80,1,1e-4,-1,1\n"), ["line 1", "twice"]),
        (format!("{HEADER}\n80,1,1e-4,-1\n"), ["line 1", "at least two"]),
        (format!("{HEADER}\n{}", row.replace("-1.5", "1.5").replace("-2", "2")), ["run.csv", "phase_of"]),
        (format!("{HEADER}\n80,1,1,5,-1\n"), ["line 2", "with decimal commas, separate the columns by semicolons"]),
        (format!("{}\n80;1;1,5;-1.5\n", HEADER.replace(',', ";")), ["line 2", "\"-1.5\""]),
    ];
    for (table, parts) in cases {
        let error = refusal(RESPONSE, ("", ""), &table);
        has(&error, &["run.csv"]);
        has(&error, &parts);
    }
}

/// Beyond critical damping nothing vibrates; per cent is the likely slip.
#[test]
fn damping_ratios_above_one_are_refused_by_their_line() {
    let study = RESPONSE.replace("[[sine]]", "[[backbone]]");
    let table = "frequency_hz,displacement_m,damping_ratio\n80,1e-5,0.01\n80,1e-4,1.2\n";
    let error = refusal(&study, ("", ""), table);
    has(
        &error,
        &[
            "run.csv",
            "line 3",
            "a damping ratio of 1.2",
            "below 1",
            "0.02",
        ],
    );
}

#[test]
fn damaged_response_studies_are_refused_by_their_key() {
    #[rustfmt::skip]
    let cases = [
        ("file = \"run.csv\"", "file = \"run.csv\"\nuse = \"predict\"", "no run for the estimate"),
        ("file = \"run.csv\"", "file = \"run.csv\"\nphase_sign = 2", "sine.phase_sign"),
        ("[[sine]]", "[known]\nm = 0\n[[sine]]", "known.m"),
        ("[[sine]]", "[noise]\nresponse = 0\n[[sine]]", "noise.response"),
        ("[[sine]]", "[frequency]\nfrom = 9\nto = 3\n[[sine]]", "frequency"),
        ("[[sine]]", "terms = [\"k3\", \"kN\"]\n[[sine]]", "k3 twice"),
        ("[[sine]]", "terms = [\"k9\"]\n[[sine]]", "k9"),
        ("[[sine]]", "compare = false\n[[sine]]", "model.compare"),
    ];
    for (from, to, part) in cases {
        let table = format!("{HEADER}\n80,1,1e-4,-1\n81,1,1e-4,-2\n");
        let error = refusal(RESPONSE, (from, to), &table);
        has(&error, &["study.toml", part]);
    }
}

#[test]
fn every_method_has_its_reader() {
    let folder = tempfile::tempdir().unwrap();
    let path = written("study.toml", UPDATE, &folder);
    let method = |path| StudyText::read(path).and_then(|study| study.method());
    assert_eq!(method(&path).unwrap(), Method::LapUpdate);
    let magic = UPDATE.replace("lap-update", "lap-magic");
    let other = written("other.toml", &magic, &folder);
    let error = method(&other).unwrap_err().to_string();
    has(&error, &["lap-magic", "`lap-response`"]);
    assert!(Study::read(&path).is_err());
}

/// A raw record of several modes, and bands that do not hold one.
#[test]
fn a_decay_of_several_modes_is_refused_and_names_them() {
    let study = |band: &str| RESPONSE.replace("[[sine]]\n", &format!("[[decay]]\n{band}"));
    let value = |t: f64| {
        let mode = |amplitude: f64, hz: f64| amplitude * (-4.0 * t).exp() * (TAU * hz * t).cos();
        mode(1e-4, 80.0) + mode(3e-5, 130.0)
    };
    let mut table = "time_s,displacement_m\n".to_owned();
    for n in 0..8000 {
        let t = 2e-4 * f64::from(n);
        table += &format!("{t},{:e}\n", value(t));
    }
    let same = ("name", "name");
    has(
        &refusal(&study(""), same, &table),
        &["run.csv", "80.", "130.", "band = [60, 100]"],
    );
    let wide = refusal(&study("band = [60, 200]\n"), same, &table);
    has(&wide, &["80.", "130."]);
    let upside_down = refusal(&study("band = [100, 60]\n"), same, &table);
    has(&upside_down, &["decay.band", "[100, 60]"]);
    let empty = refusal(&study("band = [900, 1000]\n"), same, &table);
    has(&empty, &["run.csv", "expected"]);
    let folder = tempfile::tempdir().unwrap();
    written("run.csv", &table, &folder);
    let path = written("study.toml", &study("band = [60, 100]\n"), &folder);
    let read = LapResponseStudy::read(&path).unwrap();
    let line = read.backbones[0].lines[3];
    assert!((line.omega / (TAU * 80.0) - 1.0).abs() < 1e-4);
    assert!((line.damping_ratio.unwrap() * line.omega / 4.0 - 1.0).abs() < 1e-2);
}

#[test]
fn noise_in_per_cent_is_refused() {
    let table = format!("{HEADER}\n80,1,1e-4,-1.5\n81,1,1e-4,-2\n");
    let noise = "[[sine]]\nfile = \"run.csv\"\n[noise]\nresponse = 5\n";
    let error = refusal(RESPONSE, ("[[sine]]\nfile = \"run.csv\"\n", noise), &table);
    has(&error, &["`noise.response`: found 5", "0.05 is 5 %"]);
}

#[test]
fn a_file_that_is_named_twice_is_no_second_measurement() {
    let table = format!("{HEADER}\n80,1,1e-4,-1.5\n81,1,1e-4,-2\n");
    let again = "file = \"run.csv\"\n[[sine]]\nfile = \"./run.csv\"\n";
    let error = refusal(RESPONSE, ("file = \"run.csv\"\n", again), &table);
    has(
        &error,
        &[
            "`sine.file`: found \"./run.csv\" twice",
            "it would count as two",
        ],
    );
}

/// As a German or French spreadsheet writes them.
#[test]
fn semicolons_and_decimal_commas_give_the_same_lines() {
    let read = |table: &str| {
        let folder = tempfile::tempdir().unwrap();
        written("run.csv", table, &folder);
        let path = written("study.toml", RESPONSE, &folder);
        let study = LapResponseStudy::read(&path).unwrap();
        study.sines[0].lines.clone()
    };
    let points = format!("{HEADER}\n80.5,1,1.5e-4,-1.5\n81,1,1e-4,-2\n");
    let commas = points.replace(',', ";").replace('.', ",");
    assert_eq!(read(&points), read(&commas));
}
