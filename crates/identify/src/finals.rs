//! The best minima on few lines, refined on all that are used.

use std::sync::Arc;

use super::assessment::{Assessment, assess};
use super::data::{Data, Used};
use super::estimator::{Estimate, Free, estimate};
use super::layout::Place;
use super::noise::Noise;
use super::objective::Objective;
use super::trials::{best_trials, handicap, rank, same};

/// Where less than this part of the lines is used, it is seen whether the estimate itself could use more …
const FEW: f64 = 0.9;
/// … and by this factor they have to be more.
const MANY_MORE: f64 = 1.05;
/// By how much worse a minimum stands that nothing else makes up for.
const RULED_OUT: f64 = 100.0;

/// A minimum on thinned lines and where it lies on all of them, if it is one there.
pub(super) struct Final {
    candidate: Estimate,
    pub(super) end: Option<End>,
}

/// A minimum on all lines.
pub(super) struct End {
    pub(super) estimate: Estimate,
    pub(super) assessment: Assessment,
    /// See [`Objective::standing`]: on all lines that are used, once there is another minimum to compare it with.
    standing: Option<f64>,
    pub(super) has_corrections: bool,
}

impl Final {
    fn without_corrections(self) -> Self {
        let give_up = |end: End| End {
            estimate: end.estimate.without_corrections(),
            has_corrections: false,
            ..end
        };
        Self {
            end: self.end.map(give_up),
            ..self
        }
    }

    /// Whether it is beyond doubt on all lines, and `other` too far from it on the few, or no minimum.
    fn rules_out(&self, other: &Estimate) -> bool {
        let is_certain = |end: &End| end.estimate.converged && end.assessment.is_certain();
        let is_far = rank(other) - rank(&self.candidate) > RULED_OUT;
        self.end.as_ref().is_some_and(is_certain) && (is_far || !other.converged)
    }

    /// The −2 log-likelihood on the lines that all use, with a handicap for a search that has not come to rest.
    pub(super) fn rank(&self) -> f64 {
        let of_end = |end: &End| end.estimate.misfit + handicap(&end.estimate);
        self.end.as_ref().map_or(f64::INFINITY, of_end)
    }
}

/// Minima on the lines that are used, best first.
pub(super) struct Finals {
    pub(super) used: Arc<Used>,
    pub(super) best_first: Vec<Final>,
}

impl Finals {
    pub(super) fn best(&self) -> Option<&End> {
        self.best_first.first()?.end.as_ref()
    }

    /// Whether an estimate on few lines leads to `best` on all of them.
    pub(super) fn leads_to(&self, trial: &Estimate, best: &Estimate) -> bool {
        let is_best = |end: &End| same(&end.estimate, best);
        let known =
            |one: &Final| same(&one.candidate, trial) && one.end.as_ref().is_some_and(is_best);
        self.best_first.iter().any(known)
    }
}

/// As [`finalists`] on the lines that the best of them can use; `None` without trials.
pub(super) fn finalists_of_own_lines(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    trials: &[Estimate],
    known: Option<Finals>,
) -> Option<Finals> {
    let mut near = best_trials(trials).first().copied()?.clone();
    let mut finals = match known {
        Some(known) => {
            near = known.best_first.first()?.candidate.clone();
            finalists(
                &Arc::clone(&known.used),
                entries,
                noise,
                trials,
                Some(known),
            )
        }
        None => finalists(
            &data.used_near(entries, near.place()),
            entries,
            noise,
            trials,
            None,
        ),
    };
    // What looks best on few lines need not be best on all, and can use other lines; a trial that errs much in the joint or the
    // level of noise can use few.
    if let Some(best) = finals.best()
        && data.has_errors()
    {
        let is_another = !finals.leads_to(&near, &best.estimate);
        let count = finals.used.count() as f64;
        if is_another || count < FEW * data.lines() as f64 {
            let used = data.used_near(entries, best.estimate.place());
            if is_another || used.count() as f64 > MANY_MORE * count {
                let others = finalists(&used, entries, noise, trials, None);
                let comes_to_rest = |finals: &Finals| {
                    let best = finals.best();
                    best.is_some_and(|best| best.estimate.converged)
                };
                if is_another || comes_to_rest(&others) {
                    finals = others;
                }
            }
        }
    }
    Some(finals)
}

/// Takes the minima away beside which another one stands so much better that they are none.
fn rule_out(finals: &mut [Final], whole: &Objective<'_>, noise: &Noise) {
    let ends = || finals.iter().filter(|one| one.end.is_some());
    if ends().count() < 2 {
        return;
    }
    let mut best = f64::INFINITY;
    for end in finals.iter_mut().filter_map(|one| one.end.as_mut()) {
        let standing = end
            .standing
            .unwrap_or_else(|| whole.standing(&end.estimate, noise));
        end.standing = Some(standing);
        best = best.min(standing + handicap(&end.estimate));
    }
    for one in finals {
        let is_behind = |standing: f64| standing - best > RULED_OUT;
        one.end.take_if(|end| end.standing.is_some_and(is_behind));
    }
}

/// The best few different `trials` on the lines that are used, best first; `known` are those of fewer trials.
pub(super) fn finalists(
    used: &Arc<Used>,
    entries: &[Place],
    noise: &Noise,
    trials: &[Estimate],
    known: Option<Finals>,
) -> Finals {
    let mut known = known.map_or_else(Vec::new, |known| known.best_first);
    let whole = used.assemblies.objective(entries).as_searched();
    // Thinned lines may have passed over the resonances that tell two minima apart.
    let mut finals: Vec<Final> = Vec::new();
    // The corrections of all of them would be much memory: those of the last one are kept.
    for candidate in best_trials(trials) {
        if finals.iter().any(|one| one.rules_out(candidate)) {
            continue;
        }
        let is_it = |end: &Final| same(&end.candidate, candidate);
        if let Some(place) = known.iter().position(is_it) {
            finals.push(Final {
                candidate: candidate.clone(),
                ..known.swap_remove(place)
            });
            continue;
        }
        finals = finals.into_iter().map(Final::without_corrections).collect();
        known = known.into_iter().map(Final::without_corrections).collect();
        let start = &candidate.unknowns;
        let found = estimate(&whole, noise, None, &Free, start, None);
        finals.push(Final {
            candidate: candidate.clone(),
            end: found.and_then(|estimate| {
                let assessment = assess(&whole, &estimate, noise)?;
                Some(End {
                    estimate,
                    assessment,
                    standing: None,
                    has_corrections: !whole.holds,
                })
            }),
        });
    }
    if !whole.is_independent() {
        rule_out(&mut finals, &whole, noise);
    }
    finals.sort_by(|a, b| a.rank().total_cmp(&b.rank()));
    Finals {
        used: Arc::clone(used),
        best_first: finals,
    }
}
