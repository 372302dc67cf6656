//! The thesis's case studies: obtained against published values where they agree, against independent ones otherwise.

#![expect(
    clippy::unwrap_used,
    reason = "a test whose preparation fails has nothing better to do than panic"
)]

mod chapter_5;
mod document;
mod reproduced;
mod tables;
