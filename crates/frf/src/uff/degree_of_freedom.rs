//! Degrees of freedom in record 6: by number, or by name where a writer leaves the numbers at zero.

use super::UffProblem;
use super::header::{InRecord, integer};
use crate::Dof;

pub(super) fn dof(
    role: &'static str,
    name: &str,
    node: &str,
    direction: &str,
) -> Result<Dof, InRecord> {
    let node: u32 = integer(
        node,
        6,
        node_field(role),
        "a whole number that is not negative",
    )?;
    let direction = integer(
        direction,
        6,
        direction_field(role),
        "a whole number from -6 to 6",
    )?;
    let by_number =
        Dof::from_uff(node, direction).map_err(|source| (6, UffProblem::Dof { role, source }))?;
    // Some writers leave both numbers at zero and put the degree of freedom into the entity's name, as in ".56.Z".
    Ok(match (node, direction) {
        (0, 0) => dof_from_name(name).unwrap_or(by_number),
        _ => by_number,
    })
}

fn node_field(role: &str) -> &'static str {
    match role {
        "response" => "the response node",
        _ => "the reference node",
    }
}

fn direction_field(role: &str) -> &'static str {
    match role {
        "response" => "the response direction",
        _ => "the reference direction",
    }
}

/// `[COMPONENT].NODE.DIRECTION[SIGN]`, or with colons.
fn dof_from_name(name: &str) -> Option<Dof> {
    let separator = ['.', ':'];
    let mut parts = name.trim().rsplitn(3, separator);
    let (direction, node) = (parts.next()?, parts.next()?);
    let (sign, axis) = match direction.strip_suffix('-') {
        Some(axis) => ("-", axis),
        None => ("", direction.strip_suffix('+').unwrap_or(direction)),
    };
    format!("{node}:{sign}{axis}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_in_where_nodes_and_directions_are_all_zero() {
        for (name, expected) in [
            (".56.Z", "56:+Z"),
            (".1.Z-", "1:-Z"),
            ("beam:12:+Y", "12:+Y"),
            ("NONE", "0:0"),
            ("", "0:0"),
            (".a.Z", "0:0"),
        ] {
            assert_eq!(
                dof("response", name, "0", "0").unwrap().to_string(),
                expected,
                "{name}"
            );
        }
        assert_eq!(
            dof("response", ".56.Z", "3", "2").unwrap().to_string(),
            "3:+Y"
        );
    }
}
