//! `compare`: joints beside each other, and what cannot be compared.

use bolted_joint_testing::has;

use crate::bench::Bench;

const OVER_PRELOAD: &str = include_str!("../data/joint/over-preload.joint.json");
const TORQUES: &str = include_str!("../data/joint/torques.joint.json");
const TWO_BODIES: &str = include_str!("../data/joint/two-bodies.joint.json");
const JENKINS: &str = include_str!("../../examples/friction/jenkins.joint.json");
const IWAN: &str = include_str!("../../examples/friction/iwan.joint.json");

fn joint(k: f64, spread: f64) -> String {
    format!(
        r#"{{ "format": "bolted-joint/1", "name": "x",
  "joint": {{ "dofs": ["y"], "stiffness": [[{k}]], "damping": [[2]] }},
  "uncertainty": {{ "standard_deviation": {{ "stiffness": [[{spread}]], "damping": [[0.1]] }}, "basis": "made up",
    "correlation": {{ "unknowns": ["k_yy", "c_yy"], "matrix": [[1, 0], [0, 1]] }} }},
  "provenance": {{ "tool": "t", "version": "1", "method": "frf-decoupling", "model": "full" }} }}"#
    )
}

#[test]
fn differences_are_in_standard_deviations() {
    let bench = Bench::new();
    bench.write("new.json", joint(1e5, 300.0));
    bench.write("worn.json", joint(9e4, 400.0));
    let outcome = bench.done("compare new.json worn.json --plot o.html");
    has(
        &outcome.stdout,
        &[
            "joint 2: worn.json",
            "100000 ± 300",
            "-10.00 %",
            // 1e4/√(300² + 400²)
            "-20.0",
            "all 2 unknowns together: χ² = 400",
            "1 of 2 differences are beyond 1.96 standard deviations",
            "wrote o.html",
        ],
    );
    has(
        &bench.text("o.html"),
        &["90000(400)", "joint, in the order given"],
    );
    bench.done("compare new.json worn.json new.json --plot o.svg");
    assert!(bench.text("o.svg").starts_with("<svg"));
    let json = bench.done("compare new.json worn.json --json").json();
    assert_eq!(json["rows"][0]["name"], "k_yy");
    assert!((json["rows"][0]["deviations"][0].as_f64().unwrap() + 20.0).abs() < 1e-12);
    assert_eq!(json["together"][0]["unknowns"], 2);
    // every column keeps its place: the second table's joints are the same
    has(
        &bench.done("compare new.json new.json").stdout,
        &["+0.00 %", "0 of 2 differences"],
    );
}

#[test]
fn joints_over_the_preload_are_compared_at_each_or_at_one() {
    let bench = Bench::new();
    bench.write("a.json", OVER_PRELOAD);
    bench.write("b.json", OVER_PRELOAD.replace("900000.0", "810000.0"));
    bench.write("c.json", joint(6e5, 300.0));
    let outcome = bench.done("compare a.json b.json");
    has(
        &outcome.stdout,
        &["k_yy@25", "-10.00 %", "k_yy@10", "+0.00 %"],
    );
    has(&outcome.stderr, &["without deviations in both files"]);
    has(
        &bench.done("compare a.json c.json --preload 10").stdout,
        &["k_yy", "600000 ± 300"],
    );
    bench.refused(
        "compare a.json c.json",
        &[
            "c.json is constant, a.json depends on the preload",
            "--preload TORQUE",
        ],
    );
    bench.refused("compare a.json c.json --preload 100", &["a.json", "100"]);
    // terms and laws follow the preload too
    let hardening = |k3: &str| {
        let nominal = "\"nominal\": 10.0,";
        OVER_PRELOAD.replace(nominal, &format!("{nominal} \"cubic\": [[1e12], [{k3}]],"))
    };
    bench.write("k3.json", hardening("2e12"));
    bench.write("k3b.json", hardening("3e12"));
    has(
        &bench.done("compare k3.json k3b.json").stdout,
        &["k3_y@10", "k3_y@25", "+50.00 %"],
    );
    has(&bench.done("show k3.json").stdout, &["k3_y = 2e12 N/m³"]);
    bench.write("t.json", TORQUES);
    bench.refused("compare a.json t.json", &["degrees of freedom"]);
    bench.edit("b.json", "10.0, 25.0", "10.0, 30.0");
    bench.refused(
        "compare a.json b.json",
        &["a.json has the preloads [10.0, 25.0] N·m, b.json has [10.0, 30.0] N·m"],
    );
}

#[test]
fn joints_of_other_kinds_are_refused() {
    let bench = Bench::new();
    bench.write("y.json", joint(1e5, 300.0));
    bench.write("both.json", TWO_BODIES);
    bench.write("jenkins.json", JENKINS);
    bench.write("iwan.json", IWAN);
    bench.write("study.toml", "method = \"respond\"\n");
    #[rustfmt::skip]
    let cases = [
        ("compare y.json both.json", ["y.json has the degrees of freedom", "both.json has"]),
        ("compare jenkins.json iwan.json", ["jenkins on y", "iwan on y"]),
        ("compare y.json missing.json", ["missing.json", "cannot be read"]),
        ("compare y.json study.toml", ["study.toml: found a study of method \"respond\"", "expected a joint file"]),
        ("compare y.json y.json --plot o.pdf", ["--plot: found o.pdf", ".html or .svg"]),
    ];
    for (arguments, fragments) in cases {
        bench.refused(arguments, &fragments);
    }
    assert_eq!(bench.run("compare y.json").code, Some(2));
    // laws are compared by their parameters
    bench.write(
        "softer.json",
        JENKINS.replacen("\"slip_force\": ", "\"slip_force\": 1", 1),
    );
    has(
        &bench.done("compare jenkins.json softer.json").stdout,
        &["jenkins.slip_force_y", "jenkins.stiffness_y"],
    );
}

#[test]
fn no_probability_is_zero_and_what_may_be_zero_has_no_per_cent() {
    let bench = Bench::new();
    bench.write("new.json", joint(1e5, 300.0));
    bench.write("worn.json", joint(5e4, 300.0));
    let told = bench
        .done("compare new.json worn.json --plot o.html")
        .stdout;
    has(
        &told,
        &["exceeded by chance with a probability of less than 1e-10"],
    );
    has(
        &bench.text("o.html"),
        &["a probability of less than 10<sup>−10</sup>."],
    );
    let page_of = |first: f64, second: f64, said: &str| {
        let of = |k: f64| {
            format!(
                r#"{{"format": "bolted-joint/1", "name": "x", "joint": {{"dofs": ["y"], "stiffness": [[{k}]], "damping": [[2]]}}}}"#
            )
        };
        bench.write("one.json", of(first));
        bench.write("other.json", of(second));
        let outcome = bench.run("compare one.json other.json --plot o.html");
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert_eq!(
            outcome.stdout.contains(said),
            bench.text("o.html").contains(said)
        );
        (outcome.stdout, bench.text("o.html"))
    };
    let dash = "Where there is a dash, the first value cannot be told from zero";
    let (told, page) = page_of(0.1, 60.0, dash);
    assert!(told.contains(dash) && told.contains("  –"), "{told}");
    assert!(!told.contains("59900"), "{told}");
    assert!(page.contains(dash));
    let (told, _) = page_of(50.0, 60.0, dash);
    assert!(!told.contains(dash) && told.contains("+20.00 %"), "{told}");
}
