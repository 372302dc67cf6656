//! Data of laps that are not what the study says, and runs that are left out: each is told by name.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY};

const HEADER: &str = "frequency_hz,force_n,displacement_m,phase_rad\n";
/// m, k, c, k12, c12 of a lap with resonances at 71 and 101 Hz.
const LAP: [f64; 5] = [2.0, 4e5, 20.0, 2e5, 10.0];

/// Uniform numbers from 0 to 1, the same each time.
struct Unit(u64);

impl Unit {
    /// Far from those of the next seed.
    fn of(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The sum of twelve is nearly normal.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }
}

/// Rows of the lap driven at body b: what body `seen` ("a" or "b") does, with noise of half a per cent.
fn rows(seen: &str, force_n: f64, [from_hz, to_hz]: [f64; 2], seed: u64) -> Vec<[f64; 4]> {
    let [mass, k, c, k12, c12] = LAP;
    let mut unit = Unit::of(seed);
    let count = (4.0 * (to_hz - from_hz)) as u32;
    let rows = (0..=count).map(|n| {
        let hz = from_hz + 0.25 * f64::from(n);
        let omega = TAU * hz;
        let inverse = |re: f64, im: f64| {
            let size = re * re + im * im;
            (re / size, -im / size)
        };
        // x_b = ½/z_s + ¼/z_r, x_a = ½/z_s − ¼/z_r, where z_r = k/2 + k12 − ω²m/2 + jω(c/2 + c12)
        let (sum, rel) = (
            inverse(k - mass * omega * omega, c * omega),
            inverse(
                0.5 * k + k12 - 0.5 * mass * omega * omega,
                (0.5 * c + c12) * omega,
            ),
        );
        let side = if seen == "b" { 0.25 } else { -0.25 };
        let (re, im) = (0.5 * sum.0 + side * rel.0, 0.5 * sum.1 + side * rel.1);
        let size = force_n * f64::hypot(re, im) * (1.0 + 0.005 * unit.normal());
        [hz, force_n, size, im.atan2(re) + 0.005 * unit.normal()]
    });
    rows.collect()
}

fn csv(rows: &[[f64; 4]]) -> String {
    let mut text = HEADER.to_owned();
    for [hz, force_n, size, phase] in rows {
        let _ = writeln!(text, "{hz},{force_n},{size:e},{phase:e}");
    }
    text
}

/// A study driven at body b; each run is a file and what it is used for.
fn study(seen: &str, runs: &[(&str, &str)]) -> String {
    let mut text = format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"b\"\nresponse = \"{seen}\"\nterms = []\n\
         compare = false\nharmonics = 1\n"
    );
    for (file, used) in runs {
        let _ = writeln!(text, "[[sine]]\nfile = \"{file}\"\nuse = \"{used}\"");
    }
    text
}

const RANGE: [f64; 2] = [60.0, 115.0];

/// Both resonances of a run are predicted, whichever body is driven and seen; of a run without one it is said.
#[test]
fn runs_of_one_body_that_are_left_out_are_predicted() {
    for seen in ["b", "a"] {
        let bench = Bench::new();
        for (level, file) in ["1.csv", "2.csv", "3.csv", "4.csv", "5.csv"]
            .iter()
            .enumerate()
        {
            let own = rows(seen, 1.0 + level as f64, RANGE, level as u64);
            bench.write(file, csv(&own));
        }
        bench.write("short.csv", csv(&rows(seen, 2.0, [60.0, 65.0], 9)));
        let mut runs = ["1.csv", "2.csv", "3.csv", "4.csv"]
            .map(|file| (file, "fit"))
            .to_vec();
        runs.extend([("5.csv", "predict"), ("short.csv", "predict")]);
        bench.write("study.toml", study(seen, &runs));
        let outcome = bench.done(&format!("{IDENTIFY} --report o.html"));
        let no_resonance = "No resonance of short is predicted: no two neighbouring lines";
        let named = ["5, both bodies together", "5, relative motion"];
        for text in [&outcome.stdout, &bench.text("o.html")] {
            has(text, &[no_resonance, named[0], named[1]]);
        }
        let told = bench.done(&format!("{IDENTIFY} --json")).json();
        assert_eq!(told["unpredicted"][0]["run"], "short");
        let rows = told["predictions"].as_array().unwrap();
        assert_eq!(rows.len(), 10, "{rows:?}");
        // ω² = k/m and (k/2 + k12)/(m/2); damping and the other motion move where the phase is −90° by less than 1 %
        let [mass, k, _, k12, _] = LAP;
        for (motion, hz) in [
            ("together", (k / mass).sqrt() / TAU),
            ("relative", ((k + 2.0 * k12) / mass).sqrt() / TAU),
        ] {
            let own = rows
                .iter()
                .find(|row| row["run"] == "5" && row["motion"] == motion);
            let own = own.unwrap_or_else(|| panic!("{seen} {motion}: {rows:?}"));
            assert_eq!(own["left_out"], true);
            let at = |key: &str| own[key]["frequency_hz"].as_f64().unwrap();
            assert!((at("predicted") / hz - 1.0).abs() < 0.01, "{own:?}");
            assert!(
                (at("predicted") / at("measured") - 1.0).abs() < 1e-3,
                "{own:?}"
            );
            let [low, high] = [0, 1].map(|end| {
                let interval = &own["interval_95"]["frequency_hz"];
                interval[end].as_f64().unwrap()
            });
            assert!(low < at("measured") && at("measured") < high, "{own:?}");
        }
    }
}

#[test]
fn degrees_in_a_column_of_radian_are_refused() {
    let bench = Bench::new();
    let mut own = rows("b", 1.0, RANGE, 1);
    for row in &mut own {
        row[3] = row[3].to_degrees();
    }
    bench.write("run.csv", csv(&own));
    bench.write("study.toml", study("b", &[("run.csv", "fit")]));
    bench.refused(IDENTIFY, &["run.csv", "degrees", "`phase_deg`"]);
    bench.edit("run.csv", "phase_rad", "phase_deg");
    bench.done(IDENTIFY);
}

#[test]
fn radian_in_a_column_of_degrees_is_refused() {
    let bench = Bench::new();
    bench.write("run.csv", csv(&rows("b", 1.0, RANGE, 1)));
    bench.edit("run.csv", "phase_rad", "phase_deg");
    bench.write("study.toml", study("b", &[("run.csv", "fit")]));
    bench.refused(IDENTIFY, &["run.csv", "`phase_deg`", "`phase_rad`"]);
    // far from all resonances phases of few degrees are right
    let own: Vec<[f64; 4]> = rows("b", 1.0, [20.0, 40.0], 1)
        .into_iter()
        .map(|[hz, force_n, size, phase]| [hz, force_n, size, phase.to_degrees()])
        .collect();
    assert!(own.iter().all(|row| row[3].abs() < 3.2));
    bench.write("run.csv", csv(&own).replace("phase_rad", "phase_deg"));
    let outcome = bench.run(IDENTIFY);
    assert!(
        !outcome.stderr.contains("probably rad"),
        "{}",
        outcome.stderr
    );
}

/// No noise is stated: one of three runs twice as large is named, with what it would be if it were halved, and the result is
/// unusable. The factor is the ratio of 100 %, or of 2 at every line, to noise of 0.5 %.
#[test]
fn a_run_from_peak_to_peak_is_named() {
    let bench = Bench::new();
    let files = ["1.csv", "2.csv", "3.csv"];
    for (level, file) in files.iter().enumerate() {
        let mut own = rows("b", 1.0 + level as f64, RANGE, level as u64);
        for row in &mut own {
            row[2] *= if level == 1 { 2.0 } else { 1.0 };
        }
        bench.write(file, csv(&own));
    }
    bench.write("study.toml", study("b", &files.map(|file| (file, "fit"))));
    let outcome = bench.unusable(
        IDENTIFY,
        &["the noise of 1 % that is taken where none is stated"],
    );
    has(
        &outcome.stderr,
        &[
            "warning: 2 leaves ",
            "times what the other runs leave",
            "responses from peak to peak, without which it would leave 1.0 times",
        ],
    );
}

/// All responses twice as large, beside a mass that is known.
#[test]
fn responses_that_do_not_go_with_a_known_mass_are_told() {
    let bench = Bench::new();
    let mut own = rows("b", 1.0, RANGE, 1);
    for row in &mut own {
        row[2] *= 2.0;
    }
    bench.write("run.csv", csv(&own));
    let known = format!("[known]\nm = {}\n", LAP[0]);
    bench.write("study.toml", study("b", &[("run.csv", "fit")]) + &known);
    let outcome = bench.unusable(IDENTIFY, &["the noise of 1 %"]);
    has(
        &outcome.stderr,
        &["the data seem to have responses from peak to peak"],
    );
    bench.edit("study.toml", "m = 2", "m = 1");
    bench.done(IDENTIFY);
}

/// In mm nothing contradicts the numbers: a body of 2 g moves by some mm.
#[test]
fn sizes_that_no_joint_has_are_warned_of() {
    let bench = Bench::new();
    let mut own = rows("b", 1.0, RANGE, 1);
    let largest = own.iter().map(|row| row[2]).fold(0.0, f64::max);
    let good = csv(&own);
    for row in &mut own {
        row[2] *= 1e3;
    }
    assert!(largest * 1e3 > 0.01);
    bench.write("run.csv", csv(&own));
    bench.write("study.toml", study("b", &[("run.csv", "fit")]));
    let outcome = bench.done(IDENTIFY);
    has(
        &outcome.stderr,
        &[
            "is the response in mm",
            "m = 2.00e-3 kg",
            "are the forces in kN",
        ],
    );
    bench.write("run.csv", good);
    assert_eq!(bench.done(IDENTIFY).stderr, "");
}

/// A run of few lines in another unit is a minority of all lines, and yet nothing that the lap does.
#[test]
fn a_run_that_has_nothing_to_do_with_the_others_is_not_to_be_relied_on() {
    let bench = Bench::new();
    bench.write("1.csv", csv(&rows("b", 1.0, RANGE, 1)));
    bench.write("2.csv", csv(&rows("b", 2.0, RANGE, 2)));
    let mut own = rows("b", 3.0, [98.0, 103.0], 3);
    for row in &mut own {
        row[2] *= 10.0;
    }
    bench.write("cm.csv", csv(&own));
    let runs = [("1.csv", "fit"), ("2.csv", "fit"), ("cm.csv", "fit")];
    bench.write("study.toml", study("b", &runs));
    bench.unusable(
        IDENTIFY,
        &["half of the receptances of cm are", "units, phases"],
    );
}

#[test]
fn models_of_laps_are_compared_by_another_key_than_rivals() {
    let bench = Bench::new();
    bench.write("run.csv", csv(&rows("b", 1.0, RANGE, 1)));
    bench.write("study.toml", study("b", &[("run.csv", "fit")]));
    bench.refused(
        &format!("{IDENTIFY} --no-rivals"),
        &["`compare = false` beside `terms` in the study's [model]"],
    );
}

/// Runs that end at different frequencies are within a range where one of them reaches as far.
#[test]
fn a_range_beyond_all_runs_is_told() {
    let bench = Bench::new();
    bench.write("low.csv", csv(&rows("b", 1.0, [60.0, 105.0], 1)));
    bench.write("high.csv", csv(&rows("b", 1.0, [65.0, 115.0], 2)));
    let both = study("b", &[("low.csv", "fit"), ("high.csv", "fit")]);
    let told = "`frequency`: found from 60 to 300 Hz, but the lines of the stepped sines that are used go from 60 to 115 Hz only";
    for (range, is_told) in [
        ("from = 60\nto = 115.2", false),
        ("from = 60\nto = 300", true),
    ] {
        bench.write("study.toml", format!("{both}[frequency]\n{range}\n"));
        let outcome = bench.done(&format!("{IDENTIFY} --json"));
        let warnings = outcome.json()["warnings"].to_string();
        for text in [&outcome.stderr, &warnings] {
            assert_eq!(text.contains(told), is_told, "{range}: {text}");
            assert_eq!(text.contains("`frequency`"), is_told, "{range}: {text}");
        }
    }
}

#[test]
fn repeated_rows_count_once() {
    let bench = Bench::new();
    let own = rows("b", 1.0, RANGE, 1);
    bench.write("run.csv", csv(&own));
    let twice = csv(&own) + csv(&own).trim_start_matches(HEADER);
    bench.write("twice.csv", twice);
    bench.write("study.toml", study("b", &[("run.csv", "fit")]));
    let once = bench.done(&format!("{IDENTIFY} --json"));
    assert_eq!(once.stderr, "");
    bench.write("study.toml", study("b", &[("twice.csv", "fit")]));
    let twice = bench.done(&format!("{IDENTIFY} --json"));
    has(
        &twice.stderr,
        &["twice: 221 row(s) equal an earlier one", "count once"],
    );
    assert_eq!(once.json()["estimates"], twice.json()["estimates"]);
}

#[test]
fn one_table_under_two_names_is_refused() {
    let bench = Bench::new();
    let own = rows("b", 1.0, RANGE, 1);
    bench.write("run.csv", csv(&own));
    bench.write("copy.csv", csv(&own));
    let both = [("run.csv", "fit"), ("copy.csv", "fit")];
    bench.write("study.toml", study("b", &both));
    bench.refused(
        IDENTIFY,
        &["sine.file", "run.csv", "copy.csv", "the same rows"],
    );
    // of a part it is warned, and of a test that is none
    bench.write("copy.csv", csv(&own[..100]));
    bench.write("other.csv", csv(&rows("b", 2.0, RANGE, 2)));
    for (used, why) in [
        ("fit", "they count twice"),
        ("predict", "no test of a prediction"),
    ] {
        let runs = [("run.csv", "fit"), ("other.csv", "fit"), ("copy.csv", used)];
        bench.write("study.toml", study("b", &runs));
        let outcome = bench.done(IDENTIFY);
        has(
            &outcome.stderr,
            &["100 row(s) of copy stand in run, too", why],
        );
    }
}

/// A release of the relative motion: m/2 ü + c12 u̇ + k12 u + k3 u³ = 0 in steps of 10 µs, every tenth of which is a row.
fn decay(release_m: f64, most_m: f64) -> String {
    let (mass, c12, k12, k3) = (1.5, 8.0, 8e5, 2e13);
    let rate = |u: f64, v: f64| -2.0 / mass * (k12 * u + c12 * v + k3 * u * u * u);
    let (h, mut u, mut v) = (1e-5, release_m, 0.0);
    let mut unit = Unit::of(3);
    let mut text = "time_s,displacement_m\n".to_owned();
    for n in 0..120_000 {
        if n % 10 == 0 {
            let value = (u + 5e-8 * unit.normal()).clamp(-most_m, most_m);
            let _ = writeln!(text, "{:.7},{value:.8e}", h * f64::from(n));
        }
        let a1 = rate(u, v);
        let (v2, a2) = (v + 0.5 * h * a1, rate(u + 0.5 * h * v, v + 0.5 * h * a1));
        let (v3, a3) = (v + 0.5 * h * a2, rate(u + 0.5 * h * v2, v + 0.5 * h * a2));
        let (v4, a4) = (v + h * a3, rate(u + h * v3, v + h * a3));
        u += h / 6.0 * (v + 2.0 * (v2 + v3) + v4);
        v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    }
    text
}

fn of_decay(more: &str) -> String {
    format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
         terms = [\"k3\"]\ncompare = false\n[known]\nm = 1.5\n[[decay]]\nfile = \"decay.csv\"\n{more}"
    )
}

#[test]
fn a_clipped_decay_is_refused() {
    let bench = Bench::new();
    bench.write("decay.csv", decay(5e-5, 3e-5));
    bench.write("study.toml", of_decay(""));
    bench.refused(
        IDENTIFY,
        &["decay.csv", "clipped", "exactly 3e-5", "less gain"],
    );
}

/// The same record with its times in ms is that of a joint at 0.2 Hz.
#[test]
fn times_in_milliseconds_are_warned_of() {
    let bench = Bench::new();
    let in_ms = |line: &str| match line.split_once(',') {
        Some((time, value)) if !time.starts_with('t') => {
            let time: f64 = time.parse().unwrap();
            format!("{:.4},{value}\n", 1e3 * time)
        }
        _ => format!("{line}\n"),
    };
    let text: String = decay(5e-5, 1.0).lines().map(in_ms).collect();
    bench.write("decay.csv", text);
    bench.write("study.toml", of_decay(""));
    let outcome = bench.run(IDENTIFY);
    has(
        &outcome.stderr,
        &["decay: a resonance at ", "is the time in ms"],
    );
}

/// From 201 to 164 Hz: one mode, although its frequency moves by more than a narrow band.
#[test]
fn a_decay_whose_frequency_moves_far_is_one_mode() {
    let bench = Bench::new();
    bench.write("decay.csv", decay(2e-4, 1.0));
    bench.write("study.toml", of_decay(""));
    let told = bench.done(&format!("{IDENTIFY} --json")).json();
    let estimates = told["estimates"].as_array().unwrap();
    for (unknown, truth) in [("k12", 8e5), ("c12", 8.0), ("k3", 2e13)] {
        let own = estimates.iter().find(|own| own["unknown"] == unknown);
        let [low, high] = [0, 1].map(|end| own.unwrap()["interval_95"][end].as_f64().unwrap());
        let half = 0.5 * (high - low);
        assert!(low - half < truth && truth < high + half, "{own:?}");
    }
    bench.write("study.toml", of_decay("band = [140, 220]\n"));
    bench.refused(IDENTIFY, &["moves out of the band", "band = [90, "]);
}
