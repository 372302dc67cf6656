//! A joint for other tools: what each can express of it becomes its own elements, with units and signs in comments; what it
//! cannot is carried by another element, which is said, or refused.
//!
//! Programs of finite elements get stiffness and viscous damping between two coincident nodes, in the nodes' axes x, y and z. A
//! joint in a plane moves along y and turns about z. MATLAB and Modelica also get the laws that can be written as equations.
#![forbid(unsafe_code)]

mod abaqus;
mod ansys;
mod assembly;
mod calculix;
mod error;
mod head;
mod linear;
mod matlab;
mod modelica;
mod nastran;
mod numbers;
mod reserved;
mod units;

use bolted_joint_joint::JointFile;

pub use ansys::matrix27_pair;
pub use assembly::convert_assembly;
pub use error::ConvertError;
use head::Head;
use linear::Linear;
pub use units::Units;

/// A tool that takes a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Nastran: CBUSH and PBUSH, or DMIG where degrees of freedom are coupled.
    Nastran,
    /// Abaqus: springs and dashpots, or a connector where degrees of freedom are coupled.
    Abaqus,
    /// CalculiX: springs and dashpots on relative displacements.
    Calculix,
    /// ANSYS: COMBIN14, or MATRIX27 where degrees of freedom are coupled.
    Ansys,
    /// A function for MATLAB or Octave.
    Matlab,
    /// A package in Modelica.
    Modelica,
}

impl Target {
    /// What people call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nastran => "Nastran",
            Self::Abaqus => "Abaqus",
            Self::Calculix => "CalculiX",
            Self::Ansys => "ANSYS",
            Self::Matlab => "MATLAB",
            Self::Modelica => "Modelica",
        }
    }

    /// Whether it has nodes and elements with numbers.
    #[must_use]
    pub fn has_nodes(self) -> bool {
        !matches!(self, Self::Matlab | Self::Modelica)
    }
}

/// What the user chooses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Name of the function or package: letters, digits and underscores.
    pub identifier: String,
    /// Nodes on sides a and b.
    pub nodes: [u32; 2],
    /// Nodes whose displacements are the rotations of sides a and b, in CalculiX.
    pub rotation_nodes: [u32; 2],
    /// Numbers from here on are free for elements, properties and auxiliary nodes.
    pub first_number: u32,
    /// Take the joint of small motion about rest, where sliders stick.
    pub at_rest: bool,
    /// Of the numbers for programs of finite elements.
    pub units: Units,
}

/// A joint for a tool.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Converted {
    /// Contents of the file.
    pub text: String,
    /// How it differs from the joint file, and what the user has to do.
    pub notes: Vec<String>,
}

/// The joint of a file for a tool; of a joint over the preload, take it at one preload before.
///
/// # Errors
/// [`ConvertError`] where the tool cannot express the joint.
pub fn convert(
    file: &JointFile,
    target: Target,
    options: &Options,
) -> Result<Converted, ConvertError> {
    if file.joint.over_preload.is_some() {
        return Err(ConvertError::OverPreload);
    }
    numbers::check(target, options, file.joint.dofs.turns())?;
    reserved::check(target, &options.identifier)?;
    let head = Head::of(file, target, options);
    match target {
        Target::Matlab => matlab::function(file, options, head),
        Target::Modelica => modelica::package(file, options, head),
        Target::Nastran => nastran::deck(&Linear::of(file, target, options)?, options, head),
        Target::Abaqus => Ok(abaqus::deck(
            &Linear::of(file, target, options)?,
            options,
            head,
        )),
        Target::Calculix => Ok(calculix::deck(
            &Linear::of(file, target, options)?,
            options,
            head,
        )),
        Target::Ansys => Ok(ansys::commands(
            &Linear::of(file, target, options)?,
            options,
            head,
        )),
    }
}

/// A text as an identifier: letters, digits and underscores, a letter first.
#[must_use]
pub fn identifier(text: &str) -> String {
    let own = text
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let own: String = own.collect();
    let own = own.trim_matches('_');
    match own.chars().next() {
        Some(first) if first.is_ascii_alphabetic() => own.to_owned(),
        _ => format!("joint_{own}").trim_end_matches('_').to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) const PLANAR: &str = r#"{"format": "bolted-joint/1", "name": "M10 <½>", "joint": {"dofs": ["y", "theta"],
        "stiffness": [[5.73e5, 5820], [5820, 1290]], "damping": [[10.83, -0.83], [-0.83, 0.083]]}}"#;
    const CUBIC: &str = r#"{"format": "bolted-joint/1", "name": "cubic", "joint": {"dofs": ["y"], "stiffness": [[1e6]],
        "damping": [[2]], "cubic": [1e13]}}"#;
    const VALANIS: &str = r#"{"format": "bolted-joint/1", "name": "v", "joint": {"dofs": ["y"], "stiffness": [[1e6]],
        "damping": [[2]], "friction": [{"dof": "y", "law": "jenkins", "stiffness": 1e5, "slip_force": 10},
        {"dof": "y", "law": "iwan", "slip_force": 4000, "stiffness": 1.5e7, "exponent": -0.3, "ratio": 0.5}]}}"#;

    const ALL: [Target; 6] = [
        Target::Nastran,
        Target::Abaqus,
        Target::Calculix,
        Target::Ansys,
        Target::Matlab,
        Target::Modelica,
    ];

    pub(crate) fn options(at_rest: bool) -> Options {
        Options {
            identifier: "m10".to_owned(),
            nodes: [1, 2],
            rotation_nodes: [3, 4],
            first_number: 100,
            at_rest,
            units: Units::Si,
        }
    }

    fn converted(json: &str, target: Target, at_rest: bool) -> Result<Converted, ConvertError> {
        convert(
            &JointFile::from_json(json, "j").unwrap(),
            target,
            &options(at_rest),
        )
    }

    #[test]
    fn every_tool_gets_units_signs_and_no_strange_letters() {
        for target in ALL {
            let text = converted(PLANAR, target, false).unwrap().text;
            for expected in [
                "M10 <?>",
                "N, m, rad, s, kg",
                "load on side b = K (x_a - x_b)",
            ] {
                assert!(text.contains(expected), "{target:?}: {expected}: {text}");
            }
            // what people read is not wider than the cards of Nastran
            let marks = ["$ ", "** ", "! ", "% ", "// "];
            let comments = text
                .lines()
                .filter(|line| marks.iter().any(|mark| line.starts_with(mark)));
            for line in comments {
                assert!(line.len() <= 80, "{target:?}: {line}");
            }
            assert!(text.is_ascii(), "{target:?}");
            assert!(text.ends_with('\n'), "{target:?}");
        }
    }

    /// Words of a text without the marks of comments.
    fn words(text: &str) -> String {
        let words = text.split_whitespace();
        let words: Vec<&str> = words
            .filter(|word| !["$", "**", "!", "%", "//"].contains(word))
            .collect();
        words.join(" ")
    }

    #[test]
    fn every_tool_gets_the_notes_of_the_joint_file() {
        const NOTED: &str = r#"{"format": "bolted-joint/1", "name": "noted", "joint": {"dofs": ["y", "theta"],
            "stiffness": [[5.73e5, 0], [0, 1290]], "damping": [[10.83, 0], [0, 0.083]]},
            "provenance": {"tool": "t", "version": "1", "method": "m", "model": "full", "notes": [
            "This is the contact alone, not the joint: the bolt and the bending of the parts where they overlap are missing.",
            "Motions of the interface (normal z): y along x, theta about -y; the other relative motions are held at zero."]}}"#;
        for target in ALL {
            let text = words(&converted(NOTED, target, false).unwrap().text);
            for expected in [
                "This is the contact alone, not the joint: the bolt and the bending of the parts where they overlap are missing.",
                "Motions of the interface (normal z): y along x, theta about -y; the other relative motions are held at zero.",
            ] {
                assert!(text.contains(expected), "{target:?}: {text}");
            }
        }
    }

    #[test]
    fn what_is_left_out_and_what_is_wrong_stand_in_the_file() {
        const ACTIVE: &str = r#"{"format": "bolted-joint/1", "name": "a", "joint": {"dofs": ["y"], "stiffness": [[1e6]],
            "damping": [[-3]]}, "bodies": {"a": {"inertia": [2], "stiffness": [10], "damping": [0]},
            "b": {"inertia": [3], "stiffness": [0], "damping": [0]}}}"#;
        for target in ALL {
            let converted = converted(ACTIVE, target, false).unwrap();
            let text = words(&converted.text);
            for expected in [
                "the two bodies of the joint file",
                "CAN FEED ENERGY INTO A SIMULATION",
            ] {
                assert!(text.contains(expected), "{target:?}: {text}");
            }
            assert!(converted.notes.iter().any(|note| note.contains("bodies")));
        }
    }

    #[test]
    fn deviations_of_laws_are_told() {
        const SLIPPING: &str = r#"{"format": "bolted-joint/1", "name": "s", "joint": {"dofs": ["y"], "stiffness": [[0]],
            "damping": [[0]], "friction": [{"dof": "y", "law": "jenkins", "stiffness": 1e5, "slip_force": 10}]},
            "uncertainty": {"basis": "made up", "standard_deviation": {"stiffness": [[0]], "damping": [[0]],
            "friction": [{"dof": "y", "law": "jenkins", "stiffness": 3e3, "slip_force": 0.7}]}}}"#;
        for target in ALL {
            let text = words(&converted(SLIPPING, target, true).unwrap().text);
            let expected =
                "Standard deviations of jenkins on y: slip_force 0.70 N, stiffness 3000 N/m";
            let turned =
                "Standard deviations of jenkins on y: stiffness 3000 N/m, slip_force 0.70 N";
            assert!(
                text.contains(expected) || text.contains(turned),
                "{target:?}: {text}"
            );
        }
    }

    #[test]
    fn units_in_comments_have_their_powers() {
        const HIGHER: &str = r#"{"format": "bolted-joint/1", "name": "h", "joint": {"dofs": ["rz"], "stiffness": [[1e4]],
            "damping": [[2]], "cubic": [1e5],
            "higher": {"quintic": [1e6], "septic": [1e8], "damping_quadratic": [1], "damping_quartic": [3]}}}"#;
        let text = converted(HIGHER, Target::Matlab, false).unwrap().text;
        let unit = |name: &str| {
            let line = text.lines().find(|line| line.contains(name));
            line.and_then(|line| line.split("% ").nth(1))
                .map(str::to_owned)
        };
        // a moment over a power of an angle
        for (name, expected) in [
            ("p.k3_rz =", "N.m/rad^3"),
            ("p.k5_rz =", "N.m/rad^5"),
            ("p.k7_rz =", "N.m/rad^7"),
            ("p.c2_rz =", "N.m.s/rad^3"),
            ("p.c4_rz =", "N.m.s/rad^5"),
        ] {
            assert_eq!(unit(name).as_deref(), Some(expected), "{name}: {text}");
        }
    }

    #[test]
    fn what_a_tool_cannot_express_is_refused_or_said() {
        for target in ALL {
            let has_equations = matches!(target, Target::Matlab | Target::Modelica);
            assert_eq!(
                converted(CUBIC, target, false).is_ok(),
                has_equations,
                "{target:?}"
            );
            let refused = converted(VALANIS, target, false).unwrap_err().to_string();
            assert!(
                refused.contains("iwan on y") && refused.contains("--at-rest"),
                "{refused}"
            );
            let at_rest = converted(VALANIS, target, true).unwrap();
            assert!(
                at_rest.notes.iter().any(|note| note.contains("iwan on y")),
                "{target:?}"
            );
            // 1e6 + 1e5 of the slider that sticks, and 1.5e7 of the Iwan law at no load
            assert!(
                at_rest.text.contains("1.61"),
                "{target:?}: {}",
                at_rest.text
            );
        }
        for target in [
            Target::Nastran,
            Target::Abaqus,
            Target::Calculix,
            Target::Ansys,
        ] {
            let notes = converted(PLANAR, target, false).unwrap().notes;
            assert!(
                notes.iter().any(|note| note.contains("coupl")),
                "{target:?}: {notes:?}"
            );
        }
    }

    #[test]
    fn identifiers_are_made_of_any_text() {
        for (text, expected) in [
            ("M10x16 A2-70", "M10x16_A2_70"),
            ("10 N·m", "joint_10_N_m"),
            ("½", "joint"),
            ("a.joint", "a_joint"),
        ] {
            assert_eq!(identifier(text), expected);
        }
    }
}
