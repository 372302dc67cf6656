//! The importer's log: categories, what is switched on, and the callback. Nothing is ever written anywhere else.

use std::{
    ffi::{CString, c_char, c_int, c_void},
    fmt,
};

use crate::interface::LOG_CATEGORIES;

/// Status of an FMI call, with the numbers of `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub(crate) enum Status {
    /// All well.
    Ok = 0,
    /// Done, with a remark.
    Warning = 1,
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
    const fn c_name(self) -> &'static std::ffi::CStr {
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

const _: () = assert!(
    Category::ALL.len() == LOG_CATEGORIES.len(),
    "the model descriptions define other log categories"
);

/// The importer's callback, `fmi3LogMessageCallback`.
pub(crate) type Callback = unsafe extern "C" fn(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
);

/// Where messages of one instance go, and which.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Logger {
    callback: Option<Callback>,
    environment: *mut c_void,
    enabled: u8,
}

impl Logger {
    /// Logger with all categories on or off.
    pub(crate) fn new(callback: Option<Callback>, environment: *mut c_void, on: bool) -> Self {
        let mut logger = Self {
            callback,
            environment,
            enabled: 0,
        };
        logger.switch(&Category::ALL, on);
        logger
    }

    /// Switches categories on or off; errors are reported in any case, as FMI 3.0 advises.
    pub(crate) fn switch(&mut self, categories: &[Category], on: bool) {
        for category in categories {
            if on {
                self.enabled |= category.bit();
            } else {
                self.enabled &= !category.bit();
            }
        }
    }

    /// Reports an error of `function`.
    pub(crate) fn error(&self, function: &str, reason: &dyn fmt::Display) {
        self.send(Status::Error, Category::Error, function, reason);
    }

    /// Reports a warning of `function`, if warnings are on.
    pub(crate) fn warning(&self, function: &str, reason: &dyn fmt::Display) {
        if self.enabled & Category::Warning.bit() != 0 {
            self.send(Status::Warning, Category::Warning, function, reason);
        }
    }

    /// Reports what `function` did, if events are on.
    pub(crate) fn event(&self, function: &str, event: &dyn fmt::Display) {
        if self.enabled & Category::Events.bit() != 0 {
            self.send(Status::Ok, Category::Events, function, event);
        }
    }

    fn send(&self, status: Status, category: Category, function: &str, text: &dyn fmt::Display) {
        let Some(callback) = self.callback else {
            return;
        };
        // '#' starts a reference to a variable in a message (FMI 3.0, 2.3.1): a literal one is doubled
        let message = format!("{function}: {text}")
            .replace('#', "##")
            .replace('\0', " ");
        let Ok(message) = CString::new(message) else {
            return;
        };
        // SAFETY: the importer promises that the callback it gave is callable with the environment it gave for as
        // long as the instance lives; both strings are terminated and outlive the call.
        unsafe {
            callback(
                self.environment,
                status as c_int,
                category.c_name().as_ptr(),
                message.as_ptr(),
            );
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
