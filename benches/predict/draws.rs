//! Monte Carlo over a joint of four bolts.

use std::path::Path;
use std::time::Instant;

use bolted_joint::predict::study::{InterfaceStudy, Prediction};
use bolted_joint::study::StudyText;
use criterion::Criterion;

/// Draws of the measurement, and the seconds that they may take on two processors.
const DRAWS: u64 = 10_000;
const LIMIT_S: f64 = 10.0;
/// Draws of a repetition for criterion.
const FEW: u64 = 200;

/// Four M8 on iron: 2400 elements, and everything that is never known well is uncertain.
fn study(draws: u64) -> InterfaceStudy {
    let text = include_str!("four-bolts.toml");
    let text = format!("{text}\n[uncertainty]\ndraws = {draws}\nseed = 1\n");
    InterfaceStudy::of(&StudyText::new(text, Path::new("four-bolts.toml"))).unwrap()
}

/// Prints the time of all draws and checks it against its limit.
pub(crate) fn compare() {
    let study = study(DRAWS);
    let begun = Instant::now();
    let found = Prediction::of(&study, &|| {}).unwrap();
    let seconds = begun.elapsed().as_secs_f64();
    let outcome = found.outcome.as_ref().unwrap();
    println!(
        "{DRAWS} draws of four bolts on {} elements: {seconds:.2} s on {} processors, {:.0} µs a draw, {} refused",
        found.nominal().field.elements().len(),
        std::thread::available_parallelism().map_or(1, usize::from),
        1e6 * seconds / DRAWS as f64,
        outcome.of.draws - outcome.accepted
    );
    assert!(seconds < LIMIT_S, "more than {LIMIT_S} s");
}

pub(crate) fn bench(criterion: &mut Criterion) {
    let study = study(FEW);
    let mut group = criterion.benchmark_group("prediction");
    group.sample_size(10);
    group.bench_function("200 draws of four bolts", |bencher| {
        bencher.iter(|| Prediction::of(&study, &|| {}).unwrap());
    });
    group.finish();
}
