//! Figures 4.30 and 4.32: natural frequencies by joint models 1 and 2, which say where the joint is.

use nalgebra::dmatrix;

use crate::error::ReproduceError;
use crate::outcome::Row;
use bolted_joint_identify::JointMatrices;

use super::{Case, END_TO_END, Joint, truth};

/// 800 Hz: the highest frequency of the figures is 767.5 Hz.
const LAST_LINE: u32 = 3200;
/// Rotational stiffnesses that are none and rigid beside beams of EI = 30 N·m² and 0.2 m, N·m/rad.
const FREE: f64 = 1e-3;
const RIGID: f64 = 1e6;
/// Natural frequencies without the rigid-body modes, by their number from 1, Hz.
const FIGURE_4_30: [(usize, f64); 4] = [(1, 39.5), (2, 278.3), (3, 442.0), (4, 645.5)];
const FIGURE_4_32: [(usize, f64); 4] = [(1, 20.4), (2, 123.8), (3, 312.5), (4, 767.5)];

pub(crate) fn figures_4_30_and_4_32() -> Result<Vec<Row>, ReproduceError> {
    let hinge = JointMatrices {
        stiffness: dmatrix![1e5, 0.0; 0.0, FREE],
        damping: dmatrix![5.0, 0.0; 0.0, 0.0],
    };
    let mut rigid = truth();
    rigid.stiffness[(1, 1)] = RIGID;
    let models = [
        ("model 1 (4.6)", hinge, FIGURE_4_30),
        ("model 2 (4.7)", truth(), FIGURE_4_32),
        ("model 2, rotation rigid", rigid, FIGURE_4_32),
    ];
    let mut found = Vec::new();
    for (model, matrices, published) in models {
        for (place, joint) in [
            ("end to end", END_TO_END),
            ("lap of 50 mm", Joint::in_lap(0.050)),
            ("lap of 60 mm", Joint::in_lap(0.060)),
        ] {
            let found_hz = Case::through(joint, &matrices, LAST_LINE)?.resonances_hz();
            let case = format!("{model}, {place}");
            found.extend(Row::resonances(&case, &published, &found_hz));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Peaks of the receptance at 2s in NumPy: modes of the beams by finite elements, coupled line by line, 0.25 Hz apart.
    #[test]
    fn a_lap_of_50_mm_has_the_frequencies_of_both_figures() {
        let found = figures_4_30_and_4_32().unwrap();
        #[rustfmt::skip]
        let cases = [
            ("model 1 (4.6), lap of 50 mm", [39.5, 277.5, 439.75, 644.0], [0.01; 4]),
            ("model 1 (4.6), lap of 60 mm", [39.25, 283.25, 430.0, 629.75], [0.03; 4]),
            ("model 2 (4.7), lap of 50 mm", [20.25, 116.0, 307.25, 741.0], [0.065; 4]),
            ("model 2 (4.7), lap of 60 mm", [21.0, 119.0, 313.75, 735.5], [0.045; 4]),
            ("model 2, rotation rigid, lap of 50 mm", [20.5, 124.5, 312.5, 766.75], [0.006; 4]),
        ];
        for (case, references, tolerances) in cases {
            let rows = found.iter().filter(|row| row.case == case);
            let rows: Vec<&Row> = rows.collect();
            assert_eq!(rows.len(), 4, "{case}");
            for ((row, reference), tolerance) in rows.iter().zip(references).zip(tolerances) {
                let hz = row.obtained.unwrap().mean;
                assert!((hz - reference).abs() < 0.2, "{row:?}");
                let away = (hz / row.published.unwrap() - 1.0).abs();
                assert!(away < tolerance, "{row:?}");
            }
        }
    }
}
