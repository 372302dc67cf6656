//! `completions` and `man`: what a shell and `man` want to know of the command line.

use std::fs;
use std::path::PathBuf;

use clap::{Args, Command, ValueEnum};

use super::NAME;
use super::error::CliError;
use super::output::{print, write_files};

/// `completions`
#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shell {
    /// For ~/.local/share/bash-completion/completions/bolted-joint
    Bash,
    /// For a folder of $fpath, as _bolted-joint
    Zsh,
    /// For ~/.config/fish/completions/bolted-joint.fish
    Fish,
    /// For $PROFILE
    Powershell,
}

/// `man`
#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Folder for a page of the program and one of each command, such as ~/.local/share/man/man1; it is made if it does not exist
    folder: PathBuf,
}

/// Prints the completions of `command`.
pub(super) fn completions(
    arguments: &CompletionsArguments,
    mut command: Command,
) -> Result<(), CliError> {
    use clap_complete::shells::{Bash, Fish, PowerShell, Zsh};
    let mut text = Vec::new();
    let (own, to) = (&mut command, &mut text);
    match arguments.shell {
        Shell::Bash => clap_complete::generate(Bash, own, NAME, to),
        Shell::Zsh => clap_complete::generate(Zsh, own, NAME, to),
        Shell::Fish => clap_complete::generate(Fish, own, NAME, to),
        Shell::Powershell => clap_complete::generate(PowerShell, own, NAME, to),
    }
    print(&String::from_utf8_lossy(&text))
}

/// Writes the pages of `command`.
pub(super) fn man(arguments: &ManArguments, command: Command) -> Result<(), CliError> {
    fs::create_dir_all(&arguments.folder).map_err(|source| CliError::Unwritable {
        path: arguments.folder.clone(),
        source,
    })?;
    let mut pages = Vec::new();
    let shown = command.get_subcommands().filter(|own| !own.is_hide_set());
    let each = shown.map(|own| {
        let name = format!("{NAME}-{}", own.get_name());
        // clap wants names that live as long as the program, which a page does not need
        (
            name.clone(),
            own.clone().name(clap::builder::Str::from(name)),
        )
    });
    for (name, command) in each.chain([(NAME.to_owned(), command.clone())]) {
        let mut page = Vec::new();
        clap_mangen::Man::new(command).render(&mut page)?;
        pages.push((arguments.folder.join(format!("{name}.1")), page));
    }
    let files: Vec<_> = pages
        .iter()
        .map(|(path, page)| (path.as_path(), page.as_slice()))
        .collect();
    write_files(&files)?;
    let names = pages
        .iter()
        .map(|(path, _)| format!("wrote {}\n", path.display()));
    print(&names.collect::<String>())
}
