//! Numbers of nodes that the user gives: each may mean one thing alone.

use crate::{ConvertError, Options, Target};

/// Largest number of a node in a field of eight characters.
const LARGEST_OF_NASTRAN: u32 = 99_999_999;

/// Auxiliary nodes of CalculiX: one for each relative motion, and one that it is held against.
const AUXILIARY: u32 = 12;

/// Refuses numbers for a joint that `turns` or does not.
pub(crate) fn check(target: Target, options: &Options, turns: bool) -> Result<(), ConvertError> {
    let [a, b] = options.nodes;
    if target.has_nodes() && a == b {
        return refuse("--nodes", format!("{a} twice"), "two nodes");
    }
    if target == Target::Nastran {
        let too_large = options
            .nodes
            .iter()
            .find(|node| **node > LARGEST_OF_NASTRAN);
        if let Some(node) = too_large {
            let expected =
                format!("numbers up to {LARGEST_OF_NASTRAN}, which Nastran's fields hold");
            return refuse("--nodes", node.to_string(), expected);
        }
    }
    if target == Target::Calculix {
        // nodes that nothing refers to are none
        let rotation_nodes = if turns {
            &options.rotation_nodes[..]
        } else {
            &[]
        };
        if let [one, other] = rotation_nodes
            && (one == other
                || [one, other]
                    .into_iter()
                    .any(|node| options.nodes.contains(node)))
        {
            let found = format!("{one} and {other} beside the nodes {a} and {b}");
            return refuse("--rotation-nodes", found, "nodes of their own");
        }
        let first = options.first_number;
        let own = first..first.saturating_add(AUXILIARY);
        let mut given = options.nodes.iter().chain(rotation_nodes);
        if let Some(node) = given.find(|node| own.contains(node)) {
            let found = format!("{first}, which makes {node} an auxiliary node, too");
            let expected = format!("the first of {AUXILIARY} numbers that no node has");
            return refuse("--first-number", found, expected);
        }
    }
    Ok(())
}

fn refuse(
    key: &'static str,
    found: String,
    expected: impl Into<String>,
) -> Result<(), ConvertError> {
    Err(ConvertError::Numbers {
        key,
        found,
        expected: expected.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Units;

    fn options(nodes: [u32; 2], rotation_nodes: [u32; 2], first_number: u32) -> Options {
        Options {
            identifier: "joint".to_owned(),
            nodes,
            rotation_nodes,
            first_number,
            at_rest: false,
            units: Units::Si,
        }
    }

    #[test]
    fn every_number_means_one_thing() {
        let refused = |target, options: &Options| {
            check(target, options, true).map_err(|refused| refused.to_string())
        };
        let usual = options([1, 2], [3, 4], 1001);
        for target in [
            Target::Calculix,
            Target::Nastran,
            Target::Ansys,
            Target::Matlab,
        ] {
            refused(target, &usual).unwrap();
        }
        for (target, options, says) in [
            (
                Target::Calculix,
                options([1001, 1002], [3, 4], 1001),
                "--first-number: found 1001",
            ),
            (
                Target::Calculix,
                options([1, 2], [3, 1012], 1001),
                "makes 1012 an auxiliary node",
            ),
            (
                Target::Calculix,
                options([1, 2], [1, 2], 1001),
                "--rotation-nodes: found 1 and 2",
            ),
            (
                Target::Calculix,
                options([1, 2], [3, 3], 1001),
                "--rotation-nodes: found 3 and 3",
            ),
            (
                Target::Ansys,
                options([7, 7], [3, 4], 1001),
                "--nodes: found 7 twice",
            ),
            (
                Target::Nastran,
                options([1, 100_000_000], [3, 4], 1001),
                "up to 99999999",
            ),
        ] {
            let message = refused(target, &options).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        refused(Target::Calculix, &options([1, 2], [3, 1013], 1001)).unwrap();
        check(Target::Calculix, &options([3, 4], [3, 4], 1001), false).unwrap();
    }
}
