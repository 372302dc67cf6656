//! One structure from a file of its own, for those who have no assembly file.

use std::path::{Path, PathBuf};

use bolted_joint_study::StudyText;

use crate::error::AssemblyError;
use crate::modal_form::ModalForm;
use crate::structure::structure;
use crate::tables::StructureTable;

/// All modes that a file has.
const ALL_MODES: usize = 10_000;

impl ModalForm {
    /// The structure in a file of modes (`.toml`) or of matrices (any other), with all of its modes, and what should be known of
    /// how it was read.
    ///
    /// # Errors
    /// [`AssemblyError`] that names the file and what is wrong in it.
    pub fn read(path: &Path) -> Result<(Self, Vec<String>), AssemblyError> {
        let own = path.file_name().map(PathBuf::from);
        let is_modal = path
            .extension()
            .is_some_and(|own| own.eq_ignore_ascii_case("toml"));
        let (modal, matrices) = if is_modal { (own, None) } else { (None, own) };
        let table = StructureTable {
            matrices,
            modal,
            beam: None,
            points: Default::default(),
            modes: Some(ALL_MODES),
        };
        let (form, told) = structure(&StudyText::new("", path), "neighbour", table)?;
        Ok((form, told.warnings))
    }
}
