//! `respond` with studies of laps: the examples, what they must show, and what is refused.

use bolted_joint_testing::{close, has};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use num_complex::Complex64;

use crate::bench::Bench;
use crate::examples::files_of;

/// m, c, k, k12, c12 of Table 3.
const TABLE_3: [(&str, [f64; 5]); 4] = [
    ("Ex.01, 2 N·m", [1.41, 0.78, 8.24e5, 4.14e6, 0.34]),
    ("Ex.02, 4 N·m", [1.89, 1.24, 8.82e5, 4.23e6, 0.38]),
    ("Ex.03, 6 N·m", [2.35, 1.39, 10.56e5, 4.56e6, 0.54]),
    ("Ex.04, 8 N·m", [2.38, 1.54, 11.86e5, 4.07e6, 0.69]),
];

/// Rows by lap, each by the name of its column without the unit.
type Table = Vec<(String, BTreeMap<String, f64>)>;

fn table(text: &str) -> Table {
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').skip(1);
    let names: Vec<&str> = names.map(|name| name.split(" [").next().unwrap()).collect();
    lines
        .map(|line| {
            // names of laps may be quoted
            let (lap, rest) = match line.strip_prefix('"') {
                Some(rest) => rest.split_once("\",").unwrap(),
                None => line.split_once(',').unwrap(),
            };
            let numbers = rest.split(',').map(|n| n.parse().unwrap_or(f64::NAN));
            let names = names.iter().map(|&name| name.to_owned());
            (lap.to_owned(), names.zip(numbers).collect())
        })
        .collect()
}

fn example(name: &str) -> Table {
    let bench = files_of("pirdayr");
    bench.done(&format!("respond {name} -o out.csv --report out.svg"));
    let drawing = bench.text("out.svg");
    assert!(drawing.starts_with("<svg") && drawing.trim_end().ends_with("</svg>"));
    roxmltree::Document::parse(&drawing).unwrap();
    table(&bench.text("out.csv"))
}

#[test]
fn receptances_are_those_of_two_coupled_oscillators() {
    let table = example("figures-7-to-9-frf.toml");
    for (lap, row) in table.iter().step_by(97) {
        let (_, [m, c, k, k12, c12]) = TABLE_3.iter().find(|(name, _)| name == lap).unwrap();
        let omega = TAU * row["frequency"];
        let one = Complex64::new(k - omega * omega * m, omega * c);
        let other = one + 2.0 * Complex64::new(*k12, omega * c12);
        // x_b = F/2 (1/z₁ + 1/z₂), acceleration −ω² x_b
        let expected = -0.5 * omega * omega * (one.inv() + other.inv());
        let found = Complex64::new(row["b.y real"], row["b.y imaginary"]);
        let error = (found - expected).norm();
        assert!(error < 1e-9 * expected.norm(), "{lap} {omega}");
    }
}

#[test]
fn figure_10_is_the_same_at_every_load_and_stable() {
    let table = example("figure-10.toml");
    for (lap, [m, c, k, ..]) in TABLE_3 {
        for level in [1.0, 10.0, 100.0] {
            let rows = table.iter().filter(|(name, _)| name == lap);
            let rows = rows.map(|(_, row)| row).filter(|row| row["level"] == level);
            let amplitude = |row: &BTreeMap<String, f64>| row["b.y amplitude"];
            let highest = rows
                .clone()
                .max_by(|a, b| amplitude(a).total_cmp(&amplitude(b)));
            let highest = highest.unwrap();
            let mut each = rows.map(|row| (row["stable"], row["fold"]));
            assert!(each.all(|stable_and_fold| stable_and_fold == (1.0, 0.0)));
            let omega = (k / m).sqrt();
            close(TAU * highest["frequency"], omega, 1e-3);
            let expected = level / (2.0 * c * omega);
            close(highest["b.y amplitude"], expected, 0.02);
        }
    }
}

#[test]
fn free_vibration_is_the_sum_of_its_two_decaying_modes() {
    let table = example("figure-12.toml");
    for (lap, row) in table.iter().step_by(31) {
        let (_, [m, c, k, k12, c12]) = *TABLE_3.iter().find(|(name, _)| name == lap).unwrap();
        let time = row["time"];
        // ẋ_b(0) = v: half of it in each mode, x = v/2 Σ e^{−σt} sin ω_d t/ω_d
        let mode = |k: f64, c: f64| {
            let decay = c / (2.0 * m);
            let omega = (k / m - decay * decay).sqrt();
            0.05 * (-decay * time).exp() * (omega * time).sin() / omega
        };
        let expected = mode(k, c) + mode(k + 2.0 * k12, c + 2.0 * c12);
        // The step of an FMU errs by 10⁻⁶ rad a period of the fastest mode, some 1600 of them in 4 s.
        assert!((row["b.y"] - expected).abs() < 4e-7, "{lap} {time}");
    }
}

#[test]
fn a_softening_lap_stepped_down_jumps_where_its_curve_folds() {
    let curves = example("softening-levels.toml");
    let is_05 = |row: &&(String, BTreeMap<String, f64>)| row.1["level"] == 0.5;
    let folds: Vec<f64> = curves
        .iter()
        .filter(is_05)
        .filter(|(_, row)| row["fold"] == 1.0)
        .map(|(_, row)| row["frequency"])
        .collect();
    let stepped = example("softening-stepped.toml");
    for (_, row) in &stepped {
        let hz = row["frequency"];
        if folds.iter().any(|fold| (fold - hz).abs() < 0.3) {
            continue;
        }
        let near = curves
            .windows(2)
            .filter(|pair| pair[0].1["level"] == 0.5 && pair[1].1["level"] == 0.5)
            .filter(|pair| pair[0].1["stable"] == 1.0)
            .any(|pair| {
                let [one, other] = [0, 1].map(|n| pair[n].1["frequency"]);
                let share = (hz - one) / (other - one);
                let at = |n: usize| pair[n].1["relative.y amplitude"];
                let expected = at(0) + share * (at(1) - at(0));
                (0.0..=1.0).contains(&share)
                    && (row["relative.y amplitude"] / expected - 1.0).abs() < 0.01
            });
        assert!(near, "{hz}");
    }
}

#[test]
fn every_example_can_be_run_and_drawn() {
    let names = "figures-7-to-9-decay figure-11a figure-11b figure-11c softening-backbone";
    for name in names.split(' ') {
        assert!(!example(&format!("{name}.toml")).is_empty(), "{name}");
    }
}

const RESPOND: &str = "respond study.toml -o out.csv";

/// The study is refused, and no file is written.
fn refused(bench: &Bench, study: &str, fragments: &[&str]) {
    bench.write("study.toml", study);
    bench.refused(RESPOND, fragments);
}

fn study(kind: &str, rest: &str) -> String {
    format!(
        "method = \"respond\"\nkind = \"{kind}\"\nname = \"x\"\n{rest}\n[[lap]]\njoint = \"ex02.joint.json\"\n"
    )
}

#[test]
fn what_makes_no_sense_is_refused_with_file_and_key() {
    let bench = files_of("pirdayr");
    let band = "[frequency]\nfrom = 300\nto = 400\n";
    let balance = |rest: &str| study("harmonic-balance", rest);
    #[rustfmt::skip]
    let cases = [
        (balance(band), ["study.toml", "`load`"]),
        (balance(&format!("{band}[load]\non = \"b\"\n")), ["`load.amplitude`", "found nothing"]),
        (balance(&format!("{band}[load]\namplitude = [1, -2]\n")), ["`load.amplitude`", "-2"]),
        (balance("[frequency]\nfrom = 400\nto = 300\n[load]\namplitude = 1\n"), ["`frequency.to`: found 300 Hz", "direction = \"down\""]),
        (balance(&format!("{band}[load]\namplitude = 1\n[harmonics]\nhighest = 0\n")), ["`harmonics.highest`: found 0", "1 to"]),
        (balance(&format!("{band}lines = 10\n[load]\namplitude = 1\n")), ["`frequency.lines`", "chooses its own points"]),
        (balance(&format!("{band}[load]\namplitude = 1\ndof = \"theta\"\n")), ["`load.dof`", "theta"]),
        (balance(&format!("{band}[load]\namplitude = 1\n[start]\n\"a.y\" = 1\n")), ["`start`", "kind \"harmonic-balance\" has no use for it"]),
        (format!("motions = [\"c.y\"]\n{}", balance(&format!("{band}[load]\namplitude = 1\n"))), ["`motions`", "\"c.y\""]),
        (balance("frequencies = 3"), ["unknown field", "frequencies"]),
        (study("harmonics", ""), ["study.toml", "unknown variant"]),
        (study("backbone", "[response]\nfrom = 1e-3\nto = 1e-4\n"), ["`response.to`", "more than `response.from`"]),
        (study("constant-amplitude", &format!("{band}[load]\non = \"b\"\n[response]\nof = \"b.y\"\n")),
         ["`response.amplitude`", "found nothing"]),
        (study("free-decay", "[time]\nduration = 1\ninterval = 1e-3\n[start]\n\"b.omega\" = 1\n"), ["`start`", "b.omega"]),
        (study("free-decay", "[time]\nduration = 1\n[start]\n\"b.v\" = 1\n"), ["`time.interval`", "found nothing"]),
        (study("dwell", &format!("{band}[load]\namplitude = 1\n[time]\nduration = 1\ninterval = 1\n")), ["`frequency`", "`at` alone"]),
        (study("hysteresis", ""), ["`response`", "found nothing"]),
        (study("hysteresis", "[response]\nof = \"a.y\"\namplitude = 1e-4\n"), ["`response.of`", "relative motion"]),
        (study("hysteresis", "[response]\nfrom = 1e-4\nto = 1e-3\n"), ["`response.from`", "`amplitude` alone"]),
        (study("hysteresis", &format!("{band}[response]\namplitude = 1e-4\n")), ["`frequency`", "`at` alone"]),
        (study("hysteresis", "[response]\namplitude = -1e-4\n"), ["`response.amplitude`", "-0.0001"]),
    ];
    for (text, fragments) in cases {
        refused(&bench, &text, &fragments);
    }
    let text = study("linear", "[frequency]\nfrom = 1\nto = 2\n");
    let absent = text.replace("ex02", "ex99");
    refused(
        &bench,
        &absent,
        &["`lap[0].joint`: found \"ex99.joint.json\", which is not there"],
    );
    let none = text.replace("[[lap]]\njoint", "# ");
    refused(&bench, &none, &["`lap`", "at least one"]);
}

#[test]
fn a_softening_joint_that_lets_go_is_said_with_the_time() {
    let wide = "[time]\nduration = 1\ninterval = 1e-3\n[start]\n\"a.y\" = 0.05\n";
    let text = study("free-decay", wide).replace("ex02", "softening");
    let expected = ["not finite any more at", "softening"];
    refused(&files_of("pirdayr"), &text, &expected);
}

#[test]
fn what_belongs_to_assemblies_is_refused_beside_laps() {
    let bench = files_of("pirdayr");
    let study = study("linear", "[frequency]\nfrom = 1\nto = 2\n");
    bench.write("study.toml", study);
    for option in ["--joint x.joint.json", "--step 1", "--report x.pdf"] {
        let name = option.split(' ').next().unwrap();
        bench.fails(&format!("{RESPOND} {option}"), &[name]);
    }
}

/// Body a is released beyond the slip and turns there: as long as its slider sticks again, it swings about where the springs rest.
#[test]
fn a_decay_begins_with_the_turn_of_its_slider() {
    let bench = Bench::new();
    let (spring, slider, slip_force, start, speed) = (1e5, 1e6, 100.0, 1e-3, -0.05);
    let joint = format!(
        r#"{{ "format": "bolted-joint/1", "name": "slider",
        "joint": {{ "dofs": ["y"], "stiffness": [[{spring:e}]], "damping": [[0.0]],
          "friction": [{{ "dof": "y", "law": "jenkins", "stiffness": {slider:e}, "slip_force": {slip_force} }}] }},
        "bodies": {{ "a": {{ "inertia": [1.0], "stiffness": [0.0], "damping": [0.0] }},
                     "b": {{ "inertia": [1e12], "stiffness": [0.0], "damping": [0.0] }} }} }}"#
    );
    bench.write("slider.joint.json", joint);
    let rest = format!(
        "[time]\nduration = 1e-3\ninterval = 1e-4\nsteps_per_period = 200\n[start]\n\"a.y\" = {start}\n\"a.v\" = {speed}\n"
    );
    let text = study("free-decay", &rest).replace("ex02", "slider");
    bench.write("study.toml", text);
    bench.done("respond study.toml -o out.csv");
    let omega = f64::sqrt(spring + slider);
    let rest = (slider * start - slip_force) / (spring + slider);
    for (_, row) in table(&bench.text("out.csv")) {
        let phase = omega * row["time"];
        let expected = rest + (start - rest) * phase.cos() + speed / omega * phase.sin();
        let found = row["relative.y"];
        assert!(
            (found - expected).abs() < 1e-9 * start,
            "{found:e} {expected:e}"
        );
    }
}

/// What may slip sticks in small motion, and is a spring: H = 1/(k + k_T − mω²) of a body beside one that hardly moves.
#[test]
fn small_motion_keeps_the_springs_that_may_slip() {
    let (spring, slider) = (1e5, 1e6);
    for law in [
        r#""jenkins", "stiffness": 1e6, "slip_force": 100"#,
        r#""iwan", "stiffness": 1e6, "slip_force": 100, "exponent": -0.3, "ratio": 0.5"#,
        r#""valanis", "stiffness": 1e6, "slip_stiffness": 0, "slip_force": 100, "kappa": 0.5"#,
        r#""dahl", "stiffness": 1e6, "slip_force": 100"#,
    ] {
        let bench = Bench::new();
        let joint = format!(
            r#"{{ "format": "bolted-joint/1", "name": "slider",
            "joint": {{ "dofs": ["y"], "stiffness": [[{spring:e}]], "damping": [[0.0]],
              "friction": [{{ "dof": "y", "law": {law} }}] }},
            "bodies": {{ "a": {{ "inertia": [1.0], "stiffness": [0.0], "damping": [0.0] }},
                         "b": {{ "inertia": [1e12], "stiffness": [0.0], "damping": [0.0] }} }} }}"#
        );
        bench.write("slider.joint.json", joint);
        let rest = "[frequency]\nfrom = 10\nto = 300\nlines = 30\n[load]\non = \"a\"\n";
        let text = study("linear", rest).replace("ex02", "slider");
        bench.write("study.toml", text);
        bench.done("respond study.toml -o out.csv");
        for (_, row) in table(&bench.text("out.csv")) {
            let omega = std::f64::consts::TAU * row["frequency"];
            let expected = (spring + slider - omega * omega).recip().abs();
            let found = row["relative.y modulus"];
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{law}: {found:e} {expected:e}"
            );
        }
    }
}

/// A joint without bodies, with a slider: D = 4h(U − h/k), and no heat while it sticks.
#[test]
fn a_loop_has_the_heat_of_its_slider() {
    let bench = Bench::new();
    let joint = r#"{ "format": "bolted-joint/1", "name": "slider", "joint": {
        "dofs": ["y"], "stiffness": [[5e6]], "damping": [[0.0]],
        "friction": [{ "dof": "y", "law": "jenkins", "stiffness": 2e6, "slip_force": 300 }] } }"#;
    bench.write("slider.joint.json", joint);
    let levels = [1e-4, 3e-4, 6e-4];
    let text = study(
        "hysteresis",
        &format!("[response]\namplitude = {levels:?}\n"),
    );
    bench.write("study.toml", text.replace("ex02", "slider"));
    bench.done("respond study.toml -o out.csv --report out.svg");
    // 4 · 300 N · (U − 0.15 mm)
    let beside = ["heat 0 J", "heat 0.1800 J", "heat 0.5400 J"];
    has(&bench.text("out.svg"), &beside);
    let table = table(&bench.text("out.csv"));
    for level in levels {
        let mut of_level = table.iter().filter(|(_, row)| row["level"] == level);
        let (_, last) = of_level.next_back().unwrap();
        let expected = 4.0 * 300.0 * f64::max(level - 300.0 / 2e6, 0.0);
        assert!(
            (last["heat"] - expected).abs() <= 1e-12,
            "{last:?} {expected}"
        );
    }
}

/// Six laws with the same slip force: none loses more than dry friction, D = 4hU but for what sticks.
#[test]
fn the_laws_of_the_example_lose_no_more_than_dry_friction() {
    let bench = files_of("friction");
    bench.done("respond laws.toml -o laws.csv --report laws.svg");
    let table = table(&bench.text("laws.csv"));
    let heat = |name: &str| {
        let mut rows = table.iter().filter(|(lap, _)| lap == name);
        rows.next_back().unwrap().1["heat"]
    };
    let (h, u) = (4000.0, 6e-4);
    close(heat("dry"), 4.0 * h * (u - h / 4e9), 1e-12);
    close(heat("Jenkins"), 4.0 * h * (u - h / 1.5e7), 1e-12);
    // its slip force in slow motion is the static one
    let most = 4.0 * 1.5 * h * u;
    for (name, most) in [
        ("Iwan", heat("Jenkins")),
        ("Valanis", heat("dry")),
        ("Bouc–Wen", heat("dry")),
        ("LuGre", most),
    ] {
        assert!(heat(name) > 0.1 * most && heat(name) < most, "{name}");
    }
}

/// At small amplitudes all sticks; where all slips the slider's stiffness is lost and D = 4h(U − h/k) is left.
#[test]
fn a_backbone_of_a_joint_that_slips_falls() {
    let bench = files_of("friction");
    // the closed forms are those of one harmonic
    let one = "[harmonics]\nhighest = 1\n\n[response]";
    let study = bench.text("backbone.toml").replace("[response]", one);
    bench.write("backbone.toml", study);
    bench.done("respond backbone.toml -o out.csv --report out.svg");
    let table = table(&bench.text("out.csv"));
    let rows: Vec<_> = table.iter().filter(|(lap, _)| lap == "Jenkins").collect();
    let omega = |row: &BTreeMap<String, f64>| TAU * row["frequency"];
    // m/2 r̈ + (k/2 + k12) r with m = 1.5 kg, k = 8e5 N/m
    let (first, last) = (&rows[0].1, &rows[rows.len() - 1].1);
    close(omega(first), ((4e5 + 2e7) / 0.75_f64).sqrt(), 1e-6);
    let (u, k, h) = (last["relative.y amplitude"], 1.5e7, 4000.0);
    close(u, 1e-3, 1e-9);
    let angle = (1.0_f64 - 2.0 * h / (k * u)).acos();
    let stiffness = 4e5 + 5e6 + k / std::f64::consts::PI * (angle - 0.5 * (2.0 * angle).sin());
    close(omega(last), (stiffness / 0.75).sqrt(), 1e-5);
    let of_slider = 4.0 * h * (u - h / k) / (std::f64::consts::PI * omega(last) * u * u);
    let expected = (10.0 + 0.5 + of_slider) / (2.0 * 0.75 * omega(last));
    close(last["damping ratio"], expected, 1e-3);
}

#[test]
fn it_is_said_where_a_joint_moves_further_than_it_was_observed_at() {
    let bench = Bench::new();
    let joint = r#"{ "format": "bolted-joint/1", "name": "lap", "joint": {
        "dofs": ["y"], "stiffness": [[5e6]], "damping": [[2.0]],
        "higher": { "damping_quadratic": [1e6], "amplitude": [2e-4] } },
        "bodies": { "a": { "inertia": [1], "stiffness": [1e5], "damping": [0] },
                    "b": { "inertia": [1], "stiffness": [1e5], "damping": [0] } } }"#;
    bench.write("lap.joint.json", joint);
    let within = "[response]\nfrom = 1e-5\nto = 1.9e-4\n";
    let beyond = "[response]\nfrom = 1e-5\nto = 3e-4\n";
    let histories =
        |y: &str| format!("[time]\nduration = 0.01\ninterval = 1e-3\n[start]\n\"a.y\" = {y}\n");
    for (kind, rest, is_beyond) in [
        ("backbone", within.to_owned(), false),
        ("backbone", beyond.to_owned(), true),
        ("free-decay", histories("1.9e-4"), false),
        ("free-decay", histories("2.1e-4"), true),
        (
            "hysteresis",
            "[response]\namplitude = [1e-4, 3e-4]\n".to_owned(),
            true,
        ),
    ] {
        let text = study(kind, &rest).replace("ex02", "lap");
        bench.write("study.toml", text);
        let outcome = bench.done("respond study.toml -o out.csv");
        let says = outcome
            .stderr
            .contains("beyond the 2.000e-4 m that the joint was observed at");
        assert_eq!(says, is_beyond, "{kind}: {}", outcome.stderr);
    }
}
