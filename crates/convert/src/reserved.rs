//! Names that a tool does not take: words of the languages that functions and packages are written in, and what is too long.

use crate::{ConvertError, Target};

/// What `iskeyword` lists in MATLAB.
const OF_MATLAB: &str = "break case catch classdef continue else elseif end for function global if otherwise parfor persistent \
                         return spmd switch try while";

/// What the function calls its own, and what it calls: a function of one of these names would take its place.
const OF_FUNCTION: &str = "p relative rate memory load_b f varargout nargin isempty zeros sign abs";

/// Characters of a name that MATLAB (`namelengthmax`) keeps, and that leave Abaqus and CalculiX room for the ends of their sets' names
/// (80).
const LONGEST: usize = 63;

/// Modelica Language Specification 3.6, section 2.3.3, and the types that every model sees.
const OF_MODELICA: &str = "algorithm and annotation block break class connect connector constant constrainedby der discrete each \
                           else elseif elsewhen encapsulated end enumeration equation expandable extends external false final flow \
                           for function if import impure in initial inner input loop model not operator or outer output package \
                           parameter partial protected public pure record redeclare replaceable return stream then true type when \
                           while within Real Integer Boolean String time Modelica";

pub(crate) fn check(target: Target, name: &str) -> Result<(), ConvertError> {
    let has_names = matches!(target, Target::Matlab | Target::Abaqus | Target::Calculix);
    if has_names && name.len() > LONGEST {
        return Err(ConvertError::Long {
            found: name.to_owned(),
            tool: target.name(),
            most: LONGEST,
        });
    }
    let (language, words) = match target {
        Target::Matlab => (
            "MATLAB or of the function itself",
            [OF_MATLAB, OF_FUNCTION].as_slice(),
        ),
        Target::Modelica => ("Modelica", [OF_MODELICA].as_slice()),
        Target::Nastran | Target::Abaqus | Target::Calculix | Target::Ansys => return Ok(()),
    };
    let mut words = words.iter().flat_map(|words| words.split_whitespace());
    match words.any(|word| word == name) {
        true => Err(ConvertError::Reserved {
            found: name.to_owned(),
            language,
        }),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_language_are_no_names() {
        for (target, word) in [
            (Target::Matlab, "end"),
            (Target::Matlab, "for"),
            (Target::Matlab, "p"),
            (Target::Modelica, "model"),
            (Target::Modelica, "Real"),
        ] {
            let message = check(target, word).unwrap_err().to_string();
            assert!(
                message.contains(word) && message.contains("another name"),
                "{message}"
            );
        }
        for (target, word) in [
            (Target::Matlab, "model"),
            (Target::Modelica, "m10x16"),
            (Target::Nastran, "end"),
        ] {
            check(target, word).unwrap();
        }
    }

    #[test]
    fn names_fit_into_those_of_the_tools() {
        let (fits, long) = ("n".repeat(63), "n".repeat(64));
        for target in [Target::Matlab, Target::Abaqus, Target::Calculix] {
            check(target, &fits).unwrap();
            let message = check(target, &long).unwrap_err().to_string();
            assert!(message.contains("64 characters") && message.contains("at most 63"));
        }
        check(Target::Modelica, &long).unwrap();
    }
}
