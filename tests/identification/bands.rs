//! Bands chosen by sensitivity and distance to resonances, against the median over all lines.

use bolted_joint::identify::{
    BandChoice, BandChoices, BandOrigin, JointMatrices, JointModel, Options,
};

use crate::beams::identified;
use crate::cases::{axis, beams_4_2_2, bolt};

const SEEDS: u64 = 20;

/// r.m.s. errors of the average's entries, relative to what is theirs in the joint.
fn errors(joint: &JointMatrices, choice: &BandChoice, relative: f64) -> [f64; 6] {
    let pair = beams_4_2_2(axis(500.0, 0.5), &[], &[0.125, 0.175, 0.225]);
    let options = Options {
        bands: BandChoices::all(choice.clone()),
        ..Options::default()
    };
    let mut squares = [0.0; 6];
    for seed in 0..SEEDS {
        let lines = pair.lines(joint, relative, seed);
        let found = identified(&lines, JointModel::Full, &options);
        let average = found.band_average().unwrap();
        let pairs = [
            (&average.stiffness, &joint.stiffness),
            (&average.damping, &joint.damping),
        ];
        for (matrix, (found, exact)) in pairs.into_iter().enumerate() {
            for (entry, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
                let error = (found[(i, j)] - exact[(i, j)]) / scale;
                squares[3 * matrix + entry] += error * error;
            }
        }
        for used in &found.bands()[0] {
            let expected = match choice {
                BandChoice::Automatic => BandOrigin::Automatic,
                _ => BandOrigin::Median,
            };
            assert_eq!(used.origin, expected, "{used:?}");
        }
    }
    squares.map(|sum| (sum / SEEDS as f64).sqrt())
}

#[test]
fn chosen_bands_beat_the_median() {
    let joint = bolt(1.0);
    for relative in [0.001, 0.01, 0.05] {
        let chosen = errors(&joint, &BandChoice::Automatic, relative);
        let median = errors(&joint, &BandChoice::Median, relative);
        println!("noise {relative}: chosen {chosen:.4?}, median {median:.4?}");
        // At 5 % no choice of lines makes an average of the dampings: they are hidden in the noise of the stiffnesses.
        let entries = if relative < 0.05 { 6 } else { 3 };
        for (entry, (chosen, median)) in chosen.into_iter().zip(median).take(entries).enumerate() {
            let case = format!("entry {entry} at {relative}: {chosen} {median}");
            assert!(chosen < median, "{case}");
        }
    }
}
