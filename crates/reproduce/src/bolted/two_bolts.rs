//! Section 5.3.3.3: two bolts side by side.

use nalgebra::DMatrix;

use crate::error::ReproduceError;
use crate::outcome::Row;
use crate::receptances::{rotation, translation};
use bolted_joint_frf::structure::{ComplexMatrix, Difference, FiniteDifference, Order};
use bolted_joint_identify::{JointMatrices, Lines};

use super::bolts::{Bolt, Bolts};
use super::structures::{self, SPACING_M, joint};

/// Section 5.3.3.3: two M6x30 bolts, each with the joint of Table 5.9.
pub(crate) fn two_m6x30() -> Result<Vec<Row>, ReproduceError> {
    let of_one = Bolts::published()?.m6x30;
    let bolt = joint(of_one.updated);
    let both = JointMatrices::of_bolts(&[bolt.clone(), bolt.clone()]);
    let rigid = JointMatrices {
        stiffness: &both.stiffness * 1e3,
        damping: &both.damping * 1e3,
    };
    let one = two_bolt_lines(&of_one, 1, &bolt)?;
    let two = two_bolt_lines(&of_one, 2, &both)?;
    let mut found = Vec::new();
    for (case, lines, joint) in [
        ("one bolt", &one, &bolt),
        ("two bolts", &two, &both),
        ("two bolts, 1000 times as stiff", &two, &rigid),
    ] {
        let modes = structures::resonances_hz(lines, joint)?;
        found.extend(Row::resonances(case, &[], &modes));
    }
    Ok(found)
}

/// A and B with one bolt at A's middle point, or with a second one at its inner point; B overlaps A the same for both.
fn two_bolt_lines(
    of_one: &Bolt,
    bolts: usize,
    joint: &JointMatrices,
) -> Result<Lines, ReproduceError> {
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
    let a_joint: Vec<ComplexMatrix> = structures::translations(of_one.modes, &frequency_hz)?
        .iter()
        .map(|h| &transformation * h * &transposed)
        .collect();
    let at_bolts = [2.0 * SPACING_M, SPACING_M];
    let dofs: Vec<_> = at_bolts
        .iter()
        .take(bolts)
        .flat_map(|&x_m| [translation(x_m), rotation(x_m)])
        .chain(structures::points_m(&of_one.beam).map(translation))
        .collect();
    let b = of_one.beam.receptances(&dofs, &frequency_hz)?;
    structures::lines(frequency_hz, a_joint, b, joint)
}
