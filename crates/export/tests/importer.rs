//! The importer against the library that this program puts into FMUs: every call, every error, both standards.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};

use bolted_joint_importer::{FmiVersion, ImportError, Instance, Library, Message, Setup, Status};

const START: &str = "bolted-joint-start/1\nmodel lap\ndofs 1\ntoken {100 % #1}\n\
    joint.k_yy 4e6\njoint.c_yy 8\njoint.k3_y 0\njoint.k5_y 0\njoint.k7_y 0\n\
    joint.c2_y 0\njoint.c4_y 0\na.m 2\na.k_y 8e5\na.c_y 1\nb.m 2\nb.k_y 8e5\nb.c_y 1\nstep_size_max 2e-5\n";
const TOKEN: &str = "{100 % #1}";
const A_Y: u32 = 1;
const B_Y: u32 = 5;
const B_F: u32 = 11;
const JOINT_F: u32 = 13;

fn load(version: FmiVersion) -> Library {
    Library::load(Path::new(env!("BOLTED_JOINT_LIBRARY")), version).unwrap()
}

/// A folder with a space, a percent sign and a letter beyond ASCII in its name.
fn resources() -> tempfile::TempDir {
    let folder = tempfile::Builder::new()
        .prefix("Prüfung 100% #")
        .tempdir()
        .unwrap();
    fs::write(folder.path().join("start.txt"), START).unwrap();
    folder
}

fn instance<'l>(library: &'l Library, folder: &Path) -> Result<Instance<'l>, ImportError> {
    library.instantiate(Setup {
        name: "test",
        token: TOKEN,
        resources: folder,
        logging: false,
        listener: None,
    })
}

fn stepping<'l>(library: &'l Library, folder: &Path) -> Instance<'l> {
    let mut instance = instance(library, folder).unwrap();
    instance.enter_initialization(0.0, Some(1.0)).unwrap();
    instance.set(&[A_Y], &[1e-5]).unwrap();
    instance.exit_initialization().unwrap();
    instance
}

fn value(instance: &mut Instance<'_>, reference: u32) -> f64 {
    let mut values = [f64::NAN];
    instance.get(&[reference], &mut values).unwrap();
    values[0]
}

#[test]
fn both_standards_give_the_same_bits() {
    let folder = resources();
    let mut ends = Vec::new();
    for (version, text) in [(FmiVersion::Two, "2.0"), (FmiVersion::Three, "3.0")] {
        let library = load(version);
        assert_eq!(
            (library.version(), &*library.version_text()),
            (version, text)
        );
        let mut instance = stepping(&library, folder.path());
        // F = K r at rest
        assert_eq!(value(&mut instance, JOINT_F), 4e6 * 1e-5);
        let mut slope = [f64::NAN];
        instance
            .directional_derivative(&[JOINT_F], &[A_Y, B_Y], &[1.0, 0.5], &mut slope)
            .unwrap();
        assert_eq!(slope[0], 4e6 * 0.5);
        for index in 0..10 {
            instance.set(&[B_F], &[f64::from(index)]).unwrap();
            let step = instance.step(f64::from(index) * 1e-4, 1e-4).unwrap();
            assert!((step.reached_s - f64::from(index + 1) * 1e-4).abs() < 1e-12);
            assert!(!step.event && !step.terminate && !step.early_return);
        }
        ends.push(value(&mut instance, B_Y).to_bits());
        instance.terminate().unwrap();
        instance.reset().unwrap();
    }
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn states_outlive_what_they_were_saved_from() {
    let folder = resources();
    for version in [FmiVersion::Two, FmiVersion::Three] {
        let library = load(version);
        let mut first = stepping(&library, folder.path());
        first.step(0.0, 1e-3).unwrap();
        let saved = first.save().unwrap();
        let bytes = first.serialize(&saved).unwrap();
        first.tentative_step(1e-3, 1e-3).unwrap();
        let end = value(&mut first, A_Y);
        drop(first);
        // another instance takes up the state, then its bytes
        let mut second = stepping(&library, folder.path());
        second.restore(&saved).unwrap();
        second.step(1e-3, 1e-3).unwrap();
        assert_eq!(value(&mut second, A_Y).to_bits(), end.to_bits());
        let read = second.deserialize(&bytes).unwrap();
        second.restore(&read).unwrap();
        second.step(1e-3, 1e-3).unwrap();
        assert_eq!(value(&mut second, A_Y).to_bits(), end.to_bits());
        // damaged bytes are refused by the FMU, a state of another loaded library before it comes to that
        let refused = second.deserialize(&bytes[1..]).map(|_| ()).unwrap_err();
        assert!(matches!(
            refused,
            ImportError::Refused {
                status: Status::Error,
                ..
            }
        ));
        let other = load(version);
        let mut third = stepping(&other, folder.path());
        assert!(matches!(
            third.restore(&saved),
            Err(ImportError::ForeignState { .. })
        ));
    }
}

#[test]
fn refusals_come_with_what_the_fmu_said() {
    let folder = resources();
    for version in [FmiVersion::Two, FmiVersion::Three] {
        let library = load(version);
        let mut instance = stepping(&library, folder.path());
        let Err(ImportError::Refused {
            status, messages, ..
        }) = instance.step(0.0, -1.0)
        else {
            panic!("a step back in time was taken");
        };
        assert!(!status.is_done());
        assert!(
            messages.iter().any(|message| message.text.contains("-1")),
            "{messages:?}"
        );
        assert_eq!(instance.messages(), messages);
        assert!(matches!(
            instance.set(&[A_Y, B_Y], &[1.0]),
            Err(ImportError::Count {
                references: 2,
                values: 1,
                ..
            })
        ));
        // the token has the characters that formats and messages treat as their own
        let heard: Arc<Mutex<Vec<Message>>> = Arc::default();
        let listening = Arc::clone(&heard);
        let refused = library.instantiate(Setup {
            name: "test",
            token: "50 % of #2",
            resources: folder.path(),
            logging: true,
            listener: Some(Box::new(move |message| {
                listening.lock().unwrap().push(message.clone());
                panic!("must not reach the library");
            })),
        });
        let Err(ImportError::Null { .. }) = refused else {
            panic!("a foreign token was accepted");
        };
        let text = heard.lock().unwrap()[0].text.clone();
        assert!(
            text.contains("50 % of #2") && text.contains(TOKEN),
            "{text}"
        );
        let refused = library.instantiate(Setup {
            name: "te\0st",
            token: TOKEN,
            resources: folder.path(),
            logging: false,
            listener: None,
        });
        assert!(matches!(refused, Err(ImportError::Text { .. })));
    }
}

#[test]
fn what_is_no_library_of_an_fmu_is_refused() {
    let folder = resources();
    let text = folder.path().join("start.txt");
    let refused = |path: &Path| {
        Library::load(path, FmiVersion::Three)
            .map(|_| ())
            .unwrap_err()
    };
    assert!(matches!(refused(&text), ImportError::Unloadable { .. }));
    assert!(matches!(
        refused(&folder.path().join("none.so")),
        ImportError::Unloadable { .. }
    ));
}
