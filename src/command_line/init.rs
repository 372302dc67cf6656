//! `init`: a first study from the files of a folder, and the schema by which editors complete its keys.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use bolted_joint::show::draft;

use super::error::CliError;
use super::output::{check_output, has_extension, is_standard_output, print, write_file};
use super::schema;

/// `init`
#[derive(Debug, Args)]
pub(super) struct InitArguments {
    /// Folder with the measured functions or modes of two parts and of their assembly
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Study to write [default: study.toml in the folder, unless there is one]
    #[arg(short, long, value_name = "NAME.toml")]
    output: Option<PathBuf>,
    /// Print the JSON Schema of studies, and do nothing else
    #[arg(long, exclusive = true)]
    schema: bool,
}

pub(super) fn run(arguments: &InitArguments) -> Result<(), CliError> {
    if arguments.schema {
        return print(&schema::text());
    }
    let default = arguments.folder.join("study.toml");
    let output = match &arguments.output {
        Some(output) => output,
        None if default.exists() => {
            let expected = "a name for another study, since there is one already";
            return Err(CliError::option("--output", default.display(), expected));
        }
        None => &default,
    };
    let draft = draft(&arguments.folder)?;
    check_output(output, &[])?;
    // a file by another name would be taken for a table; what must not be replaced is told when it is written
    let is_new = !is_standard_output(output) && !output.exists();
    if is_new && !has_extension(output, "toml") {
        let expected = "a name that ends in .toml, by which a study is told from a table";
        return Err(CliError::option("--output", output.display(), expected));
    }
    let schema = match is_standard_output(output) {
        true => None,
        false => Some(output.with_file_name(schema::FILE)),
    };
    // editors look for this line at the top
    let mut study = schema
        .as_ref()
        .map_or_else(String::new, |_| format!("#:schema ./{}\n", schema::FILE));
    study += &draft.text;
    write_file(output, study.as_bytes())?;
    let mut written = vec![output.display().to_string()];
    if let Some(schema) = schema.filter(|schema| !schema.exists()) {
        write_file(&schema, schema::text().as_bytes())?;
        written.push(format!("{} (its keys, for editors)", schema.display()));
    }
    let mut text = String::new();
    for note in &draft.notes {
        let _ = writeln!(text, "{note}");
    }
    if !is_standard_output(output) {
        let path = output.display();
        let _ = writeln!(
            text,
            "wrote {}\nthen: bolted-joint identify {path} -o NAME.joint.json",
            written.join("\nwrote ")
        );
    }
    print(&text)
}
