//! Errors of the estimate over many draws of noise, beside the Cramér–Rao bound and the band average of (3.21).

use bolted_joint::identify::{Bands, Noise, NoiseLevel, Options};

use crate::beams::identified;
use crate::measured::{Noisy, Rig, unknowns};

/// What many draws show of each unknown.
pub(crate) struct Outcome {
    pub(crate) name: &'static str,
    pub(crate) truth: f64,
    pub(crate) bound: f64,
    pub(crate) rms_error: f64,
    pub(crate) mean_error: f64,
    pub(crate) mean_deviation: f64,
    /// Fraction of the intervals of 95 % that hold the truth.
    pub(crate) coverage: f64,
    pub(crate) average_rms_error: f64,
}

/// Identifies `draws` noisy measurements. `told` is whether the identification is told the noise.
pub(crate) fn run(
    rig: &Rig,
    noisy: Noisy,
    level: NoiseLevel,
    draws: u64,
    told: bool,
) -> Vec<Outcome> {
    let truth = rig.truth();
    let bound = rig.bound(noisy, level);
    let options = Options {
        noise: if told {
            Noise::stated(level)
        } else {
            Noise::default()
        },
        // The thesis's bands: 200–300 Hz for the translation, 60–180 Hz for the rotation.
        bands: Bands {
            yy: vec![[200.0, 300.0]],
            ytheta: vec![[60.0, 300.0]],
            thetatheta: vec![[60.0, 180.0]],
        }
        .into(),
        ..Options::default()
    };
    let size = truth.len();
    let mut sums = vec![[0.0; 5]; size];
    let mut names = Vec::new();
    for seed in 0..draws {
        let lines = rig.lines(noisy, level, 1000 + seed);
        let found = identified(&lines, rig.model, &options);
        let values = unknowns(rig.model, found.free());
        let average = unknowns(rig.model, found.band_average().unwrap());
        let covariance = found.covariance();
        names = covariance.unknowns.iter().map(|u| u.name).collect();
        let deviation = covariance.standard_deviation();
        let intervals = covariance.intervals();
        for i in 0..size {
            let error = values[i] - truth[i];
            sums[i][0] += error * error;
            sums[i][1] += error;
            sums[i][2] += deviation[i];
            let [low, high] = intervals[i];
            sums[i][3] += f64::from(u8::from((low..=high).contains(&truth[i])));
            sums[i][4] += (average[i] - truth[i]).powi(2);
        }
    }
    let count = draws as f64;
    (0..size)
        .map(|i| Outcome {
            name: names[i],
            truth: truth[i],
            bound: bound[i],
            rms_error: (sums[i][0] / count).sqrt(),
            mean_error: sums[i][1] / count,
            mean_deviation: sums[i][2] / count,
            coverage: sums[i][3] / count,
            average_rms_error: (sums[i][4] / count).sqrt(),
        })
        .collect()
}

/// One line for each unknown, in per cent of the truth.
pub(crate) fn print(rig: &Rig, noisy: Noisy, level: NoiseLevel, outcomes: &[Outcome]) {
    println!(
        "\n{}, noise {} % on {noisy:?}",
        rig.name,
        100.0 * level.relative
    );
    for o in outcomes {
        let percent = |value: f64| 100.0 * value / o.truth.abs();
        println!(
            "  {:13} bound {:9.4} %  r.m.s. {:9.4} % = {:.3} bounds  mean {:+9.4} %  stated {:9.4} %  covers {:5.1} %  average (3.21) {:9.2} %",
            o.name,
            percent(o.bound),
            percent(o.rms_error),
            o.rms_error / o.bound,
            percent(o.mean_error),
            percent(o.mean_deviation),
            100.0 * o.coverage,
            percent(o.average_rms_error),
        );
    }
}
