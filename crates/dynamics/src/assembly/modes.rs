//! Coordinates in which the linear part of an assembly takes one rotation for each mode, in place of a product with a full matrix.
//!
//! The modes of M q̈ + C q̇ + K q = 0 with M = 1 and symmetric C and K: (λ² + λ C + K) φ = 0. In the coordinates z of
//! q = Σ Re φ z₁ + Im φ z₂, q̇ = Σ Re λφ z₁ + Im λφ z₂, each pair turns and decays by itself. What is free, and undamped, goes on.

use super::{matrix::Matrix, products::dot, system::System};
use crate::{complex::Complex, elementary::hypotenuse};

/// Fewer coordinates gain nothing.
const FEWEST: usize = 8;
/// Iterations for one mode; a few are usual, and a hundred where dampers couple two that are near each other. Where these do not do
/// there is no such frame.
const MAX_ITERATIONS: usize = 400;
/// Change of a mode, as a part of it, at which it is found.
const AT_REST: f64 = 1e-13;
/// Sweeps over all pairs for the undamped modes; eight are usual.
const MAX_SWEEPS: usize = 40;
/// Cosine of the angle between two columns that are orthogonal.
const ORTHOGONAL: f64 = 4.0 * f64::EPSILON;
/// An undamped ω² below this part of the largest one is that of a free motion.
const FREE: f64 = 1e-15;
/// What the modes may miss of a motion, as a part of it.
const LARGEST_ERROR: f64 = 1e-11;
/// Motions that they are tried with.
const PROBES: u64 = 4;

/// How a pair of coordinates goes on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pair {
    /// λ and its conjugate.
    Turning(Complex),
    /// Displacement and rate of a free motion.
    Free,
}

/// Coordinates z with y = V z, two for each mode.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pairs: Vec<Pair>,
    /// V, 2n × 2n.
    out_of_modes: Matrix,
    /// V⁻¹
    to_modes: Matrix,
}

impl Frame {
    /// That of an assembly; `None` where modes are few, or critically damped, or coupled by dampers beyond iteration.
    pub(super) fn of(system: &System) -> Option<Self> {
        let n = system.size;
        if n < FEWEST {
            return None;
        }
        let (squares, shapes) = undamped(&system.stiffness_factor()?)?;
        let damping = shapes
            .transposed()
            .product(&system.damping.product(&shapes));
        let largest = squares
            .iter()
            .fold(0.0_f64, |largest, own| largest.max(*own));
        let mut frame = Self {
            pairs: Vec::with_capacity(n),
            out_of_modes: Matrix::zeros(2 * n, 2 * n),
            to_modes: Matrix::zeros(2 * n, 2 * n),
        };
        for k in 0..n {
            if squares[k] > FREE * largest {
                frame.add_turning(k, &Mode::of(k, &squares, &damping)?, &shapes, &damping);
            } else if damping
                .row(k)
                .iter()
                .all(|own| own.abs() < FREE * largest.sqrt())
            {
                frame.add_free(k, &shapes);
            } else {
                return None;
            }
        }
        Some(frame)
    }

    fn add_turning(&mut self, k: usize, mode: &Mode, shapes: &Matrix, damping: &Matrix) {
        let n = shapes.rows();
        let Mode { lambda, shape } = mode;
        let loss: Vec<Complex> = (0..n).map(|i| along(damping.row(i), shape)).collect();
        // θ = φᵀ (2λ + C) φ
        let theta = shape
            .iter()
            .zip(&loss)
            .fold(Complex::ZERO, |sum, (own, loss)| {
                sum.plus(own.times(own.times(*lambda).scaled(2.0).plus(*loss)))
            });
        let weight = theta.reciprocal();
        let left: Vec<Complex> = shape
            .iter()
            .zip(&loss)
            .map(|(own, loss)| own.times(*lambda).plus(*loss).times(weight))
            .collect();
        for i in 0..n {
            let of = |part: &[Complex]| along(shapes.row(i), part);
            let phi = of(shape);
            for (row, own) in [(i, phi), (n + i, phi.times(*lambda))] {
                self.out_of_modes[(row, 2 * k)] = own.re;
                self.out_of_modes[(row, 2 * k + 1)] = own.im;
            }
            // ζ = φᵀ (q̇ + (C + λ) q)/θ, z = (2 Re ζ, −2 Im ζ)
            for (column, own) in [(i, of(&left)), (n + i, phi.times(weight))] {
                self.to_modes[(2 * k, column)] = 2.0 * own.re;
                self.to_modes[(2 * k + 1, column)] = -2.0 * own.im;
            }
        }
        self.pairs.push(Pair::Turning(*lambda));
    }

    fn add_free(&mut self, k: usize, shapes: &Matrix) {
        let n = shapes.rows();
        for i in 0..n {
            for part in 0..2 {
                self.out_of_modes[(part * n + i, 2 * k + part)] = shapes[(i, k)];
                self.to_modes[(2 * k + part, part * n + i)] = shapes[(i, k)];
            }
        }
        self.pairs.push(Pair::Free);
    }

    /// Whether these are the coordinates of y, and go on as it does: V V⁻¹ y = y and V Λ z = A V z, in coordinates D q (`scale`) and q̇,
    /// for motions of all coordinates at once.
    pub(super) fn is_whole(&self, system: &System, scale: &[f64]) -> bool {
        let n = system.size;
        let largest = scale
            .iter()
            .fold(0.0, |largest: f64, own| largest.max(*own));
        let is_near = |one: &[f64], other: &[f64], unit: f64| {
            let off = |i: usize| (one[i] - other[i]).abs() * if i < n { scale[i] } else { 1.0 };
            (0..2 * n).all(|i| off(i) < LARGEST_ERROR * unit)
        };
        (1..=PROBES).all(|probe| {
            // signs without any order
            let mut bits = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(2 * probe + 1);
            let mut sign = || {
                bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                if bits >> 63 == 0 { 1.0 } else { -1.0 }
            };
            let unit = |i: usize| if i < n { scale[i] } else { 1.0 };
            let y: Vec<f64> = (0..2 * n).map(|i| sign() / unit(i)).collect();
            let of = |matrix: &Matrix, x: &[f64]| {
                let mut product = vec![0.0; 2 * n];
                matrix.add_product_to(x, &mut product);
                product
            };
            let mut z = of(&self.to_modes, &y);
            let again = of(&self.out_of_modes, &z);
            self.take_rates(&mut z);
            let found = of(&self.out_of_modes, &z);
            let mut rates = vec![0.0; 2 * n];
            system.rates(&y, &mut rates);
            is_near(&again, &y, 1.0) && is_near(&found, &rates, largest)
        })
    }

    /// z ← Λ z
    pub(super) fn take_rates(&self, z: &mut [f64]) {
        for (pair, own) in z.chunks_exact_mut(2).zip(&self.pairs) {
            let [first, second] = [pair[0], pair[1]];
            let [a, b, c, d] = match own {
                Pair::Free => [0.0, 1.0, 0.0, 0.0],
                Pair::Turning(Complex { re, im }) => [*re, *im, -im, *re],
            };
            pair[0] = a * first + b * second;
            pair[1] = c * first + d * second;
        }
    }

    /// How the pairs of coordinates go on.
    pub(super) fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// V
    pub(super) fn out_of_modes(&self) -> &Matrix {
        &self.out_of_modes
    }

    /// V⁻¹
    pub(super) fn to_modes(&self) -> &Matrix {
        &self.to_modes
    }
}

/// λ and φ of one mode in the undamped modes.
struct Mode {
    lambda: Complex,
    shape: Vec<Complex>,
}

impl Mode {
    /// The mode that the `k`-th undamped one becomes: each row of (λ² + λ C + Ω²) φ = 0 in turn for its own entry, with φₖ = 1.
    fn of(k: usize, squares: &[f64], damping: &Matrix) -> Option<Self> {
        let n = squares.len();
        let mut shape = vec![Complex::ZERO; n];
        shape[k].re = 1.0;
        let mut lambda = root(Complex::real(damping[(k, k)]), squares[k])?;
        for _ in 0..MAX_ITERATIONS {
            let mut change = 0.0_f64;
            let mut size = 1.0_f64;
            let square = lambda.times(lambda);
            for j in (0..n).filter(|&j| j != k) {
                let row = damping.row(j);
                let own = Complex::real(row[j]);
                let others = along(row, &shape).minus(own.times(shape[j]));
                let divisor = square
                    .plus(lambda.times(own))
                    .plus(Complex::real(squares[j]));
                let next = lambda
                    .times(others)
                    .times(divisor.reciprocal())
                    .scaled(-1.0);
                change = change.max(next.minus(shape[j]).modulus());
                size = size.max(next.modulus());
                shape[j] = next;
            }
            let next = root(along(damping.row(k), &shape), squares[k])?;
            let rest = next.minus(lambda).modulus() / next.modulus();
            lambda = next;
            if !(change.is_finite() && rest.is_finite()) {
                return None;
            }
            if (change / size).max(rest) < AT_REST {
                return Some(Self { lambda, shape });
            }
        }
        None
    }
}

/// λ above the real axis with λ² + c λ + ω² = 0; `None` where there is none, or hardly.
fn root(c: Complex, square: f64) -> Option<Complex> {
    let half = c.scaled(-0.5);
    let radical = half.times(half).minus(Complex::real(square)).square_root();
    let radical = radical.scaled(1.0_f64.copysign(radical.im));
    let lambda = half.plus(radical);
    // near critical damping two modes become one
    (lambda.im > 0.1 * square.sqrt()).then_some(lambda)
}

fn along(row: &[f64], vector: &[Complex]) -> Complex {
    row.iter()
        .zip(vector)
        .fold(Complex::ZERO, |sum, (factor, own)| {
            sum.plus(own.scaled(*factor))
        })
}

/// ω² of the undamped modes, and their shapes of unit length in columns, from the factor G of K = Gᵀ G.
///
/// Rotations make the columns of G orthogonal, pair by pair (Hestenes 1958): low modes keep their digits beside high ones, which they
/// do not where K itself is rotated.
fn undamped(factor: &Matrix) -> Option<(Vec<f64>, Matrix)> {
    // columns as rows, since those are what a rotation takes
    let mut columns = factor.transposed();
    let n = columns.rows();
    let mut shapes = Matrix::identity(n);
    let norms = (0..n).map(|i| dot(columns.row(i), columns.row(i)));
    let largest = norms.fold(0.0, f64::max);
    for _ in 0..MAX_SWEEPS {
        let mut is_done = true;
        for p in 0..n {
            for q in p + 1..n {
                let [first, second] = [columns.row(p), columns.row(q)];
                let [own, other, between] =
                    [dot(first, first), dot(second, second), dot(first, second)];
                // what is left of a column of a free motion is rounding, and has no direction
                let is_nothing = own.min(other) <= FREE * largest;
                if is_nothing && between.abs() <= ORTHOGONAL * own.max(other)
                    || between.abs() <= ORTHOGONAL * (own * other).sqrt()
                {
                    continue;
                }
                is_done = false;
                let ratio = (other - own) / (2.0 * between);
                let tangent = (ratio.abs() + hypotenuse(ratio, 1.0))
                    .recip()
                    .copysign(ratio);
                let cosine = hypotenuse(tangent, 1.0).recip();
                let turn = [cosine, tangent * cosine];
                columns.rotate_rows([p, q], turn);
                shapes.rotate_rows([p, q], turn);
            }
        }
        if is_done {
            let squares = (0..n).map(|i| dot(columns.row(i), columns.row(i)));
            return Some((squares.collect(), shapes.transposed()));
        }
    }
    None
}
