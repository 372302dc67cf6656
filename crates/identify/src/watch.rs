//! What an identification tells while it works.

use std::path::Path;

/// Is told how far the work has come; from any thread.
pub trait Watch: Sync {
    /// So many bytes of a file have been read, `of` at most.
    fn read(&self, path: &Path, bytes: u64, of: u64) {
        let _ = (path, bytes, of);
    }

    /// One more draw of the bootstrap is done.
    fn drawn(&self) {}
}

/// A function watches the draws of the bootstrap.
impl<F: Fn() + Sync> Watch for F {
    fn drawn(&self) {
        self();
    }
}
