//! The life of one instance by right calls alone, whatever its resources or its saved state are.

use std::{
    ffi::{CStr, CString, c_void},
    path::Path,
};

use super::{
    fmi2, fmi3, forged,
    host::{self, ERROR, Host, MODELS},
    turn::{Interface, Mode, Subject, Told, Version},
};

const VERSIONS: [Version; 2] = [Version::Fmi2, Version::Fmi3];
const INTERFACES: [Interface; 2] = [Interface::CoSimulation, Interface::ModelExchange];

/// Instantiates an FMU in all four ways, and simulates a little where it is not refused. Tells whether it was not.
pub(crate) fn live_from(resources: &Path) -> bool {
    let path = CString::new(resources.to_str().expect("UTF-8")).expect("no zero byte");
    let mut accepted = false;
    for version in VERSIONS {
        for interface in INTERFACES {
            if let Some(subject) = open(version, interface, 0, &path) {
                accepted = true;
                match version {
                    Version::Fmi2 => fmi2::simulate(&subject),
                    Version::Fmi3 => fmi3::simulate(&subject),
                }
                close(&subject);
            }
        }
    }
    accepted
}

/// Replaces the content of a true state, from its end on, makes the checksum right, and goes on from there if that is
/// accepted. `pick` decides on the FMU.
pub(crate) fn go_on_from_forged_bytes(pick: u8, content: &[u8]) -> bool {
    let pick = usize::from(pick);
    let model = pick / 4 % MODELS.len();
    let (version, interface) = (VERSIONS[pick % 2], INTERFACES[pick / 2 % 2]);
    let mut subject = open(version, interface, model, host::resources(model))
        .expect("the resources are those that were written");
    let mut bytes = match version {
        Version::Fmi2 => fmi2::state_bytes(subject.handle),
        Version::Fmi3 => fmi3::state_bytes(subject.handle),
    };
    let end = bytes.len() - forged::CHECKSUM;
    for (old, &new) in bytes[..end].iter_mut().rev().zip(content) {
        *old = new;
    }
    forged::seal(&mut bytes);
    let accepted = !forged::go_on_from(&mut subject, &bytes).is_empty();
    close(&subject);
    accepted
}

/// An instance with right arguments; `None` after exactly one error that says why.
fn open(version: Version, interface: Interface, model: usize, resources: &CStr) -> Option<Subject> {
    let mut host = Box::<Host>::default();
    let environment = (&raw mut *host).cast::<c_void>();
    let handle: *mut c_void = match version {
        Version::Fmi2 => fmi2::open(interface, resources, environment),
        Version::Fmi3 => fmi3::open(interface, resources, environment),
    };
    assert_eq!(host.faults, [""; 0]);
    if handle.is_null() {
        let errors = host.messages.iter().filter(|(status, _)| *status >= ERROR);
        assert_eq!(errors.count(), 1, "{:?}", host.messages);
        return None;
    }
    Some(Subject {
        version,
        interface,
        model,
        handle,
        host,
        logs: true,
        told: Told::from_the_start(true),
        event_mode: false,
        mode: Some(Mode::Instantiated),
        time_s: 0.0,
    })
}

fn close(subject: &Subject) {
    assert_eq!(subject.host.faults, [""; 0]);
    match subject.version {
        Version::Fmi2 => fmi2::free(subject.handle),
        Version::Fmi3 => fmi3::free(subject.handle),
    }
}
