//! A smooth fit of a structure's measured functions: with it it is known, without their noise, how they change with frequency.
//!
//! Derivatives by a frequency scale, by a position and the like that were taken from noisy functions would read the noise as
//! information. All functions have their poles in common: H_e(s) = Σ_n R_en/((s − p_n)(s − p_n*)) + B_e0/s² + B_e1 + B_e2 s²,
//! found by relocating the poles until they rest (vector fitting; Gustavsen and Semlyen 1999).

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::experiment::{Entry, MeasuredFunctions};
use super::line::variance;

/// Beside the poles: rigid body, modes below and above the range.
const BESIDE: usize = 3;
/// Numbers of poles that are tried, one after the other, until more of them are in vain.
const FEWEST: usize = 2;
const MOST: usize = 16;
/// Most relocations …
const RELOCATIONS: usize = 12;
/// … which end when the poles move by less than this part of their half-widths.
const AT_REST: f64 = 1e-4;
/// So many further poles may be in vain before no more are tried.
const PATIENCE: usize = 3;
/// Above this χ² per degree of freedom a fit is none.
const NO_FIT: f64 = 4.0;
/// Damping ratio of the first poles.
const FIRST_DAMPING: f64 = 0.01;

/// The fit of all functions of a structure.
#[derive(Clone, Debug)]
pub(crate) struct ModalFit {
    /// Angular frequency that s is divided by, rad/s.
    scale: f64,
    /// p_n over the scale
    poles: Vec<Complex64>,
    /// R_en and B_e of each entry; none where it is zero or not measured.
    residues: Vec<Option<DVector<Complex64>>>,
    /// H of each entry at each line.
    values: Vec<Vec<Option<Complex64>>>,
    /// χ² per degree of freedom.
    reduced_chi_squared: f64,
    /// n ln(χ²/n) + k ln n for n numbers and k unknowns: what poles have to pay for (BIC; Schwarz 1978).
    criterion: f64,
}

impl ModalFit {
    /// `None` where no fit comes near the functions.
    pub(crate) fn of(functions: &MeasuredFunctions, omega: &[f64]) -> Option<Self> {
        let mut best: Option<Self> = None;
        let mut worse = 0;
        for count in FEWEST..=MOST.min(omega.len() / 4) {
            let fit = Self::with_poles(functions, omega, count);
            let criterion = |fit: &Self| fit.criterion;
            let is_better = match (&fit, &best) {
                (Some(fit), Some(best)) => criterion(fit) < criterion(best),
                (fit, None) => fit.is_some(),
                (None, _) => false,
            };
            worse = if is_better { 0 } else { worse + 1 };
            if is_better {
                best = fit;
            }
            if worse >= PATIENCE {
                break;
            }
        }
        let best = best.filter(|best| best.reduced_chi_squared < NO_FIT)?;
        let values = omega.iter().map(|&omega| best.values_at(omega)).collect();
        Some(Self { values, ..best })
    }

    fn with_poles(functions: &MeasuredFunctions, omega: &[f64], count: usize) -> Option<Self> {
        let scale = *omega.last()?;
        let s: Vec<Complex64> = omega
            .iter()
            .map(|omega| Complex64::new(0.0, omega / scale))
            .collect();
        let (first, last) = (s[0].im, 1.0);
        let mut poles: Vec<Complex64> = (0..count)
            .map(|n| first + (last - first) * (n as f64 + 0.5) / count as f64)
            .map(|at| Complex64::new(-FIRST_DAMPING * at, at))
            .collect();
        let samples: Vec<Option<Samples>> = functions.entries.iter().map(Samples::of).collect();
        for _ in 0..RELOCATIONS {
            let moved = relocated(&poles, &s, &samples)?;
            let is_at_rest = are_at_rest(&poles, &moved);
            poles = moved;
            if is_at_rest {
                break;
            }
        }
        // the poles are shared: each costs one complex number in all
        let (mut chi_squared, mut numbers, mut unknowns) = (0.0, 0.0, 2.0 * count as f64);
        let mut residues = Vec::with_capacity(samples.len());
        for sample in &samples {
            let Some(sample) = sample else {
                residues.push(None);
                continue;
            };
            let triangle = triangle(count + BESIDE, &s, sample, |s, value, row| {
                basis(&poles, s, row);
                row.push(value);
            });
            let own = count + BESIDE;
            let (system, target) = (
                triangle.view((0, 0), (own, own)).into_owned(),
                triangle.view((0, own), (own, 1)).column(0).into_owned(),
            );
            let solved = least_squares(&system, &target)?;
            numbers += 2.0 * s.len() as f64;
            unknowns += 2.0 * solved.len() as f64;
            // what no residues explain, and what these leave of the rest
            let beyond = triangle[(own, own)].norm_sqr();
            chi_squared += 2.0 * (beyond + (system * &solved - target).norm_squared());
            residues.push(Some(solved));
        }
        (numbers > unknowns).then(|| Self {
            scale,
            poles,
            residues,
            values: Vec::new(),
            reduced_chi_squared: chi_squared / (numbers - unknowns),
            criterion: numbers * (chi_squared / numbers).ln() + unknowns * numbers.ln(),
        })
    }

    /// H of each entry at a line; `None` where it is not measured.
    pub(crate) fn values(&self, line: usize) -> &[Option<Complex64>] {
        &self.values[line]
    }

    fn values_at(&self, omega: f64) -> Vec<Option<Complex64>> {
        let s = Complex64::new(0.0, omega / self.scale);
        let mut row = Vec::with_capacity(self.poles.len() + BESIDE);
        basis(&self.poles, s, &mut row);
        let value = |residues: &DVector<Complex64>| -> Complex64 {
            let parts = row.iter().zip(residues.iter());
            parts.map(|(part, residue)| part * residue).sum()
        };
        let residues = self.residues.iter();
        residues.map(|of| of.as_ref().map(value)).collect()
    }

    /// R(ε) = (1 + ε)⁻² H(ω/(1 + ε))/H(ω) of each entry at a line; 1 where it is not measured.
    pub(crate) fn ratios(&self, line: usize, omega: f64, epsilon: f64) -> Vec<Complex64> {
        let moved = self.values_at(omega / (1.0 + epsilon));
        let pairs = moved.into_iter().zip(&self.values[line]);
        let ratio = |(moved, value): (Option<Complex64>, &Option<Complex64>)| match (moved, value) {
            (Some(moved), Some(value)) => moved / value / (1.0 + epsilon).powi(2),
            _ => Complex64::from(1.0),
        };
        pairs.map(ratio).collect()
    }
}

/// One function with its weights.
struct Samples {
    values: Vec<Complex64>,
    /// 1/σ
    weights: Vec<f64>,
}

impl Samples {
    fn of(entry: &Entry) -> Option<Self> {
        let weights: Vec<f64> = (0..entry.values.len())
            .map(|line| variance(entry, line).sqrt().recip())
            .collect();
        let is_usable =
            !entry.measurements.is_empty() && weights.iter().all(|weight| weight.is_finite());
        is_usable.then(|| Self {
            values: entry.values.clone(),
            weights,
        })
    }
}

/// Appends 1/((s − p_n)(s − p_n*)), then 1/s², 1, s².
fn basis(poles: &[Complex64], s: Complex64, row: &mut Vec<Complex64>) {
    let squared = s * s;
    let of_pole = |pole: &Complex64| ((s - pole) * (s - pole.conj())).inv();
    row.extend(poles.iter().map(of_pole));
    row.extend([squared.inv(), Complex64::from(1.0), squared]);
}

/// R of the QR decomposition of a matrix with this row for each line, of s and H, times 1/σ: it says as much as all lines.
fn triangle(
    unknowns: usize,
    s: &[Complex64],
    sample: &Samples,
    append: impl Fn(Complex64, Complex64, &mut Vec<Complex64>),
) -> DMatrix<Complex64> {
    let mut rows = Vec::with_capacity(s.len() * (unknowns + 1));
    for ((&s, &value), &weight) in s.iter().zip(&sample.values).zip(&sample.weights) {
        let from = rows.len();
        append(s, value, &mut rows);
        rows[from..].iter_mut().for_each(|part| *part *= weight);
    }
    DMatrix::from_row_slice(s.len(), unknowns + 1, &rows)
        .qr()
        .unpack_r()
}

/// Whether no pole moved by more than a small part of its half-width.
fn are_at_rest(before: &[Complex64], poles: &[Complex64]) -> bool {
    let is_near = |pole: &Complex64| {
        let mut before = before.iter();
        before.any(|before| (pole - before).norm() < AT_REST * pole.re.abs())
    };
    poles.iter().all(is_near)
}

/// Poles that fit better: zeros of σ(s) = 1 + Σ c_n/(s − p_n), where σH and σ are fitted together.
fn relocated(
    poles: &[Complex64],
    s: &[Complex64],
    samples: &[Option<Samples>],
) -> Option<Vec<Complex64>> {
    let count = poles.len();
    let mut stacked: Vec<DMatrix<Complex64>> = Vec::new();
    let mut right: Vec<Complex64> = Vec::new();
    // σ's columns and what they have to explain, behind the function's own residues
    let own = count + BESIDE;
    for sample in samples.iter().flatten() {
        let triangle = triangle(own + count, s, sample, |s, value, row| {
            basis(poles, s, row);
            row.extend(poles.iter().map(|pole| value / (s - pole)));
            row.push(-value);
        });
        // below the rows that the own residues can take up
        right.extend(triangle.view((own, own + count), (count, 1)).iter());
        stacked.push(triangle.view((own, own), (count, count)).into_owned());
    }
    let rows = stacked.iter().map(|matrix| matrix.nrows()).sum();
    let mut system = DMatrix::zeros(rows, count);
    let mut row = 0;
    for matrix in &stacked {
        system.view_mut((row, 0), matrix.shape()).copy_from(matrix);
        row += matrix.nrows();
    }
    let c = least_squares(&system, &DVector::from_vec(right))?;
    // zeros of σ: eigenvalues of diag(p) − 1 cᵀ
    let companion = DMatrix::from_fn(count, count, |i, j| {
        let diagonal = if i == j {
            poles[i]
        } else {
            Complex64::from(0.0)
        };
        diagonal - c[j]
    });
    if !companion
        .iter()
        .all(|value| value.re.is_finite() && value.im.is_finite())
    {
        return None;
    }
    let zeros = nalgebra::linalg::Schur::try_new(companion, f64::EPSILON, 10_000)?
        .unpack()
        .1
        .diagonal();
    // a pole that would grow is mirrored
    let stable = zeros
        .iter()
        .map(|zero| Complex64::new(-zero.re.abs().max(1e-9), zero.im));
    Some(stable.collect())
}

/// By QR with columns of equal length.
fn least_squares(
    matrix: &DMatrix<Complex64>,
    right: &DVector<Complex64>,
) -> Option<DVector<Complex64>> {
    let lengths: Vec<f64> = matrix
        .column_iter()
        .map(|column| column.norm().max(f64::MIN_POSITIVE))
        .collect();
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] / lengths[j]
    });
    let svd = bolted_joint_singular::complex(scaled)?;
    let solved = svd.solve(right, 1e-13).ok()?;
    Some(DVector::from_fn(solved.len(), |i, _| {
        solved[i] / lengths[i]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Three modes, a rigid body and what is above the range.
    fn truth(entry: usize, omega: f64) -> Complex64 {
        let modes = [
            (310.0, 0.003, 1.0),
            (1900.0, 0.004, -0.7),
            (5200.0, 0.002, 0.4),
        ];
        let sum: Complex64 = modes
            .iter()
            .enumerate()
            .map(|(mode, (natural, zeta, amplitude))| {
                let shape = amplitude * (1.0 + 0.3 * (entry * (mode + 1)) as f64);
                shape
                    / Complex64::new(
                        natural * natural - omega * omega,
                        2.0 * zeta * natural * omega,
                    )
            })
            .sum();
        sum - 0.4 / (omega * omega) + 2e-8
    }

    #[test]
    fn noise_does_not_reach_the_change_with_frequency() {
        let omega: Vec<f64> = (3..250).map(|line| 25.0 * f64::from(line)).collect();
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        let noise = 0.01;
        let entries = (0..3).map(|entry| {
            let clean: Vec<Complex64> = omega.iter().map(|omega| truth(entry, *omega)).collect();
            let values = clean.iter().map(|value| {
                value
                    * (1.0
                        + Complex64::new(normal(), normal())
                            * (noise * std::f64::consts::FRAC_1_SQRT_2))
            });
            Entry {
                place: (entry, entry),
                measurements: vec![(entry, entry)],
                values: values.collect(),
                variance: clean
                    .iter()
                    .map(|value| noise * noise * value.norm_sqr())
                    .collect(),
            }
        });
        let functions = MeasuredFunctions {
            is_translation: vec![true; 3],
            positions_m: Vec::new(),
            entries: entries.collect(),
        };
        let fit = ModalFit::of(&functions, &omega).unwrap();
        assert_eq!(fit.poles.len(), 3);
        assert!(
            (fit.reduced_chi_squared - 1.0).abs() < 0.1,
            "{}",
            fit.reduced_chi_squared
        );
        let epsilon = 2e-3;
        for entry in 0..3 {
            for (line, omega) in omega.iter().enumerate() {
                let expected = truth(entry, omega / (1.0 + epsilon))
                    / truth(entry, *omega)
                    / (1.0 + epsilon).powi(2);
                let found = fit.ratios(line, *omega, epsilon)[entry];
                // ten times less than the change that one per cent of noise would feign
                assert!(
                    (found - expected).norm() < 0.01 * expected.norm(),
                    "{entry} {omega}: {found}, not {expected}"
                );
            }
        }
    }
}
