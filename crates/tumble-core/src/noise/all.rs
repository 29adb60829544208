//! Every averaging time of a record.

use super::wide::one;
use super::{Variance, Velocity};

/// Places that are worked on at once, and factors that share them: what they reach lies in the nearest caches.
const BLOCK: usize = 2048;
const TILE: usize = 64;

/// Overlapping Allan variances at every factor up to a third of the record, on all cores.
///
/// The work grows with the square of the record: on two cores 10⁵ readings take half a second, 10⁶ three quarters of a minute.
#[must_use]
pub fn all_factors(velocity: &Velocity) -> Vec<Variance> {
    let x = velocity.points();
    let most = velocity.readings() / 3;
    let tiles: Vec<usize> = (0..most.div_ceil(TILE)).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    // Dealt out in turn: small factors have more places than large ones.
    let sums: Vec<Vec<(usize, [f64; TILE])>> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads)
            .map(|t| {
                let own = tiles.iter().skip(t).step_by(threads);
                scope.spawn(move || own.map(|tile| (*tile, of_tile(x, *tile))).collect())
            })
            .collect();
        running.into_iter().map(|r| r.join().unwrap_or_default()).collect()
    });
    let mut out = Vec::with_capacity(most);
    for (tile, sums) in sums.into_iter().flatten() {
        for (k, sum) in sums.into_iter().enumerate() {
            let factor = tile * TILE + k + 1;
            if factor <= most {
                let tau_s = factor as f64 * velocity.interval_s();
                let terms = x.len() - 2 * factor;
                let variance = sum / (2.0 * tau_s * tau_s * terms as f64);
                out.push(Variance { factor, tau_s, terms, variance });
            }
        }
    }
    out.sort_by_key(|v| v.factor);
    out
}

/// Sums for the factors `tile·TILE + 1 …`.
fn of_tile(x: &[f64], tile: usize) -> [f64; TILE] {
    let mut sums = [0.0; TILE];
    let mut from = 0;
    while from < x.len() {
        for (k, sum) in sums.iter_mut().enumerate() {
            let m = tile * TILE + k + 1;
            let places = x.len().saturating_sub(from + 2 * m).min(BLOCK);
            if places > 0 {
                let at = |offset: usize| &x[from + offset..][..places];
                *sum += one([at(0), at(m), at(2 * m)]);
            }
        }
        from += BLOCK;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::{Deviation, variances};
    use super::*;

    #[test]
    fn every_factor_is_what_it_is_alone() {
        let readings: Vec<f64> =
            (0..9000).map(|i| (f64::from(i) * 0.7).sin() * f64::from(i % 17)).collect();
        let velocity = Velocity::of(&readings, 0.1).unwrap();
        let all = all_factors(&velocity);
        assert_eq!(all.len(), 3000);
        let factors: Vec<usize> = (1..=3000).collect();
        for (a, b) in all.iter().zip(variances(&velocity, Deviation::Allan, &factors)) {
            assert_eq!((a.factor, a.terms), (b.factor, b.terms));
            assert!((a.variance / b.variance - 1.0).abs() < 1e-10, "{a:?} {b:?}");
        }
    }
}
