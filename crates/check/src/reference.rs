//! The reference run that an FMU carries (layered standard FMI-LS-REF): inputs, and outputs that an importer must get.

use roxmltree::Document;

use super::archive::Archive;
use super::described::{attribute, child};

/// The folder that FMI-LS-REF reserves in an FMU.
const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
/// Where the tolerance is stated.
const EXPLANATION: &str = "documentation/fmi-ls-ref.txt";

/// The reference run of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReferenceRun {
    /// Communication step, s.
    pub(super) step_s: f64,
    /// Number of communication steps.
    pub(super) steps: usize,
    pub(super) inputs: Table,
    pub(super) outputs: Table,
    /// How far each output may be off, by its largest magnitude in the run.
    pub(super) tolerance: f64,
}

/// Values over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    /// Names of the variables, without the time.
    pub(super) names: Vec<String>,
    /// Time, s, and one value for each name.
    pub(super) rows: Vec<(f64, Vec<f64>)>,
}

impl ReferenceRun {
    /// The reference run, if there is one; the error is a sentence.
    pub(super) fn read(archive: &mut Archive) -> Result<Option<Self>, String> {
        let manifest = format!("{FOLDER}/fmi-ls-manifest.xml");
        let Some(text) = archive.optional_text(&manifest) else {
            return Ok(None);
        };
        let experiment =
            source_of_experiment(&text).map_err(|refused| format!("{manifest}: {refused}"))?;
        let mut text = |entry: &str| {
            archive.optional_text(entry).ok_or_else(|| {
                format!("{entry}: is missing or no text, expected it as {manifest} names it")
            })
        };
        let path = format!("{FOLDER}/{experiment}");
        let settings =
            Experiment::parse(&text(&path)?).map_err(|refused| format!("{path}: {refused}"))?;
        let mut table = |name: &str| {
            let path = format!("{FOLDER}/{name}");
            Table::parse(&text(&path)?).map_err(|refused| format!("{path}: {refused}"))
        };
        let (inputs, outputs) = (table(&settings.inputs)?, table(&settings.outputs)?);
        let tolerance = text(EXPLANATION)?
            .lines()
            .find_map(|line| line.strip_prefix("Tolerance: ")?.trim().parse().ok())
            .ok_or_else(|| format!("{EXPLANATION}: found no line `Tolerance: …`, expected one"))?;
        Ok(Some(Self {
            step_s: settings.step_s,
            steps: settings.steps,
            inputs,
            outputs,
            tolerance,
        }))
    }
}

impl Table {
    /// Reads names in the first line, time first, and numbers in the others.
    fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text.lines();
        let mut header = lines.next().unwrap_or_default().split(',');
        if header.next() != Some("time") {
            return Err("found no header, expected one that begins with `time`".to_owned());
        }
        let names: Vec<String> = header.map(str::to_owned).collect();
        let rows = lines
            .enumerate()
            .map(|(index, line)| {
                let numbers: Option<Vec<f64>> =
                    line.split(',').map(|number| number.parse().ok()).collect();
                match numbers.as_deref() {
                    Some([time_s, values @ ..]) if values.len() == names.len() => {
                        Ok((*time_s, values.to_vec()))
                    }
                    _ => Err(format!(
                        "found line {} with something else than {} numbers",
                        index + 2,
                        names.len() + 1
                    )),
                }
            })
            .collect::<Result<_, String>>()?;
        Ok(Self { names, rows })
    }

    /// The values that hold from `time_s` on: those of the last row up to it.
    pub(super) fn from(&self, time_s: f64) -> Option<&[f64]> {
        let after = self.rows.partition_point(|(row_s, _)| *row_s <= time_s);
        Some(&self.rows.get(after.checked_sub(1)?)?.1)
    }
}

/// The file that the manifest gives the role of an experiment.
fn source_of_experiment(manifest: &str) -> Result<String, String> {
    let document = Document::parse(manifest).map_err(|refused| refused.to_string())?;
    document
        .root_element()
        .children()
        .find(|related| related.attribute("role") == Some("experiment/validation"))
        .and_then(|related| attribute(related, "source"))
        .ok_or_else(|| "found no file with role=\"experiment/validation\", expected one".to_owned())
}

/// What the experiment says.
struct Experiment {
    step_s: f64,
    steps: usize,
    inputs: String,
    outputs: String,
}

impl Experiment {
    fn parse(text: &str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|refused| refused.to_string())?;
        let experiment = child(document.root_element(), "Experiment")
            .ok_or("found no <Experiment>, expected one")?;
        let number = |name: &str| {
            let found: Option<f64> = attribute(experiment, name).and_then(|text| text.parse().ok());
            found.ok_or_else(|| format!("found no number as {name} of <Experiment>, expected one"))
        };
        let source = |name: &str| {
            child(experiment, name)
                .and_then(|element| attribute(element, "source"))
                .ok_or_else(|| format!("found no source of <{name}>, expected a file"))
        };
        let (step_s, stop_s) = (number("stepSize")?, number("stopTime")?);
        let steps = (stop_s / step_s).round();
        if number("startTime")? != 0.0 || !(1.0..=1e6).contains(&steps) {
            return Err(format!(
                "found a run with stopTime {stop_s:?} and stepSize {step_s:?}, expected one from 0 in 1 to 1000000 steps"
            ));
        }
        Ok(Self {
            step_s,
            steps: steps as usize,
            inputs: source("Stimuli")?,
            outputs: source("References")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_that_step_hold_from_the_second_of_two_lines() {
        let table = Table::parse("time,a.F\n0,1\n0.5,1\n0.5,2\n1,2\n").unwrap();
        let at = |time_s| table.from(time_s).unwrap()[0];
        assert_eq!([at(0.0), at(0.49), at(0.5), at(2.0)], [1.0, 1.0, 2.0, 2.0]);
        assert_eq!(table.from(-1.0), None);
        assert!(
            Table::parse("time,a.F\n0,1,2\n")
                .unwrap_err()
                .contains("line 2")
        );
    }
}
