//! The start-value file: what is refused by line.

use std::fs;

use crate::{
    c,
    importer::{Folder, Kind, Request, start_text, vr},
    raw::BOTH,
    rows::rows,
};

fn lap() -> String {
    start_text(Kind::Lap, 2, &[])
}

/// Why there is no instance of the FMU with these resources; both versions give the same reason.
fn refusal(folder: &Folder) -> String {
    let [fmi2, fmi3] = BOTH.map(|version| {
        let request = Request {
            version,
            ..Request::of(folder)
        };
        let message = request.refusal();
        let (_, reason) = message.split_once(": ").unwrap();
        reason.to_owned()
    });
    assert_eq!(fmi2, fmi3);
    fmi3
}

fn refusal_of_start(start: &str) -> String {
    let message = refusal(&Folder::with_start(start));
    // a '#' in a log message starts a reference to a variable: literal ones are doubled
    assert!(message.contains("Prüfung 100% ##1/start.txt"), "{message}");
    message
}

#[test]
fn carriage_returns_are_accepted() {
    let folder = Folder::with_start(&lap().replace('\n', "\r\n"));
    let request = Request::of(&folder);
    assert_eq!(request.instantiate().unwrap().get([vr::A_MASS]), [2.0]);
}

#[test]
fn start_files_that_are_not_text_or_too_long_are_refused() {
    let folder = Folder::new("binary");
    fs::write(folder.0.join("start.txt"), [0xff, 0xfe, 0, 1]).unwrap();
    let message = refusal(&folder);
    assert!(message.contains("cannot be read"), "{message}");
    fs::write(folder.0.join("start.txt"), "x".repeat(3 << 20)).unwrap();
    let message = refusal(&folder);
    assert!(
        message.contains("line 1") && message.len() < 1000,
        "{message}"
    );
}

/// A piece of the file, what takes its place, and the line that is refused, with the reason.
const FAULTS: &str = r#"
    bolted-joint-start/1 | bolted-joint-start/2 | 1 | found "bolted-joint-start/2", expected the header
    model lap | model beam | 2 | found "model beam", expected "model element", "model lap" or "model assembly"
    dofs 2    | dofs 3     | 3 | found "dofs 3", expected "dofs 1", "dofs 2", or "dofs" and some of x y z rx ry rz
    dofs 2    | dofs z x   | 3 | found "dofs z x", expected "dofs 1", "dofs 2", or "dofs" and some of x y z rx ry rz
    dofs 2    | dofs x x   | 3 | found "dofs x x", expected "dofs 1", "dofs 2", or "dofs" and some of x y z rx ry rz
    token {   | tocken {   | 4 | found "tocken {7f0c-4a} ##1", expected "token" and the instantiation token
    joint.k_yy 4000000   | joint.k_yy | 5 | found "joint.k_yy", expected the name of a parameter, a space and a number
    joint.k_yy 4000000   |                       | 5 | found "", expected the name of a parameter
    joint.k_yy 4000000   | joint.k_xx 4000000    | 5 | "joint.k_xx" is not a parameter of this FMU
    joint.k_yy 4000000   | a.y 0                 | 5 | "a.y" is not a parameter of this FMU
    joint.k_ytheta 10000 | joint.k_yy 10000      | 6 | parameter joint.k_yy is given a second time
    joint.k_yy 4000000   | joint.k_yy inf   | 5 | parameter joint.k_yy is "inf", expected a finite number
    joint.k_yy 4000000   | joint.k_yy NaN   | 5 | parameter joint.k_yy is "NaN", expected a finite number
    joint.k_yy 4000000   | joint.k_yy 1e999 | 5 | parameter joint.k_yy is "1e999", expected a finite number
    joint.k_yy 4000000   | joint.k_yy 4 N/m | 5 | parameter joint.k_yy is "4 N/m", expected a finite number
    step_size_max 0.00002\n |               | 32 | the file ends without parameter step_size_max
"#;

#[test]
fn start_files_with_a_fault_are_refused_by_line() {
    for [from, to, line, expected] in rows(FAULTS) {
        let [start, from, to] = [&lap(), from, to].map(|text| text.replace("\\n", "\n"));
        assert!(start.contains(&from), "{from} in {start}");
        let message = refusal_of_start(&start.replacen(&from, &to, 1));
        c::tells(&message, "", &format!("line {line}: {expected}"));
    }
    let message = refusal_of_start("");
    assert!(message.contains("line 1: found \"\""), "{message}");
}

#[test]
fn rotational_parameters_belong_to_two_degrees_of_freedom_only() {
    let message = refusal_of_start(&lap().replace("dofs 2", "dofs 1"));
    c::tells(
        &message,
        "",
        "line 6: \"joint.k_ytheta\" is not a parameter",
    );
    let message = refusal_of_start(&start_text(Kind::Lap, 1, &[]).replace("dofs 1", "dofs 2"));
    c::tells(
        &message,
        "",
        "the file ends without parameter joint.k_ytheta",
    );
    let message = refusal_of_start(&lap().replace("model lap", "model element"));
    assert!(message.contains("\"a.m\" is not a parameter"), "{message}");
}
