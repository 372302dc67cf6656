//! Whether A, B and the assembly can belong together, whatever the joint: asked before anything is fitted.

use std::path::Path;

use nalgebra::DVector;
use num_complex::Complex64;

use super::super::lines::Lines;
use bolted_joint_frf::structure::{ComplexMatrix, Partition};

/// Part of the functions by which half of the lines may be what no load at the joint does to B.
const OUTSIDE: f64 = 0.1;
/// Below the first resonance an assembly that yields less than this part of what it would with a rigid joint is none of A and B.
const OF_RIGID: f64 = 0.6;
/// Lines below the first resonance that are enough to tell.
const ENOUGH_LINES: usize = 3;
/// Lines that are asked.
const ASKED: usize = 200;
/// Singular values of B below this part of the largest say nothing of how loads at the joint act.
const NEGLIGIBLE: f64 = 1e-6;

/// What speaks against A, B and the assembly, which is in this file; points of the assembly on A are not asked.
pub(super) fn warnings(lines: &Lines, path: &Path) -> Vec<String> {
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
    let stiffer: Vec<(String, f64)> = (0..lines.points.len())
        .filter_map(|point| {
            let part = of_rigid(lines, point).filter(|part| *part < OF_RIGID)?;
            Some((lines.points[point].to_string(), part))
        })
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
    median(parts)
}

/// What the assembly yields at a point as a part of what it would with a rigid joint: the median over the lines below the first
/// resonance; `None` where there are too few of them.
///
/// A joint in between adds compliance: as long as equally many modes lie below a line, H^C(K*) − H^C(∞) is positive semidefinite
/// there, without damping.
fn of_rigid(lines: &Lines, point: usize) -> Option<f64> {
    let pairs = (0..lines.frequency_hz.len().min(ASKED)).map_while(|line| {
        let measured = lines.assembly[line][(point, point)].re;
        let rigid = rigidly(&lines.a.at(line), &lines.b_at(line))?[(point, point)].re;
        (measured > 0.0 && rigid > 0.0).then_some(measured / rigid)
    });
    let parts: Vec<f64> = pairs.collect();
    (parts.len() >= ENOUGH_LINES).then(|| median(parts.into_iter()))?
}

/// H_ss − H_sk (H_jj + H_kk)⁻¹ H_ks: with a rigid joint.
fn rigidly(a: &ComplexMatrix, b: &Partition) -> Option<ComplexMatrix> {
    let loads = (a + &b.joint).lu().solve(&b.joint_points)?;
    Some(&b.points - &b.points_joint * loads)
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Receptances;

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
            floors: std::sync::OnceLock::new(),
            frequency_hz,
        }
    }

    #[test]
    fn an_assembly_of_a_and_b_belongs_to_them_whatever_the_joint() {
        let lines = lines(|_| ());
        assert!(outside(&lines).unwrap() < 1e-9);
        assert!(of_rigid(&lines, 0).unwrap() > 1.0);
        assert!(warnings(&lines, Path::new("c.npz")).is_empty());
    }

    #[test]
    fn a_point_that_is_another_is_told_and_so_is_an_assembly_that_is_too_stiff() {
        let reversed = lines(|coupled| {
            coupled[(1, 0)] = -coupled[(1, 0)];
            coupled[(0, 1)] = -coupled[(0, 1)];
        });
        let said = warnings(&reversed, Path::new("c.npz"));
        assert!(
            said.iter()
                .any(|said| said.contains("no load at the joint"))
        );
        let in_g = lines(|coupled| *coupled /= Complex64::from(9.80665));
        let said = warnings(&in_g, Path::new("c.npz"));
        assert!(
            said.iter()
                .any(|said| said.contains("stiffer at 1:+Y, 2:+Y"))
        );
    }
}
