//! Studies that are wrong: each fault is named by file and key or line, with what was found and expected.

mod bolts;
mod stated;
mod values;

use crate::bench::{Bench, IDENTIFY, PNG};
use crate::rig;
use bolted_joint_testing::has;

/// A modal substructure and a computed beam, as in the demo.
const BEAMS: &str = include_str!("../../data/studies/beams.toml");

const MODES: &str = r#"points = ["1:+Y", "2:+Y", "3:+Y"]
[[mode]]
frequency_hz = 40.0
damping_ratio = 0.01
shape = [[4.0, 0.0], [3.6, 0.0], [3.3, 0.0]]
"#;

fn beams() -> Bench {
    let bench = rig::ready();
    bench.write("study.toml", BEAMS);
    bench.write("a.toml", MODES);
    bench
}

/// Why nothing comes of these studies that anyone may rely on: the beams are others than the bodies that the rig measures.
const OF_OTHER_BODIES: &str = "% off the model";

#[test]
fn the_study_that_the_others_are_made_from_is_right() {
    let outcome = beams().unusable(IDENTIFY, &[OF_OTHER_BODIES]);
    has(&outcome.stdout, &["wrote o.joint.json"]);
}

#[test]
fn what_is_no_study_is_said_to_be_none() {
    let bench = beams();
    let cut = BEAMS.find(", width").unwrap();
    bench.refused(
        "identify missing.toml -o o.joint.json",
        &["missing.toml: cannot be read", "check the path"],
    );
    #[rustfmt::skip]
    let cases = [
        (b"".as_slice(), ["found an empty file", "expected a study (TOML)"]),
        (b" \n\t\n", ["found an empty file", "expected a study (TOML)"]),
        (PNG, ["found binary data (byte 0)", "expected a study (TOML)"]),
        (b"method = \"frf\0\"", ["found binary data (byte 13)", "UTF-8"]),
        (BEAMS.split_at(cut).0.as_bytes(), ["line 8, column", "expected `}`"]),
        (b"{ \"method\": 1 }", ["found a JSON file, expected a study (TOML)", "check the path"]),
        (b"[\"method\"]", ["found a list, as in JSON, expected a study (TOML)", "check the path"]),
        (b"[a]\nbeam = 1\n", ["`method`: found nothing", "such as method = \"frf-decoupling\""]),
        (b"method = 1\nmethod = 2\n", ["line 2, column 1", "duplicate key"]),
    ];
    bench.refused_contents(IDENTIFY, "study.toml", &cases);
}

#[test]
fn keys_that_do_not_belong_are_named_with_their_line() {
    let bench = beams();
    #[rustfmt::skip]
    let cases = [
        ("name =", "nmae =", ["line 3, column 1", "unknown field `nmae`"]),
        ("modal =", "modes =", ["line 5, column 1", "unknown field `modes`"]),
        ("spacing =", "spacng =", ["line 6, column", "unknown field `spacng`"]),
        ("length =", "lenght =", ["line 8, column", "unknown field `lenght`"]),
        ("{ x =", "{ z =", ["line 9, column", "unknown field `z`"]),
        ("[assembly]", "[assembled]", ["line 11, column", "unknown field `assembled`"]),
        ("frf =", "uff =", ["line 12, column 1", "unknown field `uff`"]),
        ("model =", "kind =", ["line 15, column 1", "unknown field `kind`"]),
        ("from =", "form =", ["line 17, column 1", "unknown field `form`"]),
        ("yy =", "xx =", ["line 20, column 1", "unknown field `xx`"]),
        ("relative =", "sigma =", ["line 22, column 1", "unknown field `sigma`"]),
        ("a = { inertia", "c = { inertia", ["line 24, column 1", "unknown field `c`"]),
        ("a = { inertia", "a = { mass", ["line 24, column", "unknown field `mass`"]),
    ];
    let cases = cases.map(|(from, to, [one, two])| (from, to, [one, two, "expected"]));
    bench.refused_edits(IDENTIFY, ("study.toml", BEAMS), &cases);
}

#[test]
fn missing_keys_and_wrong_types_are_named_with_their_line() {
    let bench = beams();
    #[rustfmt::skip]
    let cases = [
        ("name = \"beams\"\n", "", ["line 1", "missing field `name`"]),
        ("[joint]\nmodel = \"full\"\n", "", ["line 1", "missing field `joint`"]),
        ("model = \"full\"\n", "", ["line 14", "missing field `model`"]),
        ("frf = \"c.uff\"\n", "", ["line 11", "missing field `frf`"]),
        (", spacing = 0.015", "", ["line 6", "missing field `spacing`"]),
        ("density = 2700, ", "", ["line 8", "missing field `density`"]),
        ("name = \"beams\"", "name = 3", ["line 3, column 8", "expected a text"]),
        ("length = 0.2", "length = \"0.2\"", ["line 8", "expected a number, or a text such as"]),
        ("from = 5", "from = \"5 Hz\"", ["line 17", "\"5 Hz\""]),
        ("[[50, 60]]", "[50, 60]", ["line 20", "expected an array of length 2"]),
        ("[[50, 60]]", "\"mean\"", ["line 20", "expected \"automatic\" or \"median\""]),
        ("[bands]\nyy = [[50, 60]]\n", "[start]\nstiffness = [[1]]\n", ["line 19", "missing field `damping`"]),
        ("[0, 0, 0.01] }", "\"low\" }", ["line 8", "expected a number or a list of numbers"]),
        ("\"frf-decoupling\"", "\"guess\"", ["line 1, column 10", "`frf-decoupling`"]),
        ("\"full\"", "\"cross\"", ["line 15, column 9", "expected one of `translation`, `diagonal`, `full`"]),
        ("\"free-free\"", "\"free\"", ["line 8", "`fixed-free`"]),
        ("\"euler-bernoulli\"", "\"bending\"", ["line 8", "`timoshenko`"]),
        ("y = \"2:+Y\"", "y = \"2+Y\"", ["line 6", "such as \"11:+Y\""]),
        ("points = [\"21:+Y\"", "points = [\"21:+W\"", ["line 13", "X, Y, Z, RX, RY or RZ"]),
        ("\"21:+Y\" = 0.17", "\"x\" = 0.17", ["line 10", "NODE:DIRECTION"]),
        ("[\"3:+Y\", \"2:+Y\", \"1:+Y\"]", "[\"3:+Y\", \"1:+Y\"]", ["a.joint.theta.points", "expected three points"]),
    ];
    bench.refused_edits(IDENTIFY, ("study.toml", BEAMS), &cases);
}
