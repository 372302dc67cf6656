//! Tables 5.7, 5.8 and 5.10: one bolt at several torques, one of two qualities.

use crate::draws::{Repetition, rows};
use crate::error::ReproduceError;
use crate::outcome::{Row, Spread};
use bolted_joint_identify::JointModel;

use super::bolts::{Bolt, Bolts, State};
use super::structures::{self, joint};
use super::update;

/// Table 5.8: change of k_Fθ and k_Mθ from the torque before, %.
const CHANGES: [[f64; 2]; 3] = [[3.5, 0.7], [1.4, 2.2], [1.6, 1.2]];

/// Tables 5.7 and 5.8: the M8x35 bolt at four torques.
pub(crate) fn torques(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let Bolts { m8x35, torques, .. } = Bolts::published()?;
    let [mut found, resonances] = identified(&m8x35, m8x35.initial, &torques, draws)?;
    for ((before, after), published) in torques.iter().zip(&torques[1..]).zip(CHANGES) {
        let case = format!("{} to {}", before.name, after.name);
        for ((index, quantity), published) in [(1, "k_ytheta"), (2, "k_thetatheta")]
            .into_iter()
            .zip(published)
        {
            let change = 100.0 * (after.joint[index] / before.joint[index] - 1.0);
            found.push(Row {
                published: Some(published),
                ..Row::computed(&case, quantity, "%", Some(Spread::exact(change)))
            });
        }
    }
    found.extend(resonances);
    Ok(found)
}

/// Table 5.10: the M6x30 bolt of two qualities, one at two torques.
pub(crate) fn table_5_10(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let Bolts {
        m6x30, qualities, ..
    } = Bolts::published()?;
    Ok(identified(&m6x30, m6x30.updated, &qualities, draws)?.concat())
}

/// The joints of a bolt in several states, each identified from `start`, and the resonances with the published ones.
fn identified(
    bolt: &Bolt,
    start: [f64; 6],
    states: &[State],
    draws: Repetition<'_>,
) -> Result<[Vec<Row>; 2], ReproduceError> {
    let (mut found, mut resonances) = (Vec::new(), Vec::new());
    for State {
        name,
        joint: published,
    } in states
    {
        let truth = joint(*published);
        let lines = structures::assembled(bolt.modes, &bolt.beam, &truth)?;
        let used = structures::measured_at(&lines, &bolt.used);
        let joints = update::with_noise(draws, &used, &joint(start))?;
        found.extend(rows(
            name,
            JointModel::Full,
            Some(&truth),
            published,
            &joints,
        ));
        let modes = structures::resonances_hz(&lines, &truth)?;
        resonances.extend(Row::resonances(&format!("resonances, {name}"), &[], &modes));
    }
    Ok([found, resonances])
}
