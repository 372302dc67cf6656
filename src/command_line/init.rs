//! `init`: a first study from the files of a folder.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use bolted_joint::show::draft;

use super::error::CliError;
use super::output::{check_output, is_standard_output, print, write_file};

/// `init`
#[derive(Debug, Args)]
pub(super) struct InitArguments {
    /// Folder with the measured functions or modes of two parts and of their assembly
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Study to write [default: study.toml in the folder, unless there is one]
    #[arg(short, long, value_name = "NAME.toml")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &InitArguments) -> Result<(), CliError> {
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
    write_file(output, draft.text.as_bytes())?;
    let mut text = String::new();
    for note in &draft.notes {
        let _ = writeln!(text, "{note}");
    }
    if !is_standard_output(output) {
        let path = output.display();
        let _ = writeln!(
            text,
            "wrote {path}\nthen: bolted-joint identify {path} -o NAME.joint.json"
        );
    }
    print(&text)
}
