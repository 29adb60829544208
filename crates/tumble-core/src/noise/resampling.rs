//! Draws of the variances of a record under a model, for the distribution of what is made of them.

use rand_core::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::{Coefficients, Variance};
use crate::linalg::Matrix;
use crate::stats::normal_quantile;

/// Draws: ranks of 1/1000 each. Chance in this one set of draws moves how often intervals hold the truth by up to half a
/// percent.
pub(super) const DRAWS: usize = 999;
/// Where the random numbers begin: the same for every fit, so that the same record gives the same answer.
const SEED: u64 = 0x000a_11a4;

/// Standard normal numbers, the same for every model that is tried.
///
/// **Model** Latin hypercube: every variance's numbers are the `DRAWS` quantiles in random order, which takes most of the
/// chance out of the quantiles of a sum.
pub(super) struct Draws {
    normals: Vec<Vec<f64>>,
}

impl Draws {
    /// For so many variances.
    pub fn of(variances: usize) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(SEED);
        let quantiles: Vec<f64> =
            (0..DRAWS).map(|i| normal_quantile((i as f64 + 0.5) / DRAWS as f64)).collect();
        let mut normals = vec![vec![0.0; variances]; DRAWS];
        for v in 0..variances {
            let mut order: Vec<usize> = (0..DRAWS).collect();
            for i in (1..DRAWS).rev() {
                // Far more random bits than places: the remainder is even enough.
                order.swap(i, (rng.next_u64() % (i as u64 + 1)) as usize);
            }
            (0..DRAWS).for_each(|i| normals[i][v] = quantiles[order[i]]);
        }
        Self { normals }
    }

    /// Variances of `draws` other records under a model with its covariance.
    ///
    /// **Model** each variance is a scaled `χ²` of its mean and variance (Wilson and Hilferty's cube of a normal number);
    /// the normal numbers have the correlations of the variances.
    pub fn variances(
        &self,
        variances: &[Variance],
        model: &Coefficients,
        covariance: &Matrix,
        draws: usize,
    ) -> Option<Vec<Vec<f64>>> {
        let n = variances.len();
        let mut correlation = Matrix::zeros(n, n);
        for i in 0..n {
            for j in 0..n {
                correlation[(i, j)] =
                    covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            }
        }
        let lower = super::cholesky::Cholesky::of(&correlation)?;
        let marginals: Vec<[f64; 3]> = (0..n)
            .map(|i| {
                let mean = model.variance(variances[i].tau_s);
                // Of a χ²_ν over ν: 2/ν.
                let relative = covariance[(i, i)] / (mean * mean);
                let ninth = relative / 9.0;
                [mean, 1.0 - ninth, ninth.sqrt()]
            })
            .collect();
        let drawn = self.normals.iter().take(draws).map(|z| {
            let mut y = lower.product(z);
            for (y, [mean, middle, spread]) in y.iter_mut().zip(&marginals) {
                *y = mean * (middle + spread * *y).max(0.0).powi(3);
            }
            y
        });
        Some(drawn.collect())
    }
}
