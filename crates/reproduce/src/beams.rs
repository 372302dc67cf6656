//! Section 4.2.1: two steel beams, a fully populated joint, and rotations measured or estimated.

use nalgebra::dmatrix;

use bolted_joint_frf::structure::{
    Assembly, Beam, Boundary, ComplexMatrix, Damping, FiniteDifference, Partition, Theory,
};
use bolted_joint_identify::{
    Bands, Equation, Inverse, JointMatrices, JointModel, band_average, decouple,
};
use bolted_joint_respond::Pollution;

use super::draws::{Repetition, decoupled_within, polluted, rows};
use super::error::ReproduceError;
use super::outcome::Row;
use super::receptances::{assemblies, at, block, partitions, rotation, translation};

const LENGTH_M: f64 = 0.3;
/// Noise of section 4.2.1, as in 4.1.
const LEVEL: f64 = 0.05;
/// Not given: the middle of A, where neighbours 0.02 m away are on the beam.
const R_M: f64 = 0.15;
/// Not given: B's free end.
const S_M: f64 = LENGTH_M;
/// Spacing of the translations from which rotations at r are estimated (figure 4.13).
const SPACING_M: f64 = 0.02;
/// Not given; that of the measurements in chapter 5.
const LINE_SPACING_HZ: f64 = 0.25;
/// The bands end at 400 Hz; the highest response is at the first mode.
const LAST_LINE: u32 = 1640;

/// Section 4.2.1: E = 2.07e11 Pa, I = 1.0667e-9 m⁴, 1.5094 kg/m, η = 0.05. A section of 25 mm × 8 mm has this I.
fn beam(boundary: Boundary) -> Beam {
    let (width_m, height_m) = (0.025, 0.008);
    Beam {
        length_m: LENGTH_M,
        width_m,
        height_m,
        youngs_modulus_pa: 2.07e11,
        density_kg_per_m3: 1.5094 / (width_m * height_m),
        theory: Theory::EulerBernoulli,
        boundary,
        damping: Damping::LossFactor(0.05),
    }
}

/// Table 4.3; the value of c_Mθ is in Table 4.4.
fn truth() -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e6, 1e4; 1e4, 1e3],
        damping: dmatrix![25.0, 8.0; 8.0, 5.0],
    }
}

/// The bands of section 4.2.1, also for the dampings.
fn bands() -> Bands {
    Bands {
        yy: vec![[200.0, 400.0]],
        ytheta: vec![[150.0, 310.0]],
        thetatheta: vec![[15.0, 300.0]],
    }
}

struct Case {
    /// Where r is on A.
    r_m: f64,
    frequency_hz: Vec<f64>,
    a: Vec<Partition>,
    b: Vec<Partition>,
    assembly: Vec<Assembly>,
}

impl Case {
    fn new(r_m: f64) -> Result<Self, ReproduceError> {
        let frequency_hz: Vec<f64> = (1..=LAST_LINE)
            .map(|line| LINE_SPACING_HZ * f64::from(line))
            .collect();
        let parts = |boundary, joint_m, point_m| {
            let points = [translation(point_m), rotation(point_m)];
            partitions(&beam(boundary), joint_m, &points, &frequency_hz)
        };
        let a = parts(Boundary::FixedFree, LENGTH_M, r_m)?;
        let b = parts(Boundary::FreeFree, 0.0, S_M)?;
        let assembly = assemblies(&frequency_hz, &a, &b, &truth())?;
        Ok(Self {
            r_m,
            frequency_hz,
            a,
            b,
            assembly,
        })
    }

    /// The receptances that `equation` decouples, without noise, rotations measured.
    fn measured(&self, equation: Equation) -> Vec<ComplexMatrix> {
        let lines = self.assembly.iter();
        lines
            .map(|assembly| block(equation, assembly).clone())
            .collect()
    }

    /// Translations around r: receptances of A, and of the assembly.
    fn around_r(&self) -> Result<(Vec<Partition>, Vec<ComplexMatrix>), ReproduceError> {
        let points = [self.r_m - SPACING_M, self.r_m, self.r_m + SPACING_M].map(translation);
        let a = beam(Boundary::FixedFree);
        let a = partitions(&a, LENGTH_M, &points, &self.frequency_hz)?;
        let assembly = assemblies(&self.frequency_hz, &a, &self.b, &truth())?;
        Ok((a, assembly.into_iter().map(|line| line.rr).collect()))
    }

    /// Averages over the bands by `equation`.
    fn average(
        &self,
        equation: Equation,
        a: &[Partition],
        b: &[Partition],
        measured: &[ComplexMatrix],
    ) -> Option<JointMatrices> {
        let bands = bands();
        let decoupled = decoupled_within(&bands, &self.frequency_hz, |line| {
            let (a, b) = (&a[line], &b[line]);
            decouple(equation, Inverse::LeastSquares, a, b, &measured[line])
        });
        let mut joint = band_average(JointModel::Full, &self.frequency_hz, &decoupled, &bands)?;
        // "When cross-coupling terms are identified as negative values, they are taken as zero."
        for matrix in [&mut joint.stiffness, &mut joint.damping] {
            let coupling = matrix[(0, 1)].max(0.0);
            matrix[(0, 1)] = coupling;
            matrix[(1, 0)] = coupling;
        }
        Some(joint)
    }

    /// The joint for each draw of the noise on the receptances that `equation` takes, rotations measured.
    fn joints(
        &self,
        draws: Repetition<'_>,
        noise: Pollution,
        equation: Equation,
    ) -> Result<Vec<JointMatrices>, ReproduceError> {
        let noise = noise.checked()?;
        let exact = self.measured(equation);
        Ok(draws.joints(|generator| {
            let noisy = polluted(&exact, &noise, generator);
            self.average(equation, &self.a, &self.b, &noisy)
        }))
    }

    /// The same by (3.18), rotations of the assembly estimated from noisy translations around r.
    fn joints_with_estimated_rotations(
        &self,
        draws: Repetition<'_>,
        noise: Pollution,
    ) -> Result<Vec<JointMatrices>, ReproduceError> {
        let noise = noise.checked()?;
        let (_, exact) = self.around_r()?;
        Ok(draws.joints(|generator| {
            let noisy = polluted(&exact, &noise, generator);
            self.average(Equation::Rr, &self.a, &self.b, &differences(&noisy))
        }))
    }

    /// (3.18) without noise, rotations of the assembly estimated from translations around r.
    fn joint_with_estimated_rotations(&self) -> Result<Vec<JointMatrices>, ReproduceError> {
        let (_, exact) = self.around_r()?;
        let joint = self.average(Equation::Rr, &self.a, &self.b, &differences(&exact));
        Ok(joint.into_iter().collect())
    }

    /// What the translation at r (3.18) or at s (3.21) returns by itself, without noise.
    fn translation_alone(&self, equation: Equation) -> Vec<JointMatrices> {
        let first = |parts: &[Partition]| -> Vec<Partition> {
            parts.iter().map(|part| at(part, &[0])).collect()
        };
        let measured = self.measured(equation);
        let measured: Vec<ComplexMatrix> = measured
            .iter()
            .map(|h| h.select_rows(&[0]).select_columns(&[0]))
            .collect();
        self.average(equation, &first(&self.a), &first(&self.b), &measured)
            .into_iter()
            .collect()
    }
}

/// Receptances at the middle one of three points, rotation by the central difference.
fn differences(translations: &[ComplexMatrix]) -> Vec<ComplexMatrix> {
    let transformation = FiniteDifference::central(SPACING_M).transformation();
    let transposed = transformation.transpose();
    let estimated = translations
        .iter()
        .map(|h| &transformation * h * &transposed);
    estimated.collect()
}

fn joint_rows(case: &str, published: &[f64], joints: &[JointMatrices]) -> Vec<Row> {
    rows(case, JointModel::Full, Some(&truth()), published, joints)
}

/// (3.18) in Tables 4.4 and 4.5: k_Fy, k_Fθ, k_Mθ, c_Fy, c_Fθ, c_Mθ.
const BY_RR: [f64; 6] = [1.01e6, 9.03e3, 1.11e3, 25.2, 5.60, 4.83];

pub(super) fn table_4_3() -> Vec<Row> {
    joint_rows("joint", &[1e6, 1e4, 1e3, 25.0, 8.0], &[])
}

pub(super) fn table_4_4(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(R_M)?;
    let by_rs = [9.91e5, 8.60e3, 178.0, 43.2, 8.19, 3.52];
    let by_ss = [9.02e5, 2.38e4, 9.66e2, 76.3, 13.5, 3.36];
    let mut found = Vec::new();
    for (name, equation, published) in [
        ("(3.18), r", Equation::Rr, BY_RR),
        ("(3.19), r and s", Equation::Rs, by_rs),
        ("(3.21), s", Equation::Ss, by_ss),
    ] {
        for (samples, noise) in draws.responses(LEVEL) {
            let joints = case.joints(draws, noise, equation)?;
            found.extend(joint_rows(&format!("{name}{samples}"), &published, &joints));
        }
    }
    for (name, equation, published) in [
        ("(3.18), no noise, y at r alone", Equation::Rr, BY_RR),
        ("(3.21), no noise, y at s alone", Equation::Ss, by_ss),
    ] {
        let alone = case.translation_alone(equation);
        found.extend(joint_rows(name, &published, &alone));
    }
    Ok(found)
}

pub(super) fn table_4_5(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let case = Case::new(R_M)?;
    let estimated = [9.02e5, 0.0, 5.30e2, 47.6, 0.0, 2.79];
    let mut found = Vec::new();
    for (samples, noise) in draws.responses(LEVEL) {
        let joints = case.joints(draws, noise, Equation::Rr)?;
        found.extend(joint_rows(
            &format!("1: measured{samples}"),
            &BY_RR,
            &joints,
        ));
    }
    for (samples, noise) in draws.responses(LEVEL) {
        let joints = case.joints_with_estimated_rotations(draws, noise)?;
        found.extend(joint_rows(
            &format!("2: estimated{samples}"),
            &estimated,
            &joints,
        ));
    }
    let exact = case.joint_with_estimated_rotations()?;
    found.extend(joint_rows("2: estimated, no noise", &estimated, &exact));
    let alone = case.translation_alone(Equation::Rr);
    found.extend(joint_rows("no noise, y at r alone", &estimated, &alone));
    Ok(found)
}

#[cfg(test)]
mod tests;
