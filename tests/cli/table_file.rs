//! Tables of functions that are wrong, and what is said of a residual that is not noise.

use std::fmt::Write as _;

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY};
use crate::rig;

#[test]
fn coherence_alone_is_no_function() {
    let bench = rig::ready();
    bench.edit("study.toml", "frf = \"c.uff\"", "frf = \"c.csv\"");
    let header = "frequency [Hz],21:+Y/21:+Y coherence\n";
    for lines in ["", "10,0.9\n11,0.95\n"] {
        bench.write("c.csv", format!("{header}{lines}"));
        let expected = [
            "c.csv: found coherences alone",
            "expected functions",
            "coherence = \"…\" beside frf",
        ];
        bench.refused(IDENTIFY, &expected);
    }
    // The same in a universal file: function type 6 alone, with values that a coherence may have.
    let bench = rig::ready();
    let text = bench
        .text("c.uff")
        .replace("\n    4         0", "\n    6         0");
    let coherence = |line: &str| match line.starts_with("  ") && line.matches('e').count() >= 3 {
        true => "  9.00000e-1  9.00000e-1  9.00000e-1  9.00000e-1".to_owned(),
        false => line.to_owned(),
    };
    let lines: Vec<String> = text.lines().map(coherence).collect();
    bench.write("c.uff", lines.join("\n") + "\n");
    bench.fails(IDENTIFY, &["c.uff"]);
}

#[test]
fn a_value_that_is_no_number_is_named_with_its_own_line() {
    let bench = rig::ready();
    bench.edit("study.toml", "frf = \"c.uff\"", "frf = \"c.csv\"");
    let mut table =
        "frequency [Hz],21:+Y/21:+Y real [m/N],21:+Y/21:+Y imaginary [m/N]\n".to_owned();
    // line 2 of the file is at 2 Hz, line 50 at 146 Hz
    for line in 2..69 {
        let real = if line == 50 { "NaN" } else { "1e-6" };
        let _ = writeln!(table, "{},{real},-1e-8", 2 + 3 * (line - 2));
    }
    bench.write("c.csv", table);
    bench.refused(
        IDENTIFY,
        &[
            "c.csv, line 50: function 21:+Y / 21:+Y",
            "found value NaN",
            "at 146 Hz",
            "finite number",
        ],
    );
}

#[test]
fn an_ordinate_whose_label_cannot_be_read_is_quoted() {
    let bench = rig::ready();
    let text = bench.text("c.uff");
    // record 9: a data type, and after the label's 20 characters the unit's
    let record = |data_type: u32, unit: &str| {
        format!(
            "{data_type:>10}{:>5}{:>5}{:>5} {:<20} {unit:<20}",
            0, 0, 0, "NONE"
        )
    };
    let [before, unread] = [(8, "NONE"), (0, "furlong/pond")].map(|(of, unit)| record(of, unit));
    assert!(text.contains(&before), "{text}");
    bench.write("c.uff", text.replace(&before, &unread));
    let expected = [
        "c.uff, line",
        "found no data type, and the label \"furlong/pond\"",
        "state in the study what it is",
    ];
    bench.refused(IDENTIFY, &expected);
    bench.edit(
        "study.toml",
        "frf = \"c.uff\"",
        "frf = \"c.uff\"\nquantity = \"receptance\"\nunits = { length = \"m\", force = \"N\" }",
    );
    bench.done(IDENTIFY);
}

#[test]
fn intervals_that_are_hardly_wider_are_not_said_to_be() {
    // The demo has 1 % of noise. A little less is told from it by χ², but widens nothing; half of it doubles the deviations.
    let bench = Bench::new();
    bench.done("demo -o demo");
    let study = bench.text("demo/study.toml");
    for (relative, is_wider) in [("0.0098", false), ("0.005", true)] {
        let stated = format!("{study}\n[noise]\nrelative = {relative}\nfloor = 0\n");
        bench.write("demo/study.toml", stated);
        let outcome = bench.run("identify demo/study.toml -o o.joint.json --no-rivals");
        has(
            &outcome.stderr,
            &["what the joint leaves of the measurement is not noise"],
        );
        let said = outcome.stderr.contains("the intervals are wider for it");
        assert_eq!(said, is_wider, "{}", outcome.stderr);
    }
}
