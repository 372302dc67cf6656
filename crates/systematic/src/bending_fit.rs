//! How stiff and how heavy a beam is, by the functions that were measured along it.
//!
//! Where nothing acts on a piece its motion is a sum of four shapes, and a force at ξ adds C₃(|x − ξ|)/2EI ([`super::bending_shape`]).
//! So five motions along it are one too many: with the κ and EI that are the beam's own, one follows from the others. Each function
//! at each line says so, and what is left is weighted by the motions themselves, as their noise is.

use nalgebra::{DMatrix, DVector};

use super::bending_shape::Waves;
use super::experiment::ComplexMatrix;
use super::place::{Condition, Kind, Place};

/// Motions of which one follows from the others.
const MOTIONS: usize = 5;
/// Lines that are looked at, at most.
const MOST_LINES: usize = 100;
/// κ times the length of the longest piece at the last line: the range that is looked through, and its steps.
const RANGE: [f64; 2] = [0.5, 8.0];
const STEPS: usize = 40;
/// One with inertia is believed where one without leaves this many times the mean square of a motion more.
const TELLING: f64 = 20.0;

/// What five motions along a piece tell.
struct Window {
    conditions: Vec<Condition>,
}

/// How a beam bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beam {
    /// 1/EI, rad/(N·m²)
    pub(crate) flexibility: f64,
    /// ρA/EI, s²/m⁴
    pub(crate) inertia: f64,
}

impl Beam {
    /// One that does not bend.
    pub(crate) const RIGID: Self = Self {
        flexibility: 0.0,
        inertia: 0.0,
    };
}

/// The beam through these places, of which `motions` gives the receptances at a line; `flexibility` if it is known. `None` where
/// no piece has motions enough, and where they do not tell.
pub(crate) fn beam(
    places: &[Place],
    omega: &[f64],
    motions: impl Fn(usize) -> ComplexMatrix,
    flexibility: Option<f64>,
) -> Option<Beam> {
    let windows = windows(places);
    let length = windows.iter().map(Window::length).fold(0.0, f64::max);
    let last = omega.iter().copied().fold(0.0, f64::max);
    if !(length > 0.0 && last > 0.0) {
        return None;
    }
    let loads: Vec<(usize, f64)> = places
        .iter()
        .filter(|place| place.kind == Kind::Point)
        .map(|place| (place.translation, place.x_m))
        .collect();
    let stride = omega.len().div_ceil(MOST_LINES).max(1);
    let lines: Vec<(f64, ComplexMatrix)> = (0..omega.len())
        .step_by(stride)
        .map(|line| (omega[line], motions(line)))
        .collect();
    let left = |inertia: f64| {
        let mut left = Left::default();
        for (omega, motions) in &lines {
            let waves = Waves::new(inertia, *omega);
            for window in &windows {
                left.add(window, waves, motions, &loads);
            }
        }
        left
    };
    let inertia_of = |reach: f64| (reach / length).powi(4) / (last * last);
    let [from, to] = RANGE.map(f64::ln);
    let step = (to - from) / STEPS as f64;
    let costs: Vec<f64> = (0..=STEPS)
        .map(|i| {
            left(inertia_of((from + step * i as f64).exp()))
                .least(flexibility)
                .1
        })
        .collect();
    let best = (0..costs.len()).min_by(|&i, &j| costs[i].total_cmp(&costs[j]))?;
    let (before, after) = (costs.get(best.checked_sub(1)?)?, costs.get(best + 1)?);
    // the parabola through the three
    let bend = before - 2.0 * costs[best] + after;
    let shift = if bend > 0.0 {
        0.5 * (before - after) / bend
    } else {
        0.0
    };
    let inertia = inertia_of((from + step * (best as f64 + shift)).exp());
    let own = left(inertia);
    let (found, least) = own.least(flexibility);
    let (_, at_rest) = left(0.0).least(flexibility);
    let gain = (at_rest - least) / least * own.count as f64;
    let is_told = found.is_finite() && found > 0.0 && gain > TELLING;
    is_told.then_some(Beam {
        flexibility: found,
        inertia,
    })
}

/// Five motions side by side each, no bolt between them.
fn windows(places: &[Place]) -> Vec<Window> {
    let mut order: Vec<&Place> = places.iter().collect();
    order.sort_by(|one, other| one.x_m.total_cmp(&other.x_m));
    let is_bolt = |place: &Place| place.kind != Kind::Point;
    let mut pieces: Vec<Vec<&Place>> = vec![Vec::new()];
    for place in order {
        if let Some(piece) = pieces.last_mut() {
            piece.push(place);
        }
        if is_bolt(place) {
            pieces.push(vec![place]);
        }
    }
    let of_piece = |piece: &Vec<&Place>| -> Vec<Window> {
        let all = || piece.iter().flat_map(|place| place.conditions());
        let count = all().count();
        let first = 0..(count + 1).saturating_sub(MOTIONS);
        first
            .map(|first| Window {
                conditions: all().skip(first).take(MOTIONS).collect(),
            })
            .collect()
    };
    pieces.iter().flat_map(of_piece).collect()
}

impl Window {
    fn length(&self) -> f64 {
        let ends = self.conditions.first().zip(self.conditions.last());
        ends.map_or(0.0, |(first, last)| last.x_m - first.x_m)
    }

    /// Weights of the motions whose sum is zero on the four shapes.
    fn weights(&self, waves: Waves) -> Option<Vec<f64>> {
        let origin = self.conditions.first()?.x_m;
        let length = self.length();
        let bending = waves.anywhere();
        let of = |condition: &Condition, n: usize| condition.of_shape(n, origin, length, bending);
        let last = self.conditions.len() - 1;
        let system = DMatrix::from_fn(last, last, |n, i| of(&self.conditions[i], n));
        let right = DVector::from_fn(last, |n, _| of(&self.conditions[last], n));
        let solved = system.lu().solve(&right)?;
        Some(solved.iter().copied().chain([-1.0]).collect())
    }

    /// What a unit force at ξ does to each motion, for EI of one.
    fn by_load(&self, load_m: f64, waves: Waves) -> impl Iterator<Item = f64> {
        let bending = waves.anywhere();
        let conditions = self.conditions.iter();
        conditions.map(move |condition| condition.by_load(load_m, bending))
    }
}

/// Sums of what is left: c − 2 b/EI + a/EI².
#[derive(Clone, Copy, Debug, Default)]
struct Left {
    a: f64,
    b: f64,
    c: f64,
    /// Motions that follow from four others.
    count: usize,
}

impl Left {
    fn add(
        &mut self,
        window: &Window,
        waves: Waves,
        motions: &ComplexMatrix,
        loads: &[(usize, f64)],
    ) {
        let Some(weights) = window.weights(waves) else {
            return;
        };
        for column in 0..motions.ncols() {
            let own = window
                .conditions
                .iter()
                .map(|one| motions[(one.motion, column)]);
            if own.clone().any(|motion| motion.norm_sqr() == 0.0) {
                // was not measured
                continue;
            }
            let terms = own.zip(&weights).map(|(motion, weight)| motion * *weight);
            let power: f64 = terms.clone().map(|term| term.norm_sqr()).sum();
            let sum: num_complex::Complex64 = terms.sum();
            let load = loads.iter().find(|(motion, _)| *motion == column);
            let by_load = load.map_or(0.0, |(_, load_m)| {
                let there = window.by_load(*load_m, waves).zip(&weights);
                there.map(|(there, weight)| there * weight).sum()
            });
            if power > 0.0 && power.is_finite() {
                self.a += by_load * by_load / power;
                self.b += by_load * sum.re / power;
                self.c += sum.norm_sqr() / power;
                self.count += 1;
            }
        }
    }

    /// 1/EI that leaves least, if it is not known, and what it leaves.
    fn least(self, known: Option<f64>) -> (f64, f64) {
        let flexibility = known.unwrap_or(self.b / self.a);
        let left = self.c - 2.0 * self.b * flexibility + self.a * flexibility * flexibility;
        (flexibility, left)
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    const EI: f64 = 30.0;
    const INERTIA: f64 = 0.013;

    /// A beam without end: w″″ − κ⁴ w = δ/EI has w = −(e^(−κ|d|) + j e^(−jκ|d|))/4EIκ³, here with its first two derivatives by d.
    fn endless(d: f64, kappa: f64) -> [Complex64; 3] {
        let j = Complex64::i();
        let near = Complex64::from((-kappa * d.abs()).exp());
        let far = (-j * kappa * d.abs()).exp();
        let scale = -1.0 / (4.0 * EI * kappa.powi(3));
        let sign = d.signum();
        [
            (near + j * far) * scale,
            (-near + far) * (kappa * sign * scale),
            (near - j * far) * (kappa * kappa * scale),
        ]
    }

    /// A bolt, then points.
    fn places(points_m: &[f64]) -> Vec<Place> {
        let bolt = Place {
            x_m: 0.1,
            translation: 0,
            kind: Kind::Bolt { rotation: Some(1) },
        };
        let points = points_m.iter().enumerate().map(|(i, &x_m)| Place {
            x_m,
            translation: 2 + i,
            kind: Kind::Point,
        });
        std::iter::once(bolt).chain(points).collect()
    }

    fn receptances(places: &[Place], omega: f64) -> ComplexMatrix {
        let kappa = (INERTIA * omega * omega).powf(0.25);
        let motions: Vec<(f64, bool)> = places
            .iter()
            .flat_map(|place| match place.kind {
                Kind::Bolt { .. } => vec![(place.x_m, false), (place.x_m, true)],
                Kind::Point => vec![(place.x_m, false)],
            })
            .collect();
        ComplexMatrix::from_fn(motions.len(), motions.len(), |i, j| {
            let ((x, of_slope), (xi, by_moment)) = (motions[i], motions[j]);
            let [w, slope, curvature] = endless(x - xi, kappa);
            match (of_slope, by_moment) {
                (false, false) => w,
                (true, false) => slope,
                (false, true) => -slope,
                (true, true) => -curvature,
            }
        })
    }

    fn told(points_m: &[f64], flexibility: Option<f64>) -> Option<Beam> {
        let places = places(points_m);
        let omega: Vec<f64> = (1..=60).map(|i| f64::from(i) * 100.0).collect();
        let motions = |line: usize| receptances(&places, omega[line]);
        beam(&places, &omega, motions, flexibility)
    }

    #[test]
    fn a_beam_without_end_tells_its_own_stiffness_and_mass() {
        // four points and the bolt's rotation: two windows of five motions
        let found = told(&[0.15, 0.2, 0.27, 0.31], None).unwrap();
        assert!((found.flexibility * EI - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.inertia / INERTIA - 1.0).abs() < 0.02, "{found:?}");
        let known = told(&[0.15, 0.2, 0.27], Some(1.0 / EI)).unwrap();
        assert_eq!(known.flexibility, 1.0 / EI);
        assert!((known.inertia / INERTIA - 1.0).abs() < 0.02, "{known:?}");
    }

    #[test]
    fn too_few_motions_tell_nothing() {
        assert_eq!(told(&[0.15, 0.2], None), None);
        assert_eq!(told(&[], None), None);
    }
}
