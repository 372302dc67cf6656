//! The FMI 2.0 form of a model description, derived from that of FMI 3.0.
//!
//! Written here and not by `fmi-schema`, whose FMI 2.0 part puts the log categories before the units, writes lists that
//! the schema wants left out where they are empty, and leaves out empty lists of dependencies, which then mean "all".

use fmi_schema::fmi3::{
    Causality, DependenciesKind, Float64Type, Fmi3CoSimulation, Fmi3ModelDescription,
    Fmi3ModelExchange, Fmi3Unit, Fmi3Unknown, FmiFloat64, TypeDefinition,
};

use super::FmiVersion;
use super::description::floats;
use super::xml::{Attributes, Document};

/// The text of `modelDescription.xml`.
pub(super) fn model_description(tree: &Fmi3ModelDescription) -> String {
    let variables = Variables::of(tree);
    let mut document = Document::new();
    let root = Attributes::new()
        .with("fmiVersion", FmiVersion::V2.number())
        .with("modelName", &tree.model_name)
        .with("guid", &tree.instantiation_token)
        .maybe("description", tree.description.as_ref())
        .maybe("author", tree.author.as_ref())
        .maybe("version", tree.version.as_ref())
        .maybe("copyright", tree.copyright.as_ref())
        .maybe("license", tree.license.as_ref())
        .maybe("generationTool", tree.generation_tool.as_ref())
        .maybe(
            "generationDateAndTime",
            tree.generation_date_and_time.as_ref(),
        )
        .maybe(
            "variableNamingConvention",
            tree.variable_naming_convention.as_ref(),
        )
        .with(
            "numberOfEventIndicators",
            tree.model_structure.event_indicators().count(),
        );
    document.element("fmiModelDescription", root, |document| {
        if let Some(declared) = &tree.model_exchange {
            document.empty("ModelExchange", model_exchange(declared));
        }
        if let Some(declared) = &tree.co_simulation {
            document.empty("CoSimulation", co_simulation(declared));
        }
        units(document, tree);
        types(document, tree);
        log_categories(document, tree);
        if let Some(experiment) = &tree.default_experiment {
            let attributes = Attributes::new()
                .number("startTime", experiment.start_time)
                .number("stopTime", experiment.stop_time)
                .number("tolerance", experiment.tolerance)
                .number("stepSize", experiment.step_size);
            document.empty("DefaultExperiment", attributes);
        }
        document.element("ModelVariables", Attributes::new(), |document| {
            for float64 in &variables.0 {
                variable(document, float64, &variables);
            }
        });
        document.element("ModelStructure", Attributes::new(), |document| {
            structure(document, tree, &variables);
        });
    });
    document.finish()
}

/// Adds the capabilities that are the last ones of either interface type.
macro_rules! with_common {
    ($attributes:expr, $declared:expr) => {
        $attributes
            .maybe(
                "canBeInstantiatedOnlyOncePerProcess",
                $declared.can_be_instantiated_only_once_per_process,
            )
            .with("canNotUseMemoryManagementFunctions", true)
            .maybe("canGetAndSetFMUstate", $declared.can_get_and_set_fmu_state)
            .maybe("canSerializeFMUstate", $declared.can_serialize_fmu_state)
            .maybe(
                "providesDirectionalDerivative",
                $declared.provides_directional_derivatives,
            )
    };
}

fn model_exchange(declared: &Fmi3ModelExchange) -> Attributes {
    let needs_completed_step = declared.needs_completed_integrator_step == Some(true);
    let own = Attributes::new()
        .with("modelIdentifier", &declared.model_identifier)
        .maybe("needsExecutionTool", declared.needs_execution_tool)
        .with("completedIntegratorStepNotNeeded", !needs_completed_step);
    with_common!(own, declared)
}

fn co_simulation(declared: &Fmi3CoSimulation) -> Attributes {
    let own = Attributes::new()
        .with("modelIdentifier", &declared.model_identifier)
        .maybe("needsExecutionTool", declared.needs_execution_tool)
        .maybe(
            "canHandleVariableCommunicationStepSize",
            declared.can_handle_variable_communication_step_size,
        )
        // What takes inputs at its own steps in FMI 3.0 takes their derivatives in FMI 2.0.
        .maybe(
            "canInterpolateInputs",
            declared.provides_intermediate_update,
        )
        .maybe(
            "maxOutputDerivativeOrder",
            declared.max_output_derivative_order,
        )
        .with("canRunAsynchronuously", false);
    with_common!(own, declared)
}

fn units(document: &mut Document, tree: &Fmi3ModelDescription) {
    let Some(definitions) = &tree.unit_definitions else {
        return;
    };
    document.element("UnitDefinitions", Attributes::new(), |document| {
        for unit in &definitions.units {
            let name = Attributes::new().with("name", &unit.name);
            document.element("Unit", name, |document| unit_content(document, unit));
        }
    });
}

fn unit_content(document: &mut Document, unit: &Fmi3Unit) {
    if let Some(base) = &unit.base_unit {
        let attributes = Attributes::new()
            .maybe("kg", base.kg)
            .maybe("m", base.m)
            .maybe("s", base.s)
            .maybe("A", base.a)
            .maybe("K", base.k)
            .maybe("mol", base.mol)
            .maybe("cd", base.cd)
            .maybe("rad", base.rad)
            .number("factor", base.factor)
            .number("offset", base.offset);
        document.empty("BaseUnit", attributes);
    }
    for display in &unit.display_unit {
        let attributes = Attributes::new()
            .with("name", &display.name)
            .number("factor", display.factor)
            .number("offset", display.offset);
        document.empty("DisplayUnit", attributes);
    }
}

fn types(document: &mut Document, tree: &Fmi3ModelDescription) {
    let Some(definitions) = &tree.type_definitions else {
        return;
    };
    document.element("TypeDefinitions", Attributes::new(), |document| {
        for definition in &definitions.type_definitions {
            if let TypeDefinition::Float64(float64) = definition {
                let attributes = Attributes::new()
                    .with("name", &float64.name)
                    .maybe("description", float64.description.as_ref());
                document.element("SimpleType", attributes, |document| {
                    document.empty("Real", real_type(float64));
                });
            }
        }
    });
}

fn real_type(declared: &Float64Type) -> Attributes {
    Attributes::new()
        .maybe("quantity", declared.quantity.as_ref())
        .maybe("unit", declared.unit.as_ref())
        .maybe("displayUnit", declared.display_unit.as_ref())
        .maybe("relativeQuantity", declared.relative_quantity)
        .number("min", declared.min)
        .number("max", declared.max)
        .number("nominal", declared.nominal)
        .maybe("unbounded", declared.unbounded)
}

fn log_categories(document: &mut Document, tree: &Fmi3ModelDescription) {
    let Some(list) = &tree.log_categories else {
        return;
    };
    document.element("LogCategories", Attributes::new(), |document| {
        for category in &list.categories {
            let description = category.description.as_ref();
            let attributes = Attributes::new().with("name", &category.name).maybe(
                "description",
                description.map(|text| text.replace("fmi3", "fmi2")),
            );
            document.empty("Category", attributes);
        }
    });
}

/// The variables in their order, which the indices of FMI 2.0 count from 1.
struct Variables<'a>(Vec<&'a FmiFloat64>);

impl<'a> Variables<'a> {
    fn of(tree: &'a Fmi3ModelDescription) -> Self {
        // the independent variable may be left out, and tools that make a block of an FMU have a time of their own
        let is_time = |own: &&FmiFloat64| own.causality == Some(Causality::Independent);
        Self(floats(tree).filter(|own| !is_time(own)).collect())
    }

    fn index(&self, reference: u32) -> Option<usize> {
        let position = self
            .0
            .iter()
            .position(|variable| variable.value_reference == reference)?;
        Some(position + 1)
    }

    fn is_parameter(&self, reference: u32) -> bool {
        self.0.iter().any(|variable| {
            variable.value_reference == reference
                && variable.causality == Some(Causality::Parameter)
        })
    }
}

fn variable(document: &mut Document, declared: &FmiFloat64, variables: &Variables<'_>) {
    let attributes = Attributes::new()
        .with("name", &declared.name)
        .with("valueReference", declared.value_reference)
        .maybe("description", declared.description.as_ref())
        .maybe("causality", declared.causality)
        .maybe("variability", declared.variability)
        .maybe("initial", declared.initial);
    document.element("ScalarVariable", attributes, |document| {
        let start = declared.start.as_ref().and_then(|start| start.first());
        let real = Attributes::new()
            .maybe("declaredType", declared.declared_type.as_ref())
            .number("min", declared.min)
            .number("max", declared.max)
            .number("start", start.copied())
            .maybe(
                "derivative",
                declared
                    .derivative
                    .and_then(|reference| variables.index(reference)),
            );
        document.empty("Real", real);
    });
}

fn structure(document: &mut Document, tree: &Fmi3ModelDescription, variables: &Variables<'_>) {
    let structure = &tree.model_structure;
    // The knowns of outputs and derivatives are inputs, states and time, those of the initialisation also parameters
    // (FMI 2.0.5, section 2.2.8).
    let at_points =
        |unknown| Dependencies::of(unknown, variables, |vr| !variables.is_parameter(vr));
    let initially = |unknown| Dependencies::of(unknown, variables, |_| true);
    let mut initial: Vec<_> = structure.initial_unknowns().map(initially).collect();
    initial.sort_by_key(|unknown| unknown.index);
    for (name, unknowns) in [
        ("Outputs", structure.outputs().map(at_points).collect()),
        (
            "Derivatives",
            structure
                .continuous_state_derivatives()
                .map(at_points)
                .collect(),
        ),
        ("InitialUnknowns", initial),
    ] {
        let unknowns: Vec<Dependencies<'_>> = unknowns;
        if unknowns.is_empty() {
            continue;
        }
        document.element(name, Attributes::new(), |document| {
            for unknown in unknowns {
                document.empty("Unknown", unknown.attributes());
            }
        });
    }
}

/// What an unknown depends on, by index.
struct Dependencies<'a> {
    index: Option<usize>,
    /// `None`: on everything. The kind goes with each, or with none.
    on: Option<Vec<(usize, Option<&'a DependenciesKind>)>>,
}

impl<'a> Dependencies<'a> {
    fn of(
        unknown: &'a Fmi3Unknown,
        variables: &Variables<'_>,
        is_known: impl Fn(u32) -> bool,
    ) -> Self {
        let kinds = unknown.dependencies_kind.as_ref();
        let on = unknown.dependencies.as_ref().map(|references| {
            let mut on: Vec<_> = references
                .iter()
                .enumerate()
                .filter(|&(_, &reference)| is_known(reference))
                .filter_map(|(position, &reference)| {
                    let kind = kinds.and_then(|kinds| kinds.get(position));
                    Some((variables.index(reference)?, kind))
                })
                .collect();
            on.sort_by_key(|&(index, _)| index);
            on
        });
        Self {
            index: variables.index(unknown.value_reference),
            on,
        }
    }

    fn attributes(&self) -> Attributes {
        let list = |words: Vec<String>| words.join(" ");
        let indices = self
            .on
            .as_ref()
            .map(|on| list(on.iter().map(|(index, _)| index.to_string()).collect()));
        let kinds = self.on.as_ref().and_then(|on| {
            let kinds: Option<Vec<String>> = on
                .iter()
                .map(|(_, kind)| kind.map(ToString::to_string))
                .collect();
            kinds.filter(|kinds| !kinds.is_empty()).map(list)
        });
        Attributes::new()
            .maybe("index", self.index)
            .maybe("dependencies", indices)
            .maybe("dependenciesKind", kinds)
    }
}
