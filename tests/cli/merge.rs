//! Draws in parts: together they are what one machine makes, to the bit, and what does not belong together is refused.

use bolted_joint_testing::has;

use crate::bench::{Bench, replaced};

const FOUR_BOLTS: &str = include_str!("../data/studies/four-bolts.toml");

/// A study with few lines.
fn demo() -> Bench {
    let bench = Bench::new();
    bench.done("demo -o d --seed 3");
    bench.edit("d/study.toml", "to = 512", "to = 150");
    bench
}

/// Makes the draws of these numbers one part after the other, with one processor or with several.
fn parts(bench: &Bench, make: &str, numbers: &[&str]) -> String {
    let mut names = Vec::new();
    for (place, numbers) in numbers.iter().enumerate() {
        let name = format!("{numbers}.json");
        let mut command = bench.command(&format!("{make} --draws {numbers} -o {name}"));
        command.env("RAYON_NUM_THREADS", if place == 0 { "1" } else { "3" });
        assert!(command.output().unwrap().status.success(), "{numbers}");
        names.push(name);
    }
    names.join(" ")
}

#[test]
fn parts_of_a_bootstrap_are_the_whole_to_the_bit() {
    let bench = demo();
    let bootstrap = "identify d/study.toml --bootstrap 24 --seed 5";
    let whole = bench.done(&format!("{bootstrap} -o o.joint.json"));
    let names = parts(&bench, bootstrap, &["17..24", "0..5", "5..17"]);
    let merged = bench.done(&format!("merge d/study.toml {names} -o m.joint.json"));
    assert_eq!(bench.text("m.joint.json"), bench.text("o.joint.json"));
    assert_eq!(
        merged.stdout,
        whole.stdout.replace("o.joint.json", "m.joint.json")
    );
    has(
        &merged.stdout,
        &["24 draws of noise", "seed 5, 24 converged"],
    );
    // a draw is a few numbers: these are less than two kilobytes with all that they were made from
    assert!(bench.text("0..5.json").len() < 2000);
    has(
        &bench.done("show 5..17.json").stdout,
        &[
            "draws, as `merge` takes them",
            "5..17 of 24, seed 5",
            "k_thetatheta from",
            "next",
        ],
    );
}

#[test]
fn parts_of_a_bootstrap_with_an_error_budget_are_the_whole_to_the_bit() {
    let bench = demo();
    bench.edit("d/study.toml", "budget = \"none\"", "");
    let bootstrap = "identify d/study.toml --bootstrap 2 --no-rivals";
    let whole = bench.done(&format!("{bootstrap} -o o.joint.json"));
    has(
        &whole.stdout,
        &["2 draws of noise and of errors of the set-up"],
    );
    let names = parts(&bench, bootstrap, &["0..1", "1..2"]);
    bench.done(&format!(
        "merge d/study.toml {names} -o m.joint.json --no-rivals --report m.html"
    ));
    assert_eq!(bench.text("m.joint.json"), bench.text("o.joint.json"));
    has(&bench.text("m.html"), &["2 draws of noise and"]);
}

#[test]
fn parts_of_a_monte_carlo_simulation_are_the_whole_to_the_bit() {
    let bench = Bench::new();
    // some draws are refused
    let study = replaced(FOUR_BOLTS, "= 1.42", "= \"1.42 ± 0.02\"");
    let study = replaced(&study, "friction = 0.3", "friction = \"0.3 ± 0.1\"");
    bench.write(
        "study.toml",
        study + "\n[uncertainty]\ndraws = 1500\nseed = 4\n",
    );
    let whole = bench
        .done("predict study.toml -o o.joint.json --json")
        .json();
    assert!(whole["uncertainty"]["accepted"].as_u64() < Some(1500));
    // parts that are no whole batches
    let names = parts(
        &bench,
        "predict study.toml",
        &["0..1", "1..1100", "1100..1500"],
    );
    let merged = bench.done(&format!("merge study.toml {names} -o m.joint.json --json"));
    assert_eq!(bench.text("m.joint.json"), bench.text("o.joint.json"));
    let merged = merged.json();
    assert_eq!(merged["uncertainty"], whole["uncertainty"]);
    assert_eq!(merged["warnings"], whole["warnings"]);
}

#[test]
fn draws_that_do_not_belong_together_are_refused() {
    let bench = demo();
    let bootstrap = "identify d/study.toml --bootstrap 6";
    parts(&bench, bootstrap, &["0..2", "1..4", "4..6"]);
    let merge = |names: &str| format!("merge d/study.toml {names} -o m.joint.json");
    bench.refused(
        &merge("0..2.json 4..6.json"),
        &["the draws 2..4, expected all of 0..6"],
    );
    bench.refused(
        &merge("0..2.json 4..6.json 1..4.json"),
        &["1..4.json: found the draws 1..2, which 0..2.json has as well"],
    );
    bench.refused(
        &merge("d/study.toml"),
        &[
            "d/study.toml: found a study",
            "expected a file of draws",
            "`bolted-joint identify",
        ],
    );
    parts(&bench, &format!("{bootstrap} --seed 2"), &["2..4"]);
    bench.refused(
        &merge("0..2.json 2..4.json 4..6.json"),
        &["2..4.json: found draws with the seed 2, expected 1 as 0..2.json has it"],
    );
    parts(&bench, bootstrap, &["2..4"]);
    let all = "0..2.json 2..4.json 4..6.json";
    bench.done(&merge(all));
    let whole = bench.text("m.joint.json");
    // what was read off of a figure is not what was drawn
    bench.edit("d/study.toml", "to = 150", "to = 151");
    bench.refused(
        &merge(all),
        &[
            "0..2.json: found draws with the file study.toml (study, SHA-256",
            "as it is now",
        ],
    );
    bench.edit("d/study.toml", "to = 151", "to = 150");
    let modes = bench.text("d/a-modes.toml");
    bench.write("d/a-modes.toml", format!("{modes}\n# touched\n"));
    bench.refused(
        &merge(all),
        &["the file a-modes.toml (substructure a, SHA-256"],
    );
    bench.write("d/a-modes.toml", &modes);
    bench.done(&merge(all));
    assert_eq!(bench.text("m.joint.json"), whole);
    bench.fails(
        "show d/study.toml 0..2.json --plot x.svg",
        &["something to draw"],
    );
}

#[test]
fn draws_that_cannot_be_made_are_refused() {
    let bench = demo();
    for (options, said) in [
        (
            "--bootstrap 6 --draws 4..7",
            "found 4..7 of 6, expected numbers below",
        ),
        (
            "--bootstrap 6 --draws 4..6 --report o.html",
            "--report: found it, expected none beside --draws",
        ),
    ] {
        bench.refused(
            &format!("identify d/study.toml -o o.json {options}"),
            &[said],
        );
    }
    for options in [
        "--draws 0..2",
        "--bootstrap 6 --draws 2..2",
        "--bootstrap 6 --draws 2",
    ] {
        let outcome = bench.run(&format!("identify d/study.toml -o o.json {options}"));
        assert_eq!(outcome.code, Some(2), "{options}");
    }
    bench.write("four.toml", FOUR_BOLTS);
    bench.refused(
        "predict four.toml -o o.json --draws 0..2",
        &["a study with an uncertain value"],
    );
    let uncertain = replaced(FOUR_BOLTS, "= 1.42", "= \"1.42 ± 0.02\"");
    bench.write(
        "uncertain.toml",
        uncertain + "\n[uncertainty]\ndraws = 1500\n",
    );
    let outcome = bench.run("predict uncertain.toml -o o.json --draws 0..5000");
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    has(&outcome.stderr, &["the study's [uncertainty] states"]);
    assert!(
        !outcome.stderr.contains("--bootstrap"),
        "{}",
        outcome.stderr
    );
    bench.write("beam.toml", include_str!("../data/studies/two-layers.toml"));
    bench.refused(
        "predict beam.toml -o o.json --draws 0..2",
        &["--draws: found 0..2, expected none: all draws of a layered beam"],
    );
}
