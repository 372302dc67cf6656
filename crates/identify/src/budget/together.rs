//! Assemblies that one estimate with the set-up's errors can hold: both structures, the points and the lines are the same.

use std::fmt;

use super::super::lines::Lines;
use super::super::study::{Study, Substructure};

/// Lines are the same whose frequencies differ by less than this part.
const CLOSE: f64 = 1e-5;

/// Why assemblies cannot be held by one estimate with the set-up's errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Apart {
    /// A structure of this assembly is another than that of the first.
    Structure {
        /// Number of the assembly, from 1.
        assembly: usize,
        /// Its key.
        key: &'static str,
    },
    /// This assembly was measured at other points.
    Points {
        /// Number of the assembly, from 1.
        assembly: usize,
    },
    /// They have no two lines in common.
    Lines,
}

impl fmt::Display for Apart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Structure { assembly, key } => write!(
                f,
                "assembly {assembly} has another `{key}` than the first, and with several assemblies they take part only where A \
                 and B are the same in all"
            ),
            Self::Points { assembly } => write!(
                f,
                "assembly {assembly} has other points than the first, and with several assemblies they take part only where the \
                 points are the same, in the same order"
            ),
            Self::Lines => f.write_str(
                "the assemblies have no lines in common, and with several assemblies they take part only where they have",
            ),
        }
    }
}

/// Whether one estimate can hold them.
pub(in super::super) fn are_together(study: &Study, all: &[Lines]) -> Result<(), Apart> {
    common(study, all).map(|_| ())
}

/// The assemblies at the lines that all of them have.
pub(super) fn together(study: &Study, all: &[Lines]) -> Result<Vec<Lines>, Apart> {
    let common = common(study, all)?;
    let lines = all.iter().zip(common);
    Ok(lines.map(|(lines, own)| lines.at_lines(&own)).collect())
}

/// Of each assembly the lines that all of them have.
fn common(study: &Study, all: &[Lines]) -> Result<Vec<Vec<usize>>, Apart> {
    for (number, further) in study.further.iter().enumerate() {
        let assembly = number + 2;
        let differs = |own: &Substructure, first: &Substructure| own != first;
        for (key, own, first) in [("a", &further.a, &study.a), ("b", &further.b, &study.b)] {
            if differs(own, first) {
                return Err(Apart::Structure { assembly, key });
            }
        }
        if (&further.points, further.points_on_a) != (&study.points, study.points_on_a) {
            return Err(Apart::Points { assembly });
        }
    }
    let axes: Vec<&[f64]> = all
        .iter()
        .map(|lines| lines.frequency_hz.as_slice())
        .collect();
    let common = common_lines(&axes);
    match common.first() {
        Some(first) if first.len() > 1 => Ok(common),
        _ => Err(Apart::Lines),
    }
}

/// Of each ascending axis the lines that all of them have.
fn common_lines(axes: &[&[f64]]) -> Vec<Vec<usize>> {
    let mut common = vec![Vec::new(); axes.len()];
    let Some((first, others)) = axes.split_first() else {
        return common;
    };
    for (line, hz) in first.iter().enumerate() {
        let of_other = |axis: &&[f64]| {
            let from = axis.partition_point(|other| *other < hz * (1.0 - CLOSE));
            axis.get(from)
                .is_some_and(|other| *other <= hz * (1.0 + CLOSE))
                .then_some(from)
        };
        let found: Option<Vec<usize>> = others.iter().map(of_other).collect();
        if let Some(found) = found {
            let places = std::iter::once(line).chain(found);
            common
                .iter_mut()
                .zip(places)
                .for_each(|(own, place)| own.push(place));
        }
    }
    common
}

#[cfg(test)]
mod tests {
    use super::common_lines;

    #[test]
    fn lines_are_common_that_every_axis_has() {
        let axes: [&[f64]; 3] = [
            &[10.0, 20.0, 30.0, 40.0],
            &[5.0, 10.00001, 20.0, 40.0],
            &[10.0, 19.9, 20.0001, 30.0, 40.0],
        ];
        assert_eq!(common_lines(&axes), [[0, 1, 3], [1, 2, 3], [0, 2, 4]]);
        assert_eq!(common_lines(&axes[..1]), [[0, 1, 2, 3]]);
        let apart: [&[f64]; 2] = [&[1.0, 2.0], &[1.5, 2.5]];
        assert_eq!(common_lines(&apart), [[0; 0], [0; 0]]);
    }
}
