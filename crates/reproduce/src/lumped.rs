//! Section 4.1: two chains of two masses, one spring and damper between them.

use nalgebra::{DMatrix, dmatrix, dvector};

use bolted_joint_frf::structure::{ComplexMatrix, Partition, SpatialModel, couple};
use bolted_joint_identify::{
    Bands, Equation, Inverse, JointMatrices, JointModel, band_average, decouple,
};

use super::draws::{Repetition, decoupled_within, polluted, rows};
use super::error::ReproduceError;
use super::outcome::Row;
use super::receptances::block;

/// Noise of section 4.1.
const LEVEL: f64 = 0.05;
/// The sensitive band of section 4.1, Hz.
const BAND_HZ: [f64; 2] = [3.0, 9.0];
/// Not given; the half-power band of the second mode holds some twenty lines.
const LINE_SPACING_HZ: f64 = 0.01;
/// The highest response, which sets the noise, is at the first mode; all four lie below this.
const LAST_LINE: u32 = 1200;

/// Table 4.1: ground–m1–m2 and m3–m4–ground; the joint's mass comes first.
fn substructures() -> Result<[SpatialModel; 2], ReproduceError> {
    let a = SpatialModel::new(
        DMatrix::from_diagonal(&dvector![3.0, 5.0]),
        dmatrix![4.0, -4.0; -4.0, 7.0],
        dmatrix![3500.0, -3500.0; -3500.0, 6000.0],
    )?;
    let b = SpatialModel::new(
        DMatrix::from_diagonal(&dvector![4.0, 2.0]),
        dmatrix![2.0, -2.0; -2.0, 3.0],
        dmatrix![2000.0, -2000.0; -2000.0, 4500.0],
    )?;
    Ok([a, b])
}

pub(super) fn table_4_2(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let truth = JointMatrices {
        stiffness: dmatrix![2000.0],
        damping: dmatrix![3.0],
    };
    let [a, b] = substructures()?;
    let frequency_hz: Vec<f64> = (1..=LAST_LINE)
        .map(|line| LINE_SPACING_HZ * f64::from(line))
        .collect();
    let parts = |model: &SpatialModel| -> Result<Vec<Partition>, ReproduceError> {
        let partition = |&hz: &f64| Ok(Partition::of(&model.receptance(hz)?, 1));
        frequency_hz.iter().map(partition).collect()
    };
    let (a, b) = (parts(&a)?, parts(&b)?);
    let assembly = frequency_hz
        .iter()
        .zip(a.iter().zip(&b))
        .map(|(&hz, (a, b))| couple(a, b, &truth.complex_stiffness(hz)))
        .collect::<Result<Vec<_>, _>>()?;
    let bands = Bands {
        yy: vec![BAND_HZ],
        ..Bands::default()
    };
    let mut found = Vec::new();
    for (case, equation, published) in [
        ("(3.18), mass 1", Equation::Rr, [2008.0, 3.52].as_slice()),
        ("(3.19), masses 1 and 4", Equation::Rs, &[2016.0, 2.73]),
        ("(3.20), masses 4 and 1", Equation::Sr, &[]),
        ("(3.21), mass 4", Equation::Ss, &[2020.0, 2.80]),
    ] {
        let exact: Vec<ComplexMatrix> = assembly
            .iter()
            .map(|assembly| block(equation, assembly).clone())
            .collect();
        for (samples, noise) in draws.responses(LEVEL) {
            let noise = noise.checked()?;
            let joints = draws.joints(|generator| {
                let noisy = polluted(&exact, &noise, generator);
                let decoupled = decoupled_within(&bands, &frequency_hz, |line| {
                    decouple(
                        equation,
                        Inverse::LeastSquares,
                        &a[line],
                        &b[line],
                        &noisy[line],
                    )
                });
                band_average(JointModel::Translation, &frequency_hz, &decoupled, &bands)
            });
            found.extend(rows(
                &format!("{case}{samples}"),
                JointModel::Translation,
                Some(&truth),
                published,
                &joints,
            ));
        }
    }
    Ok(found)
}
