//! `resources/start.txt`: what the library reads when it is instantiated.

use std::fmt::Write as _;

use super::Interface;
use crate::joint::DofSet;

/// First line of the file.
const HEADER: &str = "bolted-joint-start/1";

/// The parameters as the file lists them, one `name value` on each line.
pub(super) fn parameter_lines(parameters: &[(String, f64)]) -> String {
    let mut text = String::new();
    for (name, value) in parameters {
        // writing to a String cannot fail; {:?} gives the fewest digits that read back to the same value
        let _ = writeln!(text, "{name} {value:?}");
    }
    text
}

/// The whole file.
pub(super) fn start_file(
    interface: Interface,
    dofs: DofSet,
    token: &str,
    parameter_lines: &str,
) -> String {
    format!(
        "{HEADER}\nmodel {interface}\ndofs {}\ntoken {token}\n{parameter_lines}",
        dofs.count()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_are_those_that_the_library_reads() {
        let parameters = [
            ("joint.k_yy".to_owned(), 5.73e5),
            ("step_size_max".to_owned(), 2e-5),
        ];
        let text = start_file(
            Interface::Lap,
            DofSet::Translation,
            "0123",
            &parameter_lines(&parameters),
        );
        assert_eq!(
            text,
            "bolted-joint-start/1\nmodel lap\ndofs 1\ntoken 0123\njoint.k_yy 573000.0\nstep_size_max 2e-5\n"
        );
    }
}
