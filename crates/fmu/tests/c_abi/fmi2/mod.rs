//! The functions of FMI 2.0, and how they agree with those of FMI 3.0.

mod arguments;
pub(crate) mod c;
mod calling_order;
mod derivatives;
pub(crate) mod importer;
mod instantiation;
mod logging;
mod saved_states;
mod stepping;
mod versions;
