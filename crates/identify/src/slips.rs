//! Slips that no error bar covers: a reversed sensor, exchanged points, a wrong unit. Where what an estimate leaves is no noise, the
//! data are tried as if each had happened.

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use nalgebra::DVector;
use num_complex::Complex64;

use bolted_joint_systematic::{MeasuredSet, Side};

use super::assessment::Assessment;
use super::data::Data;
use super::glance::{Beginning, least_left};
use super::layout::Layout;
use super::lines::Lines;
use super::noise::Noise;
use super::parallel;
use super::receptances::Receptances;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;
/// A slip is named where undoing it lowers the mean square of what is left to this part …
const MOST_LEFT: f64 = 0.25;
/// … a factor of a hundred and more to this …
const MOST_LEFT_FAR: f64 = 0.02;
/// … and another one is named beside it where it leaves less than so many times as much.
const ALIKE: f64 = 1.5;
/// A mean square beside the receptances that a joint leaves if it belongs to the data at all: one that has nothing to do with them
/// leaves about 1, or next to nothing of what it computes.
const BELIEVABLE: f64 = 0.1;
/// χ² per degree of freedom beside which a slip is thought of.
const SUSPICIOUS: f64 = 5.0;
/// The same beside which it is thought of first.
const OVERWHELMING: f64 = 100.0;
/// A fit that is exact to rounding is none of a measurement, and so no evidence.
const ROUNDING: f64 = 1e-12;
/// Slips that are tried from more starts.
const PROMISING: usize = 8;

/// What may be wrong with a set of functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slip {
    /// They have to be multiplied by a number.
    Factor(MeasuredSet, f64),
    /// They are another quantity than the study says: they have to be multiplied by (jω)ⁿ.
    Quantity(MeasuredSet, i32),
    /// The response at a point of the assembly has the wrong sign.
    Response(usize),
    /// The force at a point of the assembly has.
    Force(usize),
    /// Both have.
    Point(usize),
    /// Two points of the assembly are exchanged.
    Points(usize, usize),
    /// The responses at two points of the assembly are exchanged.
    Responses(usize, usize),
    /// The rotation at the joint of a structure has the wrong sign.
    Rotation(Side),
}

impl Slip {
    /// Whether it is a factor that leaves hardly anything of a set, or of what stands beside it.
    fn is_far_off(self) -> bool {
        matches!(self, Self::Factor(_, factor) if factor.abs().log10().abs() >= 2.0)
    }
}

/// A slip with what undoing it does.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundSlip {
    /// The slip.
    pub slip: Slip,
    /// The slip in words, with the points' labels.
    pub words: String,
    /// Mean square of what is left without it, as a part of what is left with it.
    pub left: f64,
}

impl fmt::Display for FoundSlip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} (the mean square of what is left would fall by a factor of {:.0})",
            self.words,
            self.left.recip()
        )
    }
}

/// Whether what an estimate leaves is so much that small errors of the set-up hardly explain it.
pub(super) fn are_possible(assessment: &Assessment) -> bool {
    let chi_squared = assessment.reduced_chi_squared;
    let is_much = chi_squared.is_none_or(|chi| chi > SUSPICIOUS || !assessment.noise_is_stated);
    !assessment.fits() && is_much
}

/// Whether an estimate leaves so much that errors of the set-up within their limits hardly ever explain it.
pub(super) fn are_likely(assessment: &Assessment) -> bool {
    let chi_squared = assessment.reduced_chi_squared;
    are_possible(assessment) && chi_squared.is_some_and(|chi| chi > OVERWHELMING)
}

/// Whether undoing a slip leaves so little that no other error need be thought of.
pub(super) fn are_certain(found: &[FoundSlip], assessment: &Assessment) -> bool {
    let left = assessment.reduced_chi_squared.zip(found.first());
    left.is_some_and(|(chi, first)| chi * first.left < SUSPICIOUS)
}

/// The slips that explain what an estimate leaves of one assembly's lines, the most likely first; none where no slip does.
pub(super) fn found(
    lines: &Lines,
    layout: &Layout,
    noise: &Noise,
    estimate: &[f64],
) -> Vec<FoundSlip> {
    let shown;
    let noise = match noise.is_stated()
        || [&lines.a, &lines.b]
            .iter()
            .all(|of| of.measured().is_none())
    {
        true => noise,
        // measured substructures whose noise may be anything would explain anything
        false => {
            shown = noise.or_as_shown(lines);
            &shown
        }
    };
    let start = DVector::from_column_slice(estimate);
    let left = |lines: &Lines, beginning: Beginning<'_>| {
        let data = Data::of(vec![(lines, 0)], noise)?;
        least_left(&data, &layout.places(), noise, beginning)
    };
    let Some(as_it_is) = left(lines, Beginning::At(&start)) else {
        return Vec::new();
    };
    let ranked_from = |slips: &[Slip], beginning: Beginning<'_>| {
        let left = |slip: &Slip| left(&undone(lines, layout, *slip), beginning);
        let tried = slips.iter().zip(parallel::map(slips, left));
        let mut ranked: Vec<(Slip, f64)> = tried
            .filter_map(|(slip, left)| Some((*slip, left?)))
            .filter(|(_, left)| *left > ROUNDING)
            .map(|(slip, left)| (slip, left / as_it_is))
            .collect();
        ranked.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        ranked
    };
    let mut ranked = ranked_from(&possible(lines, layout), Beginning::At(&start));
    // A slip can leave no start that leads to the joint. A reversed sign of all functions leaves none at all.
    let (first, others) = ranked.split_at(PROMISING.min(ranked.len()));
    let signs = others
        .iter()
        .filter(|(slip, _)| matches!(slip, Slip::Factor(_, -1.0)));
    let promising: Vec<Slip> = first.iter().chain(signs).map(|(slip, _)| *slip).collect();
    for (slip, left) in ranked_from(&promising, Beginning::Grid) {
        for known in ranked.iter_mut().filter(|(other, _)| *other == slip) {
            known.1 = known.1.min(left);
        }
    }
    ranked.sort_by(|(_, one), (_, other)| one.total_cmp(other));
    let relative = noise.assembly.relative.filter(|relative| *relative > 0.0);
    let believable = BELIEVABLE / relative.unwrap_or(1.0).powi(2) / as_it_is;
    let most = MOST_LEFT.min(believable);
    // what is a thousand times itself is as good as not there, which may fit a little better
    ranked.retain(|(slip, left)| !slip.is_far_off() || *left < MOST_LEFT_FAR);
    let Some(&(_, best)) = ranked.first().filter(|(_, left)| *left < most) else {
        return Vec::new();
    };
    ranked.retain(|(_, left)| *left <= ALIKE * best);
    let words = |(slip, left): (Slip, f64)| FoundSlip {
        words: slip.in_words(lines),
        slip,
        left,
    };
    ranked.into_iter().map(words).collect()
}

/// The slips that could have happened to these lines.
fn possible(lines: &Lines, layout: &Layout) -> Vec<Slip> {
    let sides = [(Side::A, &lines.a), (Side::B, &lines.b)];
    let measured = sides.into_iter().filter(|(_, of)| of.measured().is_some());
    let measured: Vec<Side> = measured.map(|(side, _)| side).collect();
    let sets = measured.iter().map(|&side| MeasuredSet::Of(side));
    let sets: Vec<MeasuredSet> = sets.chain([MeasuredSet::Assembly(0)]).collect();
    let mut all = Vec::new();
    for &set in &sets {
        let factors = [-1.0, GRAVITY, GRAVITY.recip(), 1e3, 1e-3];
        all.extend(factors.map(|factor| Slip::Factor(set, factor)));
        all.extend([-2, -1, 1, 2].map(|power| Slip::Quantity(set, power)));
    }
    let points = lines.points.len();
    for point in 0..points {
        all.extend([
            Slip::Point(point),
            Slip::Response(point),
            Slip::Force(point),
        ]);
        for other in point + 1..points {
            all.extend([Slip::Points(point, other), Slip::Responses(point, other)]);
        }
    }
    if layout.model().dofs() > 1 {
        all.extend(measured.into_iter().map(Slip::Rotation));
    }
    all
}

/// The lines as they would be without a slip.
fn undone(lines: &Lines, layout: &Layout, slip: Slip) -> Lines {
    let mut lines = lines.clone();
    let points = lines.points.len();
    match slip {
        Slip::Factor(set, factor) => multiply(&mut lines, set, &|_| Complex64::from(factor)),
        Slip::Quantity(set, power) => {
            multiply(&mut lines, set, &|omega| {
                Complex64::new(0.0, omega).powi(power)
            });
        }
        Slip::Response(point) => change_sign(&mut lines, |row, _| row == point),
        Slip::Force(point) => change_sign(&mut lines, |_, column| column == point),
        Slip::Point(point) => {
            change_sign(&mut lines, |row, column| {
                (row == point) != (column == point)
            });
        }
        Slip::Points(one, other) => {
            for matrix in &mut lines.assembly {
                matrix.swap_rows(one, other);
                matrix.swap_columns(one, other);
            }
            let mut order: Vec<usize> = (0..points).collect();
            order.swap(one, other);
            for place in &mut lines.measured {
                *place = (order[place.0], order[place.1]);
            }
        }
        Slip::Responses(one, other) => {
            for matrix in &mut lines.assembly {
                matrix.swap_rows(one, other);
            }
        }
        Slip::Rotation(side) => {
            let of_side = match side {
                Side::A => &mut lines.a,
                Side::B => &mut lines.b,
            };
            if let Receptances::Measured(measured) = of_side {
                let dofs = layout.dofs_of_a_bolt();
                let bolts = layout.bolts();
                let rotations = (0..bolts).map(|bolt| bolt * dofs + 1);
                let reversed = measured.with_reversed(rotations);
                *measured = Arc::new(reversed);
            }
        }
    }
    lines
}

fn multiply(lines: &mut Lines, set: MeasuredSet, factor: &dyn Fn(f64) -> Complex64) {
    let factors = lines.frequency_hz.iter().map(|hz| factor(TAU * hz));
    let factors: Vec<Complex64> = factors.collect();
    match set {
        MeasuredSet::Assembly(_) => {
            for (matrix, factor) in lines.assembly.iter_mut().zip(&factors) {
                *matrix *= *factor;
            }
            if let Some(repeats) = &mut lines.repeats {
                for (scatter, factor) in repeats.scatter.iter_mut().zip(&factors) {
                    *scatter *= factor.norm_sqr();
                }
            }
        }
        MeasuredSet::Of(side) => {
            let of_side = match side {
                Side::A => &mut lines.a,
                Side::B => &mut lines.b,
            };
            if let Receptances::Measured(measured) = of_side {
                *measured = Arc::new(measured.multiplied(&factors));
            }
        }
    }
}

/// Changes the sign of some entries of the assembly's matrix.
fn change_sign(lines: &mut Lines, is_wrong: impl Fn(usize, usize) -> bool) {
    for matrix in &mut lines.assembly {
        for row in 0..matrix.nrows() {
            for column in 0..matrix.ncols() {
                if is_wrong(row, column) {
                    matrix[(row, column)] = -matrix[(row, column)];
                }
            }
        }
    }
}

impl Slip {
    fn in_words(self, lines: &Lines) -> String {
        let point = |index: usize| lines.points[index];
        match self {
            Self::Factor(set, -1.0) => format!("all functions of {set} have the wrong sign"),
            Self::Factor(set, factor) => {
                let guess = match factor {
                    GRAVITY => "accelerations in g",
                    ..1e-2 => "motions in mm",
                    1.0.. => "forces in kN",
                    _ => "forces in kgf",
                };
                format!("the functions of {set} have to be multiplied by {factor:.4} ({guess}?)")
            }
            Self::Quantity(set, power) => {
                let quantities = match power {
                    2 => "the integral of displacement",
                    1 => "an integral of the quantity",
                    -1 => {
                        "mobility where the study has receptance, or accelerance where it has mobility"
                    }
                    _ => "accelerance where the study has receptance",
                };
                format!("the functions of {set} are {quantities}: state their quantity")
            }
            Self::Response(index) => {
                format!("the responses at {} have the wrong sign", point(index))
            }
            Self::Force(index) => format!("the forces at {} have the wrong sign", point(index)),
            Self::Point(index) => format!("the direction of {} is reversed", point(index)),
            Self::Points(one, other) => {
                format!(
                    "the points {} and {} are exchanged",
                    point(one),
                    point(other)
                )
            }
            Self::Responses(one, other) => format!(
                "the responses at {} and {} are exchanged",
                point(one),
                point(other)
            ),
            Self::Rotation(side) => {
                format!("the rotation at the joint of {side} has the wrong sign")
            }
        }
    }
}
