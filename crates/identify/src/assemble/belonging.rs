//! Whether A, B and the assembly can belong together, whatever the joint: asked before anything is fitted.

use std::path::Path;

use bolted_joint_statistics::upper_median;
use nalgebra::DVector;
use num_complex::Complex64;

use super::super::lines::Lines;
use super::stiffer::{self, Errors};

/// Part of the functions by which half of the lines may be what no load at the joint does to B.
const OUTSIDE: f64 = 0.1;
/// Lines that are asked.
const ASKED: usize = 200;
/// Singular values of B below this part of the largest say nothing of how loads at the joint act.
const NEGLIGIBLE: f64 = 1e-6;

/// What speaks against A, B and the assembly, which is in this file; points of the assembly on A are not asked.
pub(super) fn warnings(lines: &Lines, errors: Errors<'_>, path: &Path) -> Vec<String> {
    if lines.apart.is_some() {
        return Vec::new();
    }
    let mut found = Vec::new();
    if let Some(part) = outside(lines).filter(|part| *part > OUTSIDE) {
        found.push(format!(
            "no load at the joint makes these functions of those of B: half of the lines are {:.0} % off whatever the joint is; the \
             points, signs or units of B and of the assembly are not the same",
            100.0 * part
        ));
    }
    let stiffer: Vec<(String, f64)> = stiffer::points(lines, errors)
        .into_iter()
        .map(|(point, part)| (lines.points[point].to_string(), part))
        .collect();
    let least = stiffer.iter().map(|(_, part)| *part);
    if let Some(least) = least.min_by(f64::total_cmp) {
        let names: Vec<&str> = stiffer.iter().map(|(name, _)| name.as_str()).collect();
        found.push(format!(
            "below the first resonance the assembly is stiffer at {} than A and B would be with a rigid joint: it yields {:.0} % of \
             that; units or gains of the assembly, of A or of B are wrong, or something else holds the assembly",
            names.join(", "),
            100.0 * least
        ));
    }
    let named = found.into_iter();
    named
        .map(|complaint| format!("{}: {complaint}", path.display()))
        .collect()
}

/// What is left of H_ss − H^C beside all that loads at the joint can do, as a part of both: the median over the lines.
///
/// H_ss − H^C = H_sk Z⁻¹ H_ks (Tol 3.17), so that its columns are combinations of those of H_sk. `None` where there are no more
/// points than the joint has DOFs, or no point whose responses were all measured.
fn outside(lines: &Lines) -> Option<f64> {
    let (points, dofs) = (lines.points.len(), lines.joint_dofs());
    if points <= dofs {
        return None;
    }
    let count = lines.frequency_hz.len();
    let asked = (0..count).step_by(count.div_ceil(ASKED).max(1));
    let parts = asked.filter_map(|line| {
        let b = lines.b_at(line);
        let u = bolted_joint_singular::complex(b.points_joint.clone())?;
        let largest = u.singular_values.max();
        let (values, u) = (u.singular_values, u.u?);
        let (mut left, mut whole) = (0.0, 0.0);
        for reference in 0..points {
            let assembled = lines.assembly[line].column(reference);
            if assembled.iter().any(|value| !value.is_finite()) {
                continue;
            }
            let own = b.points.column(reference);
            let mut change: DVector<Complex64> = own - assembled;
            for (direction, value) in u.column_iter().zip(&values) {
                if *value > NEGLIGIBLE * largest {
                    change -= direction * direction.dotc(&change);
                }
            }
            left += change.norm_squared();
            whole += (own.norm() + assembled.norm()).powi(2);
        }
        (whole > 0.0).then(|| (left / whole).sqrt())
    });
    upper_median(parts.filter(|part| part.is_finite()))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bolted_joint_frf::structure::ComplexMatrix;
    use bolted_joint_systematic::Budget;
    use nalgebra::DMatrix;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::noise::{Noise, NoiseLevel, StatedLevel};
    use crate::receptances::{MeasuredSubstructure, Receptances};

    fn said(lines: &Lines, noise: &Noise) -> Vec<String> {
        let budget = &Budget::default();
        warnings(lines, Errors { noise, budget }, Path::new("c.npz"))
    }

    /// Two masses on a spring, B: receptance between them.
    fn b_at(omega: f64) -> ComplexMatrix {
        let (mass_kg, k_n_per_m) = (0.5, Complex64::new(1e6, 1e3));
        let own = k_n_per_m - mass_kg * omega * omega;
        let stiffness = ComplexMatrix::from_row_slice(2, 2, &[own, -k_n_per_m, -k_n_per_m, own]);
        stiffness.try_inverse().unwrap()
    }

    /// A spring to the ground, A; a joint in between; the assembly is measured at both masses.
    fn lines(change: impl Fn(&mut ComplexMatrix)) -> Lines {
        let frequency_hz: Vec<f64> = (1..40).map(f64::from).collect();
        let omega = frequency_hz.iter().map(|hz| std::f64::consts::TAU * hz);
        let (ground, joint) = (Complex64::from(2e5), Complex64::from(3e5));
        let in_row = (ground.inv() + joint.inv()).inv();
        let b: Vec<ComplexMatrix> = omega
            .map(|omega| {
                let own = b_at(omega);
                ComplexMatrix::from_fn(3, 3, |i, j| own[(i.saturating_sub(1), j.saturating_sub(1))])
            })
            .collect();
        let assembly = b.iter().map(|b| {
            let mut stiffness = b.view((1, 1), (2, 2)).into_owned().try_inverse().unwrap();
            stiffness[(0, 0)] += in_row;
            let mut coupled = stiffness.try_inverse().unwrap();
            change(&mut coupled);
            coupled
        });
        Lines {
            a: Receptances::Exact(vec![
                ComplexMatrix::from_element(1, 1, ground.inv());
                b.len()
            ]),
            assembly: assembly.collect(),
            b: Receptances::Exact(b),
            apart: None,
            points: vec!["1:+Y".parse().unwrap(), "2:+Y".parse().unwrap()],
            measured: vec![(0, 0), (1, 0), (0, 1), (1, 1)],
            relative_variance: None,
            repeats: None,
            shown: crate::ShownNoise::default(),
            frequency_hz,
        }
    }

    #[test]
    fn an_assembly_of_a_and_b_belongs_to_them_whatever_the_joint() {
        let lines = lines(|_| ());
        assert!(outside(&lines).unwrap() < 1e-9);
        assert!(said(&lines, &Noise::default()).is_empty());
    }

    #[test]
    fn a_point_that_is_another_is_told_and_so_is_an_assembly_that_is_too_stiff() {
        let reversed = lines(|coupled| {
            coupled[(1, 0)] = -coupled[(1, 0)];
            coupled[(0, 1)] = -coupled[(0, 1)];
        });
        let is_told = |lines: &Lines, words: &str| {
            let said = said(lines, &Noise::default());
            said.iter().any(|said| said.contains(words))
        };
        assert!(is_told(&reversed, "no load at the joint"));
        let in_g = lines(|coupled| *coupled /= Complex64::from(9.80665));
        assert!(is_told(&in_g, "stiffer at 1:+Y, 2:+Y"));
    }

    /// B as it was measured with this noise, from 1 Hz on, where what it yields as a whole is 5000 times what A does.
    fn noisy(lines: Lines, relative: f64, seed: u64) -> Lines {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        let mut factor = || {
            let part = relative * std::f64::consts::FRAC_1_SQRT_2;
            Complex64::new(1.0 + part * normal(), part * normal())
        };
        let columns = (0..3).flat_map(|column| (0..=column).map(move |row| (row, column)));
        let places: Vec<(usize, usize)> = columns.collect();
        let mut function = |&(row, column): &(usize, usize)| -> Vec<Complex64> {
            let all = 0..lines.frequency_hz.len();
            all.map(|line| lines.b.at(line)[(row, column)] * factor())
                .collect()
        };
        let functions = places.iter().map(&mut function).collect();
        let measured = MeasuredSubstructure::new(DMatrix::identity(3, 3), functions, places, None);
        let measured = measured.with_axis(&lines.frequency_hz, vec![false; 3]);
        Lines {
            b: Receptances::Measured(Arc::new(measured)),
            ..lines
        }
    }

    #[test]
    fn the_noise_of_a_free_b_makes_no_assembly_too_stiff_and_hides_none_that_is() {
        let stated = Noise::of_the_assembly(StatedLevel::from(NoiseLevel {
            relative: 0.01,
            floor: 0.0,
        }));
        let stated = Noise {
            b: stated.assembly,
            ..stated
        };
        for noise in [Noise::default(), stated] {
            for seed in 0..60 {
                let good = noisy(lines(|_| ()), 0.01, seed);
                assert_eq!(said(&good, &noise), [""; 0], "{seed}");
                let in_g = lines(|coupled| *coupled /= Complex64::from(9.80665));
                let told = said(&noisy(in_g, 0.01, seed), &noise);
                let is_told = told.iter().any(|told| told.contains("stiffer at"));
                assert!(is_told, "{seed} {told:?}");
            }
        }
    }
}
