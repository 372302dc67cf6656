//! Which run is not like the others, and which slip would explain a misfit: runs are left out in turn, and likely slips are undone.
//!
//! A run in another unit draws the estimate towards itself, so that all runs seem to be off. Without it the others agree, and it
//! stands far from what they have in common.

mod late;

use std::fmt;

use self::late::Late;
use super::backbone::BackboneRun;
use super::data::{SineLine, SineRun, Use, wrapped};
use super::fit::{self, Data, Fit, Kind, chi_squared_at};
use super::model::{Model, ResponseUnknown, Values};
use super::slip::{Quantity, Slip};
use super::start;
use super::study::LapResponseStudy;

/// By how many times χ² per degree of freedom has to fall for a run to be left out, or a slip to be undone.
const FALLS: f64 = 9.0;
/// Runs of which each can be looked at beside the others, and the most of which searches begin anew.
const FEWEST: usize = 3;
const MOST_SEARCHED: usize = 8;
/// χ² per number that is rounding.
const ROUNDING: f64 = 1e-12;
/// Part by which a number is what a slip makes of it.
const NEAR: f64 = 0.1;

/// What may be behind a misfit.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Misfit {
    /// A run that leaves much more than the others.
    pub(super) run: Option<OddRun>,
    /// A slip of all runs, and how many times the noise would be left without it.
    pub(super) slip: Option<(Slip, f64)>,
    /// A delay of all responses.
    late: Option<Late>,
}

/// A run that is not like the others.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OddRun {
    pub(super) name: String,
    /// What it leaves in what the others leave.
    pub(super) times: f64,
    /// What seems to be wrong with it, and what it would leave without, in what the others leave.
    pub(super) cause: Option<(Cause, f64)>,
}

/// What is wrong with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cause {
    /// Its numbers.
    Slip(Slip),
    /// The responses are so late, s.
    Delay(f64),
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slip(slip) => f.write_str(slip.words),
            Self::Delay(late_s) => write!(f, "a delay of {:.2} ms", 1e3 * late_s),
        }
    }
}

impl Misfit {
    /// In sentences.
    pub(super) fn told(&self) -> Vec<String> {
        let of_run = self.run.as_ref().map(|run| {
            let why = match &run.cause {
                Some((cause, times)) => format!(
                    "it seems to have {cause}, without which it would leave {times:.1} times what they leave"
                ),
                None => "look at its units, at peak or r.m.s., at its phase and its delay, or the law does not hold for its amplitudes"
                    .to_owned(),
            };
            format!(
                "{} leaves {:.0} times what the other runs leave, which agree with each other without it: {why}",
                run.name, run.times
            )
        });
        let of_all = self.slip.as_ref().map(|(slip, times)| {
            format!(
                "the data seem to have {}, without which the law would leave {times:.1} times the noise",
                slip.words
            )
        });
        let of_late = self.late.map(|late| late.told());
        of_run.into_iter().chain(of_all).chain(of_late).collect()
    }
}

/// The data of some runs.
struct Runs<'a> {
    lines: Vec<SineLine>,
    sines: Vec<&'a SineRun>,
    backbones: Vec<&'a BackboneRun>,
}

impl<'a> Runs<'a> {
    fn of(sines: Vec<&'a SineRun>, backbones: Vec<&'a BackboneRun>) -> Self {
        let lines = sines.iter().flat_map(|run| &run.lines);
        Self {
            lines: lines.copied().collect(),
            sines,
            backbones,
        }
    }

    fn data(&self) -> Data<'_> {
        Data {
            lines: &self.lines,
            backbones: &self.backbones,
        }
    }
}

/// A fit, with the model that all runs were fitted with.
struct Search<'a> {
    study: &'a LapResponseStudy,
    model: Model,
}

impl Search<'_> {
    /// The best fit to some runs: from another one, or from the starts that they suggest.
    fn fitted(&self, runs: &Runs<'_>, from: &Values) -> Option<Fit> {
        let (model, noise) = (&self.model, &self.study.noise);
        fit::fit(model, runs.data(), noise, from, Kind::Passive).ok()
    }

    fn anew(&self, runs: &Runs<'_>) -> Option<Fit> {
        let known = self.study.known_values();
        let noise = &self.study.noise;
        let found = start::best(
            &self.model,
            &runs.sines,
            &runs.backbones,
            noise,
            &known,
            Kind::Passive,
        );
        found.ok().map(|(fit, ..)| fit)
    }

    /// χ² per number of runs at values that were fitted to others.
    fn left_of(&self, runs: &Runs<'_>, values: &Values) -> f64 {
        let data = runs.data();
        let chi_squared = chi_squared_at(&self.model, data, &self.study.noise, values);
        (chi_squared / data.count().max(1) as f64).max(ROUNDING)
    }
}

impl Search<'_> {
    /// What is wrong with a run that leaves so much at these values, where others leave a `level`.
    fn cause(
        &self,
        run: &Runs<'_>,
        values: &Values,
        [left, level]: [f64; 2],
    ) -> Option<(Cause, f64)> {
        let of_slip = |slip: Slip| {
            let curves = undone_in(&slip, &run.backbones)?;
            let lines = run.lines.iter().map(|line| slip.undone_in_line(line));
            let undone = Runs {
                lines: lines.collect(),
                sines: Vec::new(),
                backbones: curves.iter().collect(),
            };
            Some((Cause::Slip(slip), self.left_of(&undone, values)))
        };
        let slips = Slip::ALL.into_iter().filter_map(of_slip);
        let all = slips.chain(self.delay(run, values));
        let enough = all.filter(|(_, now)| now * FALLS < left);
        let best = enough.min_by(|(_, one), (_, other)| one.total_cmp(other))?;
        Some((best.0, (best.1 / level).sqrt()))
    }

    /// The delay that explains most of the phases of a sine, and what is left without it.
    fn delay(&self, run: &Runs<'_>, values: &Values) -> Option<(Cause, f64)> {
        (!run.lines.is_empty()).then_some(())?;
        let (mut sum, mut squares) = (0.0, 0.0);
        for line in &run.lines {
            let amplitude_m = self.model.relative_amplitude(values, line);
            let (computed, _) = self.model.receptance(values, amplitude_m, line.omega);
            sum -= line.omega * wrapped(line.phase_rad - computed.arg());
            squares += line.omega * line.omega;
        }
        let late_s = sum / squares;
        let lines = run.lines.iter().map(|line| SineLine {
            phase_rad: wrapped(line.phase_rad + line.omega * late_s),
            ..*line
        });
        let undone = Runs {
            lines: lines.collect(),
            sines: Vec::new(),
            backbones: Vec::new(),
        };
        Some((Cause::Delay(late_s), self.left_of(&undone, values)))
    }
}

fn per_freedom(fit: &Fit) -> f64 {
    fit.reduced_chi_squared().max(ROUNDING)
}

/// Looks for what is behind a misfit of an estimate.
pub(super) fn misfit(study: &LapResponseStudy, model: &Model, estimate: &Fit) -> Misfit {
    let search = Search {
        study,
        model: Model {
            harmonics: 1,
            ..model.clone()
        },
    };
    let run = odd_run(&search, estimate);
    let slip = match run {
        None => slip_of_all(&search, estimate),
        Some(_) => None,
    };
    let late = match (&run, &slip) {
        (None, None) => late::of_all(&search, estimate),
        _ => None,
    };
    Misfit { run, slip, late }
}

/// The runs that were fitted.
fn fitted_runs(study: &LapResponseStudy) -> (Vec<&SineRun>, Vec<&BackboneRun>) {
    let sines = study.sines.iter().filter(|run| run.used_for == Use::Fit);
    let curves = study.backbones.iter();
    let curves = curves.filter(|run| run.used_for == Use::Fit);
    (sines.collect(), curves.collect())
}

/// Runs without the one at a place, and that one; sines come first.
fn without<'a>(
    sines: &[&'a SineRun],
    curves: &[&'a BackboneRun],
    place: usize,
) -> (Runs<'a>, Runs<'a>) {
    let own = |n: usize| n == place;
    let (mut first, mut others) = (Vec::new(), Vec::new());
    for (n, run) in sines.iter().enumerate() {
        let side = if own(n) { &mut first } else { &mut others };
        side.push(*run);
    }
    let (mut curve, mut other_curves) = (Vec::new(), Vec::new());
    for (n, run) in curves.iter().enumerate() {
        let side = match own(sines.len() + n) {
            true => &mut curve,
            false => &mut other_curves,
        };
        side.push(*run);
    }
    (Runs::of(others, other_curves), Runs::of(first, curve))
}

/// The run without which the others agree.
fn odd_run(search: &Search<'_>, estimate: &Fit) -> Option<OddRun> {
    let (sines, curves) = fitted_runs(search.study);
    let count = sines.len() + curves.len();
    if count < FEWEST {
        return None;
    }
    let whole = per_freedom(estimate);
    let agrees = |fit: &Fit| per_freedom(fit) * FALLS < whole;
    let best = |anew: bool| {
        let each = (0..count).filter_map(|place| {
            let (others, _) = without(&sines, &curves, place);
            let fit = match anew {
                true => search.anew(&others)?,
                false => search.fitted(&others, &estimate.values)?,
            };
            Some((place, fit)).filter(|(_, fit)| agrees(fit))
        });
        each.min_by(|(_, one), (_, other)| per_freedom(one).total_cmp(&per_freedom(other)))
    };
    let found = best(false);
    let anew = || match count <= MOST_SEARCHED {
        true => best(true),
        false => None,
    };
    let (place, fit) = found.or_else(anew)?;
    let (others, own) = without(&sines, &curves, place);
    let searched = (count <= MOST_SEARCHED).then(|| search.anew(&others));
    let fit = match searched.flatten() {
        Some(anew) if anew.chi_squared < fit.chi_squared => anew,
        _ => fit,
    };
    let level = per_freedom(&fit);
    let left = search.left_of(&own, &fit.values);
    let name = match (own.sines.first(), own.backbones.first()) {
        (Some(run), _) => run.name.clone(),
        (None, Some(run)) => run.name.clone(),
        (None, None) => return None,
    };
    Some(OddRun {
        name,
        times: (left / level).sqrt(),
        cause: search.cause(&own, &fit.values, [left, level]),
    })
    .filter(|run| run.times * run.times > FALLS)
}

/// Curves without a slip; `None` where one of them is a record, of which points are not all.
fn undone_in(slip: &Slip, curves: &[&BackboneRun]) -> Option<Vec<BackboneRun>> {
    let each = curves.iter().map(|run| {
        let points = run.lines.iter().map(|point| slip.undone_in_point(point));
        let undone = BackboneRun {
            lines: points.collect(),
            ..(*run).clone()
        };
        run.recorded.is_none().then_some(undone)
    });
    each.collect()
}

/// A slip of all runs: of the damping of curves; and of responses or forces, where a mass is stated that they do not have.
fn slip_of_all(search: &Search<'_>, estimate: &Fit) -> Option<(Slip, f64)> {
    let (sines, curves) = fitted_runs(search.study);
    let whole = per_freedom(estimate);
    let of_damping = Slip::ALL
        .into_iter()
        .filter(|slip| slip.of == Quantity::Damping && sines.is_empty())
        .filter_map(|slip| {
            let curves = undone_in(&slip, &curves)?;
            let runs = Runs::of(Vec::new(), curves.iter().collect());
            let fits = [search.anew(&runs), search.fitted(&runs, &estimate.values)];
            let left = fits.into_iter().flatten().map(|fit| per_freedom(&fit));
            Some((slip, left.reduce(f64::min)?))
        });
    let known = search.study.known_values();
    // z = F/x is in proportion to all that is unknown of it
    let of_scale = || {
        let mut model = search.model.clone();
        let is_open = model.unknowns.contains(&ResponseUnknown::Mass);
        if is_open || sines.is_empty() {
            return None;
        }
        model.unknowns.insert(0, ResponseUnknown::Mass);
        let free = Search {
            study: search.study,
            model,
        };
        let runs = Runs::of(sines.clone(), curves.clone());
        let fit = free.anew(&runs)?;
        let times = known.mass / fit.values.mass;
        // too large a response makes too small a mass, and so does too small a force
        let is_near = |slip: &Slip| {
            let own = match slip.of {
                Quantity::Response => slip.times,
                Quantity::Force => slip.times.recip(),
                Quantity::Damping => return false,
            };
            (times / own - 1.0).abs() < NEAR
        };
        let slip = Slip::ALL.into_iter().find(is_near)?;
        Some((slip, per_freedom(&fit)))
    };
    let all = of_damping.chain(of_scale());
    let best = all.min_by(|(_, one), (_, other)| one.total_cmp(other))?;
    let (slip, left) = best;
    (left * FALLS < whole).then(|| (slip, left.sqrt()))
}
