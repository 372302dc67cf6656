//! `resources/start.txt`: what the library reads when it is instantiated.

use std::fmt::Write as _;

use super::Interface;
use bolted_joint_dynamics::law::Declaration;
use bolted_joint_joint::{DofSet, Joint, JointFile};

/// First line of the file.
pub(super) const HEADER: &str = "bolted-joint-start/1";

/// The value reference of the first variable that such a file lists, as `crates/fmu` has it.
pub(super) const FIRST_LISTED: u32 = 4096;

/// The parameters as the file lists them, one `name value` on each line.
pub fn parameter_lines(parameters: &[(String, f64)]) -> String {
    let mut text = String::new();
    for (name, value) in parameters {
        // writing to a String cannot fail; {:?} gives the fewest digits that read back to the same value
        let _ = writeln!(text, "{name} {value:?}");
    }
    text
}

/// The line with the joint's laws that remember the motion; empty where there are none.
pub fn laws_line(file: &JointFile) -> String {
    let laws = file.joint.laws_with_memory();
    let names: Vec<String> = laws.map(Declaration::numbered_name).collect();
    match names.as_slice() {
        [] => String::new(),
        names => format!("laws {}\n", names.join(" ")),
    }
}

/// The table of a joint over the preload: a heading, then a line for each preload with the preload, the upper triangles of K
/// and C row by row, and k3; empty for a constant joint. Friction is stated at the preload at the heading's end; where it has a
/// table of its own, the heading ends with `friction`, and each line with the parameters of the laws in [`laws_line`] on each DOF.
pub fn table_lines(joint: &Joint, extrapolate: bool) -> String {
    let Some(table) = &joint.over_preload else {
        return String::new();
    };
    let beyond = if extrapolate { "held" } else { "refused" };
    let mut text = format!("table {} {beyond}", table.preload.len());
    if !table.friction.is_empty() {
        text.push_str(" friction");
    } else if !joint.friction.is_empty() {
        let _ = write!(text, " {:?}", table.nominal);
    }
    text.push('\n');
    for (place, preload) in table.preload.iter().enumerate() {
        let mut numbers = vec![*preload];
        let mut order = 0;
        for matrices in [&table.stiffness, &table.damping] {
            let rows = matrices.get(place).map_or(&[][..], Vec::as_slice);
            order = rows.len();
            for (i, row) in rows.iter().enumerate() {
                numbers.extend(row.iter().skip(i));
            }
        }
        match table.cubic.get(place) {
            Some(cubic) => numbers.extend(cubic),
            None => numbers.extend(std::iter::repeat_n(0.0, order)),
        }
        if let Some(own) = table.friction.get(place) {
            let at = Joint {
                friction: own.clone(),
                over_preload: None,
                ..joint.clone()
            };
            for dof in joint.dofs.rows() {
                for law in joint.laws_with_memory() {
                    let own = at.friction_on(dof, law);
                    let value = |parameter| own.and_then(|own| own.value(parameter));
                    let all = law.parameters.iter();
                    numbers.extend(all.map(|parameter| value(parameter).unwrap_or(0.0)));
                }
            }
        }
        let words: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
        text += &words.join(" ");
        text.push('\n');
    }
    text
}

/// The whole file.
pub(super) fn start_file(
    interface: Interface,
    dofs: DofSet,
    token: &str,
    table_lines: &str,
    parameter_lines: &str,
) -> String {
    format!(
        "{HEADER}\nmodel {interface}\ndofs {}\ntoken {token}\n{table_lines}{parameter_lines}",
        dofs_text(dofs)
    )
}

/// The joint's DOFs as the file has them: how many in a plane, by name in space.
pub fn dofs_text(dofs: DofSet) -> String {
    if dofs.is_in_space() {
        dofs.names().join(" ")
    } else {
        dofs.count().to_string()
    }
}

/// What such a file says.
#[derive(Debug, Clone, PartialEq)]
pub struct StartFile {
    /// Which FMU it is for.
    pub interface: Interface,
    /// The joint's DOFs, as [`dofs_text`] writes them.
    pub dofs: String,
    /// The FMU's instantiation token.
    pub token: String,
    /// The line of the laws with memory, or heading and lines of the table over the preload; empty for a constant joint.
    pub table: String,
    /// Names and values.
    pub parameters: Vec<(String, f64)>,
}

impl StartFile {
    /// Reads the text back; `None` where it is not such a file.
    pub fn parse(text: &str) -> Option<Self> {
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
        let dofs = field("dofs")?.to_owned();
        let token = field("token")?.to_owned();
        let mut lines = lines.peekable();
        let mut table = String::new();
        if let Some(laws) = lines.next_if(|line| line.starts_with("laws ")) {
            table = format!("{laws}\n");
        }
        if let Some(heading) = lines.next_if(|line| line.starts_with("table ")) {
            let count = heading.split(' ').nth(1)?.parse::<usize>().ok()?;
            let mut all = vec![heading];
            all.extend(lines.by_ref().take(count));
            for line in all {
                table += line;
                table.push('\n');
            }
        }
        let parameters = lines
            .map(|line| {
                let (name, value) = line.split_once(' ')?;
                Some((name.to_owned(), value.parse().ok()?))
            })
            .collect::<Option<_>>()?;
        Some(Self {
            interface,
            dofs,
            token,
            table,
            parameters,
        })
    }

    /// Whether the joint is one over the preload that is held beyond its table.
    pub fn extrapolates(&self) -> bool {
        let heading = self.table.lines().find(|line| line.starts_with("table "));
        heading.is_some_and(|heading| heading.split(' ').nth(2) == Some("held"))
    }

    /// Start value of the parameter `name`.
    pub fn value(&self, name: &str) -> Option<f64> {
        let found = self.parameters.iter().find(|(other, _)| other == name);
        found.map(|&(_, value)| value)
    }
}

/// What the start-value file of an assembly says of the FMU's variables.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyStartFile {
    /// The FMU's instantiation token.
    pub token: String,
    /// The variables.
    pub variables: Vec<ListedVariable>,
}

/// A variable that the start-value file of an assembly lists.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedVariable {
    /// Name.
    pub name: String,
    /// Its value reference.
    pub reference: u32,
    /// Causalities that it may be declared with.
    pub causalities: &'static [&'static str],
    /// Unit.
    pub unit: String,
}

impl AssemblyStartFile {
    /// Reads the text; `None` where it is not such a file.
    pub fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let has_head = lines.next()? == HEADER && lines.next()? == "model assembly";
        let token = lines
            .next()
            .filter(|_| has_head)?
            .strip_prefix("token ")?
            .to_owned();
        let count = lines
            .next()?
            .strip_prefix("variables ")?
            .parse::<usize>()
            .ok()?;
        let variables: Vec<ListedVariable> = lines
            .take(count)
            .enumerate()
            .map(|(place, line)| {
                let mut words = line.split(' ');
                let causalities: &[&str] = match words.next()? {
                    "input" | "limited" => &["input"],
                    "state" => &["output", "local"],
                    "inner" | "output" => &["output"],
                    "derivative" | "indicator" => &["local"],
                    _ => return None,
                };
                Some(ListedVariable {
                    name: words.next()?.to_owned(),
                    reference: FIRST_LISTED + u32::try_from(place).ok()?,
                    causalities,
                    unit: words.next()?.to_owned(),
                })
            })
            .collect::<Option<_>>()?;
        (variables.len() == count).then_some(Self { token, variables })
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
            DofSet::TRANSLATION,
            "0123",
            "",
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
