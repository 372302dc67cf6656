//! Values that cannot be, and ranges without lines.

use super::{BEAMS, beams};
use crate::bench::{IDENTIFY, replaced};

#[test]
fn values_that_cannot_be_are_named_by_key() {
    let bench = beams();
    #[rustfmt::skip]
    let cases = [
        ("\"beams\"", "\" \"", ["`name`: found \" \"", "one line of text"]),
        ("\"beams\"", "\"a\\nb\"", ["`name`: found \"a\\nb\"", "one line of text"]),
        (", theta = { points = [\"3:+Y\", \"2:+Y\", \"1:+Y\"], spacing = 0.015 }", "",
         ["`a.joint.theta`: found nothing", "which joint model \"full\" needs"]),
        ("y = \"2:+Y\"", "y = \"1:+Y\"", ["`a.joint.theta.points`: found 2:+Y in the middle", "expected the joint's own translation 1:+Y"]),
        ("spacing = 0.015", "spacing = 0", ["`a.joint.theta.spacing`: found 0", "in m"]),
        ("spacing = 0.015", "spacing = -1", ["`a.joint.theta.spacing`: found -1", "in m"]),
        ("modal = \"a.toml\"", "", ["`a`: found no source", "one of `frf`, `modal` and `beam`"]),
        ("modal = \"a.toml\"",
         "modal = \"a.toml\"\nbeam = { length = 0.2, width = 0.02, height = 0.006, youngs_modulus = 7e10, density = 2700, boundary = \"free-free\", loss_factor = 0.01 }",
         ["`a`: found modal and beam", "or `frf` with `modal`"]),
        ("modal = \"a.toml\"", "modal = \"a.toml\"\nquantity = \"mobility\"", ["`a.quantity`", "beside `frf` only"]),
        ("modal = \"a.toml\"", "modal = \"a.toml\"\npoints = { \"1:+Y\" = 0.1 }", ["`a.points`", "the assembly's points, which are on B"]),
        ("beam = {", "quantity = \"mobility\"\nbeam = {", ["`b.quantity`", "beside `frf` only"]),
        ("{ x = 0.015 }", "{ y = \"21:+Y\" }", ["`b.joint`: found y", "{ x = "]),
        ("{ x = 0.015 }", "{}", ["`b.joint`: found no key", "{ x = "]),
        ("{ y = \"2:+Y\", theta", "{ x = 0.1, theta", ["`a.joint`: found x and theta", "{ y = "]),
        ("{ x = 0.015 }", "{ x = 0.3 }", ["`b.joint.x`: found 0.3", "from 0 to 0.2 m"]),
        ("\"21:+Y\" = 0.17", "\"21:+Y\" = -0.1", ["`b.points.\"21:+Y\"`: found -0.1", "from 0 to 0.2 m"]),
        ("\"21:+Y\" = 0.17", "\"21:+Y\" = nan", ["`b.points.\"21:+Y\"`: found NaN", "from 0 to 0.2 m"]),
        ("\"21:+Y\" = 0.17, ", "", ["`b.points`: found no position of 21:+Y", "\"21:+Y\" = "]),
        ("height = 0.006", "height = -0.006", ["beam.height: found -0.006", "expected a positive number"]),
        ("length = 0.2", "length = 0", ["beam.length: found 0", "expected a positive number"]),
        ("density = 2700", "density = inf", ["beam.density: found inf", "expected a positive number"]),
        ("theory = \"euler-bernoulli\"", "poissons_ratio = 0.5", ["beam.poissons_ratio: found 0.5", "below 0.5"]),
        ("theory = \"euler-bernoulli\"", "theory = \"euler-bernoulli\", poissons_ratio = 0.3",
         ["`b.beam.poissons_ratio`: found 0.3", "theory = \"timoshenko\" only"]),
        ("[0, 0, 0.01] }", "[] }", ["beam.damping_ratio: found an empty list", "expected one number"]),
        ("[0, 0, 0.01] }", "-0.1 }", ["beam.damping_ratio: found -0.1", "a ratio from 0 to below 1"]),
        ("[0, 0, 0.01] }", "[0, 0, 8] }", ["beam.damping_ratio: found 8", "not per cent"]),
        ("[0, 0, 0.01] }", "0.1, loss_factor = 0.1 }", ["`b.beam`: found both damping_ratio and loss_factor", "exactly one"]),
        (", damping_ratio = [0, 0, 0.01] }", " }", ["`b.beam`: found neither damping_ratio nor loss_factor", "exactly one"]),
        ("points = [\"21:+Y\", \"22:+Y\"]", "points = []", ["`assembly.points`: found an empty list", "three for the best result"]),
        ("points = [\"21:+Y\", \"22:+Y\"]", "points = [\"21:+Y\", \"21:Y\"]", ["`assembly.points`: found 21:+Y twice", "every point once"]),
        ("points = [\"21:+Y\", \"22:+Y\"]", "points = [\"21:+Y\", \"21:-Y\"]",
         ["`assembly.points`: found both 21:+Y and 21:-Y", "every point once"]),
        ("from = 5", "from = 300", ["`frequency`: found from 300 to 200", "0 < from < to"]),
        ("from = 5", "from = 200", ["`frequency`: found from 200 to 200", "0 < from < to"]),
        ("from = 5", "from = nan", ["`frequency`: found from NaN to 200", "0 < from < to"]),
        ("from = 5\nto = 200", "to = -3", ["`frequency`: found to -3", "0 < from < to"]),
        ("[[50, 60]]", "[[60, 50]]", ["`bands.yy`: found [60, 50]", "0 < from < to"]),
        ("[[50, 60]]", "[[0, 50]]", ["`bands.yy`: found [0, 50]", "0 < from < to"]),
        ("[[50, 60]]", "[]", ["`bands.yy`: found an empty list", "\"automatic\" or \"median\""]),
        ("relative = 0.01", "relative = 0\nfloor = 0", ["`noise`: found relative = 0, floor = 0", "above zero"]),
        ("relative = 0.01", "relative = -0.01", ["`noise`: found relative = -0.01", "not negative"]),
        ("relative = 0.01", "floor = inf", ["`noise`: found floor = inf", "not negative"]),
        ("relative = 0.01", "relative = 0.01\na = { floor = -1 }", ["`noise.a`: found floor = -1", "not negative"]),
        ("[joint]", "torque = -3\n[joint]", ["`assembly.torque`: found -3", "N·m"]),
        ("a = { inertia = [1, 2]", "a = { inertia = [1]", ["`bodies.a.inertia`: found 1 entries", "expected 2"]),
        ("a = { inertia = [1, 2]", "a = { inertia = [1, 0]", ["`bodies.a.inertia`: found 0", "above zero"]),
        ("b = { inertia = [1, 2], stiffness = [0, 0]", "b = { inertia = [1, 2], stiffness = [0, -1]",
         ["`bodies.b.stiffness`: found -1", "not negative"]),
    ];
    bench.refused_edits(IDENTIFY, ("study.toml", BEAMS), &cases);
}

#[test]
fn deviations_in_other_units_than_si_are_asked_about() {
    let bench = beams();
    #[rustfmt::skip]
    let cases = [
        ("position = 1", "`budget.position`: found 1", "in m, at most 0.1 (is it in millimetres?)"),
        ("delay = 5", "`budget.delay`: found 5", "in s, at most 0.01 (is it in microseconds"),
        ("phase = 1.5", "`budget.phase`: found 1.5", "in rad, at most 0.5 (is it in degrees?)"),
        ("accelerometer_mass = 10", "`budget.accelerometer_mass`: found 10", "in kg, at most 5 (is it in grams?)"),
        ("joint_mass = 30", "`budget.joint_mass`: found 30", "in kg, at most 5 (is it in grams?)"),
        ("joint_inertia = 4", "`budget.joint_inertia`: found 4", "in kg·m², at most 0.1"),
        ("joint_mass = -1", "`budget.joint_mass`: found -1", "in kg that is finite and not negative"),
    ];
    for (key, found, expected) in cases {
        let budget = format!("budget = {{ {key} }}");
        bench.write("study.toml", replaced(BEAMS, "budget = \"none\"", &budget));
        bench.refused(IDENTIFY, &["study.toml: ", found, expected]);
    }
}

#[test]
fn a_band_without_enough_lines_is_refused() {
    let bench = beams();
    let text = |range: &str| replaced(BEAMS, "from = 5\nto = 200", range);
    #[rustfmt::skip]
    let cases = [
        ("from = 300", ["found no line from 300 Hz on", "the functions go from 2 to 200 Hz"]),
        ("to = 1.5", ["found no line above 0 and up to 1.5 Hz", "the functions go from 2 to 200 Hz"]),
        ("from = 10.2\nto = 10.8", ["found no line from 10.2 to 10.8 Hz", "the functions go from 2 to 200 Hz"]),
        ("from = 10.5\nto = 11.5", ["found 1 line(s) from 11 to 11 Hz", "expected at least 2"]),
    ];
    for (range, fragments) in cases {
        bench.write("study.toml", text(range));
        let [one, two] = fragments;
        bench.refused(IDENTIFY, &["c.uff: ", one, two]);
    }
    bench.write("study.toml", text("from = 10.5\nto = 14.5"));
    let (both, one) = ("points = [\"21:+Y\", \"22:+Y\"]", "points = [\"21:+Y\"]");
    bench.edit("study.toml", both, one);
    let found = "c.uff: found 2 line(s) from 11 to 14 Hz, expected at least 3";
    bench.refused(IDENTIFY, &[found, "model \"full\""]);
}
