//! Estimation of one run: positions in, parameters with their covariance out.
//!
//! **Model** (method sections 2–6) `k* (N̂ + c(N̂)) = g sin(φ + Δφ) + Δa`, `k* = k0 (1 + δk)`.

mod design;
mod equations;
mod exact;
mod further;
mod likelihood;
mod paper;
mod sequential;
mod terms;
mod types;

pub use design::{Prediction, predict, predict_with_terms};
pub use equations::{Equation, equations};
pub use paper::{ToParameters, WeightedRow};
pub use sequential::{SequentialEstimate, Stabilization};
pub use terms::{Term, TermChoice, TermSet, added_m_s2};
pub use types::{
    AgainstStated, Estimate, EstimateError, EstimateOptions, Method, Parameter, ProfileIntervals,
    Ranged, Residual, Scatter, Split, TermEstimate, Weights,
};

use crate::linalg::{RANK_CONDITION_LIMIT, Triangular};
use crate::{Bench, ConverterEnds, Position, Quantizer};

use paper::Fit;

/// What every run of an experiment shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting<'a> {
    /// The table and its gravity.
    pub bench: &'a Bench,
    /// The converter.
    pub quantizer: Quantizer,
    /// Its ends.
    pub ends: ConverterEnds,
    /// `k0`, m/s² per LSB.
    pub nominal_scale_m_s2_per_lsb: f64,
}

/// Estimates bias, misalignment and scale error of one run.
///
/// Use it for one power-up in one mounting. It assumes that the parameters stay constant during the run and
/// that the angles' systematic errors (dial zero apart, which goes into the misalignment) are small against
/// the uncertainty wanted; the budget adds those.
///
/// **Model** [`Method::Exact`]: `N* = α + β sinφ + γ cosφ`, then `k* = g/√(β²+γ²)`, `Δφ = atan2(γ, β)`,
/// `Δa = α k*`, `δk = k*/k0 − 1`. [`Method::Paper`]: `Δa + g cosφ Δφ − g sinφ δk = k0 N* − g sinφ`.
///
/// **Units** bias m/s² (what the unit reads too much), misalignment rad (true angle minus table angle), scale
/// error relative (`k*/k0 − 1`).
///
/// **Uncertainty** statistical only: scatter of the positions around the model (n − p degrees of freedom) and
/// the lean of ±90° dwells. Gravity, dial scale and eccentricity are not in.
///
/// **Errors** [`EstimateError`]. Too few angles are no error: what is identifiable is given, the rest is absent.
///
/// **Source** method sections 4, 6, 7.
pub fn estimate(
    positions: &[&Position],
    setting: &Setting<'_>,
    options: &EstimateOptions,
) -> Result<Estimate, EstimateError> {
    let temperatures: Vec<f64> = positions.iter().filter_map(|p| p.temperature_degc).collect();
    estimate_with_terms(
        positions,
        setting,
        options,
        options.terms.named(),
        crate::stats::mean(&temperatures),
    )
}

/// [`estimate`] with further terms, for one run of several that share the reference temperature `T̄`.
///
/// Terms that the positions cannot tell from the parameters at all, and those on temperature where one was not
/// recorded, are left out: what was entered stands in [`Estimate::terms`]. [`Method::Paper`] enters none.
///
/// **Model** as in [`Term`]; the terms are part of the model, so residuals and everything after them are those that are
/// left.
///
/// **Uncertainty** of the joint fit, as [`Estimate::full_covariance`] says.
///
/// **Errors** [`EstimateError`].
///
/// **Source** method section 8 (end); IEEE Std 1293.
pub fn estimate_with_terms(
    positions: &[&Position],
    setting: &Setting<'_>,
    options: &EstimateOptions,
    terms: TermSet,
    reference_degc: Option<f64>,
) -> Result<Estimate, EstimateError> {
    let identifiability = Identifiability::of(positions, setting);
    // Without redundancy there is no likelihood of the scatter: what is identifiable is solved for.
    let redundant = identifiability.full_rank() && positions.len() > 3;
    let base = |offsets_lsb: &[f64]| -> Result<Fit, EstimateError> {
        let eqs = || {
            let mut eqs = equations(positions, setting, options.weights);
            eqs.iter_mut().zip(offsets_lsb).for_each(|(e, added)| e.analogue_lsb -= added);
            eqs
        };
        Ok(match options.method {
            Method::Paper => paper::fit(&eqs(), setting, identifiability.columns),
            Method::Likelihood if redundant => {
                likelihood::fit(positions, setting, options, offsets_lsb)?
            }
            Method::Exact | Method::Likelihood => {
                exact::fit(&eqs(), setting, identifiability.columns)?
            }
        })
    };
    let set = match options.method {
        Method::Exact | Method::Likelihood if redundant => further::supported(terms, positions),
        _ => TermSet::EMPTY,
    };
    let extended = match (set.is_empty(), reference_degc.unwrap_or(0.0)) {
        (true, _) => None,
        (false, t) => further::fit(set, t, positions, setting, options.method, base)?,
    };
    let (fit, entered, full_covariance) = match extended {
        Some(e) => (e.fit, e.terms, e.covariance),
        None => (base(&[])?, Vec::new(), None),
    };
    let on_temperature = entered.iter().any(|t| t.term.needs_temperature());
    let stabilization = if identifiability.full_rank() {
        sequential::stabilization(&fit, options.level)
    } else {
        Stabilization::default()
    };
    Ok(Estimate {
        positions: positions.len(),
        distinct_angles: distinct_angles(positions),
        degrees_of_freedom: fit.degrees_of_freedom,
        effective_dof: fit.dof,
        values: core::array::from_fn(|i| identifiability.determined[i].then_some(fit.values[i])),
        covariance: fit.covariance,
        residuals: fit.residuals,
        residual_std_lsb: fit.residual_std_lsb,
        against_stated: fit.against_stated,
        profile: fit.profile,
        scatter: fit.scatter,
        condition: identifiability.condition,
        reference_temperature_degc: reference_degc.filter(|_| on_temperature),
        terms: entered,
        full_covariance,
        plan_uncertainty: fit
            .residual_std_lsb
            .zip(identifiability.plan_uncertainty)
            .map(|(s, u)| u.map(|per_m_s2| per_m_s2 * s * setting.nominal_scale_m_s2_per_lsb)),
        stabilization,
        weighted_rows: fit.weighted_rows,
        to_parameters: fit.to_parameters,
    })
}

/// Whether positions determine all three parameters at all, however badly.
#[must_use]
pub fn determines_all(positions: &[&Position], setting: &Setting<'_>) -> bool {
    Identifiability::of(positions, setting).full_rank()
}

/// Number of different angles, to a millionth of a degree; up and down dwells count as angles.
fn distinct_angles(positions: &[&Position]) -> usize {
    let mut angles: Vec<f64> = positions.iter().map(|p| p.angle.deg()).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    angles.len()
}

/// Which parameters a set of positions determines at all.
#[derive(Debug, Clone, PartialEq)]
struct Identifiability {
    /// Condition number of the columns (1, cosφ, −sinφ) with unit length.
    condition: f64,
    /// Whether a parameter alone is determined, in the order of the parameters.
    determined: [bool; 3],
    /// Columns that are fitted; dropped ones are combinations of these.
    columns: [bool; 3],
    /// Standard uncertainties for a scatter of 1 m/s²; absent below full rank.
    plan_uncertainty: Option<[f64; 3]>,
}

impl Identifiability {
    fn of(positions: &[&Position], setting: &Setting<'_>) -> Self {
        let rows: Vec<[f64; 3]> = positions
            .iter()
            .map(|p| paper::design_row(p, setting.bench.gravity.value_m_s2))
            .collect();
        let triangle = |columns: [bool; 3]| {
            let mut t = Triangular::new(columns.iter().filter(|c| **c).count());
            rows.iter().for_each(|r| t.push(&select(r, columns), 0.0));
            t
        };
        let whole = triangle([true; 3]);
        let all = whole.scaled_singular_values();
        let condition = all.condition();
        if let (true, Ok(c)) = (condition <= RANK_CONDITION_LIMIT, whole.unit_covariance()) {
            return Self {
                condition,
                determined: [true; 3],
                columns: [true; 3],
                plan_uncertainty: Some(core::array::from_fn(|i| c[(i, i)].sqrt())),
            };
        }
        // A parameter is determined where no vector of the null space touches it.
        let largest = all.values[0];
        let null: Vec<usize> =
            (0..3).filter(|j| all.values[*j] * RANK_CONDITION_LIMIT < largest).collect();
        let determined =
            core::array::from_fn(|i| null.iter().all(|j| all.right[(i, *j)].abs() < 1e-6));
        // Drop misalignment first, then bias: what remains must have full rank.
        let columns = [[true, false, true], [false, false, true], [true, false, false]]
            .into_iter()
            .find(|c| triangle(*c).condition() <= RANK_CONDITION_LIMIT)
            .unwrap_or([false; 3]);
        Self { condition, determined, columns, plan_uncertainty: None }
    }

    fn full_rank(&self) -> bool {
        self.columns == [true; 3]
    }
}

/// The elements of a row whose columns are fitted.
fn select(row: &[f64; 3], columns: [bool; 3]) -> Vec<f64> {
    row.iter().zip(columns).filter(|(_, c)| *c).map(|(v, _)| *v).collect()
}
