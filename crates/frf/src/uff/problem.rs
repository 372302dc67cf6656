//! What can be wrong in a universal file, each with what was found, what was expected and what to do.

use thiserror::Error;

use crate::{DofError, FrfError, Quantity};

/// What is wrong at one line of a universal file.
#[derive(Debug, Error)]
pub enum UffProblem {
    /// Nothing in the file.
    #[error(
        "found an empty file, expected a universal file with data sets 58; export the measurement again"
    )]
    Empty,
    /// The first line does not begin a data set.
    #[error(
        "found \"{found}\", expected the line \"    -1\" that begins a universal file; \
         this file has another format, export the measurement as UFF 58 (ASCII)"
    )]
    NotUniversalFile {
        /// The beginning of the line.
        found: String,
    },
    /// A line too long for text.
    #[error(
        "found a line of more than {limit} bytes, expected text; export the measurement as UFF 58 (ASCII)"
    )]
    LineTooLong {
        /// The longest line that is read, bytes.
        limit: usize,
    },
    /// Text after the end of a data set and before the next.
    #[error(
        "found \"{found}\" between data sets, expected the line \"    -1\" that begins the next one; \
         remove the text, or restore the \"    -1\" that is missing before it"
    )]
    BetweenDatasets {
        /// The beginning of the line.
        found: String,
    },
    /// The line after the opening `-1` holds no number.
    #[error("found \"{found}\" as the number of a data set, expected a number such as 58")]
    DatasetNumber {
        /// The beginning of the line.
        found: String,
    },
    /// A mode shape that cannot be used.
    #[error("found {found}, expected {expected}")]
    Shape {
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// The file ends before the data set does.
    #[error(
        "the file ends inside data set {dataset} that begins at line {begun_at}, expected \"    -1\" at its end; \
         the file is cut short, copy or export it again"
    )]
    EndsInside {
        /// The data set's number.
        dataset: String,
        /// The line of its opening `-1`.
        begun_at: usize,
    },
    /// A binary data set that does not end where its header says.
    #[error(
        "binary data set 58b: found no \"    -1\" after {} bytes of values, expected it there by the {lines} lines of its \
         record 7{}; the file is cut short, or was changed by a transfer in text mode, or the count in record 7 is wrong: \
         copy it again in binary mode, or export as ASCII",
        either(expected),
        stated.map_or_else(String::new, |bytes| format!(" (its first line says {bytes} bytes)"))
    )]
    BinaryLength {
        /// Lines by record 7.
        lines: usize,
        /// Bytes that so many lines take, for every way to store them.
        expected: Vec<u64>,
        /// Bytes by the first line.
        stated: Option<u64>,
    },
    /// The data set ends within its header.
    #[error(
        "data set {dataset} that begins at line {begun_at} ends after {found} records, expected {expected} before its values; \
         export the measurement again"
    )]
    HeaderEnds {
        /// The data set's number.
        dataset: u32,
        /// The line of its opening `-1`.
        begun_at: usize,
        /// Records found.
        found: usize,
        /// Records expected.
        expected: usize,
    },
    /// A field of the header that cannot be read.
    #[error("{}found \"{found}\" as {field}, expected {expected}", in_record(*record))]
    Field {
        /// The record's number in the standard; 0 for the line of the data set's number.
        record: usize,
        /// What the field is.
        field: &'static str,
        /// Its text.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
    /// A degree of freedom that the format does not know.
    #[error("record 6, {role}: {source}")]
    Dof {
        /// Response or reference.
        role: &'static str,
        /// What is wrong with it.
        source: DofError,
    },
    /// The function is not over frequency in Hz.
    #[error(
        "record 8: found an abscissa of {found}, expected frequency in Hz; export the function over frequency"
    )]
    AbscissaNotFrequency {
        /// Data type or unit.
        found: String,
    },
    /// A value that is no number.
    #[error("column {column}: found \"{found}\", expected a number such as 1.23456E-03")]
    NotANumber {
        /// Column, from 1.
        column: usize,
        /// The text.
        found: String,
    },
    /// A value that is infinite or not a number.
    #[error(
        "found {found} among the values, expected finite numbers; remove the line from the measurement"
    )]
    NotFinite {
        /// The value.
        found: f64,
    },
    /// The data set ends before its values are complete.
    #[error(
        "data set 58 that begins at line {begun_at} ends after {found} numbers, expected {expected} by its record 7; \
         export the measurement again, or correct the count if the file was edited"
    )]
    TooFewNumbers {
        /// Numbers found.
        found: usize,
        /// Numbers expected: abscissae and real and imaginary parts each count.
        expected: usize,
        /// The line of its opening `-1`.
        begun_at: usize,
    },
    /// The data set goes on when its values are complete.
    #[error(
        "data set 58 that begins at line {begun_at} has more numbers than the {expected} of its record 7, \
         expected \"    -1\"; correct the count or the ordinate type in record 7"
    )]
    TooManyNumbers {
        /// Numbers expected: abscissae and real and imaginary parts each count.
        expected: usize,
        /// The line of its opening `-1`.
        begun_at: usize,
    },
    /// A load per motion, such as dynamic stiffness.
    #[error(
        "found {found} ({stated_by}), a load per motion; expected receptance, mobility or accelerance. \
         Its entries cannot be inverted one by one: export the motion per load"
    )]
    Inverse {
        /// Dynamic stiffness, impedance or apparent mass.
        found: &'static str,
        /// The statement in the file.
        stated_by: String,
    },
    /// A ratio of anything else.
    #[error(
        "found a function of {numerator} per {denominator}, expected displacement, velocity or acceleration per force or moment; \
         export a frequency response function of motion per load"
    )]
    NotMotionPerLoad {
        /// The ordinate's numerator.
        numerator: String,
        /// The ordinate's denominator.
        denominator: String,
    },
    /// Nothing says what was measured.
    #[error(
        "found neither a data type nor a label in records 9 and 10 that says whether this is receptance, mobility or accelerance; \
         state it in the study, such as quantity = \"accelerance\" beside frf"
    )]
    UnknownQuantity,
    /// The ordinate has a label, which does not say what was measured.
    #[error(
        "found no data type, and the label {found} of the ordinate, which cannot be read as receptance, mobility or accelerance; \
         state in the study what it is, such as quantity = \"accelerance\" and units = {{ length = \"m\", force = \"N\" }} \
         beside frf"
    )]
    UnreadQuantity {
        /// The label.
        found: String,
    },
    /// Two statements about what was measured.
    #[error(
        "found {first_statement}, which means {first}, and {second_statement}, which means {second}; expected one quantity. \
         Find out which is right and state the quantity in the study, such as quantity = \"{first}\" beside frf"
    )]
    ContradictingQuantities {
        /// Where the first statement stands and how it reads.
        first_statement: String,
        /// What it means.
        first: Quantity,
        /// Where the second statement stands and how it reads.
        second_statement: String,
        /// What it means.
        second: Quantity,
    },
    /// Two statements about units.
    #[error(
        "found {first_statement}, by which one unit of the file is {first_factor} SI units, and {second_statement}, \
         by which it is {second_factor}; expected one unit. Find out which is right and state the units in the study, \
         such as units = {{ length = \"mm\", force = \"N\" }} beside frf"
    )]
    ContradictingUnits {
        /// Where the first statement stands and how it reads.
        first_statement: String,
        /// Its factor to SI.
        first_factor: f64,
        /// Where the second statement stands and how it reads.
        second_statement: String,
        /// Its factor to SI.
        second_factor: f64,
    },
    /// A unit that is none of those that are read, where nothing else tells the units.
    #[error(
        "found the unit \"{found}\", expected one such as m/N, (m/s^2)/N, 1/kg or g, or none at all; correct the file, or state \
         the units in the study, such as units = {{ length = \"mm\", force = \"N\" }} beside frf"
    )]
    UnreadUnit {
        /// The label.
        found: String,
    },
    /// A unit that does not fit the degrees of freedom.
    #[error(
        "found {statement}, which does not fit a response along {response} and a reference along {reference}; \
         expected the unit of that ratio. Correct the directions or the unit in the file, or state the units in the study, \
         such as units = {{ length = \"mm\", force = \"N\" }} beside frf"
    )]
    UnitNotOfDirections {
        /// Where the unit stands and how it reads.
        statement: String,
        /// The response.
        response: crate::Dof,
        /// The reference.
        reference: crate::Dof,
    },
    /// Data set 164 says one thing by its code and another by its factors.
    #[error(
        "data set 164: found units code {code} ({name}) with the factors {length} (length) and {force} (force), \
         expected {expected_length} and {expected_force}; correct the code or the factors in the file"
    )]
    UnitsCode {
        /// The code.
        code: i64,
        /// What the code stands for.
        name: &'static str,
        /// The length factor found.
        length: f64,
        /// The force factor found.
        force: f64,
        /// The code's length factor.
        expected_length: f64,
        /// The code's force factor.
        expected_force: f64,
    },
    /// Two data sets 164 that differ.
    #[error(
        "found a second data set 164 with other units than that of line {first_line}, expected one system of units in a file; \
         split the file"
    )]
    SecondUnits {
        /// The line of the first.
        first_line: usize,
    },
    /// The function is not usable as it is.
    #[error("{0}")]
    Function(#[source] Box<FrfError>),
}

/// Where a field stands.
fn in_record(record: usize) -> String {
    match record {
        0 => String::new(),
        _ => format!("record {record}: "),
    }
}

/// Numbers, with "or" between them.
fn either(numbers: &[u64]) -> String {
    let shown: Vec<String> = numbers.iter().map(u64::to_string).collect();
    shown.join(" or ")
}
