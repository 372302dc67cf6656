//! The steps that work says it is in, as the words beside the time that has passed.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use bolted_joint_wanted::{Listener, Pieces};
use indicatif::HumanDuration;

/// Steps within each other that a line has room for: the outer ones last longest.
const SHOWN: usize = 2;

/// The steps that have begun and not ended, the outer ones first.
#[derive(Default)]
pub(super) struct Steps(Mutex<Vec<Running>>);

struct Running {
    name: &'static str,
    pieces: Pieces,
    done: usize,
    /// What those that are done weigh.
    weight: usize,
    since: Instant,
}

impl Steps {
    fn change(&self, change: impl FnOnce(&mut Vec<Running>)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// What is done of each, and how long it takes yet where that can be told; empty without steps.
    pub(super) fn words(&self, now: Instant) -> String {
        let mut text = String::new();
        self.change(|steps| {
            for (number, step) in steps.iter().take(SHOWN).enumerate() {
                let before = if number == 0 { ", " } else { "; " };
                text += before;
                text += &step.words(now);
            }
        });
        text
    }
}

impl Listener for Steps {
    fn begun(&self, depth: usize, name: &'static str, pieces: Pieces) {
        self.change(|steps| {
            steps.truncate(depth);
            steps.push(Running {
                name,
                pieces,
                done: 0,
                weight: 0,
                since: Instant::now(),
            });
        });
    }

    fn done(&self, depth: usize, pieces: usize, weight: usize) {
        self.change(|steps| {
            if let Some(step) = steps.get_mut(depth) {
                step.done += pieces;
                step.weight += weight;
            }
        });
    }

    fn ended(&self, depth: usize) {
        self.change(|steps| steps.truncate(depth));
    }
}

impl Running {
    fn words(&self, now: Instant) -> String {
        let (name, done) = (self.name, self.done);
        let (count, weight) = match self.pieces {
            Pieces::Unknown if done == 0 => return name.to_owned(),
            Pieces::Unknown => return format!("{name} {done}"),
            // where it ends early nobody knows how much is left
            Pieces::AtMost(count) => return format!("{name} {done} of at most {count}"),
            Pieces::Exactly(count) => (count, count),
            Pieces::Weighed { count, weight } => (count, weight),
        };
        let passed = now.saturating_duration_since(self.since);
        let left = left(passed, self.weight, weight);
        let left = left.map(|left| format!(", {:#} left", HumanDuration(left)));
        format!("{name} {done} of {count}{}", left.unwrap_or_default())
    }
}

/// How long the rest takes, if it takes as long for its weight as what is done did; `None` before something is.
fn left(passed: Duration, done: usize, all: usize) -> Option<Duration> {
    let of_each = (done > 0).then(|| passed.as_secs_f64() / done as f64)?;
    Duration::try_from_secs_f64(of_each * all.saturating_sub(done) as f64).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_takes_as_long_a_piece_as_what_is_done() {
        let steps = Steps::default();
        assert_eq!(steps.words(Instant::now()), "");
        steps.begun(0, "laws", Pieces::Exactly(5));
        assert_eq!(steps.words(Instant::now()), ", laws 0 of 5");
        steps.done(0, 2, 2);
        // 30 s for two: three more take 45 s
        let later = |steps: &Steps| {
            let since = steps.0.lock().unwrap()[0].since;
            steps.words(since + Duration::from_secs(30))
        };
        assert_eq!(later(&steps), ", laws 2 of 5, 45s left");
        steps.begun(1, "searches", Pieces::AtMost(7));
        steps.done(1, 1, 1);
        assert_eq!(
            later(&steps),
            ", laws 2 of 5, 45s left; searches 1 of at most 7"
        );
        steps.begun(2, "too deep to be shown", Pieces::Unknown);
        assert!(later(&steps).ends_with("of at most 7"));
        steps.begun(1, "rounds", Pieces::Unknown);
        assert!(later(&steps).ends_with("; rounds"));
        steps.done(1, 1, 1);
        assert!(later(&steps).ends_with("; rounds 1"));
        steps.ended(1);
        assert_eq!(later(&steps), ", laws 2 of 5, 45s left");
        let (count, weight) = (3, 20);
        steps.begun(0, "laws", Pieces::Weighed { count, weight });
        steps.done(0, 2, 15);
        assert_eq!(later(&steps), ", laws 2 of 3, 10s left");
        steps.ended(0);
        assert_eq!(steps.words(Instant::now()), "");
    }
}
