//! How the cost of a line grows with the degrees of freedom of all joints: `cargo bench -p bolted-joint-space`.
//!
//! Two structures are connected at N motions, and have nine responses and nine references elsewhere each. Timed is the
//! assembly with the relative motions from which all derivatives by stiffnesses follow.

use std::hint::black_box;
use std::time::Instant;

use bolted_joint_space::{Coupled, Dof, Selection, SpaceError};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Elsewhere on each structure.
const ELSEWHERE: usize = 9;
/// Trials, of which the fastest counts: others use the machine too.
const TRIALS: usize = 1000;

fn main() -> Result<(), SpaceError> {
    println!("{:>3} {:>12} {:>12}", "N", "µs a line", "kB a line");
    for joint in [1, 2, 3, 4, 6, 9, 12, 18, 24] {
        let side = joint + ELSEWHERE;
        let count = 2 * side;
        let number =
            |i: usize, j: usize| Complex64::new((i * j + i + j) as f64, (i + j) as f64).sin();
        let receptances = DMatrix::from_fn(count, count, |i, j| match i / side == j / side {
            true => number(i.min(j), i.max(j)) * 1e-7 + if i == j { 1e-6 } else { 0.0 },
            false => Complex64::ZERO,
        });
        let relative = DMatrix::from_fn(joint, count, |row, column| {
            f64::from(u8::from(column == row)) - f64::from(u8::from(column == side + row))
        });
        let selection = Selection::new(relative, vec![Dof::X; joint])?;
        let stiffness = DMatrix::from_fn(joint, joint, |i, j| {
            Complex64::new(if i == j { 1e6 } else { 1e4 }, 1e3)
        });
        let mut fastest = f64::INFINITY;
        for _ in 0..TRIALS {
            let started = Instant::now();
            let coupled = Coupled::new(black_box(&receptances), &selection, &stiffness, 0.03)?;
            black_box(coupled);
            fastest = fastest.min(started.elapsed().as_secs_f64());
        }
        // Y_C, Y_C Sᵀ and S Y_C
        let numbers = count * count + 2 * count * joint;
        println!(
            "{joint:>3} {:>12.1} {:>12.1}",
            1e6 * fastest,
            16e-3 * numbers as f64
        );
    }
    Ok(())
}
