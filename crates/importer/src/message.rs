//! What an FMU logs, and the callbacks that take it.

use std::ffi::{CStr, c_int};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

use crate::header::{self, Opaque, StatusCode, Text};

/// Status of a call or a message: `fmi2Status`, `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All is well.
    Ok,
    /// All is well, but there is something to say.
    Warning,
    /// The call was not carried out; a shorter step may be.
    Discard,
    /// The call was not carried out.
    Error,
    /// Neither the call was carried out nor can this or another instance be used again.
    Fatal,
    /// FMI 2.0: the call is being carried out.
    Pending,
    /// A number that is no status.
    Unknown(c_int),
}

impl Status {
    pub(crate) fn of(code: StatusCode) -> Self {
        match code {
            header::OK => Self::Ok,
            header::WARNING => Self::Warning,
            header::DISCARD => Self::Discard,
            header::ERROR => Self::Error,
            header::FATAL => Self::Fatal,
            header::PENDING => Self::Pending,
            other => Self::Unknown(other),
        }
    }

    /// Whether the call was carried out.
    #[must_use]
    pub fn is_done(self) -> bool {
        matches!(self, Self::Ok | Self::Warning)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ok => f.write_str("OK"),
            Self::Warning => f.write_str("Warning"),
            Self::Discard => f.write_str("Discard"),
            Self::Error => f.write_str("Error"),
            Self::Fatal => f.write_str("Fatal"),
            Self::Pending => f.write_str("Pending"),
            Self::Unknown(code) => write!(f, "{code}, which is no status"),
        }
    }
}

/// One message of an FMU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its status.
    pub status: Status,
    /// Its log category.
    pub category: String,
    /// What it says.
    pub text: String,
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]: {}", self.status, self.category, self.text)
    }
}

/// Called with each message of an instance at once, before the FMU goes on; perhaps from another thread.
pub type Listener = Box<dyn Fn(&Message) + Send + Sync>;

/// Everything that an instance has logged: the environment of its callbacks.
#[derive(Default)]
pub(crate) struct Log {
    messages: Mutex<Vec<Message>>,
    listener: Option<Listener>,
}

impl Log {
    pub(crate) fn new(listener: Option<Listener>) -> Self {
        Self {
            messages: Mutex::default(),
            listener,
        }
    }

    pub(crate) fn messages(&self) -> Vec<Message> {
        self.since(0)
    }

    pub(crate) fn len(&self) -> usize {
        self.messages
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .len()
    }

    /// Messages from the one with this index on.
    pub(crate) fn since(&self, first: usize) -> Vec<Message> {
        let messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        messages.iter().skip(first).cloned().collect()
    }

    fn add(&self, message: Message) {
        if let Some(listener) = &self.listener {
            listener(&message);
        }
        self.messages
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(message);
    }
}

/// The log callback of FMI 3.0; the environment is the [`Log`].
///
/// # Safety
///
/// `environment` is the log of an instance that lives, the strings are terminated or null.
pub(crate) unsafe extern "C" fn log_fmi3(
    environment: Opaque,
    status: StatusCode,
    category: Text,
    text: Text,
) {
    // SAFETY: the caller's promise
    unsafe { add(environment, status, category, owned(text)) };
}

/// The log callback of FMI 2.0; the environment is the [`Log`].
///
/// In C it is variadic, and `format` a format of `printf`: see [`header::fmi2::variadic`]. Of the formats, `%s` and `%%` are
/// filled in; others are left as they are.
///
/// # Safety
///
/// `environment` is the log of an instance that lives, the strings are terminated or null.
pub(crate) unsafe extern "C" fn log_fmi2(
    environment: Opaque,
    _instance: Text,
    status: StatusCode,
    category: Text,
    format: Text,
    first: Text,
) {
    let on_stack = cfg!(all(target_vendor = "apple", target_arch = "aarch64"));
    // SAFETY: the caller's promise; a format of `%s` has a string after it
    unsafe {
        let is_text = !format.is_null() && CStr::from_ptr(format) == c"%s";
        if is_text && !on_stack {
            add(environment, status, category, owned(first));
        } else {
            add(
                environment,
                status,
                category,
                owned(format).replace("%%", "%"),
            );
        }
    }
}

/// # Safety
///
/// `text` is a terminated string or null.
unsafe fn owned(text: Text) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: the caller's promise
    unsafe { CStr::from_ptr(text) }
        .to_string_lossy()
        .into_owned()
}

/// # Safety
///
/// `environment` is the log of an instance that lives, `category` is a terminated string or null.
unsafe fn add(environment: Opaque, status: StatusCode, category: Text, text: String) {
    let message = Message {
        status: Status::of(status),
        // SAFETY: the caller's promise
        category: unsafe { owned(category) },
        // a literal '#' is doubled in messages (FMI 2.0, 2.1.5; FMI 3.0, 2.3.1)
        text: text.replace("##", "#"),
    };
    // SAFETY: the caller's promise; null only from a library that loses its environment
    if let Some(log) = unsafe { environment.cast::<Log>().as_ref() } {
        // a listener that panics must not unwind into C; its message is lost, nothing else
        drop(catch_unwind(AssertUnwindSafe(|| log.add(message))));
    }
}
