//! The middle of values, which stands for all of them where a few may be far off.

/// The middle one of the values, and of an even count the upper one of the two in the middle; `None` of none.
///
/// It is always one of the values, as where lines or functions are judged by a typical one among them. For a middle between two
/// there is [`median`].
///
/// Values are ordered as [`f64::total_cmp`] does, so that NaN comes last: who may have such values leaves them out first.
///
/// ```
/// use bolted_joint_statistics::upper_median;
///
/// assert_eq!(upper_median([3.0, 1.0, 2.0]), Some(2.0));
/// assert_eq!(upper_median([4.0, 1.0, 3.0, 2.0]), Some(3.0));
/// assert_eq!(upper_median([]), None);
/// ```
#[must_use]
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The middle one of the values, and of an even count the mean of the two in the middle; `None` of none.
///
/// NaN comes last, as with [`upper_median`].
///
/// ```
/// assert_eq!(bolted_joint_statistics::median([4.0, 1.0, 3.0, 2.0]), Some(2.5));
/// ```
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let (middle, is_odd) = (values.len() / 2, values.len() % 2 == 1);
    if values.is_empty() {
        return None;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().max_by(f64::total_cmp);
    Some(match lower {
        Some(lower) if !is_odd => 0.5 * (lower + upper),
        _ => upper,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_those_of_sorted_values() {
        // by definition, for every count up to ten and values in no order
        for count in 1..=10_u32 {
            let values: Vec<f64> = (0..count).map(|i| f64::from(i * 7 % 11)).collect();
            let mut ascending = values.clone();
            ascending.sort_by(f64::total_cmp);
            let [lower, upper] =
                [ascending.len() - 1, ascending.len()].map(|own| ascending[own / 2]);
            assert_eq!(upper_median(values.iter().copied()), Some(upper), "{count}");
            assert_eq!(median(values), Some(0.5 * (lower + upper)), "{count}");
        }
        assert_eq!(median([]), None);
    }

    #[test]
    fn nan_comes_last() {
        assert_eq!(upper_median([f64::NAN, 1.0, 2.0]), Some(2.0));
        assert!(upper_median([f64::NAN, 1.0]).is_some_and(f64::is_nan));
    }
}
