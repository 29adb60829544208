//! Sums of squared differences: the loops that everything else waits for.

use super::wide::one;

/// Points that one pass over all averaging factors works on: they stay in the nearest cache.
const BLOCK: usize = 2048;

/// `Σ (x[i] − 2 x[i+m] + x[i+2m])²` over `count` places from `from` on.
fn second(x: &[f64], m: usize, from: usize, count: usize) -> f64 {
    one([&x[from..][..count], &x[from + m..][..count], &x[from + 2 * m..][..count]])
}

/// Sums of squared second differences for several averaging factors in one pass over the points.
///
/// Block by block, so that the streams `x[i], x[i+m], x[i+2m]` of small factors are read from the cache; for octaves
/// `x[i+2m]` of one factor is `x[i+m]` of the next.
#[must_use]
pub(super) fn second_differences(x: &[f64], factors: &[usize]) -> Vec<f64> {
    let mut sums = vec![0.0; factors.len()];
    let mut from = 0;
    while from < x.len() {
        for (sum, m) in sums.iter_mut().zip(factors) {
            let end = x.len().saturating_sub(2 * m).min(from + BLOCK);
            if end > from {
                *sum += second(x, *m, from, end - from);
            }
        }
        from += BLOCK;
    }
    sums
}

/// `Σ (x[i+3m] − 3 x[i+2m] + 3 x[i+m] − x[i])²` over all places.
pub(super) fn third_differences(x: &[f64], m: usize) -> f64 {
    let count = x.len().saturating_sub(3 * m);
    (0..count)
        .map(|i| {
            let d = (x[i + 3 * m] - x[i]) - 3.0 * (x[i + 2 * m] - x[i + m]);
            d * d
        })
        .sum()
}

/// `Σ z_i²`, `z_i = Σ_{k<m} (x[i+k] − 2 x[i+k+m] + x[i+k+2m])`, over all `i` with `i + 3m ≤ len`.
///
/// The windows slide, and are summed anew now and then: what rounding leaves behind does not pile up.
pub(super) fn windowed_second_differences(x: &[f64], m: usize) -> f64 {
    let Some(count) = (x.len() + 1).checked_sub(3 * m) else { return 0.0 };
    let renew = m.max(BLOCK);
    let (mut total, mut z) = (0.0, 0.0);
    for i in 0..count {
        if i % renew == 0 {
            z = (i..i + m).map(|k| (x[k] - x[k + m]) + (x[k + 2 * m] - x[k + m])).sum();
        } else {
            let (old, new) = (i - 1, i - 1 + m);
            z += (x[new] - x[new + m]) + (x[new + 2 * m] - x[new + m]);
            z -= (x[old] - x[old + m]) + (x[old + 2 * m] - x[old + m]);
        }
        total += z * z;
    }
    total
}

/// `Σ (x*[i−m] − 2 x*[i] + x*[i+m])²` over the inner points, with `x*` mirrored about both end points.
pub(super) fn mirrored_second_differences(x: &[f64], m: usize) -> f64 {
    let n = x.len();
    let last = n - 1;
    let at = |i: isize| -> f64 {
        if i < 0 {
            2.0 * x[0] - x[i.unsigned_abs().min(last)]
        } else {
            let i = i.unsigned_abs();
            if i <= last { x[i] } else { 2.0 * x[last] - x[(2 * last).saturating_sub(i)] }
        }
    };
    (1..last)
        .map(|i| {
            let (i, m) = (i as isize, m as isize);
            let d = at(i - m) - 2.0 * at(i) + at(i + m);
            d * d
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pass_is_the_sum_over_all_places() {
        let x: Vec<f64> =
            (0..5000).map(|i| (f64::from(i) * 0.7).sin() * f64::from(i % 17)).collect();
        for m in [1, 2, 64, 1024, 2499] {
            let direct: f64 =
                (0..x.len() - 2 * m).map(|i| (x[i] - 2.0 * x[i + m] + x[i + 2 * m]).powi(2)).sum();
            let passed = second_differences(&x, &[m])[0];
            assert!((passed / direct - 1.0).abs() < 1e-12, "{m}");
        }
        assert_eq!(second_differences(&x, &[2500]), [0.0]);
    }

    #[test]
    fn sliding_windows_are_sums_of_windows() {
        let x: Vec<f64> =
            (0..9000).map(|i| (f64::from(i) * 0.3).cos() * f64::from(i % 5)).collect();
        for m in [1, 3, 100] {
            let direct: f64 = (0..=x.len() - 3 * m)
                .map(|i| {
                    let z: f64 = (i..i + m).map(|k| x[k] - 2.0 * x[k + m] + x[k + 2 * m]).sum();
                    z * z
                })
                .sum();
            assert!((windowed_second_differences(&x, m) / direct - 1.0).abs() < 1e-10, "{m}");
        }
    }
}
