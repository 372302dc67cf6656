//! What a measured function is the ratio of, and how to get receptance from it.

use std::f64::consts::TAU;
use std::fmt;

use num_complex::Complex64;
use serde::{Deserialize, Serialize};

use super::Dof;
use bolted_joint_files::misspelt::did_you_mean;

/// A motion per load: the three forms in which frequency response functions are measured.
///
/// Motion is m or rad and its rates, load is N or N·m. Serde uses the lower-case names, `"receptance"` and so on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Displacement per force, m/N.
    Receptance,
    /// Velocity per force, m/(s·N).
    Mobility,
    /// Acceleration per force, m/(s²·N).
    Accelerance,
}

impl Quantity {
    /// What a quantity is called: by its name, or by what is measured for it. Words that mean different things to different people,
    /// such as admittance, are left out.
    pub(super) const WORDS: [(Self, &'static [&'static str]); 3] = [
        (
            Self::Receptance,
            &["receptance", "compliance", "displacement"],
        ),
        (Self::Mobility, &["mobility", "velocity"]),
        (
            Self::Accelerance,
            &["accelerance", "inertance", "acceleration"],
        ),
    ];

    /// A quantity by one of its words, in capitals or not.
    pub(super) fn named(word: &str) -> Option<Self> {
        let word = word.to_lowercase();
        let mut all = Self::WORDS.iter();
        all.find(|(_, words)| words.contains(&word.as_str()))
            .map(|(quantity, _)| *quantity)
    }

    /// What is expected in the place of a word that names none, with the name that was meant.
    pub(super) fn instead_of(word: &str) -> String {
        let names = Self::WORDS.map(|(_, words)| words[0]);
        let [receptance, mobility, accelerance] = names;
        let meant = did_you_mean(word, &names);
        format!("{receptance}, {mobility} or {accelerance}{meant}")
    }

    /// The quantity with so many time derivatives of displacement above the load: 0, 1 or 2.
    pub(super) fn from_time_derivatives(derivatives: i32) -> Option<Self> {
        match derivatives {
            0 => Some(Self::Receptance),
            1 => Some(Self::Mobility),
            2 => Some(Self::Accelerance),
            _ => None,
        }
    }

    /// What a complex value of receptance at `frequency_hz` (Hz) is multiplied by to give this quantity.
    fn per_receptance(self, frequency_hz: f64) -> Complex64 {
        let omega = TAU * frequency_hz;
        match self {
            Self::Receptance => Complex64::new(1.0, 0.0),
            // Y = jω H
            Self::Mobility => Complex64::new(0.0, omega),
            // A = −ω² H
            Self::Accelerance => Complex64::new(-omega * omega, 0.0),
        }
    }

    /// Receptance (m/N, rad/N, m/(N·m) or rad/(N·m)) from a `value` of this quantity at `frequency_hz` (Hz).
    ///
    /// `None` at 0 Hz for mobility and accelerance, which say nothing about static compliance.
    #[must_use]
    pub fn to_receptance(self, value: Complex64, frequency_hz: f64) -> Option<Complex64> {
        match self {
            Self::Receptance => Some(value),
            _ if frequency_hz == 0.0 => None,
            // H = Y/(jω),  H = −A/ω²
            _ => Some(value / self.per_receptance(frequency_hz)),
        }
    }

    /// This quantity from a `receptance` at `frequency_hz` (Hz), for plots and comparisons.
    #[must_use]
    pub fn from_receptance(self, receptance: Complex64, frequency_hz: f64) -> Complex64 {
        receptance * self.per_receptance(frequency_hz)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Receptance => "receptance",
            Self::Mobility => "mobility",
            Self::Accelerance => "accelerance",
        })
    }
}

/// Unit of a receptance between two degrees of freedom, by whether they are rotations.
#[must_use]
pub fn receptance_unit(response: Dof, reference: Dof) -> &'static str {
    match [response, reference].map(|dof| dof.direction().is_rotation()) {
        [false, false] => "m/N",
        [false, true] => "m/(N·m)",
        [true, false] => "rad/N",
        [true, true] => "rad/(N·m)",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A viscously damped oscillator gives all three forms in closed form.
    #[test]
    fn an_oscillator_has_the_same_receptance_from_each_quantity() {
        let (mass, stiffness, damping) = (1.3, 4.0e5, 21.0);
        for frequency_hz in [0.5, 88.0, 900.0] {
            let omega = TAU * frequency_hz;
            let s = Complex64::new(0.0, omega);
            let impedance_sum = s * s * mass + s * damping + stiffness;
            let receptance = 1.0 / impedance_sum;
            for (quantity, value) in [
                (Quantity::Receptance, receptance),
                (Quantity::Mobility, s / impedance_sum),
                (Quantity::Accelerance, s * s / impedance_sum),
            ] {
                let found = quantity.to_receptance(value, frequency_hz).unwrap();
                assert!((found - receptance).norm() <= 4e-16 * receptance.norm());
                let back = quantity.from_receptance(receptance, frequency_hz);
                assert!((back - value).norm() <= 4e-16 * value.norm());
            }
        }
    }

    #[test]
    fn only_receptance_says_anything_at_zero_frequency() {
        let value = Complex64::new(2.0, 0.0);
        assert_eq!(Quantity::Receptance.to_receptance(value, 0.0), Some(value));
        assert_eq!(Quantity::Mobility.to_receptance(value, 0.0), None);
        assert_eq!(Quantity::Accelerance.to_receptance(value, 0.0), None);
    }

    #[test]
    fn a_quantity_has_the_words_that_universal_files_use() {
        for (word, expected) in [
            ("Inertance", Some(Quantity::Accelerance)),
            ("acceleration", Some(Quantity::Accelerance)),
            ("compliance", Some(Quantity::Receptance)),
            ("displacement", Some(Quantity::Receptance)),
            ("velocity", Some(Quantity::Mobility)),
            ("admittance", None),
        ] {
            assert_eq!(Quantity::named(word), expected, "{word}");
        }
    }

    #[test]
    fn serde_and_display_use_the_same_name() {
        for quantity in [
            Quantity::Receptance,
            Quantity::Mobility,
            Quantity::Accelerance,
        ] {
            let json = serde_json::to_string(&quantity).unwrap();
            assert_eq!(json, format!("\"{quantity}\""));
        }
    }
}
