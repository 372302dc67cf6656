//! Modal data that are wrong.

use crate::bench::{Bench, IDENTIFY, PNG};
use crate::rig;

const MODES: &str = include_str!("../data/studies/modes.toml");

fn bench() -> Bench {
    let bench = rig::ready();
    bench.edit("study.toml", "frf = \"a.uff\"", "modal = \"modes.toml\"");
    bench.write("modes.toml", MODES);
    bench
}

/// They can be read and computed with; that no body moves as the one mode says is another matter, and a stiffness comes out negative.
#[test]
fn the_data_that_the_others_are_made_from_are_right() {
    let reasons = [
        "more than noise",
        "is not noise",
        "the data do not determine k_yy",
    ];
    bench().unusable(IDENTIFY, &reasons);
}

#[test]
fn what_is_no_modal_file_is_said_to_be_none() {
    let bench = bench();
    #[rustfmt::skip]
    let cases = [
        (b"".as_slice(), ["found an empty file", "expected modal data (TOML)"]),
        (PNG, ["found binary data (byte 0)", "expected modal data (TOML)"]),
        (&MODES.as_bytes()[..100], ["line 5", "shape"]),
        (b"frequency,damping\n", ["line 1", "expected"]),
    ];
    bench.refused_contents(IDENTIFY, "modes.toml", &cases);
    std::fs::remove_file(bench.path("modes.toml")).unwrap();
    bench.refused(
        IDENTIFY,
        &["`a.modal`: found \"modes.toml\", which is not there"],
    );
}

#[test]
fn every_wrong_entry_is_named() {
    let bench = bench();
    #[rustfmt::skip]
    let cases = [
        ("frequency_hz", "frequency", ["line 3, column 1", "unknown field `frequency`"]),
        ("damping_ratio = 0.01\n", "", ["line 2", "missing field `damping_ratio`"]),
        ("40.0", "\"40 Hz\"", ["line 3", "expected a number"]),
        ("40.0", "-40.0", ["mode 1, frequency_hz: found -40", "a positive frequency in Hz"]),
        ("40.0", "nan", ["mode 1, frequency_hz: found NaN", "a positive frequency in Hz"]),
        ("0.01", "1.0", ["mode 1, damping_ratio: found 1", "not per cent"]),
        (", [3.3, 0.0]]", "]", ["mode 1, shape: found 2 entries, expected 3", "one for each of `points`"]),
        ("[3.6, 0.0]", "[3.6, inf]", ["mode 1, shape: found inf", "finite"]),
        ("[3.6, 0.0]", "[3.6]", ["line 5", "expected an array of length 2"]),
        ("\"2:+Y\"", "\"1:+Y\"", ["found point 1:+Y twice", "every point once"]),
        ("[\"1:+Y\", \"2:+Y\", \"3:+Y\"]", "[]", ["found no point or no mode", "at least one [[mode]]"]),
        ("reference = \"3:+Y\"", "reference = \"7:+Y\"", ["reference 7:+Y", "a reference among `points`"]),
        ("lower = [0, 0, 0]", "lower = [0, 0]", ["residual of 3:+Y, lower: found 2 entries", "expected 3"]),
    ];
    bench.refused_edits(IDENTIFY, ("modes.toml", MODES), &cases);
}

#[test]
fn a_point_without_a_shape_is_named_beside_those_that_have_one() {
    let bench = bench();
    bench.write("modes.toml", MODES.replace("\"1:+Y\"", "\"9:+Y\""));
    let absent = "modes.toml: no mode shape at 1:+Y; the points are 9:+Y, 2:+Y, 3:+Y";
    bench.refused(IDENTIFY, &[absent, "correct the point in the study"]);
}
