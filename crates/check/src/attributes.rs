//! Attributes that the standard knows: the schema of FMI 3.0 lets any other through, so that a misspelt capability is
//! silently none.

use bolted_joint_importer::FmiVersion;
use roxmltree::Node;

use super::described::{FILE, child, elements};

/// Attributes of `<fmiModelDescription>`.
fn of_root(version: FmiVersion) -> Vec<&'static str> {
    let mut names = vec![
        "fmiVersion",
        "modelName",
        "description",
        "author",
        "version",
        "copyright",
        "license",
        "generationTool",
        "generationDateAndTime",
        "variableNamingConvention",
    ];
    names.extend_from_slice(match version {
        FmiVersion::Two => &["guid", "numberOfEventIndicators"],
        FmiVersion::Three => &["instantiationToken"],
    });
    names
}

/// Capabilities that both interface types of FMI 3.0 have (2.4.1).
const BOTH_FMI3: [&str; 7] = [
    "needsExecutionTool",
    "canBeInstantiatedOnlyOncePerProcess",
    "canGetAndSetFMUState",
    "canSerializeFMUState",
    "providesDirectionalDerivatives",
    "providesAdjointDerivatives",
    "providesPerElementDependencies",
];

/// Capabilities that both interface types of FMI 2.0 have (3.3.1, 4.3.1).
const BOTH_FMI2: [&str; 6] = [
    "needsExecutionTool",
    "canBeInstantiatedOnlyOncePerProcess",
    "canNotUseMemoryManagementFunctions",
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "providesDirectionalDerivative",
];

/// Capabilities of one interface type alone that are true or false, and those that are something else.
fn of_interface(
    version: FmiVersion,
    element: &str,
) -> (&'static [&'static str], &'static [&'static str]) {
    match (version, element) {
        (FmiVersion::Two, "ModelExchange") => (&["completedIntegratorStepNotNeeded"], &[]),
        (FmiVersion::Two, _) => (
            &[
                "canHandleVariableCommunicationStepSize",
                "canInterpolateInputs",
                "canRunAsynchronuously",
            ],
            &["maxOutputDerivativeOrder"],
        ),
        (FmiVersion::Three, "ModelExchange") => (
            &[
                "needsCompletedIntegratorStep",
                "providesEvaluateDiscreteStates",
            ],
            &[],
        ),
        (FmiVersion::Three, _) => (
            &[
                "canHandleVariableCommunicationStepSize",
                "providesIntermediateUpdate",
                "mightReturnEarlyFromDoStep",
                "canReturnEarlyAfterIntermediateUpdate",
                "hasEventMode",
                "providesEvaluateDiscreteStates",
            ],
            &[
                "fixedInternalStepSize",
                "maxOutputDerivativeOrder",
                "recommendedIntermediateInputSmoothness",
            ],
        ),
    }
}

/// What each kind of variable may have.
fn of_variable(version: FmiVersion) -> [&'static [&'static str]; 2] {
    const REAL: [&str; 12] = [
        "declaredType",
        "quantity",
        "unit",
        "displayUnit",
        "relativeQuantity",
        "unbounded",
        "min",
        "max",
        "nominal",
        "start",
        "derivative",
        "reinit",
    ];
    match version {
        FmiVersion::Two => [
            &[
                "name",
                "valueReference",
                "description",
                "causality",
                "variability",
                "initial",
                "canHandleMultipleSetPerTimeInstant",
            ],
            &REAL,
        ],
        FmiVersion::Three => [
            &[
                "name",
                "valueReference",
                "description",
                "causality",
                "variability",
                "initial",
                "canHandleMultipleSetPerTimeInstant",
                "intermediateUpdate",
                "previous",
                "clocks",
                "declaredType",
                "quantity",
                "unit",
                "displayUnit",
                "relativeQuantity",
                "unbounded",
                "min",
                "max",
                "nominal",
                "start",
                "derivative",
                "reinit",
            ],
            &[],
        ],
    }
}

/// Attributes that the standard does not know, and capabilities that are neither true nor false.
pub(super) fn findings(root: Node<'_, '_>, version: FmiVersion) -> Vec<String> {
    let mut findings = unknown(root, &of_root(version));
    for name in ["CoSimulation", "ModelExchange"] {
        let Some(element) = child(root, name) else {
            continue;
        };
        let both: &[&str] = match version {
            FmiVersion::Two => &BOTH_FMI2,
            FmiVersion::Three => &BOTH_FMI3,
        };
        let (flags, others) = of_interface(version, name);
        let known = [both, flags, others, &["modelIdentifier"]].concat();
        findings.extend(unknown(element, &known));
        for flag in both.iter().chain(flags) {
            match element.attribute(*flag) {
                None | Some("true" | "false" | "0" | "1") => {}
                Some(found) => findings.push(format!(
                    "{FILE}: found {flag}=\"{found}\" of <{name}>, expected true or false"
                )),
            }
        }
    }
    let [general, typed] = of_variable(version);
    for variable in elements(child(root, "ModelVariables")) {
        findings.extend(unknown(variable, general));
        if version == FmiVersion::Two {
            for real in elements(Some(variable)).filter(|node| node.has_tag_name("Real")) {
                findings.extend(unknown(real, typed));
            }
        }
    }
    findings
}

/// Attributes of `element`, without those of other namespaces, that are not in `known`.
fn unknown(element: Node<'_, '_>, known: &[&str]) -> Vec<String> {
    let name = element.tag_name().name();
    let which = element
        .attribute("name")
        .map_or_else(String::new, |name| format!(" {name}"));
    element
        .attributes()
        .filter(|found| found.namespace().is_none() && !known.contains(&found.name()))
        .map(|found| {
            let similar = known
                .iter()
                .find(|candidate| candidate.eq_ignore_ascii_case(found.name()));
            let meant = similar.map_or_else(String::new, |name| format!("; did you mean {name}?"));
            format!(
                "{FILE}: found attribute {} of <{name}>{which}, which the standard does not have{meant}",
                found.name()
            )
        })
        .collect()
}
