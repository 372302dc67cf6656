//! Saved states that this library never wrote, with the checksum that it would have written.

use super::{
    choices::Choices,
    lives,
    turn::{Mode, Subject},
};
use crate::raw::seal;

/// Number of bytes of the checksum.
pub(crate) const CHECKSUM: usize = 8;

/// Changes some of the content and makes the checksum right again.
pub(crate) fn forge(bytes: &mut [u8], choices: &mut Choices<'_>) {
    let before = bytes.to_vec();
    seal(bytes);
    assert_eq!(bytes, before, "the states have another checksum than this");
    let end = bytes.len() - CHECKSUM;
    for _ in 0..=choices.below(8) {
        let position = choices.bits() as usize % end;
        // whole numbers at once, or a single byte
        let replaced = if choices.one_in(2) {
            choices.any_number().to_le_bytes().to_vec()
        } else {
            vec![choices.below(256) as u8]
        };
        for (old, new) in bytes[position..end].iter_mut().zip(replaced) {
            *old = new;
        }
    }
    seal(bytes);
}

/// Restores a forged state, if it is accepted, and takes a few steps from it: whatever it says, nothing may break.
/// The instance is at its start values afterwards, unless the state was refused.
pub(crate) fn go_on_from(subject: &mut Subject, bytes: &[u8]) -> Vec<f64> {
    let values = lives::go_on_from(subject.raw, bytes);
    if !values.is_empty() {
        subject.mode = Some(Mode::Instantiated);
        subject.time_s = 0.0;
    }
    values
}
