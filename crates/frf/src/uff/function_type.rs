//! Function types: the standard's codes of what a data set 58 holds.

/// Function type of a frequency response function.
pub(super) const FREQUENCY_RESPONSE: i64 = 4;

/// Function type of an ordinary coherence.
pub(super) const COHERENCE: i64 = 6;

/// The standard's names of the function types, by their code.
const FUNCTION_TYPES: [&str; 28] = [
    "general function",
    "time response",
    "auto spectrum",
    "cross spectrum",
    "frequency response function",
    "transmissibility",
    "coherence",
    "auto correlation",
    "cross correlation",
    "power spectral density",
    "energy spectral density",
    "probability density function",
    "spectrum",
    "cumulative frequency distribution",
    "peaks valley",
    "stress/cycles",
    "strain/cycles",
    "orbit",
    "mode indicator function",
    "force pattern",
    "partial power",
    "partial coherence",
    "eigenvalue",
    "eigenvector",
    "shock response spectrum",
    "finite impulse response filter",
    "multiple coherence",
    "order function",
];

/// The standard's name of a function type, or that it is unknown.
pub(super) fn function_type_name(code: i64) -> &'static str {
    usize::try_from(code)
        .ok()
        .and_then(|code| FUNCTION_TYPES.get(code))
        .copied()
        .unwrap_or("function of unknown type")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn function_types_have_the_names_of_the_standard() {
        assert_eq!(function_type_name(4), "frequency response function");
        assert_eq!(function_type_name(6), "coherence");
        assert_eq!(function_type_name(27), "order function");
        assert_eq!(function_type_name(-1), "function of unknown type");
    }
}
