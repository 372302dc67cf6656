//! The search finds the joint from wherever it starts.

use bolted_joint::identify::{JointModel, NoiseLevel, Options};

use crate::beams;
use crate::beams::identified;
use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint, matrices, thesis, unknowns};

const EXACT: NoiseLevel = beams::relative(0.0);

#[test]
fn exact_data_give_the_truth_from_any_start_within_a_factor_of_30() {
    for (factor, damping) in [(1.0, 1.0), (0.03, 0.3), (30.0, 3.0)] {
        let rig = Rig::new("exact", joint(factor, damping), thesis(axis(500.0, 1.0)));
        let truth = rig.truth();
        for noisy in [Noisy::Assembly, Noisy::Everything] {
            let lines = rig.lines(noisy, EXACT, 1);
            // Every corner of the cube of starts; where the substructures have errors too, the first.
            for corner in 0..1_u32 << truth.len() {
                let start: Vec<f64> = truth
                    .iter()
                    .enumerate()
                    .map(|(i, value)| if corner >> i & 1 == 1 { 30.0 } else { 1.0 / 30.0 } * value)
                    .collect();
                let options = Options {
                    start: Some(matrices(rig.model, &start)),
                    ..Options::default()
                };
                let found = identified(&lines, JointModel::Full, &options);
                let found = unknowns(rig.model, found.free());
                for (found, truth) in found.iter().zip(&truth) {
                    let error = (found / truth - 1.0).abs();
                    let case = format!("{factor} {noisy:?} corner {corner}: {error:e}");
                    assert!(error < 1e-8, "{case}");
                }
                if noisy == Noisy::Everything {
                    break;
                }
            }
        }
    }
}
