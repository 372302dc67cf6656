//! A substructure given by its measured modes: shapes, frequencies, damping ratios and residuals.

mod universal;

use std::f64::consts::TAU;
use std::fmt::Display;
use std::io::BufRead;
use std::path::{Path, PathBuf};

use num_complex::Complex64;
use serde::Deserialize;

use super::StructureError;
use crate::Dof;
use bolted_joint_files::misspelt::with_meant;
use bolted_joint_files::text_file;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    #[expect(dead_code, reason = "a note for people who read the file")]
    source: String,
    points: Vec<Dof>,
    #[serde(default, rename = "mode")]
    modes: Vec<Mode>,
    #[serde(default, rename = "residual")]
    residuals: Vec<Residual>,
}

/// One mode of a [`ModalModel`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Natural frequency, Hz; 0 for a motion of a rigid body.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Mass normalised, real and imaginary part at each point, 1/√kg.
    pub shape: Vec<[f64; 2]>,
}

/// Residuals of the receptances of all points for a load at `reference`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Residual {
    reference: Dof,
    /// UA of each point, m/N.
    upper: Vec<f64>,
    /// LA of each point, m/(N·s²).
    lower: Vec<f64>,
}

/// Modes of a substructure, mass normalised, with the residuals of the modes outside the measured range.
#[derive(Clone, Debug)]
pub struct ModalModel {
    path: PathBuf,
    points: Vec<Dof>,
    modes: Vec<Mode>,
    residuals: Vec<Residual>,
    /// How a file that is not ours was understood.
    understood: Vec<(&'static str, String)>,
    warnings: Vec<String>,
}

/// Damping ratio from which on it may be meant in per cent: a bolted structure has less than a hundredth.
const LARGE_RATIO: f64 = 0.2;

/// A word on damping ratios of which the largest is such that nothing of that kind swings as a bolted structure does; `None` for
/// others.
#[must_use]
pub fn large_damping_ratio(largest: f64) -> Option<String> {
    (LARGE_RATIO..1.0).contains(&largest).then(|| {
        format!(
            "damping ratios up to {largest:.2} are taken as parts of the critical damping, {:.0} %: if they are per cent, divide them by 100",
            100.0 * largest
        )
    })
}

/// The same of modes that hardly swing.
fn of_damping(modes: &[Mode]) -> Option<String> {
    let ratios = modes.iter().map(|mode| mode.damping_ratio);
    large_damping_ratio(ratios.fold(0.0, f64::max))
}

impl ModalModel {
    /// Reads modal data from a TOML file, or from a universal file with data sets 55.
    ///
    /// # Errors
    /// [`StructureError`], which names the file and the line or key.
    pub fn read(path: &Path) -> Result<Self, StructureError> {
        if universal::is_one(path) {
            return universal::read(path);
        }
        let text = text_file::read(path, "modal data (TOML)")?;
        Self::from_toml(&text, path)
    }

    /// Modes of a universal file (data sets 55) from any reader; `path` is what messages call it.
    ///
    /// # Errors
    /// [`StructureError`], which names the file and the line or key.
    pub fn from_universal(reader: impl BufRead, path: &Path) -> Result<Self, StructureError> {
        universal::read_from(reader, path)
    }

    /// Modal data from the text of a TOML file; `path` is what messages call it.
    ///
    /// # Errors
    /// [`StructureError`], which names the file and the line or key.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, StructureError> {
        let path = path.to_owned();
        let file: File = toml::from_str(text).map_err(|error| StructureError::Syntax {
            path: path.clone(),
            message: with_meant(error.to_string().trim_end(), []),
        })?;
        let model = Self {
            path,
            points: file.points,
            warnings: of_damping(&file.modes).into_iter().collect(),
            modes: file.modes,
            residuals: file.residuals,
            understood: Vec::new(),
        };
        model.check()?;
        Ok(model)
    }

    /// Modes that were computed, without residuals.
    pub(in crate::structure) fn computed(points: Vec<Dof>, modes: Vec<Mode>) -> Self {
        Self {
            path: PathBuf::from("beam"),
            points,
            modes,
            residuals: Vec::new(),
            understood: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The same modes without residuals.
    ///
    /// Residuals belong to single functions. Where those of one load alone are known, a rotation by finite differences
    /// would take them for a difference between points.
    #[must_use]
    pub fn without_residuals(&self) -> Self {
        Self {
            residuals: Vec::new(),
            ..self.clone()
        }
    }

    /// Degrees of freedom that the mode shapes cover.
    #[must_use]
    pub fn points(&self) -> &[Dof] {
        &self.points
    }

    /// The modes.
    #[must_use]
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// How a file of another program was understood, by what it is about: units, scale, damping.
    #[must_use]
    pub fn understood(&self) -> &[(&'static str, String)] {
        &self.understood
    }

    /// What had to be assumed of a file of another program.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// UA (m/N) and LA (m/(N·s²)) between two of the points, by their places, where the file has them for this pair or the
    /// transposed one.
    #[must_use]
    pub fn residual(&self, p: usize, q: usize) -> Option<(f64, f64)> {
        let own = |response: usize, reference: usize| {
            let mut all = self.residuals.iter();
            all.find(|residual| residual.reference == self.points[reference])
                .map(|residual| (residual.upper[response], residual.lower[response]))
        };
        own(p, q).or_else(|| own(q, p))
    }

    /// Receptance of `response` for a load at `reference`, one value for each frequency.
    ///
    /// Residuals are added where the file has them for this pair or, by reciprocity, for the transposed one.
    ///
    /// # Errors
    /// [`StructureError::MissingPoint`] if there is no shape at one of the two.
    pub fn receptance(
        &self,
        response: Dof,
        reference: Dof,
        frequency_hz: &[f64],
    ) -> Result<Vec<Complex64>, StructureError> {
        let (p, p_sign) = self.place(response)?;
        let (q, q_sign) = self.place(reference)?;
        let (upper, lower) = self.residual(p, q).unwrap_or((0.0, 0.0));
        let value = |&frequency_hz: &f64| {
            let omega = TAU * frequency_hz;
            let j_omega = Complex64::new(0.0, omega);
            let mut sum = Complex64::from(upper - lower_term(lower, omega));
            for mode in &self.modes {
                let natural = TAU * mode.frequency_hz;
                if natural == 0.0 {
                    // H = −U_pr U_qr/ω²
                    sum -= lower_term(mode.shape[p][0] * mode.shape[q][0], omega);
                    continue;
                }
                let damped = natural * (1.0 - mode.damping_ratio * mode.damping_ratio).sqrt();
                // λ_r = −ζ_r ω_r + j ω_r √(1 − ζ_r²),  a_r = 1/(2j m_r ω_r √(1 − ζ_r²)),  m_r = 1
                let pole = Complex64::new(-mode.damping_ratio * natural, damped);
                let [u_p, u_q] = [p, q].map(|i| Complex64::new(mode.shape[i][0], mode.shape[i][1]));
                let residue = u_p * u_q / Complex64::new(0.0, 2.0 * damped);
                // H_pq = Σ_r [a_r U_pr U_qr/(jω − λ_r) + conj(a_r U_pr U_qr)/(jω − λ_r*)] + UA − LA/ω²   (Tol 3.50)
                sum += residue / (j_omega - pole) + residue.conj() / (j_omega - pole.conj());
            }
            sum * (p_sign * q_sign)
        };
        Ok(frequency_hz.iter().map(value).collect())
    }

    fn place(&self, dof: Dof) -> Result<(usize, f64), StructureError> {
        let position = |wanted: Dof| self.points.iter().position(|&point| point == wanted);
        position(dof)
            .map(|index| (index, 1.0))
            .or_else(|| position(dof.flipped()).map(|index| (index, -1.0)))
            .ok_or_else(|| StructureError::MissingPoint {
                path: self.path.clone(),
                dof,
                present: self.points.clone(),
            })
    }

    fn check(&self) -> Result<(), StructureError> {
        let is_empty = self.points.is_empty() || self.modes.is_empty();
        let expected = "`points` and at least one [[mode]]";
        self.ensure(!is_empty, "found no point or no mode", expected)?;
        for (index, point) in self.points.iter().enumerate() {
            let is_new = !self.points[..index].contains(point);
            let found = format!("found point {point} twice");
            self.ensure(is_new, found, "every point once")?;
        }
        for (index, mode) in self.modes.iter().enumerate() {
            let key = |name: &str| format!("mode {}, {name}", index + 1);
            self.check_length(&key("shape"), mode.shape.len())?;
            for &[re, im] in &mode.shape {
                self.check_finite(&key("shape"), re + im)?;
            }
            let (frequency, ratio) = (mode.frequency_hz, mode.damping_ratio);
            self.ensure(
                frequency.is_finite() && frequency >= 0.0,
                format_args!("{}: found {frequency}", key("frequency_hz")),
                "a positive frequency in Hz, or 0 for a motion of a rigid body",
            )?;
            let is_real = mode.shape.iter().all(|part| part[1] == 0.0);
            self.ensure(
                frequency > 0.0 || ratio == 0.0 && is_real,
                format_args!(
                    "{}: found 0 with damping or a complex shape",
                    key("frequency_hz")
                ),
                "neither for a motion of a rigid body",
            )?;
            self.ensure(
                (0.0..1.0).contains(&ratio),
                format_args!("{}: found {ratio}", key("damping_ratio")),
                "a ratio from 0 to below 1 (not per cent)",
            )?;
        }
        for residual in &self.residuals {
            let is_there = self.points.contains(&residual.reference);
            let found = format!("found a residual with reference {}", residual.reference);
            self.ensure(is_there, found, "a reference among `points`")?;
            for (name, values) in [("upper", &residual.upper), ("lower", &residual.lower)] {
                let key = format!("residual of {}, {name}", residual.reference);
                self.check_length(&key, values.len())?;
                for &value in values {
                    self.check_finite(&key, value)?;
                }
            }
        }
        Ok(())
    }

    fn check_length(&self, key: &str, found: usize) -> Result<(), StructureError> {
        let expected = self.points.len();
        self.ensure(
            found == expected,
            format_args!("{key}: found {found} entries"),
            format_args!("{expected}, one for each of `points`"),
        )
    }

    fn check_finite(&self, key: &str, found: f64) -> Result<(), StructureError> {
        let is_finite = found.is_finite();
        self.ensure(
            is_finite,
            format_args!("{key}: found {found}"),
            "finite numbers",
        )
    }

    fn ensure(
        &self,
        valid: bool,
        found: impl Display,
        expected: impl Display,
    ) -> Result<(), StructureError> {
        match valid {
            true => Ok(()),
            false => Err(StructureError::Modes {
                path: self.path.clone(),
                found: found.to_string(),
                expected: expected.to_string(),
            }),
        }
    }
}

/// LA/ω², which is left out at 0 Hz, where it has no value.
fn lower_term(lower: f64, omega: f64) -> f64 {
    if omega > 0.0 {
        lower / (omega * omega)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE_MODE: &str = r#"
        points = ["1:+Y", "2:+Y"]
        [[mode]]
        frequency_hz = 10.0
        damping_ratio = 0.02
        shape = [[2.0, 0.0], [-1.0, 0.0]]
        [[residual]]
        reference = "2:+Y"
        upper = [1e-6, 2e-6]
        lower = [3e-2, 4e-2]
    "#;

    fn model(text: &str) -> Result<ModalModel, StructureError> {
        ModalModel::from_toml(text, Path::new("modes.toml"))
    }

    fn dof(text: &str) -> Dof {
        text.parse().unwrap()
    }

    #[test]
    fn a_real_mode_is_the_oscillator_of_its_modal_mass() {
        let frequencies = [1.0, 9.9, 10.0, 30.0];
        let found = model(ONE_MODE)
            .unwrap()
            .receptance(dof("1:+Y"), dof("1:+Y"), &frequencies)
            .unwrap();
        for (found, frequency) in found.iter().zip(frequencies) {
            // H = φ²/(ω_r² − ω² + 2jζω_r ω)
            let (natural, omega) = (TAU * 10.0, TAU * frequency);
            let denominator =
                Complex64::new(natural * natural - omega * omega, 0.04 * natural * omega);
            let exact = 4.0 / denominator;
            assert!((found - exact).norm() < 1e-13 * exact.norm());
        }
    }

    #[test]
    fn residuals_belong_to_their_reference_and_its_transpose() {
        let model = model(ONE_MODE).unwrap();
        let at = |response: &str, reference: &str| {
            model
                .receptance(dof(response), dof(reference), &[20.0])
                .unwrap()[0]
        };
        let omega = TAU * 20.0;
        let without = at("1:+Y", "1:+Y") * -0.5;
        let expected = without + 1e-6 - 3e-2 / (omega * omega);
        assert!((at("1:+Y", "2:+Y") - expected).norm() < 1e-18);
        assert_eq!(at("1:+Y", "2:+Y"), at("2:+Y", "1:+Y"));
        assert_eq!(at("1:-Y", "2:+Y"), -at("1:+Y", "2:+Y"));
    }

    #[test]
    fn a_mode_at_zero_is_a_free_mass() {
        let text = ONE_MODE.replace("10.0", "0").replace("0.02", "0");
        let found = model(&text)
            .unwrap()
            .receptance(dof("1:+Y"), dof("1:+Y"), &[0.0, 20.0]);
        let omega = TAU * 20.0;
        // φ²/(−ω²), φ = 2: a mass of 0.25 kg
        let expected = [0.0, -4.0 / (omega * omega)].map(Complex64::from);
        assert_eq!(found.unwrap(), expected);
        let refused = model(&ONE_MODE.replace("10.0", "0"))
            .unwrap_err()
            .to_string();
        assert!(refused.contains("found 0 with damping"), "{refused}");
    }

    #[test]
    fn errors_say_where_and_what() {
        let message =
            |from: &str, to: &str| model(&ONE_MODE.replace(from, to)).unwrap_err().to_string();
        assert!(
            message("[-1.0, 0.0]]", "]").contains("mode 1, shape: found 1 entries, expected 2")
        );
        assert!(message("0.02", "2.0").contains("mode 1, damping_ratio: found 2"));
        assert!(message("= 10.0", "= -1").contains("frequency_hz: found -1"));
        assert!(message("upper", "uper").contains("uper"));
        assert!(message("\"2:+Y\"]", "\"1:+Y\"]").contains("1:+Y twice"));
        assert!(message("reference = \"2:+Y\"", "reference = \"9:+Y\"").contains("9:+Y"));
        let missing = model(ONE_MODE)
            .unwrap()
            .receptance(dof("5:+Y"), dof("1:+Y"), &[1.0])
            .unwrap_err();
        assert_eq!(
            missing.to_string(),
            "modes.toml: no mode shape at 5:+Y; the points are 1:+Y, 2:+Y; correct the point in the study, or add its shape"
        );
    }

    #[test]
    fn much_damping_may_be_in_per_cent() {
        let told = |ratio: f64| {
            let text =
                ONE_MODE.replace("damping_ratio = 0.02", &format!("damping_ratio = {ratio}"));
            let model = model(&text).unwrap();
            model.warnings().join(", ")
        };
        assert_eq!(told(0.02), "");
        assert!(told(0.5).contains("divide them by 100"));
    }
}
