//! Output files are written whole or not at all: a reader never finds half of one, and an error leaves the old one alone.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::inputs;

/// Symbolic links that are followed one after another, as many as operating systems do.
const MOST_LINKS: usize = 40;

/// Writes `contents` to `path` through a temporary file in the same folder that is renamed at the end.
///
/// A symbolic link keeps pointing where it did, also one to a file that does not exist yet. What is no regular file (a pipe,
/// `/dev/stdout`) is written to directly.
///
/// # Errors
///
/// What the operating system says where the folder does not exist or cannot be written to, or where `path` is a folder.
pub fn write(path: &Path, contents: &[u8]) -> io::Result<()> {
    match Prepared::new(path, contents)? {
        Some(prepared) => prepared.persist(),
        None => File::options().write(true).open(path)?.write_all(contents),
    }
}

/// Writes several files, all or none: each is complete beside its target before the first target is replaced, and if one
/// cannot be replaced those before it become again what they were.
///
/// # Errors
///
/// As [`write()`], with the path.
pub fn write_all(files: &[(&Path, &[u8])]) -> Result<(), (PathBuf, io::Error)> {
    let at = |path: &Path| {
        let path = path.to_path_buf();
        |source| (path, source)
    };
    if let [(path, contents)] = files {
        return write(path, contents).map_err(at(path));
    }
    let mut prepared = Vec::with_capacity(files.len());
    for (path, contents) in files {
        let one = Prepared::new(path, contents).and_then(|one| {
            one.ok_or_else(|| {
                io::Error::other("it is no regular file, as one of several has to be")
            })
        });
        let one = one.map_err(at(path))?;
        let before = match fs::read(&one.target) {
            Ok(before) => Some(before),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err((path.to_path_buf(), error)),
        };
        prepared.push((*path, one, before));
    }
    replace(prepared)
}

/// Replaces every target by its new file; `None` in place of the old contents is a target that did not exist.
fn replace(prepared: Vec<(&Path, Prepared, Option<Vec<u8>>)>) -> Result<(), (PathBuf, io::Error)> {
    let mut replaced: Vec<(PathBuf, Option<Vec<u8>>)> = Vec::new();
    for (path, one, before) in prepared {
        let target = one.target.clone();
        if let Err(error) = one.persist() {
            for (target, before) in replaced {
                // As well as it can be done: the error that is reported is the first one.
                let _ = match before {
                    Some(before) => write(&target, &before),
                    None => fs::remove_file(&target),
                };
            }
            return Err((path.to_path_buf(), error));
        }
        replaced.push((target, before));
    }
    Ok(())
}

/// Where a path leads: what it names itself, or the end of the symbolic links that it begins, whether or not that exists.
///
/// # Errors
///
/// Where links lead to each other in a circle.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&target) else {
            return Ok(target);
        };
        target = folder_of(&target).join(next);
    }
    let why = "its symbolic links do not come to an end";
    Err(io::Error::new(io::ErrorKind::InvalidInput, why))
}

/// What to do where a file cannot be written, by what the operating system or [`inputs::check`] says.
#[must_use]
pub fn advice(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::AlreadyExists => "give the output a name of its own",
        _ => "give a path in a folder that exists and may be written to",
    }
}

/// A complete file beside the one that it is to become.
struct Prepared {
    temporary: tempfile::NamedTempFile,
    target: PathBuf,
}

impl Prepared {
    /// `None` where the target is no regular file, which cannot be renamed to.
    fn new(path: &Path, contents: &[u8]) -> io::Result<Option<Self>> {
        let target = match fs::metadata(path) {
            Ok(found) if found.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(found) if !found.is_file() => return Ok(None),
            Ok(_) => fs::canonicalize(path)?,
            // a link to what does not exist yet is followed as well
            Err(_) => followed(path)?,
        };
        inputs::check(&target)?;
        let mut temporary = new_temporary(&folder_of(&target))?;
        temporary.write_all(contents)?;
        temporary.as_file().sync_all()?;
        Ok(Some(Self { temporary, target }))
    }

    fn persist(self) -> io::Result<()> {
        let refused = self.temporary.persist(&self.target);
        refused.map(|_| ()).map_err(|refused| refused.error)
    }
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bolted-joint-").suffix(".part");
    #[cfg(unix)]
    let permissions = {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new file; the process's umask takes its bits away.
        fs::Permissions::from_mode(0o666)
    };
    #[cfg(unix)]
    builder.permissions(permissions);
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m10.joint.json");
        write(&path, b"first, and longer").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(entries(folder.path()), ["m10.joint.json"]);
    }

    #[test]
    fn a_folder_in_the_way_is_an_error_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::create_dir(&path).unwrap();
        assert_eq!(
            write(&path, b"x").unwrap_err().kind(),
            io::ErrorKind::IsADirectory
        );
        assert_eq!(entries(folder.path()), ["taken"]);
    }

    #[test]
    fn of_several_files_all_are_written_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let (old, new, taken) = (path("old"), path("new"), path("taken"));
        write(&old, b"before").unwrap();
        fs::create_dir(&taken).unwrap();
        let files = |third| -> [(&Path, &[u8]); 3] { [(&old, b"1"), (&new, b"2"), (third, b"3")] };
        let (refused, error) = write_all(&files(&taken)).unwrap_err();
        assert_eq!(
            (refused, error.kind()),
            (taken.clone(), io::ErrorKind::IsADirectory)
        );
        assert_eq!(fs::read(&old).unwrap(), b"before");
        assert_eq!(entries(folder.path()), ["old", "taken"]);
        write_all(&files(&path("third"))).unwrap();
        assert_eq!(fs::read(&old).unwrap(), b"1");
        assert_eq!(entries(folder.path()), ["new", "old", "taken", "third"]);
    }

    #[test]
    fn what_was_replaced_before_a_refusal_is_put_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let (old, new, last) = (path("old"), path("new"), path("last"));
        write(&old, b"before").unwrap();
        let prepared = |path: &Path| Prepared::new(path, b"after").unwrap().unwrap();
        let lost = prepared(&last);
        fs::remove_file(lost.temporary.path()).unwrap();
        let before = Some(b"before".to_vec());
        let all = vec![
            (old.as_path(), prepared(&old), before),
            (new.as_path(), prepared(&new), None),
            (last.as_path(), lost, None),
        ];
        assert_eq!(replace(all).unwrap_err().0, last);
        assert_eq!(fs::read(&old).unwrap(), b"before");
        assert_eq!(entries(folder.path()), ["old"]);
    }

    #[test]
    fn a_folder_that_does_not_exist_is_not_made() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing").join("m10.joint.json");
        assert_eq!(
            write(&path, b"x").unwrap_err().kind(),
            io::ErrorKind::NotFound
        );
        assert!(entries(folder.path()).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_and_what_it_points_to_stay_together() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_what_does_not_exist_yet_stays_and_makes_it() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("far")).unwrap();
        symlink("far/target", path("link")).unwrap();
        symlink("link", path("first")).unwrap();
        assert_eq!(followed(&path("first")).unwrap(), path("far/target"));
        write(&path("first"), b"new").unwrap();
        assert_eq!(fs::read(path("far/target")).unwrap(), b"new");
        assert!(fs::symlink_metadata(path("link")).unwrap().is_symlink());
        assert_eq!(entries(folder.path()), ["far", "first", "link"]);

        symlink("missing/target", path("nowhere")).unwrap();
        let refused = write(&path("nowhere"), b"new").unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::NotFound);
        symlink("circle", path("circle")).unwrap();
        assert!(write(&path("circle"), b"new").is_err());
        assert!(fs::symlink_metadata(path("circle")).unwrap().is_symlink());
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_it_as_far_as_the_umask_allows() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write(&ours, b"x").unwrap();
        fs::write(&plain, b"x").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
