//! The update in two steps on a synthesised assembly, repeated until it rests, with noise and without.

use crate::draws::{Repetition, polluted};
use crate::error::ReproduceError;
use bolted_joint_identify::{
    Amplitudes, JointMatrices, JointModel, Lines, TwoStep, update_in_two_steps,
};
use bolted_joint_respond::{Generator, Pollution};

use super::bolts::LEVEL;

/// A round that lowers the sum by less than this part of it ends the repetition,
const REST: f64 = 1e-6;
/// and so does a mean of (ln|H| − ln|Ĥ|)² below this: receptances that agree to eight digits.
const EXACT: f64 = 1e-16;
/// So many rounds at most.
const ROUNDS: usize = 60;

/// Where repeated updates came to rest.
pub(super) struct Rested {
    /// The last round.
    pub(super) last: TwoStep,
    /// How many there were.
    pub(super) rounds: usize,
}

/// The update on logarithms of the amplitudes, each round from the joint of the one before.
///
/// One round holds the dampings of the start while it seeks the stiffnesses, which then take up their error.
pub(super) fn until_rest(lines: &Lines, start: &JointMatrices) -> Result<Rested, ReproduceError> {
    let round = |start: &JointMatrices| {
        update_in_two_steps(lines, JointModel::Full, start, Amplitudes::Logarithmic)
    };
    let mut last = round(start)?;
    let mut rounds = 1;
    while rounds < ROUNDS {
        let [before, _, after] = last.objective;
        if after < EXACT || before - after < REST * before {
            break;
        }
        last = round(&last.joint)?;
        rounds += 1;
    }
    Ok(Rested { last, rounds })
}

/// The joints at which the update rests, for each draw of the noise on the assembly.
pub(super) fn with_noise(
    draws: Repetition<'_>,
    lines: &Lines,
    start: &JointMatrices,
) -> Result<Vec<JointMatrices>, ReproduceError> {
    let noise = Pollution::Frf { level: LEVEL }.checked()?;
    Ok(draws.joints(|generator| {
        let noisy = noisy(lines, &noise, generator);
        Some(until_rest(&noisy, start).ok()?.last.joint)
    }))
}

/// The same lines with noise on the assembly.
pub(super) fn noisy(lines: &Lines, noise: &Pollution, generator: &mut Generator) -> Lines {
    Lines {
        assembly: polluted(&lines.assembly, noise, generator),
        ..lines.clone()
    }
}
