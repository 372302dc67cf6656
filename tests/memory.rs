//! What an identification takes of memory, from the files to the joint file, beside the receptances that it is made from.
//!
//! `cargo test --release --test memory -- --ignored --nocapture` does it for 200,000 lines.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

#[path = "identification/beams.rs"]
#[expect(dead_code, reason = "the tests of identification need more of them")]
mod beams;
#[path = "memory/counting.rs"]
mod counting;
#[path = "identification/measured.rs"]
#[expect(dead_code, reason = "the rig can do more than is needed here")]
mod measured;

use std::path::Path;

use bolted_joint::frf::{ByteOrder, Dof, Frf, FrfSet, write_uff58b};
use bolted_joint::identify::{Receptances, Study, identify};
use bolted_joint::structure::ComplexMatrix;

use measured::{Noisy, Rig, joint, thesis};

/// Peak of the memory in use, beside the receptances of all files.
const ALLOWED: f64 = 3.0;

/// Three points about A's joint, as many about B's, and those where the assembly is measured.
const STUDY: &str = include_str!("data/studies/measured.toml");

fn write(path: &Path, frequency_hz: &[f64], matrices: &[ComplexMatrix], nodes: &[u32]) {
    let dof = |node: u32| -> Dof { format!("{node}:+Y").parse().unwrap() };
    let mut functions = Vec::new();
    for (row, &response) in nodes.iter().enumerate() {
        for (column, &reference) in nodes.iter().enumerate() {
            let values = matrices
                .iter()
                .map(|matrix| matrix[(row, column)])
                .collect();
            let (response, reference) = (dof(response), dof(reference));
            let axis = frequency_hz.to_vec();
            functions.push(Frf::new(response, reference, axis, values).unwrap());
        }
    }
    let set = FrfSet::new(functions).unwrap();
    write_uff58b(&set, path, "memory", ByteOrder::Little).unwrap();
}

/// Writes a study of so many lines, in which everything is measured, and gives the bytes of its receptances.
fn written(folder: &Path, count: usize) -> usize {
    let step_hz = 500.0 / count as f64;
    let axis = (1..=count).map(|line| line as f64 * step_hz).collect();
    let rig = Rig::new("memory", joint(1.0, 1.0), thesis(axis));
    let lines = rig.lines(Noisy::Everything, beams::relative(0.01), 1);
    let hz = &lines.frequency_hz;
    let assembly = folder.join("assembly.uff");
    write(&assembly, hz, &lines.assembly, &[21, 22, 23]);
    let all = |substructure: &Receptances| -> Vec<ComplexMatrix> {
        let measured = substructure.measured().unwrap();
        (0..count).map(|line| measured.receptance(line)).collect()
    };
    write(&folder.join("a.uff"), hz, &all(&lines.a), &[1, 2, 3]);
    let nodes = [11, 12, 13, 21, 22, 23];
    write(&folder.join("b.uff"), hz, &all(&lines.b), &nodes);
    std::fs::write(folder.join("study.toml"), STUDY).unwrap();
    16 * count * (9 + 9 + 36)
}

fn check(count: usize) {
    let folder = tempfile::tempdir().unwrap();
    let data = written(folder.path(), count);
    let study = Study::read(&folder.path().join("study.toml")).unwrap();
    let before = counting::in_use();
    counting::reset_peak();
    let found = identify(&study).unwrap();
    let file = found.joint_file().to_json().unwrap();
    let peak = counting::peak() - before;
    let held = counting::in_use() - before;
    let ratio = peak as f64 / data as f64;
    println!(
        "{count} lines, {:.1} MB of receptances: peak {:.1} MB = {ratio:.2} times, held {:.2} times",
        data as f64 / 1e6,
        peak as f64 / 1e6,
        held as f64 / data as f64
    );
    assert!(file.len() > 1000);
    assert!(found.estimate.assessment.fits());
    assert!(ratio < ALLOWED, "{ratio}");
}

#[test]
fn an_identification_takes_three_times_the_memory_of_its_data() {
    check(2_000);
}

#[test]
#[ignore = "takes minutes"]
fn a_large_identification_takes_three_times_the_memory_of_its_data() {
    check(200_000);
}
