//! A loaded library, and what it is called by.

use std::ffi::CStr;
use std::path::Path;

use crate::error::ImportError;
use crate::header::{Opaque, fmi2, fmi3};

/// Version of the standard that a library is driven by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FmiVersion {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// A function of the library, with its C name.
#[derive(Clone, Copy)]
pub(crate) struct Named<F> {
    pub(crate) name: &'static str,
    pub(crate) function: F,
}

/// A function that the versions declare with other arguments.
#[derive(Clone, Copy)]
pub(crate) enum Either<F2, F3> {
    Two(F2),
    Three(F3),
}

/// Declares the functions that an importer of Co-Simulation needs, with their names in both versions: those that have one
/// type, and those that differ.
macro_rules! functions {
    (
        same { $($same:ident: $same_two:ident, $same_three:ident;)* }
        different { $($other:ident: $other_two:ident, $other_three:ident;)* }
    ) => {
        pub(crate) struct Functions {
            $(pub(crate) $same: Named<fmi3::$same_three>,)*
            $(pub(crate) $other: Named<Either<fmi2::$other_two, fmi3::$other_three>>,)*
            /// FMI 2.0 alone: there the time span is told before.
            pub(crate) enter_initialization: Option<Named<fmi2::fmi2EnterInitializationMode>>,
        }

        impl Functions {
            /// Looks up all functions; the first that is missing is the error.
            ///
            /// # Safety
            ///
            /// The functions of these names have the types that the standard's headers declare.
            unsafe fn of(library: &libloading::Library, version: FmiVersion) -> Result<Self, Missing> {
                // SAFETY: the caller's promise
                unsafe {
                    Ok(match version {
                        FmiVersion::Two => Self {
                            $($same: named::<fmi2::$same_two, _>(library, stringify!($same_two), |same| same)?,)*
                            $($other: named(library, stringify!($other_two), Either::Two)?,)*
                            enter_initialization: Some(named(library, "fmi2EnterInitializationMode", |same| same)?),
                        },
                        FmiVersion::Three => Self {
                            $($same: named(library, stringify!($same_three), |same| same)?,)*
                            $($other: named(library, stringify!($other_three), Either::Three)?,)*
                            enter_initialization: None,
                        },
                    })
                }
            }
        }
    };
}

functions! {
    same {
        get_version: fmi2GetVersion, fmi3GetVersion;
        free_instance: fmi2FreeInstance, fmi3FreeInstance;
        exit_initialization: fmi2ExitInitializationMode, fmi3ExitInitializationMode;
        terminate: fmi2Terminate, fmi3Terminate;
        reset: fmi2Reset, fmi3Reset;
        get_state: fmi2GetFMUstate, fmi3GetFMUState;
        set_state: fmi2SetFMUstate, fmi3SetFMUState;
        free_state: fmi2FreeFMUstate, fmi3FreeFMUState;
        state_size: fmi2SerializedFMUstateSize, fmi3SerializedFMUStateSize;
        serialize_state: fmi2SerializeFMUstate, fmi3SerializeFMUState;
        deserialize_state: fmi2DeSerializeFMUstate, fmi3DeserializeFMUState;
    }
    different {
        instantiate: fmi2Instantiate, fmi3InstantiateCoSimulation;
        set_time_span: fmi2SetupExperiment, fmi3EnterInitializationMode;
        set: fmi2SetReal, fmi3SetFloat64;
        get: fmi2GetReal, fmi3GetFloat64;
        do_step: fmi2DoStep, fmi3DoStep;
        directional_derivative: fmi2GetDirectionalDerivative, fmi3GetDirectionalDerivative;
    }
}

/// A function that is missing, and what the system says.
type Missing = (&'static str, libloading::Error);

/// # Safety
///
/// The function of this name has the type `F`.
unsafe fn named<F: Copy, G>(
    library: &libloading::Library,
    name: &'static str,
    wrap: impl FnOnce(F) -> G,
) -> Result<Named<G>, Missing> {
    // SAFETY: the caller's promise
    let function = unsafe { library.get::<F>(name) }.map_err(|refused| (name, refused))?;
    let function = wrap(*function);
    Ok(Named { name, function })
}

/// The shared library of an FMU.
pub struct Library {
    pub(crate) functions: Functions,
    /// Keeps the functions where they are; dropped last.
    _library: libloading::Library,
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
        // SAFETY: the standard gives the types to these names
        let functions =
            unsafe { Functions::of(&library, version) }.map_err(|(function, source)| {
                ImportError::Missing {
                    path: path.to_owned(),
                    function,
                    source,
                }
            })?;
        Ok(Self {
            functions,
            _library: library,
        })
    }

    /// Version of the standard that the library is driven by.
    #[must_use]
    pub fn version(&self) -> FmiVersion {
        match self.functions.instantiate.function {
            Either::Two(_) => FmiVersion::Two,
            Either::Three(_) => FmiVersion::Three,
        }
    }

    /// What the library itself says: `fmi2GetVersion` or `fmi3GetVersion`, such as `3.0`.
    #[must_use]
    pub fn version_text(&self) -> String {
        // SAFETY: the standard has these return a terminated string that stays
        unsafe {
            let text = (self.functions.get_version.function)();
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
        unsafe { (self.functions.free_instance.function)(instance) };
    }
}
