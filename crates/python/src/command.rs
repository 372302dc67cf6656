//! Commands of the command line, without a process of their own.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use bolted_joint::command_line::{self, Answer, Call, Program};
use bolted_joint_wanted::Asker;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often Ctrl-C is looked for while a command runs.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Executable, arguments before a command's name, folder of FMU libraries.
type Started = (PathBuf, Vec<String>, Option<PathBuf>);

/// Runs the program `bolted-joint` with these arguments; gives its exit code.
///
/// `python` is how Python starts this module anew, the executable and its arguments, and the folder of FMU libraries that
/// the module brings along.
#[pyfunction]
pub(super) fn main(py: Python<'_>, arguments: Vec<OsString>, python: Started) -> PyResult<u8> {
    in_threads(py, move || {
        command_line::main_of(program(python), arguments)
    })
}

/// Runs a command; gives its exit code, what it printed, and its messages line by line.
///
/// Raises `KeyboardInterrupt` at Ctrl-C; the command then ends as soon as it next looks.
#[pyfunction]
pub(super) fn call(
    py: Python<'_>,
    arguments: Vec<OsString>,
    python: Started,
) -> PyResult<(u8, String, Vec<String>)> {
    let call = Call {
        arguments,
        program: program(python),
    };
    let Answer {
        exit_code,
        printed,
        messages,
    } = in_threads(py, move || command_line::call(call))?;
    Ok((exit_code, printed, messages))
}

fn program((path, arguments, platforms): Started) -> Program {
    Program {
        path,
        arguments,
        platforms,
    }
}

/// Does `work` in threads of its own while Python's other threads run, and listens for Ctrl-C meanwhile.
fn in_threads<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = mpsc::channel();
    let asker = Asker::new();
    let asked = asker.clone();
    let worker = thread::Builder::new()
        .name("bolted-joint".to_owned())
        .spawn(move || {
            let result = asked.ask(work).transpose();
            // nobody listens after Ctrl-C
            let _ = result.map(|result| sender.send(result));
        })?;
    loop {
        let heard;
        (receiver, heard) = py.detach(move || {
            let heard = receiver.recv_timeout(BETWEEN_LOOKS);
            (receiver, heard)
        });
        match heard {
            Ok(result) => return Ok(result?),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().inspect_err(|_| asker.give_up())?
            }
            Err(RecvTimeoutError::Disconnected) => {
                let said = py.detach(move || last_words(worker));
                return Err(PyRuntimeError::new_err(format!(
                    "bolted-joint has come upon a mistake of its own ({said}); standard error has where"
                )));
            }
        }
    }
}

/// What a thread said that has come upon a mistake: notebooks do not show standard error.
fn last_words(worker: JoinHandle<()>) -> String {
    let said = match worker.join() {
        Ok(()) => None,
        Err(said) => match said.downcast::<String>() {
            Ok(said) => Some(*said),
            Err(said) => said.downcast::<&str>().ok().map(|said| said.to_string()),
        },
    };
    said.unwrap_or_else(|| "it did not say which".to_owned())
}
