//! Converts a file of functions to a universal file of receptances in SI: `frf_to_uff IN OUT [little|big]`.
//!
//! IN is a universal file, a table (CSV), a NumPy archive or a MATLAB file. With a byte order OUT is binary (58b), without one it is ASCII.
#![forbid(unsafe_code)]

use std::error::Error;

use bolted_joint::frf::{ByteOrder, ReadOptions, read_frfs, write_uff58, write_uff58b};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let order = match arguments.get(2).map(String::as_str) {
        None => None,
        Some("little") => Some(ByteOrder::Little),
        Some("big") => Some(ByteOrder::Big),
        Some(other) => return Err(format!("found \"{other}\", expected little or big").into()),
    };
    let [input, output, ..] = arguments.as_slice() else {
        return Err("expected frf_to_uff IN OUT [little|big]".into());
    };
    let set = read_frfs(input, &ReadOptions::default())?.into_set()?;
    let description = format!("converted from {input}");
    match order {
        None => write_uff58(&set, output, &description)?,
        Some(order) => write_uff58b(&set, output, &description, order)?,
    }
    Ok(())
}
