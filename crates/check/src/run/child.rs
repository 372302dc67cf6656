//! The child process: loads the library, does what the script says and keeps a journal of it.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use bolted_joint_importer::{ImportError, Instance, Library, SavedState, Setup};

use super::script::{Action, Entry, Script};

/// Carries out the script in the file `script`, writing each thing to the file `journal` before it is done.
///
/// It is the other half of [`super::run`], which starts a process for it. What the FMU does wrong is in the journal.
///
/// # Errors
///
/// What the system says where the files cannot be read or written.
pub fn execute_script(script: &Path, journal: &Path) -> io::Result<()> {
    let script: Script = serde_json::from_slice(&fs::read(script)?)?;
    let journal = Journal(Arc::new(Mutex::new(File::create(journal)?)));
    journal.add(&Entry::Loading)?;
    let outcome = match Library::load(&script.library, script.version) {
        Ok(library) => perform(&library, &script, &journal),
        Err(refused) => Err(Stopped::Refused(refused)),
    };
    match outcome {
        Ok(()) => journal.add(&Entry::Finished),
        Err(Stopped::Refused(refused)) => journal.add(&Entry::Refused(refused.to_string())),
        Err(Stopped::Journal(failed)) => Err(failed),
    }
}

/// Why the script was not carried out to its end.
#[derive(Debug, thiserror::Error)]
enum Stopped {
    #[error(transparent)]
    Refused(#[from] ImportError),
    #[error(transparent)]
    Journal(#[from] io::Error),
}

/// The file that outlives the process, one entry a line, each written at once.
#[derive(Clone)]
struct Journal(Arc<Mutex<File>>);

impl Journal {
    fn add(&self, entry: &Entry) -> io::Result<()> {
        let mut line = serde_json::to_vec(entry)?;
        line.push(b'\n');
        let mut file = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(&line)
    }

    fn add_values(&self, values: &[f64]) -> io::Result<()> {
        let finite = |value: &f64| value.is_finite().then_some(*value);
        self.add(&Entry::Values(values.iter().map(finite).collect()))
    }
}

fn perform(library: &Library, script: &Script, journal: &Journal) -> Result<(), Stopped> {
    let mut running: Option<(Instance<'_>, Option<SavedState<'_>>)> = None;
    for (index, action) in script.actions.iter().enumerate() {
        journal.add(&Entry::Began(index))?;
        if let Action::Start { references, values } = action {
            if let Some((mut instance, saved)) = running.take() {
                drop(saved);
                instance.terminate()?;
            }
            running = Some((start(library, script, journal, references, values)?, None));
            continue;
        }
        let Some((instance, saved)) = &mut running else {
            return Err(io::Error::other("the script does not begin with an instance").into());
        };
        match action {
            Action::Start { .. } => {}
            Action::Set { references, values } => instance.set(references, values)?,
            Action::Step {
                time_s,
                interval_s,
                tentative: false,
            } => drop(instance.step(*time_s, *interval_s)?),
            Action::Step {
                time_s, interval_s, ..
            } => drop(instance.tentative_step(*time_s, *interval_s)?),
            Action::Get { references } => {
                let mut values = vec![0.0; references.len()];
                instance.get(references, &mut values)?;
                journal.add_values(&values)?;
            }
            Action::Derive {
                unknowns,
                knowns,
                seed,
            } => {
                let mut values = vec![0.0; unknowns.len()];
                instance.directional_derivative(unknowns, knowns, seed, &mut values)?;
                journal.add_values(&values)?;
            }
            Action::Save => *saved = Some(instance.save()?),
            Action::Restore => {
                if let Some(saved) = saved {
                    instance.restore(saved)?;
                }
            }
        }
    }
    if let Some((mut instance, saved)) = running {
        drop(saved);
        instance.terminate()?;
    }
    Ok(())
}

fn start<'l>(
    library: &'l Library,
    script: &Script,
    journal: &Journal,
    references: &[u32],
    values: &[f64],
) -> Result<Instance<'l>, ImportError> {
    let journal = journal.clone();
    let mut instance = library.instantiate(Setup {
        name: "check",
        token: &script.token,
        resources: &script.resources,
        logging: false,
        listener: Some(Box::new(move |message| {
            // a journal that cannot be written to is found out by the next entry
            drop(journal.add(&Entry::Logged(message.to_string())));
        })),
    })?;
    instance.enter_initialization(0.0, None)?;
    instance.set(references, values)?;
    instance.exit_initialization()?;
    Ok(instance)
}
