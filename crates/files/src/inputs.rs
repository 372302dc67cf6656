//! Which files a command has read, so that none of its outputs takes the place of one: a measurement that is replaced by what
//! was made of it is lost.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

thread_local! {
    /// Files that this thread has opened since it began to watch; `None` where it does not.
    static READ: RefCell<Option<BTreeSet<PathBuf>>> = const { RefCell::new(None) };
}

/// From now on files that this thread opens are not written by it; those before are forgotten.
pub fn watch() {
    READ.set(Some(BTreeSet::new()));
}

/// Opens a file to read it.
///
/// # Errors
///
/// What the operating system says.
pub fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    READ.with_borrow_mut(|read| {
        // a pipe or a device has nothing to lose
        if let Some(read) = read
            && file.metadata().is_ok_and(|own| own.is_file())
            && let Ok(whole) = fs::canonicalize(path)
        {
            read.insert(whole);
        }
    });
    Ok(file)
}

/// Refuses to write a file that was read.
///
/// # Errors
///
/// [`io::ErrorKind::AlreadyExists`], with the reason.
pub fn check(target: &Path) -> io::Result<()> {
    let whole = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
    let is_read = |read: &BTreeSet<PathBuf>| read.contains(&whole);
    match READ.with_borrow(|read| read.as_ref().is_some_and(is_read)) {
        true => Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            "it is one of the files that are read, and would be lost",
        )),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{text_file, whole_file};

    #[test]
    fn what_is_read_is_not_written_while_it_is_watched() {
        let folder = tempfile::tempdir().unwrap();
        let [data, other] = ["data.csv", "other.csv"].map(|name| folder.path().join(name));
        fs::write(&data, "measured").unwrap();
        // a library may change a file in its place
        text_file::read(&data, "a text").unwrap();
        whole_file::write(&data, b"changed").unwrap();

        watch();
        whole_file::write(&data, b"not read yet").unwrap();
        text_file::read(&data, "a text").unwrap();
        let beside = folder.path().join(".").join("data.csv");
        let refused = whole_file::write(&beside, b"lost").unwrap_err();
        assert!(refused.to_string().contains("would be lost"), "{refused}");
        let (path, _) = whole_file::write_all(&[(&other, b"1"), (&data, b"2")]).unwrap_err();
        assert_eq!(path, data);
        assert_eq!(fs::read(&data).unwrap(), b"not read yet");
        assert!(!other.exists());

        watch();
        whole_file::write(&data, b"forgotten").unwrap();
    }
}
