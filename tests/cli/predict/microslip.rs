//! Interfaces that slip under the joint's motion.

use bolted_joint_testing::{close, has, near};
use serde_json::Value;

use super::{PREDICT, STUDY, bench, over_torque, predicted};
use crate::bench::{Bench, replaced};
use crate::examples::files_of;

/// A file of one even pressure of 2 MPa over 0.3 × 0.2 m, in 40 × 40 elements.
fn even_field() -> String {
    let n = 40;
    let mut field = "x_m,y_m,area_m2,pressure_Pa\n".to_owned();
    for k in 0..n * n {
        let [x, y] = [(0.3, k % n), (0.2, k / n)]
            .map(|(length, place)| length * (f64::from(place) + 0.5) / f64::from(n) - 0.5 * length);
        field += &format!("{x},{y},{},2e6\n", 0.06 / f64::from(n * n));
    }
    field
}

/// The study of an interface from a file that slips as `joint` says.
fn slipping(joint: &str) -> Bench {
    let interface = STUDY.find("[interface]").unwrap();
    let damping = STUDY.find("[damping]").unwrap();
    let study = format!(
        "{}[interface]\nfield = \"field.csv\"\n\n[joint]\n{joint}\n[microslip]\n{}",
        &STUDY[..interface],
        &STUDY[damping..]
    );
    let bench = bench(&study.replace("shear_strength = 1e8\n", ""));
    bench.write("field.csv", even_field());
    bench
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Alike patches are one contact of Mindlin: slip force μN, stiffness k_t A, heat in closed form. The exponent and the ratio are
/// those that SciPy's `least_squares` finds for it over the same amplitudes: 0.066 and 0.82.
#[test]
fn an_even_pressure_slips_as_one_contact_of_mindlin() {
    let bench = slipping("translation = \"x\"");
    let outcome = bench.done(PREDICT);
    has(&outcome.stdout, &["iwan_h_y", "y slips", "1600 patches"]);
    let file = bench.json("j.joint.json");
    let law = &file["joint"]["friction"][0];
    assert_eq!(
        (law["dof"].as_str(), law["law"].as_str()),
        (Some("y"), Some("iwan"))
    );
    let (slip_force, stiffness) = (number(&law["slip_force"]), number(&law["stiffness"]));
    // μ p A
    close(slip_force, 0.3 * 2e6 * 0.06, 1e-12);
    // K_T/A₀ = 0.461 · 6.200e11 N/m³ of Zhao's surfaces at 2 MPa
    close(stiffness, 0.461 * 6.200e11 * 0.06, 2e-3);
    near(number(&law["exponent"]), 0.066, 0.01);
    near(number(&law["ratio"]), 0.82, 0.05);
    // what slips is in no matrix
    assert_eq!(number(&file["joint"]["stiffness"][0][0]), 0.0);
    assert_eq!(number(&file["joint"]["damping"][0][0]), 0.0);

    // its loop: with s = U/δ, δ = 3h/(2k) and c = √(1 − s), the heat is ⅘ h δ (1 − c)³ (1 + 3c + c²)
    let end = 1.5 * slip_force / stiffness;
    let amplitude = 0.3 * end;
    bench.write(
        "loops.toml",
        format!(
            "method = \"respond\"\nkind = \"hysteresis\"\nname = \"loop\"\n[[lap]]\njoint = \"j.joint.json\"\n\
             [response]\nof = \"relative.y\"\namplitude = [{amplitude}]\n"
        ),
    );
    bench.done("respond loops.toml -o loops.csv");
    let rows = bench.text("loops.csv");
    let heat: f64 = rows
        .lines()
        .last()
        .unwrap()
        .split(',')
        .next_back()
        .unwrap()
        .parse()
        .unwrap();
    let c = 0.7_f64.sqrt();
    let expected = 0.8 * slip_force * end * (1.0 - c).powi(3) * (1.0 + c * (3.0 + c));
    close(heat, expected, 0.05);

    for version in ["3", "2"] {
        bench.done(&format!("export j.joint.json -o j.fmu --fmi {version}"));
        bench.done("check j.fmu");
    }
}

/// μ p A scatters as μ does: the joint file, `show` and `compare` have the deviation that is printed.
#[test]
fn the_scatter_of_the_slip_is_in_the_joint_file() {
    let bench = slipping("translation = \"x\"");
    bench.edit("study.toml", "friction = 0.3", "friction = \"0.3 ± 0.03\"");
    bench.done(PREDICT);
    let file = bench.json("j.joint.json");
    let law = &file["uncertainty"]["standard_deviation"]["friction"][0];
    assert_eq!(
        (law["dof"].as_str(), law["law"].as_str()),
        (Some("y"), Some("iwan"))
    );
    close(number(&law["slip_force"]), 0.1 * 0.3 * 2e6 * 0.06, 0.05);
    assert_eq!(number(&law["ratio"]), 0.0);
    has(
        &bench.done("show j.joint.json").stdout,
        &["slip_force 36000 ± 3"],
    );
    let rows = bench
        .done("compare j.joint.json j.joint.json --json")
        .json();
    let rows = rows["rows"].as_array().unwrap();
    let row = rows
        .iter()
        .find(|row| row["name"] == "iwan.slip_force_y")
        .unwrap();
    assert_eq!(row["standard_deviations"][0], law["slip_force"]);
}

/// A rotation about the normal slides each patch by its distance: ∫ μ p r dA slips, ∫ k_t r² dA resists.
#[test]
fn a_twist_slips_from_the_outside_in() {
    let bench = slipping("translation = \"x\"\nrotation = \"z\"");
    bench.done(PREDICT);
    let file = bench.json("j.joint.json");
    let laws = &file["joint"]["friction"];
    assert_eq!(laws[1]["dof"], "theta");
    let stiffness = number(&laws[0]["stiffness"]) / 0.06;
    // (a²+b²)/12 of the area a b; the elements count at their middles
    let second = 0.06 * (0.3_f64.powi(2) + 0.2_f64.powi(2)) / 12.0 * (1.0 - 1.0 / 1600.0);
    close(number(&laws[1]["stiffness"]), stiffness * second, 1e-9);
    // ∫ r dA over a rectangle: (1/12)(2 a b d + a³ asinh(b/a) + b³ asinh(a/b)), d its diagonal
    let (a, b) = (0.3_f64, 0.2_f64);
    let first =
        (2.0 * a * b * a.hypot(b) + a.powi(3) * (b / a).asinh() + b.powi(3) * (a / b).asinh())
            / 12.0;
    close(number(&laws[1]["slip_force"]), 0.3 * 2e6 * first, 1e-3);
}

/// Draws tell how well slip force and stiffness are known: the force as friction and preload are.
#[test]
fn the_slip_force_is_as_uncertain_as_the_friction() {
    let study = STUDY
        .replace("shear_strength = 1e8\n", "")
        .replace("friction = 0.3", "friction = \"0.3 ± 0.03\"")
        .replace(
            "translation = \"z\"\nrotation = \"-y\"",
            "translation = \"y\"\n[microslip]",
        );
    let bench = bench(&(study + "\n[uncertainty]\ndraws = 4000\n"));
    let found = bench.done(&format!("{PREDICT} --json")).json();
    let estimate = &found["uncertainty"]["estimates"]["iwan_h_y"];
    let slip = &found["states"][0]["slip"][0];
    // torque/(0.2 d) of four bolts, by friction
    let force = number(&slip["slip_force"]);
    close(force, 0.3 * 4.0 * 20.0 / (0.2 * 0.008), 2e-3);
    close(number(&estimate["standard_deviation"]) / force, 0.1, 0.04);
    let stiffness = &found["uncertainty"]["estimates"]["iwan_k_y"];
    assert_eq!(number(&stiffness["standard_deviation"]), 0.0);
    let notes = found["joint_file"]["provenance"]["notes"].to_string();
    has(
        &notes,
        &["y slips", "iwan_h_y = ", "Each motion slips by itself"],
    );
}

#[test]
#[rustfmt::skip]
fn what_cannot_slip_is_refused() {
    let refused = |study: &str, fragments: &[&str]| bench(study).refused(PREDICT, fragments);
    let with = |study: &str| study.replace("[damping]", "[microslip]\n[damping]");
    let smooth = STUDY.replace("shear_strength = 1e8\n", "");
    let along = |study: &str| replaced(study, "translation = \"z\"\nrotation = \"-y\"", "translation = \"x\"");
    refused(&with(&smooth), &["`joint.translation`", "\"z\"", "along the normal nothing slips"]);
    refused(&with(&along(STUDY)), &["`contact.shear_strength`", "100000000", "[microslip]"]);
    let wrong = with(&along(&smooth)).replace("[microslip]", "[microslip]\namplitudes = { from = 2e-6, to = 1e-6 }");
    refused(&wrong, &["`microslip.amplitudes`", "0.000002", "smaller to a larger"]);
    let aside = with(&along(&smooth)).replace("translation = \"x\"", "translation = \"x\"\nrotation = \"z\"\nreference = [0, 0.1]");
    refused(&aside, &["`joint.reference`", "the same way", "centre of the tangential stiffness"]);
    let layer = with(&along(&smooth)).replace("fractal-contact", "virtual-material").replace("friction = 0.3\n", "")
        .replace("[interface]", "[layer]\nthickness = [0.001, 0.001]\n[interface]").replace("poissons_ratio = 0.28", "poissons_ratio = 0.28\ndensity = 7800");
    refused(&layer, &["`microslip`", "fractal-contact"]);
}

/// Millimetres for metres: all that is asked for lies beyond Mindlin's δ = 3h/(2k), from which a contact slips as a whole.
#[test]
fn amplitudes_at_which_everything_slips_are_warned_of() {
    let bench = slipping("translation = \"x\"");
    let outcome = bench.done(PREDICT);
    assert!(!outcome.stderr.contains("slips from"), "{}", outcome.stderr);
    let law = &bench.json("j.joint.json")["joint"]["friction"][0];
    let end = 1.5 * number(&law["slip_force"]) / number(&law["stiffness"]);
    let given = "[microslip]\namplitudes = { from = 1e-3, to = 1 }\n";
    bench.edit("study.toml", "[microslip]\n", given);
    let outcome = bench.done(PREDICT);
    let from = format!("all of y slips from {end:.2e} m on");
    has(
        &outcome.stderr,
        &[&from, "microslip.amplitudes", "smaller amplitudes in m"],
    );
}

/// Over the torque each law is that of a study of this torque alone: slip forces in proportion, stiffness not.
#[test]
fn what_slips_has_its_stiffness_at_every_torque() {
    let along = |study: &str| {
        let study = study.replace("shear_strength = 1e8\n", "");
        let joint = "translation = \"z\"\nrotation = \"-y\"";
        replaced(&study, joint, "translation = \"y\"\n[microslip]")
    };
    let bench = bench(&along(&over_torque()));
    bench.done(PREDICT);
    let joint = &bench.json("j.joint.json")["joint"];
    assert!(joint["friction"].is_null());
    let table = &joint["over_preload"]["friction"];
    for (place, torque) in [5, 10, 15, 20, 25].into_iter().enumerate() {
        let alone = along(STUDY).replace("torque = 20\n", &format!("torque = {torque}\n"));
        let alone = &predicted(&alone)["joint"]["friction"][0];
        let own = &table[place][0];
        for key in ["slip_force", "stiffness", "exponent", "ratio"] {
            close(number(&own[key]), number(&alone[key]), 1e-9);
        }
        let slip_force = number(&table[3][0]["slip_force"]);
        close(
            number(&own["slip_force"]),
            slip_force * f64::from(torque) / 20.0,
            1e-9,
        );
    }
    let ratio = number(&table[1][0]["stiffness"]) / number(&table[3][0]["stiffness"]);
    assert!((0.5..0.6).contains(&ratio), "{ratio}");
    has(
        &bench.done("show j.joint.json").stdout,
        &["20 N·m: k_yy", "iwan on y"],
    );
    // for a preload that moves, and for one that stays
    for preload in ["", " --preload 12"] {
        bench.done(&format!("export j.joint.json -o j.fmu{preload}"));
        bench.done("check j.fmu");
    }
}

/// The example goes from a study to loops and to an FMU.
#[test]
fn the_example_slips() {
    let bench = files_of("predict-microslip");
    bench.done("predict study.toml -o lap.joint.json --report lap.html");
    has(
        &bench.text("lap.html"),
        &["<h2>Slip</h2>", "Heat of a cycle", "its law"],
    );
    bench.done("respond loops.toml -o loops.csv --report loops.html");
    bench.done("export lap.joint.json -o lap.fmu");
    bench.done("check lap.fmu");
    // and over the torque, for a bolt that loosens
    bench.done("predict over-torque.toml -o over-torque.joint.json");
    bench.done("export over-torque.joint.json -o over-torque.fmu");
    bench.done("check over-torque.fmu");
    // μ times the preload of the one bolt
    let file = bench.json("lap.joint.json");
    close(
        number(&file["joint"]["friction"][0]["slip_force"]),
        0.2 * 20_000.0,
        1e-4,
    );
}
