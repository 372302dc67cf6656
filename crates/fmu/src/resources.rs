//! Finds and reads the FMU's start-value file, in whatever form the importer tells the way to it.

use std::{
    fmt, fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use crate::{library, refusal::Refusal, start_file::StartFile};

/// Name of the start-value file in the FMU's `resources` folder.
const START_FILE: &str = "start.txt";

/// No start-value file is that large, in bytes.
const LARGEST_FILE: u64 = 1 << 20;

/// Why the resources cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ResourceError {
    /// No path was given, and the library does not know where it was loaded from.
    NoPath,
    /// A URI that does not lead to a local folder.
    Uri { found: String },
    /// The file cannot be read.
    Unreadable { path: String, reason: String },
}

impl fmt::Display for ResourceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPath => f.write_str(
                "resourcePath is not given, and the library was not loaded from an FMU's binaries folder; give the \
                 path of the FMU's resources folder",
            ),
            Self::Uri { found } => write!(
                f,
                "resourcePath \"{found}\" is no local file URI; give the path of the FMU's resources folder"
            ),
            Self::Unreadable { path, reason } => write!(
                f,
                "{path} cannot be read: {reason}; give the path of the FMU's resources folder"
            ),
        }
    }
}

/// Reads the start-value file of the FMU whose resources are at `resource_path`, or, without one, of the FMU that
/// this library was loaded from.
pub(crate) fn read_start_file(resource_path: Option<&str>) -> Result<StartFile, Refusal> {
    let folder = match resource_path {
        Some(path) if !path.is_empty() => folder_of(path)?,
        _ => own_folder().ok_or(ResourceError::NoPath)?,
    };
    let path = folder.join(START_FILE);
    let text = read(&path).map_err(|error| ResourceError::Unreadable {
        path: path.display().to_string(),
        reason: error.to_string(),
    })?;
    Ok(StartFile::parse(&path.display().to_string(), &text)?)
}

fn read(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    fs::File::open(path)?
        .take(LARGEST_FILE)
        .read_to_string(&mut text)?;
    Ok(text)
}

/// `<FMU>/binaries/<platform>/<library>` lies beside `<FMU>/resources`.
fn own_folder() -> Option<PathBuf> {
    let library = library::path()?;
    let root = library.parent()?.parent()?.parent()?;
    Some(root.join("resources"))
}

/// Folder that a path or a `file:` URI leads to.
fn folder_of(path: &str) -> Result<PathBuf, ResourceError> {
    let rest = match path.split_at_checked(5) {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("file:") => rest,
        _ => return Ok(PathBuf::from(path)),
    };
    let refuse = || ResourceError::Uri {
        found: path.to_owned(),
    };
    // file:/path, file:///path and file://localhost/path lead to this machine
    let local = match rest.strip_prefix("//") {
        None => rest,
        Some(authority) => authority.strip_prefix("localhost").unwrap_or(authority),
    };
    if !local.starts_with('/') {
        return Err(refuse());
    }
    let decoded = percent_decoded(local).ok_or_else(refuse)?;
    Ok(PathBuf::from(without_slash_before_drive(&decoded)))
}

/// On Windows `/C:/path` of a URI is `C:/path`.
fn without_slash_before_drive(path: &str) -> &str {
    let Some(rest) = path.strip_prefix('/').filter(|_| cfg!(windows)) else {
        return path;
    };
    let mut start = rest.chars();
    let has_drive =
        start.next().is_some_and(|c| c.is_ascii_alphabetic()) && start.next() == Some(':');
    if has_drive { rest } else { path }
}

/// Text with `%XX` replaced by bytes; `None` if that is not UTF-8 or an escape is broken.
fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let mut digit = || char::from(rest.next()?).to_digit(16);
            let (high, low) = (digit()?, digit()?);
            bytes.push(u8::try_from(16 * high + low).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris_lead_to_the_same_folder() {
        let folder = Ok(PathBuf::from("/tmp/Übung 1/resources/"));
        for path in [
            "/tmp/Übung 1/resources/",
            "file:///tmp/Übung 1/resources/",
            "file:///tmp/%C3%9Cbung%201/resources/",
            "file:/tmp/%c3%9cbung%201/resources/",
            "file://localhost/tmp/%C3%9Cbung%201/resources/",
            "FILE:///tmp/%C3%9Cbung%201/resources/",
        ] {
            assert_eq!(folder_of(path), folder, "{path}");
        }
        // a plain path is not decoded
        assert_eq!(folder_of("/tmp/100%25"), Ok(PathBuf::from("/tmp/100%25")));
        assert_eq!(folder_of("file"), Ok(PathBuf::from("file")));
        assert_eq!(folder_of("Übung"), Ok(PathBuf::from("Übung")));
    }

    #[test]
    fn uris_of_other_machines_and_broken_escapes_are_refused() {
        for path in [
            "file://server/share",
            "file:relative",
            "file:///a%2",
            "file:///a%zz",
            "file:///%ff",
        ] {
            assert_eq!(
                folder_of(path),
                Err(ResourceError::Uri {
                    found: path.to_owned()
                })
            );
        }
    }
}
