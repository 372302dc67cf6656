//! Section 5.3.2.3: a bolt identified on one assembly, used in another.

use crate::draws::Repetition;
use crate::error::ReproduceError;
use crate::outcome::{Row, Spread};

use super::bolts::Bolts;
use super::structures::{self, SubstructureA, joint};
use super::update;

/// Section 5.3.2.3: the bolt of Table 5.6 in an assembly with a longer A.
pub(crate) fn long_m8x35(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let bolt = Bolts::published()?.m8x35;
    let short = bolt.lines()?;
    let used = structures::measured_at(&short, &bolt.used);
    let truth = joint(bolt.updated);
    let long = structures::assembled(SubstructureA::LongM8x35, &bolt.beam, &truth)?;
    let mut deviations = Vec::new();
    for joint in update::with_noise(draws, &used, &joint(bolt.initial))? {
        let [_, at_2s, _] = structures::deviations_percent(&long, &joint)?;
        deviations.push(at_2s);
    }
    let mut found = vec![Row::computed(
        "predicted, r.m.s. deviation",
        "2s",
        "%",
        Spread::of(&deviations),
    )];
    for (case, lines) in [
        ("resonances, A of 0.30 m", &short),
        ("resonances, A of 0.35 m", &long),
    ] {
        let modes = structures::resonances_hz(lines, &truth)?;
        found.extend(Row::resonances(case, &[], &modes));
    }
    Ok(found)
}
