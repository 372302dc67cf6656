//! Laps from responses: where the result is not to be relied on the file says so, and every command that takes it.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY};

const FLAT: &str = include_str!("../data/backbones/brake-reuss-model-flat.csv");

/// A study of the relative motion; `more` is what it has beside the model.
fn study(terms: &str, more: &str) -> String {
    format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
         terms = [{terms}]\ncompare = false\n{more}"
    )
}

/// The backbone of a beam with friction, with what is stated of its noise.
fn of_backbone(terms: &str, known: &str) -> Bench {
    let bench = Bench::new();
    bench.write("run.csv", FLAT);
    let more = format!(
        "{known}[noise]\nfrequency = 0.002\ndamping = 0.1\n[[backbone]]\nfile = \"run.csv\"\n"
    );
    bench.write("study.toml", study(terms, &more));
    bench
}

const MASS: &str = "[known]\nm = 2.1107\n";

#[test]
fn a_law_that_has_nothing_to_do_with_the_data_is_not_to_be_relied_on() {
    let bench = of_backbone("", MASS);
    let reason = "times the stated noise";
    let outcome = bench.unusable(&format!("{IDENTIFY} --report o.html"), &[reason]);
    has(&outcome.stdout, &["wrote o.joint.json", "wrote o.html"]);
    assert_eq!(bench.json("o.joint.json")["status"]["usable"], false);
    has(&bench.text("o.html"), &["not to be relied on: ", reason]);
    let told = bench.run(&format!("{IDENTIFY} --json"));
    assert_eq!(told.code, Some(3));
    assert_eq!(told.json()["usable"], false);
    bench.fails("export o.joint.json -o o.fmu", &[reason, "--unusable"]);
    bench.done("export o.joint.json -o o.fmu --unusable");
}

/// A backbone without force tells ratios to the mass, and nothing else.
#[test]
fn a_mass_that_nothing_tells_is_not_to_be_relied_on() {
    let bench = of_backbone("\"micro-slip\"", "");
    bench.unusable(IDENTIFY, &["nothing tells the mass", "[known]"]);
}

#[test]
fn a_law_that_fits_may_be_relied_on() {
    let bench = of_backbone("\"micro-slip\"", MASS);
    bench.done(IDENTIFY);
    assert!(bench.json("o.joint.json")["status"].is_null());
    bench.done("export o.joint.json -o o.fmu --as lap");
}

/// How a decay went into the estimate is said in every place: sample by sample, or why not.
#[test]
fn how_decays_are_fitted_is_said() {
    let bench = Bench::new();
    let (rate, omega) = (3.0, 700.0_f64);
    // the sum of twelve numbers of a linear congruence is nearly normal
    let mut state = 1_u64;
    let mut unit = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut csv = "time_s,displacement_m\n".to_owned();
    for n in 0..3000 {
        let t = 2e-4 * f64::from(n);
        let noise = 1e-6 * ((0..12).map(|_| unit()).sum::<f64>() - 6.0);
        let u = 3e-4 * (-rate * t).exp() * (omega * t).cos() + noise;
        writeln!(csv, "{t:e},{u:e}").unwrap();
    }
    bench.write("decay.csv", csv);
    let decay = format!("{MASS}[[decay]]\nfile = \"decay.csv\"\n");
    for (more, told, basis) in [
        (
            "",
            "Decays are fitted sample by sample.",
            "decays sample by sample",
        ),
        (
            "band = [50, 170]\n",
            "Decays are fitted sample by sample.",
            "decays sample by sample",
        ),
        (
            "[noise]\nfrequency = 1e-4\ndamping = 0.01\n",
            "not sample by sample: [noise] states errors of frequencies and damping ratios",
            "decays as they are read ([noise] states",
        ),
    ] {
        bench.write("study.toml", study("", &format!("{decay}{more}")));
        let outcome = bench.done(&format!("{IDENTIFY} --report o.html"));
        has(&outcome.stdout, &[told]);
        has(&bench.text("o.html"), &[told]);
        let of_file = &bench.json("o.joint.json")["uncertainty"]["basis"];
        has(of_file.as_str().unwrap(), &[basis]);
        let json = bench.done(&format!("{IDENTIFY} --json")).json();
        has(json["of_decays"].as_str().unwrap(), &[told]);
    }
}

/// One fitted run tells nothing of how runs scatter about the model: the reason stands below the table.
#[test]
fn why_a_run_has_no_interval_is_said() {
    let (mass, stiffness, damping) = (1.0, 5e5, 20.0);
    let bench = Bench::new();
    let mut more = "harmonics = 1\n".to_owned();
    for (level, used) in [(1.0, "fit"), (2.0, "predict")] {
        let mut csv = "frequency_hz,force_n,displacement_m,phase_rad\n".to_owned();
        for n in 0..41 {
            let hz = 105.0 + 0.4 * f64::from(n);
            let omega = TAU * hz;
            let (real, imaginary) = (stiffness - mass * omega * omega, damping * omega);
            let size = level / f64::hypot(real, imaginary);
            writeln!(csv, "{hz},{level},{size:e},{:e}", -imaginary.atan2(real)).unwrap();
        }
        bench.write(&format!("{level}.csv"), csv);
        writeln!(more, "[[sine]]\nfile = \"{level}.csv\"\nuse = \"{used}\"").unwrap();
    }
    bench.write("study.toml", study("", &more));
    let reason = "one fitted run has a resonance, so that nothing tells how runs scatter";
    let outcome = bench.done(&format!("{IDENTIFY} --report o.html"));
    has(
        &outcome.stdout,
        &["No run has an interval: ", reason, "fit at least two"],
    );
    has(&bench.text("o.html"), &[reason]);
    let told = bench.done(&format!("{IDENTIFY} --json")).json();
    let last = &told["predictions"][1];
    assert!(last["interval_95"].is_null());
    has(last["no_interval"].as_str().unwrap(), &[reason]);
}
