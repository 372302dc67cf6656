//! Studies that are wrong: each fault is named by file and key or line, with what was found and expected.

use crate::bench::{Bench, PNG, replaced};
use crate::rig;

/// A modal substructure and a computed beam, as in the demo.
const BEAMS: &str = r#"method = "frf-decoupling"
name = "beams"
[a]
modal = "a.toml"
joint = { y = "2:+Y", theta = { points = ["3:+Y", "2:+Y", "1:+Y"], spacing = 0.015 } }
[b]
beam = { length = 0.2, width = 0.02, height = 0.006, youngs_modulus = 7e10, density = 2700, boundary = "free-free", damping_ratio = [0, 0, 0.01] }
joint = { x = 0.015 }
points = { "21:+Y" = 0.17, "22:+Y" = 0.2 }
[assembly]
frf = "c.uff"
points = ["21:+Y", "22:+Y"]
[joint]
model = "full"
[frequency]
from = 5
to = 200
[bands]
yy = [[50, 60]]
[noise]
relative = 0.01
[bodies]
a = { inertia = [1, 2], stiffness = [0, 0], damping = [0, 0] }
b = { inertia = [1, 2], stiffness = [0, 0], damping = [0, 0] }
"#;

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

const IDENTIFY: [&str; 4] = ["identify", "study.toml", "-o", "o.joint.json"];

#[test]
fn the_study_that_the_others_are_made_from_is_right() {
    let outcome = beams().run(&IDENTIFY);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

#[test]
fn what_is_no_study_is_said_to_be_none() {
    let bench = beams();
    let cut = BEAMS.find(", width").unwrap();
    bench.refused(
        &["identify", "missing.toml", "-o", "o.joint.json"],
        &["missing.toml: cannot be read", "check the path"],
    );
    for (contents, fragments) in [
        (
            b"".as_slice(),
            ["found an empty file", "expected a study (TOML)"],
        ),
        (
            b" \n\t\n",
            ["found an empty file", "expected a study (TOML)"],
        ),
        (
            PNG,
            ["found binary data (byte 0)", "expected a study (TOML)"],
        ),
        (
            b"method = \"frf\0\"",
            ["found binary data (byte 13)", "UTF-8"],
        ),
        (
            BEAMS.split_at(cut).0.as_bytes(),
            ["line 7, column", "expected `}`"],
        ),
        (
            b"{ \"method\": 1 }",
            ["line 1, column 1", "{ \"method\": 1 }"],
        ),
        (
            b"method = 1\nmethod = 2\n",
            ["line 2, column 1", "duplicate key"],
        ),
    ] {
        bench.write("study.toml", contents);
        let [one, two] = fragments;
        bench.refused(&IDENTIFY, &["study.toml: ", one, two]);
    }
}

#[test]
fn keys_that_do_not_belong_are_named_with_their_line() {
    let bench = beams();
    for (from, to, fragments) in [
        (
            "name =",
            "nmae =",
            ["line 2, column 1", "unknown field `nmae`"],
        ),
        (
            "modal =",
            "modes =",
            ["line 4, column 1", "unknown field `modes`"],
        ),
        (
            "spacing =",
            "spacng =",
            ["line 5, column", "unknown field `spacng`"],
        ),
        (
            "length =",
            "lenght =",
            ["line 7, column", "unknown field `lenght`"],
        ),
        ("{ x =", "{ z =", ["line 8, column", "unknown field `z`"]),
        (
            "[assembly]",
            "[assembled]",
            ["line 10, column", "unknown field `assembled`"],
        ),
        (
            "frf =",
            "uff =",
            ["line 11, column 1", "unknown field `uff`"],
        ),
        (
            "model =",
            "kind =",
            ["line 14, column 1", "unknown field `kind`"],
        ),
        (
            "from =",
            "form =",
            ["line 16, column 1", "unknown field `form`"],
        ),
        ("yy =", "xx =", ["line 19, column 1", "unknown field `xx`"]),
        (
            "relative =",
            "sigma =",
            ["line 21, column 1", "unknown field `sigma`"],
        ),
        (
            "a = { inertia",
            "c = { inertia",
            ["line 23, column 1", "unknown field `c`"],
        ),
        (
            "a = { inertia",
            "a = { mass",
            ["line 23, column", "unknown field `mass`"],
        ),
    ] {
        bench.write("study.toml", replaced(BEAMS, from, to));
        let [one, two] = fragments;
        bench.refused(&IDENTIFY, &["study.toml: ", one, two, "expected"]);
    }
}

#[test]
fn missing_keys_and_wrong_types_are_named_with_their_line() {
    let bench = beams();
    for (from, to, fragments) in [
        ("name = \"beams\"\n", "", ["line 1", "missing field `name`"]),
        (
            "[joint]\nmodel = \"full\"\n",
            "",
            ["line 1", "missing field `joint`"],
        ),
        (
            "model = \"full\"\n",
            "",
            ["line 13", "missing field `model`"],
        ),
        ("frf = \"c.uff\"\n", "", ["line 10", "missing field `frf`"]),
        (
            ", spacing = 0.015",
            "",
            ["line 5", "missing field `spacing`"],
        ),
        (
            "density = 2700, ",
            "",
            ["line 7", "missing field `density`"],
        ),
        (
            "name = \"beams\"",
            "name = 3",
            ["line 2, column 8", "expected a string"],
        ),
        (
            "length = 0.2",
            "length = \"0.2\"",
            ["line 7", "expected f64"],
        ),
        ("from = 5", "from = \"5 Hz\"", ["line 16", "\"5 Hz\""]),
        (
            "[[50, 60]]",
            "[50, 60]",
            ["line 19", "expected an array of length 2"],
        ),
        (
            "[0, 0, 0.01] }",
            "\"low\" }",
            ["line 7", "expected a number or a list of numbers"],
        ),
        (
            "\"frf-decoupling\"",
            "\"guess\"",
            ["line 1, column 10", "expected `frf-decoupling`"],
        ),
        (
            "\"full\"",
            "\"cross\"",
            [
                "line 14, column 9",
                "expected one of `translation`, `diagonal`, `full`",
            ],
        ),
        ("\"free-free\"", "\"free\"", ["line 7", "`fixed-free`"]),
        (
            "y = \"2:+Y\"",
            "y = \"2+Y\"",
            ["line 5", "such as \"11:+Y\""],
        ),
        (
            "points = [\"21:+Y\"",
            "points = [\"21:+W\"",
            ["line 12", "X, Y, Z, RX, RY or RZ"],
        ),
        (
            "\"21:+Y\" = 0.17",
            "\"x\" = 0.17",
            ["line 9", "NODE:DIRECTION"],
        ),
        (
            "[\"3:+Y\", \"2:+Y\", \"1:+Y\"]",
            "[\"3:+Y\", \"1:+Y\"]",
            ["a.joint.theta.points", "expected three points"],
        ),
    ] {
        bench.write("study.toml", replaced(BEAMS, from, to));
        let [one, two] = fragments;
        bench.refused(&IDENTIFY, &["study.toml: ", one, two]);
    }
}

#[test]
fn values_that_cannot_be_are_named_by_key() {
    let bench = beams();
    for (from, to, fragments) in [
        (
            "\"beams\"",
            "\" \"",
            ["`name`: found \" \"", "one line of text"],
        ),
        (
            "\"beams\"",
            "\"a\\nb\"",
            ["`name`: found \"a\\nb\"", "one line of text"],
        ),
        (
            ", theta = { points = [\"3:+Y\", \"2:+Y\", \"1:+Y\"], spacing = 0.015 }",
            "",
            [
                "`a.joint.theta`: found nothing",
                "which joint model \"full\" needs",
            ],
        ),
        (
            "y = \"2:+Y\"",
            "y = \"1:+Y\"",
            [
                "`a.joint.theta.points`: found 2:+Y in the middle",
                "expected the joint's own translation 1:+Y",
            ],
        ),
        (
            "spacing = 0.015",
            "spacing = 0",
            ["`a.joint.theta.spacing`: found 0", "in m"],
        ),
        (
            "spacing = 0.015",
            "spacing = -1",
            ["`a.joint.theta.spacing`: found -1", "in m"],
        ),
        (
            "modal = \"a.toml\"",
            "",
            [
                "`a`: found no source",
                "exactly one of `frf`, `modal` and `beam`",
            ],
        ),
        (
            "modal = \"a.toml\"",
            "modal = \"a.toml\"\nfrf = \"a.uff\"",
            ["`a`: found frf and modal", "exactly one"],
        ),
        (
            "modal = \"a.toml\"",
            "modal = \"a.toml\"\nquantity = \"mobility\"",
            ["`a.quantity`", "beside `frf` only"],
        ),
        (
            "modal = \"a.toml\"",
            "modal = \"a.toml\"\npoints = { \"1:+Y\" = 0.1 }",
            ["`a.points`", "beside `beam` only"],
        ),
        (
            "beam = {",
            "quantity = \"mobility\"\nbeam = {",
            ["`b.quantity`", "beside `frf` only"],
        ),
        (
            "{ x = 0.015 }",
            "{ y = \"21:+Y\" }",
            ["`b.joint`: found y", "{ x = "],
        ),
        ("{ x = 0.015 }", "{}", ["`b.joint`: found no key", "{ x = "]),
        (
            "{ y = \"2:+Y\", theta",
            "{ x = 0.1, theta",
            ["`a.joint`: found x and theta", "{ y = "],
        ),
        (
            "{ x = 0.015 }",
            "{ x = 0.3 }",
            ["`b.joint.x`: found 0.3", "from 0 to 0.2 m"],
        ),
        (
            "\"21:+Y\" = 0.17",
            "\"21:+Y\" = -0.1",
            ["`b.points.\"21:+Y\"`: found -0.1", "from 0 to 0.2 m"],
        ),
        (
            "\"21:+Y\" = 0.17",
            "\"21:+Y\" = nan",
            ["`b.points.\"21:+Y\"`: found NaN", "from 0 to 0.2 m"],
        ),
        (
            "\"21:+Y\" = 0.17, ",
            "",
            ["`b.points`: found no position of 21:+Y", "\"21:+Y\" = "],
        ),
        (
            "height = 0.006",
            "height = -0.006",
            ["beam.height: found -0.006", "expected a positive number"],
        ),
        (
            "length = 0.2",
            "length = 0",
            ["beam.length: found 0", "expected a positive number"],
        ),
        (
            "density = 2700",
            "density = inf",
            ["beam.density: found inf", "expected a positive number"],
        ),
        (
            "[0, 0, 0.01] }",
            "[] }",
            [
                "beam.damping_ratio: found an empty list",
                "expected one number",
            ],
        ),
        (
            "[0, 0, 0.01] }",
            "-0.1 }",
            ["beam.damping_ratio: found -0.1", "not negative"],
        ),
        (
            "[0, 0, 0.01] }",
            "0.1, loss_factor = 0.1 }",
            [
                "`b.beam`: found both damping_ratio and loss_factor",
                "exactly one",
            ],
        ),
        (
            ", damping_ratio = [0, 0, 0.01] }",
            " }",
            [
                "`b.beam`: found neither damping_ratio nor loss_factor",
                "exactly one",
            ],
        ),
        (
            "points = [\"21:+Y\", \"22:+Y\"]",
            "points = []",
            [
                "`assembly.points`: found an empty list",
                "three for the best result",
            ],
        ),
        (
            "points = [\"21:+Y\", \"22:+Y\"]",
            "points = [\"21:+Y\", \"21:Y\"]",
            ["`assembly.points`: found 21:+Y twice", "every point once"],
        ),
        (
            "points = [\"21:+Y\", \"22:+Y\"]",
            "points = [\"21:+Y\", \"21:-Y\"]",
            [
                "`assembly.points`: found both 21:+Y and 21:-Y",
                "every point once",
            ],
        ),
        (
            "from = 5",
            "from = 300",
            ["`frequency`: found from 300 to 200", "0 < from < to"],
        ),
        (
            "from = 5",
            "from = 200",
            ["`frequency`: found from 200 to 200", "0 < from < to"],
        ),
        (
            "from = 5",
            "from = nan",
            ["`frequency`: found from NaN to 200", "0 < from < to"],
        ),
        (
            "from = 5\nto = 200",
            "to = -3",
            ["`frequency`: found to -3", "0 < from < to"],
        ),
        (
            "[[50, 60]]",
            "[[60, 50]]",
            ["`bands.yy`: found [60, 50]", "0 < from < to"],
        ),
        (
            "[[50, 60]]",
            "[[0, 50]]",
            ["`bands.yy`: found [0, 50]", "0 < from < to"],
        ),
        (
            "relative = 0.01",
            "relative = 0\nfloor = 0",
            ["`noise`: found relative = 0, floor = 0", "above zero"],
        ),
        (
            "relative = 0.01",
            "relative = -0.01",
            ["`noise`: found relative = -0.01", "not negative"],
        ),
        (
            "relative = 0.01",
            "floor = inf",
            ["`noise`: found floor = inf", "not negative"],
        ),
        (
            "relative = 0.01",
            "relative = 0.01\na = { floor = -1 }",
            ["`noise.a`: found floor = -1", "not negative"],
        ),
        (
            "[joint]",
            "torque = -3\n[joint]",
            ["`assembly.torque`: found -3", "N·m"],
        ),
        (
            "a = { inertia = [1, 2]",
            "a = { inertia = [1]",
            ["`bodies.a.inertia`: found 1 entries", "expected 2"],
        ),
        (
            "a = { inertia = [1, 2]",
            "a = { inertia = [1, 0]",
            ["`bodies.a.inertia`: found 0", "above zero"],
        ),
        (
            "b = { inertia = [1, 2], stiffness = [0, 0]",
            "b = { inertia = [1, 2], stiffness = [0, -1]",
            ["`bodies.b.stiffness`: found -1", "not negative"],
        ),
    ] {
        bench.write("study.toml", replaced(BEAMS, from, to));
        let [one, two] = fragments;
        bench.refused(&IDENTIFY, &["study.toml: ", one, two]);
    }
}

#[test]
fn a_band_without_enough_lines_is_refused() {
    let bench = beams();
    let text = |range: &str| replaced(BEAMS, "from = 5\nto = 200", range);
    for (range, fragments) in [
        (
            "from = 300",
            [
                "found no line from 300 Hz on",
                "the functions go from 2 to 200 Hz",
            ],
        ),
        (
            "to = 1.5",
            [
                "found no line above 0 and up to 1.5 Hz",
                "the functions go from 2 to 200 Hz",
            ],
        ),
        (
            "from = 10.2\nto = 10.8",
            [
                "found no line from 10.2 to 10.8 Hz",
                "the functions go from 2 to 200 Hz",
            ],
        ),
        (
            "from = 10.5\nto = 11.5",
            ["found 1 line(s) from 11 to 11 Hz", "expected at least 2"],
        ),
    ] {
        bench.write("study.toml", text(range));
        let [one, two] = fragments;
        bench.refused(&IDENTIFY, &["c.uff: ", one, two]);
    }
    bench.write(
        "study.toml",
        replaced(
            &text("from = 10.5\nto = 14.5"),
            "points = [\"21:+Y\", \"22:+Y\"]",
            "points = [\"21:+Y\"]",
        ),
    );
    bench.refused(
        &IDENTIFY,
        &[
            "c.uff: found 2 line(s) from 11 to 14 Hz, expected at least 3",
            "model \"full\"",
        ],
    );
}
