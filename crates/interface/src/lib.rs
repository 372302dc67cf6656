//! Reads `modelDescription/*.xml`, checks it and turns it into the tables of the FMU library.
#![forbid(unsafe_code)]
