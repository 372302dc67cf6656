//! `check`: is a joint file or an FMU what it should be?

use super::CheckArguments;
use super::error::CliError;

pub(super) fn run(_arguments: &CheckArguments) -> Result<(), CliError> {
    Ok(())
}
