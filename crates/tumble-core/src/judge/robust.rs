//! Quantiles of a few numbers.

/// Median; `None` without values.
pub(super) fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// Quantile by linear interpolation between the order statistics.
pub(super) fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let at = share.clamp(0.0, 1.0) * last as f64;
    let (below, rest) = (at.floor() as usize, at.fract());
    Some(sorted[below] + rest * (sorted[(below + 1).min(last)] - sorted[below]))
}

/// Standard deviation as the middle of the values tells it: the larger of what a Gaussian's middle half and its
/// middle four fifths say.
pub(super) fn spread(values: &[f64]) -> Option<f64> {
    let between = |a: f64, b: f64| Some(quantile(values, b)? - quantile(values, a)?);
    // Φ⁻¹(0.75) = 0.674, Φ⁻¹(0.9) = 1.282.
    Some((between(0.25, 0.75)? / 1.349).max(between(0.1, 0.9)? / 2.563))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_and_spread() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(quantile(&[0.0, 10.0], 0.25), Some(2.5));
        assert_eq!(median(&[]), None);
        // One wild value of twenty changes nothing.
        let mut values: Vec<f64> = (0..20).map(f64::from).collect();
        let before = spread(&values);
        values[19] = 1e9;
        assert_eq!(spread(&values), before);
    }
}
