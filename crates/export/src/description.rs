//! Writes an FMU's `modelDescription.xml`: that of all joints, without what the joint lacks, with the joint's values.

use std::collections::BTreeMap;

use bolted_joint_interface::{Expanded, Interface as Checked, Joints, Rows};
use fmi_schema::fmi3::{
    Causality, DefaultExperiment, DependenciesKind, Float64Type, Fmi3ModelDescription, Fmi3Unknown,
    FmiFloat64, TypeDefinition, Variable, VariableDependency,
};
use fmi_schema::traits::FmiModelDescription as _;
use fmi_schema::utils::AttrList;

use super::nominal::{Magnitudes, power_of_ten};
use super::step::Experiment;
use super::{ExportError, FmiVersion, Interface, Timestamp, fmi2, xml};
use bolted_joint_joint::{About, DofSet};

/// File name of the model description in an FMU.
pub(super) const FILE: &str = "modelDescription.xml";

/// A model description in the making.
pub(super) struct Description {
    tree: Fmi3ModelDescription,
    /// What the tree is made from.
    expanded: Expanded,
    version: FmiVersion,
}

impl Description {
    /// The interface as declared, without what belongs to DOFs that the joint does not have, and with what belongs to its law
    /// alone: the parameters of a constant one, or the preload of one over the preload.
    pub(super) fn new(
        interface: Interface,
        dofs: DofSet,
        law: Joints,
    ) -> Result<Self, ExportError> {
        let expanded = interface.expanded()?;
        let mut tree = Fmi3ModelDescription::deserialize(&expanded.xml)?;
        let rows = Rows::of(dofs.indices());
        drop_variables(&mut tree, |name| {
            !expanded
                .scope(name)
                .is_some_and(|scope| scope.includes(rows, law))
        });
        if law == Joints::OVER_PRELOAD {
            make_factors_change(&mut tree, &expanded);
        }
        if law.remembers() {
            tree.model_exchange
                .iter_mut()
                .for_each(|exchange| exchange.needs_completed_integrator_step = Some(true));
        }
        drop_unused_types(&mut tree);
        // Set last, by `finish`.
        tree.instantiation_token.clear();
        tree.generation_date_and_time = None;
        Ok(Self {
            tree,
            expanded,
            version: FmiVersion::default(),
        })
    }

    /// An interface whose variables are not those of a joint, but these; types, units and the time are those of the lap.
    pub(super) fn listing(
        variables: impl FnOnce(&Fmi3ModelDescription) -> (Vec<Float64Type>, Vec<FmiFloat64>),
        unknowns: Vec<VariableDependency>,
        remembers: bool,
    ) -> Result<Self, ExportError> {
        let expanded = Interface::Lap.expanded()?;
        let mut tree = Fmi3ModelDescription::deserialize(&expanded.xml)?;
        let (types, listed) = variables(&tree);
        if let Some(definitions) = &mut tree.type_definitions {
            let types = types.into_iter().map(TypeDefinition::Float64);
            definitions.type_definitions.extend(types);
        }
        let is_time = |variable: &Variable| matches!(variable, Variable::Float64(own) if own.causality == Some(Causality::Independent));
        let all = &mut tree.model_variables.variables;
        all.retain(is_time);
        all.extend(listed.into_iter().map(Variable::Float64));
        tree.model_structure.unknowns = unknowns;
        tree.model_exchange
            .iter_mut()
            .for_each(|exchange| exchange.needs_completed_integrator_step = Some(remembers));
        drop_unused_types(&mut tree);
        tree.instantiation_token.clear();
        tree.generation_date_and_time = None;
        Ok(Self {
            tree,
            expanded,
            version: FmiVersion::default(),
        })
    }

    /// The version of FMI that the text is written for; without this, 3.0.
    pub(super) fn set_version(&mut self, version: FmiVersion) {
        self.version = version;
    }

    /// Name of the model and one line about it.
    pub(super) fn set_names(&mut self, model_name: &str, description: String) {
        self.tree.model_name = model_name.to_owned();
        self.tree.description = Some(description);
        self.tree.generation_tool = Some(generation_tool());
    }

    pub(super) fn set_experiment(&mut self, experiment: Experiment) {
        let suggested = self
            .tree
            .default_experiment
            .get_or_insert_with(DefaultExperiment::default);
        suggested.start_time = Some(0.0);
        suggested.stop_time = Some(experiment.stop_s);
        suggested.step_size = Some(experiment.communication_step_s);
    }

    /// Gives every parameter its value, and returns names and values in the order of the file.
    pub(super) fn set_parameters(
        &mut self,
        value_of: impl Fn(&str) -> Option<f64>,
    ) -> Result<Vec<(String, f64)>, ExportError> {
        let mut parameters = Vec::new();
        for float64 in floats_mut(&mut self.tree) {
            if float64.causality == Some(Causality::Parameter) {
                let value = value_of(&float64.name).ok_or_else(|| ExportError::NoValue {
                    variable: float64.name.clone(),
                })?;
                float64.start = Some(AttrList(vec![value]));
                parameters.push((float64.name.clone(), value));
            }
        }
        Ok(parameters)
    }

    /// Gives types typical magnitudes: those of the parameters' start values, and these of other types. States keep theirs, which
    /// the library knows by itself.
    pub(super) fn set_nominals(&mut self, magnitudes: &Magnitudes) {
        let states: Vec<u32> = floats(&self.tree)
            .filter_map(|own| own.derivative)
            .collect();
        let mut sizes: BTreeMap<String, f64> = magnitudes
            .iter()
            .map(|(&name, &size)| (name.to_owned(), size))
            .collect();
        for own in floats(&self.tree) {
            let (Some(declared), Some(AttrList(start))) = (&own.declared_type, &own.start) else {
                continue;
            };
            if own.causality == Some(Causality::Parameter) {
                let size = start.iter().fold(0.0_f64, |size, own| size.max(own.abs()));
                let largest = sizes.entry(declared.clone()).or_insert(0.0);
                *largest = largest.max(size);
            }
        }
        for own in floats(&self.tree).filter(|own| states.contains(&own.value_reference)) {
            sizes.remove(own.declared_type.as_deref().unwrap_or_default());
        }
        let definitions = self.tree.type_definitions.iter_mut();
        for definition in definitions.flat_map(|all| &mut all.type_definitions) {
            if let TypeDefinition::Float64(own) = definition
                && let Some(size) = sizes.get(&own.name).copied().and_then(power_of_ten)
                && own.nominal.is_some()
            {
                own.nominal = Some(size);
            }
        }
    }

    /// Gives the preload of a joint over the preload its start value and, where its table ends, its range; N·m.
    pub(super) fn set_preload(&mut self, nominal_n_m: f64, range_n_m: Option<[f64; 2]>) {
        for float64 in floats_mut(&mut self.tree) {
            if is_preload(float64, &self.expanded) {
                float64.start = Some(AttrList(vec![nominal_n_m]));
                if let Some([first, last]) = range_n_m {
                    (float64.min, float64.max) = (Some(first), Some(last));
                }
            }
        }
    }

    /// Name of the shared library, without extension, and of what tools make of the FMU.
    pub(super) fn set_identifier(&mut self, identifier: &str) {
        let tree = &mut self.tree;
        let of_exchange = tree
            .model_exchange
            .iter_mut()
            .map(|own| &mut own.model_identifier);
        let of_simulation = tree
            .co_simulation
            .iter_mut()
            .map(|own| &mut own.model_identifier);
        of_exchange
            .chain(of_simulation)
            .for_each(|own| identifier.clone_into(own));
    }

    /// Who stands behind the model, and what others may do with it.
    pub(super) fn set_about(&mut self, about: Option<&About>) {
        let about = about.cloned().unwrap_or_default();
        self.tree.author = about.author;
        self.tree.version = about.version;
        self.tree.license = about.license;
        self.tree.copyright = about.copyright;
    }

    /// The text so far, which the token is made from.
    pub(super) fn text(&self) -> Result<String, ExportError> {
        match self.version {
            FmiVersion::V2 => Ok(fmi2::model_description(&self.tree)),
            FmiVersion::V3 => self.fmi3_text(),
        }
    }

    fn fmi3_text(&self) -> Result<String, ExportError> {
        Ok(indented(&self.tree.serialize()?))
    }

    /// What it declares so far, checked.
    pub(super) fn declared(&self) -> Result<Checked, ExportError> {
        Checked::from_xml(FILE, &self.fmi3_text()?)
            .map_err(|refused| ExportError::Interface(Box::new(refused)))
    }

    /// The finished text, and what it declares, checked in its FMI 3.0 form as the hand-written files are.
    pub(super) fn finish(
        mut self,
        token: &str,
        date: Timestamp,
    ) -> Result<(String, Checked), ExportError> {
        self.tree.instantiation_token = token.to_owned();
        self.tree.generation_date_and_time = Some(date.to_string());
        let checked = self.declared()?;
        Ok((self.text()?, checked))
    }
}

/// This program and its version.
pub(super) fn generation_tool() -> String {
    format!("bolted-joint {}", bolted_joint_files::VERSION)
}

/// The variables.
pub(super) fn floats(tree: &Fmi3ModelDescription) -> impl Iterator<Item = &FmiFloat64> {
    let variables = tree.model_variables.variables.iter();
    variables.filter_map(|variable| match variable {
        Variable::Float64(float64) => Some(float64),
        _ => None,
    })
}

fn floats_mut(tree: &mut Fmi3ModelDescription) -> impl Iterator<Item = &mut FmiFloat64> {
    let variables = tree.model_variables.variables.iter_mut();
    variables.filter_map(|variable| match variable {
        Variable::Float64(float64) => Some(float64),
        _ => None,
    })
}

/// Takes out every variable whose name is told to go, and every mention of one.
fn drop_variables(tree: &mut Fmi3ModelDescription, goes: impl Fn(&str) -> bool) {
    let mut dropped = Vec::new();
    tree.model_variables.variables.retain(|variable| {
        let Variable::Float64(float64) = variable else {
            return true;
        };
        let goes = goes(&float64.name);
        if goes {
            dropped.push(float64.value_reference);
        }
        !goes
    });
    // what was the derivative of a state that went is no derivative any more
    let mut no_derivatives = Vec::new();
    for float64 in floats_mut(tree) {
        if (float64.derivative).is_some_and(|state| dropped.contains(&state)) {
            float64.derivative = None;
            no_derivatives.push(float64.value_reference);
        }
    }
    let unknowns = &mut tree.model_structure.unknowns;
    unknowns.retain_mut(|unknown| {
        let is_derivative = matches!(unknown, VariableDependency::ContinuousStateDerivative(_));
        let reference = inner(unknown).value_reference;
        let goes =
            dropped.contains(&reference) || is_derivative && no_derivatives.contains(&reference);
        !goes
    });
    for unknown in unknowns {
        let unknown = inner(unknown);
        let Some(AttrList(dependencies)) = &mut unknown.dependencies else {
            continue;
        };
        if let Some(AttrList(kinds)) = &mut unknown.dependencies_kind {
            let mut references = dependencies.iter();
            kinds.retain(|_| {
                references
                    .next()
                    .is_none_or(|known| !dropped.contains(known))
            });
        }
        dependencies.retain(|known| !dropped.contains(known));
    }
}

/// What is linear in a known with a factor that only parameters change is no longer so where the preload changes that factor.
fn make_factors_change(tree: &mut Fmi3ModelDescription, expanded: &Expanded) {
    let inputs: Vec<u32> = floats(tree)
        .filter(|float64| is_preload(float64, expanded))
        .map(|float64| float64.value_reference)
        .collect();
    for unknown in &mut tree.model_structure.unknowns {
        let unknown = inner(unknown);
        let on_preload = unknown
            .dependencies
            .as_ref()
            .is_some_and(|AttrList(on)| on.iter().any(|known| inputs.contains(known)));
        if let (true, Some(AttrList(kinds))) = (on_preload, &mut unknown.dependencies_kind) {
            kinds.fill_with(|| DependenciesKind::Dependent);
        }
    }
}

/// Whether it is the input that the law of a joint over the preload follows.
fn is_preload(variable: &FmiFloat64, expanded: &Expanded) -> bool {
    variable.causality == Some(Causality::Input)
        && expanded
            .scope(&variable.name)
            .is_some_and(|scope| scope.is_only_of(Joints::OVER_PRELOAD))
}

fn inner(unknown: &mut VariableDependency) -> &mut Fmi3Unknown {
    match unknown {
        VariableDependency::Output(unknown)
        | VariableDependency::ContinuousStateDerivative(unknown)
        | VariableDependency::ClockedState(unknown)
        | VariableDependency::InitialUnknown(unknown)
        | VariableDependency::EventIndicator(unknown) => unknown,
    }
}

/// Takes out the types that no variable is declared with, then the units that no type has.
fn drop_unused_types(tree: &mut Fmi3ModelDescription) {
    let used: Vec<String> = floats(tree)
        .filter_map(|float64| float64.declared_type.clone())
        .collect();
    let mut units = Vec::new();
    if let Some(types) = &mut tree.type_definitions {
        types
            .type_definitions
            .retain(|definition| match definition {
                TypeDefinition::Float64(float64) => {
                    let stays = used.contains(&float64.name);
                    if stays {
                        units.extend(float64.unit.clone());
                    }
                    stays
                }
                _ => true,
            });
    }
    if let Some(definitions) = &mut tree.unit_definitions {
        definitions.units.retain(|unit| units.contains(&unit.name));
    }
}

/// Attributes whose value is one floating-point number.
const NUMBERS: &str = "start min max nominal factor offset startTime stopTime tolerance stepSize";

/// One element on each line, indented by its depth, under the XML declaration.
///
/// The writer escapes `<`, `>` and `"` in attribute values and writes no text, so each `<…>` is a tag. It writes
/// out all digits of a number, hundreds of them for the smallest, which are shortened here.
fn indented(xml: &str) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut depth = 0_usize;
    for tag in xml.split_inclusive('>') {
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        }
        text.extend(std::iter::repeat_n("  ", depth));
        push_tag(&mut text, tag);
        text.push('\n');
        if !tag.starts_with("</") && !tag.ends_with("/>") {
            depth += 1;
        }
    }
    text
}

/// `tag` with the shortest decimal for each of its numbers.
fn push_tag(text: &mut String, tag: &str) {
    let mut rest = tag;
    while let Some((name, after)) = rest.split_once("=\"")
        && let Some((value, after)) = after.split_once('"')
    {
        text.push_str(name);
        text.push_str("=\"");
        let attribute = name.rsplit(' ').next().unwrap_or(name);
        let is_number = NUMBERS.split(' ').any(|number| number == attribute);
        match value.parse() {
            Ok(parsed) if is_number => text.push_str(&xml::number(parsed)),
            _ => text.push_str(value),
        }
        text.push('"');
        rest = after;
    }
    text.push_str(rest);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_and_writing_loses_nothing() {
        for interface in [Interface::Element, Interface::Lap] {
            let xml = interface.expanded().unwrap().xml;
            let tree = Fmi3ModelDescription::deserialize(&xml).unwrap();
            let text = indented(&tree.serialize().unwrap());
            assert_eq!(Fmi3ModelDescription::deserialize(&text).unwrap(), tree);
            // The parser is strict, but could still leave out what it does not know: compare tags and attributes
            // with those of the file itself.
            assert_eq!(attributes(&text), attributes(&xml));
        }
    }

    /// Every attribute of every element, numbers as numbers, in sorted order: `Tag/name=value`.
    fn attributes(xml: &str) -> Vec<String> {
        let mut found = Vec::new();
        for tag in xml.split('<').skip(1) {
            let tag = tag.split('>').next().unwrap();
            if tag.starts_with(['?', '!', '/']) {
                continue;
            }
            let (name, mut rest) = tag.split_once(' ').unwrap_or((tag, ""));
            found.push(name.trim_end_matches('/').to_owned());
            while let Some((attribute, after)) = rest.split_once("=\"") {
                let (value, after) = after.split_once('"').unwrap();
                let value = value.replace("&apos;", "'");
                let value = value
                    .parse::<f64>()
                    .map_or(value.clone(), |number| format!("{number:?}"));
                found.push(format!("{name}/{}={value}", attribute.trim()));
                rest = after;
            }
        }
        found.sort();
        found
    }

    #[test]
    fn user_text_is_escaped() {
        let mut description =
            Description::new(Interface::Element, DofSet::TRANSLATION, Joints::CONSTANT).unwrap();
        let name = "M8 <\"steel\" & 'brass'> ü";
        description.set_names(name, format!("{name}: x"));
        let text = description.text().unwrap();
        assert!(
            text.contains("modelName=\"M8 &lt;&quot;steel&quot; &amp; &apos;brass&apos;&gt; ü\"")
        );
        let tree = Fmi3ModelDescription::deserialize(&text).unwrap();
        assert_eq!(tree.model_name, name);
    }

    #[test]
    fn nothing_of_the_rotation_is_left() {
        for interface in [Interface::Element, Interface::Lap] {
            let text = Description::new(interface, DofSet::TRANSLATION, Joints::CONSTANT)
                .unwrap()
                .text()
                .unwrap();
            for word in "theta omega .M\" .J\" rad Rotation Moment".split(' ') {
                assert!(!text.contains(word), "{interface}: {word}");
            }
            for word in "joint.k_yy joint.c_yy joint.k3_y a.y b.v N/m3".split(' ') {
                assert!(text.contains(word), "{interface}: {word}");
            }
        }
    }
}
