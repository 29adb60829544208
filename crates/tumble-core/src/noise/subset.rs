//! Weighted least squares with no coefficient negative, by trying all sets of coefficients.

use super::Variance;
use super::cholesky::{Cholesky, dot};
use super::model::columns;
pub(super) use super::nonnegative::COUNT;
use super::nonnegative::{inverse, least};
use crate::linalg::Matrix;

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
        let rows: Vec<[f64; COUNT]> = variances.iter().map(|v| columns(v.tau_s)).collect();
        let columns: [Vec<f64>; COUNT] = core::array::from_fn(|i| {
            whiten.solve_lower(&rows.iter().map(|r| r[i]).collect::<Vec<_>>())
        });
        let sizes: [f64; COUNT] = core::array::from_fn(|i| dot(&columns[i], &columns[i]).sqrt());
        let gram = core::array::from_fn(|i| {
            core::array::from_fn(|j| dot(&columns[i], &columns[j]) / (sizes[i] * sizes[j]))
        });
        let right = core::array::from_fn(|i| dot(&columns[i], &y) / sizes[i]);
        let square = dot(&y, &y);
        Some(Self { sizes, gram, right, square })
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
        let inverse = inverse(&self.gram, &places)?;
        for (k, i) in places.iter().enumerate() {
            let scaled: f64 = (0..p).map(|l| inverse[k][l] * right[places[l]]).sum();
            values[*i] = scaled / self.sizes[*i];
            uncertainties[*i] = inverse[k][k].sqrt() / self.sizes[*i];
            square -= scaled * right[*i];
        }
        Some(Subset { set, values, uncertainties, chi_squared: square.max(0.0) })
    }

    /// How far the best value of a coefficient is from a size: the root of the growth of `χ²`, with its sign.
    pub fn root(&self, which: usize, size: f64) -> f64 {
        let free = least(&self.gram, &self.right, [false; COUNT], (1 << COUNT) - 1);
        let s = size * self.sizes[which];
        let right = core::array::from_fn(|i| self.right[i] - s * self.gram[i][which]);
        let mut zero = [false; COUNT];
        zero[which] = true;
        let held = least(&self.gram, &right, zero, free.set & !(1 << which));
        let growth = held.value + s * s - 2.0 * s * self.right[which] - free.value;
        growth.max(0.0).sqrt().copysign(free.x[which] - s)
    }
}
