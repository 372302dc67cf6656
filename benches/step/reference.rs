//! The same Runge–Kutta steps in plain C, compiled when the benchmark starts.

use std::{
    env,
    error::Error,
    ffi::OsString,
    fs,
    path::PathBuf,
    process::{Command, Output},
};

use bolted_joint_dynamics::{Lap, law::Term};

const SOURCE: &str = include_str!("reference.c");

/// `run` of the source: parameters, state, rows of loads and how many, first row, interval in s, substeps, steps.
type RunC =
    unsafe extern "C" fn(*const f64, *mut f64, *const f64, usize, usize, f64, u32, u64) -> f64;

/// What the C code does with the inertias.
#[derive(Clone, Copy)]
pub(crate) enum Inertias {
    /// Divides by them in every stage.
    Divided,
    /// Multiplies by their reciprocals, calculated once.
    Reciprocals,
}

/// The C compiler, and a folder for what it makes.
pub(crate) struct Compiler {
    program: OsString,
    folder: tempfile::TempDir,
}

impl Compiler {
    /// The compiler named by the variable `CC`, or `cc`. The error says what to install.
    pub(crate) fn find() -> Result<Self, Box<dyn Error>> {
        let program = env::var_os("CC").unwrap_or_else(|| "cc".into());
        let shown = program.to_string_lossy().into_owned();
        let advice = "install a C compiler (Debian, Ubuntu: apt-get install gcc) or name one in the variable CC";
        let output = Command::new(&program)
            .arg("--version")
            .output()
            .map_err(|error| format!("{shown} cannot be run ({error}): {advice}"))?;
        if !output.status.success() {
            return Err(format!("{shown} --version fails: {advice}").into());
        }
        let version = String::from_utf8_lossy(&output.stdout);
        println!(
            "C reference: {shown} -O3, {}",
            version.lines().next().unwrap_or_default()
        );
        Ok(Self {
            program,
            folder: tempfile::tempdir()?,
        })
    }

    fn library(
        &self,
        dofs: usize,
        cubic: bool,
        inertias: Inertias,
    ) -> Result<PathBuf, Box<dyn Error>> {
        let (cubic, reciprocals) = (
            u8::from(cubic),
            u8::from(matches!(inertias, Inertias::Reciprocals)),
        );
        let source = self.folder.path().join("reference.c");
        let library = self
            .folder
            .path()
            .join(format!("{dofs}{cubic}{reciprocals}.so"));
        if library.exists() {
            return Ok(library);
        }
        fs::write(&source, SOURCE)?;
        let Output { status, stderr, .. } = Command::new(&self.program)
            .args(["-std=c11", "-O3", "-shared", "-fPIC"])
            .args([
                format!("-DDOFS={dofs}"),
                format!("-DCUBIC={cubic}"),
                format!("-DRECIPROCALS={reciprocals}"),
            ])
            .arg(&source)
            .arg("-o")
            .arg(&library)
            .output()?;
        if !status.success() {
            let messages = String::from_utf8_lossy(&stderr);
            return Err(format!("the C reference does not compile:\n{messages}").into());
        }
        Ok(library)
    }
}

/// The lap in C, with its state.
pub(crate) struct Reference<const D: usize> {
    run: RunC,
    parameters: Vec<f64>,
    /// Displacements of a and b, velocities of a and b.
    state: Vec<f64>,
    /// On a and b, a row for each step.
    loads: Vec<f64>,
    next: usize,
    interval_s: f64,
    substeps: u32,
    /// Keeps the function where it is.
    _library: libloading::Library,
}

impl<const D: usize> Reference<D> {
    /// The lap at rest, with `loads` in turn over communication steps of `interval_s` (s).
    pub(crate) fn new(
        compiler: &Compiler,
        inertias: Inertias,
        lap: &Lap<D>,
        loads: Vec<f64>,
        interval_s: f64,
        substeps: u32,
    ) -> Result<Self, Box<dyn Error>> {
        let linear = &lap.joint.linear;
        let cubic = lap
            .joint
            .polynomials()
            .map(|terms| terms.coefficient(Term::CUBIC));
        let has_cubic = cubic.iter().any(|&cubic| cubic != 0.0);
        let path = compiler.library(D, has_cubic, inertias)?;
        let matrices = linear.stiffness.iter().chain(&linear.damping);
        let mut parameters: Vec<f64> = matrices.flatten().copied().collect();
        parameters.extend(cubic);
        for [a, b] in [
            [lap.a.inertia, lap.b.inertia],
            [lap.a.stiffness, lap.b.stiffness],
            [lap.a.damping, lap.b.damping],
        ] {
            parameters.extend(a);
            parameters.extend(b);
        }
        // SAFETY: the library runs no code when it is loaded, and the types are those of the source
        let (library, run, count) = unsafe {
            let library = libloading::Library::new(path)?;
            let run: RunC = *library.get("run")?;
            let count: unsafe extern "C" fn() -> usize = *library.get("parameter_count")?;
            (library, run, count())
        };
        if count != parameters.len() {
            return Err(format!("the C reference has {count} parameters").into());
        }
        Ok(Self {
            run,
            parameters,
            state: vec![0.0; 4 * D],
            loads,
            next: 0,
            interval_s,
            substeps,
            _library: library,
        })
    }

    /// Takes communication steps; the sum of all states on the way.
    pub(crate) fn take(&mut self, steps: u64) -> f64 {
        let period = self.loads.len() / (2 * D);
        // SAFETY: the arrays have the lengths that the source expects for this number of DOFs
        let sum = unsafe {
            (self.run)(
                self.parameters.as_ptr(),
                self.state.as_mut_ptr(),
                self.loads.as_ptr(),
                period,
                self.next,
                self.interval_s,
                self.substeps,
                steps,
            )
        };
        self.next = (self.next + steps as usize) % period;
        sum
    }
}
