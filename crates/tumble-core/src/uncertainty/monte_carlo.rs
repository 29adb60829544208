//! Propagation of distributions by Monte Carlo, with adaptive stop: JCGM 101.

use rand_core::SeedableRng;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::distribution::widening;
use super::quantiles::{shortest, symmetric};
use super::{Distribution, Measurement, Model};
use crate::assess::Interval;

/// Draws of a batch (JCGM 101, 7.9.4: at least 10⁴, and 100/(1 − p)).
const BATCH: usize = 10_000;
/// Batches that are drawn before the answer is looked at again.
const ROUND: usize = 10;

/// How to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MonteCarloOptions {
    /// Where the random numbers begin: the same seed gives the same answer, whatever the number of threads.
    pub seed: u64,
    /// Significant digits of the uncertainty that must stand still: 1 or 2.
    pub digits: u32,
    /// Most draws; rounded up to whole rounds of 10⁵.
    pub most_draws: usize,
    /// Fewest draws.
    pub fewest_draws: usize,
    /// Threads.
    pub threads: usize,
}

impl Default for MonteCarloOptions {
    /// Two digits, up to 2·10⁶ draws (JCGM 101, 7.2: 10⁶ deliver one or two digits).
    fn default() -> Self {
        Self { seed: 1, digits: 2, most_draws: 2_000_000, fewest_draws: 100_000, threads: 1 }
    }
}

/// What the draws gave.
#[derive(Debug, Clone, PartialEq)]
pub struct MonteCarlo<const M: usize> {
    /// Draws that were made.
    pub draws: usize,
    /// Whether every output stood still before the draws ran out.
    pub stabilized: bool,
    /// One an output.
    pub outputs: [MonteCarloOutput; M],
    /// Covariance of the outputs.
    pub covariance: [[f64; M]; M],
}

/// One output's distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonteCarloOutput {
    /// Mean.
    pub value: f64,
    /// Standard deviation.
    pub standard_uncertainty: f64,
    /// Probabilistically symmetric coverage interval.
    pub symmetric: Interval,
    /// Shortest coverage interval.
    pub shortest: Interval,
    /// Numerical tolerance `δ` of the standard uncertainty at the digits asked for.
    pub tolerance: f64,
}

/// Whether the interval of the propagation of uncertainty holds (JCGM 101, clause 8).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Validation {
    /// `|y − U − y_low|`.
    pub d_low: f64,
    /// `|y + U − y_high|`.
    pub d_high: f64,
    /// `δ`: neither may be larger.
    pub tolerance: f64,
}

impl Validation {
    /// Whether both ends agree within the tolerance.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.d_low <= self.tolerance && self.d_high <= self.tolerance
    }
}

impl MonteCarloOutput {
    /// Holds an interval against the symmetric one. JCGM 101, 8.1.
    #[must_use]
    pub fn validate(&self, interval: Interval) -> Validation {
        Validation {
            d_low: (interval.low - self.symmetric.low).abs(),
            d_high: (interval.high - self.symmetric.high).abs(),
            tolerance: self.tolerance,
        }
    }
}

/// `δ = ½·10^l` for `u = c·10^l` with `c` an integer of so many digits. JCGM 101, 7.9.2.
fn tolerance(u: f64, digits: u32) -> f64 {
    if u <= 0.0 || u.is_nan() {
        return 0.0;
    }
    let unit = |u: f64| 10f64.powi(u.log10().floor() as i32 + 1 - digits as i32);
    // 0.0996 is 0.10 to two digits: the unit is that of the rounded number.
    let rounded = (u / unit(u)).round() * unit(u);
    0.5 * unit(rounded * (1.0 + 1e-9))
}

/// A batch: its draws, output by output, and what they say alone.
struct Batch<const M: usize> {
    draws: [Vec<f64>; M],
    /// Mean, standard deviation, ends of the interval.
    says: [[f64; 4]; M],
}

impl<F: Sync, const N: usize> Measurement<F, N> {
    /// Draws until the values stand still.
    ///
    /// **Model** batches of 10⁴ draws; it stops when twice the standard deviation of the batches' mean, `u`, `y_low` and
    /// `y_high`, over `√h`, is below `δ` for every output. Each batch has its own random numbers, and batches are looked at in
    /// their order.
    ///
    /// **Source** JCGM 101, 5.9, 6.4, 7.9; JCGM 102, 7.
    pub fn draw<const M: usize>(&self, level: f64, options: &MonteCarloOptions) -> MonteCarlo<M>
    where
        F: Model<N, M>,
    {
        let drawing = Drawing::of(self);
        let size = BATCH.max((100.0 / (1.0 - level)).ceil() as usize);
        let mut batches: Vec<Batch<M>> = Vec::new();
        let mut stabilized = false;
        while !stabilized && batches.len() * size < options.most_draws {
            batches.extend(self.round(&drawing, batches.len(), size, level, options));
            stabilized = batches.len() * size >= options.fewest_draws
                && stands_still(&batches, options.digits);
        }
        summed_up(batches, level, stabilized, options.digits)
    }

    fn round<const M: usize>(
        &self,
        drawing: &Drawing<N>,
        first: usize,
        size: usize,
        level: f64,
        options: &MonteCarloOptions,
    ) -> Vec<Batch<M>>
    where
        F: Model<N, M>,
    {
        let threads = options.threads.clamp(1, ROUND);
        let one = |k: usize| self.batch(drawing, options.seed, first + k, size, level);
        if threads == 1 {
            return (0..ROUND).map(one).collect();
        }
        let mut out: Vec<(usize, Batch<M>)> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|t| {
                    let one = &one;
                    scope.spawn(move || {
                        (t..ROUND).step_by(threads).map(|k| (k, one(k))).collect::<Vec<_>>()
                    })
                })
                .collect();
            // A model that panics panics here, too: no batch is lost in silence.
            let joined = |w: std::thread::ScopedJoinHandle<'_, Vec<(usize, Batch<M>)>>| {
                w.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            workers.into_iter().flat_map(joined).collect()
        });
        out.sort_by_key(|(k, _)| *k);
        out.into_iter().map(|(_, b)| b).collect()
    }

    fn batch<const M: usize>(
        &self,
        drawing: &Drawing<N>,
        seed: u64,
        index: usize,
        size: usize,
        level: f64,
    ) -> Batch<M>
    where
        F: Model<N, M>,
    {
        let mut rng = stream(seed, index);
        let mut draws: [Vec<f64>; M] = core::array::from_fn(|_| Vec::with_capacity(size));
        for _ in 0..size {
            let outputs = self.model.evaluate(&drawing.inputs(self, &mut rng));
            draws.iter_mut().zip(outputs).for_each(|(d, y)| d.push(y));
        }
        let says = core::array::from_fn(|a| {
            let (mean, sd) = mean_and_deviation(&draws[a]);
            let mut reordered = draws[a].clone();
            let i = symmetric(&mut reordered, level);
            [mean, sd, i.low, i.high]
        });
        Batch { draws, says }
    }
}

/// Random numbers of a batch: far from those of every other batch and seed.
fn stream(seed: u64, index: usize) -> Pcg64Mcg {
    // SplitMix64 of the index over the seed.
    let mut z = seed ^ (index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    Pcg64Mcg::seed_from_u64(z ^ (z >> 31))
}

/// What is drawn and how: worked out once.
struct Drawing<const N: usize> {
    /// Inputs that are not exact and stand alone.
    alone: Vec<usize>,
    /// Correlated inputs.
    together: Vec<usize>,
    /// Lower triangle of their correlations' square root, row by row.
    root: Vec<Vec<f64>>,
    /// Degrees of freedom that Student inputs share, and which: one `χ²` a draw for each kind.
    widths: Vec<(f64, Vec<usize>)>,
}

impl<const N: usize> Drawing<N> {
    fn of<F>(m: &Measurement<F, N>) -> Self {
        let varies = |i: &usize| m.inputs[*i].distribution != Distribution::Exact;
        let correlated = |i: usize| m.correlations.iter().any(|(a, b, _)| *a == i || *b == i);
        let (together, alone) =
            (0..N).filter(varies).partition::<Vec<usize>, _>(|i| correlated(*i));
        let r = m.correlation_matrix();
        let mut root: Vec<Vec<f64>> = Vec::new();
        for (a, i) in together.iter().enumerate() {
            let mut row = vec![0.0; a + 1];
            for b in 0..a {
                let known: f64 = (0..b).map(|k| row[k] * root[b][k]).sum();
                let pivot = root[b][b];
                row[b] = if pivot > 0.0 { (r[*i][together[b]] - known) / pivot } else { 0.0 };
            }
            let left = 1.0 - row[..a].iter().map(|x| x * x).sum::<f64>();
            row[a] = left.max(0.0).sqrt();
            root.push(row);
        }
        let mut widths: Vec<(f64, Vec<usize>)> = Vec::new();
        for i in (0..N).filter(varies) {
            if let Distribution::Student { dof, .. } = m.inputs[i].distribution {
                // Those that hang together share their χ²: a multivariate Student distribution.
                match widths.iter_mut().find(|(d, members)| {
                    *d == dof && correlated(i) && members.iter().any(|j| correlated(*j))
                }) {
                    Some((_, members)) => members.push(i),
                    None => widths.push((dof, vec![i])),
                }
            }
        }
        Self { alone, together, root, widths }
    }

    #[inline]
    fn inputs<F>(&self, m: &Measurement<F, N>, rng: &mut Pcg64Mcg) -> [f64; N] {
        let mut x: [f64; N] = core::array::from_fn(|i| m.inputs[i].estimate);
        let mut widened = [1.0; N];
        for (dof, members) in &self.widths {
            let w = widening(rng, *dof);
            members.iter().for_each(|i| widened[*i] = w);
        }
        for i in &self.alone {
            x[*i] += m.inputs[*i].distribution.draw(rng, None, widened[*i]);
        }
        if self.together.is_empty() {
            return x;
        }
        let mut z = [0.0; N];
        for (a, i) in self.together.iter().enumerate() {
            z[a] = StandardNormal.sample(rng);
            let normal: f64 = self.root[a].iter().zip(&z).map(|(l, z)| l * z).sum();
            x[*i] += m.inputs[*i].distribution.draw(rng, Some(normal), widened[*i]);
        }
        x
    }
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, (square / (n - 1.0)).sqrt())
}

fn stands_still<const M: usize>(batches: &[Batch<M>], digits: u32) -> bool {
    let h = batches.len() as f64;
    (0..M).all(|a| {
        let u = batches.iter().map(|b| b.says[a][1]).sum::<f64>() / h;
        let delta = tolerance(u, digits);
        (0..4).all(|k| {
            let says: Vec<f64> = batches.iter().map(|b| b.says[a][k]).collect();
            2.0 * mean_and_deviation(&says).1 / h.sqrt() < delta || u == 0.0
        })
    })
}

fn summed_up<const M: usize>(
    batches: Vec<Batch<M>>,
    level: f64,
    stabilized: bool,
    digits: u32,
) -> MonteCarlo<M> {
    let mut all: [Vec<f64>; M] = core::array::from_fn(|_| Vec::new());
    for batch in batches {
        all.iter_mut().zip(batch.draws).for_each(|(all, d)| all.extend(d));
    }
    let draws = all.first().map_or(0, Vec::len);
    let means: [f64; M] = core::array::from_fn(|a| mean_and_deviation(&all[a]).0);
    let covariance = core::array::from_fn(|a| {
        core::array::from_fn(|b| {
            let products = all[a].iter().zip(&all[b]).map(|(x, y)| (x - means[a]) * (y - means[b]));
            products.sum::<f64>() / (draws as f64 - 1.0)
        })
    });
    let outputs = core::array::from_fn(|a| {
        let u: f64 = {
            let c: &[[f64; M]; M] = &covariance;
            c[a][a].sqrt()
        };
        MonteCarloOutput {
            value: means[a],
            standard_uncertainty: u,
            symmetric: symmetric(&mut all[a], level),
            shortest: shortest(&mut all[a], level),
            tolerance: tolerance(u, digits),
        }
    });
    MonteCarlo { draws, stabilized, outputs, covariance }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tolerance_is_half_of_the_last_digit_of_the_rounded_number() {
        // JCGM 101, 7.9.2: 0.000 32 to two digits is 32·10⁻⁵, to one 3·10⁻⁴.
        for (u, digits, delta) in [
            (0.000_32, 2, 5e-6),
            (0.000_32, 1, 5e-5),
            (2.0, 2, 0.05),
            (0.0996, 2, 5e-3),
            (0.0, 2, 0.0),
        ] {
            assert!((tolerance(u, digits) - delta).abs() < 1e-12, "{u}");
        }
    }
}
