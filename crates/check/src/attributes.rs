//! Attributes that the standard knows: the schema of FMI 3.0 lets any other through, so that a misspelt capability is
//! silently none.

use bolted_joint_importer::FmiVersion;
use roxmltree::Node;

use super::described::{FILE, child, elements};

/// Names, separated by white space.
type Names = &'static str;

/// Attributes of `<fmiModelDescription>`.
fn of_root(version: FmiVersion) -> [Names; 2] {
    const BOTH: Names = "fmiVersion modelName description author version copyright license generationTool \
                         generationDateAndTime variableNamingConvention";
    match version {
        FmiVersion::Two => [BOTH, "guid numberOfEventIndicators"],
        FmiVersion::Three => [BOTH, "instantiationToken"],
    }
}

/// Capabilities that both interface types have (FMI 2.0, 3.3.1 and 4.3.1; FMI 3.0, 2.4.1).
fn of_both_interfaces(version: FmiVersion) -> Names {
    match version {
        FmiVersion::Two => {
            "needsExecutionTool canBeInstantiatedOnlyOncePerProcess canNotUseMemoryManagementFunctions \
             canGetAndSetFMUstate canSerializeFMUstate providesDirectionalDerivative"
        }
        FmiVersion::Three => {
            "needsExecutionTool canBeInstantiatedOnlyOncePerProcess canGetAndSetFMUState canSerializeFMUState \
             providesDirectionalDerivatives providesAdjointDerivatives providesPerElementDependencies"
        }
    }
}

/// Capabilities of one interface type alone that are true or false, and those that are something else.
fn of_interface(version: FmiVersion, element: &str) -> [Names; 2] {
    match (version, element) {
        (FmiVersion::Two, "ModelExchange") => ["completedIntegratorStepNotNeeded", ""],
        (FmiVersion::Two, _) => [
            "canHandleVariableCommunicationStepSize canInterpolateInputs canRunAsynchronuously",
            "maxOutputDerivativeOrder",
        ],
        (FmiVersion::Three, "ModelExchange") => [
            "needsCompletedIntegratorStep providesEvaluateDiscreteStates",
            "",
        ],
        (FmiVersion::Three, _) => [
            "canHandleVariableCommunicationStepSize providesIntermediateUpdate mightReturnEarlyFromDoStep \
             canReturnEarlyAfterIntermediateUpdate hasEventMode providesEvaluateDiscreteStates",
            "fixedInternalStepSize maxOutputDerivativeOrder recommendedIntermediateInputSmoothness",
        ],
    }
}

/// What every variable may have.
const GENERAL: Names = "name valueReference description causality variability initial canHandleMultipleSetPerTimeInstant";
/// What every variable of FMI 3.0 may have beside that.
const GENERAL_FMI3: Names = "intermediateUpdate previous clocks";
/// What a number may have: with FMI 2.0 in an element of its own.
const REAL: Names = "declaredType quantity unit displayUnit relativeQuantity unbounded min max nominal start derivative reinit";

/// Attributes that the standard does not know, and capabilities that are neither true nor false.
pub(super) fn findings(root: Node<'_, '_>, version: FmiVersion) -> Vec<String> {
    let mut findings = unknown(root, &of_root(version));
    for name in ["CoSimulation", "ModelExchange"] {
        let Some(element) = child(root, name) else {
            continue;
        };
        let both = of_both_interfaces(version);
        let [flags, others] = of_interface(version, name);
        findings.extend(unknown(element, &[both, flags, others, "modelIdentifier"]));
        for flag in words(&[both, flags]) {
            match element.attribute(flag) {
                None | Some("true" | "false" | "0" | "1") => {}
                Some(found) => findings.push(format!(
                    "{FILE}: found {flag}=\"{found}\" of <{name}>, expected true or false"
                )),
            }
        }
    }
    for variable in elements(child(root, "ModelVariables")) {
        match version {
            FmiVersion::Two => {
                findings.extend(unknown(variable, &[GENERAL]));
                let children = elements(Some(variable));
                let numbers = children.filter(|node| node.has_tag_name("Real"));
                findings.extend(numbers.flat_map(|real| unknown(real, &[REAL])));
            }
            FmiVersion::Three => {
                findings.extend(unknown(variable, &[GENERAL, GENERAL_FMI3, REAL]));
            }
        }
    }
    findings
}

fn words(lists: &[Names]) -> impl Iterator<Item = &'static str> {
    lists.iter().flat_map(|list| list.split_whitespace())
}

/// Attributes of `element`, without those of other namespaces, that are not in `known`.
fn unknown(element: Node<'_, '_>, known: &[Names]) -> Vec<String> {
    let name = element.tag_name().name();
    let which = element
        .attribute("name")
        .map_or_else(String::new, |name| format!(" {name}"));
    element
        .attributes()
        .filter(|found| {
            found.namespace().is_none() && !words(known).any(|name| name == found.name())
        })
        .map(|found| {
            let similar = words(known).find(|name| name.eq_ignore_ascii_case(found.name()));
            let meant = similar.map_or_else(String::new, |name| format!("; did you mean {name}?"));
            format!(
                "{FILE}: found attribute {} of <{name}>{which}, which the standard does not have{meant}",
                found.name()
            )
        })
        .collect()
}
