//! K* of each line of an assembly by (3.21), as `decoupling` computes it, in matrices of fixed size: there are many lines.

use std::fmt;
use std::ops::Range;

use bolted_joint_frf::structure::{ComplexMatrix, Partition};
use num_complex::Complex64;

use super::decoupling;
use super::formed::Formed;
use super::kernel::{Small, dot, filled, for_dofs, inverse, vector};
use super::lanes::{Complexes, LANES, Number, Reals};
use super::layout::Layout;
use super::lines::Lines;
use super::parallel;

/// Lines that one processor takes at a time.
const LINES_AT_A_TIME: usize = 256;
/// A column of unit length of which less than this is left beside those before it depends on them.
const DEPENDENT: f64 = 1e-10;

/// The equations of Tol by which an assembly is decoupled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equations {
    /// (3.21): every pair of points on B.
    Ss,
    /// (3.18): every pair of points on A.
    Rr,
    /// (3.18) to (3.21) at once, by least squares: every pair of points on both sides.
    All {
        /// How many of the points, the last ones, are on A.
        on_a: usize,
    },
    /// (3.18) alone, beside points on B whose pairs were not all measured.
    RrOf {
        /// How many of the points, the last ones, are on A.
        on_a: usize,
    },
    /// (3.19): every pair of a response on A and a reference on B, or (3.20), which is its transpose.
    Rs {
        /// How many of the points, the last ones, are on A.
        on_a: usize,
    },
    /// (3.21) alone, beside points on A whose pairs were not all measured.
    SsOf {
        /// How many of the points, the last ones, are on A.
        on_a: usize,
    },
}

/// As equations are numbered.
impl fmt::Display for Equations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ss | Self::SsOf { .. } => "(3.21)",
            Self::Rr | Self::RrOf { .. } => "(3.18)",
            Self::Rs { .. } => "(3.19) and (3.20)",
            Self::All { .. } => "(3.18) to (3.21) at once",
        })
    }
}

impl Equations {
    /// What the measured pairs allow, `on_a` of the points, the last ones, being on A; `None` if nothing.
    pub(super) fn of(lines: &Lines, on_a: usize) -> Option<Self> {
        let count = lines.points.len();
        let (b, a) = (0..count - on_a.min(count), count - on_a.min(count)..count);
        let has = |place: (usize, usize)| {
            lines.measured.contains(&place) || lines.measured.contains(&(place.1, place.0))
        };
        let is_complete = |rows: &Range<usize>, columns: &Range<usize>| {
            let mut pairs = rows
                .clone()
                .flat_map(|p| columns.clone().map(move |q| (p, q)));
            !rows.is_empty() && !columns.is_empty() && pairs.all(has)
        };
        let [ss, rr, rs] = [(&b, &b), (&a, &a), (&a, &b)].map(|(p, q)| is_complete(p, q));
        match (a.is_empty(), b.is_empty()) {
            (true, _) => ss.then_some(Self::Ss),
            (false, true) => rr.then_some(Self::Rr),
            (false, false) if ss && rr && rs => Some(Self::All { on_a }),
            (false, false) if rs => Some(Self::Rs { on_a }),
            (false, false) if ss => Some(Self::SsOf { on_a }),
            (false, false) => rr.then_some(Self::RrOf { on_a }),
        }
    }
}

/// Blocks of an assembly that was measured on both sides, of one structure that both are as long as they are apart.
struct Sides {
    /// A at the joint, which is still, and at its points.
    a: Partition,
    /// Both at the joint, and B at its points.
    b: Partition,
    rr: ComplexMatrix,
    rs: ComplexMatrix,
    ss: ComplexMatrix,
}

impl Sides {
    fn of(lines: &Lines, used: &[usize], line: usize, on_a: usize) -> Self {
        let whole = lines.b_at(line);
        let of_b = lines.points.len() - on_a;
        let joint = whole.joint.select_rows(used).select_columns(used);
        let to_points = whole.points_joint.select_columns(used);
        let assembly = &lines.assembly[line];
        let block = |at: (usize, usize), size: (usize, usize), matrix: &ComplexMatrix| {
            matrix.view(at, size).into_owned()
        };
        let side = |joint: ComplexMatrix, first: usize, count: usize, sign: f64| {
            let to_points = to_points.rows(first, count) * Complex64::from(sign);
            Partition {
                joint,
                joint_points: to_points.transpose(),
                points_joint: to_points,
                points: block((first, first), (count, count), &whole.points),
            }
        };
        let still = ComplexMatrix::zeros(used.len(), used.len());
        Self {
            // H_ur = −H_jr
            a: side(still, of_b, on_a, -1.0),
            b: side(joint, 0, of_b, 1.0),
            rr: block((of_b, of_b), (on_a, on_a), assembly),
            rs: block((of_b, 0), (on_a, of_b), assembly),
            ss: block((0, 0), (of_b, of_b), assembly),
        }
    }
}

/// K* of each line by these equations, over the DOFs of all bolts that the joint model makes use of; `None` where it cannot be
/// had.
pub(super) fn decouple(
    lines: &Lines,
    layout: &Layout,
    equations: Option<Equations>,
) -> Vec<Option<ComplexMatrix>> {
    type By = fn(&Partition, &Partition, &ComplexMatrix) -> Option<ComplexMatrix>;
    let used = layout.used_dofs();
    let of_sides = |on_a: usize, by: By, block: fn(&Sides) -> &ComplexMatrix| {
        let count = 0..lines.frequency_hz.len();
        let of_line = |line| {
            let sides = Sides::of(lines, &used, line, on_a);
            by(&sides.a, &sides.b, block(&sides))
        };
        count.map(of_line).collect()
    };
    let none = || vec![None; lines.frequency_hz.len()];
    match equations {
        None => none(),
        Some(Equations::Rs { on_a }) => of_sides(on_a, decoupling::from_rs, |sides| &sides.rs),
        Some(Equations::RrOf { on_a }) => of_sides(on_a, decoupling::from_rr, |sides| &sides.rr),
        Some(Equations::SsOf { on_a }) => of_sides(on_a, decoupling::from_ss, |sides| &sides.ss),
        // of one structure all of these are (3.21)
        Some(Equations::Ss | Equations::Rr | Equations::All { .. }) => {
            let of: Option<OfLines> = for_dofs!(lines.joint_dofs(), with_dofs);
            of.map_or_else(none, |of| of(lines, layout))
        }
    }
}

type OfLines = fn(&Lines, &Layout) -> Vec<Option<ComplexMatrix>>;

fn with_dofs<const N: usize>(lines: &Lines, layout: &Layout) -> Vec<Option<ComplexMatrix>> {
    let pieces = parallel::pieces(lines.frequency_hz.len(), LINES_AT_A_TIME);
    let of_piece = |piece: &Range<usize>| of_lines::<N>(lines, layout, piece.clone());
    parallel::map(&pieces, of_piece)
        .into_iter()
        .flatten()
        .collect()
}

fn of_lines<const N: usize>(
    lines: &Lines,
    layout: &Layout,
    piece: Range<usize>,
) -> Vec<Option<ComplexMatrix>> {
    let used = layout.used_dofs();
    let dofs = filled::<N>(lines.joint_dofs());
    let is_fixed = lines.points.len() > dofs && used.len() == dofs;
    let mut least_squares = LeastSquares::<N>::new(lines);
    let mut decoupled = Vec::with_capacity(piece.len());
    for first in piece.clone().step_by(LANES) {
        let last = LANES.min(piece.end - first) - 1;
        let index: [usize; LANES] = std::array::from_fn(|lane| first + lane.min(last));
        let found = is_fixed.then(|| least_squares.solve(index));
        let found = found.flatten();
        decoupled.extend(index[..=last].iter().enumerate().map(|(lane, &line)| {
            let Some(found) = found else {
                return alone(lines, &used, line);
            };
            let stiffness = ComplexMatrix::from_fn(dofs, dofs, |i, j| found[i][j].lane(lane));
            is_finite(&stiffness).then_some(stiffness)
        }));
    }
    decoupled
}

/// One line, whatever its matrices are, at the joint's DOFs that are `used`.
fn alone(lines: &Lines, used: &[usize], line: usize) -> Option<ComplexMatrix> {
    let a_joint = lines.a.at(line).select_rows(used).select_columns(used);
    // Equation (3.21) needs nothing of A but H_jj.
    let a = Partition::of(&a_joint, used.len());
    let b = lines.b_at(line);
    let b = Partition {
        joint: b.joint.select_rows(used).select_columns(used),
        joint_points: b.joint_points.select_rows(used),
        points_joint: b.points_joint.select_columns(used),
        points: b.points,
    };
    decoupling::from_ss(&a, &b, &lines.assembly[line])
}

fn is_finite(matrix: &ComplexMatrix) -> bool {
    let mut values = matrix.iter();
    values.all(|value| value.re.is_finite() && value.im.is_finite())
}

/// The least-squares solution of (3.21) from more points than joint DOFs, for lines side by side.
struct LeastSquares<'l, const N: usize> {
    lines: &'l Lines,
    /// What H_jj comes from, and those between the joint's DOFs and the points of B, …
    formed: [Formed<'l>; 2],
    /// … and both of the lines that are solved, row by row.
    a: Vec<Complexes>,
    b: Vec<Complexes>,
    left: PseudoInverse<N>,
    right: PseudoInverse<N>,
}

impl<'l, const N: usize> LeastSquares<'l, N> {
    fn new(lines: &'l Lines) -> Self {
        Self {
            lines,
            formed: [Formed::of(&lines.a), Formed::of(&lines.b)],
            a: Vec::new(),
            b: Vec::new(),
            left: PseudoInverse::default(),
            right: PseudoInverse::default(),
        }
    }

    /// `None` where columns depend on each other, or a matrix is singular, at any of the lines.
    fn solve(&mut self, index: [usize; LANES]) -> Option<Small<N, Complexes>> {
        let Self { lines, formed, .. } = self;
        let assembly = index.map(|line| &lines.assembly[line]);
        let (dofs, points) = (filled::<N>(lines.joint_dofs()), lines.points.len());
        formed[0].at(index, &mut self.a);
        formed[1].at(index, &mut self.b);
        let [of_a, of_b] = [lines.a.size(), lines.b.size()];
        let a = |i: usize, j: usize| self.a[i * of_a + j];
        let b = |i: usize, j: usize| self.b[i * of_b + j];
        let left = &mut self.left;
        left.of((points, dofs), |p, i| b(dofs + p, i))?;
        let right = match formed[1].is_symmetric() {
            true => &*left,
            false => {
                self.right.of((points, dofs), |p, i| b(i, dofs + p))?;
                &self.right
            }
        };
        // Z⁻¹ = H_sk⁺ (H_ss − H^C_ss) H_ks⁺
        let mut z_inverse = [[Complexes::ZERO; N]; N];
        for (q, right) in right.columns.iter().enumerate() {
            let mut product = [Complexes::ZERO; N];
            for (p, left) in left.columns.iter().enumerate() {
                let measured = Complexes::of(|lane| assembly[lane][(p, q)]);
                let difference = b(dofs + p, dofs + q) - measured;
                for i in 0..dofs {
                    product[i] += left[i] * difference;
                }
            }
            for i in 0..dofs {
                for j in 0..dofs {
                    z_inverse[i][j] += product[i] * right[j];
                }
            }
        }
        // K* = (Z − H_jj − H_kk)⁻¹
        let mut z = inverse(dofs, z_inverse)?;
        for i in 0..dofs {
            for j in 0..dofs {
                z[i][j] -= a(i, j) + b(i, j);
            }
        }
        inverse(dofs, z)
    }
}

/// M⁺ of a matrix with at most N columns, as many rows as there are points.
#[derive(Default)]
struct PseudoInverse<const N: usize> {
    /// M by rows, then its orthonormal basis.
    rows: Vec<[Complexes; N]>,
    /// M⁺, a column for each point.
    columns: Vec<[Complexes; N]>,
}

impl<const N: usize> PseudoInverse<N> {
    /// M = Q R by Gram and Schmidt, twice over, from columns of unit length; M⁺ = R⁻¹ Qᴴ.
    fn of(
        &mut self,
        (points, dofs): (usize, usize),
        entry: impl Fn(usize, usize) -> Complexes,
    ) -> Option<()> {
        self.rows.clear();
        let row = |point| vector(dofs, |i| entry(point, i));
        self.rows.extend((0..points).map(row));
        // Q = M A: A takes the part of every operation that R⁻¹ is made of.
        let mut factor = [[Complexes::ZERO; N]; N];
        for i in 0..dofs {
            let scale = self.length(i).reciprocal();
            self.scale(i, scale);
            factor[i][i].re = scale;
        }
        for i in 0..dofs {
            for _ in 0..2 {
                for before in 0..i {
                    let mut part = Complexes::ZERO;
                    for row in &self.rows {
                        part += row[before].conj() * row[i];
                    }
                    for row in self.rows.iter_mut().chain(&mut factor) {
                        let taken = row[before] * part;
                        row[i] -= taken;
                    }
                }
            }
            let left = self.length(i);
            let is_independent = |&left: &f64| left > DEPENDENT && left.is_finite();
            if !left.lanes().iter().all(is_independent) {
                return None;
            }
            let scale = left.reciprocal();
            self.scale(i, scale);
            for row in &mut factor {
                row[i] = row[i].scaled(scale);
            }
        }
        // M⁺ = A Qᴴ
        self.columns.clear();
        self.columns.extend(self.rows.iter().map(|row| {
            let conjugate = row.map(Complexes::conj);
            vector(dofs, |i| dot(&factor[i][..dofs], &conjugate[..dofs]))
        }));
        Some(())
    }

    fn length(&self, column: usize) -> Reals {
        let mut squares = Reals::ZERO;
        for row in &self.rows {
            squares += row[column].norm_sqr();
        }
        squares.sqrt()
    }

    fn scale(&mut self, column: usize, factor: Reals) {
        for row in &mut self.rows {
            row[column] = row[column].scaled(factor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn the_pseudo_inverse_obeys_its_definition_for_columns_of_any_size() {
        let c = Complex64::new;
        let matrix = [
            [c(1.0, 2.0), c(1e-6, 3e-6)],
            [c(-1.0, 0.5), c(2e-6, 0.0)],
            [c(0.25, -2.0), c(-1e-6, 5e-6)],
        ];
        let of = |point: usize, i: usize| {
            Complexes::of(|lane| matrix[point][i] + matrix[(point + lane) % 3][i])
        };
        let mut inverse = PseudoInverse::<2>::default();
        inverse.of((3, 2), of).unwrap();
        for i in 0..2 {
            for j in 0..2 {
                for lane in 0..LANES {
                    let products = (0..3).map(|p| (inverse.columns[p][i] * of(p, j)).lane(lane));
                    let product: Complex64 = products.sum();
                    let scale = [1.0, 1e-6][j] / [1.0, 1e-6][i];
                    let unit = if i == j { 1.0 } else { 0.0 };
                    assert!((product - unit).norm() < 1e-14 * scale, "{i} {j} {product}");
                }
            }
        }
    }

    #[test]
    fn columns_that_depend_on_each_other_are_refused() {
        let mut inverse = PseudoInverse::<2>::default();
        let of = inverse.of((3, 2), |point, i| {
            Complexes::of(|_| Complex64::from((point * 7 + 1) as f64 * [1.0, 3.0][i]))
        });
        assert_eq!(of, None);
    }
}
