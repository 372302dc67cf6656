//! The assembly: what of its start-value file is refused by line, and what it computes.

use crate::{
    c,
    importer::{Folder, Request, TOKEN},
    raw::{
        BOTH,
        assembly::{FIRST, Laws},
    },
    rows::rows,
};

/// A piece of the file, what takes its place, and the line that is refused, with the reason.
const FAULTS: &str = r#"
    variables 15 | variables | 4 | found "variables", expected "variables" and their number
    variables 15 | variables 99999999999 | 20 | found "apart 10", expected role, name, unit and start value
    variables 15 | variables 14 | 19 | found "derivative modal.a1 1 0", expected "apart" and a place
    input push.F N 0 | load push.F N 0 | 5 | found "load push.F N 0", expected role, name, unit
    input push.F N 0 | input push.F N inf | 5 | found "input push.F N inf", expected role, name, unit
    input push.F N 0 | output push.F N 0 | 42 | the list of the variables does not belong to these structures and joints
    apart 10 | apart 9 | 42 | the list of the variables does not belong to these structures and joints
    1 3 1e-4 | 1 3 0 | 22 | found "1 3 0", expected places of a state and of its derivative
    1 3 1e-4 | 1 77 1e-4 | 42 | the list of the variables does not belong to these structures and joints
    coordinates 2 | coordinates 0 | 28 | found "coordinates 0", expected "coordinates" and their number, 1 to 2000
    coordinates 2 | coordinates 9999999999 | 28 | expected "coordinates" and their number, 1 to 2000
    800.0 0.0 | 800.0 | 29 | found "800.0", expected 2 finite numbers
    800.0 0.0 | 800.0 NaN | 29 | found "800.0 NaN", expected 2 finite numbers
    800.0 0.0 | -800.0 0.0 | 29 | found a frequency below zero
    0 0 32.0 | 0 2 32.0 | 31 | found "0 2 32.0", expected row, column and value of an entry of the damping
    loads 1 | loads 7 | 34 | found "motions 1", expected 2 finite numbers
    joint lap y | joint lap u | 37 | found "joint lap u", expected "joint", its name and its degrees of freedom
    joint lap y | joint lap theta y | 37 | expected "joint", its name and its degrees of freedom
    joint.k3_y 1e12 | joint.k3_x 1e12 | 42 | found "joint.k3_x 1e12", expected the name of a parameter of a law
    joint.k3_y 1e12\n | joint.k3_y 1e12\nmore\n | 43 | found "more", expected the end of the file
    joint.k3_y 1e12\n | | 42 | found "", expected the name of a parameter of a law
"#;

#[test]
fn files_with_a_fault_are_refused_by_line() {
    let whole = Laws::Cubic.start_text(TOKEN);
    for [from, to, line, expected] in rows(FAULTS) {
        let [from, to] = [from, to].map(|text| text.replace("\\n", "\n"));
        assert!(whole.contains(&from), "{from} in {whole}");
        let folder = Folder::with_start(&whole.replacen(&from, &to, 1));
        for version in BOTH {
            let request = Request {
                version,
                ..Request::of(&folder)
            };
            let message = request.refusal();
            assert!(
                message.contains(&format!("line {line}: ")),
                "{message}, not line {line}"
            );
            c::tells(&message, "", expected);
        }
    }
}

/// The check case of the scheme: its numbers come from NumPy and SciPy.
#[test]
fn steps_are_those_of_the_check_case() {
    let folder = Folder::with_start(&Laws::Cubic.start_text(TOKEN));
    let instance = Request::of(&folder).instantiate().unwrap();
    c::ok(instance.enter_initialization(0.0, None));
    let second_coordinate = 1e-3 / 2.0_f64.sqrt();
    c::ok(instance.set(&[FIRST, FIRST + 2], &[10.0, second_coordinate]));
    c::ok(instance.exit_initialization());
    let exact = [4.256638020e-4, 1.672845601e-4, 0.4503936292, -0.6683705808];
    for step in 0..100 {
        c::ok(instance.do_step(1e-5 * f64::from(step), 1e-5).status);
    }
    let found = instance.get([FIRST + 1, FIRST + 2, FIRST + 3, FIRST + 4]);
    for (found, expected) in found.iter().zip(exact) {
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    }
}
