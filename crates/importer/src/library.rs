//! A loaded library, and what it is called by.

use std::ffi::CStr;
use std::path::Path;

use crate::abi::Opaque;
use crate::error::ImportError;
use crate::{fmi2, fmi3};

/// Version of the standard that a library is driven by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FmiVersion {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// The shared library of an FMU.
pub struct Library {
    pub(crate) functions: Functions,
    /// Keeps the functions where they are; dropped last.
    _library: libloading::Library,
}

pub(crate) enum Functions {
    Two(fmi2::Functions),
    Three(fmi3::Functions),
}

impl Library {
    /// Loads the library at `path` and looks up the functions of one version of the standard.
    ///
    /// This runs code of the library. The functions are taken to be what the standard's headers declare under their
    /// names; nothing can check that.
    ///
    /// # Errors
    ///
    /// [`ImportError::Unloadable`], [`ImportError::Missing`].
    pub fn load(path: &Path, version: FmiVersion) -> Result<Self, ImportError> {
        // SAFETY: what the library does on loading is its own affair, as documented
        let library = unsafe { libloading::Library::new(path) }.map_err(|source| {
            ImportError::Unloadable {
                path: path.to_owned(),
                source,
            }
        })?;
        let missing = |(function, source)| ImportError::Missing {
            path: path.to_owned(),
            function,
            source,
        };
        // SAFETY: the standard gives the types to these names
        let functions = unsafe {
            match version {
                FmiVersion::Two => Functions::Two(fmi2::Functions::of(&library).map_err(missing)?),
                FmiVersion::Three => {
                    Functions::Three(fmi3::Functions::of(&library).map_err(missing)?)
                }
            }
        };
        Ok(Self {
            functions,
            _library: library,
        })
    }

    /// Version of the standard that the library is driven by.
    #[must_use]
    pub fn version(&self) -> FmiVersion {
        match self.functions {
            Functions::Two(_) => FmiVersion::Two,
            Functions::Three(_) => FmiVersion::Three,
        }
    }

    /// What the library itself says: `fmi2GetVersion` or `fmi3GetVersion`, such as `3.0`.
    #[must_use]
    pub fn version_text(&self) -> String {
        // SAFETY: the standard has these return a terminated string that stays
        unsafe {
            let text = match &self.functions {
                Functions::Two(functions) => (functions.get_version)(),
                Functions::Three(functions) => (functions.get_version)(),
            };
            if text.is_null() {
                String::new()
            } else {
                CStr::from_ptr(text).to_string_lossy().into_owned()
            }
        }
    }

    /// # Safety
    ///
    /// `instance` is one of this library's, and is not used again.
    pub(crate) unsafe fn free_instance(&self, instance: Opaque) {
        // SAFETY: the caller's promise
        unsafe {
            match &self.functions {
                Functions::Two(functions) => (functions.free_instance)(instance),
                Functions::Three(functions) => (functions.free_instance)(instance),
            }
        }
    }
}
