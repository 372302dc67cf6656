//! What a set of functions says of itself before anything is fitted: whether it is reciprocal, and whether its drive points take up
//! energy.

use std::path::Path;

use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

use super::labelled::Labelled;
use bolted_joint_frf::{Asked, Dof, feeds_energy, turns_backwards};

/// H_pq and H_qp may differ by this part of them at half of the lines.
const RECIPROCAL: f64 = 0.2;
/// They differ by a factor where this makes them so much more alike.
const MORE_ALIKE: f64 = 0.3;

/// What is wrong with a set of functions.
pub(super) struct Unsound {
    /// Each with the file's name.
    pub(super) warnings: Vec<String>,
    /// That its phases are counted the other way, whatever a fit makes of them: every drive point feeds energy, and the phase of each
    /// rises through resonances, as no turned sign lets it.
    pub(super) turned: Option<String>,
}

/// What is wrong with functions between `labels`.
pub(super) fn unsound(functions: &Labelled, labels: &[Dof], path: &Path) -> Unsound {
    let (mut found, mut signs) = (Vec::new(), Vec::new());
    let drive_points = functions.measured.iter().filter(|(p, q)| p == q);
    let mut drive_points = drive_points
        .map(|&(p, _)| functions.function(p, p))
        .peekable();
    let is_turned = drive_points.peek().is_some()
        && drive_points.all(|own| {
            feeds_energy(own, Asked::BeyondNoise) && turns_backwards(own, Asked::BeyondNoise)
        });
    let turned = is_turned.then(|| {
        format!(
            "the phases of {} are counted the other way (e^−jωt): they rise through resonances, and every drive point feeds energy; \
             take the conjugate of its functions",
            path.display()
        )
    });
    for &(p, q) in &functions.measured {
        if p == q && feeds_energy(functions.function(p, p), Asked::BeyondNoise) {
            signs.push(labels[p].to_string());
        }
        if p < q && functions.measured.contains(&(q, p)) {
            let pair = [functions.function(p, q), functions.function(q, p)];
            let complaint = not_reciprocal(pair);
            found.extend(complaint.map(|complaint| {
                let [one, other] = [labels[p], labels[q]];
                format!("the function from {other} to {one} {complaint} from {one} to {other}")
            }));
        }
    }
    if !signs.is_empty() {
        found.push(format!(
            "the drive point at {} feeds energy into the structure instead of taking it up: a sign is wrong, or phases are counted \
             the other way (e^−jωt)",
            signs.join(", ")
        ));
    }
    let named = found.into_iter();
    let warnings = named.map(|complaint| format!("{}: {complaint}", path.display()));
    Unsound {
        warnings: warnings.collect(),
        turned,
    }
}

/// How two functions that should be the same differ; `None` where they are.
fn not_reciprocal([one, other]: [&[Complex64]; 2]) -> Option<String> {
    let difference = |factor: f64| {
        usual(one.iter().zip(other).map(|(one, other)| {
            let other = other * factor;
            2.0 * (one - other).norm() / (one.norm() + other.norm())
        }))
    };
    let apart = difference(1.0);
    if apart.is_nan() || apart <= RECIPROCAL {
        return None;
    }
    let factor = usual(one.iter().zip(other).map(|(one, other)| (one / other).re));
    if difference(factor) >= MORE_ALIKE * apart {
        return Some(format!(
            "is not reciprocal: at half of the lines it differs by more than {:.0} %",
            100.0 * apart
        ));
    }
    Some(if (factor + 1.0).abs() < RECIPROCAL {
        "has the opposite sign of that".to_owned()
    } else {
        format!("is {factor:.3} times that")
    })
}

/// The median of those that are numbers; NaN where none is.
fn usual(values: impl Iterator<Item = f64>) -> f64 {
    upper_median(values.filter(|value| value.is_finite())).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resonance(line: usize) -> Complex64 {
        let ratio = line as f64 / 50.0;
        Complex64::new(1.0 - ratio * ratio, 0.02 * ratio).inv()
    }

    #[test]
    fn functions_that_are_not_reciprocal_say_how() {
        let function: Vec<Complex64> = (1..100).map(resonance).collect();
        let times =
            |factor: f64| -> Vec<Complex64> { function.iter().map(|h| h * factor).collect() };
        assert_eq!(not_reciprocal([&function, &times(1.1)]), None);
        let complaint = |factor: f64| not_reciprocal([&times(factor), &function]).unwrap();
        assert!(complaint(-1.0).contains("opposite sign"));
        assert!(complaint(1e-3).contains("is 0.001 times"));
        let other: Vec<Complex64> = (1..100).map(|line| resonance(line + 20)).collect();
        let complaint = not_reciprocal([&function, &other]).unwrap();
        assert!(complaint.contains("not reciprocal"));
    }
}
