//! `resources/start.txt`: what the library reads when it is instantiated.

use std::fmt::Write as _;

use super::Interface;
use crate::joint::DofSet;

/// First line of the file.
const HEADER: &str = "bolted-joint-start/1";

/// The parameters as the file lists them, one `name value` on each line.
pub(crate) fn parameter_lines(parameters: &[(String, f64)]) -> String {
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

/// What such a file says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StartFile {
    pub(crate) interface: Interface,
    pub(crate) dof_count: usize,
    pub(crate) token: String,
    pub(crate) parameters: Vec<(String, f64)>,
}

impl StartFile {
    /// Reads the text back; `None` where it is not such a file.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        if lines.next()? != HEADER {
            return None;
        }
        let mut field = |name: &str| lines.next()?.strip_prefix(name)?.strip_prefix(' ');
        let interface = match field("model")? {
            "element" => Interface::Element,
            "lap" => Interface::Lap,
            _ => return None,
        };
        let dof_count = field("dofs")?.parse().ok()?;
        let token = field("token")?.to_owned();
        let parameters = lines
            .map(|line| {
                let (name, value) = line.split_once(' ')?;
                Some((name.to_owned(), value.parse().ok()?))
            })
            .collect::<Option<_>>()?;
        Some(Self {
            interface,
            dof_count,
            token,
            parameters,
        })
    }

    /// Start value of the parameter `name`.
    pub(crate) fn value(&self, name: &str) -> Option<f64> {
        let found = self.parameters.iter().find(|(other, _)| other == name);
        found.map(|&(_, value)| value)
    }
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
        let read = StartFile::parse(&text).unwrap();
        assert_eq!((read.interface, &*read.token), (Interface::Lap, "0123"));
        assert_eq!(read.parameters, parameters);
        assert_eq!(StartFile::parse(&text.replace("2e-5", "fast")), None);
    }
}
