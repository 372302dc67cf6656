//! The estimate reaches the Cramér–Rao bound, and its intervals hold the truth as often as they say.

use bolted_joint::identify::NoiseLevel;

use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint, thesis};
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
    let rig = Rig::new("medium joint", joint(1.0, 1.0), thesis(axis(500.0, 1.0)));
    check(&rig, Noisy::Assembly, 0.01, 1.2);
    check(&rig, Noisy::Assembly, 0.05, 1.5);
}

#[test]
fn noise_on_everything_is_told_from_the_joint() {
    // Few draws: up to 27 receptances with errors of their own on each line. The benchmark has many.
    let rig = Rig::new("medium joint", joint(1.0, 1.0), thesis(axis(500.0, 2.0)));
    let level = NoiseLevel {
        relative: 0.01,
        floor: 0.0,
    };
    for noisy in [Noisy::AssemblyAndA, Noisy::Everything] {
        let outcomes = run(&rig, noisy, level, 12, true);
        print(&rig, noisy, level, &outcomes);
        for outcome in outcomes {
            // The r.m.s. of twelve errors is known to 20 %.
            let ratio = outcome.rms_error / outcome.bound;
            assert!(ratio < 1.8, "{noisy:?} {}: {ratio}", outcome.name);
            let stated = outcome.mean_deviation / outcome.bound;
            assert!(
                (0.85..1.2).contains(&stated),
                "{noisy:?} {}: {stated}",
                outcome.name
            );
        }
    }
}
