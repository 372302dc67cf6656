//! What no validator looks at in a model description: bounds, capability flags, and that both versions say the same.

use bolted_joint::export::{FmiVersion, Interface};
use bolted_joint_dynamics::law::{Range, dof_parameters};
use bolted_joint_interface::Expanded;

use crate::xml::{Element, elements, named};
use crate::{export_as, text};

/// Attributes of `<ModelExchange>` and `<CoSimulation>` alike: FMI 3.0.2, section 2.4.1.1.
const FMI_3_COMMON: &str = "\
    modelIdentifier needsExecutionTool canBeInstantiatedOnlyOncePerProcess canGetAndSetFMUState \
    canSerializeFMUState providesDirectionalDerivatives providesAdjointDerivatives providesPerElementDependencies \
    providesEvaluateDiscreteStates";
/// FMI 3.0.2, section 3.4.
const FMI_3_MODEL_EXCHANGE: &str = "needsCompletedIntegratorStep";
/// FMI 3.0.2, section 4.4.
const FMI_3_CO_SIMULATION: &str = "\
    canHandleVariableCommunicationStepSize fixedInternalStepSize maxOutputDerivativeOrder \
    recommendedIntermediateInputSmoothness providesIntermediateUpdate mightReturnEarlyFromDoStep \
    canReturnEarlyAfterIntermediateUpdate hasEventMode";
/// FMI 2.0.5, sections 3.3.1 and 4.3.1.
const FMI_2_COMMON: &str = "\
    modelIdentifier needsExecutionTool canBeInstantiatedOnlyOncePerProcess canNotUseMemoryManagementFunctions \
    canGetAndSetFMUstate canSerializeFMUstate providesDirectionalDerivative";
/// FMI 2.0.5, section 3.3.1.
const FMI_2_MODEL_EXCHANGE: &str = "completedIntegratorStepNotNeeded";
/// FMI 2.0.5, section 4.3.1, as misspelt there.
const FMI_2_CO_SIMULATION: &str = "\
    canHandleVariableCommunicationStepSize canInterpolateInputs maxOutputDerivativeOrder canRunAsynchronuously";

const JOINTS: [(&str, Interface); 3] = [
    ("m10-aluminium.joint.json", Interface::Element),
    ("pirdayr-ex03.joint.json", Interface::Element),
    ("pirdayr-ex03.joint.json", Interface::Lap),
];

fn description(name: &str, interface: Interface, version: FmiVersion) -> String {
    let (fmu, _) = export_as(name, interface, version).unwrap();
    text(&fmu, "modelDescription.xml").unwrap()
}

/// Exported ones of both versions, and those of all joints, which have every variable.
fn all() -> Vec<(FmiVersion, String)> {
    let mut all = Expanded::present()
        .unwrap()
        .map(|of_all_joints| (FmiVersion::V3, of_all_joints.xml))
        .to_vec();
    for version in [FmiVersion::V2, FmiVersion::V3] {
        for (name, interface) in JOINTS {
            all.push((version, description(name, interface, version)));
        }
    }
    all
}

#[test]
fn every_capability_attribute_is_one_of_the_standard() {
    for (version, xml) in all() {
        let (common, model_exchange, co_simulation) = match version {
            FmiVersion::V2 => (FMI_2_COMMON, FMI_2_MODEL_EXCHANGE, FMI_2_CO_SIMULATION),
            FmiVersion::V3 => (FMI_3_COMMON, FMI_3_MODEL_EXCHANGE, FMI_3_CO_SIMULATION),
        };
        for (element, own) in [
            ("ModelExchange", model_exchange),
            ("CoSimulation", co_simulation),
        ] {
            let found = named(&xml, element);
            assert_eq!(found.len(), 1, "{version}: {element}");
            for name in found[0].attributes.keys() {
                let mut known = common.split(' ').chain(own.split(' '));
                assert!(
                    known.any(|known| known == name),
                    "{version}: {element}: {name}"
                );
            }
        }
    }
}

#[test]
fn start_values_lie_within_their_bounds_and_bounds_around_what_the_library_takes() {
    let mut bounded = 0;
    for (version, xml) in all() {
        let elements = elements(&xml);
        // FMI 2.0 has the numbers of type and variable in the element that follows.
        let (inner, type_tag, variable_tag) = match version {
            FmiVersion::V2 => (1, "SimpleType", "ScalarVariable"),
            FmiVersion::V3 => (0, "Float64Type", "Float64"),
        };
        let all_of = |tag: &str| -> Vec<(&str, &Element)> {
            let found = elements.iter().enumerate().filter(|(_, e)| e.name == tag);
            found
                .map(|(i, e)| (e.get("name").unwrap(), &elements[i + inner]))
                .collect()
        };
        let types = all_of(type_tag);
        for (name, variable) in all_of(variable_tag) {
            let declared = variable.get("declaredType").unwrap();
            let of_type = types.iter().find(|(name, _)| *name == declared).unwrap().1;
            let bound = |bound| variable.number(bound).or_else(|| of_type.number(bound));
            let Some(start) = variable.number("start") else {
                continue;
            };
            assert!(start.is_finite(), "{name}");
            assert!(bound("min").is_none_or(|min| min <= start), "{name}");
            assert!(bound("max").is_none_or(|max| start <= max), "{name}");
            bounded += usize::from(bound("min").is_some());
            // Zero is refused by the library, so it must not lie within the bounds.
            let of_body = name.strip_prefix("a.").or_else(|| name.strip_prefix("b."));
            let is_inertia =
                |own: &str| ["m", "J"].contains(&own.split('_').next().unwrap_or_default());
            let must_be_positive = of_body.is_some_and(is_inertia) || name == "step_size_max";
            // Without a law of friction, its parameters are zero.
            let may_be_zero = dof_parameters().any(|(law, parameter)| {
                let is_it = name.starts_with(&law.variable(parameter.symbol, ""));
                is_it && law.remembers() && parameter.range == Range::NotNegative
            });
            let least = if must_be_positive {
                Some(f64::MIN_POSITIVE)
            } else {
                may_be_zero.then_some(0.0)
            };
            assert_eq!(bound("min"), least, "{name}");
            let nominal = of_type.number("nominal");
            assert!(nominal.is_none_or(|nominal| nominal > 0.0), "{declared}");
        }
    }
    assert!(bounded > 10, "{bounded}");
}

#[rustfmt::skip]
const COMMON_OF_VARIABLES: [&str; 6] = ["name", "valueReference", "causality", "variability", "initial", "description"];

#[test]
fn both_versions_declare_the_same_variables() {
    for (name, interface) in JOINTS {
        let [two, three] = [FmiVersion::V2, FmiVersion::V3]
            .map(|version| elements(&description(name, interface, version)));
        let variables =
            |elements: &[Element], tag: &str, inner: usize, derivative: &dyn Fn(&str) -> String| {
                let found = elements.iter().enumerate().filter(|(_, e)| e.name == tag);
                found
                    .map(|(i, variable)| {
                        let numbers = &elements[i + inner];
                        let own =
                            COMMON_OF_VARIABLES.map(|name| variable.get(name).map(str::to_owned));
                        (
                            own,
                            numbers.get("declaredType").map(str::to_owned),
                            numbers.number("start"),
                            numbers.get("derivative").map(derivative),
                        )
                    })
                    .collect::<Vec<_>>()
            };
        let mut in_three = variables(&three, "Float64", 0, &|reference| reference.to_owned());
        // FMI 2.0 leaves the independent variable out
        in_three.retain(|(own, ..)| own[2].as_deref() != Some("independent"));
        // Indices count from 1 in the order of the file; references are what FMI 3.0 has in their place.
        let reference_of = |index: usize| in_three[index - 1].0[1].clone().unwrap();
        let in_two = variables(&two, "ScalarVariable", 1, &|index| {
            reference_of(index.parse().unwrap())
        });
        assert_eq!(in_two, in_three);
        assert!(in_two.len() > 10);

        let units = |elements: &[Element]| -> Vec<String> {
            let kept = "Unit BaseUnit DisplayUnit Category DefaultExperiment";
            let found = elements
                .iter()
                .filter(|e| kept.split(' ').any(|kept| kept == e.name));
            found
                .map(|e| format!("{e:?}").replace("fmi3", "fmi2"))
                .collect()
        };
        assert_eq!(units(&two), units(&three));
        let types = |elements: &[Element], tag: &str, inner: usize| -> Vec<_> {
            let found = elements.iter().enumerate().filter(|(_, e)| e.name == tag);
            found
                .map(|(i, e)| {
                    let mut attributes = elements[i + inner].attributes.clone();
                    attributes.insert("name".to_owned(), e.get("name").unwrap().to_owned());
                    attributes
                })
                .collect()
        };
        let of_two = types(&two, "SimpleType", 1);
        assert_eq!(of_two, types(&three, "Float64Type", 0));
    }
}

#[test]
fn both_versions_tell_the_same_dependencies() {
    for (name, interface) in JOINTS {
        let [two, three] =
            [FmiVersion::V2, FmiVersion::V3].map(|version| description(name, interface, version));
        let mut declared = named(&three, "Float64");
        // FMI 2.0 leaves the independent variable out
        declared.retain(|e| e.get("causality") != Some("independent"));
        let reference = |element: &Element| element.list("valueReference").unwrap()[0];
        let index_of = |wanted: usize| {
            let position = declared.iter().position(|e| reference(e) == wanted);
            position.unwrap() + 1
        };
        let is_parameter =
            |index: &usize| declared[index - 1].get("causality") == Some("parameter");
        for (list, element) in [
            ("Outputs", "Output"),
            ("Derivatives", "ContinuousStateDerivative"),
            ("InitialUnknowns", "InitialUnknown"),
        ] {
            let expected: Vec<_> = named(&three, element)
                .iter()
                .map(|unknown| {
                    let on = unknown.list("dependencies").unwrap();
                    let mut on: Vec<usize> = on.into_iter().map(index_of).collect();
                    on.sort_unstable();
                    // Only the initialisation knows parameters in FMI 2.0.
                    on.retain(|index| list == "InitialUnknowns" || !is_parameter(index));
                    (index_of(reference(unknown)), on)
                })
                .collect();
            let found: Vec<_> = match two.split_once(&format!("<{list}>")) {
                Some((_, rest)) => {
                    let within = rest.split(&format!("</{list}>")).next().unwrap();
                    named(within, "Unknown")
                        .iter()
                        .map(|unknown| {
                            let on = unknown.list("dependencies").unwrap();
                            let kinds = unknown.get("dependenciesKind");
                            let kinds = kinds.map(|kinds| kinds.split(' ').count());
                            assert!(kinds.is_none_or(|count| count == on.len()), "{list}");
                            assert_eq!(kinds.is_none(), list == "InitialUnknowns", "{list}");
                            (unknown.list("index").unwrap()[0], on)
                        })
                        .collect()
                }
                None => Vec::new(),
            };
            assert_eq!(found, expected, "{list}");
            let is_element = interface == Interface::Element;
            assert_eq!(found.is_empty(), list == "Derivatives" && is_element);
        }
    }
}

#[test]
fn fmi_2_claims_what_fmi_3_claims() {
    for (name, interface) in JOINTS {
        let [two, three] =
            [FmiVersion::V2, FmiVersion::V3].map(|version| description(name, interface, version));
        let pairs = [
            ("canGetAndSetFMUstate", "canGetAndSetFMUState"),
            ("canSerializeFMUstate", "canSerializeFMUState"),
            (
                "providesDirectionalDerivative",
                "providesDirectionalDerivatives",
            ),
            // of Co-Simulation alone
            ("canInterpolateInputs", "providesIntermediateUpdate"),
            ("maxOutputDerivativeOrder", "maxOutputDerivativeOrder"),
            (
                "canHandleVariableCommunicationStepSize",
                "canHandleVariableCommunicationStepSize",
            ),
        ];
        for (element, pairs) in [("ModelExchange", &pairs[..3]), ("CoSimulation", &pairs)] {
            let [two, three] = [&two, &three].map(|xml| named(xml, element).remove(0));
            for (old, new) in pairs {
                assert_eq!(two.get(old), three.get(new), "{element}: {old}");
                assert!(two.get(old).is_some(), "{element}: {old}");
            }
            assert_eq!(two.get("modelIdentifier"), three.get("modelIdentifier"));
        }
        let is_needed = (interface == Interface::Lap).to_string();
        let is_not_needed = (interface != Interface::Lap).to_string();
        for (xml, attribute, expected) in [
            (&three, FMI_3_MODEL_EXCHANGE, is_needed),
            (&two, FMI_2_MODEL_EXCHANGE, is_not_needed),
        ] {
            let found = named(xml, "ModelExchange").remove(0);
            assert_eq!(found.get(attribute), Some(&*expected), "{attribute}");
        }
        assert!(!two.contains("fmi3") && two.contains("numberOfEventIndicators=\"0\""));
    }
}
