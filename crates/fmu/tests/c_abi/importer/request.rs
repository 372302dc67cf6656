//! How an instance is asked for.

use std::{
    ffi::{CString, c_char, c_void},
    ptr,
};

use super::callbacks::{Environment, update};
use super::{Instance, Message, TOKEN, record};
use crate::c;

/// How to instantiate.
pub(crate) struct Request<'a> {
    pub(crate) name: Option<&'a str>,
    pub(crate) token: Option<&'a str>,
    pub(crate) resources: Option<&'a str>,
    pub(crate) logging: bool,
    pub(crate) event_mode: bool,
    pub(crate) early_return: bool,
    /// Whether to give a callback for intermediate updates, and the variables that it will use.
    pub(crate) updated: bool,
    pub(crate) intermediate: &'a [u32],
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            name: Some("joint"),
            token: Some(TOKEN),
            resources: None,
            logging: true,
            event_mode: false,
            early_return: false,
            updated: false,
            intermediate: &[],
        }
    }
}

impl Request<'_> {
    /// The instance, or the messages that say why there is none.
    pub(crate) fn instantiate(&self) -> Result<Instance, Vec<Message>> {
        // SAFETY: all strings are terminated and live through the call, the log lives until the instance is freed
        self.instantiate_by(|[name, token, resources], log| unsafe {
            c::fmi3InstantiateCoSimulation(
                name,
                token,
                resources,
                false,
                self.logging,
                self.event_mode,
                self.early_return,
                self.intermediate.as_ptr(),
                self.intermediate.len(),
                log,
                Some(record),
                self.updated.then_some(update),
            )
        })
    }

    /// The instance for Model Exchange, or the messages that say why there is none.
    pub(crate) fn instantiate_model_exchange(&self) -> Result<Instance, Vec<Message>> {
        // SAFETY: all strings are terminated and live through the call, the log lives until the instance is freed
        self.instantiate_by(|[name, token, resources], log| unsafe {
            c::fmi3InstantiateModelExchange(
                name,
                token,
                resources,
                false,
                self.logging,
                log,
                Some(record),
            )
        })
    }

    fn instantiate_by(
        &self,
        function: impl FnOnce([*const c_char; 3], *mut c_void) -> *mut c_void,
    ) -> Result<Instance, Vec<Message>> {
        let texts = [self.name, self.token, self.resources]
            .map(|text| text.map(|text| CString::new(text).unwrap()));
        let pointers = texts
            .each_ref()
            .map(|text| text.as_ref().map_or(ptr::null(), |text| text.as_ptr()));
        let environment: *mut Environment = Box::into_raw(Box::default());
        let handle = function(pointers, environment.cast());
        if handle.is_null() {
            // SAFETY: nobody else has the environment any more
            return Err(unsafe { Box::from_raw(environment) }.log);
        }
        // SAFETY: the library uses the environment only during a call
        unsafe { (*environment).handle = Some(handle) };
        Ok(Instance {
            handle,
            environment,
            start_s: 0.0,
        })
    }
}
