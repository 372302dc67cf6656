//! Which file of a folder is the assembly and which are the parts, by their names before anything else.

use super::Candidate;

impl Candidate {
    /// The words of its name, in small letters and without its ending.
    fn words(&self) -> Vec<String> {
        let name = self.name.to_lowercase();
        let stem = name.split('.').next().unwrap_or_default();
        let words = stem.split(|c: char| !c.is_alphanumeric());
        words
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect()
    }

    /// Whether one of the words of its name is this letter.
    pub(super) fn is_called(&self, letter: &str) -> bool {
        self.words().iter().any(|word| word == letter)
    }
}

/// Whether a file's name says that it is the assembly.
pub(super) fn is_named_assembly(own: &Candidate) -> bool {
    own.words().iter().any(|word| is_assembly(word))
}

/// By what a file was given its role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ToldBy {
    /// Its name, or the points of all parts that it has.
    ItsOwn,
    /// Its place among the names, which means nothing: its author has to look.
    Order,
}

impl ToldBy {
    /// What stands beside a role in the study.
    pub(super) fn comment(self, what: &str) -> String {
        match self {
            Self::ItsOwn => what.to_owned(),
            Self::Order => format!("CHECK: {what}? Guessed by the order of the files' names"),
        }
    }
}

/// Which of the files is the assembly. Names come before points and before the order: a folder with `a`, `b` and `ab` says it all.
pub(super) fn assembly(found: &[Candidate], is_in_space: bool) -> Option<(usize, ToldBy)> {
    let first = |is_one: &dyn Fn(&Candidate) -> bool| {
        found.iter().position(|own| !own.is_modal && is_one(own))
    };
    let of_two = |own: &Candidate| is_of_two(own, found);
    let of_all = |own: &Candidate| is_in_space && found.iter().all(|other| own.contains(other));
    let third = |own: &Candidate| {
        let name = own.name.to_lowercase();
        ["c.", "c_", "c-"].iter().any(|word| name.starts_with(word))
    };
    let told = first(&is_named_assembly)
        .or_else(|| first(&of_two))
        .or_else(|| first(&of_all))
        .or_else(|| first(&third));
    if let Some(place) = told {
        return Some((place, ToldBy::ItsOwn));
    }
    // what is called a or b is a part; of three files the third is what is left
    let is_part = |own: &Candidate| own.is_called("a") || own.is_called("b");
    let are_named =
        ["a", "b"].map(|letter| found.iter().filter(|own| own.is_called(letter)).count());
    let by = match (are_named, found.len()) {
        ([1, 1], 3) => ToldBy::ItsOwn,
        _ => ToldBy::Order,
    };
    let last = |is_one: &dyn Fn(&Candidate) -> bool| {
        found.iter().rposition(|own| !own.is_modal && is_one(own))
    };
    last(&|own| !is_part(own))
        .map(|place| (place, by))
        .or_else(|| last(&|_| true).map(|place| (place, ToldBy::Order)))
}

/// A word for parts that are bolted together.
fn is_assembly(word: &str) -> bool {
    let begins = ["assem", "asm", "joined", "bolted", "coupled"];
    word == "ab" || begins.iter().any(|known| word.starts_with(known))
}

/// Whether a file has the names of two others put together, such as `holder-tool` beside `holder` and `tool`.
fn is_of_two(own: &Candidate, found: &[Candidate]) -> bool {
    let whole = own.words().concat();
    let others = found.iter().filter(|other| other.name != own.name);
    let others: Vec<String> = others.map(|other| other.words().concat()).collect();
    let pairs = (0..others.len()).flat_map(|one| (0..others.len()).map(move |other| (one, other)));
    pairs
        .filter(|(one, other)| one != other)
        .any(|(one, other)| whole == format!("{}{}", others[one], others[other]))
}

/// The parts in their order, which is that of the letters they are called by, if one of them is called `a` and another `b`.
pub(super) fn in_order(parts: &mut [Candidate]) {
    let letter = |own: &Candidate| own.words().into_iter().find(|word| word.len() == 1);
    let has = |wanted: &str| {
        parts
            .iter()
            .any(|own| letter(own).is_some_and(|own| own == wanted))
    };
    if has("a") && has("b") {
        parts.sort_by_key(|own| letter(own).unwrap_or_else(|| "~".to_owned()));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::super::plane::{Part, Plane};
    use super::*;

    fn named(name: &str) -> Candidate {
        Candidate {
            name: name.to_owned(),
            further: Vec::new(),
            modes: None,
            is_modal: name.ends_with(".toml"),
            responses: BTreeSet::new(),
            references: BTreeSet::new(),
            pairs: BTreeSet::new(),
            band_hz: [0.0, 1.0],
            warning: None,
        }
    }

    #[test]
    fn names_tell_the_assembly_from_the_parts() {
        use ToldBy::{ItsOwn, Order};
        #[rustfmt::skip]
        let cases: &[(&[&str], &str, ToldBy, [&str; 2])] = &[
            (&["a.uff", "ab.uff", "b.uff"], "ab.uff", ItsOwn, ["a.uff", "b.uff"]),
            (&["frf_a.csv", "frf_ab.csv", "frf_b.csv"], "frf_ab.csv", ItsOwn, ["frf_a.csv", "frf_b.csv"]),
            (&["a.uff", "assembled.uff", "b.uff"], "assembled.uff", ItsOwn, ["a.uff", "b.uff"]),
            (&["a.uff", "b.uff", "test_coupled.uff"], "test_coupled.uff", ItsOwn, ["a.uff", "b.uff"]),
            (&["holder.csv", "holder-tool.csv", "tool.csv"], "holder-tool.csv", ItsOwn, ["holder.csv", "tool.csv"]),
            (&["a-modes.toml", "b.uff", "joined.uff"], "joined.uff", ItsOwn, ["a-modes.toml", "b.uff"]),
            (&["a.uff", "a2.uff", "assembly.uff", "b.uff"], "assembly.uff", ItsOwn, ["a.uff", "b.uff"]),
            (&["a.csv", "b.csv", "c.csv"], "c.csv", ItsOwn, ["a.csv", "b.csv"]),
            (&["1_whole.uff", "a.uff", "b.uff"], "1_whole.uff", ItsOwn, ["a.uff", "b.uff"]),
            (&["one.uff", "three.uff", "two.uff"], "two.uff", Order, ["one.uff", "three.uff"]),
            (&["a.uff", "b.uff", "one.uff", "two.uff"], "two.uff", Order, ["a.uff", "b.uff"]),
        ];
        for (names, expected, by, parts) in cases {
            let mut found: Vec<Candidate> = names.iter().map(|name| named(name)).collect();
            let (place, told) = assembly(&found, false).unwrap();
            assert_eq!(
                (found.remove(place).name.as_str(), told),
                (*expected, *by),
                "{names:?}"
            );
            in_order(&mut found);
            let found: Vec<&str> = found.iter().map(|own| own.name.as_str()).collect();
            assert_eq!(found[..2], *parts, "{names:?}");
        }
        let plane = Plane {
            a: Part::of(named("a.uff")),
            b: Part::of(named("b.uff")),
            assembly: named("z.uff"),
            by: Order,
        };
        let drafted = plane.text();
        assert_eq!(
            drafted.matches("Guessed by the order").count(),
            3,
            "{drafted}"
        );
    }
}
