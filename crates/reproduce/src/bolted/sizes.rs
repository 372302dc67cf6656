//! Tables 5.11 and 5.12: the bolts of different sizes compared, and what the comparison rests on.

use crate::draws::{Repetition, rows};
use crate::error::ReproduceError;
use crate::outcome::{Row, Spread};
use bolted_joint_frf::structure::Beam;
use bolted_joint_identify::{JointMatrices, JointModel, Lines, Unknown};

use super::bolts::{Bolt, Bolts};
use super::structures::{self, joint};
use super::update;

/// By so much Young's modulus of B is wrong in the rows that say so; those that the thesis found for its three steel beams
/// lie 2 % apart.
const MODULUS_ERROR: f64 = 0.01;

/// A bolt's name in the table, the bolt, and the joint that the table has.
type Compared<'a> = (&'a str, &'a Bolt, [f64; 6]);

/// Steel beams.
pub(crate) fn table_5_11(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let Bolts {
        m10x35,
        m8x35,
        m6x30,
        ..
    } = Bolts::published()?;
    let compared = [
        ("M10", &m10x35, m10x35.updated),
        ("M8", &m8x35, m8x35.updated),
        ("M6", &m6x30, [2.27e6, 3.89e4, 3.7e3, 75.7, 0.946, 0.164]),
    ];
    comparison(&compared, draws)
}

/// Aluminium beams.
pub(crate) fn table_5_12(draws: Repetition<'_>) -> Result<Vec<Row>, ReproduceError> {
    let Bolts { m10x16, m8x16, .. } = Bolts::published()?;
    let compared = [
        ("M10", &m10x16, m10x16.updated),
        ("M8", &m8x16, m8x16.updated),
    ];
    comparison(&compared, draws)
}

fn comparison(
    compared: &[Compared<'_>],
    draws: Repetition<'_>,
) -> Result<Vec<Row>, ReproduceError> {
    let mut found = Vec::new();
    let mut joints = Vec::new();
    for (name, bolt, published) in compared {
        let exact = bolt.lines()?;
        let truth = joint(bolt.updated);
        let used = structures::measured_at(&exact, &bolt.used);
        let of_line = update::with_noise(draws, &used, &truth)?;
        found.extend(rows(
            name,
            JointModel::Full,
            Some(&truth),
            published,
            &of_line,
        ));
        joints.push(of_line);
    }
    for (name, bolt, _) in compared {
        let wrong = with_wrong_modulus(bolt)?;
        let rested = update::until_rest(&wrong, &joint(bolt.updated))?;
        found.extend(rows(
            &format!("{name}, E of B 1 % higher, no noise"),
            JointModel::Full,
            Some(&joint(bolt.updated)),
            &[],
            &[rested.last.joint],
        ));
    }
    for (pair, joints) in compared.windows(2).zip(joints.windows(2)) {
        let published = [0, 1].map(|of| joint(pair[of].2));
        let case = format!("{} to {}", pair[0].0, pair[1].0);
        found.extend(changes(&case, &published, &joints[0], &joints[1]));
    }
    Ok(found)
}

/// The assembly as it is, and a B that is computed with another modulus.
fn with_wrong_modulus(bolt: &Bolt) -> Result<Lines, ReproduceError> {
    let beam = Beam {
        youngs_modulus_pa: (1.0 + MODULUS_ERROR) * bolt.beam.youngs_modulus_pa,
        ..bolt.beam.clone()
    };
    let lines = Lines {
        assembly: bolt.lines()?.assembly,
        ..structures::assembled(bolt.modes, &beam, &joint(bolt.updated))?
    };
    Ok(structures::measured_at(&lines, &bolt.used))
}

/// Change of the stiffnesses from one bolt to the next, %.
fn changes(
    case: &str,
    published: &[JointMatrices; 2],
    before: &[JointMatrices],
    after: &[JointMatrices],
) -> Vec<Row> {
    let unknowns = Unknown::of(JointModel::Full);
    let stiffnesses = unknowns.iter().take(3);
    let row = |unknown: &Unknown| {
        let change = |before: &JointMatrices, after: &JointMatrices| {
            100.0 * (unknown.value(after) / unknown.value(before) - 1.0)
        };
        // Neighbouring draws: those of one seed share their noise.
        let pairs = before.iter().zip(after.iter().cycle().skip(1));
        let obtained: Vec<f64> = pairs.map(|(before, after)| change(before, after)).collect();
        Row {
            published: Some(change(&published[0], &published[1])),
            ..Row::computed(case, unknown.name, "%", Spread::of(&obtained))
        }
    };
    stiffnesses.map(row).collect()
}
