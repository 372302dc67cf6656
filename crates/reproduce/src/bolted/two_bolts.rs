//! Section 5.3.3.3: two bolts side by side.

use nalgebra::DMatrix;

use crate::error::ReproduceError;
use crate::outcome::{Reproduction, Row};
use crate::published::PublishedTable;
use crate::receptances::{rotation, translation};
use bolted_joint_frf::structure::{ComplexMatrix, Difference, FiniteDifference, Order};
use bolted_joint_identify::{JointMatrices, Lines};

use super::bolts::m6x30;
use super::structures::{self, SPACING_M, joint};

/// Section 5.3.3.3: two M6x30 bolts, each with the joint of Table 5.9.
pub(crate) fn two_m6x30() -> Result<Reproduction, ReproduceError> {
    let bolt = joint(m6x30().updated);
    let both = JointMatrices::of_bolts(&[bolt.clone(), bolt.clone()]);
    let rigid = structures::stiffened(&both, 1e3);
    let one = two_bolt_lines(1, &bolt)?;
    let two = two_bolt_lines(2, &both)?;
    let mut found = Vec::new();
    for (case, lines, joint) in [
        ("one bolt", &one, &bolt),
        ("two bolts", &two, &both),
        ("two bolts, 1000 times as stiff", &two, &rigid),
    ] {
        let modes = structures::resonances_hz(lines, joint)?;
        found.extend(Row::resonances(case, &[], &modes));
    }
    Ok(Reproduction {
        table: PublishedTable::TwoM6x30,
        conditions: vec![
            "joint: block diagonal (3.27), both bolts as in Table 5.9".to_owned(),
            "rotation of A at its middle point by the central difference, at its inner point by the forward one of second order (Table 3.1)".to_owned(),
        ],
        rows: found,
        differences: vec!["As in figure 5.43, the assembly becomes stiffer from one bolt to two to a rigid connection.".to_owned()],
        not_given: vec![
            "where the second bolt is: 15 mm from the first taken, towards A's fixed end, and B's end another 15 mm beyond it".to_owned(),
            "modes of A at the second bolt: those at the inner one of the three points taken".to_owned(),
            "figures 5.42 and 5.43 have curves and no numbers".to_owned(),
        ],
    })
}

/// A and B with one bolt at A's middle point, or with a second one at its inner point; B overlaps A the same for both.
fn two_bolt_lines(bolts: usize, joint: &JointMatrices) -> Result<Lines, ReproduceError> {
    let frequency_hz = structures::frequencies();
    let middle = FiniteDifference::central(SPACING_M).transformation();
    let transformation = match FiniteDifference::new(Difference::Forward, Order::Second, SPACING_M)
    {
        // The forward difference takes the farthest point first: the tip.
        Some(forward) if bolts == 2 => {
            let inner = forward.transformation().select_columns(&[2, 1, 0]);
            let mut both = DMatrix::zeros(4, 3);
            both.view_mut((0, 0), (2, 3)).copy_from(&middle);
            both.view_mut((2, 0), (2, 3)).copy_from(&inner);
            both
        }
        _ => middle,
    };
    let transposed = transformation.transpose();
    let a_joint: Vec<ComplexMatrix> =
        structures::translations(structures::STEEL_M6, &frequency_hz)?
            .iter()
            .map(|h| &transformation * h * &transposed)
            .collect();
    let beam = structures::steel_b_m6();
    let at_bolts = [2.0 * SPACING_M, SPACING_M];
    let dofs: Vec<_> = at_bolts
        .iter()
        .take(bolts)
        .flat_map(|&x_m| [translation(x_m), rotation(x_m)])
        .chain(structures::points_m(&beam).map(translation))
        .collect();
    let b = beam.receptances(&dofs, &frequency_hz)?;
    structures::lines(frequency_hz, a_joint, b, joint)
}
