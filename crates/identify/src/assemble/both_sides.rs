//! Assemblies that were measured on both sides of the joint.
//!
//! Both structures, apart, are one structure, and the joint holds its motion u = y_B − y_A against the ground: with
//! H_uu = H_jj + H_kk, H_us = H_ks and H_ur = −H_jr,
//!
//! ```text
//! H^C = [H_ss 0; 0 H_rr] − H_pu (H_uu + K*⁻¹)⁻¹ H_up,   p = (s, r)
//! ```
//!
//! is (3.14) to (3.17) of Tol at once, and decoupling from it is (3.18) to (3.21). So everything that works on functions at points
//! of B alone works on these.

use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::receptances::{MeasuredSubstructure, Receptances};
use bolted_joint_frf::structure::ComplexMatrix;

/// A at the joint's DOFs and `of_a` points, B at the joint's DOFs and its points, as one structure at u, B's points and A's.
pub(super) fn as_one(
    a: &Receptances,
    b: &Receptances,
    dofs: usize,
    axis_hz: &[f64],
) -> Receptances {
    match (a, b) {
        (Receptances::Exact(a), Receptances::Exact(b)) => {
            let lines = a.iter().zip(b);
            Receptances::Exact(lines.map(|(a, b)| one_matrix(a, b, dofs)).collect())
        }
        _ => Receptances::Measured(Arc::new(one_measurement(
            [&Part::of(a), &Part::of(b)],
            dofs,
            axis_hz,
        ))),
    }
}

fn one_matrix(a: &ComplexMatrix, b: &ComplexMatrix, dofs: usize) -> ComplexMatrix {
    let (of_a, of_b) = (a.nrows(), b.nrows());
    let mut apart = ComplexMatrix::zeros(of_a + of_b, of_a + of_b);
    apart.view_mut((0, 0), (of_a, of_a)).copy_from(a);
    apart.view_mut((of_a, of_a), (of_b, of_b)).copy_from(b);
    let whole = transformation(
        [
            &DMatrix::identity(of_a, of_a),
            &DMatrix::identity(of_b, of_b),
        ],
        dofs,
    );
    let whole = whole.map(Complex64::from);
    &whole * apart * whole.transpose()
}

/// Motions u, of B's points and of A's, by the labels of A and then of B.
fn transformation([a, b]: [&DMatrix<f64>; 2], dofs: usize) -> DMatrix<f64> {
    let (of_a, of_b) = (a.nrows() - dofs, b.nrows() - dofs);
    let mut whole = DMatrix::zeros(dofs + of_b + of_a, a.ncols() + b.ncols());
    let mut put = |at: (usize, usize), rows: &DMatrix<f64>| {
        whole.view_mut(at, rows.shape()).copy_from(rows);
    };
    let first_of_b = a.ncols();
    put((0, 0), &-a.rows(0, dofs).into_owned());
    put((0, first_of_b), &b.rows(0, dofs).into_owned());
    put((dofs, first_of_b), &b.rows(dofs, of_b).into_owned());
    put((dofs + of_b, 0), &a.rows(dofs, of_a).into_owned());
    whole
}

/// A structure as functions between labels.
struct Part {
    functions: Arc<MeasuredSubstructure>,
    is_measured: bool,
}

impl Part {
    fn of(receptances: &Receptances) -> Self {
        match receptances {
            Receptances::Measured(measured) => Self {
                functions: Arc::clone(measured),
                is_measured: true,
            },
            Receptances::Exact(matrices) => {
                let size = matrices.first().map_or(0, ComplexMatrix::nrows);
                let of = |place| matrices.iter().map(|matrix| matrix[place]).collect();
                let functions = triangle(size).map(of).collect();
                let identity = DMatrix::identity(size, size);
                Self {
                    functions: Arc::new(MeasuredSubstructure::new(
                        identity,
                        functions,
                        Vec::new(),
                        None,
                    )),
                    is_measured: false,
                }
            }
        }
    }
}

/// Places of the upper triangle, column by column.
fn triangle(size: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..size).flat_map(|column| (0..=column).map(move |row| (row, column)))
}

fn one_measurement([a, b]: [&Part; 2], dofs: usize, axis_hz: &[f64]) -> MeasuredSubstructure {
    let (of_a, of_b) = (&a.functions, &b.functions);
    let whole = transformation([of_a.transformation(), of_b.transformation()], dofs);
    let first_of_b = of_a.transformation().ncols();
    let zeros = vec![Complex64::from(0.0); axis_hz.len()];
    let function = |(row, column): (usize, usize)| -> Vec<Complex64> {
        if column < first_of_b {
            of_a.function(row, column).as_ref().clone()
        } else if row >= first_of_b {
            of_b.function(row - first_of_b, column - first_of_b)
                .as_ref()
                .clone()
        } else {
            zeros.clone()
        }
    };
    let functions = triangle(whole.ncols()).map(function).collect();
    let later = of_b.measured().iter();
    let later = later.map(|&(row, column)| (row + first_of_b, column + first_of_b));
    let measured = of_a.measured().iter().copied().chain(later).collect();
    // what is not measured has no function whose noise is to be known
    let known = |part: &Part| match part.is_measured {
        true => part.functions.relative_variance().map(<[_]>::to_vec),
        false => Some(Vec::new()),
    };
    let variance = known(a).zip(known(b)).map(|(a, b)| [a, b].concat());
    let rotations = |part: &Part| -> Vec<bool> {
        let labels = 0..part.functions.transformation().ncols();
        labels
            .map(|label| part.functions.is_rotation(label))
            .collect()
    };
    let rotations: Vec<bool> = [rotations(a), rotations(b)].concat();
    let lost = [of_a, of_b].into_iter().filter_map(|part| part.lost());
    let lost = lost.cloned().reduce(|one, other| one + other);
    MeasuredSubstructure::new(whole, functions, measured, variance)
        .with_lost(lost)
        .with_axis(axis_hz, rotations)
}
