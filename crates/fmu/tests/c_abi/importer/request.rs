//! How an instance is asked for.

use std::ffi::CString;

use super::callbacks::{Environment, update};
use super::{Folder, Instance, Message, TOKEN, record, record_fmi2};
use crate::raw::{self, Fmi3, FmiVersion, Interface};

/// How to instantiate.
pub(crate) struct Request<'a> {
    pub(crate) version: FmiVersion,
    pub(crate) interface: Interface,
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
            version: Fmi3,
            interface: Interface::CoSimulation,
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

impl<'a> Request<'a> {
    /// For an instance with the resources in this folder.
    pub(crate) fn of(folder: &'a Folder) -> Self {
        Self {
            resources: folder.0.to_str(),
            ..Self::default()
        }
    }

    /// The instance, or the messages that say why there is none.
    pub(crate) fn instantiate(&self) -> Result<Instance, Vec<Message>> {
        let texts = [self.name, self.token, self.resources]
            .map(|text| text.map(|text| CString::new(text).unwrap()));
        let [name, token, resources] = texts.each_ref().map(|text| text.as_deref());
        let environment: *mut Environment = Box::into_raw(Box::default());
        let request = raw::request::Request {
            version: self.version,
            interface: self.interface,
            name,
            token,
            resources,
            logging: self.logging,
            event_mode: self.event_mode,
            early_return: self.early_return,
            intermediate: self.intermediate,
            environment: environment.cast(),
            log: (Some(record_fmi2), Some(record)),
            update: self.updated.then_some(update),
        };
        let Some(raw) = request.instantiate() else {
            // SAFETY: nobody else has the environment any more
            return Err(unsafe { Box::from_raw(environment) }.log);
        };
        // SAFETY: the library uses the environment only during a call
        unsafe { (*environment).handle = Some(raw.handle) };
        Ok(Instance { raw, environment })
    }

    /// There is no instance, for the reason that is expected.
    #[track_caller]
    pub(crate) fn refuses(&self, expected: &str) {
        let message = self.refusal();
        assert!(message.contains(expected), "{message}, not {expected}");
    }

    /// The one reason why there is no instance.
    pub(crate) fn refusal(&self) -> String {
        let log = self.instantiate().err().unwrap();
        let [message] = log.as_slice() else {
            panic!("{log:?}");
        };
        let function = match (self.version, self.interface) {
            (FmiVersion::Two, _) => "fmi2Instantiate",
            (Fmi3, Interface::CoSimulation) => "fmi3InstantiateCoSimulation",
            (Fmi3, Interface::ModelExchange) => "fmi3InstantiateModelExchange",
        };
        let name = (self.version == FmiVersion::Two).then(|| self.name.unwrap_or(""));
        assert_eq!(message.instance_name.as_deref(), name);
        assert_eq!(message.status, crate::c::ERROR);
        assert_eq!(message.category, "logStatusError");
        assert!(
            message.text.starts_with(&format!("{function}: ")),
            "{message:?}"
        );
        message.text.clone()
    }
}
