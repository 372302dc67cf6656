//! `joint.higher`: the terms of the polynomial law but the cubic one, each a list under the key that the law declares.

use std::fmt;

use bolted_joint_dynamics::{
    Polynomial,
    law::{TERM_COUNT, Term},
};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, MapAccess, Visitor},
};

/// Number of lists.
const COUNT: usize = TERM_COUNT - 1;

/// Key of [`HigherTerms::amplitude`].
pub(super) const AMPLITUDE: &str = "amplitude";

/// All keys, in the order of the file: those of the terms behind the cubic one, then the amplitude.
const KEYS: [&str; COUNT + 1] = {
    let mut keys = [AMPLITUDE; COUNT + 1];
    let mut index = 0;
    while index < COUNT {
        keys[index] = Term::ALL[index + 1].row().key;
        index += 1;
    }
    keys
};

/// Terms of higher order on each relative DOF. What is left out is zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HigherTerms {
    /// In the order of the law's parameters; empty where left out.
    lists: [Vec<f64>; COUNT],
    /// Largest relative displacement, m and rad, that the joint was observed at and its terms hold up to. Within it the joint
    /// must take energy; left out, it must at every displacement.
    pub amplitude: Vec<f64>,
}

impl HigherTerms {
    /// The terms there are, in the order of the file.
    pub fn terms() -> impl Iterator<Item = Term> {
        Term::ALL.into_iter().skip(1)
    }

    /// Those of these polynomials, one for each DOF, but their cubic springs; a term that none of them has is left out.
    #[must_use]
    pub fn of(polynomials: &[Polynomial], amplitude: Vec<f64>) -> Self {
        let mut all = Self {
            amplitude,
            ..Self::default()
        };
        for term in Self::terms() {
            let list: Vec<f64> = polynomials
                .iter()
                .map(|polynomial| polynomial.coefficient(term))
                .collect();
            if list.iter().any(|&coefficient| coefficient != 0.0) {
                all.set(term, list);
            }
        }
        all
    }

    /// Coefficients of a term on each DOF; empty where it is left out, and for the cubic spring, which is not among these.
    #[must_use]
    pub fn list(&self, term: Term) -> &[f64] {
        let place = term.index().checked_sub(1);
        place
            .and_then(|place| self.lists.get(place))
            .map_or(&[], Vec::as_slice)
    }

    /// Sets the coefficients of a term; of the cubic spring there are none here.
    pub fn set(&mut self, term: Term, list: Vec<f64>) {
        let place = term.index().checked_sub(1);
        if let Some(own) = place.and_then(|place| self.lists.get_mut(place)) {
            *own = list;
        }
    }

    /// Each key with its list, in the order of the file.
    pub(super) fn keyed(&self) -> impl Iterator<Item = (&'static str, &[f64])> {
        let lists = self.lists.iter().chain([&self.amplitude]);
        KEYS.into_iter().zip(lists.map(Vec::as_slice))
    }
}

impl Serialize for HigherTerms {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.keyed().filter(|(_, list)| !list.is_empty()))
    }
}

impl<'de> Deserialize<'de> for HigherTerms {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("HigherTerms", &KEYS, Lists)
    }
}

/// Reads the object.
struct Lists;

impl<'de> Visitor<'de> for Lists {
    type Value = HigherTerms;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("struct HigherTerms")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<HigherTerms, A::Error> {
        let mut read: [Option<Vec<f64>>; KEYS.len()] = Default::default();
        while let Some(Key(place)) = map.next_key()? {
            if read[place].is_some() {
                return Err(A::Error::duplicate_field(KEYS[place]));
            }
            read[place] = Some(map.next_value()?);
        }
        let mut lists = read.into_iter().map(Option::unwrap_or_default);
        Ok(HigherTerms {
            lists: std::array::from_fn(|_| lists.next().unwrap_or_default()),
            amplitude: lists.next().unwrap_or_default(),
        })
    }
}

/// Place of a key among all of them.
struct Key(usize);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_identifier(KeyVisitor)
    }
}

struct KeyVisitor;

impl Visitor<'_> for KeyVisitor {
    type Value = Key;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("field identifier")
    }

    fn visit_str<E: Error>(self, found: &str) -> Result<Key, E> {
        let place = KEYS.iter().position(|&key| key == found);
        place.map(Key).ok_or_else(|| E::unknown_field(found, &KEYS))
    }
}
