use crate::cases::axis;
use crate::measured::{Noisy, Rig, joint, unknowns};
use bolted_joint::identify::*;
#[test]
fn probe() {
    let rig = Rig::new("medium joint", joint(1.0, 1.0), 0.01, axis(500.0, 2.0));
    for relative in [1e-4, 1e-3, 0.01, 0.05] {
        let level = NoiseLevel {
            relative,
            floor: 0.0,
        };
        println!("bound {:?}", rig.bound(Noisy::Everything, level));
        for seed in 0..2 {
            let lines = rig.lines(Noisy::Everything, level, seed);
            let t = std::time::Instant::now();
            let options = Options {
                noise: Noise::stated(level),
                ..Options::default()
            };
            let found = identify_lines(std::slice::from_ref(&lines), rig.model, &options).unwrap();
            let u = unknowns(rig.model, found.free());
            let e: Vec<f64> = u.iter().zip(rig.truth()).map(|(a, b)| a - b).collect();
            println!(
                "{relative} {:?} err {e:?} sd {:?} starts {:?}\n {:?}\n {:?}",
                t.elapsed(),
                found.covariance().standard_deviation(),
                found.starts(),
                found.assessment(),
                found.warnings()
            );
        }
    }
}
