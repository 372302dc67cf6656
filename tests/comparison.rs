//! The table of FMI capabilities in docs/comparison.md, held to what exported FMUs claim and contain.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;
use std::process::Command;

use zip::ZipArchive;

/// Capabilities that the two versions of the standard call by different names: that of FMI 3.0 and that of FMI 2.0.
const RENAMED: [(&str, &str); 3] = [
    ("canGetAndSetFMUState", "canGetAndSetFMUstate"),
    ("canSerializeFMUState", "canSerializeFMUstate"),
    (
        "providesDirectionalDerivatives",
        "providesDirectionalDerivative",
    ),
];

/// Capabilities that FMI 2.0 does not know.
const OF_FMI_3_ALONE: &str = "\
    providesAdjointDerivatives providesIntermediateUpdate canReturnEarlyAfterIntermediateUpdate hasEventMode";

/// The capability that FMI 3.0 does not know.
const OF_FMI_2_ALONE: &str = "canInterpolateInputs";

/// Capabilities of Co-Simulation alone.
const CO_SIMULATION_ALONE: &str = "\
    maxOutputDerivativeOrder canInterpolateInputs providesIntermediateUpdate canReturnEarlyAfterIntermediateUpdate \
    hasEventMode canHandleVariableCommunicationStepSize";

/// Attributes of the interface types that are no capabilities but facts about the FMU or duties of the importer.
/// The last one is of FMI 2.0, never claimed: with the standard's spelling.
const NO_CAPABILITIES: &str = "\
    modelIdentifier needsCompletedIntegratorStep completedIntegratorStepNotNeeded needsExecutionTool \
    canNotUseMemoryManagementFunctions fixedInternalStepSize recommendedIntermediateInputSmoothness \
    canRunAsynchronuously";

fn lists(names: &str, name: &str) -> bool {
    names.split(' ').any(|one| one == name)
}

/// An exported FMU, as far as the table speaks of it.
struct Fmu {
    version: u8,
    description: String,
    entries: BTreeSet<String>,
}

impl Fmu {
    /// Exports with an empty `PATH`, so that no compiler can be called.
    fn export(folder: &Path, interface: &str, version: u8) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join(format!("{interface}-{version}.fmu"));
        let done = Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
            .env("PATH", "")
            .arg("export")
            .arg(root.join("examples/pirdayr-ex03/pirdayr-ex03.joint.json"))
            .arg("-o")
            .arg(&path)
            .args(["--as", interface, "--fmi", &version.to_string()])
            .output()
            .unwrap();
        assert!(done.status.success(), "{done:?}");
        let mut archive = ZipArchive::new(File::open(&path).unwrap()).unwrap();
        let entries = archive
            .file_names()
            .map(|name| name.unwrap().into_owned())
            .collect();
        let mut description = String::new();
        let mut entry = archive.by_name("modelDescription.xml").unwrap();
        entry.read_to_string(&mut description).unwrap();
        Self {
            version,
            description,
            entries,
        }
    }

    /// Attributes of an interface type, such as `CoSimulation`; `None` where the FMU does not offer it.
    fn interface_type(&self, element: &str) -> Option<BTreeMap<&str, &str>> {
        let (_, rest) = self.description.split_once(&format!("<{element} "))?;
        let (tag, _) = rest.split_once('>').unwrap();
        let parts: Vec<&str> = tag.trim_end_matches('/').split('"').collect();
        let pairs = parts.chunks_exact(2);
        Some(
            pairs
                .map(|pair| (pair[0].trim().trim_end_matches('='), pair[1]))
                .collect(),
        )
    }

    /// The name of a capability in this FMU's version, if it has it.
    fn name_of<'a>(&self, capability: &'a str) -> Option<&'a str> {
        if self.version == 3 {
            return (capability != OF_FMI_2_ALONE).then_some(capability);
        }
        let renamed = RENAMED.iter().find(|(name, _)| *name == capability);
        (!lists(OF_FMI_3_ALONE, capability)).then(|| renamed.map_or(capability, |(_, name)| name))
    }
}

/// The two interfaces in both versions of the standard.
fn exported() -> Vec<Fmu> {
    let folder = tempfile::tempdir().unwrap();
    let mut fmus = Vec::new();
    for interface in ["element", "lap"] {
        for version in [3, 2] {
            fmus.push(Fmu::export(folder.path(), interface, version));
        }
    }
    fmus
}

/// The table's rows: what it is about, and what our column says.
fn rows() -> Vec<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/comparison.md");
    let document = fs::read_to_string(path).unwrap();
    let rows: Vec<(String, String)> = document
        .lines()
        .skip_while(|line| !line.starts_with("| | bolted-joint | Reference FMUs"))
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            assert_eq!(cells.len(), 7, "{line}");
            (cells[1].to_owned(), cells[2].to_owned())
        })
        .collect();
    assert!(rows.len() > 20, "rows of the table");
    rows
}

/// What the row names in code font: a capability or a file.
fn named(label: &str) -> Option<&str> {
    label.split('`').nth(1)
}

/// "yes", "no", or "order N", if all FMUs agree.
fn agreed(found: &BTreeSet<String>, label: &str) -> String {
    assert_eq!(found.len(), 1, "{label}: the FMUs differ: {found:?}");
    found.first().unwrap().clone()
}

/// What the exported FMUs say of a capability.
fn claimed(fmus: &[Fmu], capability: &str) -> String {
    let mut found = BTreeSet::new();
    for fmu in fmus {
        let Some(name) = fmu.name_of(capability) else {
            continue;
        };
        for element in ["CoSimulation", "ModelExchange"] {
            if element == "ModelExchange" && lists(CO_SIMULATION_ALONE, capability) {
                continue;
            }
            let attributes = fmu.interface_type(element).unwrap();
            found.insert(match attributes.get(name).copied() {
                Some("true") => "yes".to_owned(),
                Some("false" | "0") | None => "no".to_owned(),
                Some(number) => format!("order {number}"),
            });
        }
    }
    agreed(&found, capability)
}

fn yes_or_no(yes: bool) -> String {
    if yes { "yes" } else { "no" }.to_owned()
}

#[test]
fn our_column_of_the_table_says_what_exported_fmus_say() {
    let fmus = exported();
    let all = |fmus: &mut dyn Iterator<Item = &Fmu>, has: &dyn Fn(&Fmu) -> bool, label: &str| {
        agreed(&fmus.map(|fmu| yes_or_no(has(fmu))).collect(), label)
    };
    let mut checked = 0;
    for (label, ours) in rows() {
        let expected = match named(&label) {
            // a file in every FMU
            Some(path) if path.contains('/') => {
                all(&mut fmus.iter(), &|fmu| fmu.entries.contains(path), &label)
            }
            Some(attribute) if label.contains(", not `") => {
                yes_or_no(claimed(&fmus, attribute) == "no")
            }
            Some(attribute) => claimed(&fmus, attribute),
            // an interface type: "FMI 3.0 Model Exchange"
            None => match label
                .strip_prefix("FMI ")
                .and_then(|rest| rest.split_once(".0 "))
            {
                Some((version, name)) => {
                    let element = name.replace(['-', ' '], "");
                    let has = |fmu: &Fmu| fmu.interface_type(&element).is_some();
                    let mut of_it = fmus.iter().filter(|fmu| fmu.version.to_string() == version);
                    all(&mut of_it, &has, &label)
                }
                None if label == "arrays, clocks" => yes_or_no(fmus.iter().any(|fmu| {
                    fmu.description.contains("<Dimension") || fmu.description.contains("<Clock")
                })),
                // the export above has called nothing
                None if label == "a new FMU without a compiler" => "yes".to_owned(),
                None => continue,
            },
        };
        assert_eq!(ours, expected, "{label}");
        checked += 1;
    }
    assert!(checked >= 20, "{checked} rows checked");
}

#[test]
fn every_capability_that_an_exported_fmu_claims_has_its_row() {
    let rows = rows();
    let in_table: BTreeSet<&str> = rows.iter().filter_map(|(label, _)| named(label)).collect();
    for fmu in exported() {
        for element in ["CoSimulation", "ModelExchange"] {
            for (attribute, value) in fmu.interface_type(element).unwrap() {
                let renamed = RENAMED.iter().find(|(_, name)| *name == attribute);
                let capability = renamed.map_or(attribute, |(name, _)| name);
                assert!(
                    in_table.contains(capability) || lists(NO_CAPABILITIES, attribute),
                    "FMI {} {element}: {attribute}=\"{value}\" has no row in the table of docs/comparison.md",
                    fmu.version
                );
            }
        }
    }
}
