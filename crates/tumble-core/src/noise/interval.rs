//! Interval of a coefficient: the sizes at which what was found is no surprise.

use super::covariance::AllanCovariance;
use super::resampling::{DRAWS, Draws};
use super::subset::{COUNT, Problem};
use super::{Coefficients, Variance};
use crate::linalg::Matrix;
use crate::stats::{chi_squared_quantile, normal_quantile};

/// Rounds in which the other coefficients and the covariance are brought together at a size.
const ROUNDS: usize = 2;
/// Halvings of the logarithm of a bound: 10⁻⁴ of twelve decades.
const HALVINGS: usize = 24;
/// Sizes that are tried, about what was found or what is just seen.
const FARTHEST: f64 = 1e6;
/// Degrees of freedom from which the normal distribution serves.
const MANY: f64 = 1e4;
/// Fewest that are thought of.
const FEW: f64 = 0.5;

/// What the sizes are tried on.
pub(super) struct Trial<'a> {
    pub variances: &'a [Variance],
    pub family: &'a AllanCovariance,
    /// Squared coefficients that were found.
    pub found: [f64; COUNT],
    /// The coefficient in question.
    pub which: usize,
    /// Probability of each tail.
    pub tail: f64,
    /// How each variance moves the coefficient in the set that was found (with it), and what that set gives for it.
    pub weights: Vec<f64>,
    /// See above; may be negative.
    pub let_in: f64,
    /// EXPLORE
    pub redo: usize,
    pub likely: bool,
}

impl Trial<'_> {
    /// The interval of the squared coefficient; `seen`, an uncertainty of it, sets the scale where nothing was found.
    ///
    /// **Model** at a true size `c` the other coefficients are fitted anew, none negative; the covariance is that of the
    /// whole model. `T`, the growth of `χ²` against the best fit under that covariance, is the square of a standardized
    /// deviation of what was found from `c`. Its quantiles are those of a `χ²_ν` of the same skewness: of the
    /// coefficient's own noise, `2 v²/(c u³)` with `v` the part of the variance `u²` that comes with `c`.
    ///
    /// Coefficients that are zero and cannot be found negative take their part from the others; sizes that are no surprise
    /// to the set that was found, with its weights, are therefore in the interval as well.
    pub fn interval(&self, seen: f64) -> [f64; 2] {
        let found = self.found[self.which];
        let scale = if found > 0.0 { found } else { seen };
        let low = match found > 0.0 && !self.is_likely(0.0) {
            true => self.bound(scale / FARTHEST, found),
            false => 0.0,
        };
        [low, self.bound(scale * FARTHEST, found.max(scale / FARTHEST))]
    }

    /// Between a size that is a surprise and one that is none.
    fn bound(&self, surprising: f64, likely: f64) -> f64 {
        if self.is_likely(surprising) {
            return if surprising > likely { f64::INFINITY } else { 0.0 };
        }
        let (mut out, mut within) = (surprising.ln(), likely.ln());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (out + within);
            if self.is_likely(middle.exp()) {
                within = middle;
            } else {
                out = middle;
            }
        }
        (0.5 * (out + within)).exp()
    }

    /// Whether what was found is no surprise at a true size.
    fn is_likely(&self, size: f64) -> bool {
        let little = |s: Option<f64>| s.is_some_and(|s| s <= 1.0);
        little(self.surprise(size)) || little(self.surprise_of_set(size))
    }

    /// The same for the set that was found alone.
    fn surprise_of_set(&self, size: f64) -> Option<f64> {
        let mut model = self.found;
        model[self.which] = size;
        let p = if self.let_in > size { 1.0 - self.tail } else { self.tail };
        let u2 = variance_of(&self.weights, &self.covariance(model));
        let z = self.quantile(&self.weights, model, p)?;
        Some((self.let_in - size).powi(2) / (u2 * z * z))
    }

    /// `T` over the square of its quantile.
    fn surprise(&self, size: f64) -> Option<f64> {
        let (points, i) = (self.variances.len(), self.which);
        let mut model = self.found;
        model[i] = size;
        let mut problem = Problem::new(self.variances, &self.covariance(model))?;
        let mut held = problem.best(points, Some((i, size)))?;
        for _ in 1..ROUNDS {
            model = held.values;
            problem = Problem::new(self.variances, &self.covariance(model))?;
            held = problem.best(points, Some((i, size)))?;
        }
        let free = problem.best(points, None)?;
        let growth = (held.chi_squared - free.chi_squared).max(0.0);
        let mut set = held.set;
        set[i] = true;
        let p = if free.values[i] > size { 1.0 - self.tail } else { self.tail };
        let z = self.quantile(&problem.weights(set, i)?, held.values, p)?;
        Some(growth / (z * z))
    }

    /// Quantile of the standardized deviation.
    fn quantile(&self, w: &[f64], model: [f64; COUNT], p: f64) -> Option<f64> {
        let i = self.which;
        let all = variance_of(w, &self.covariance(model));
        let mut without = model;
        without[i] = 0.0;
        let own = (all - variance_of(w, &self.covariance(without))).max(0.0);
        let skewness = match model[i] > 0.0 {
            true => 2.0 * own * own / (model[i] * all.powf(1.5)),
            false => 0.0,
        };
        let dof = (8.0 / (skewness * skewness)).max(FEW);
        if dof >= MANY {
            return Some(normal_quantile(p));
        }
        Some((chi_squared_quantile(p, dof)? - dof) / (2.0 * dof).sqrt())
    }

    /// Probabilities, in records under the model with the coefficient at a size, of so small and of so large a value.
    pub fn chances(&self, draws: &Draws, size: f64, rounds: usize) -> Option<[f64; 2]> {
        let (points, i) = (self.variances.len(), self.which);
        let mut model = self.found;
        model[i] = size;
        let mut covariance = self.covariance(model);
        let mut problem = Problem::new(self.variances, &covariance)?;
        let mut held = problem.best(points, Some((i, size)))?;
        for _ in 1..rounds {
            covariance = self.covariance(held.values);
            problem = Problem::new(self.variances, &covariance)?;
            held = problem.best(points, Some((i, size)))?;
        }
        if self.likely {
            held.values = super::likelihood::most_likely(self.variances, self.family, held.values, Some(i))?;
            covariance = self.covariance(held.values);
            problem = Problem::new(self.variances, &covariance)?;
        }
        if std::env::var_os("SHOW").is_some() && i == 4 { eprintln!("{:?} root {:.3}", held.values.map(f64::sqrt), problem.again().root(&self.variances.iter().map(|v| v.variance).collect::<Vec<_>>(), i, size)); }
        let mut again = problem.again();
        let measured: Vec<f64> = self.variances.iter().map(|v| v.variance).collect();
        let root = again.root(&measured, i, size);
        let model = Coefficients::from_order(held.values);
        let covariance = self.covariance(held.values);
        let others = draws.variances(self.variances, &model, &covariance)?;
        let (mut below, mut above) = (1.0, 1.0);
        for y in others {
            let other = if self.redo > 0 { self.redone(&y, held.values, size)? } else { again.root(&y, i, size) };
            below += f64::from(u8::from(other <= root));
            above += f64::from(u8::from(other >= root));
        }
        let of = DRAWS as f64 + 1.0;
        Some([below / of, above / of])
    }

    /// EXPLORE: root with re-estimated covariance
    fn redone(&self, y: &[f64], mut model: [f64; COUNT], size: f64) -> Option<f64> {
        let i = self.which;
        let vs: Vec<Variance> = self.variances.iter().zip(y).map(|(v, y)| Variance { variance: *y, ..*v }).collect();
        let mut problem = Problem::new(&vs, &self.covariance(model))?;
        for _ in 0..self.redo {
            model = problem.best(vs.len(), Some((i, size)))?.values;
            problem = Problem::new(&vs, &self.covariance(model))?;
        }
        let held = problem.best(vs.len(), Some((i, size)))?;
        let free = problem.best(vs.len(), None)?;
        let g = (held.chi_squared - free.chi_squared).max(0.0).sqrt();
        Some(if free.values[i] >= size { g } else { -g })
    }

    fn covariance(&self, model: [f64; COUNT]) -> Matrix {
        self.family.at(&Coefficients::from_order(model))
    }
}

/// `wᵀ C w`.
fn variance_of(w: &[f64], c: &Matrix) -> f64 {
    let mut sum = 0.0;
    for a in 0..w.len() {
        for b in 0..w.len() {
            sum += w[a] * w[b] * c[(a, b)];
        }
    }
    sum.max(f64::MIN_POSITIVE)
}
