//! Does the model description declare what this program would for the joint that is in the FMU?

use bolted_joint_importer::FmiVersion;
use bolted_joint_interface::{Interface as Declared, Role, Variable};

use super::described::{Described, DescribedVariable, FILE};
use bolted_joint_export::{StartFile, parameter_lines};

/// How many differing variables are told of before they are only counted.
const LISTED_VARIABLES: usize = 5;

/// Where the model description declares other variables than this program does; start values are compared elsewhere.
pub(super) fn differences(found: &Described, expected: &Declared) -> Vec<String> {
    let mut findings = Vec::new();
    let interfaces = [
        ("CoSimulation", &found.co_simulation),
        ("ModelExchange", &found.model_exchange),
    ];
    for (element, identifier) in interfaces {
        if identifier.is_none() {
            findings.push(format!("{FILE}: found no <{element}>, expected one"));
        }
    }
    if let (Some(one), Some(other)) = (&found.co_simulation, &found.model_exchange)
        && one != other
    {
        findings.push(format!(
            "{FILE}: found modelIdentifier \"{one}\" of <CoSimulation> and \"{other}\" of <ModelExchange>, expected one library"
        ));
    }
    let is_declared = |wanted: &&Variable| {
        // FMI 2.0 lets the independent variable be left out
        found.version == FmiVersion::Three || wanted.role != Role::Independent
    };
    for wanted in expected.variables.iter().filter(is_declared) {
        let causality = causality(wanted.role);
        let same = |other: &DescribedVariable| {
            (other.reference, other.causality.as_str(), &other.unit)
                == (wanted.reference, causality, &wanted.unit)
        };
        match found.variable(&wanted.name) {
            None => findings.push(format!(
                "{FILE}: variable {} not found, expected it as resources/start.txt names this interface",
                wanted.name
            )),
            Some(other) if !same(other) => findings.push(format!(
                "{FILE}: found variable {} as {} {} in {}, expected {causality} {} in {}",
                wanted.name,
                other.causality,
                other.reference,
                other.unit,
                wanted.reference,
                wanted.unit
            )),
            Some(_) => {}
        }
    }
    for other in &found.variables {
        if expected.variable(&other.name).is_none() {
            findings.push(format!(
                "{FILE}: found variable {}, expected none of that name",
                other.name
            ));
        }
    }
    shortened(findings)
}

/// The first of the variables that differ, and how many more there are.
pub(super) fn shortened(mut findings: Vec<String>) -> Vec<String> {
    if let Some(more) = findings.len().checked_sub(LISTED_VARIABLES + 1) {
        findings.truncate(LISTED_VARIABLES);
        findings.push(format!("{FILE}: {} more variables differ", more + 1));
    }
    findings
}

/// The causality that a variable of this role is declared with.
fn causality(role: Role) -> &'static str {
    match role {
        Role::Independent => "independent",
        Role::Parameter => "parameter",
        Role::Input => "input",
        Role::State | Role::InnerState | Role::Output => "output",
        Role::CalculatedParameter => "calculatedParameter",
        Role::Derivative | Role::Indicator => "local",
    }
}

/// Start values that lie outside their range: validators do not look.
pub(super) fn starts_out_of_range(found: &Described) -> Vec<String> {
    let within = |variable: &&DescribedVariable| {
        variable.start.is_none_or(|start| {
            start >= variable.min.unwrap_or(f64::NEG_INFINITY)
                && start <= variable.max.unwrap_or(f64::INFINITY)
        })
    };
    found
        .variables
        .iter()
        .filter(|variable| !within(variable))
        .map(|variable| {
            format!(
                "{FILE}: found start = {:?} of {}, expected a value from {:?} to {:?}",
                variable.start.unwrap_or(f64::NAN),
                variable.name,
                variable.min.unwrap_or(f64::NEG_INFINITY),
                variable.max.unwrap_or(f64::INFINITY)
            )
        })
        .collect()
}

/// Where the model description and the file that the library reads do not agree.
pub(super) fn against_start_file(found: &Described, start: &StartFile) -> Vec<String> {
    let mut findings = Vec::new();
    // by name, because the start-value file has the order of the model description and not of the value references
    let mut declared: Vec<(String, f64)> = found
        .variables
        .iter()
        .filter(|variable| variable.causality == "parameter" || variable.name == "preload")
        .filter_map(|variable| Some((variable.name.clone(), variable.start?)))
        .collect();
    let mut read = start.parameters.clone();
    for parameters in [&mut declared, &mut read] {
        parameters.sort_by(|(one, _), (other, _)| one.cmp(other));
    }
    if parameter_lines(&declared) != parameter_lines(&read) {
        findings.push(
            "modelDescription.xml: the parameters' start values differ from resources/start.txt, which the library \
             reads; export the FMU again instead of editing it"
                .to_owned(),
        );
    }
    if found.token != start.token {
        let attribute = match found.version {
            FmiVersion::Two => "guid",
            FmiVersion::Three => "instantiationToken",
        };
        findings.push(format!(
            "{FILE}: found {attribute} \"{}\", expected \"{}\" as in resources/start.txt",
            found.token, start.token
        ));
    }
    findings
}
