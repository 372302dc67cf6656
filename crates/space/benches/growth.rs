//! How the cost of a line grows with the degrees of freedom of all joints: `cargo bench -p bolted-joint-space`, which draws it
//! too with `-- --figure NAME.svg`.
//!
//! Two structures are connected at N motions, and have nine responses and nine references elsewhere each. Timed is the
//! assembly with the relative motions from which all derivatives by stiffnesses follow; memory is what is taken meanwhile at
//! most, beside the structures' functions.

use std::error::Error;
use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

use bolted_joint_figures::{Line, LineFigure, Scale};
use bolted_joint_space::{Coupled, Dof, Selection};
use nalgebra::DMatrix;
use num_complex::Complex64;

#[path = "../../../tests/memory/counting.rs"]
mod counting;

/// Elsewhere on each structure.
const ELSEWHERE: usize = 9;
/// Trials, of which the fastest counts: others use the machine too.
const TRIALS: usize = 1000;
/// Degrees of freedom from which on a cube is drawn beside the time.
const MANY: f64 = 6.0;

/// Of N degrees of freedom.
struct Measured {
    degrees: f64,
    microseconds: f64,
    kilobytes: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:>3} {:>12} {:>12}", "N", "µs a line", "kB a line");
    let mut all = Vec::new();
    for joint in [1, 2, 3, 4, 6, 9, 12, 18, 24] {
        let own = measured(joint)?;
        println!(
            "{joint:>3} {:>12.1} {:>12.1}",
            own.microseconds, own.kilobytes
        );
        all.push(own);
    }
    let arguments: Vec<String> = std::env::args().collect();
    let place = arguments.iter().position(|argument| argument == "--figure");
    if let Some(path) = place.and_then(|place| arguments.get(place + 1)) {
        // Cargo runs it in the crate's folder
        let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(path);
        std::fs::write(path, drawn(&all).ok_or("nothing to draw")?)?;
    }
    Ok(())
}

fn measured(joint: usize) -> Result<Measured, Box<dyn Error>> {
    let side = joint + ELSEWHERE;
    let count = 2 * side;
    let number = |i: usize, j: usize| Complex64::new((i * j + i + j) as f64, (i + j) as f64).sin();
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
    let before = counting::in_use();
    counting::reset_peak();
    for _ in 0..TRIALS {
        let started = Instant::now();
        let coupled = Coupled::new(black_box(&receptances), &selection, &stiffness, 0.03)?;
        black_box(coupled);
        fastest = fastest.min(started.elapsed().as_secs_f64());
    }
    Ok(Measured {
        degrees: joint as f64,
        microseconds: 1e6 * fastest,
        kilobytes: 1e-3 * (counting::peak() - before) as f64,
    })
}

fn drawn(all: &[Measured]) -> Option<String> {
    let last = all.last()?;
    let cube = |degrees: f64| last.microseconds * (degrees / last.degrees).powi(3);
    let many = all.iter().filter(|own| own.degrees >= MANY);
    LineFigure {
        title: "time and memory of a line over the degrees of freedom of all joints",
        across: ("degrees of freedom of all joints, N", Scale::Logarithmic),
        up: ("of a line", Scale::Logarithmic),
        lines: vec![
            Line::curve(
                "time, µs",
                all.iter().map(|own| (own.degrees, own.microseconds)),
            ),
            Line::curve(
                "memory, kB",
                all.iter().map(|own| (own.degrees, own.kilobytes)),
            ),
            Line::curve("N³", many.map(|own| (own.degrees, cube(own.degrees)))),
        ],
    }
    .to_svg()
}
