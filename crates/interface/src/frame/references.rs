//! Value references: the numbers by which importers know variables, and which no variable ever changes or takes over.

use std::collections::HashMap;

use crate::error::InterfaceProblem;

/// Value reference of each name: those of `list`, a name on each line, are counted from 0; the other names follow in their order.
pub(super) fn references<'n>(
    list: &'n str,
    names: impl Iterator<Item = &'n str>,
) -> Result<HashMap<String, u32>, InterfaceProblem> {
    let mut references = HashMap::new();
    for name in list.lines() {
        let number = references.len() as u32;
        if references.insert(name.to_owned(), number).is_some() {
            return Err(InterfaceProblem::ReferenceTwice {
                name: name.to_owned(),
            });
        }
    }
    for name in names {
        let number = references.len() as u32;
        references.entry(name.to_owned()).or_insert(number);
    }
    Ok(references)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_goes_before_and_new_names_follow() {
        let references = references("time\na.y\n", ["b.y", "time", "b.v", "b.y"].into_iter());
        let references = references.unwrap();
        assert_eq!(
            ["time", "a.y", "b.y", "b.v"].map(|name| references[name]),
            [0, 1, 2, 3]
        );
    }

    #[test]
    fn a_name_has_one_reference() {
        let problem = references("time\na.y\ntime\n", [].into_iter()).unwrap_err();
        let name = "time".to_owned();
        assert_eq!(problem, InterfaceProblem::ReferenceTwice { name });
    }
}
