//! The terms of the joint's law beyond stiffness and viscous damping: which of them a model has, and their names in studies.

use std::fmt;

use bolted_joint_dynamics::{
    DofKind, Polynomial,
    law::{TERM_COUNT, Term},
};
use bolted_joint_joint::unit;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{EnumAccess, Error, VariantAccess as _, Visitor},
};

use super::model::ResponseUnknown;
use super::slider::Slider;

/// The paper's name of the cubic spring.
const CUBIC_OF_PAPER: &str = "kN";

/// Names in a study: the terms' symbols, the paper's behind its own, then the laws that slip.
const NAMES: [&str; TERM_COUNT + 1 + Slider::ALL.len()] = {
    let mut names = [CUBIC_OF_PAPER; TERM_COUNT + 1 + Slider::ALL.len()];
    names[0] = Term::CUBIC.row().symbol;
    let mut index = 1;
    while index < TERM_COUNT {
        names[index + 1] = Term::ALL[index].row().symbol;
        index += 1;
    }
    let mut index = 0;
    while index < Slider::ALL.len() {
        names[TERM_COUNT + 1 + index] = Slider::ALL[index].name();
        index += 1;
    }
    names
};

/// SI unit of a term of a translation.
pub(super) fn unit_of(term: Term) -> String {
    let kind = DofKind::Translation;
    unit(term.row().unit, kind, kind)
}

/// Writes a term by its symbol.
pub(super) fn by_symbol<S: Serializer>(term: &Term, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(term.row().symbol)
}

/// Writes the coefficients as a list, in the order of [`Term::ALL`].
pub(super) fn as_list<S: Serializer>(terms: &Polynomial, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(Term::ALL.map(|term| terms.coefficient(term)))
}

/// A term or a law that slips, as a study names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NamedTerm {
    Term(Term),
    Slider(Slider),
}

impl<'de> Deserialize<'de> for NamedTerm {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("Term", &NAMES, NameVisitor)
    }
}

struct NameVisitor;

impl<'de> Visitor<'de> for NameVisitor {
    type Value = NamedTerm;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("enum Term")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<NamedTerm, A::Error> {
        let (name, rest) = data.variant::<String>()?;
        rest.unit_variant()?;
        let term = match name.as_str() {
            CUBIC_OF_PAPER => Some(Term::CUBIC),
            symbol => Term::named(symbol),
        };
        let mut sliders = Slider::ALL.into_iter();
        let slider = sliders.find(|slider| slider.name() == name);
        term.map(NamedTerm::Term)
            .or(slider.map(NamedTerm::Slider))
            .ok_or_else(|| A::Error::unknown_variant(&name, &NAMES))
    }
}

/// The terms that a model has, each once, and the law that slips beside them, if one does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TermSet {
    terms: Vec<Term>,
    slider: Option<Slider>,
}

impl TermSet {
    /// These terms, in their order in [`Term::ALL`].
    #[must_use]
    pub fn of(terms: &[Term]) -> Self {
        let all = Term::ALL.into_iter();
        Self {
            terms: all.filter(|term| terms.contains(term)).collect(),
            slider: None,
        }
    }

    /// The same beside a law that slips.
    #[must_use]
    pub fn beside(self, slider: Slider) -> Self {
        Self {
            slider: Some(slider),
            ..self
        }
    }

    /// The terms.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The law that slips.
    #[must_use]
    pub fn slider(&self) -> Option<Slider> {
        self.slider
    }

    /// About how long the search of a model takes, beside one of springs and dampers alone: what slips is computed loop by loop, and
    /// Iwan's law has most unknowns and corners. To tell how long the rest takes, and nothing else.
    pub(super) fn effort(&self) -> usize {
        match self.slider {
            None => 1,
            Some(Slider::Iwan) => 160,
            Some(_) => 20,
        }
    }

    /// What is unknown of them.
    pub(super) fn unknowns(&self) -> impl Iterator<Item = ResponseUnknown> + '_ {
        let terms = self.terms.iter().copied().map(ResponseUnknown::Term);
        let slider = self.slider.map_or(&[][..], Slider::parameters);
        terms.chain(slider.iter().copied().map(ResponseUnknown::Slider))
    }

    /// The models that are compared where a study leaves the choice: springs of growing order, each with dampers of growing order;
    /// laws that slip, alone and beside a cubic spring.
    #[must_use]
    pub fn candidates() -> Vec<Self> {
        let (dampers, springs): (Vec<Term>, Vec<Term>) =
            Term::ALL.into_iter().partition(|term| term.is_damper());
        let mut candidates = Vec::new();
        for d in 0..=dampers.len() {
            for s in 0..=springs.len() {
                candidates.push(Self::of(&[&springs[..s], &dampers[..d]].concat()));
            }
        }
        for slider in Slider::ALL {
            for s in 0..=1 {
                candidates.push(Self::of(&springs[..s]).beside(slider));
            }
        }
        candidates
    }

    fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        let symbols = self.terms.iter().map(|term| term.row().symbol);
        symbols.chain(self.slider.map(Slider::name))
    }
}

impl Serialize for TermSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.names())
    }
}

impl fmt::Display for TermSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.names().collect::<Vec<&str>>().as_slice() {
            [] => f.write_str("linear"),
            names => f.write_str(&names.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_are_distinct_and_begin_with_the_linear_model() {
        let candidates = TermSet::candidates();
        assert_eq!(candidates[0].to_string(), "linear");
        let springs = Term::ALL.iter().filter(|term| !term.is_damper()).count();
        let count = (springs + 1) * (TERM_COUNT - springs + 1) + 2 * Slider::ALL.len();
        assert_eq!(candidates.len(), count);
        assert!((1..count).all(|n| !candidates[..n].contains(&candidates[n])));
    }
}
