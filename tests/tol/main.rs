//! The thesis's case studies: obtained against published values where they agree, against independent ones otherwise.

#![expect(
    clippy::unwrap_used,
    reason = "a test whose preparation fails has nothing better to do than panic"
)]

mod bolts;
mod chapter_5;
mod command;
mod document;
mod reproduced;
mod tables;
