//! Joint files beside each other: each number with its deviation, and how far it is from that of the first joint, in standard
//! deviations of the difference.
//!
//! Joints are compared as independent estimates: errors that they have in common, such as those of one set-up, make real
//! differences smaller than they look, never larger.
#![forbid(unsafe_code)]

mod error;
mod numbers;
mod together;

pub use error::CompareError;
pub use numbers::{Difference, HALF, Measured, Row};
pub use together::{Together, UNLIKELY};

use bolted_joint_joint::{DofSet, JointFile};

/// Joint files beside each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What each joint is called in messages and figures, in their order.
    pub names: Vec<String>,
    /// Their degrees of freedom.
    pub dofs: DofSet,
    /// A row for each number that one of them has.
    pub rows: Vec<Row>,
    /// Of each joint but the first: all numbers of K and C together, where both files have deviations and correlations.
    pub together: Vec<Option<Together>>,
    /// What differs between the files beside the numbers.
    pub notes: Vec<String>,
}

impl Comparison {
    /// Joints with their names, at least two; those over the preload at the same preloads.
    ///
    /// # Errors
    /// [`CompareError`] where the joints are not of one kind, or one over the preload is not what a joint file may hold.
    pub fn of(joints: &[(String, JointFile)]) -> Result<Self, CompareError> {
        let [(first_name, first), others @ ..] = joints else {
            return Err(CompareError::TooFew { found: 0 });
        };
        if others.is_empty() {
            return Err(CompareError::TooFew { found: 1 });
        }
        for (name, other) in others {
            error::comparable((first_name, first), (name, other))?;
        }
        let files: Vec<&JointFile> = joints.iter().map(|own| &own.1).collect();
        Ok(Self {
            names: joints.iter().map(|own| own.0.clone()).collect(),
            dofs: first.joint.dofs,
            rows: numbers::rows(&files)?,
            together: others
                .iter()
                .map(|(_, other)| Together::of(first, other))
                .collect(),
            notes: notes(joints),
        })
    }

    /// Why differences are no parts of some first values, which have a dash in their place.
    #[must_use]
    pub fn unknown_parts(&self) -> Option<&'static str> {
        let mut differences = self.rows.iter().flat_map(|row| &row.differences).flatten();
        differences.any(|own| own.relative.is_none()).then_some(
            "Where there is a dash, the first value cannot be told from zero, by its deviation or beside the difference, so that no part of it \
             says anything.",
        )
    }
}

/// Differences of origin and validity that may explain those of the numbers.
fn notes(joints: &[(String, JointFile)]) -> Vec<String> {
    let mut notes = Vec::new();
    let mut differ = |what: &str, of: &dyn Fn(&JointFile) -> Option<String>| {
        let all: Vec<Option<String>> = joints.iter().map(|own| of(&own.1)).collect();
        if all.iter().any(|own| own != &all[0]) {
            let told = joints.iter().zip(&all).map(|((name, _), own)| {
                format!("{name}: {}", own.as_deref().unwrap_or("not stated"))
            });
            notes.push(format!(
                "{what} differ: {}",
                told.collect::<Vec<_>>().join("; ")
            ));
        }
    };
    let of = |file: &JointFile| file.provenance.clone();
    differ("methods", &|file| of(file).map(|own| own.method));
    differ("joint models", &|file| of(file).map(|own| own.model));
    differ("frequencies", &|file| {
        let [low, high] = file.validity.as_ref()?.frequency_hz;
        Some(format!("{low} to {high} Hz"))
    });
    differ("torques", &|file| {
        let [low, high] = file.validity.as_ref()?.torque_n_m?;
        Some(format!("{low} to {high} N·m"))
    });
    notes
}

#[cfg(test)]
mod tests {
    use bolted_joint_joint::JointFile;

    use super::*;

    fn joint(k: f64, spread: f64, extra: &str) -> JointFile {
        let text = format!(
            r#"{{"format": "bolted-joint/1", "name": "x", "joint": {{"dofs": ["y"], "stiffness": [[{k}]], "damping": [[2]]{extra}}},
            "uncertainty": {{"standard_deviation": {{"stiffness": [[{spread}]], "damping": [[0.1]]}}, "basis": "made up",
            "correlation": {{"unknowns": ["k_yy", "c_yy"], "matrix": [[1, 0.5], [0.5, 1]]}}}}}}"#
        );
        JointFile::from_json(&text, "x").unwrap()
    }

    fn compared(other: JointFile) -> Result<Comparison, CompareError> {
        Comparison::of(&[
            ("a".to_owned(), joint(1e5, 300.0, "")),
            ("b".to_owned(), other),
        ])
    }

    #[test]
    fn differences_are_in_deviations_of_the_difference() {
        let found = compared(joint(0.9e5, 400.0, "")).unwrap();
        let row = &found.rows[0];
        assert_eq!((row.name.as_str(), row.unit.as_str()), ("k_yy", "N/m"));
        // √(300² + 400²) = 500
        let difference = row.differences[0].unwrap();
        assert!((difference.deviations.unwrap() + 1e4 / 500.0).abs() < 1e-9);
        assert!((difference.relative.unwrap() + 0.1).abs() < 1e-12);
        // dᵀ (Σa + Σb)⁻¹ d by hand: d = (−1e4, 0), Σ = [[25e4, 0.5·(300·0.1 + 400·0.1)], [·, 0.02]]
        let (a, b, c): (f64, f64, f64) = (25e4, 35.0, 0.02);
        let expected = 1e8 * c / (a * c - b * b);
        let together = found.together[0].unwrap();
        assert!(
            (together.chi_squared / expected - 1.0).abs() < 1e-9,
            "{together:?}"
        );
        assert_eq!(together.unknowns, 2);
        assert!(together.probability < 1e-10);
    }

    #[test]
    fn nothing_is_a_part_of_a_value_that_may_be_zero() {
        let of = |k: f64| {
            let joints = [joint(k, 300.0, ""), joint(1e5, 300.0, "")];
            let found = Comparison::of(&joints.map(|own| ("j".to_owned(), own))).unwrap();
            found.rows[0].differences[0].unwrap()
        };
        // 1.96·300 = 588
        assert_eq!(of(587.0).relative, None);
        assert!(of(587.0).deviations.unwrap() > 200.0);
        assert!(of(589.0).relative.unwrap() > 100.0);
    }

    #[test]
    fn numbers_of_laws_have_their_deviations() {
        let slipping = |slip_force: f64, deviation: f64| {
            let text = format!(
                r#"{{"format": "bolted-joint/1", "name": "x", "joint": {{"dofs": ["y"], "stiffness": [[0]], "damping": [[0]],
                "friction": [{{"dof": "y", "law": "jenkins", "stiffness": 1e5, "slip_force": {slip_force}}}]}},
                "uncertainty": {{"basis": "made up", "standard_deviation": {{"stiffness": [[0]], "damping": [[0]],
                "friction": [{{"dof": "y", "law": "jenkins", "stiffness": 0, "slip_force": {deviation}}}]}}}}}}"#
            );
            JointFile::from_json(&text, "x").unwrap()
        };
        let joints = [slipping(100.0, 3.0), slipping(110.0, 4.0)].map(|own| ("j".to_owned(), own));
        let found = Comparison::of(&joints).unwrap();
        let row = |name: &str| found.rows.iter().find(|row| row.name == name).unwrap();
        // √(3² + 4²) = 5
        let difference = row("jenkins.slip_force_y").differences[0].unwrap();
        assert!((difference.deviations.unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(row("jenkins.stiffness_y").values[0].deviation, None);
    }

    #[test]
    fn joints_of_other_kinds_are_refused() {
        let sliding =
            r#", "friction": [{"dof": "y", "law": "jenkins", "stiffness": 1e5, "slip_force": 10}]"#;
        let refused = compared(joint(1e5, 1.0, sliding)).unwrap_err().to_string();
        assert!(
            refused.contains("a: found no law of friction, b: found jenkins on y"),
            "{refused}"
        );
        let text = r#"{"format": "bolted-joint/1", "name": "x", "joint": {"dofs": ["y", "theta"], "stiffness": [[1, 0], [0, 1]],
            "damping": [[1, 0], [0, 1]]}}"#;
        let other = JointFile::from_json(text, "x").unwrap();
        let refused = compared(other).unwrap_err().to_string();
        assert!(refused.contains("degrees of freedom"), "{refused}");
        let alone = Comparison::of(&[("a".to_owned(), joint(1e5, 1.0, ""))]);
        assert!(matches!(alone, Err(CompareError::TooFew { found: 1 })));
    }

    #[test]
    fn terms_that_one_joint_lacks_are_zero_there() {
        let found = compared(joint(1e5, 300.0, r#", "cubic": [1e12]"#)).unwrap();
        let row = found.rows.iter().find(|row| row.name == "k3_y").unwrap();
        assert_eq!(
            row.values.iter().map(|own| own.value).collect::<Vec<_>>(),
            [0.0, 1e12]
        );
        assert_eq!(row.differences[0].unwrap().deviations, None);
    }
}
