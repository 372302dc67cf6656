//! What a set of functions shows of its noise, kept: several steps of an identification ask for it.

use std::sync::{Arc, OnceLock};

use super::Roughness;

/// What a set of functions shows of its noise; found when it is first asked for.
#[derive(Clone, Debug, Default)]
pub struct ShownNoise {
    functions: OnceLock<Arc<[Roughness]>>,
    floors: OnceLock<Arc<[f64]>>,
}

impl ShownNoise {
    /// Of each function.
    pub(crate) fn functions(&self, find: impl FnOnce() -> Vec<Roughness>) -> &[Roughness] {
        self.functions.get_or_init(|| find().into())
    }

    /// Floor of the noise of each function, in its unit.
    pub(crate) fn floors(&self, find: impl FnOnce() -> Vec<Roughness>) -> &[f64] {
        self.floors.get_or_init(|| {
            let functions = self.functions(find);
            functions.iter().map(|own| own.floor).collect()
        })
    }

    /// Of the same functions at fewer lines: the floors stay those that all lines show.
    pub(crate) fn of_fewer_lines(&self, find: impl FnOnce() -> Vec<Roughness>) -> Self {
        self.floors(find);
        Self {
            functions: OnceLock::new(),
            floors: self.floors.clone(),
        }
    }
}
