//! Reading and writing of files as every part of the program does it: small texts with one set of messages, words that
//! are misspelt, outputs that are written whole or not at all, and who wrote them and when.
#![forbid(unsafe_code)]

mod decimal;
mod encoding;
pub mod inputs;
pub mod misspelt;
mod number;
mod table_header;
pub mod text_file;
pub mod text_table;
mod timestamp;
pub mod whole_file;

pub use decimal::Decimal;
pub use encoding::Encoding;
pub use misspelt::nearest;
pub use number::number;
pub use table_header::table_header;
pub use text_file::TextFileError;
pub use timestamp::{Civil, DateError, Timestamp};

/// The program's name, as it stands in the files that it writes.
pub const TOOL: &str = "bolted-joint";

/// The program's version, which all its crates share.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
