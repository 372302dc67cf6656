//! The folder of an FMU's resources, with a start-value file in it.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use super::TOKEN;

/// Which FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Element,
    Lap,
}

/// Text of `start.txt` with some parameters replaced.
pub(crate) fn start_text(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> String {
    crate::raw::start_text(kind == Kind::Lap, dofs, TOKEN, changes)
}

/// A folder that is removed when the test ends.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!(
            "bolted joint {} {number} {name}",
            std::process::id()
        ));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Folder with a start-value file.
    pub(crate) fn with_start(text: &str) -> Self {
        let folder = Self::new("Prüfung 100% #1");
        fs::write(folder.0.join("start.txt"), text).unwrap();
        folder
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The path as text.
pub(crate) fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}
