//! The functions of FMI 2.0, and how they agree with those of FMI 3.0.

mod arguments;
mod c;
mod calling_order;
mod derivatives;
mod importer;
mod instantiation;
mod logging;
mod saved_states;
mod stepping;
mod versions;
