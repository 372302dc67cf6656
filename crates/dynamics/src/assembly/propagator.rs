//! What an assembly's state becomes over a step of a given length: exactly, for loads and joint forces that are polynomials of
//! time.
//!
//! With y = (q, q̇), ẏ = A y + X w, w = (u, f), X = (0; B, −Sᵀ), and w(t) = w₀ + w₁ θ + w₂ θ²/2 + w₃ θ³/6 + w₄ θ⁴/24 with θ = t/h:
//!
//! y(h) = E y + hφ₁X w₀ + hφ₂X w₁ + … + hφ₅X w₄,  E = φ₀ = e^{hA},  φ_{k+1} = (φ_k − 1/k!)/(hA)
//!
//! All of them, and the integrals of the motion that the work of the forces takes, are blocks of one exponential, with no
//! inverse, so that motions of free bodies need no care. That of twice the length is its square.

use std::ops::Range;

use super::{exponential::Growth, matrix::Matrix, modal::Turns, system::System};

/// Powers of time that the joints' forces of a step have: constant to quartic. Loads go up to the cube.
pub(super) const POWERS: usize = 5;
/// Integrals of the motion over the step that the work of the forces takes: as often integrated.
pub(super) const MOMENTS: usize = POWERS - 1;

/// Blocks of the exponential for one length.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// E, 2n × 2n.
    pub(super) state: Going,
    /// (hφ₁X)ᵀ to (hφ₅X)ᵀ, one under the other: what each load and force adds stands side by side. 5 (m + d) × 2n.
    pub(super) by: Matrix,
    /// What ∫ Rq dθ, with R = (Bᵀ; S), and the integrals over it take of y, place by place: 4 (m + d) × 2n.
    pub(super) moments: Matrix,
    /// What they take of w₀ to w₄: 4 (m + d) × 5 (m + d).
    pub(super) moments_by: Matrix,
}

impl Blocks {
    /// Of E, (hφ₁X)ᵀ to (hφ₅X)ᵀ, and what each integral takes of y and of w₀ to w₄.
    pub(super) fn new(
        state: Going,
        by: [Matrix; POWERS],
        moments: &[Matrix; MOMENTS],
        moments_by: &[[Matrix; POWERS]; MOMENTS],
    ) -> Self {
        let [first, ..] = moments;
        let forces = first.rows();
        let place = |row: usize| (row % MOMENTS, row / MOMENTS);
        Self {
            state,
            by: Matrix::stacked(by.into_iter()),
            moments: Matrix::from_fn(MOMENTS * forces, first.columns(), |row, j| {
                let (moment, p) = place(row);
                moments[moment][(p, j)]
            }),
            moments_by: Matrix::from_fn(MOMENTS * forces, POWERS * forces, |row, j| {
                let (moment, p) = place(row);
                moments_by[moment][j / forces][(p, j % forces)]
            }),
        }
    }

    /// (hφ_{p+1}X)ᵀ of some loads and forces.
    pub(super) fn of_power(&self, power: usize, which: Range<usize>) -> Matrix {
        let forces = self.by.rows() / POWERS;
        let top = power * forces + which.start;
        self.by.block([top, 0], which.len(), self.by.columns())
    }
}

/// E as it is, or mode by mode.
#[derive(Clone, Debug)]
pub(super) enum Going {
    Whole(Matrix),
    Turning(Turns),
}

impl Going {
    /// Where a state goes: E y.
    pub(super) fn go_on(&self, from: &[f64], to: &mut [f64]) {
        match self {
            Self::Whole(matrix) => {
                to.fill(0.0);
                matrix.add_product_to(from, to);
            }
            Self::Turning(turns) => {
                to.copy_from_slice(from);
                turns.turn(to);
            }
        }
    }

    /// R E of some rows.
    pub(super) fn seen_by(&self, rows: &Matrix) -> Matrix {
        match self {
            Self::Whole(matrix) => rows.product(matrix),
            Self::Turning(turns) => turns.seen_by(rows),
        }
    }

    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Whole(matrix) => matrix.is_finite(),
            Self::Turning(turns) => turns.is_finite(),
        }
    }
}

/// The exponential itself, in (D q, q̇) and in parts θ of the longest length.
#[derive(Clone, Debug)]
pub(super) struct Propagator<'s> {
    system: &'s System,
    scale: Vec<f64>,
    growth: Growth,
    /// How often the length is half of the longest.
    level: i32,
}

impl<'s> Propagator<'s> {
    /// That of steps of `length_s` (s) halved so many times; `None` where it is not finite.
    pub(super) fn new(system: &'s System, length_s: f64, level: usize) -> Option<Self> {
        let n = system.size;
        let rows = Rows::of(system);
        // in (D q, q̇) all entries of A are frequencies, which keeps the digits
        let (h, scale) = (length_s, scale(system));
        let mut whole = Matrix::zeros(rows.count(), rows.count());
        let y = rows.y();
        for i in 0..n {
            whole[(y + i, y + n + i)] = h * scale[i];
            for j in 0..n {
                whole[(y + n + i, y + j)] = -h * system.stiffness[(i, j)] / scale[j];
                whole[(y + n + i, y + n + j)] = -h * system.damping[(i, j)];
            }
        }
        for p in 0..rows.forces {
            // dz₁/dθ = R q, dz₂/dθ = z₁ …
            for moment in 1..MOMENTS {
                whole[(rows.z(moment) + p, rows.z(moment - 1) + p)] = 1.0;
            }
            for j in 0..n {
                let row = force_row(system, p, j);
                let sign = if p < system.loads { 1.0 } else { -1.0 };
                whole[(rows.z(0) + p, y + j)] = row / scale[j];
                whole[(y + n + j, rows.w(0) + p)] = h * sign * row;
            }
            for power in 1..POWERS {
                whole[(rows.w(power - 1) + p, rows.w(power) + p)] = 1.0;
            }
        }
        let level = level as i32;
        Some(Self {
            system,
            scale,
            growth: Growth::of(&whole.times(0.5_f64.powi(level)))?,
            level,
        })
    }

    /// That of steps of twice the length; `None` where it is not finite.
    pub(super) fn doubled(&self) -> Option<Self> {
        Some(Self {
            system: self.system,
            scale: self.scale.clone(),
            growth: self.growth.doubled()?,
            level: self.level - 1,
        })
    }

    /// The blocks that steps take.
    pub(super) fn blocks(&self) -> Blocks {
        let n = self.system.size;
        let (rows, scale) = (Rows::of(self.system), &self.scale);
        // back to (q, q̇)
        let unit = |i: usize| if i < n { scale[i] } else { 1.0 };
        let part = |[top, left]: [usize; 2],
                    rows: usize,
                    columns: usize,
                    factor: &dyn Fn(usize, usize) -> f64| {
            Matrix::from_fn(rows, columns, |i, j| {
                self.growth.exponential(top + i, left + j) * factor(i, j)
            })
        };
        // w_k and z_k in parts of the own length are those in parts of the longest times (own/longest)^±k
        let powers = |of_row: usize, of_column: usize| {
            2.0_f64.powi(self.level * (of_row + of_column) as i32)
        };
        let (y, forces) = (rows.y(), rows.forces);
        Blocks::new(
            Going::Whole(part([y, y], 2 * n, 2 * n, &|i, j| unit(j) / unit(i))),
            std::array::from_fn(|power| {
                let own = powers(0, power);
                part([y, rows.w(power)], 2 * n, forces, &|i, _| own / unit(i)).transposed()
            }),
            &std::array::from_fn(|moment| {
                let own = powers(moment + 1, 0);
                part([rows.z(moment), y], forces, 2 * n, &|_, j| own * unit(j))
            }),
            &std::array::from_fn(|moment| {
                std::array::from_fn(|power| {
                    let own = powers(moment + 1, power);
                    part([rows.z(moment), rows.w(power)], forces, forces, &|_, _| own)
                })
            }),
        )
    }
}

/// Where the quantities stand in the exponential.
#[derive(Clone, Copy, Debug)]
struct Rows {
    size: usize,
    forces: usize,
}

impl Rows {
    fn of(system: &System) -> Self {
        Self {
            size: system.size,
            forces: system.loads + system.forces(),
        }
    }

    /// First row of an integral.
    fn z(self, moment: usize) -> usize {
        (MOMENTS - 1 - moment) * self.forces
    }

    /// First row of the state.
    fn y(self) -> usize {
        MOMENTS * self.forces
    }

    /// First row of a power of time.
    fn w(self, power: usize) -> usize {
        self.y() + 2 * self.size + power * self.forces
    }

    fn count(self) -> usize {
        self.w(POWERS)
    }
}

/// Row of R = (Bᵀ; S) for a load or a joint force.
fn force_row(system: &System, force: usize, coordinate: usize) -> f64 {
    match force.checked_sub(system.loads) {
        None => system.load_rows[(force, coordinate)],
        Some(law) => system.rows[(law, coordinate)],
    }
}

/// D: the frequency of each coordinate, but at least the lowest that there is, rad/s.
pub(super) fn scale(system: &System) -> Vec<f64> {
    let own = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let positive = (0..system.size).map(own).filter(|&own| own > 0.0);
    let least = positive.fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { least } else { 1.0 };
    (0..system.size).map(|i| own(i).max(least)).collect()
}
