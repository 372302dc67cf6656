//! Whether an assembly is stiffer than its substructures with a rigid joint: something that no joint makes of them.
//!
//! Of a free B the large motions as a whole cancel in what it yields with A, and its noise, which does not, can be larger than what
//! is left. So the lines are taken together, each by its noise, and their sum counts beyond what noise and gains of channels make.

use bolted_joint_frf::structure::{ComplexMatrix, Partition};
use bolted_joint_systematic::Budget;
use nalgebra::DVector;
use num_complex::Complex64;

use super::super::group::Side;
use super::super::lines::Lines;
use super::super::noise::{Noise, Of, Size};
use super::super::receptances::Receptances;
use super::super::roughness::Roughness;

/// Below the first resonance an assembly that yields less than this part of what it would with a rigid joint is none of A and B.
const OF_RIGID: f64 = 0.6;
/// Lines below the first resonance that are enough to tell.
const ENOUGH_LINES: usize = 3;
/// Lines that are asked.
const ASKED: usize = 200;
/// Standard deviations that noise and gains do not make.
const CERTAIN: f64 = 4.0;
/// Numbers have rounding, at least.
const ROUNDING: f64 = 1e-9;

/// What is known of the errors of what was measured.
#[derive(Clone, Copy)]
pub(super) struct Errors<'e> {
    pub(super) noise: &'e Noise,
    pub(super) budget: &'e Budget,
}

/// What the assembly yields at each of its points that is stiffer there, by number, as a part of what it would with a rigid joint.
///
/// A joint in between adds compliance: as long as equally many modes lie below a line, H^C(K*) − H^C(∞) is positive semidefinite
/// there, without damping.
pub(super) fn points(lines: &Lines, errors: Errors<'_>) -> Vec<(usize, f64)> {
    let sides = [(Side::A, &lines.a), (Side::B, &lines.b)];
    let sides = sides.map(|(side, receptances)| Variances::of(side, receptances, errors.noise));
    let of_assembly = of_assembly(lines, errors.noise);
    let of_point = |point: usize| {
        let index = lines.measured.iter().position(|own| *own == (point, point));
        let own = of_assembly.get(index?)?;
        let part = of_rigid(lines, point, own, &sides, errors.budget)?;
        Some((point, part))
    };
    (0..lines.points.len()).filter_map(of_point).collect()
}

/// `None` where it is not stiffer, or where nobody can tell.
fn of_rigid(
    lines: &Lines,
    point: usize,
    of_measured: &[f64],
    sides: &[Option<Variances>; 2],
    budget: &Budget,
) -> Option<f64> {
    let mut sums = Sums::default();
    let mut of_channels = sides.each_ref().map(|side| {
        let channels = side.as_ref().map_or(0, |side| side.channels);
        DVector::<f64>::zeros(channels)
    });
    let mut of_own_channel = 0.0;
    let mut count = 0;
    for line in 0..lines.frequency_hz.len().min(ASKED) {
        let measured = lines.assembly[line][(point, point)].re;
        let rigid = Rigid::of(&lines.a.at(line), &lines.b_at(line), point)?;
        let ways = [(&lines.a, &rigid.loads), (&lines.b, &rigid.motions)];
        let errors = ways.map(|(receptances, way)| OfLine::of(receptances, way, line));
        let variance: f64 = errors
            .iter()
            .zip(sides)
            .filter_map(|(own, side)| own.as_ref()?.variance(side.as_ref()?, line))
            .sum();
        let rounding = ROUNDING * measured.abs().max(rigid.yields.re.abs());
        // half of a complex variance is that of the real part
        let of_rigid = (0.5 * variance).sqrt();
        let beyond_resonance = rigid.yields.re <= -CERTAIN * of_rigid;
        // never where it was not measured
        let is_below = measured > 0.0 && !beyond_resonance;
        if !is_below {
            break;
        }
        count += 1;
        let variance =
            0.5 * of_measured[line] + (OF_RIGID * of_rigid).powi(2) + rounding * rounding;
        let weight = variance.recip();
        sums.weight += weight;
        sums.measured += weight * measured;
        sums.rigid += weight * rigid.yields.re;
        of_own_channel += weight * measured;
        for (sum, own) in of_channels.iter_mut().zip(&errors) {
            if let Some(own) = own {
                *sum += own.gains() * (OF_RIGID * weight);
            }
        }
    }
    if count < ENOUGH_LINES {
        return None;
    }
    let of_gains: f64 = of_channels.iter().map(DVector::norm_squared).sum();
    let of_gains = (of_gains + of_own_channel * of_own_channel) * budget.channel_gain.powi(2);
    let deviation = (sums.weight + of_gains).sqrt();
    let less = OF_RIGID * sums.rigid - sums.measured;
    (less > CERTAIN * deviation).then(|| sums.measured / sums.rigid)
}

/// Sums over the lines, each by the inverse of its variance.
#[derive(Default)]
struct Sums {
    weight: f64,
    measured: f64,
    rigid: f64,
}

/// A point with a rigid joint: h_pp − h_pk (H_jj + H_kk)⁻¹ h_kp.
struct Rigid {
    yields: Complex64,
    /// What the joint loads A with, by a unit load at the point.
    loads: DVector<Complex64>,
    /// What B is loaded with: the joint's loads, and the unit at the point.
    motions: DVector<Complex64>,
}

impl Rigid {
    fn of(a: &ComplexMatrix, b: &Partition, point: usize) -> Option<Self> {
        let seen = b.joint_points.column(point).into_owned();
        let loads = (a + &b.joint).lu().solve(&seen)?;
        let yields = b.points[(point, point)] - b.points_joint.row(point).transpose().dot(&loads);
        let dofs = loads.len();
        let motions = DVector::from_fn(dofs + b.points.nrows(), |row, _| match row {
            row if row < dofs => -loads[row],
            row if row == dofs + point => Complex64::from(1.0),
            _ => Complex64::ZERO,
        });
        Some(Self {
            yields,
            loads,
            motions,
        })
    }
}

/// How errors of a measured structure act on what is yielded: it is stationary in the loads, so that d = xᵀ dU x with x = Wᵀ of
/// them, loads and unit load together.
struct OfLine {
    x: DVector<Complex64>,
    u: ComplexMatrix,
}

impl OfLine {
    fn of(receptances: &Receptances, loads: &DVector<Complex64>, line: usize) -> Option<Self> {
        let measured = receptances.measured()?;
        let whole = measured.transformation().map(Complex64::from);
        Some(Self {
            x: whole.tr_mul(loads),
            u: measured.receptance(line),
        })
    }

    fn variance(&self, of: &Variances, line: usize) -> Option<f64> {
        let entries = of.entries.iter();
        let parts = entries.map(|&((p, q), ref variances)| {
            let twice = if p == q { 1.0 } else { 2.0 };
            (self.x[p] * self.x[q] * twice).norm_sqr() * variances.get(line).unwrap_or(&0.0)
        });
        Some(parts.sum())
    }

    /// What a gain of each channel does: x_p (U x)_p.
    fn gains(&self) -> DVector<f64> {
        let moved = &self.u * &self.x;
        self.x.zip_map(&moved, |x, moved| (x * moved).re)
    }
}

/// Variances of the measured functions of a structure, by row and column of U, at each line.
struct Variances {
    channels: usize,
    entries: Vec<((usize, usize), Vec<f64>)>,
}

impl Variances {
    fn of(side: Side, receptances: &Receptances, noise: &Noise) -> Option<Self> {
        let measured = receptances.measured()?;
        let known = |(p, q)| {
            let places = measured.measured().iter();
            let mut places = places.zip(measured.relative_variance().into_iter().flatten());
            let own = places.find(|(place, _)| **place == (p, q) || **place == (q, p));
            own.map(|(_, known)| known.as_slice())
        };
        let functions = measured.measured_functions().into_iter();
        let entries = functions.map(|((p, q), rough)| {
            let rotations = [p, q].map(|label| measured.is_rotation(label));
            let values = measured.function(p, q);
            let of = Of::Substructure(side);
            let variances = variances(of, rotations, values, known((p, q)), rough, noise);
            ((p, q), variances)
        });
        Some(Self {
            channels: measured.transformation().ncols(),
            entries: entries.collect(),
        })
    }
}

/// Those of each of the assembly's measured functions.
fn of_assembly(lines: &Lines, noise: &Noise) -> Vec<Vec<f64>> {
    let functions = lines.measured.iter().zip(lines.roughness());
    let of = |(index, (&(p, q), rough)): (usize, (&(usize, usize), &Roughness))| {
        let values: Vec<Complex64> = lines.assembly.iter().map(|line| line[(p, q)]).collect();
        let rotations = [p, q].map(|point| lines.points[point].direction().is_rotation());
        let known = lines.relative_variance.as_ref();
        let known = known.and_then(|known| known.get(index).map(Vec::as_slice));
        variances(Of::Assembly, rotations, &values, known, rough, noise)
    };
    functions.enumerate().map(of).collect()
}

/// As coherence, the study or else the function itself says.
fn variances(
    of: Of,
    rotations: [bool; 2],
    values: &[Complex64],
    known: Option<&[f64]>,
    rough: &Roughness,
    noise: &Noise,
) -> Vec<f64> {
    let [relative, own] = rough.level();
    let shown = Size {
        relative,
        floor: 1.0,
    };
    let size = noise.levels(shown).of(of);
    let floor = noise.floor(of, rotations, || own);
    let lines = values.iter().enumerate();
    lines
        .map(|(line, value)| match known {
            Some(known) => known[line] * value.norm_sqr(),
            None => size.variance(value.norm_sqr(), floor),
        })
        .collect()
}
