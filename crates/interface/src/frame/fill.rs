//! Goes through the lines of a frame and writes each for the DOFs and laws that it is for.

use std::collections::HashMap;

use super::{
    Declared, Expanded, Origin,
    filling::Filling,
    instance::Instance,
    laws::{LawMemory, LawParameter, law_memory, law_parameters},
    line::Line,
    types,
    unknowns::{INITIAL, Laws, Unknown},
    words::{self, Quantity},
};
use crate::{
    error::InterfaceProblem,
    scope::{Joints, Rows, Scope},
};

/// Elements that a frame has one line for.
const VARIABLE: &str = "Float64";
const UNKNOWNS: [&str; 4] = [
    "Output",
    "ContinuousStateDerivative",
    INITIAL,
    "EventIndicator",
];

/// A frame with its lines written for DOFs and laws, value references apart.
pub(super) struct Filled {
    file: &'static str,
    parts: Vec<Part>,
    pub(super) variables: Vec<Declared>,
    unknowns: Vec<Unknown>,
}

/// A piece of the text.
enum Part {
    Text(String),
    /// The variable at this place.
    Variable(usize),
    /// The unknown at this place.
    Unknown(usize),
}

impl Filled {
    pub(super) fn new(
        file: &'static str,
        frame: &str,
        filling: &Filling<'_>,
    ) -> Result<Self, InterfaceProblem> {
        let parameters = law_parameters(filling);
        let memory = law_memory(filling);
        let rates = memory.iter().filter_map(|memory| memory.rate.as_ref());
        let types: Vec<_> = parameters
            .iter()
            .map(|parameter| &parameter.declared_type)
            .chain(memory.iter().map(|memory| &memory.declared_type))
            .chain(rates.map(|rate| &rate.declared_type))
            .collect();
        let [units, definitions] = types::missing(frame, &types)?;
        let mut filler = Filler {
            filling,
            parameters: &parameters,
            memory: &memory,
            filled: Self {
                file,
                parts: Vec::new(),
                variables: Vec::new(),
                unknowns: Vec::new(),
            },
        };
        for (index, text) in frame.lines().enumerate() {
            match text.trim() {
                "</UnitDefinitions>" => filler.texts(&units),
                "</TypeDefinitions>" => filler.texts(&definitions),
                _ => {}
            }
            filler.line(text, index + 1)?;
        }
        Ok(filler.filled)
    }

    /// The model description, with these value references.
    pub(super) fn expanded(
        self,
        references: &HashMap<String, u32>,
    ) -> Result<Expanded, InterfaceProblem> {
        let mut xml = String::new();
        for part in &self.parts {
            match part {
                Part::Text(text) => xml.push_str(text),
                Part::Variable(place) => {
                    xml.push_str(&self.variables[*place].element(references)?);
                }
                Part::Unknown(place) => xml.push_str(&self.unknowns[*place].element(references)?),
            }
            xml.push('\n');
        }
        Ok(Expanded {
            file: self.file,
            xml,
            variables: self.variables,
        })
    }

    /// Adds a variable, or its DOF to one that is the same for another DOF.
    fn add_variable(&mut self, declared: Declared) {
        let mut variables = self.variables.iter_mut();
        match variables.find(|other| other.is_same_as(&declared)) {
            Some(same) => {
                same.scope.rows.extend(declared.scope.rows);
                same.origins.extend(declared.origins);
            }
            None => {
                self.parts.push(Part::Variable(self.variables.len()));
                self.variables.push(declared);
            }
        }
    }

    /// Adds an unknown, or what it depends on to the same one for another DOF.
    fn add_unknown(
        &mut self,
        mut unknown: Unknown,
        laws: &Laws<'_>,
    ) -> Result<(), InterfaceProblem> {
        unknown.complete(&self.unknowns, laws)?;
        let mut unknowns = self.unknowns.iter_mut();
        match unknowns.find(|other| other.is_same_as(&unknown)) {
            Some(same) => same.depend_also_as(unknown),
            None => {
                self.parts.push(Part::Unknown(self.unknowns.len()));
                self.unknowns.push(unknown);
            }
        }
        Ok(())
    }
}

impl Declared {
    fn is_same_as(&self, other: &Self) -> bool {
        self.line == other.line && self.scope.joints == other.scope.joints
    }

    /// The element of FMI.
    fn element(&self, references: &HashMap<String, u32>) -> Result<String, InterfaceProblem> {
        let reference = |name: &str| {
            let undefined = || InterfaceProblem::UndefinedName {
                line: self.number,
                name: name.to_owned(),
            };
            let number = references.get(name).ok_or_else(undefined);
            number.map(u32::to_string)
        };
        let mut element = Line::new(VARIABLE);
        element.push("name", self.name.clone());
        element.push("valueReference", reference(&self.name)?);
        for (attribute, value) in &self.line.attributes {
            match attribute.as_str() {
                "name" => {}
                "derivative" => element.push(attribute, reference(value)?),
                _ => element.push(attribute, value.clone()),
            }
        }
        Ok(element.to_string())
    }
}

/// What the lines of a frame are filled with.
struct Filler<'a> {
    filling: &'a Filling<'a>,
    parameters: &'a [LawParameter],
    memory: &'a [LawMemory],
    filled: Filled,
}

impl<'a> Filler<'a> {
    fn texts(&mut self, lines: &[String]) {
        self.filled
            .parts
            .extend(lines.iter().cloned().map(Part::Text));
    }

    fn line(&mut self, text: &str, number: usize) -> Result<(), InterfaceProblem> {
        let starts_with = |tag: &&&str| {
            let element = text.trim_start().strip_prefix('<');
            element
                .and_then(|element| element.strip_prefix(**tag))
                .is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_alphanumeric()))
        };
        let Some(tag) = std::iter::once(&VARIABLE)
            .chain(&UNKNOWNS)
            .find(starts_with)
        else {
            self.filled.parts.push(Part::Text(text.to_owned()));
            return Ok(());
        };
        let mut line = Line::parse(text).ok_or(InterfaceProblem::NotALine { line: number, tag })?;
        let each = line.take("each");
        let only = line.take("only");
        for instance in self.instances(each, number)? {
            if *tag == VARIABLE {
                let declared = self.variable(&line, only.as_deref(), &instance, number)?;
                self.filled.add_variable(declared);
            } else {
                let unknown = self.unknown(&line, &instance, number)?;
                let laws = self.laws();
                self.filled.add_unknown(unknown, &laws)?;
            }
        }
        Ok(())
    }

    /// What a line is written for.
    fn instances(
        &self,
        each: Option<String>,
        number: usize,
    ) -> Result<Vec<Instance<'a>>, InterfaceProblem> {
        Ok(match each.as_deref() {
            None => vec![Instance::Alone],
            Some("dof") => (0..self.filling.dofs.len()).map(Instance::Dof).collect(),
            Some("parameter") => self.parameters.iter().map(Instance::Parameter).collect(),
            Some("memory") => {
                let committed = self.memory.iter().filter(|memory| memory.rate.is_none());
                committed.map(Instance::Memory).collect()
            }
            Some("state") => {
                let integrated = self.memory.iter().filter(|memory| memory.rate.is_some());
                integrated.map(Instance::Memory).collect()
            }
            Some("rate") => {
                let integrated = self.memory.iter();
                let rate =
                    |memory: &'a LawMemory| Some(Instance::Rate(memory, memory.rate.as_ref()?));
                integrated.filter_map(rate).collect()
            }
            Some(found) => {
                return Err(InterfaceProblem::Word {
                    line: number,
                    attribute: "each",
                    found: found.to_owned(),
                    expected: "dof, parameter, memory, state or rate",
                });
            }
        })
    }

    fn variable(
        &self,
        line: &Line,
        only: Option<&str>,
        instance: &Instance<'_>,
        number: usize,
    ) -> Result<Declared, InterfaceProblem> {
        let mut line = line.clone();
        let pattern = line.get("name").unwrap_or_default().to_owned();
        for (attribute, value) in &mut line.attributes {
            let filled = words::filled(value, |placeholder| match attribute.as_str() {
                "name" | "derivative" => self.name(placeholder, instance),
                "declaredType" => self.declared_type(placeholder, instance),
                _ => self.word(placeholder, instance),
            });
            *value = filled.map_err(InterfaceProblem::placeholder(number))?;
        }
        Ok(Declared {
            name: self.checked_name(&line, number)?,
            scope: self.scope(only, instance, number)?,
            origins: vec![match instance {
                Instance::Alone => Origin::Alone,
                Instance::Dof(row) => Origin::Dof { pattern, row: *row },
                Instance::Parameter(parameter) => Origin::Parameter {
                    place: [parameter.law, parameter.parameter],
                    symbol: parameter.symbol,
                    at: parameter.at,
                },
                Instance::Memory(memory) => Origin::Memory([memory.law, memory.number, memory.row]),
                Instance::Rate(memory, _) => Origin::Rate([memory.law, memory.number, memory.row]),
            }],
            line,
            number,
        })
    }

    fn unknown(
        &self,
        line: &Line,
        instance: &Instance<'_>,
        number: usize,
    ) -> Result<Unknown, InterfaceProblem> {
        let mut line = line.clone();
        for (attribute, value) in &mut line.attributes {
            if attribute == "name" {
                *value = words::filled(value, |placeholder| self.name(placeholder, instance))
                    .map_err(InterfaceProblem::placeholder(number))?;
            }
        }
        let name = self.checked_name(&line, number)?;
        Unknown::new(&line, number, name, instance, &self.laws())
    }

    fn laws(&self) -> Laws<'a> {
        Laws {
            filling: self.filling,
            parameters: self.parameters,
            memory: self.memory,
        }
    }

    fn checked_name(&self, line: &Line, number: usize) -> Result<String, InterfaceProblem> {
        let name = line.get("name").map(str::to_owned);
        name.ok_or(InterfaceProblem::NoName { line: number })
    }

    /// A placeholder in a variable's name.
    fn name(&self, placeholder: &str, instance: &Instance<'_>) -> Option<String> {
        match (placeholder, instance) {
            ("parameter", Instance::Parameter(parameter)) => Some(parameter.name.clone()),
            ("memory", Instance::Memory(memory)) => Some(memory.name.clone()),
            ("state", Instance::Rate(memory, _)) => Some(memory.name.clone()),
            ("inner_rate", Instance::Rate(_, rate)) => Some(rate.name.clone()),
            _ => {
                let dof = &self.filling.dofs[instance.row()?];
                Some(Quantity::parse(placeholder)?.name(dof).to_owned())
            }
        }
    }

    /// A placeholder in the name of a type.
    fn declared_type(&self, placeholder: &str, instance: &Instance<'_>) -> Option<String> {
        match (placeholder, instance) {
            ("type", Instance::Parameter(parameter)) => Some(parameter.declared_type.name.clone()),
            ("type", Instance::Memory(memory)) => Some(memory.declared_type.name.clone()),
            ("type", Instance::Rate(_, rate)) => Some(rate.declared_type.name.clone()),
            _ => Some(words::type_name(&self.word(placeholder, instance)?)),
        }
    }

    /// A placeholder in any other attribute.
    fn word(&self, placeholder: &str, instance: &Instance<'_>) -> Option<String> {
        match (placeholder, instance) {
            ("description", Instance::Parameter(parameter)) => Some(parameter.description.clone()),
            ("description", Instance::Memory(memory)) => Some(memory.description.clone()),
            ("description", Instance::Rate(_, rate)) => Some(rate.description.clone()),
            ("start", Instance::Parameter(parameter)) => Some(types::number(parameter.start)),
            _ => words::word(placeholder, self.filling.dofs[instance.row()?].kind),
        }
    }

    fn scope(
        &self,
        only: Option<&str>,
        instance: &Instance<'_>,
        number: usize,
    ) -> Result<Scope, InterfaceProblem> {
        let joints = |default: Joints| match only {
            None => Ok(default),
            Some(words) => self.joints(words, number),
        };
        Ok(match instance {
            Instance::Alone | Instance::Dof(_) => Scope {
                rows: vec![instance.row().map_or(Rows::NONE, |row| Rows::of(&[row]))],
                joints: joints(Joints::ANY)?,
            },
            Instance::Parameter(LawParameter { scope, .. })
            | Instance::Memory(LawMemory { scope, .. })
            | Instance::Rate(LawMemory { scope, .. }, _) => Scope {
                rows: scope.rows.clone(),
                joints: joints(scope.joints)?,
            },
        })
    }

    /// The joints that an attribute `only` names.
    fn joints(&self, only: &str, number: usize) -> Result<Joints, InterfaceProblem> {
        let mut joints = Joints::NONE;
        for word in only.split_whitespace() {
            joints = joints.with(match word {
                "constant" => Joints::CONSTANT,
                "over_preload" => Joints::OVER_PRELOAD,
                "memory" => Joints::MEMORY,
                "turning" => Joints::that_commit(self.filling.laws),
                found => {
                    return Err(InterfaceProblem::Word {
                        line: number,
                        attribute: "only",
                        found: found.to_owned(),
                        expected: "constant, over_preload, memory or turning",
                    });
                }
            });
        }
        Ok(joints)
    }
}
