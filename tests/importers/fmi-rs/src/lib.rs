//! Nothing to use: `tests/` loads exported FMUs with the crate `fmi-rs`.
