//! How long predictions take, with the limits they have to keep, against the same formulas in NumPy and SciPy.
//!
//! `cargo bench --bench predict` evaluates a pressure field of 100,000 points on one core, and runs `fractal_field.py` with the Python of
//! the environment variable `PYTHON` (`python3`). Both must agree, or it fails. It takes 10,000 draws of a joint of four bolts on all
//! processors.

#![expect(
    clippy::unwrap_used,
    reason = "a benchmark whose preparation fails has nothing better to do than panic"
)]

mod draws;
mod fractal_field;

use criterion::Criterion;

fn main() {
    fractal_field::compare();
    draws::compare();
    let mut criterion = Criterion::default().configure_from_args();
    fractal_field::bench(&mut criterion);
    draws::bench(&mut criterion);
    criterion.final_summary();
}
