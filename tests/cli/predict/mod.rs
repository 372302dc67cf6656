//! `predict`: from a study to joint file, FMU and files for finite-element programs, and what it says of studies that are wrong.

mod bad;
mod good;
mod microslip;
mod space;

use crate::bench::Bench;
use serde_json::Value;

/// Four bolts on milled iron, by one torque, without any doubt.
const STUDY: &str = include_str!("../../data/studies/four-bolts.toml");

/// The study with its bolts tightened as a table says.
fn over_torque() -> String {
    STUDY.replace("torque = 20\n", "").replace(
        "nut_factor = 0.2\n",
        "nut_factor = 0.2\ntorques = [5, 10, 15, 20, 25]\nnominal = 20\n",
    )
}

fn bench(study: &str) -> Bench {
    let bench = Bench::new();
    bench.write("study.toml", study);
    bench
}

/// The joint file that the study gives.
fn predicted(study: &str) -> Value {
    let bench = bench(study);
    bench.done(PREDICT);
    bench.json("j.joint.json")
}

const PREDICT: &str = "predict study.toml -o j.joint.json";
