//! The importer's log: categories, what is switched on, and the callback. Nothing is ever written anywhere else.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    fmt,
    sync::Arc,
};

use crate::interface::LOG_CATEGORIES;

/// Status of an FMI call, with the numbers of `fmi2Status` and `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub(crate) enum Status {
    /// All well.
    Ok = 0,
    /// Done, with a remark.
    Warning = 1,
    /// Not done; a shorter step of the importer may help, or what was asked for cannot be told.
    Discard = 2,
    /// Refused, with the instance as it was, or failed, with the instance terminated.
    Error = 3,
}

/// Log categories; the model descriptions define the same ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Category {
    /// What happened.
    Events,
    /// Reasons for warnings.
    Warning,
    /// Reasons for errors.
    Error,
}

impl Category {
    /// All categories.
    pub(crate) const ALL: [Self; 3] = [Self::Events, Self::Warning, Self::Error];

    /// Name in the model description, for C.
    const fn c_name(self) -> &'static CStr {
        match self {
            Self::Events => c"logEvents",
            Self::Warning => c"logStatusWarning",
            Self::Error => c"logStatusError",
        }
    }

    /// Name in the model description.
    pub(crate) fn name(self) -> &'static str {
        self.c_name().to_str().unwrap_or_default()
    }

    /// Category of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|category| category.name() == name)
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// Bit of the messages with `fmi2Discard`, which share the category of errors but wait until it is asked for: a solver
/// that only tries needs none before (FMI 2.0, 2.1.3).
const DISCARDS: u8 = 1 << Category::ALL.len();

const _: () = assert!(
    Category::ALL.len() == LOG_CATEGORIES.len(),
    "the model descriptions define other log categories"
);

/// The importer's callback of FMI 3.0, `fmi3LogMessageCallback`.
pub(crate) type Fmi3Callback = unsafe extern "C" fn(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
);

/// The importer's callback of FMI 2.0, `fmi2CallbackLogger`. The message is a format of `printf`.
pub(crate) type Fmi2Callback = unsafe extern "C" fn(
    environment: *mut c_void,
    instance_name: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
    ...
);

/// Where messages of one instance go, and which.
#[derive(Clone, Debug)]
pub(crate) struct Logger {
    sink: Sink,
    enabled: u8,
}

/// The importer's callback, with what is handed back to it.
#[derive(Clone, Debug)]
enum Sink {
    /// The importer does not want messages.
    Nowhere,
    /// A callback of FMI 2.0. The name outlives the instance, which the callback may free.
    Fmi2 {
        callback: Fmi2Callback,
        environment: *mut c_void,
        instance_name: Arc<CStr>,
    },
    /// A callback of FMI 3.0.
    Fmi3 {
        callback: Fmi3Callback,
        environment: *mut c_void,
    },
}

impl Logger {
    /// Logger of FMI 2.0 with all categories on, or errors alone.
    pub(crate) fn fmi2(
        callback: Option<Fmi2Callback>,
        environment: *mut c_void,
        instance_name: &CStr,
        on: bool,
    ) -> Self {
        let sink = callback.map_or(Sink::Nowhere, |callback| Sink::Fmi2 {
            callback,
            environment,
            instance_name: Arc::from(instance_name),
        });
        Self::new(sink, on)
    }

    /// Logger of FMI 3.0 with all categories on, or errors alone.
    pub(crate) fn fmi3(callback: Option<Fmi3Callback>, environment: *mut c_void, on: bool) -> Self {
        let sink = callback.map_or(Sink::Nowhere, |callback| Sink::Fmi3 {
            callback,
            environment,
        });
        Self::new(sink, on)
    }

    /// Errors are on from the start, whatever `loggingOn` says: else nobody would learn why a call was refused, or why
    /// there is no instance.
    fn new(sink: Sink, on: bool) -> Self {
        let mut logger = Self {
            sink,
            enabled: Category::Error.bit(),
        };
        if on {
            logger.switch(&Category::ALL, true);
        }
        logger
    }

    /// Switches categories on or off.
    pub(crate) fn switch(&mut self, categories: &[Category], on: bool) {
        for &category in categories {
            let bits = match category {
                Category::Error => category.bit() | DISCARDS,
                Category::Events | Category::Warning => category.bit(),
            };
            if on {
                self.enabled |= bits;
            } else {
                self.enabled &= !bits;
            }
        }
    }

    /// Reports what `function` did, or why it did it with a warning or not at all, if messages of this status are on;
    /// returns the status.
    pub(crate) fn tell(&self, status: Status, function: &str, text: &dyn fmt::Display) -> Status {
        let (category, bit) = match status {
            Status::Ok => (Category::Events, Category::Events.bit()),
            Status::Warning => (Category::Warning, Category::Warning.bit()),
            Status::Discard => (Category::Error, DISCARDS),
            Status::Error => (Category::Error, Category::Error.bit()),
        };
        if self.enabled & bit != 0 {
            self.send(status, category, function, text);
        }
        status
    }

    fn send(&self, status: Status, category: Category, function: &str, text: &dyn fmt::Display) {
        // '#' starts a reference to a variable in a message (FMI 2.0, 2.1.5; FMI 3.0, 2.3.1): a literal one is doubled
        let escaped = |format: fmt::Arguments<'_>| {
            CString::new(format.to_string().replace('#', "##").replace('\0', " "))
        };
        let category = category.c_name().as_ptr();
        match &self.sink {
            Sink::Nowhere => {}
            Sink::Fmi2 {
                callback,
                environment,
                instance_name,
            } => {
                // '%' starts a conversion of printf, and importers that do not format show it as it is
                let text = text.to_string().replace('%', "%%");
                let Ok(message) = escaped(format_args!("{function}: {text}")) else {
                    return;
                };
                // SAFETY: the importer promises that the callback it gave is callable with the environment it gave for
                // as long as the instance lives; the strings are terminated and outlive the call; the message has no
                // conversions, so that there are no further arguments.
                unsafe {
                    callback(
                        *environment,
                        instance_name.as_ptr(),
                        status as c_int,
                        category,
                        message.as_ptr(),
                    );
                }
            }
            Sink::Fmi3 {
                callback,
                environment,
            } => {
                let Ok(message) = escaped(format_args!("{function}: {text}")) else {
                    return;
                };
                // SAFETY: the importer promises that the callback it gave is callable with the environment it gave for
                // as long as the instance lives; both strings are terminated and outlive the call.
                unsafe { callback(*environment, status as c_int, category, message.as_ptr()) };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Category, LOG_CATEGORIES};

    #[test]
    fn categories_are_those_of_the_model_descriptions() {
        let names: Vec<&str> = Category::ALL.into_iter().map(Category::name).collect();
        assert_eq!(names, LOG_CATEGORIES);
    }
}
