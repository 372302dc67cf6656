//! FRF decoupling: the joint's complex stiffness at each line from substructures and assembly (Tol 3.18 to 3.21).

use num_complex::Complex64;

use bolted_joint_frf::structure::{ComplexMatrix, Partition};

/// Which receptances of the assembly are decoupled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equation {
    /// H^C_rr, at points of A (Tol 3.18).
    Rr,
    /// H^C_rs, points of A for loads on B (Tol 3.19).
    Rs,
    /// H^C_sr, points of B for loads on A (Tol 3.20).
    Sr,
    /// H^C_ss, at points of B (Tol 3.21).
    Ss,
}

/// What takes the place of the inner inverse where there are more points than joint DOFs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inverse {
    /// The least-squares solution.
    LeastSquares,
    /// The inverse of the equation as printed (approach 4 of Tol 4.2.2), which only noise makes possible.
    AsPrinted,
}

/// K* at one line by one of the four equations; `assembly` is the block of receptances that it names.
///
/// `None` where a matrix that has to be inverted is singular or not square.
#[must_use]
pub fn decouple(
    equation: Equation,
    inverse: Inverse,
    a: &Partition,
    b: &Partition,
    assembly: &ComplexMatrix,
) -> Option<ComplexMatrix> {
    match inverse {
        Inverse::LeastSquares => match equation {
            Equation::Rr => from_rr(a, b, assembly),
            Equation::Rs => from_rs(a, b, assembly),
            Equation::Sr => from_sr(a, b, assembly),
            Equation::Ss => from_ss(a, b, assembly),
        },
        Inverse::AsPrinted => {
            let (left, difference, right) = match equation {
                Equation::Rr => (&a.points_joint, &a.points - assembly, &a.joint_points),
                Equation::Rs => (&a.points_joint, assembly.clone(), &b.joint_points),
                Equation::Sr => (&b.points_joint, assembly.clone(), &a.joint_points),
                Equation::Ss => (&b.points_joint, &b.points - assembly, &b.joint_points),
            };
            let is_square = difference.nrows() == difference.ncols();
            let inner = is_square.then(|| difference.try_inverse()).flatten()?;
            joint(right * inner * left, a, b)
        }
    }
}

/// The blocks of one bolt, from 0, in the decoupled K* of several bolts with `dofs` DOFs each (Tol 3.27).
#[must_use]
pub fn of_bolt(
    decoupled: &[Option<ComplexMatrix>],
    bolt: usize,
    dofs: usize,
) -> Vec<Option<ComplexMatrix>> {
    let block = |whole: &ComplexMatrix| {
        let start = bolt * dofs;
        whole.view((start, start), (dofs, dofs)).into_owned()
    };
    decoupled
        .iter()
        .map(|whole| whole.as_ref().map(block))
        .collect()
}

/// K* from the assembly's receptances at points of A (Tol 3.18).
///
/// `None` where a matrix that has to be inverted is singular.
#[must_use]
pub fn from_rr(a: &Partition, b: &Partition, assembly_rr: &ComplexMatrix) -> Option<ComplexMatrix> {
    // K* = [H_jr (H_rr − H^C_rr)⁻¹ H_rj − H_jj − H_kk]⁻¹   (Tol 3.18)
    let z = interface_receptance(&a.points_joint, &(&a.points - assembly_rr), &a.joint_points)?;
    joint(z, a, b)
}

/// K* from the assembly's receptances at points of A for loads at points of B (Tol 3.19).
///
/// `None` where a matrix that has to be inverted is singular, or not square for want of points on one side.
#[must_use]
pub fn from_rs(a: &Partition, b: &Partition, assembly_rs: &ComplexMatrix) -> Option<ComplexMatrix> {
    // K* = [H_ks (H^C_rs)⁻¹ H_rj − H_jj − H_kk]⁻¹   (Tol 3.19)
    let z = interface_receptance(&a.points_joint, assembly_rs, &b.joint_points)?;
    joint(z, a, b)
}

/// K* from the assembly's receptances at points of B for loads at points of A (Tol 3.20).
///
/// `None` where a matrix that has to be inverted is singular, or not square for want of points on one side.
#[must_use]
pub fn from_sr(a: &Partition, b: &Partition, assembly_sr: &ComplexMatrix) -> Option<ComplexMatrix> {
    // K* = [H_jr (H^C_sr)⁻¹ H_sk − H_jj − H_kk]⁻¹   (Tol 3.20)
    let z = interface_receptance(&b.points_joint, assembly_sr, &a.joint_points)?;
    joint(z, a, b)
}

/// K* from the assembly's receptances at points of B (Tol 3.21), the practical one: of A it needs H_jj alone.
///
/// `None` where a matrix that has to be inverted is singular.
#[must_use]
pub fn from_ss(a: &Partition, b: &Partition, assembly_ss: &ComplexMatrix) -> Option<ComplexMatrix> {
    // K* = [H_ks (H_ss − H^C_ss)⁻¹ H_sk − H_jj − H_kk]⁻¹   (Tol 3.21)
    let z = interface_receptance(&b.points_joint, &(&b.points - assembly_ss), &b.joint_points)?;
    joint(z, a, b)
}

/// Z from Δ = L Z⁻¹ R, where Δ (points × points) is what the joint does to the receptances.
///
/// With as many points as joint DOFs, or fewer, this is the product R Δ⁻¹ L of the printed equations, which needs as many
/// points on both sides. With more points Δ has the rank of the joint, and no inverse unless noise lends it one; then
/// Z⁻¹ = L⁺ Δ R⁺ is the least-squares solution, which uses all points.
fn interface_receptance(
    left: &ComplexMatrix,
    difference: &ComplexMatrix,
    right: &ComplexMatrix,
) -> Option<ComplexMatrix> {
    let joint_dofs = left.ncols();
    let (rows, columns) = difference.shape();
    if rows.min(columns) > joint_dofs || rows != columns && rows.min(columns) == joint_dofs {
        return (pseudo_inverse(left)? * difference * pseudo_inverse(right)?).try_inverse();
    }
    if rows != columns {
        return None;
    }
    Some(right * difference.clone().try_inverse()? * left)
}

fn pseudo_inverse(matrix: &ComplexMatrix) -> Option<ComplexMatrix> {
    // Columns of rotation and translation differ in units; scaled to unit length they can be told from rounding.
    let tall = matrix.nrows() >= matrix.ncols();
    let tall_matrix = if tall {
        matrix.clone()
    } else {
        matrix.transpose()
    };
    let lengths: Vec<f64> = tall_matrix
        .column_iter()
        .map(|column| column.norm())
        .collect();
    if lengths
        .iter()
        .any(|&length| !(length.is_finite() && length > 0.0))
    {
        return None;
    }
    let mut scaled = tall_matrix;
    for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
        column /= Complex64::from(*length);
    }
    let mut inverse = bolted_joint_singular::complex(scaled)?
        .pseudo_inverse(1e-13)
        .ok()?;
    for (mut row, length) in inverse.row_iter_mut().zip(&lengths) {
        row /= Complex64::from(*length);
    }
    Some(if tall { inverse } else { inverse.transpose() })
}

/// K* = (Z − H_jj − H_kk)⁻¹
fn joint(z: ComplexMatrix, a: &Partition, b: &Partition) -> Option<ComplexMatrix> {
    let stiffness = (z - &a.joint - &b.joint).try_inverse()?;
    stiffness
        .iter()
        .all(|entry| entry.re.is_finite() && entry.im.is_finite())
        .then_some(stiffness)
}
