//! Section 4.1: two chains of two masses, one spring and damper between them.

use nalgebra::{DMatrix, dmatrix, dvector};

use crate::identify::{Bands, JointMatrices, JointModel, from_rr, from_rs, from_ss};
use crate::structure::{Assembly, ComplexMatrix, Partition, SpatialModel, couple};

use super::draws::{Averages, Draws, polluted};
use super::error::ReproduceError;
use super::outcome::Reproduction;
use super::published::PublishedTable;

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

type Decouple = fn(&Partition, &Partition, &ComplexMatrix) -> Option<ComplexMatrix>;
type Block = fn(&Assembly) -> &ComplexMatrix;

pub(super) fn table_4_2(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    let noise = draws.response(LEVEL).checked()?;
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
    let equations: [(&str, Decouple, Block, [f64; 2]); 3] = [
        ("(3.18), mass 1", from_rr, |c| &c.rr, [2008.0, 3.52]),
        ("(3.19), masses 1 and 4", from_rs, |c| &c.rs, [2016.0, 2.73]),
        ("(3.21), mass 4", from_ss, |c| &c.ss, [2020.0, 2.80]),
    ];
    let mut rows = Vec::new();
    for (case, decouple, block, published) in equations {
        let exact: Vec<ComplexMatrix> = assembly.iter().map(|c| block(c).clone()).collect();
        let mut averages = Averages::new(JointModel::Translation);
        for mut generator in draws.generators() {
            let noisy = polluted(&exact, &noise, &mut generator);
            let decoupled: Vec<_> = (0..frequency_hz.len())
                .map(|line| decouple(&a[line], &b[line], &noisy[line]))
                .collect();
            averages.add(&frequency_hz, &decoupled, &bands);
        }
        rows.extend(averages.rows(case, &truth, &published));
    }
    Ok(Reproduction {
        table: PublishedTable::Table4_2,
        conditions: vec![format!(
            "joint averaged from {} to {} Hz; noise {} % of the highest response",
            BAND_HZ[0],
            BAND_HZ[1],
            100.0 * LEVEL
        )],
        rows,
        differences: Vec::new(),
        not_given: vec![
            format!("spacing of the lines: {LINE_SPACING_HZ} Hz taken"),
            format!("samples of each harmonic test: {} taken", draws.samples),
        ],
    })
}
