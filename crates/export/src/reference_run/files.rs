//! The files of the reference run, after the layered standard FMI-LS-REF and the Modelica Association's format for
//! experiments that it refers to.

use std::fmt::Write as _;

use super::super::archive::File;
use super::super::xml::{Attributes, Document, number};
use super::{ReferenceRun, Table};

/// The folder that FMI-LS-REF reserves in an FMU.
const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
const EXPERIMENT: &str = "reference-run.exp";
const INPUTS: &str = "reference-run-in.csv";
const OUTPUTS: &str = "reference-run-out.csv";
/// What FMI-LS-REF recommends to explain the files in.
const EXPLANATION: &str = "documentation/fmi-ls-ref.txt";

pub(super) fn files(run: &ReferenceRun, model_name: &str) -> Vec<File> {
    let inside = |name: &str| format!("{FOLDER}/{name}");
    vec![
        File::text(&inside("fmi-ls-manifest.xml"), manifest()),
        File::text(&inside(EXPERIMENT), experiment(run, model_name)),
        File::text(&inside(INPUTS), csv(&run.inputs, number)),
        File::text(
            &inside(OUTPUTS),
            csv(&run.outputs, |value| format!("{value:.12e}")),
        ),
        File::text(EXPLANATION, explanation(run)),
    ]
}

fn manifest() -> String {
    let mut document = Document::new();
    let root = Attributes::new()
        .with("xmlns:fmi-ls", "http://fmi-standard.org/fmi-ls-manifest")
        .with("fmi-ls:fmi-ls-name", "org.fmi-standard.fmi-ls-ref")
        .with("fmi-ls:fmi-ls-version", "1.0.0-alpha.1")
        .with(
            "fmi-ls:fmi-ls-description",
            "Layered Standard providing information on related files included in an FMU.",
        );
    document.element("fmiReferences", root, |document| {
        for (media_type, source, role, description) in [
            (
                "application/x-ma-hs-experiments",
                EXPERIMENT,
                "experiment/validation",
                "Reference run",
            ),
            ("text/csv", INPUTS, "other", "Inputs of the reference run"),
            (
                "text/csv",
                OUTPUTS,
                "result",
                "Outputs of the reference run",
            ),
            (
                "text/plain",
                "../../documentation/fmi-ls-ref.txt",
                "document",
                "How to use the reference run, and how closely its outputs are to be met",
            ),
        ] {
            let related = Attributes::new()
                .with("type", media_type)
                .with("source", source)
                .with("role", role)
                .with("description", description);
            document.empty("Related", related);
        }
    });
    document.finish()
}

fn experiment(run: &ReferenceRun, model_name: &str) -> String {
    let mut document = Document::new();
    let root = Attributes::new()
        .with("name", format!("Reference run of {model_name}"))
        .with(
            "description",
            "Inputs in steps, and the outputs to compare with",
        );
    document.element("Experiments", root, |document| {
        let settings = Attributes::new()
            .with("name", "Reference run")
            .with(
                "description",
                format!(
                    "From rest, without other settings; outputs differ by at most {} of their largest magnitude",
                    number(run.tolerance)
                ),
            )
            .number("startTime", Some(0.0))
            .number("stopTime", Some(run.stop_s()))
            .number("stepSize", Some(run.step_s));
        document.element("Experiment", settings, |document| {
            document.empty("Stimuli", Attributes::new().with("source", INPUTS));
            document.empty("References", Attributes::new().with("source", OUTPUTS));
        });
    });
    document.finish()
}

/// Names, then one line for each time.
fn csv(table: &Table, written: impl Fn(f64) -> String) -> String {
    let mut text = String::from("time");
    for name in &table.names {
        text.push(',');
        text.push_str(name);
    }
    text.push('\n');
    for (time_s, values) in &table.rows {
        text.push_str(&number(*time_s));
        for value in values {
            // writing to a String cannot fail
            let _ = write!(text, ",{}", written(*value));
        }
        text.push('\n');
    }
    text
}

fn explanation(run: &ReferenceRun) -> String {
    format!(
        "\
The reference run of this FMU (layered standard FMI-LS-REF)

{FOLDER}/
    {EXPERIMENT:24} start, stop and communication step
    {INPUTS:24} inputs; two lines of the same time are a step from one value to the other
    {OUTPUTS:24} outputs at communication points, to compare with

Start at rest, with the start values of the model description. In Co-Simulation take
communication steps of {step} s, up to {stop} s, and set the inputs at the beginning of each:
those after the step where the inputs step there. In Model Exchange let an event happen at
each step of the inputs, and keep the solver's relative error below the tolerance.

Tolerance: {tolerance}
This is how far an output may be from the reference, as a fraction of its largest magnitude in
the run. The reference comes from the same equations, calculated far more precisely than the
FMU does with its own steps.
",
        step = number(run.step_s),
        stop = number(run.stop_s()),
        tolerance = number(run.tolerance),
    )
}
