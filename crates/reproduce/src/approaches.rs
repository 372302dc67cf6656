//! Sections 4.2.2 and 4.3: two aluminium beams, approaches 1 to 4, and both noise procedures.

mod figures;
mod tables;

pub(crate) use figures::figures_4_30_and_4_32;
pub(crate) use tables::{table_4_6, table_4_7, table_4_8, table_4_9};

use nalgebra::dmatrix;

use bolted_joint_frf::resonances;
use bolted_joint_frf::structure::{Beam, Boundary, ComplexMatrix, Damping, Partition, Theory};
use bolted_joint_identify::{
    Bands, Equation, Inverse, JointMatrices, JointModel, band_average, decouple,
};
use bolted_joint_respond::Pollution;

use super::draws::{Repetition, decoupled_within, polluted};
use super::error::ReproduceError;
use super::outcome::{Row, Spread};
use super::receptances::{assemblies, at, partitions, rotation, translation};

/// Not given; those of chapter 5, up to B's free end.
const POINTS_M: [f64; 3] = [0.195, 0.210, 0.225];
/// Not given; that of the measurements in chapter 5.
const LINE_SPACING_HZ: f64 = 0.25;
/// The bands end at 300 Hz; the highest response is at the first mode.
const LAST_LINE: u32 = 1640;

/// Where the joint is: m from A's fixed end, m from B's first end. Not given in the text.
#[derive(Clone, Copy)]
struct Joint {
    on_a_m: f64,
    on_b_m: f64,
}

impl Joint {
    /// In the middle of beams that overlap.
    const fn in_lap(lap_m: f64) -> Self {
        Self {
            on_a_m: A_LENGTH_M - 0.5 * lap_m,
            on_b_m: 0.5 * lap_m,
        }
    }
}

/// As the thesis's figure shows the beams.
const END_TO_END: Joint = Joint::in_lap(0.0);
const LAPPED: Joint = Joint::in_lap(0.060);
const A_LENGTH_M: f64 = 0.3;
const B_LENGTH_M: f64 = 0.225;

/// Section 4.2.2: E = 67e9 Pa, I = 4.5e-10 m⁴, 0.4050 kg/m, which is 25 mm × 6 mm of 2700 kg/m³, ζ = 0.01.
fn beam(length_m: f64, boundary: Boundary) -> Beam {
    Beam {
        length_m,
        width_m: 0.025,
        height_m: 0.006,
        youngs_modulus_pa: 67e9,
        density_kg_per_m3: 2700.0,
        theory: Theory::EulerBernoulli,
        boundary,
        damping: Damping::Ratios(vec![0.01]),
    }
}

/// (4.7).
fn truth() -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e5, 0.0; 0.0, 1e3],
        damping: dmatrix![5.0, 0.0; 0.0, 0.05],
    }
}

/// Where section 4.2.2 averages k_Fy and k_Mθ, Hz.
const TRANSLATION_HZ: [f64; 2] = [200.0, 300.0];
const ROTATION_HZ: [f64; 2] = [60.0, 180.0];

/// The bands of section 4.2.2, also for the dampings.
fn bands() -> Bands {
    Bands {
        yy: vec![TRANSLATION_HZ],
        ytheta: Vec::new(),
        thetatheta: vec![ROTATION_HZ],
    }
}

/// What of the assembly an approach decouples: points 1s, 2s, 3s and the rotation at 2s are 0 to 3.
#[derive(Clone, Copy)]
enum Approach {
    /// Translation and rotation at 2s.
    One,
    /// Translation at 2s.
    Two,
    /// Translations at 2s and 3s.
    Three,
    /// Translations at 1s, 2s and 3s.
    Four,
}

impl Approach {
    fn places(self) -> &'static [usize] {
        match self {
            Self::One => &[1, 3],
            Self::Two => &[1],
            Self::Three => &[1, 2],
            Self::Four => &[0, 1, 2],
        }
    }
}

struct Case {
    frequency_hz: Vec<f64>,
    a: Vec<Partition>,
    b: Vec<Partition>,
    /// H^C_ss at the three points and the rotation.
    assembly: Vec<ComplexMatrix>,
}

impl Case {
    fn new(joint: Joint) -> Result<Self, ReproduceError> {
        Self::through(joint, &truth(), LAST_LINE)
    }

    /// The beams through a joint of these matrices, up to a line.
    fn through(
        joint: Joint,
        matrices: &JointMatrices,
        last_line: u32,
    ) -> Result<Self, ReproduceError> {
        let frequency_hz: Vec<f64> = (1..=last_line)
            .map(|line| LINE_SPACING_HZ * f64::from(line))
            .collect();
        let mut points = POINTS_M.map(translation).to_vec();
        points.push(rotation(POINTS_M[1]));
        let a = beam(A_LENGTH_M, Boundary::FixedFree);
        let a = partitions(&a, joint.on_a_m, &[], &frequency_hz)?;
        let b = beam(B_LENGTH_M, Boundary::FreeFree);
        let b = partitions(&b, joint.on_b_m, &points, &frequency_hz)?;
        let assembly = assemblies(&frequency_hz, &a, &b, matrices)?;
        Ok(Self {
            frequency_hz,
            a,
            b,
            assembly: assembly.into_iter().map(|line| line.ss).collect(),
        })
    }

    /// What of the assembly an approach decouples, without noise.
    fn measured(&self, approach: Approach) -> Vec<ComplexMatrix> {
        let places = approach.places();
        let lines = self.assembly.iter();
        lines
            .map(|line| line.select_rows(places).select_columns(places))
            .collect()
    }

    /// B at the points of an approach.
    fn b_at(&self, approach: Approach) -> Vec<Partition> {
        let parts = self.b.iter();
        parts.map(|b| at(b, approach.places())).collect()
    }

    /// Averages over the bands.
    fn average(
        &self,
        inverse: Inverse,
        b: &[Partition],
        measured: &[ComplexMatrix],
    ) -> Option<JointMatrices> {
        let bands = bands();
        let decoupled = decoupled_within(&bands, &self.frequency_hz, |line| {
            let (a, b) = (&self.a[line], &b[line]);
            decouple(Equation::Ss, inverse, a, b, &measured[line])
        });
        band_average(JointModel::Diagonal, &self.frequency_hz, &decoupled, &bands)
    }

    /// Averages over the bands by an approach, for each draw of the noise; inverses as printed.
    fn joints(
        &self,
        draws: Repetition<'_>,
        approach: Approach,
        noise: Pollution,
    ) -> Result<Vec<JointMatrices>, ReproduceError> {
        let noise = noise.checked()?;
        let exact = self.measured(approach);
        let b = self.b_at(approach);
        Ok(draws.joints(|generator| {
            let noisy = polluted(&exact, &noise, generator);
            self.average(Inverse::AsPrinted, &b, &noisy)
        }))
    }

    /// What approach 2 returns without any noise.
    fn single_point(&self) -> Vec<JointMatrices> {
        let approach = Approach::Two;
        let measured = self.measured(approach);
        self.average(Inverse::AsPrinted, &self.b_at(approach), &measured)
            .into_iter()
            .collect()
    }

    /// |H^C| at 2s.
    fn amplitudes(&self) -> Vec<f64> {
        self.assembly.iter().map(|h| h[(1, 1)].norm()).collect()
    }

    fn resonances_hz(&self) -> Vec<f64> {
        let function: Vec<_> = self.assembly.iter().map(|h| h[(1, 1)]).collect();
        let found = resonances(&self.frequency_hz, &function);
        found.iter().map(|found| found.frequency_hz).collect()
    }

    /// Root mean square of a line's noise at 2s by response pollution, % of the median receptance in each of the two bands.
    fn noise_rows(&self, level: f64, samples: u32) -> Vec<Row> {
        let amplitudes = self.amplitudes();
        let highest = amplitudes.iter().copied().fold(0.0, f64::max);
        // Real and imaginary part of variance 2σ²/N each.
        let noise = level * highest * (4.0 / f64::from(samples)).sqrt();
        let row = |[from, to]: [f64; 2]| {
            let lines = self.frequency_hz.iter().zip(&amplitudes);
            let within = lines.filter(|&(hz, _)| (from..=to).contains(hz));
            let within: Vec<f64> = within.map(|(_, amplitude)| *amplitude).collect();
            let percent = Spread::of(&within).map(|of| Spread::exact(100.0 * noise / of.median));
            Row::computed(
                &format!("noise beside |H| at 2s, N = {samples}"),
                &format!("{from}–{to} Hz"),
                "%",
                percent,
            )
        };
        [ROTATION_HZ, TRANSLATION_HZ].map(row).to_vec()
    }
}

#[cfg(test)]
mod tests;
