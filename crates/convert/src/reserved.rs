//! Words of the languages that functions and packages are written in: none of them can be a name.

use crate::{ConvertError, Target};

/// What `iskeyword` lists in MATLAB.
const OF_MATLAB: &str = "break case catch classdef continue else elseif end for function global if otherwise parfor persistent \
                         return spmd switch try while";

/// Modelica Language Specification 3.6, section 2.3.3, and the types that every model sees.
const OF_MODELICA: &str = "algorithm and annotation block break class connect connector constant constrainedby der discrete each \
                           else elseif elsewhen encapsulated end enumeration equation expandable extends external false final flow \
                           for function if import impure in initial inner input loop model not operator or outer output package \
                           parameter partial protected public pure record redeclare replaceable return stream then true type when \
                           while within Real Integer Boolean String time Modelica";

pub(crate) fn check(target: Target, name: &str) -> Result<(), ConvertError> {
    let (language, words) = match target {
        Target::Matlab => ("MATLAB", OF_MATLAB),
        Target::Modelica => ("Modelica", OF_MODELICA),
        Target::Nastran | Target::Abaqus | Target::Calculix | Target::Ansys => return Ok(()),
    };
    match words.split_whitespace().any(|word| word == name) {
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
}
