//! The adjustment with further terms: profiled over their coefficients, uncertainty from the joint rows.
//!
//! **Model** each estimator fits three columns; what the terms add enters as an offset of the positions' levels. One
//! step of least squares in all `3 + q` columns, on the estimator's own weighted rows, renews the coefficients, until
//! they stay. At the fixed point this is the joint fit with the estimator's weights.
//!
//! **Uncertainty** `(XᵀX)⁻¹` of the joint rows, sized as the estimator sizes that of three parameters: by the residuals
//! of each parameter (R. M. Bell, D. F. McCaffrey, 2002) where the estimator does so, else by the common scale with
//! `n − 3 − q` degrees of freedom.
//!
//! **Source** method section 8; `docs/terms.md` for measured coverage.

use super::paper::{Fit, MOST_TERMS, WeightedRow};
use super::terms::{Term, TermSet};
use super::types::{EstimateError, Method, TermEstimate};
use super::{Parameter, Setting};
use crate::Position;
use crate::linalg::{Matrix, RANK_CONDITION_LIMIT, Triangular};

/// Rounds of coefficients and adjustment; two to five are usual.
const MAX_ROUNDS: usize = 25;
/// Last change of a coefficient over its standard deviation at which the rounds stop, and that is still borne.
const SETTLED: f64 = 1e-2;
const SETTLED_ENOUGH: f64 = 0.05;
/// The same where a round costs nothing and rounding allows it.
const SETTLED_EXACT: f64 = 1e-10;

/// A fit with further terms.
pub(super) struct Extended {
    pub fit: Fit,
    pub terms: Vec<TermEstimate>,
    /// Of (bias, misalignment, scale error, terms in order).
    pub covariance: Option<Matrix>,
}

/// Where a position stands: what the terms' columns are made of.
struct Place {
    angle_rad: f64,
    is_upright: bool,
    kelvin: f64,
}

/// The terms whose columns a run's positions have: those on temperature need one at every position.
pub(super) fn supported(set: TermSet, positions: &[&Position]) -> TermSet {
    let recorded = positions.iter().all(|p| p.temperature_degc.is_some());
    set.iter().filter(|t| recorded || !t.needs_temperature()).collect()
}

/// Fits three parameters and the terms of a set that is not empty and is supported.
///
/// `base` is the estimator of three parameters for given offsets, LSB. `Ok(None)`: the positions cannot tell the terms
/// from the parameters, or leave no redundancy.
pub(super) fn fit(
    set: TermSet,
    reference_degc: f64,
    positions: &[&Position],
    setting: &Setting<'_>,
    method: Method,
    base: impl Fn(&[f64]) -> Result<Fit, EstimateError>,
) -> Result<Option<Extended>, EstimateError> {
    let terms: Vec<Term> = set.iter().collect();
    let (n, q) = (positions.len(), terms.len());
    if n < 4 + q {
        return Ok(None);
    }
    let places: Vec<Place> = positions
        .iter()
        .map(|p| Place {
            angle_rad: p.angle.rad(),
            is_upright: p.seat.vertical_sign().is_some(),
            kelvin: p.temperature_degc.map_or(0.0, |t| t - reference_degc),
        })
        .collect();
    let model = Model { terms: &terms, places: &places, setting };
    let wanted = if method == Method::Exact { SETTLED_EXACT } else { SETTLED };
    let mut coefficients = vec![0.0; q];
    let mut offsets = vec![0.0; n];
    for round in 1..=MAX_ROUNDS {
        let fit = base(&offsets)?;
        let joint = model.joint(&fit, &coefficients);
        if joint.condition() > RANK_CONDITION_LIMIT {
            return Ok(None);
        }
        let step = joint.back_substituted();
        let unit = joint.unit_covariance_unchecked();
        let moved = (0..q).map(|i| step[3 + i].abs() / unit[(3 + i, 3 + i)].sqrt());
        let moved = moved.fold(0.0, f64::max);
        if !moved.is_finite() {
            return Ok(None);
        }
        if moved <= wanted || (round == MAX_ROUNDS && moved <= SETTLED_ENOUGH) {
            return Ok(Some(model.present(fit, &coefficients, &unit, n)));
        }
        coefficients.iter_mut().zip(&step[3..]).for_each(|(c, s)| *c += s);
        let shifted = moved_unknowns(&fit, &step);
        offsets = model.offsets(&coefficients, &shifted);
    }
    Err(EstimateError::NotConverged { iterations: MAX_ROUNDS, last_change: f64::NAN })
}

/// Misalignment and `g/R` after a step of the unknowns.
struct Geometry {
    misalignment_rad: f64,
    /// `k* = g/R`, m/s² per LSB.
    scale: f64,
}

fn moved_unknowns(fit: &Fit, step: &[f64]) -> Geometry {
    let [_, beta, gamma] = fit.to_parameters.unknowns(fit.values);
    let (beta, gamma) = (beta + step[1], gamma + step[2]);
    let g = fit.to_parameters.gravity_m_s2();
    Geometry { misalignment_rad: gamma.atan2(beta), scale: g / beta.hypot(gamma) }
}

struct Model<'a> {
    terms: &'a [Term],
    places: &'a [Place],
    setting: &'a Setting<'a>,
}

impl Model<'_> {
    /// Applied acceleration at a place, and its derivative by the misalignment, m/s².
    fn acceleration(&self, place: &Place, misalignment_rad: f64) -> (f64, f64) {
        let g = self.setting.bench.gravity.value_m_s2;
        match place.is_upright {
            true => (g * place.angle_rad.signum(), 0.0),
            false => {
                let (sin, cos) = (place.angle_rad + misalignment_rad).sin_cos();
                (g * sin, g * cos)
            }
        }
    }

    /// What the terms add to each position, LSB.
    fn offsets(&self, coefficients: &[f64], at: &Geometry) -> Vec<f64> {
        self.places
            .iter()
            .map(|p| {
                let (a, _) = self.acceleration(p, at.misalignment_rad);
                let add = |(t, c): (&Term, &f64)| c * t.basis(a, p.kelvin);
                self.terms.iter().zip(coefficients).map(add).sum::<f64>() / at.scale
            })
            .collect()
    }

    fn geometry(&self, fit: &Fit) -> Geometry {
        Geometry {
            misalignment_rad: fit.values[1],
            scale: self.setting.nominal_scale_m_s2_per_lsb * (1.0 + fit.values[2]),
        }
    }

    /// Row of a position in all columns, over its standard deviation: the three of the estimator with what the terms
    /// change by the misalignment and by `k*`, and the terms' own.
    fn row(&self, j: usize, w: &WeightedRow, fit: &Fit, coefficients: &[f64]) -> Vec<f64> {
        let at = self.geometry(fit);
        let g = self.setting.bench.gravity.value_m_s2;
        let r = g / at.scale;
        let (sin, cos) = at.misalignment_rad.sin_cos();
        let (a, by_misalignment) = self.acceleration(&self.places[j], at.misalignment_rad);
        let kelvin = self.places[j].kelvin;
        let (mut added, mut turned) = (0.0, 0.0);
        for (t, c) in self.terms.iter().zip(coefficients) {
            added += c * t.basis(a, kelvin) / at.scale;
            turned += c * t.slope(a, kelvin) * by_misalignment / at.scale;
        }
        // β = R cosΔφ, γ = R sinΔφ; what is added goes with 1/k* = R/g.
        let by_beta = added * cos / r - turned * sin / r;
        let by_gamma = added * sin / r + turned * cos / r;
        let mut row = w.row.to_vec();
        row[1] += by_beta / w.sd_lsb;
        row[2] += by_gamma / w.sd_lsb;
        row.extend(self.terms.iter().map(|t| t.basis(a, kelvin) / at.scale / w.sd_lsb));
        row
    }

    fn joint(&self, fit: &Fit, coefficients: &[f64]) -> Triangular {
        let mut triangle = Triangular::new(3 + self.terms.len());
        for (j, w) in fit.weighted_rows.iter().enumerate() {
            triangle.push(&self.row(j, w, fit, coefficients), w.residual);
        }
        triangle
    }

    /// The fit with the terms taken out of its residuals, and what is known of all its parameters.
    fn present(&self, mut fit: Fit, coefficients: &[f64], unit: &Matrix, n: usize) -> Extended {
        let q = self.terms.len();
        let rows: Vec<Vec<f64>> = fit
            .weighted_rows
            .iter()
            .enumerate()
            .map(|(j, w)| self.row(j, w, &fit, coefficients))
            .collect();
        let jacobian = jacobian(&fit, q);
        let (covariance, dof) = self.sized(&fit, &rows, unit, &jacobian, n);
        for (w, row) in fit.weighted_rows.iter_mut().zip(&rows) {
            w.further = [0.0; MOST_TERMS];
            w.further.iter_mut().zip(&row[3..]).for_each(|(to, from)| *to = *from);
        }
        let kept = (n - 3) as f64 / (n - 3 - q) as f64;
        fit.degrees_of_freedom = n - 3 - q;
        fit.residual_std_lsb = fit.residual_std_lsb.map(|s| s * kept.sqrt());
        fit.dof = core::array::from_fn(|i| dof[i]);
        fit.profile = None;
        fit.covariance = covariance.as_ref().map(|c| {
            let three: [[f64; 3]; 3] =
                core::array::from_fn(|i| core::array::from_fn(|k| c[(i, k)]));
            Matrix::from_rows(three)
        });
        let at = self.geometry(&fit);
        let peak = |t: Term, value: f64| {
            let add = |p: &Place| {
                (value * t.basis(self.acceleration(p, at.misalignment_rad).0, p.kelvin)).abs()
            };
            self.places.iter().map(add).fold(0.0, f64::max)
        };
        let terms = self
            .terms
            .iter()
            .zip(coefficients)
            .enumerate()
            .map(|(i, (term, value))| TermEstimate {
                term: *term,
                value: *value,
                standard_uncertainty: covariance.as_ref().map(|c| c[(3 + i, 3 + i)].sqrt()),
                degrees_of_freedom: dof[3 + i],
                peak_m_s2: peak(*term, *value),
            })
            .collect();
        Extended { fit, terms, covariance }
    }

    /// Covariance and degrees of freedom of all parameters.
    fn sized(
        &self,
        fit: &Fit,
        rows: &[Vec<f64>],
        unit: &Matrix,
        jacobian: &Matrix,
        n: usize,
    ) -> (Option<Matrix>, Vec<f64>) {
        let q = self.terms.len();
        let p = 3 + q;
        let plain = unit.propagated(jacobian);
        let Some(own) = &fit.covariance else {
            return (None, vec![(n - p) as f64; p]);
        };
        let three = fit.to_parameters.at(fit.to_parameters.unknowns(fit.values)).1;
        let mut alone = Triangular::new(3);
        fit.weighted_rows.iter().for_each(|w| alone.push(&w.row, 0.0));
        let alone = alone.unit_covariance_unchecked();
        let short: Vec<Vec<f64>> = fit.weighted_rows.iter().map(|w| w.row.to_vec()).collect();
        let shown = fit
            .sized_by_residuals
            .then(|| {
                let residuals: Vec<f64> = fit.weighted_rows.iter().map(|w| w.residual).collect();
                let of_all = self.by_residuals(rows, &residuals, unit, jacobian)?;
                let of_three = self.by_residuals(&short, &residuals, &alone, &three)?;
                Some((of_all, of_three))
            })
            .flatten();
        let alone = alone.propagated(&three);
        let (mut u, mut dof, mut beyond) = (Vec::new(), Vec::new(), 0.0);
        match shown {
            Some((of_all, of_three)) => {
                // What the estimator adds for the noise that it does not know.
                (0..3).for_each(|i| beyond += own[(i, i)].sqrt() / of_three[i].0 / 3.0);
                u.extend(of_all.iter().map(|(u, _)| u * f64::max(beyond, 1.0)));
                dof.extend(of_all.iter().map(|(_, dof)| *dof));
            }
            None => {
                let kept = (n - 3) as f64 / (n - p) as f64;
                let factor: Vec<f64> = (0..3).map(|i| own[(i, i)] / alone[(i, i)] * kept).collect();
                let common = factor.iter().sum::<f64>() / 3.0;
                let least = fit.dof.iter().copied().fold(f64::INFINITY, f64::min);
                for i in 0..p {
                    u.push((plain[(i, i)] * factor.get(i).copied().unwrap_or(common)).sqrt());
                    let dof_i = fit.dof.get(i).copied().unwrap_or(least);
                    dof.push((dof_i - q as f64).max(1.0));
                }
            }
        }
        let mut covariance = Matrix::zeros(p, p);
        for i in 0..p {
            for k in 0..p {
                let r = if i == k { 1.0 } else { plain.correlation(i, k).unwrap_or(0.0) };
                covariance[(i, k)] = r * u[i] * u[k];
            }
        }
        (Some(covariance), dof)
    }

    /// Standard uncertainty and degrees of freedom of each parameter as the residuals show them; upright dwells with
    /// the variance of the model. `None` where a parameter has too few.
    fn by_residuals(
        &self,
        rows: &[Vec<f64>],
        residuals: &[f64],
        unit: &Matrix,
        jacobian: &Matrix,
    ) -> Option<Vec<(f64, f64)>> {
        let p = unit.rows();
        let along = |row: &[f64]| -> Vec<f64> {
            (0..p).map(|i| (0..p).map(|k| unit[(i, k)] * row[k]).sum()).collect()
        };
        let directions = jacobian.times(unit);
        let mut out = Vec::with_capacity(p);
        for i in 0..p {
            let (mut variance, mut expected, mut square) = (0.0, 0.0, 0.0);
            let mut outer = Matrix::zeros(p, p);
            for (j, row) in rows.iter().enumerate() {
                let influence: f64 = (0..p).map(|k| directions[(i, k)] * row[k]).sum();
                let own = influence * influence;
                if self.places[j].is_upright {
                    variance += own;
                    expected += own;
                    continue;
                }
                let leverage: f64 = along(row).iter().zip(row).map(|(a, b)| a * b).sum();
                let weight = own / (1.0 - leverage.min(0.999));
                variance += weight * residuals[j] * residuals[j];
                expected += weight * (1.0 - leverage);
                square += weight * weight * (1.0 - 2.0 * leverage);
                for a in 0..p {
                    for b in 0..p {
                        outer[(a, b)] += weight * row[a] * row[b];
                    }
                }
            }
            let cs = unit.times(&outer);
            for a in 0..p {
                for b in 0..p {
                    square += cs[(a, b)] * cs[(b, a)];
                }
            }
            let dof = (expected * expected / square).min(rows.len() as f64 - p as f64);
            if !(dof >= 3.0 && variance > 0.0) {
                return None;
            }
            out.push((variance.sqrt(), dof));
        }
        Some(out)
    }
}

/// From `(α, β, γ, coefficients)` to `(Δa, Δφ, δk, coefficients)`.
fn jacobian(fit: &Fit, q: usize) -> Matrix {
    let (_, three) = fit.to_parameters.at(fit.to_parameters.unknowns(fit.values));
    let mut out = Matrix::zeros(3 + q, 3 + q);
    for i in Parameter::ALL {
        (0..3).for_each(|k| out[(i.index(), k)] = three[(i.index(), k)]);
    }
    (0..q).for_each(|i| out[(3 + i, 3 + i)] = 1.0);
    out
}
