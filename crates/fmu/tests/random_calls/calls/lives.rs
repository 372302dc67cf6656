//! The lives of instances: how they are made, what can be seen of them, and whole lives by right calls alone.

use std::{
    ffi::{CString, c_int, c_void},
    path::Path,
    ptr,
};

use bolted_joint_importer::header::{
    DISCARD, ERROR, OK,
    fmi2::{self, CallbackFunctions, fmi2Instantiate},
    fmi3::{fmi3InstantiateCoSimulation, fmi3InstantiateModelExchange},
};

use super::{
    arrays::Arguments,
    choices::Choices,
    forged,
    host::{self, Host, MODELS, TOKEN},
    turn::{Interface, Mode, Subject, Told},
};
use crate::raw::{BOTH, Fmi2, Fmi3, FmiVersion, Raw, request::Request, seal};

const INTERFACES: [Interface; 2] = [Interface::CoSimulation, Interface::ModelExchange];

/// Time, and the displacements and velocities of all models here.
const SEEN: [u32; 5] = [0, 1, 3, 5, 7];

/// The same of y in space.
const SEEN_IN_SPACE: [u32; 5] = [0, 1, 122, 5, 133];

/// Time and the states of an assembly.
const SEEN_IN_ASSEMBLY: [u32; 5] = [0, 4097, 4098, 4099, 4100];

/// Of every joint: time, energy, power.
const SEEN_ALWAYS: [u32; 3] = [0, 15, 16];

/// A new instance, or none where the arguments are wrong; and the function that was called.
pub(crate) fn instantiate(
    version: FmiVersion,
    choices: &mut Choices<'_>,
) -> (&'static str, Option<Subject>) {
    let mut a = Arguments::new(choices);
    let model = a.choices.below(MODELS.len());
    let interface = INTERFACES[usize::from(a.choices.one_in(2))];
    let mut host = Box::<Host>::default();
    let logs = !a.unusual(4);
    let drawn = match version {
        Fmi2 => instantiate_fmi2(&mut a, model, interface, &mut host, logs),
        Fmi3 => instantiate_fmi3(&mut a, model, interface, &mut host, logs),
    };
    let Drawn {
        function,
        handle,
        logging,
        event_mode,
    } = drawn;
    assert_eq!(host.faults, [""; 0], "{function}");
    if handle.is_null() {
        assert!(!a.right || event_mode, "{function}: {:?}", host.messages);
        let errors = host.messages.iter().filter(|(status, _)| *status >= ERROR);
        assert_eq!(
            errors.count(),
            usize::from(logs),
            "{function}: {:?}",
            host.messages
        );
        return (function, None);
    }
    host.instance = Some(handle);
    let mut subject = Subject::new(Raw { version, handle }, interface, model, host);
    subject.logs = logs;
    subject.told = Told::from_the_start(logging);
    subject.event_mode = event_mode;
    (function, Some(subject))
}

/// What an instance was asked for with, and what came of it.
struct Drawn {
    function: &'static str,
    handle: *mut c_void,
    logging: bool,
    event_mode: bool,
}

fn instantiate_fmi2(
    a: &mut Arguments<'_, '_>,
    model: usize,
    interface: Interface,
    host: &mut Host,
    logs: bool,
) -> Drawn {
    // the structure is only there during the call
    let callbacks = Box::new(CallbackFunctions {
        logger: logs.then(|| fmi2::variadic(host::log_fmi2)),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        environment: ptr::from_mut(host).cast(),
    });
    let none = !logs && a.unusual(2);
    let name = a.text(c"joint");
    let guid = a.text(TOKEN);
    let resources = a.text(host::resources(model));
    let kind = if a.wrong(8) {
        a.choices.pick(&[-1, 2, c_int::MAX])
    } else {
        c_int::from(interface == Interface::CoSimulation)
    };
    let (visible, logging) = (a.flag(), a.flag());
    let functions = if none {
        ptr::null()
    } else {
        &raw const *callbacks
    };
    // SAFETY: the strings are terminated or null, the host outlives the instance
    let handle = unsafe {
        fmi2Instantiate(
            name,
            kind,
            guid,
            resources,
            functions,
            visible.into(),
            logging.into(),
        )
    };
    Drawn {
        function: "fmi2Instantiate",
        handle,
        logging: logging != 0,
        event_mode: false,
    }
}

fn instantiate_fmi3(
    a: &mut Arguments<'_, '_>,
    model: usize,
    interface: Interface,
    host: &mut Host,
    logs: bool,
) -> Drawn {
    let environment = ptr::from_mut(host).cast::<c_void>();
    let log = logs.then_some(host::log_fmi3 as _);
    let name = a.text(c"joint");
    let token = a.text(TOKEN);
    let resources = a.text(host::resources(model));
    let (visible, logging) = (a.flag(), a.flag());
    let (event_mode, early_return) = (a.unusual(2), a.unusual(2));
    if interface == Interface::ModelExchange {
        // SAFETY: the strings are terminated or null, the host outlives the instance
        let handle = unsafe {
            fmi3InstantiateModelExchange(name, token, resources, visible, logging, environment, log)
        };
        return Drawn {
            function: "fmi3InstantiateModelExchange",
            handle,
            logging: logging != 0,
            event_mode: false,
        };
    }
    let update = a.choices.one_in(2);
    let mut required = Vec::new();
    if update && a.choices.one_in(2) {
        // what the callback sets and reads
        host.references = (MODELS[model].inputs(), MODELS[model].outputs());
        required.extend(host.references.0);
        required.extend(host.references.1);
    }
    if a.wrong(8) {
        required.push(a.choices.below(64) as u32);
    }
    let required = a.array(required);
    // SAFETY: as above; the array has the length that is told, or one that no array has
    let handle = unsafe {
        fmi3InstantiateCoSimulation(
            name,
            token,
            resources,
            visible,
            logging,
            event_mode.into(),
            early_return.into(),
            required.pointer(),
            required.count(),
            environment,
            log,
            update.then_some(host::update_fmi3 as _),
        )
    };
    Drawn {
        function: "fmi3InstantiateCoSimulation",
        handle,
        logging: logging != 0,
        event_mode,
    }
}

/// Time, displacements and velocities, where they can be read.
pub(crate) fn values(subject: &Subject) -> Vec<f64> {
    let is_fmi2 = subject.raw.version == Fmi2;
    if is_fmi2 && matches!(subject.mode, None | Some(Mode::Instantiated | Mode::SetUp)) {
        return Vec::new();
    }
    let seen = match subject.model().dofs {
        _ if subject.model().assembly.is_some() => SEEN_IN_ASSEMBLY,
        6 => SEEN_IN_SPACE,
        _ => SEEN,
    };
    let values = subject.raw.try_get(&seen);
    values.expect("time, displacements and velocities can be read")
}

/// What every joint has, and of y where that is one of its motions.
fn seen_of_any(instance: Raw) -> Result<Vec<f64>, c_int> {
    let Ok(mut values) = instance.try_get(&SEEN_ALWAYS) else {
        return instance.try_get(&SEEN_IN_ASSEMBLY);
    };
    let of_y = [SEEN, SEEN_IN_SPACE].map(|seen| instance.try_get(&seen));
    values.extend(of_y.into_iter().flatten().flatten());
    Ok(values)
}

/// Restores these bytes, if they are accepted, steps, and resets.
pub(crate) fn go_on_from(instance: Raw, bytes: &[u8]) -> Vec<f64> {
    let Ok(state) = instance.deserialize(bytes) else {
        return Vec::new();
    };
    assert_eq!(instance.restore(state), OK);
    instance.free_state(state);
    let mut values = vec![0.0];
    for _ in 0..3 {
        if let Ok(found) = seen_of_any(instance) {
            assert!(found.iter().all(|value| value.is_finite()), "{found:?}");
            values = found;
        }
        instance.do_step(values[0], 1e-4);
        instance.complete_step();
    }
    assert_eq!(instance.reset(), OK);
    values
}

/// Instantiates an FMU in all four ways, and simulates a little where it is not refused. Tells whether it was not.
pub(crate) fn live_from(resources: &Path) -> bool {
    let path = CString::new(resources.to_str().expect("UTF-8")).expect("no zero byte");
    let mut accepted = false;
    for version in BOTH {
        for interface in INTERFACES {
            if let Some(subject) = open(version, interface, 0, &path) {
                accepted = true;
                simulate(&subject);
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
    let (version, interface) = (BOTH[pick % 2], INTERFACES[pick / 2 % 2]);
    let mut subject = open(version, interface, model, host::resources(model))
        .expect("the resources are those that were written");
    let mut bytes = subject.raw.state_bytes();
    let end = bytes.len() - forged::CHECKSUM;
    for (old, &new) in bytes[..end].iter_mut().rev().zip(content) {
        *old = new;
    }
    seal(&mut bytes);
    let accepted = !forged::go_on_from(&mut subject, &bytes).is_empty();
    close(&subject);
    accepted
}

/// Initialises and takes some steps; parameters that no simulation can start from are refused.
fn simulate(subject: &Subject) {
    let i = subject.raw;
    assert_eq!(i.enter_initialization(0.0, None), OK);
    if i.exit_initialization() >= DISCARD {
        return;
    }
    for step in 0..3 {
        match subject.interface {
            Interface::CoSimulation => {
                i.step(f64::from(step) * 1e-5, 1e-5);
            }
            Interface::ModelExchange => {
                i.enter_continuous();
                i.complete_step();
            }
        }
    }
    let values = seen_of_any(i).expect("values can be read");
    assert!(values.iter().all(|value| value.is_finite()));
}

/// An instance with right arguments; `None` after exactly one error that says why.
fn open(
    version: FmiVersion,
    interface: Interface,
    model: usize,
    resources: &std::ffi::CStr,
) -> Option<Subject> {
    let mut host = Box::<Host>::default();
    let request = Request {
        version,
        interface,
        token: Some(TOKEN),
        resources: Some(resources),
        environment: (&raw mut *host).cast(),
        log: (Some(host::log_fmi2), Some(host::log_fmi3)),
        ..Request::NONE
    };
    let instance = request.instantiate();
    assert_eq!(host.faults, [""; 0]);
    let Some(raw) = instance else {
        let errors = host.messages.iter().filter(|(status, _)| *status >= ERROR);
        assert_eq!(errors.count(), 1, "{:?}", host.messages);
        return None;
    };
    Some(Subject::new(raw, interface, model, host))
}

fn close(subject: &Subject) {
    assert_eq!(subject.host.faults, [""; 0]);
    subject.raw.free();
}
