//! Weighted least squares with no coefficient negative, by trying all sets of coefficients.

use super::Variance;
use super::cholesky::Cholesky;
use super::model::columns;
use crate::linalg::Matrix;

/// Coefficients.
pub(super) const COUNT: usize = 5;

/// A fit with some of the coefficients.
#[derive(Debug, Clone)]
pub(super) struct Subset {
    pub set: [bool; COUNT],
    pub values: [f64; COUNT],
    pub uncertainties: [f64; COUNT],
    pub chi_squared: f64,
}

/// The problem under one covariance: products of the whitened columns and variances.
pub(super) struct Problem {
    whiten: Cholesky,
    columns: [Vec<f64>; COUNT],
    /// `‖column‖`, taken out of the products.
    sizes: [f64; COUNT],
    gram: [[f64; COUNT]; COUNT],
    /// Products with the variances.
    right: [f64; COUNT],
    /// `‖variances‖²`.
    square: f64,
}

impl Problem {
    pub fn new(variances: &[Variance], covariance: &Matrix) -> Option<Self> {
        let whiten = Cholesky::of(covariance)?;
        let y = whiten.solve_lower(&variances.iter().map(|v| v.variance).collect::<Vec<_>>());
        let columns: [Vec<f64>; COUNT] = core::array::from_fn(|i| {
            let column: Vec<f64> = variances.iter().map(|v| columns(v.tau_s)[i]).collect();
            whiten.solve_lower(&column)
        });
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let sizes: [f64; COUNT] = core::array::from_fn(|i| dot(&columns[i], &columns[i]).sqrt());
        let gram = core::array::from_fn(|i| {
            core::array::from_fn(|j| dot(&columns[i], &columns[j]) / (sizes[i] * sizes[j]))
        });
        let right = core::array::from_fn(|i| dot(&columns[i], &y) / sizes[i]);
        let square = dot(&y, &y);
        Some(Self { whiten, columns, sizes, gram, right, square })
    }

    /// The best set with none negative, of those that hold (or lack) what is asked; a coefficient may be fixed.
    pub fn best(&self, points: usize, fixed: Option<(usize, f64)>) -> Option<Subset> {
        (0u32..1 << COUNT)
            .map(|bits| core::array::from_fn(|i| bits >> i & 1 == 1))
            .filter(|set: &[bool; COUNT]| fixed.is_none_or(|(i, _)| !set[i]))
            .filter_map(|set| self.fit(points, set, fixed))
            .filter(|s| s.values.iter().all(|v| *v >= 0.0))
            .min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared))
    }

    /// The fit of one set.
    pub fn fit(
        &self,
        points: usize,
        set: [bool; COUNT],
        fixed: Option<(usize, f64)>,
    ) -> Option<Subset> {
        let places: Vec<usize> = (0..COUNT).filter(|i| set[*i]).collect();
        let p = places.len();
        if p > points {
            return None;
        }
        let (mut values, mut uncertainties) = ([0.0; COUNT], [0.0; COUNT]);
        let (mut right, mut square) = (self.right, self.square);
        if let Some((i, value)) = fixed {
            let size = value * self.sizes[i];
            square += size * size - 2.0 * size * self.right[i];
            (0..COUNT).for_each(|j| right[j] -= size * self.gram[j][i]);
            values[i] = value;
        }
        let inverse = self.inverse(&places)?;
        for (k, i) in places.iter().enumerate() {
            let scaled: f64 = (0..p).map(|l| inverse[k][l] * right[places[l]]).sum();
            values[*i] = scaled / self.sizes[*i];
            uncertainties[*i] = inverse[k][k].sqrt() / self.sizes[*i];
            square -= scaled * right[*i];
        }
        Some(Subset { set, values, uncertainties, chi_squared: square.max(0.0) })
    }

    /// How each variance moves a coefficient of a set.
    pub fn weights(&self, set: [bool; COUNT], of: usize) -> Option<Vec<f64>> {
        let places: Vec<usize> = (0..COUNT).filter(|i| set[*i]).collect();
        let k = places.iter().position(|i| *i == of)?;
        let inverse = self.inverse(&places)?;
        let whitened: Vec<f64> = (0..self.columns[of].len())
            .map(|j| {
                places
                    .iter()
                    .enumerate()
                    .map(|(l, i)| inverse[k][l] * self.columns[*i][j] / self.sizes[*i])
                    .sum::<f64>()
                    / self.sizes[of]
            })
            .collect();
        Some(self.whiten.solve_upper(&whitened))
    }

    /// How each variance enters the products.
    pub fn products(&self) -> [Vec<f64>; COUNT] {
        core::array::from_fn(|i| {
            let scaled: Vec<f64> = self.columns[i].iter().map(|c| c / self.sizes[i]).collect();
            self.whiten.solve_upper(&scaled)
        })
    }

    /// Solves the same problem for other variances.
    pub fn again(&self) -> Again<'_> {
        let sets = (0u32..1 << COUNT)
            .map(|bits| {
                let places: Vec<usize> = (0..COUNT).filter(|i| bits >> i & 1 == 1).collect();
                self.inverse(&places).map(|inverse| (places, inverse))
            })
            .collect();
        Again { problem: self, products: self.products(), sets, last: [0; 2] }
    }

    /// Inverse of the products of some columns, by Gauss and Jordan; `None` where they cannot be told apart.
    fn inverse(&self, places: &[usize]) -> Option<[[f64; COUNT]; COUNT]> {
        inverse_of(&self.gram, places)
    }
}

/// See above.
fn inverse_of(gram: &[[f64; COUNT]; COUNT], places: &[usize]) -> Option<[[f64; COUNT]; COUNT]> {
        /// Part of a column that the others must leave.
        const INDEPENDENT: f64 = 1e-12;
        let p = places.len();
        let mut a = [[0.0; COUNT]; COUNT];
        let mut out = [[0.0; COUNT]; COUNT];
        for k in 0..p {
            out[k][k] = 1.0;
            for l in 0..p {
                a[k][l] = gram[places[k]][places[l]];
            }
        }
        for k in 0..p {
            let pivot = a[k][k];
            if pivot <= INDEPENDENT || pivot.is_nan() {
                return None;
            }
            for l in 0..p {
                a[k][l] /= pivot;
                out[k][l] /= pivot;
            }
            for r in (0..p).filter(|r| *r != k) {
                let factor = a[r][k];
                for l in 0..p {
                    a[r][l] -= factor * a[k][l];
                    out[r][l] -= factor * out[k][l];
                }
            }
        }
        Some(out)
    }


/// A problem with other variances.
pub(super) struct Again<'a> {
    problem: &'a Problem,
    products: [Vec<f64>; COUNT],
    /// By the bits of a set.
    sets: Vec<Option<(Vec<usize>, [[f64; COUNT]; COUNT])>>,
    /// The sets that served last: the free one, and with one held.
    last: [usize; 2],
}

/// What a negative coefficient or a gradient may be by rounding, in units of the products.
const ROUNDING: f64 = 1e-9;

impl Again<'_> {
    /// How far the best value of a coefficient is from a size: the root of the growth of `χ²`, with its sign.
    pub fn root(&mut self, variances: &[f64], which: usize, size: f64) -> f64 {
        let b: [f64; COUNT] = core::array::from_fn(|i| {
            self.products[i].iter().zip(variances).map(|(a, y)| a * y).sum()
        });
        let (free, x) = self.least(&b, None);
        let s = size * self.problem.sizes[which];
        let held_b: [f64; COUNT] = core::array::from_fn(|i| b[i] - s * self.problem.gram[i][which]);
        let (held, _) = self.least(&held_b, Some(which));
        let growth = (held + s * s - 2.0 * s * b[which] - free).max(0.0);
        if x[which] >= s { growth.sqrt() } else { -growth.sqrt() }
    }

    /// Least of `xᵀ G x − 2 bᵀ x` with no `x` negative, one of them zero.
    fn least(&mut self, b: &[f64; COUNT], without: Option<usize>) -> (f64, [f64; COUNT]) {
        let kind = usize::from(without.is_some());
        let last = self.last[kind];
        let scale = b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
        let mut best = (f64::INFINITY, [0.0; COUNT]);
        for bits in core::iter::once(last).chain((0..1 << COUNT).filter(|s| *s != last)) {
            if without.is_some_and(|i| bits >> i & 1 == 1) {
                continue;
            }
            let Some((places, inverse)) = &self.sets[bits] else { continue };
            let mut x = [0.0; COUNT];
            let mut value = 0.0;
            let mut negative = false;
            for (k, i) in places.iter().enumerate() {
                x[*i] = places.iter().enumerate().map(|(l, j)| inverse[k][l] * b[*j]).sum();
                negative |= x[*i] < 0.0;
                value -= x[*i] * b[*i];
            }
            if negative {
                continue;
            }
            if value < best.0 {
                best = (value, x);
            }
            let others = (0..COUNT).filter(|j| bits >> j & 1 == 0 && without != Some(*j));
            let done = others.fold(true, |done, j| {
                let gradient: f64 = (0..COUNT).map(|k| self.problem.gram[j][k] * x[k]).sum();
                done && b[j] - gradient <= ROUNDING * scale
            });
            if done {
                self.last[kind] = bits;
                return (value, x);
            }
        }
        best
    }
}

/// Least of `xᵀ G x − 2 bᵀ x` with no `x` negative, one of them zero.
pub(super) fn least_of(gram: &[[f64; COUNT]; COUNT], b: &[f64; COUNT], without: Option<usize>) -> [f64; COUNT] {
    let size: [f64; COUNT] = core::array::from_fn(|i| gram[i][i].sqrt());
    let unit = core::array::from_fn(|i| core::array::from_fn(|j| gram[i][j] / (size[i] * size[j])));
    let mut best = (f64::INFINITY, [0.0; COUNT]);
    for bits in 0u32..1 << COUNT {
        if without.is_some_and(|i| bits >> i & 1 == 1) {
            continue;
        }
        let places: Vec<usize> = (0..COUNT).filter(|i| bits >> i & 1 == 1).collect();
        let Some(inverse) = inverse_of(&unit, &places) else { continue };
        let mut x = [0.0; COUNT];
        let mut value = 0.0;
        for (k, i) in places.iter().enumerate() {
            let scaled: f64 = places.iter().enumerate().map(|(l, j)| inverse[k][l] * b[*j] / size[*j]).sum();
            x[*i] = scaled / size[*i];
            value -= x[*i] * b[*i];
        }
        if x.iter().all(|x| *x >= 0.0) && value < best.0 {
            best = (value, x);
        }
    }
    best.1
}
