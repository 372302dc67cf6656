//! The shared libraries that go into an FMU: the embedded one, and those of other platforms from a folder.

use std::fs;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use bolted_joint_files::inputs;

use super::archive::Content;
use super::{ExportError, FmiVersion};

/// The FMU library of the platform that this program was built for, as the one file of an archive.
const EMBEDDED_LIBRARY: &[u8] = include_bytes!(env!("BOLTED_JOINT_PACKED_LIBRARY"));

/// That platform, as FMI 3.0 names it.
pub const EMBEDDED_PLATFORM: &str = env!("BOLTED_JOINT_PLATFORM");

/// Name of the libraries in the folders of platforms, without extension.
const SOURCE_NAME: &str = "bolted_joint";

/// Architectures of FMI 3.0's platform names (section 2.5.1.4.1).
const ARCHITECTURES: [&str; 8] = [
    "aarch32", "aarch64", "ppc32", "ppc64", "riscv32", "riscv64", "x86", "x86_64",
];

/// An operating system of FMI 3.0's platform names, and its shared libraries.
struct System {
    suffix: &'static str,
    extension: &'static str,
    format: &'static str,
    magic: &'static [&'static [u8]],
}

const SYSTEMS: [System; 3] = [
    System {
        suffix: "-darwin",
        extension: "dylib",
        format: "Mach-O",
        // 64-bit and 32-bit little-endian, universal
        magic: &[
            b"\xcf\xfa\xed\xfe",
            b"\xce\xfa\xed\xfe",
            b"\xca\xfe\xba\xbe",
        ],
    },
    System {
        suffix: "-linux",
        extension: "so",
        format: "ELF",
        magic: &[b"\x7fELF"],
    },
    System {
        suffix: "-windows",
        extension: "dll",
        format: "PE",
        magic: &[b"MZ"],
    },
];

/// A shared library in an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Library {
    /// Platform's folder in the FMU, such as `x86_64-windows`, or `win64` in FMI 2.0.
    pub platform: String,
    /// Where the library was taken from.
    pub source: LibrarySource,
}

/// Where a shared library was taken from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LibrarySource {
    /// This program carries it.
    Embedded,
    /// A file in the folder of platforms.
    File(PathBuf),
}

/// A library with its bytes and its place in the FMU.
pub(super) struct Binary {
    pub(super) library: Library,
    pub(super) path: String,
    pub(super) content: Content,
}

/// The FMU library of [`EMBEDDED_PLATFORM`].
///
/// # Errors
///
/// [`ExportError::Archive`] where what this program carries is damaged.
pub fn embedded_library() -> Result<Vec<u8>, ExportError> {
    Content::packed(EMBEDDED_LIBRARY)?.bytes()
}

/// The embedded library and those in `folder`, by platform; a library in the folder comes before the embedded one.
///
/// `name` is the libraries' name in the FMU, without extension. The folders in `folder` have the names of FMI 3.0 whatever the
/// `version` that the FMU follows. Files and hidden folders beside the platforms' are left alone.
pub(super) fn binaries(
    folder: Option<&Path>,
    name: &str,
    version: FmiVersion,
) -> Result<Vec<Binary>, ExportError> {
    let mut found = match folder {
        Some(folder) => from_folder(folder, name, version)?,
        None => Vec::new(),
    };
    if let Some(system) = system_of(EMBEDDED_PLATFORM) {
        let path = entry_path(EMBEDDED_PLATFORM, name, system, version);
        if !found.iter().any(|binary| binary.path == path) {
            found.push(Binary {
                library: Library {
                    platform: version.platform_folder(EMBEDDED_PLATFORM).to_owned(),
                    source: LibrarySource::Embedded,
                },
                path,
                content: Content::packed(EMBEDDED_LIBRARY)?,
            });
        }
    }
    found.sort_by(|one, other| one.path.cmp(&other.path));
    Ok(found)
}

fn from_folder(folder: &Path, name: &str, version: FmiVersion) -> Result<Vec<Binary>, ExportError> {
    let unreadable = |path: &Path, source: io::Error| ExportError::UnreadablePlatforms {
        path: path.to_path_buf(),
        source,
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(|source| unreadable(folder, source))? {
        let path = entry.map_err(|source| unreadable(folder, source))?.path();
        let platform = path.file_name().unwrap_or_default().to_string_lossy();
        if platform.starts_with('.') || !path.is_dir() {
            continue;
        }
        let system = system_of(&platform).ok_or_else(|| ExportError::UnknownPlatform {
            path: path.clone(),
            architectures: ARCHITECTURES.to_vec(),
            systems: SYSTEMS.iter().map(|system| system.suffix).collect(),
        })?;
        let library = path.join(format!("{SOURCE_NAME}.{}", system.extension));
        let mut bytes = Vec::new();
        let read = inputs::open(&library).and_then(|mut file| file.read_to_end(&mut bytes));
        read.map_err(|source| match source.kind() {
            io::ErrorKind::NotFound => ExportError::NoLibrary {
                path: library.clone(),
            },
            _ => unreadable(&library, source),
        })?;
        if !system.magic.iter().any(|magic| bytes.starts_with(magic)) {
            return Err(ExportError::NotALibrary {
                path: library,
                format: system.format,
            });
        }
        found.push(Binary {
            path: entry_path(&platform, name, system, version),
            library: Library {
                platform: version.platform_folder(&platform).to_owned(),
                source: LibrarySource::File(library),
            },
            content: Content::Bytes(bytes),
        });
    }
    if found.is_empty() {
        let path = folder.to_path_buf();
        return Err(ExportError::NoPlatforms { path });
    }
    Ok(found)
}

fn system_of(platform: &str) -> Option<&'static System> {
    SYSTEMS.iter().find(|system| {
        platform
            .strip_suffix(system.suffix)
            .is_some_and(|architecture| ARCHITECTURES.contains(&architecture))
    })
}

fn entry_path(platform: &str, name: &str, system: &System, version: FmiVersion) -> String {
    let folder = version.platform_folder(platform);
    format!("binaries/{folder}/{name}.{}", system.extension)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder_with(files: &[(&str, &[u8])]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (file, bytes) in files {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        folder
    }

    fn refusal(files: &[(&str, &[u8])]) -> String {
        let folder = folder_with(files);
        match binaries(Some(folder.path()), "bolted_joint", FmiVersion::V3) {
            Ok(_) => "accepted".to_owned(),
            Err(refused) => refused.to_string(),
        }
    }

    #[test]
    fn the_embedded_library_is_one_for_this_platform() {
        let found = binaries(None, "bolted_joint", FmiVersion::V3).unwrap();
        assert_eq!(found.len(), 1);
        let system = system_of(&found[0].library.platform).unwrap();
        let bytes = embedded_library().unwrap();
        assert!(bytes.starts_with(system.magic[0]) || cfg!(target_os = "macos"));
        assert!(bytes.len() > 10_000 && found[0].content.size() == bytes.len());
        // as the compiler wrote it
        assert_eq!(bytes, fs::read(env!("BOLTED_JOINT_LIBRARY")).unwrap());
    }

    #[test]
    fn libraries_from_a_folder_join_or_replace_the_embedded_one() {
        let folder = folder_with(&[
            ("x86_64-windows/bolted_joint.dll", b"MZ one"),
            ("aarch64-darwin/bolted_joint.dylib", b"\xcf\xfa\xed\xfe two"),
            ("README.md", b"left alone"),
            (".git/config", b"left alone"),
        ]);
        let found = binaries(Some(folder.path()), "bolted_joint", FmiVersion::V3).unwrap();
        let mut expected = vec![
            "binaries/aarch64-darwin/bolted_joint.dylib".to_owned(),
            "binaries/x86_64-windows/bolted_joint.dll".to_owned(),
        ];
        for binary in &found {
            if binary.library.source == LibrarySource::Embedded {
                expected.push(binary.path.clone());
            }
        }
        expected.sort();
        let paths: Vec<&str> = found.iter().map(|binary| binary.path.as_str()).collect();
        assert_eq!(paths, expected);

        let own = &binaries(None, "bolted_joint", FmiVersion::V3).unwrap()[0];
        let file = own.path.strip_prefix("binaries/").unwrap();
        let mut other = embedded_library().unwrap()[..4].to_vec();
        other.extend(b" another build");
        let folder = folder_with(&[(file, &other)]);
        let mut found = binaries(Some(folder.path()), "bolted_joint", FmiVersion::V3).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(found.remove(0).content.bytes().unwrap(), other);
    }

    #[test]
    fn a_folder_that_is_not_as_expected_is_refused() {
        for (files, fragment) in [
            (
                &[("win64/bolted_joint.dll", b"MZ".as_slice())],
                "win64: is not the name of a platform in FMI 3.0, expected one of aarch32,",
            ),
            (
                &[("x86_64-windows/joint.dll", b"MZ")],
                "bolted_joint.dll: not found, expected the FMU library of that platform",
            ),
            (
                &[("x86_64-windows/bolted_joint.dll", b"\x7fELF")],
                "bolted_joint.dll: is not a shared library of that platform, expected one in PE format",
            ),
            (
                &[("README.md", b"no platforms")],
                "found no platform's folder, expected at least one",
            ),
        ] {
            let message = refusal(files);
            assert!(message.contains(fragment), "{message}");
        }
        let message = match binaries(
            Some(Path::new("no such folder")),
            "bolted_joint",
            FmiVersion::V3,
        ) {
            Ok(_) => "accepted".to_owned(),
            Err(refused) => refused.to_string(),
        };
        assert!(
            message.contains("no such folder: cannot be read"),
            "{message}"
        );
    }
}
