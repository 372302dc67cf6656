//! Several bolts and presumed joints that contradict the rest of the study.

use super::{BEAMS, OF_OTHER_BODIES, beams};
use crate::bench::{IDENTIFY, replaced};

/// Modes at five points.
const MODES: &str = r#"points = ["1:+Y", "2:+Y", "3:+Y", "4:+Y", "5:+Y"]
[[mode]]
frequency_hz = 40.0
damping_ratio = 0.01
shape = [[4.0, 0.0], [3.6, 0.0], [3.3, 0.0], [3.0, 0.0], [2.7, 0.0]]
"#;

const ON_A: &str =
    r#"joint = { y = "2:+Y", theta = { points = ["3:+Y", "2:+Y", "1:+Y"], spacing = 0.015 } }"#;
const TWO_ON_A: &str = r#"joint = [
  { name = "left", y = "2:+Y", theta = { points = ["3:+Y", "2:+Y", "1:+Y"], spacing = 0.015 } },
  { name = "right", y = "4:+Y", theta = { points = ["5:+Y", "4:+Y", "3:+Y"], spacing = 0.015 } },
]"#;
const ON_B: &str = "joint = { x = 0.015 }";
const TWO_ON_B: &str = r#"joint = [{ name = "left", x = 0.015 }, { name = "right", x = 0.045 }]"#;

fn two_bolts() -> String {
    let text = replaced(BEAMS, ON_A, TWO_ON_A);
    let text = replaced(&text, ON_B, TWO_ON_B);
    let alike = "model = \"full\"\nbolts = \"alike\"";
    replaced(&text, "model = \"full\"", alike)
}

#[test]
fn the_study_with_two_bolts_is_right() {
    let bench = beams();
    bench.write("a.toml", MODES);
    bench.write("study.toml", two_bolts());
    bench.unusable(IDENTIFY, &[OF_OTHER_BODIES]);
    // The order on B is that of the names, not of the list.
    let first = bench.json("o.joint.json");
    let turned = r#"joint = [{ name = "right", x = 0.045 }, { name = "left", x = 0.015 }]"#;
    bench.write("study.toml", replaced(&two_bolts(), TWO_ON_B, turned));
    bench.unusable(IDENTIFY, &[OF_OTHER_BODIES]);
    assert_eq!(bench.json("o.joint.json")["joint"], first["joint"]);
}

#[test]
fn bolts_that_contradict_each_other_are_named() {
    let bench = beams();
    bench.write("a.toml", MODES);
    #[rustfmt::skip]
    let cases = [
        ("bolts = \"alike\"", "bolts = \"similar\"", ["line 19", "expected `alike` or `different`"]),
        ("bolts = \"alike\"\n", "", ["`joint.bolts`: found nothing for 2 bolts", "\"alike\" for one joint at all of them"]),
        (TWO_ON_B, ON_B, ["`b.joint`: found 1 place", "expected 2 places, as on A"]),
        (TWO_ON_A, ON_A, ["`joint.bolts`: found it for one bolt", "lists of several places"]),
        (TWO_ON_B, "joint = []", ["`b.joint`: found an empty list", "the place of one bolt or more"]),
        ("{ name = \"right\", x = 0.045 }", "{ x = 0.045 }", ["`b.joint`: found no name of place 2", "such as name = \"left\""]),
        ("{ name = \"right\", x = 0.045 }", "{ name = \"middle\", x = 0.045 }",
         ["`b.joint`: found the names \"left\", \"middle\"", "those on A, \"left\", \"right\""]),
        ("{ name = \"right\", x = 0.045 }", "{ name = \"Left\", x = 0.045 }",
         ["`b.joint`: found the names \"left\" and \"Left\"", "a name of its own for every place"]),
        ("{ name = \"right\", x = 0.045 }", "{ name = \"../right\", x = 0.045 }",
         ["`b.joint`: found the name \"../right\"", "part of a file's name"]),
        ("x = 0.045", "x = 0.015", ["`b.joint`: found x = 0.015 at \"left\" and at \"right\"", "a place of its own"]),
        ("x = 0.045", "x = 0.3", ["`b.joint \"right\".x`: found 0.3", "from 0 to 0.2 m"]),
        ("{ name = \"right\", x = 0.045 }",
         "{ name = \"right\", x = 0.045 }, { name = \"c\", x = 0.05 }, { name = \"d\", x = 0.06 }, { name = \"e\", x = 0.07 }, \
          { name = \"f\", x = 0.08 }, { name = \"g\", x = 0.09 }, { name = \"h\", x = 0.1 }, { name = \"i\", x = 0.11 }",
         ["`b.joint`: found 9 places", "expected 8 at most"]),
        ("y = \"4:+Y\", theta = { points = [\"5:+Y\", \"4:+Y\", \"3:+Y\"]",
         "y = \"2:-Y\", theta = { points = [\"3:+Y\", \"2:-Y\", \"1:+Y\"]",
         ["`a.joint`: found 2:-Y at \"left\" and at \"right\"", "a place of its own"]),
        ("y = \"4:+Y\", theta", "y = \"5:+Y\", theta",
         ["`a.joint \"right\".theta.points`: found 4:+Y in the middle", "expected the joint's own translation 5:+Y"]),
        (", theta = { points = [\"5:+Y\", \"4:+Y\", \"3:+Y\"], spacing = 0.015 }", "",
         ["`a.joint \"right\".theta`: found nothing", "which joint model \"full\" needs"]),
        ("bolts = \"alike\"", "bolts = \"different\"", ["`bodies`: found them with bolts that differ", "with one joint only"]),
    ];
    bench.refused_edits(IDENTIFY, ("study.toml", &two_bolts()), &cases);
    let named = "joint = { name = \"left\", x = 0.015 }";
    bench.write("study.toml", replaced(BEAMS, ON_B, named));
    let found = "`b.joint.name`: found \"left\" for the only place";
    bench.refused(IDENTIFY, &[found, "several places"]);
    let own =
        "frf = \"c.uff\"\nb = { modal = \"a.toml\", joint = { y = \"2:+Y\", theta = \"2:+RZ\" } }";
    bench.write("study.toml", replaced(&two_bolts(), "frf = \"c.uff\"", own));
    let found = "`assembly.b.joint`: found 1 place";
    bench.refused(IDENTIFY, &[found, "expected 2 places, as on A"]);
}

#[test]
fn a_presumed_joint_that_cannot_be_is_refused() {
    let bench = beams();
    #[rustfmt::skip]
    let cases = [
        ("[[1e5]]", "[[1, 0], [0, 1]]", ["`start.stiffness`: found rows of [1] entries", "expected 2 by 2"]),
        ("[[1, 2], [3, 4]]", "[[1, 0], [0, 1]]", ["`start.stiffness`: found 2 and 3 off the diagonal", "symmetric"]),
        ("[[1, 0], [0, 1]]", "[[1, 0], [0, -1]]", ["`start.damping`: found -1 on the diagonal", "not negative"]),
        ("[[1, 0], [0, nan]]", "[[1, 0], [0, 1]]", ["`start.stiffness`: found NaN", "finite"]),
    ];
    for (stiffness, damping, fragments) in cases {
        let start = format!("[start]\nstiffness = {stiffness}\ndamping = {damping}\n[bodies]");
        bench.write("study.toml", replaced(BEAMS, "[bodies]", &start));
        let [one, two] = fragments;
        bench.refused(IDENTIFY, &["study.toml: ", one, two]);
    }
    let start = "[start]\nstiffness = [[1e5, 1], [1, 1e3]]\ndamping = [[1, 0], [0, 1]]\n[bodies]";
    let text = replaced(BEAMS, "[bodies]", start);
    bench.write("study.toml", replaced(&text, "\"full\"", "\"diagonal\""));
    let found = "`start.stiffness`: found 1 off the diagonal";
    bench.refused(IDENTIFY, &[found, "has no coupling"]);
}
