//! The few operations on small fixed-size vectors and matrices that the joint's equations need.

use crate::number::Number;

/// `matrix · vector`
#[inline]
pub(crate) fn product<const D: usize, N: Number>(matrix: &[[N; D]; D], vector: &[N; D]) -> [N; D] {
    core::array::from_fn(|row| dot(&matrix[row], vector))
}

/// `left · right`
#[inline]
pub(crate) fn dot<const D: usize, N: Number>(left: &[N; D], right: &[N; D]) -> N {
    let mut sum = N::ZERO;
    for i in 0..D {
        sum = sum + left[i] * right[i];
    }
    sum
}
