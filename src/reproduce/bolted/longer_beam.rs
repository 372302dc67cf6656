//! Section 5.3.2.3: a bolt identified on one assembly, used in another.

use crate::identify::{Amplitudes, JointModel, Lines, update_in_two_steps};
use crate::reproduce::draws::{Draws, polluted};
use crate::reproduce::error::ReproduceError;
use crate::reproduce::outcome::{Reproduction, Row, Spread};
use crate::reproduce::published::PublishedTable;
use crate::respond::Pollution;

use super::bolts::{LEVEL, m8x35};
use super::frequency_row;
use super::structures::{self, joint};

/// Section 5.3.2.3: the bolt of Table 5.6 in an assembly with a longer A.
pub(in crate::reproduce) fn long_m8x35(draws: &Draws) -> Result<Reproduction, ReproduceError> {
    let bolt = m8x35();
    let used = structures::measured_at(&bolt.lines()?, bolt.used);
    let truth = joint(bolt.updated);
    let long = structures::assembled(structures::STEEL_M8_LONG, &bolt.beam, &truth)?;
    let noise = Pollution::Frf { level: LEVEL }.checked()?;
    let start = joint(bolt.initial);
    let identified = draws.joints(|generator| {
        let noisy = Lines {
            assembly: polluted(&used.assembly, &noise, generator),
            ..used.clone()
        };
        Some(
            update_in_two_steps(&noisy, JointModel::Full, &start, Amplitudes::Logarithmic)
                .ok()?
                .joint,
        )
    });
    let mut deviations = Vec::new();
    for joint in &identified {
        let assembly = long.regenerated(joint)?;
        deviations.push(
            100.0
                * structures::relative_rms(
                    &structures::function(&assembly, (1, 1)),
                    &structures::function(&long.assembly, (1, 1)),
                ),
        );
    }
    let mut found = vec![Row {
        case: "predicted, r.m.s. deviation".to_owned(),
        quantity: "2s".to_owned(),
        unit: "%",
        truth: None,
        published: None,
        obtained: Spread::of(&deviations),
    }];
    for (case, hz) in [
        (
            "resonances, A of 0.30 m",
            structures::resonances_hz(&bolt.lines()?, &truth)?,
        ),
        (
            "resonances, A of 0.35 m",
            structures::resonances_hz(&long, &truth)?,
        ),
    ] {
        let indexed = hz.into_iter().enumerate();
        found.extend(indexed.map(|(index, hz)| frequency_row(case, index, None, hz)));
    }
    Ok(Reproduction {
        table: PublishedTable::LongM8x35,
        conditions: vec![
            "joint identified on the shorter assembly from 2s with 1 % FRF pollution (two-step update on logarithms), then used with the longer A; deviation from the published joint there".to_owned(),
        ],
        rows: found,
        differences: Vec::new(),
        not_given: vec!["figure 5.35 has a curve and no numbers: \"perfectly match\"".to_owned()],
    })
}
