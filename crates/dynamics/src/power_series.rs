//! Polynomials of the squared displacement u = r² on u ≥ 0, by their coefficients, that of u⁰ first.

use crate::number::Number;

/// Σ cⱼ uʲ
#[inline]
pub(crate) fn value<N: Number>(coefficients: &[N], u: N) -> N {
    match coefficients.split_last() {
        None => N::ZERO,
        Some((&last, rest)) => rest.iter().rfold(last, |sum, &c| c + u * sum),
    }
}

/// The roots u > 0 at which the polynomial changes its sign, ascending.
pub(crate) fn positive_roots<const K: usize>(coefficients: &[f64; K]) -> Roots<K> {
    let mut roots = Roots {
        roots: [0.0; K],
        count: 0,
    };
    let degree = coefficients.iter().rposition(|&c| c != 0.0).unwrap_or(0);
    match degree {
        0 => {}
        1 => roots.push(-coefficients[0] / coefficients[1]),
        2 => {
            let [c, b, a] = [0, 1, 2].map(|j| coefficients[j]);
            // without cancellation for either sign of b
            let half = 0.5 * b;
            let discriminant = half * half - a * c;
            if discriminant > 0.0 {
                let larger = -(half + discriminant.sqrt().copysign(half));
                let (one, other) = (larger / a, c / larger);
                roots.push(one.min(other));
                roots.push(one.max(other));
            }
        }
        _ => {
            // between two turning points there is one root at the most
            let slope: [f64; K] = std::array::from_fn(|j| {
                let next = coefficients.get(j + 1).copied().unwrap_or(0.0);
                (j + 1) as f64 * next
            });
            let mut low = 0.0;
            for turn in positive_roots(&slope) {
                roots.extend_between(coefficients, low, turn);
                low = turn;
            }
            roots.extend_between(coefficients, low, f64::INFINITY);
        }
    }
    roots
}

/// Largest u ≥ 0 up to which the polynomial is not negative; `None` where it never is.
pub(crate) fn first_negative<const K: usize>(coefficients: &[f64; K]) -> Option<f64> {
    let lowest = coefficients.iter().find(|&&c| c != 0.0)?;
    if *lowest < 0.0 {
        return Some(0.0);
    }
    // it begins above zero, and the first change of sign takes it below
    positive_roots(coefficients).into_iter().next()
}

/// Up to `K` roots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots<const K: usize> {
    roots: [f64; K],
    count: usize,
}

impl<const K: usize> Roots<K> {
    fn push(&mut self, root: f64) {
        if root > 0.0
            && root.is_finite()
            && let Some(place) = self.roots.get_mut(self.count)
        {
            *place = root;
            self.count += 1;
        }
    }

    /// Adds the root between `low` and `high`, where the polynomial is monotone, if there is one.
    fn extend_between(&mut self, coefficients: &[f64; K], low: f64, high: f64) {
        let is_negative = |u: f64| value(coefficients, u) < 0.0;
        let (mut low, mut high) = (low, high);
        let begins = match low {
            0.0 => coefficients
                .iter()
                .find(|&&c| c != 0.0)
                .is_some_and(|&c| c < 0.0),
            _ => is_negative(low),
        };
        if high == f64::INFINITY {
            high = if low > 0.0 { 2.0 * low } else { 1.0 };
            while high < f64::MAX && is_negative(high) == begins {
                high *= 4.0;
            }
        }
        if !high.is_finite() || is_negative(high) == begins {
            return;
        }
        loop {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                break;
            }
            if is_negative(middle) == begins {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.push(high);
    }
}

impl<const K: usize> IntoIterator for Roots<K> {
    type Item = f64;
    type IntoIter = std::iter::Take<std::array::IntoIter<f64, K>>;

    fn into_iter(self) -> Self::IntoIter {
        self.roots.into_iter().take(self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_products_are_found() {
        // (u − 1)(u − 2)(u − 5), (u + 1)(u − 3)², (u − 1e-9)(u − 1e9)(u + 1)
        for (coefficients, expected) in [
            ([-10.0, 17.0, -8.0, 1.0], &[1.0, 2.0, 5.0][..]),
            ([9.0, 3.0, -5.0, 1.0], &[]),
            (
                [1.0, 1.0 - 1e9 - 1e-9, -1e9 - 1e-9 + 1.0, 1.0],
                &[1e-9, 1e9],
            ),
            ([6.0, -5.0, 1.0, 0.0], &[2.0, 3.0]),
            ([-6.0, 2.0, 0.0, 0.0], &[3.0]),
            ([0.0, -4.0, 1.0, 0.0], &[4.0]),
            ([0.0, 0.0, 0.0, 0.0], &[]),
        ] {
            let found: Vec<f64> = positive_roots(&coefficients).into_iter().collect();
            assert_eq!(found.len(), expected.len(), "{coefficients:?}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
            }
        }
    }

    #[test]
    fn the_first_change_to_less_than_nothing_is_found() {
        for (coefficients, expected) in [
            (
                [10.0, -10.0 * (1.0 / 4.0 + 1.0 / 9.0), 10.0 / 36.0],
                Some(4.0),
            ),
            (
                [10.0, 10.0 * (1.0 / 4.0 - 1.0 / 9.0), -10.0 / 36.0],
                Some(9.0),
            ),
            ([10.0, -10.0 / 9.0, 0.0], Some(9.0)),
            ([0.0, 1.0, -1.0 / 9.0], Some(9.0)),
            ([10.0, 0.0, -10.0 / 81.0], Some(9.0)),
            ([1.0, 1.0, 0.0], None),
            ([0.0, 0.0, 0.0], None),
            ([1.0, -1.9, 1.0], None),
            ([0.0, 1.0, 2.0], None),
            ([0.0, -1.0, 5.0], Some(0.0)),
            ([0.0, 0.0, -1.0], Some(0.0)),
            ([-1.0, -1.0, 0.0], Some(0.0)),
        ] {
            match (first_negative(&coefficients), expected) {
                (Some(found), Some(expected)) if expected > 0.0 => {
                    assert!((found / expected - 1.0).abs() < 1e-14, "{coefficients:?}");
                }
                (found, expected) => assert_eq!(found, expected, "{coefficients:?}"),
            }
        }
    }
}
