//! Deviations beside values, masses that are known, and the ground: what is read, and what is refused.

use super::{BEAMS, OF_OTHER_BODIES, beams};
use crate::bench::IDENTIFY;
use bolted_joint_testing::has;

#[test]
fn deviations_stand_beside_values() {
    let bench = beams();
    #[rustfmt::skip]
    let edits = [
        ("youngs_modulus = 7e10", "youngs_modulus = \"7e10 ± 7e8\""),
        ("density = 2700", "density = \"2700 +/- 0.5 %\""),
        ("x = 0.015", "x = \"0.015 ± 2e-4\", mass = \"0.001 ± 1e-4\", inertia = \"1e-7 ± 50 %\""),
        ("\"21:+Y\" = 0.17", "\"21:+Y\" = \"0.17 ± 0.0005\""),
        ("frf = \"c.uff\"", "frf = \"c.uff\"\naccelerometer_mass = \"0 ± 1e-4\""),
        // up to 200 Hz these bodies, which are not those of the assembly, contradict what is stated
        ("to = 200", "to = 80"),
    ];
    for (from, to) in edits {
        bench.edit("study.toml", from, to);
    }
    let budget = &bench.unusable(&format!("{IDENTIFY} --json"), &[]).json()["budget"];
    let causes = budget["causes"].as_array().unwrap();
    #[rustfmt::skip]
    let stated = [
        ("Young's modulus of B", 0.01), ("density of B", 0.005), ("position of the joint on B", 2e-4),
        ("mass at the joint on B", 1e-4), ("moment of inertia at the joint on B", 5e-8),
        ("position of 21:+Y on the assembly", 5e-4), ("mass of the accelerometer on the assembly", 1e-4),
    ];
    // under budget = "none" nothing else takes part
    assert_eq!(causes.len(), stated.len(), "{causes:?}");
    for (cause, prior) in stated {
        let found = causes.iter().find(|found| found["cause"] == cause).unwrap();
        assert!(found["contradicted"].is_null(), "{found}");
        assert!(
            (found["prior"].as_f64().unwrap() / prior - 1.0).abs() < 1e-12,
            "{found}"
        );
    }
}

#[test]
fn deviations_that_have_no_meaning_are_refused() {
    let bench = beams();
    let none = "a number alone: the error budget has no cause for it";
    #[rustfmt::skip]
    let cases = [
        ("length = 0.2", "length = \"0.2 ± 0.001\"", ["`b.beam.length`: found 0.2 ± 0.001", none]),
        ("width = 0.02", "width = \"0.02 ± 1 %\"", ["`b.beam.width`: found 0.02 ± 1 %", none]),
        ("height = 0.006", "height = \"0.006 +/- 1e-5\"", ["`b.beam.height`: found 0.006 ± 0.00001", none]),
        ("theory = \"euler-bernoulli\"", "poissons_ratio = \"0.3 ± 0.01\"", ["`b.beam.poissons_ratio`: found 0.3 ± 0.01", none]),
        ("damping_ratio = [0, 0, 0.01]", "loss_factor = \"0.01 ± 0.001\"", ["`b.beam.loss_factor`: found 0.01 ± 0.001", none]),
        ("spacing = 0.015", "spacing = \"0.015 ± 0.001\"", ["`a.joint.theta.spacing`: found 0.015 ± 0.001", none]),
        ("density = 2700", "density = \"2700 ± -10\"", ["line 8, column", "standard deviation is negative or not finite"]),
        ("density = 2700", "density = \"2700 ± ten\"", ["line 8, column", "\"ten\" is no number"]),
        ("density = 2700", "density = \"2700 ± 10 g\"", ["line 8, column", "in the key's SI unit, which is not written"]),
        ("density = 2700", "density = \"2700\"", ["line 8, column", "expected a number, or a text such as"]),
        ("x = 0.015", "x = \"15 ± 0.1\"", ["`b.joint.x`: found 15", "a position on the beam"]),
        ("x = 0.015", "x = 0.015, mass = -0.01", ["`b.joint.mass`: found -0.01", "from 0 to 100 in kg"]),
        ("x = 0.015", "x = 0.015, mass = \"1e3 ± 1\"", ["`b.joint.mass`: found 1000", "from 0 to 100 in kg"]),
        ("x = 0.015", "x = 0.015, inertia = nan", ["`b.joint.inertia`: found NaN", "kg·m²"]),
        ("modal = \"a.toml\"", "modal = \"a.toml\"\naccelerometer_mass = 0.001", ["`a.accelerometer_mass`: found a mass", "beside `frf` only"]),
        ("frf = \"c.uff\"", "frf = \"c.uff\"\naccelerometer_mass = 5", ["`assembly.accelerometer_mass`: found 5", "from 0 to 1 in kg"]),
        ("[b]\n", "[b]\nground = true\n", ["`b.ground`: found true", "the ground as `a`"]),
        ("[a]\n", "[a]\nground = true\n", ["`a`: found ground = true and modal and joint", "`b.joint` says where"]),
        ("joint = { x = 0.015 }\n", "", ["`b.joint`: found nothing", "the joint's place on this structure"]),
        ("[noise]", "[budget]\njoint_inertia = -1\n[noise]", ["`budget.joint_inertia`: found -1", "kg·m²"]),
        ("[noise]", "[budget]\ngain = 5\n[noise]", ["`budget.gain`: found 5", "0.05 is 5 %"]),
    ];
    let text = BEAMS.replace("budget = \"none\"", "#");
    bench.refused_edits(IDENTIFY, ("study.toml", &text), &cases);
}

#[test]
fn an_inertia_needs_a_rotation_that_carries_it() {
    let bench = beams();
    let model = ("model = \"full\"", "model = \"translation\"");
    let on_b = ("x = 0.015", "x = 0.015, inertia = 1e-6");
    let text = BEAMS.replace(model.0, model.1).replace(on_b.0, on_b.1);
    bench.write("study.toml", text);
    bench.refused(
        IDENTIFY,
        &[
            "`b.joint.inertia`: found 0.000001",
            "model \"diagonal\" or \"full\"",
        ],
    );
    let on_a = "spacing = 0.015 }, inertia = 1e-6 }\nsection = { width = 0.02, height = 0.006, youngs_modulus = 7e10 }";
    bench.write("study.toml", BEAMS.replace("spacing = 0.015 } }", on_a));
    bench.refused(
        IDENTIFY,
        &[
            "`a.joint.inertia`: found 0.000001",
            "none beside a `section`",
        ],
    );
    let deviates = "spacing = 0.015 } }\nsection = { width = \"0.02 ± 1 %\", height = 0.006, youngs_modulus = \"7e10 ± 5 %\" }";
    bench.write("study.toml", BEAMS.replace("spacing = 0.015 } }", deviates));
    bench.refused(
        IDENTIFY,
        &["`a.section.width`: found 0.02 ± 1 %", "has no cause for it"],
    );
}

#[test]
fn an_accelerometer_is_taken_out_only_where_its_drive_point_was_measured() {
    let bench = beams();
    let one = "points = [\"21:+Y\", \"22:+Y\"]\naccelerometer_mass = 0.001";
    bench.edit("study.toml", "points = [\"21:+Y\", \"22:+Y\"]", one);
    bench.unusable(IDENTIFY, &[OF_OTHER_BODIES]);
    // the second block of the file is that of 22 at 21, or 21 at 22: without the drive points nothing can be taken out
    let table = "frequency [Hz],21:+Y/22:+Y real,21:+Y/22:+Y imaginary\n";
    let lines = (5..40).map(|hz| format!("{hz},1e-6,-1e-7\n"));
    bench.write("c.csv", table.to_owned() + &lines.collect::<String>());
    bench.edit(
        "study.toml",
        "frf = \"c.uff\"",
        "frf = \"c.csv\"\nquantity = \"receptance\"",
    );
    bench.refused(
        IDENTIFY,
        &[
            "c.csv: found no function of 21:+Y at 21:+Y",
            "`accelerometer_mass` = 0.001 kg",
        ],
    );
}

#[test]
fn rivals_can_be_left_out() {
    let bench = beams();
    let said = "joint models are not compared: the study or the command line says so";
    let outcome = bench.unusable(
        &format!("{IDENTIFY} --no-rivals --report o.html"),
        &[OF_OTHER_BODIES],
    );
    has(&outcome.stdout, &[said]);
    has(
        &bench.text("o.html"),
        &["The joint models are not compared: the study or the command line says so."],
    );
    let with = bench.unusable(IDENTIFY, &[OF_OTHER_BODIES]);
    assert!(!with.stdout.contains("not compared"), "{}", with.stdout);
    bench.edit(
        "study.toml",
        "model = \"full\"",
        "model = \"full\"\nrivals = false",
    );
    let without = bench
        .unusable(&format!("{IDENTIFY} --json"), &[OF_OTHER_BODIES])
        .json();
    assert!(without["models"].is_null(), "{without}");
    assert_eq!(
        without["models_not_compared"],
        "the study or the command line says so"
    );
}
