//! `joint.friction`: laws with parameters of their own on one relative DOF, by the keys that each declares.

use std::fmt;

use bolted_joint_dynamics::{
    Dof, DofLaws, Polynomial,
    law::{
        DECLARATIONS, DOF_PARAMETER_COUNT, Declaration, Law, Outside, Parameter, dof_parameters,
    },
};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, MapAccess, Visitor},
    ser::SerializeMap as _,
};

use super::DofName;

/// Key of [`Friction::dof`].
pub(super) const DOF: &str = "dof";

/// Key of [`Friction::law`].
pub(super) const LAW: &str = "law";

/// A law on one relative DOF.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// The DOF, by its name: y is the same in a plane and in space.
    pub dof: &'static Dof,
    /// The law.
    pub law: &'static Declaration,
    /// Its parameters, in the order of its declaration and in SI units.
    pub parameters: Vec<f64>,
}

impl Friction {
    /// The kinds of laws that can stand there: all but those whose parameters are the joint's own lists and matrices.
    pub fn laws() -> impl Iterator<Item = &'static Declaration> {
        Self::all_laws().filter(|law| law.number == 1)
    }

    /// The laws that can stand there beside each other on a DOF, of some kinds several.
    pub(super) fn all_laws() -> impl Iterator<Item = &'static Declaration> {
        let polynomial = <Polynomial as Law<f64>>::DECLARATION.name;
        // the linear one is the first
        let on_dofs = DECLARATIONS.iter().skip(1);
        on_dofs.filter(move |law| law.name != polynomial)
    }

    /// This law on a DOF; `None` of a law that does not stand there.
    #[must_use]
    pub fn of<L: Law<f64>>(dof: &'static Dof, law: &L) -> Option<Self> {
        let declared = Self::laws().find(|declared| declared.name == L::DECLARATION.name)?;
        let mut parameters = vec![0.0; declared.parameters.len()];
        law.write(&mut parameters);
        Some(Self {
            dof,
            law: declared,
            parameters,
        })
    }

    /// The law at this share of the preload that it is stated for.
    pub(super) fn at_share_of_preload(&self, share: f64) -> Self {
        let mut own = self.clone();
        for (parameter, value) in own.law.parameters.iter().zip(&mut own.parameters) {
            if parameter.grows_with_preload {
                *value *= share;
            }
        }
        own
    }

    /// Value of a parameter of the law.
    #[must_use]
    pub fn value(&self, parameter: &Parameter) -> Option<f64> {
        self.keyed()
            .find(|(key, _)| *key == parameter.key)
            .map(|(_, value)| value)
    }

    /// The first parameter that is outside of the range of the law.
    pub(super) fn outside(&self) -> Option<Outside> {
        self.alone().outside().map(|(_, outside)| outside)
    }

    /// The same on the straight way to another one, with the share of the way.
    pub(super) fn outside_towards(&self, other: &Self) -> Option<(f64, Outside)> {
        let outside = self.alone().outside_towards(&other.alone());
        outside.map(|(share, _, outside)| (share, outside))
    }

    /// This law alone.
    fn alone(&self) -> DofLaws {
        let mut parameters = [0.0; DOF_PARAMETER_COUNT];
        for (own, (law, parameter)) in parameters.iter_mut().zip(dof_parameters()) {
            if law == self.law {
                *own = self.value(parameter).unwrap_or(0.0);
            }
        }
        DofLaws::new(parameters)
    }

    /// Each parameter's key with its value.
    pub(super) fn keyed(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let keys = self.law.parameters.iter().map(|parameter| parameter.key);
        keys.zip(self.parameters.iter().copied())
    }
}

impl Serialize for Friction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry(DOF, self.dof.name)?;
        map.serialize_entry(LAW, self.law.name)?;
        for (key, value) in self.keyed() {
            map.serialize_entry(key, &value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Friction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Entry)
    }
}

/// Reads the object; its keys depend on its law, which need not come first.
struct Entry;

impl<'de> Visitor<'de> for Entry {
    type Value = Friction;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("struct Friction")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Friction, A::Error> {
        let (mut dof, mut law) = (None, None);
        let mut values: Vec<(String, f64)> = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            let is_there = match key.as_str() {
                DOF => dof.replace(map.next_value::<DofName>()?.dof()).is_some(),
                LAW => law.replace(map.next_value::<LawName>()?.0).is_some(),
                _ => {
                    let value = map.next_value()?;
                    let is_there = values.iter().any(|(other, _)| *other == key);
                    values.push((key.clone(), value));
                    is_there
                }
            };
            if is_there {
                return Err(A::Error::custom(format!("duplicate field `{key}`")));
            }
        }
        let dof = dof.ok_or_else(|| A::Error::missing_field(DOF))?;
        let law = law.ok_or_else(|| A::Error::missing_field(LAW))?;
        let keys = || law.parameters.iter().map(|parameter| parameter.key);
        if let Some((found, _)) = values.iter().find(|(key, _)| keys().all(|own| own != key)) {
            return Err(unknown_field(found, [DOF, LAW].into_iter().chain(keys())));
        }
        let value = |key: &'static str| {
            let own = values.iter().find(|(found, _)| found == key);
            own.map(|&(_, value)| value)
                .ok_or_else(|| A::Error::missing_field(key))
        };
        Ok(Friction {
            dof,
            law,
            parameters: keys().map(value).collect::<Result<_, _>>()?,
        })
    }
}

/// As [`Error::unknown_field`], for keys that are known only here.
fn unknown_field<E: Error>(found: &str, known: impl Iterator<Item = &'static str>) -> E {
    let known: Vec<String> = known.map(|key| format!("`{key}`")).collect();
    E::custom(format!(
        "unknown field `{found}`, expected one of {}",
        known.join(", ")
    ))
}

/// A law by its name.
struct LawName(&'static Declaration);

impl<'de> Deserialize<'de> for LawName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let found = String::deserialize(deserializer)?;
        let law = Friction::laws().find(|law| law.name == found);
        law.map(Self).ok_or_else(|| {
            let known: Vec<&str> = Friction::laws().map(|law| law.name).collect();
            let expected = match known.as_slice() {
                [] => "none: no such law is known".to_owned(),
                _ => format!("one of {}", known.join(", ")),
            };
            D::Error::custom(format!("found {found:?}, expected {expected}"))
        })
    }
}
