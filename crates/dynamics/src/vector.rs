//! The few operations on small fixed-size vectors and matrices that the joint's equations need.

/// `matrix · vector`
#[inline]
pub(crate) fn product<const D: usize>(matrix: &[[f64; D]; D], vector: &[f64; D]) -> [f64; D] {
    core::array::from_fn(|row| dot(&matrix[row], vector))
}

/// `left · right`
#[inline]
pub(crate) fn dot<const D: usize>(left: &[f64; D], right: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for i in 0..D {
        sum += left[i] * right[i];
    }
    sum
}
