//! Starts over the samples of a record for a law that slips, where what is read of it tells none.
//!
//! The first point is read behind half a window. A joint that sticks from there on seems to be linear, whatever it did before. So
//! laws that slip at several parts of the release are tried on the first periods, beside the joint of the last ones.

use std::borrow::Cow;
use std::sync::atomic::AtomicUsize;

use bolted_joint_identify::parallel;

use super::search::State;
use super::{Start, farthest_m};
use crate::response::backbone::{self, BackboneRun};
use crate::response::decay::motion::Release;
use crate::response::decay::recorded::Recorded;
use crate::response::fit::Data;
use crate::response::model::{Model, Values};
use crate::response::slider::{Slider, SliderValues};
use crate::response::study::LapResponseStudy;

/// Shares of the records that a law is tried on, one after the other.
const TRIED_ON: [f64; 2] = [0.06, 0.15];
/// Laws that are followed to their end, the best first, and how many times what the best leaves they may leave.
const FOLLOWED: usize = 3;
const WORSE: f64 = 10.0;

/// Starts, the best first; none of a law that does not slip. All of them together may take so many steps of motions.
pub(super) fn starts(
    (study, model): (&LapResponseStudy, &Model),
    runs: &[&BackboneRun],
    alone: &[(&BackboneRun, Cow<'_, Recorded>)],
    of_all: usize,
) -> Vec<Values> {
    let Some(slider) = model.terms.slider() else {
        return Vec::new();
    };
    let data = Data {
        lines: &[],
        backbones: runs,
    };
    let Some(base) = backbone::start(model, data, &study.known_values()) else {
        return Vec::new();
    };
    let farthest = alone.iter().map(|(run, record)| farthest_m(run, record));
    let released_m = farthest.fold(0.0, f64::max);
    let laws = laws(slider, base.relative_stiffness(), released_m).into_iter();
    let laws: Vec<SliderValues> = laws
        .filter(|law| law.stiffness() < base.joint_stiffness)
        .collect();
    let steps = of_all / laws.len().max(1);
    let tried = parallel::map_each(laws, |law| {
        let values = Values {
            slider: Some(law),
            ..base
        };
        let left = AtomicUsize::new(steps);
        tried(Start::of((study, model), values, alone, &left).ok()?)
    });
    let mut tried: Vec<(f64, Values)> = tried.into_iter().flatten().collect();
    tried.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let most = tried.first().map_or(0.0, |(least, _)| WORSE * least);
    let best = tried.into_iter().take(FOLLOWED);
    let best = best.filter(|(left, _)| *left <= most);
    best.map(|(_, values)| values).collect()
}

/// What a law leaves of the first periods after a few steps, per sample, and where these led.
fn tried(start: Start<'_>) -> Option<(f64, Values)> {
    let mut from = start.from;
    let mut left = f64::INFINITY;
    for share in TRIED_ON {
        let part = start.search.up_to(share);
        let courses = from.courses.iter();
        let releases: Vec<Release> = courses.map(|course| course.release).collect();
        from = part.improved(State::of(&part, from.values, &releases)?);
        left = from.chi_squared / part.samples().max(1) as f64;
    }
    left.is_finite().then_some((left, from.values))
}

/// Laws that lose small or large parts of the stiffness (N/m), early or late on the way to the release (m).
fn laws(slider: Slider, stiffness: f64, released_m: f64) -> Vec<SliderValues> {
    let mut all = Vec::new();
    match slider {
        Slider::Jenkins => {
            for part in [0.1, 0.3, 0.6] {
                for way in [0.15, 0.35, 0.7] {
                    let own = part * stiffness;
                    all.push(SliderValues::jenkins(
                        own,
                        own * way * released_m,
                        released_m,
                    ));
                }
            }
        }
        Slider::MicroSlip => {
            for part in [0.05, 0.15, 0.35] {
                for exponent in [-0.6, -0.2] {
                    let lost = part * stiffness;
                    all.push(SliderValues::iwan(
                        slider,
                        lost,
                        exponent,
                        [1.0, 1.0],
                        released_m,
                    ));
                }
            }
        }
        Slider::Iwan => {
            for part in [0.1, 0.3] {
                for span in [0.3, 0.8, 1.5] {
                    for exponent in [-0.5, 0.0] {
                        let lost = part * stiffness;
                        let rest = [span, 0.5];
                        all.push(SliderValues::iwan(slider, lost, exponent, rest, released_m));
                    }
                }
            }
        }
    }
    all
}
