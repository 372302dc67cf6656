//! The estimate reaches the Cramér–Rao bound, and its intervals hold the truth as often as they say.

use bolted_joint::identify::NoiseLevel;

use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint};
use crate::monte_carlo::{print, run};

const DRAWS: u64 = 100;

fn check(rig: &Rig, noisy: Noisy, relative: f64, most: f64) {
    let level = NoiseLevel {
        relative,
        floor: 0.0,
    };
    let outcomes = run(rig, noisy, level, DRAWS, true);
    print(rig, noisy, level, &outcomes);
    for outcome in &outcomes {
        let ratio = outcome.rms_error / outcome.bound;
        assert!(ratio < most, "{} {}: {ratio}", rig.name, outcome.name);
    }
    // Intervals of all unknowns together; their errors are correlated, so three times the deviation of independent ones.
    let coverage = outcomes.iter().map(|o| o.coverage).sum::<f64>() / outcomes.len() as f64;
    assert!(
        (0.90..=0.99).contains(&coverage),
        "{}: {coverage}",
        rig.name
    );
}

#[test]
fn a_medium_joint_with_noise_on_the_assembly() {
    let rig = Rig::new("medium joint", joint(1.0, 1.0), 0.01, axis(500.0, 1.0));
    check(&rig, Noisy::Assembly, 0.01, 1.2);
    check(&rig, Noisy::Assembly, 0.05, 1.5);
}

#[test]
fn a_medium_joint_with_noise_on_everything() {
    // Every 10 Hz: the errors of 27 measured receptances a line are unknowns of their own.
    let rig = Rig::new("medium joint", joint(1.0, 1.0), 0.01, axis(500.0, 10.0));
    check(&rig, Noisy::Everything, 0.01, 1.2);
}
