//! How the command line was called: by a shell, or by a program that keeps what is printed.

use std::cell::RefCell;
use std::env;
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;

/// How to start this program in a process of its own, which `check` does to run an FMU's library.
#[derive(Clone, Debug)]
pub struct Program {
    /// The executable.
    pub path: PathBuf,
    /// Its arguments before the name of a command.
    pub arguments: Vec<String>,
    /// The folder with FMU libraries for other platforms that it brings along, if it does: what `export --platforms` takes.
    pub platforms: Option<PathBuf>,
}

impl Program {
    /// The executable that runs now.
    ///
    /// # Errors
    /// What the operating system says where it does not tell.
    pub(super) fn current() -> io::Result<Self> {
        Ok(Self {
            path: env::current_exe()?,
            arguments: Vec::new(),
            platforms: None,
        })
    }
}

/// A command, as a program calls it.
#[derive(Clone, Debug)]
pub struct Call {
    /// The command and its arguments, without the program's name.
    pub arguments: Vec<OsString>,
    /// How the program is started anew.
    pub program: Program,
}

/// What became of a call.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// What the program would end with.
    pub exit_code: u8,
    /// What it would print to standard output.
    pub printed: String,
    /// What it would print to standard error, line by line: warnings, and at last the error.
    pub messages: Vec<String>,
}

/// What is under way in this thread.
struct UnderWay {
    program: Program,
    /// What has been printed, where it is kept.
    kept: Option<Answer>,
}

thread_local! {
    static UNDER_WAY: RefCell<Option<UnderWay>> = const { RefCell::new(None) };
}

/// Lets `work` run as a command of the program that `program` starts; it prints as a program does.
pub(super) fn printing(program: Program, work: impl FnOnce() -> u8) -> u8 {
    UNDER_WAY.set(Some(UnderWay {
        program,
        kept: None,
    }));
    let exit_code = work();
    UNDER_WAY.set(None);
    exit_code
}

/// Lets `work` run as a call whose prints are kept.
pub(super) fn keeping(program: Program, work: impl FnOnce() -> u8) -> Answer {
    UNDER_WAY.set(Some(UnderWay {
        program,
        kept: Some(Answer::default()),
    }));
    let exit_code = work();
    let kept = UNDER_WAY.take().and_then(|under_way| under_way.kept);
    Answer {
        exit_code,
        ..kept.unwrap_or_default()
    }
}

/// Lets `take` have what is kept of this thread's call; nothing where its prints are not kept.
pub(super) fn with_kept<T>(take: impl FnOnce(&mut Answer) -> T) -> Option<T> {
    UNDER_WAY.with_borrow_mut(|under_way| under_way.as_mut()?.kept.as_mut().map(take))
}

/// How this program is started anew.
pub(super) fn program() -> io::Result<Program> {
    let program = UNDER_WAY.with_borrow(|under_way| Some(under_way.as_ref()?.program.clone()));
    program.map_or_else(Program::current, Ok)
}

/// The FMU libraries for other platforms that this program brings along.
pub(super) fn platforms() -> Option<PathBuf> {
    UNDER_WAY.with_borrow(|under_way| under_way.as_ref()?.program.platforms.clone())
}
