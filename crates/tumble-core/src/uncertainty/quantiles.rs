//! Coverage intervals of many draws.

use crate::assess::Interval;

/// Both ends of the probabilistically symmetric interval, by JCGM 101, 7.7: `q = pM`, `r = (M − q)/2`. Reorders the draws.
pub(super) fn symmetric(draws: &mut [f64], level: f64) -> Interval {
    let n = draws.len();
    let inside = (level * n as f64).round() as usize;
    let r = (n - inside) / 2;
    let low = *draws.select_nth_unstable_by(r, f64::total_cmp).1;
    let high = *draws[r..].select_nth_unstable_by(inside.min(n - 1 - r), f64::total_cmp).1;
    Interval { low, high }
}

/// The shortest interval that holds `pM` draws. Reorders the draws; only their tails are sorted.
pub(super) fn shortest(draws: &mut [f64], level: f64) -> Interval {
    let n = draws.len();
    let inside = ((level * n as f64).round() as usize).min(n - 1);
    let tail = n - inside;
    // The lower end is among the lowest `tail` draws, the upper one among the highest.
    draws.select_nth_unstable_by(tail.min(n - 1), f64::total_cmp);
    draws[..tail.min(n - 1)].sort_unstable_by(f64::total_cmp);
    draws[tail.min(n - 1)..].select_nth_unstable_by(inside - tail.min(inside), f64::total_cmp);
    draws[inside..].sort_unstable_by(f64::total_cmp);
    (0..tail)
        .map(|i| Interval { low: draws[i], high: draws[i + inside] })
        .min_by(|a, b| (a.high - a.low).total_cmp(&(b.high - b.low)))
        .unwrap_or(Interval { low: draws[0], high: draws[n - 1] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_known_order() {
        // 0, 1, 4, 9 … 99²: the shortest 95 % are the lowest.
        let mut draws: Vec<f64> = (0..100).rev().map(|i| f64::from(i * i)).collect();
        assert_eq!(shortest(&mut draws, 0.95), Interval { low: 0.0, high: 95.0 * 95.0 });
        let mut draws: Vec<f64> = (0..1000).rev().map(f64::from).collect();
        assert_eq!(symmetric(&mut draws, 0.95), Interval { low: 25.0, high: 975.0 });
    }
}
