//! Finds and reads the FMU's start-value file, in whatever form the importer tells the way to it.

use std::{
    fmt, fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use crate::{
    library,
    start_file::{StartFile, StartFileError},
};

/// Name of the start-value file in the FMU's `resources` folder.
const START_FILE: &str = "start.txt";

/// No start-value file is that large, in bytes.
const LARGEST_FILE: u64 = 1 << 26;

/// Why the resources cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ResourceError {
    /// No path was given, and the library does not know where it was loaded from.
    NoPath { argument: &'static str },
    /// A URI that does not lead to a local folder.
    Uri {
        argument: &'static str,
        found: String,
    },
    /// The file cannot be read.
    Unreadable { path: String, reason: String },
    /// The start-value file cannot be used.
    StartFile(StartFileError),
}

impl From<StartFileError> for ResourceError {
    fn from(error: StartFileError) -> Self {
        Self::StartFile(error)
    }
}

impl fmt::Display for ResourceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPath { argument } => write!(
                f,
                "{argument} is not given, and the library was not loaded from an FMU's binaries folder; give the \
                 path of the FMU's resources folder"
            ),
            Self::Uri { argument, found } => write!(
                f,
                "{argument} \"{found}\" is no local file URI; give the path of the FMU's resources folder"
            ),
            Self::Unreadable { path, reason } => write!(
                f,
                "{path} cannot be read: {reason}; give the path of the FMU's resources folder"
            ),
            Self::StartFile(error) => error.fmt(f),
        }
    }
}

/// Reads the start-value file of the FMU whose resources are at `resource_path`, or, without one, of the FMU that
/// this library was loaded from. `argument` is the importer's name for the path.
pub(crate) fn read_start_file(
    resource_path: Option<&str>,
    argument: &'static str,
) -> Result<StartFile, ResourceError> {
    let folders = match resource_path {
        Some(path) if !path.is_empty() => {
            let readings = readings(path, cfg!(windows)).ok_or_else(|| ResourceError::Uri {
                argument,
                found: path.to_owned(),
            })?;
            readings.map(PathBuf::from)
        }
        _ => {
            let folder = own_folder().ok_or(ResourceError::NoPath { argument })?;
            [folder.clone(), folder]
        }
    };
    let [standard, lenient] = folders.map(|folder| folder.join(START_FILE));
    let path = if !standard.exists() && lenient.exists() {
        lenient
    } else {
        standard
    };
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

/// The folder that a path or a `file:` URI leads to, read as the standards say; and, for importers that encode where
/// they must not or do not where they must, read the other way. `None` for what is not on this machine.
fn readings(location: &str, windows: bool) -> Option<[String; 2]> {
    let Some(rest) = after_file_scheme(location) else {
        if location.contains("://") {
            return None;
        }
        let decoded = percent_decoded(location).unwrap_or_else(|| location.to_owned());
        return Some([location.to_owned(), decoded]);
    };
    // a URI has no backslashes, but some importers for Windows write them
    let rest = if windows {
        rest.replace('\\', "/")
    } else {
        rest.to_owned()
    };
    let path = path_of_uri(&rest, windows)?;
    let decoded = percent_decoded(&path).unwrap_or_else(|| path.clone());
    Some([decoded, path].map(|path| {
        if windows {
            without_slash_before_drive(&path).to_owned()
        } else {
            path
        }
    }))
}

/// What follows `file:`, in upper or lower case.
fn after_file_scheme(location: &str) -> Option<&str> {
    let (scheme, rest) = location.split_at_checked(5)?;
    scheme.eq_ignore_ascii_case("file:").then_some(rest)
}

/// Absolute path in what follows `file:`, still percent-encoded (RFC 8089).
fn path_of_uri(rest: &str, windows: bool) -> Option<String> {
    let Some(after) = rest.strip_prefix("//") else {
        return match rest {
            // file:/path
            path if path.starts_with('/') => Some(path.to_owned()),
            // file:C:/path
            path if windows && starts_with_drive(path) => Some(format!("/{path}")),
            _ => None,
        };
    };
    let host_length = after.find('/').unwrap_or(after.len());
    let (host, path) = after.split_at_checked(host_length)?;
    if host.is_empty() || host.eq_ignore_ascii_case("localhost") {
        // file:///path and file://localhost/path
        (!path.is_empty()).then(|| path.to_owned())
    } else if windows && starts_with_drive(host) {
        // file://C:/path, with a slash too few
        Some(format!("/{after}"))
    } else {
        // file://server/share/path: on Windows //server/share/path leads there
        windows.then(|| rest.to_owned())
    }
}

/// On Windows `/C:/path` of a URI is `C:/path`.
fn without_slash_before_drive(path: &str) -> &str {
    path.strip_prefix('/')
        .filter(|rest| starts_with_drive(rest))
        .unwrap_or(path)
}

fn starts_with_drive(path: &str) -> bool {
    let mut start = path.chars();
    start.next().is_some_and(|c| c.is_ascii_alphabetic())
        && start.next() == Some(':')
        && matches!(start.next(), None | Some('/' | '\\'))
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
    use super::readings;

    fn standard(location: &str, windows: bool) -> Option<String> {
        readings(location, windows).map(|[standard, _]| standard)
    }

    #[test]
    fn paths_and_uris_lead_to_the_same_folder() {
        for location in [
            "/tmp/Übung 1/resources/",
            "file:///tmp/Übung 1/resources/",
            "file:///tmp/%C3%9Cbung%201/resources/",
            "file:/tmp/%c3%9cbung%201/resources/",
            "file://localhost/tmp/%C3%9Cbung%201/resources/",
            "FILE://LocalHost/tmp/%C3%9Cbung%201/resources/",
        ] {
            assert_eq!(
                standard(location, false).as_deref(),
                Some("/tmp/Übung 1/resources/"),
                "{location}"
            );
        }
        for path in ["/tmp/resources", "file", "Übung", "a/b", "C:/x"] {
            assert_eq!(standard(path, false).as_deref(), Some(path));
        }
    }

    #[test]
    fn drive_letters_and_servers_are_those_of_windows() {
        for location in [
            "C:/Users/M%C3%BCller",
            "file:///C:/Users/M%C3%BCller",
            "file:/C:/Users/M%C3%BCller",
            "file:C:/Users/M%C3%BCller",
            "file://C:/Users/M%C3%BCller",
            "file://localhost/C:/Users/M%C3%BCller",
            "file:///C%3A/Users/M%C3%BCller",
            "file:///C:\\Users\\M%C3%BCller",
        ] {
            let [standard, lenient] = readings(location, true).unwrap_or_default();
            let expected = "C:/Users/Müller";
            assert!(standard == expected || lenient == expected, "{location}");
        }
        for (location, windows, expected) in [
            ("file://server/share/a%20b", true, "//server/share/a b"),
            ("C:\\Users\\a", true, "C:\\Users\\a"),
            // elsewhere a colon is a character like any other
            ("file:///C:/resources", false, "/C:/resources"),
        ] {
            assert_eq!(standard(location, windows).as_deref(), Some(expected));
        }
    }

    #[test]
    fn the_second_reading_takes_the_escapes_the_other_way() {
        let both = |first: &str, second: &str| Some([first.to_owned(), second.to_owned()]);
        assert_eq!(
            readings("/tmp/my%20model", false),
            both("/tmp/my%20model", "/tmp/my model")
        );
        assert_eq!(
            readings("file:///tmp/100%25", false),
            both("/tmp/100%", "/tmp/100%25")
        );
        // what is no escape, or no text, can only be meant as it is
        for path in ["/a%2", "/100% sure", "/a%zz", "/%ff"] {
            assert_eq!(readings(&format!("file://{path}"), false), both(path, path));
            assert_eq!(readings(path, false), both(path, path));
        }
    }

    #[test]
    fn other_machines_and_relative_uris_are_refused() {
        for location in [
            "file://server/share",
            "file:relative",
            "file:",
            "file://",
            "file:C:/path",
            "file://C:/path",
            "http://server/resources",
        ] {
            assert_eq!(readings(location, false), None, "{location}");
        }
        assert_eq!(readings("file:relative", true), None);
    }
}
