//! Universal files that are wrong, at the assembly's place and at a substructure's.

use crate::bench::{Bench, IDENTIFY, PNG, replaced};
use crate::rig::{self, functions_of};

fn with<C: AsRef<[u8]>>(file: &str, change: impl Fn(&str) -> C) -> Bench {
    let bench = rig::ready();
    bench.write(file, change(&bench.text(file)));
    bench
}

#[test]
fn what_is_no_universal_file_is_said_to_be_none() {
    for file in ["a.uff", "b.uff", "c.uff"] {
        #[rustfmt::skip]
        let cases = [
            (b"".as_slice(), ["found an empty file", "export the measurement again"]),
            (PNG, ["found \"\\u{89}PNG", "export the measurement as UFF 58 (ASCII)"]),
            (b"f,re,im\n1,2,3\n", ["found \"f,re,im\"", "export the measurement as UFF 58 (ASCII)"]),
        ];
        for (contents, fragments) in cases {
            let bench = with(file, |_| contents.to_vec());
            let [one, two] = fragments;
            bench.refused(IDENTIFY, &[file, "line 1: ", one, two]);
        }
        let bench = rig::ready();
        std::fs::remove_file(bench.path(file)).unwrap();
        let unread = format!("found \"{file}\", which is not there");
        bench.refused(IDENTIFY, &[&unread, "relative to the study's own folder"]);
    }
}

#[test]
fn a_binary_header_over_ascii_values_is_refused() {
    let bench = with("c.uff", |text| {
        let header = "    58b     1     2          11     3184     0     0           0           0";
        text.replacen("    58", header, 1)
    });
    let found = "c.uff, line 1: binary data set 58b: found no \"    -1\"";
    bench.refused(IDENTIFY, &[found, "says 3184 bytes", "export as ASCII"]);
}

#[test]
fn a_file_cut_in_the_middle_is_said_to_be_cut() {
    let bench = with("c.uff", |text| text.as_bytes()[..text.len() / 2].to_vec());
    // The end of the file is one line past the last.
    let end = bench.text("c.uff").lines().count() + 1;
    let found = format!("c.uff, line {end}: the file ends inside data set 58");
    bench.refused(IDENTIFY, &[&found, "cut short"]);
}

#[test]
fn a_letter_among_the_digits_is_found() {
    let bench = with("b.uff", |text| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        // The second number of line 160 of the file.
        let line = &lines[159];
        let at = line.match_indices('e').nth(1).unwrap().0;
        lines[159] = format!("{}q{}", &line[..at], &line[at + 1..]);
        lines.join("\n") + "\n"
    });
    let expected = ["b.uff, line 160: column 2", "q-", "expected a number"];
    bench.refused(IDENTIFY, &expected);
}

#[test]
fn numbers_that_are_not_finite_or_missing_are_located() {
    let first_values = |text: &str| text.lines().nth(13).unwrap().to_owned();
    let bench = with("c.uff", |text| {
        replaced(text, &first_values(text), "  NaN  1.0  2.0  3.0")
    });
    bench.refused(IDENTIFY, &["c.uff", "line 14", "found NaN", "finite"]);
    let bench = with("c.uff", |text| {
        replaced(text, &format!("{}\n", first_values(text)), "")
    });
    let expected = ["c.uff, line", "ends after 130 numbers, expected 134"];
    bench.refused(IDENTIFY, &expected);
}

#[test]
fn a_missing_pair_is_named_beside_those_that_are_there() {
    // Without the last function of B, whose transpose is itself.
    let bench = with("b.uff", |text| functions_of(text, |place| place < 24));
    let absent = "b.uff: no function with response 23:+Y and reference 23:+Y";
    let there = "20:+Y / 20:+Y, 20:+Y / 20:+RZ";
    bench.refused(IDENTIFY, &[absent, there, "12 more", "use other points"]);
    let bench = rig::ready();
    let study = rig::study("full", &[21, 22]);
    #[rustfmt::skip]
    let cases = [
        ("\"20:+RZ\"", "\"24:+RZ\"", ["b.uff: no function with response 24:+RZ", "20:+RZ / 20:+RZ"]),
        ("\"22:+Y\"", "\"99:+Y\"", ["c.uff: no function with response 99:+Y", ""]),
    ];
    for (from, to, fragments) in cases {
        bench.write("study.toml", replaced(&study, from, to));
        bench.refused(IDENTIFY, &fragments);
    }
}

#[test]
fn a_pair_twice_is_refused() {
    let bench = with("c.uff", |text| {
        text.to_owned() + &functions_of(text, |place| place == 0)
    });
    let found = "c.uff: found two functions from 21:+Y to 21:+Y";
    bench.refused(IDENTIFY, &[found]);
}

#[test]
#[rustfmt::skip]
fn files_with_different_axes_are_both_named() {
    // 2, 5, … Hz becomes 2, 5.5, … Hz.
    let bench = with("a.uff", |text| text.replace(rig::AXIS, "    2.00000e0    3.50000e0"));
    bench.refused(IDENTIFY,
        &["c.uff and a.uff", "within 2 to 200 Hz", "line 2 of the band is at 5 Hz", "5.5 Hz in the second", "same analyser settings"]);
    // A starts above the assembly.
    let bench = with("a.uff", |text| text.replace(rig::AXIS, "    5.00000e0    3.00000e0"));
    bench.refused(IDENTIFY, &["c.uff and a.uff", "line 1 of the band is at 2 Hz", "5 Hz in the second"]);
    // One function of a file differs from the others of that file.
    let bench = with("c.uff", |text| text.replacen(rig::AXIS, "    2.00000e0    3.50000e0", 1));
    bench.refused(IDENTIFY, &["c.uff: functions 21:+Y / 21:+Y and 21:+Y / 22:+Y", "line 2 is at 5.5 Hz"]);
}

#[test]
fn other_functions_than_frequency_responses_are_not_enough() {
    // Function type 3: cross spectrum.
    let bench = with("c.uff", |text| {
        text.replace("\n    4         0", "\n    3         0")
    });
    bench.refused(IDENTIFY, &["c.uff: found no frequency response function"]);
    // Function type 6 says that these receptances are coherences.
    let bench = with("c.uff", |text| {
        text.replace("\n    4         0", "\n    6         0")
    });
    let found = "c.uff, line 1: coherence 21:+Y / 21:+Y";
    bench.refused(IDENTIFY, &[found, "expected a number from 0 to 1"]);
    // Data type 9 over 8: a load per motion.
    let bench = with("c.uff", |text| {
        text.replace("         8    0", "         9    0")
            .replace("        13    0", "         8    0")
    });
    let found = "c.uff, line 11: found dynamic stiffness";
    bench.refused(IDENTIFY, &[found, "export the motion per load"]);
}

#[test]
fn a_file_that_is_named_twice_and_lacks_points_is_said_to_be() {
    for (file, roles) in [
        ("a.uff", "for a and for the assembly"),
        ("b.uff", "for b and for the assembly"),
    ] {
        let bench = rig::ready();
        bench.edit(
            "study.toml",
            &format!("frf = \"{file}\""),
            "frf = \"c.uff\"",
        );
        let fragments = ["c.uff: ", roles, "is it meant for both?"];
        bench.refused(IDENTIFY, &fragments);
    }
    let bench = rig::ready();
    bench.edit("study.toml", "frf = \"c.uff\"", "frf = \"a.uff\"");
    bench.refused(
        IDENTIFY,
        &[
            "a.uff: found no function between those that are asked for, 21:+Y 22:+Y 23:+Y",
            "for a and for the assembly",
        ],
    );
}
