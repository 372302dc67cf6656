//! Following a curve of solutions step by step along its own length, through folds.
//!
//! E. Riks, An incremental approach to the solution of snapping and buckling problems, Int. J. Solids Struct. 15 (1979)
//! 529–551; H. B. Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems, in: Applications of Bifurcation
//! Theory, Academic Press, 1977. Each step goes along the tangent and returns to the curve across it. Lengths are relative:
//! the change of the motion over its size, and that of the frequency over a part of the range.

use nalgebra::DVector;

use super::system::{Closing, Scale, System};
use super::{HarmonicError, Observed, Side, Solution};

/// How a curve is followed. Lengths are relative changes of the motion; a tenth of the frequency range counts as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// Length of the first step.
    pub first: f64,
    /// Shortest step that is tried before giving up.
    pub shortest: f64,
    /// Longest step.
    pub longest: f64,
    /// Most points on a curve.
    pub most: usize,
}

impl Default for Steps {
    fn default() -> Self {
        Self {
            first: 0.02,
            shortest: 1e-9,
            longest: 0.1,
            most: 20_000,
        }
    }
}

/// Iterations of a correction that make the next step neither longer nor shorter, and the most before a step is shortened.
const USUAL_ITERATIONS: f64 = 3.0;
const MOST_ITERATIONS: usize = 8;
/// Smallest cosine of the angle between the tangents of neighbouring points.
const SMALLEST_COSINE: f64 = 0.95;
/// Steps so short may turn more where a law slips.
const AT_A_CORNER: f64 = 1e-3;
/// Relative change of the bodies' common motion in one step, in longest steps.
const CARRIED: f64 = 2.0;
/// Common motion below this part of the relative one is of no account.
const OF_RELATIVE: f64 = 1e-3;
/// Part of a step within which a fold is located, and the most trials for that.
const FOLD_WITHIN: f64 = 1e-10;
const MOST_TRIALS: usize = 60;

/// What the curve runs in, and how far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// A point of a curve.
#[derive(Clone, Debug)]
pub(super) struct Followed<const D: usize> {
    pub(super) solution: Solution<D>,
    /// Whether the frequency turns here.
    pub(super) is_fold: bool,
}

/// A point with the direction of the curve there.
#[derive(Clone, Debug)]
struct Place {
    unknowns: Vec<f64>,
    scale: Scale,
    /// Scaled, of length one.
    tangent: DVector<f64>,
}

impl<const D: usize> System<'_, D> {
    /// The curve from a solution on, in the direction in which `monitor` moves from the first to the second of its ends, until
    /// it leaves the range between them. `close` gives the last point, at an end.
    pub(super) fn follow(
        &mut self,
        start: Vec<f64>,
        [from, to]: [f64; 2],
        steps: &Steps,
        monitor: &dyn Fn(&Self, &[f64]) -> f64,
        close: &dyn Fn(f64) -> Closing<'static>,
    ) -> Result<Vec<Followed<D>>, HarmonicError> {
        let range = Range {
            low: from.min(to),
            high: from.max(to),
        };
        let mut place = self.begin(start, monitor, to - from)?;
        let mut points = vec![Followed {
            solution: self.solution(&place.unknowns),
            is_fold: false,
        }];
        let mut length = steps.first.min(steps.longest);
        while points.len() < steps.most {
            bolted_joint_wanted::look();
            let Some((next, iterations)) = self.step(&place, length) else {
                length *= 0.5;
                if length < steps.shortest {
                    return Err(HarmonicError::Stuck {
                        frequency_hz: self.frequency_hz(&place),
                        points: points.len(),
                    });
                }
                continue;
            };
            // A mode in which the joint does not move is not in the unknowns, but it is in what sensors on the bodies see.
            let carried = self.carried(&place.unknowns, &next.unknowns) / (CARRIED * steps.longest);
            if carried > 1.0 && length > steps.shortest {
                length = (length * (0.8 / carried).max(0.1)).max(steps.shortest);
                continue;
            }
            let value = monitor(self, &next.unknowns);
            let omega = self.balance.size();
            // The tangent at the fold has no share along the frequency.
            if place.tangent[omega] * next.tangent[omega] < 0.0
                && let Some(fold) = self.fold(&place, &next, length)
                && (range.low..=range.high).contains(&monitor(self, &fold.unknowns))
            {
                points.push(Followed {
                    solution: self.solution(&fold.unknowns),
                    is_fold: true,
                });
            }
            if !(range.low..=range.high).contains(&value) {
                let end = if value > range.high {
                    range.high
                } else {
                    range.low
                };
                let mut unknowns = next.unknowns;
                if self
                    .correct(
                        &mut unknowns,
                        &close(end),
                        &next.scale,
                        MOST_ITERATIONS,
                        true,
                    )
                    .is_some()
                {
                    points.push(Followed {
                        solution: self.solution(&unknowns),
                        is_fold: false,
                    });
                }
                return Ok(points);
            }
            points.push(Followed {
                solution: self.solution(&next.unknowns),
                is_fold: false,
            });
            let faster = (USUAL_ITERATIONS / iterations as f64).clamp(0.5, 1.5);
            let faster = faster.min((0.8 / carried).max(0.2));
            length = (length * faster).clamp(steps.shortest, steps.longest);
            place = next;
        }
        Err(HarmonicError::TooLong {
            frequency_hz: self.frequency_hz(&place),
            points: points.len(),
        })
    }

    /// Largest relative change of the bodies' common motion, x_a + x_b at the fundamental, between two points.
    fn carried(&self, from: &[f64], to: &[f64]) -> f64 {
        let common = |unknowns: &[f64], dof: usize| {
            let sides = [Side::A, Side::B].map(|side| Observed::Body(side, dof));
            let [a, b] = sides.map(|observed| self.observe(observed, unknowns).value);
            a + b
        };
        let relative = |dof: usize| self.observe(Observed::Relative(dof), to).value.norm();
        let change = |dof: usize| {
            let (from, to) = (common(from, dof), common(to, dof));
            let size = from.norm().max(to.norm()).max(OF_RELATIVE * relative(dof));
            if size > 0.0 {
                (to - from).norm() / size
            } else {
                0.0
            }
        };
        (0..D).map(change).fold(0.0, f64::max)
    }

    fn frequency_hz(&self, place: &Place) -> f64 {
        place.unknowns[self.balance.size()] / std::f64::consts::TAU
    }

    /// The first point, with the tangent that makes the monitor move as asked.
    fn begin(
        &mut self,
        unknowns: Vec<f64>,
        monitor: &dyn Fn(&Self, &[f64]) -> f64,
        direction: f64,
    ) -> Result<Place, HarmonicError> {
        let scale = self.scale(&unknowns);
        let total = self.size();
        // The null vector of the equations: with each unknown held in turn, until the rest follows it.
        for held in (0..total).rev() {
            let mut across = DVector::zeros(total);
            across[held] = 1.0;
            let closing = Closing::Plane {
                through: &unknowns,
                across: &across,
            };
            let (matrix, _) = self.linearise(&unknowns, &closing, &scale);
            let Some(mut tangent) = matrix.lu().solve(&last_unit(total)) else {
                continue;
            };
            let norm = tangent.norm();
            if !norm.is_finite() || norm > 1e8 {
                continue;
            }
            tangent /= norm;
            // A short way along it tells the direction.
            let small = 1e-6;
            let ahead: Vec<f64> = moved(&unknowns, &scale, &tangent, small);
            let change = monitor(self, &ahead) - monitor(self, &unknowns);
            if change * direction < 0.0 {
                tangent = -tangent;
            }
            return Ok(Place {
                unknowns,
                scale,
                tangent,
            });
        }
        Err(super::solution::not_found(unknowns[self.balance.size()], 1))
    }

    /// The point a step away, and the iterations that it took; `None` if there is none near or the curve turns too much.
    fn step(&mut self, place: &Place, length: f64) -> Option<(Place, usize)> {
        let predicted = moved(&place.unknowns, &place.scale, &place.tangent, length);
        let mut unknowns = predicted.clone();
        let closing = Closing::Plane {
            through: &predicted,
            across: &place.tangent,
        };
        let (iterations, factors) =
            self.correct(&mut unknowns, &closing, &place.scale, MOST_ITERATIONS, true)?;
        let mut tangent = factors.solve(&last_unit(self.size()))?;
        let norm = tangent.norm();
        tangent /= norm;
        // Where a slider begins to slip the curve has a corner: it turns however short the step is.
        let may_turn = self.balance.slipping.is_some() && length < AT_A_CORNER;
        let turns = tangent.dot(&place.tangent) < SMALLEST_COSINE;
        if !norm.is_finite() || turns && !may_turn {
            return None;
        }
        // the same direction in the sizes of the new point
        let scale = self.scale(&unknowns);
        for (n, entry) in tangent.iter_mut().enumerate() {
            *entry *= place.scale.unknown[n] / scale.unknown[n];
        }
        let norm = tangent.norm();
        tangent /= norm;
        let next = Place {
            unknowns,
            scale,
            tangent,
        };
        Some((next, iterations))
    }

    /// The point between two where the tangent has no share along the frequency, by the regula falsi with halved weights
    /// ("Illinois").
    fn fold(&mut self, before: &Place, after: &Place, length: f64) -> Option<Place> {
        let omega = self.balance.size();
        let (mut low, mut high) = (0.0, length);
        let (mut at_low, mut at_high) = (before.tangent[omega], after.tangent[omega]);
        let mut last_side = 0;
        let mut best = None;
        for _ in 0..MOST_TRIALS {
            let trial = (low * at_high - high * at_low) / (at_high - at_low);
            let (place, _) = self.step(before, trial)?;
            let share = place.tangent[omega];
            let side = if share * at_high > 0.0 { 1 } else { -1 };
            if side > 0 {
                (high, at_high) = (trial, share);
                if last_side == side {
                    at_low *= 0.5;
                }
            } else {
                (low, at_low) = (trial, share);
                if last_side == side {
                    at_high *= 0.5;
                }
            }
            last_side = side;
            best = Some(place);
            if share.abs() < FOLD_WITHIN || high - low < FOLD_WITHIN * length {
                break;
            }
        }
        best
    }
}

fn last_unit(total: usize) -> DVector<f64> {
    let mut unit = DVector::zeros(total);
    unit[total - 1] = 1.0;
    unit
}

fn moved(unknowns: &[f64], scale: &Scale, tangent: &DVector<f64>, length: f64) -> Vec<f64> {
    let sizes = scale.unknown.iter().zip(tangent.iter());
    let steps = sizes.map(|(size, share)| length * size * share);
    unknowns
        .iter()
        .zip(steps)
        .map(|(value, step)| value + step)
        .collect()
}
