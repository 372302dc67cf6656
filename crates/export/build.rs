//! Builds the FMU library that the executable embeds, for the target platform.
//!
//! The library's two crates have no dependencies, so the compiler is called directly: no second Cargo, no second
//! workspace, and the same flags whatever the profile, so that the bytes depend on the sources and the compiler alone.

use std::{
    env,
    error::Error,
    ffi::OsString,
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use bolted_joint_interface::Interfaces;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

#[path = "../fmu/linking.rs"]
mod linking;

/// Level of compression: it is done once, and every FMU is the smaller for it.
const SMALLEST: i64 = 9;

fn main() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<(), String> {
    let here = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    let root = root_of(&here)?;
    let out = PathBuf::from(variable("OUT_DIR")?);
    for watched in [
        "crates/export/build.rs",
        "crates/dynamics/src",
        "crates/fmu/src",
        "crates/fmu/linking.rs",
        "crates/fmu/old_glibc.rs",
    ] {
        println!("cargo:rerun-if-changed={}", root.join(watched).display());
    }

    let interfaces = Interfaces::present().map_err(|error| format!("modelDescription: {error}"))?;
    let tables = out.join("interface.rs");
    fs::write(&tables, interfaces.to_rust())
        .map_err(|error| format!("{}: {error}", tables.display()))?;

    let platform = Platform::of_target()?;
    let library = out.join(format!(
        "{}.{}",
        interfaces.lap.model_identifier, platform.extension
    ));
    let compiler = Compiler::new(&root, &out, &platform)?;
    let dynamics = compiler.dynamics()?;
    let old_glibc = compiler.old_glibc()?;
    compiler.fmu(&dynamics, old_glibc.as_deref(), &library)?;

    let packed = out.join("library.zip");
    pack(&library, &packed).map_err(|error| format!("{}: {error}", packed.display()))?;

    println!("cargo:rustc-env=BOLTED_JOINT_LIBRARY={}", library.display());
    println!(
        "cargo:rustc-env=BOLTED_JOINT_PACKED_LIBRARY={}",
        packed.display()
    );
    println!("cargo:rustc-env=BOLTED_JOINT_PLATFORM={}", platform.folder);
    Ok(())
}

/// Compresses the library once for all FMUs, as the one file of an archive.
fn pack(library: &Path, archive: &Path) -> Result<(), Box<dyn Error>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(SMALLEST))
        .last_modified_time(DateTime::DEFAULT)
        .unix_permissions(0o755);
    let mut writer = ZipWriter::new(fs::File::create(archive)?);
    writer.start_file("library", options)?;
    writer.write_all(&fs::read(library)?)?;
    writer.finish()?;
    Ok(())
}

/// Folder of the workspace.
fn root_of(package: &Path) -> Result<PathBuf, String> {
    package
        .ancestors()
        .nth(2)
        .map(Path::to_path_buf)
        .ok_or_else(|| format!("{}: found no workspace above it", package.display()))
}

/// Target platform as FMI 3.0 names it (section 2.5.1.4.1).
struct Platform {
    /// Folder below `binaries`.
    folder: String,
    /// Extension of a shared library.
    extension: &'static str,
    /// Flags that this platform's linker needs.
    flags: Vec<String>,
    /// Whether the functions of `old_glibc.rs` are linked in, for systems older than this one.
    old_glibc: bool,
}

impl Platform {
    fn of_target() -> Result<Self, String> {
        let architecture = match variable("CARGO_CFG_TARGET_ARCH")?.as_str() {
            "x86_64" => "x86_64",
            "x86" => "x86",
            "aarch64" => "aarch64",
            "arm" => "aarch32",
            "riscv64" => "riscv64",
            "riscv32" => "riscv32",
            "powerpc64" => "ppc64",
            "powerpc" => "ppc32",
            other => return Err(format!("FMI 3.0 has no name for the architecture {other}")),
        };
        let environment = env::var("CARGO_CFG_TARGET_ENV").unwrap_or_default();
        let system = variable("CARGO_CFG_TARGET_OS")?;
        let (name, extension) = match system.as_str() {
            "linux" => ("linux", "so"),
            "macos" => ("darwin", "dylib"),
            "windows" => ("windows", "dll"),
            other => {
                return Err(format!(
                    "FMI 3.0 has no name for the operating system {other}"
                ));
            }
        };
        let mut flags: Vec<String> = linking::arguments(&system, &environment)
            .iter()
            .map(|argument| format!("-Clink-arg={argument}"))
            .collect();
        match environment.as_str() {
            // a shared library needs the dynamic C library
            "musl" => flags.push("-Ctarget-feature=-crt-static".to_owned()),
            // no Visual C++ runtime on the user's machine
            "msvc" => flags.push("-Ctarget-feature=+crt-static".to_owned()),
            _ => {}
        }
        let old_glibc = system == "linux"
            && environment == "gnu"
            && matches!(architecture, "x86_64" | "aarch64")
            && variable("CARGO_CFG_TARGET_POINTER_WIDTH")? == "64";
        Ok(Self {
            folder: format!("{architecture}-{name}"),
            extension,
            flags,
            old_glibc,
        })
    }
}

/// The compiler, with the flags that both crates share.
struct Compiler<'a> {
    root: &'a Path,
    out: &'a Path,
    platform: &'a Platform,
    program: String,
    target: String,
    linker: Option<OsString>,
}

impl<'a> Compiler<'a> {
    fn new(root: &'a Path, out: &'a Path, platform: &'a Platform) -> Result<Self, String> {
        println!("cargo:rerun-if-env-changed=RUSTC_LINKER");
        Ok(Self {
            root,
            out,
            platform,
            program: variable("RUSTC")?,
            target: variable("TARGET")?,
            linker: env::var_os("RUSTC_LINKER"),
        })
    }

    fn dynamics(&self) -> Result<PathBuf, String> {
        let rlib = self.out.join("libbolted_joint_dynamics.rlib");
        let mut command = self.command("crates/dynamics/src/lib.rs", &rlib);
        command.args(["--crate-name=bolted_joint_dynamics", "--crate-type=rlib"]);
        // code for the optimiser that sees the whole library
        command.arg("-Cembed-bitcode=yes");
        run(command)?;
        Ok(rlib)
    }

    /// The object that keeps newer versions of the C library's symbols out of the library, where there is one.
    fn old_glibc(&self) -> Result<Option<PathBuf>, String> {
        if !self.platform.old_glibc {
            return Ok(None);
        }
        let object = self.out.join("old_glibc.o");
        let mut command = self.command("crates/fmu/old_glibc.rs", &object);
        command.args(["--crate-name=old_glibc", "--crate-type=lib", "--emit=obj"]);
        run(command)?;
        Ok(Some(object))
    }

    fn fmu(&self, dynamics: &Path, old_glibc: Option<&Path>, library: &Path) -> Result<(), String> {
        let mut command = self.command("crates/fmu/src/lib.rs", library);
        command.args(["--crate-name=bolted_joint", "--crate-type=cdylib"]);
        command.args(["-Clto=fat", "-Cstrip=symbols"]);
        command
            .arg("--extern")
            .arg(with_value("bolted_joint_dynamics=", dynamics));
        command.args(&self.platform.flags);
        if let Some(object) = old_glibc {
            command.arg(with_value("-Clink-arg=", object));
        }
        if let Some(linker) = &self.linker {
            command.arg(with_value("-Clinker=", Path::new(linker)));
        }
        run(command)
    }

    fn command(&self, source: &str, output: &Path) -> Command {
        let mut command = Command::new(&self.program);
        // relative to the root, so that no path of this machine is compiled in
        command
            .current_dir(self.root)
            .arg(source)
            .arg("-o")
            .arg(output);
        command.arg(format!("--target={}", self.target));
        command.args([
            "--edition=2024",
            "-Copt-level=3",
            "-Ccodegen-units=1",
            "-Cpanic=unwind",
        ]);
        command.args(["-Cdebuginfo=0", "-Cdebug-assertions=no", "--cap-lints=warn"]);
        command.arg(format!("-Cmetadata={}", env!("CARGO_PKG_VERSION")));
        command.arg(format!("--remap-path-prefix={}=", self.out.display()));
        command.arg(format!("--remap-path-prefix={}=", self.root.display()));
        command.env("OUT_DIR", self.out);
        command
    }
}

fn run(mut command: Command) -> Result<(), String> {
    let output = command
        .output()
        .map_err(|error| format!("{command:?} cannot be run: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let messages = String::from_utf8_lossy(&output.stderr);
    Err(format!(
        "the FMU library does not build with {command:?}:\n{messages}"
    ))
}

fn with_value(option: &str, value: &Path) -> OsString {
    let mut argument = OsString::from(option);
    argument.push(value);
    argument
}

fn variable(name: &str) -> Result<String, String> {
    env::var(name)
        .map_err(|error| format!("environment variable {name}: {error}; build with Cargo"))
}
