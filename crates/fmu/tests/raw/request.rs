//! How an instance is asked for, with right arguments or without some.

use std::{
    ffi::{CStr, c_int, c_void},
    ptr,
};

use bolted_joint_importer::header::{
    fmi2::{self, CallbackFunctions, FixedLogger, fmi2Instantiate},
    fmi3::{
        IntermediateUpdateCallback, LogMessageCallback, fmi3InstantiateCoSimulation,
        fmi3InstantiateModelExchange,
    },
};

use super::{Fmi2, Fmi3, FmiVersion, Interface, Raw};

/// How to instantiate; what only one version has is left out with the other.
#[derive(Clone, Copy)]
pub(crate) struct Request<'a> {
    pub(crate) version: FmiVersion,
    pub(crate) interface: Interface,
    pub(crate) name: Option<&'a CStr>,
    pub(crate) token: Option<&'a CStr>,
    pub(crate) resources: Option<&'a CStr>,
    pub(crate) logging: bool,
    pub(crate) event_mode: bool,
    pub(crate) early_return: bool,
    /// Variables that the callback for intermediate updates will use.
    pub(crate) intermediate: &'a [u32],
    pub(crate) environment: *mut c_void,
    pub(crate) log: (Option<FixedLogger>, Option<LogMessageCallback>),
    pub(crate) update: Option<IntermediateUpdateCallback>,
}

impl Request<'_> {
    /// For an instance of this name, without callbacks.
    pub(crate) const NONE: Self = Self {
        version: Fmi3,
        interface: Interface::CoSimulation,
        name: Some(c"joint"),
        token: None,
        resources: None,
        logging: false,
        event_mode: false,
        early_return: false,
        intermediate: &[],
        environment: ptr::null_mut(),
        log: (None, None),
        update: None,
    };

    /// The instance, if there is one.
    pub(crate) fn instantiate(&self) -> Option<Raw> {
        let [name, token, resources] = [self.name, self.token, self.resources]
            .map(|text| text.map_or(ptr::null(), CStr::as_ptr));
        let (visible, logging) = (0, self.logging);
        let (environment, (fmi2_log, fmi3_log)) = (self.environment, self.log);
        // the structure is only there during the call
        let callbacks = Box::new(CallbackFunctions {
            logger: fmi2_log.map(fmi2::variadic),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment,
        });
        // SAFETY: all pointers are null or to what lives through the call; callbacks can be called with the environment
        let handle = unsafe {
            match (self.version, self.interface) {
                (Fmi2, interface) => fmi2Instantiate(
                    name,
                    c_int::from(interface == Interface::CoSimulation),
                    token,
                    resources,
                    &raw const *callbacks,
                    visible.into(),
                    logging.into(),
                ),
                (Fmi3, Interface::ModelExchange) => fmi3InstantiateModelExchange(
                    name,
                    token,
                    resources,
                    visible,
                    logging.into(),
                    environment,
                    fmi3_log,
                ),
                (Fmi3, Interface::CoSimulation) => fmi3InstantiateCoSimulation(
                    name,
                    token,
                    resources,
                    visible,
                    logging.into(),
                    self.event_mode.into(),
                    self.early_return.into(),
                    self.intermediate.as_ptr(),
                    self.intermediate.len(),
                    environment,
                    fmi3_log,
                    self.update,
                ),
            }
        };
        let version = self.version;
        (!handle.is_null()).then_some(Raw { version, handle })
    }
}
