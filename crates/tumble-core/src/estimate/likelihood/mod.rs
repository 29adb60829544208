//! The two-level likelihood: codes within a dwell, scatter between dwells.
//!
//! **Model** within a dwell `x_i = μ_j + e_i`, `e_i ~ N(0, σ²)`, `code_i = Q(x_i)`; between dwells
//! `μ_j = m(φ_j; θ) + u_j`, `u_j ~ N(0, τ0² + τφ² (∂m/∂φ)²)`, `m = α + β sinφ + γ cosφ`.
//!
//! The way: what each dwell says about its level ([`evidence`]), the noise that they share ([`noise`]), the parameters for
//! a given scatter ([`integrate`]), the restricted likelihood of the scatter ([`scatter`]), values and uncertainties over
//! all of it ([`spread`]).
//!
//! **Source** method section 8; `docs/likelihood.md` for derivations, choices and measured coverage.

mod basis;
mod cells;
mod curve;
mod evidence;
mod frame;
mod integrate;
mod material;
mod noise;
mod piece;
mod profile;
mod scatter;
mod search;
mod spread;
mod table;

use basis::Basis;
use evidence::Evidence;
use frame::Frame;
use integrate::{Dwell, Site, Solution, integrate};
use material::{Material, Materials};
use noise::Noise;
use profile::Profile;
use scatter::{Beforehand, Components, Exploration, Surface};
use spread::{Reading, Spread};

use super::Setting;
use super::equations::equations;
use super::exact;
use super::paper::{Fit, MOST_TERMS, ToParameters, WeightedRow};
use super::types::{EstimateError, EstimateOptions, ProfileIntervals, Residual, Weights};
use crate::Position;
use crate::linalg::dot3;
use crate::stats::student_factor;

/// Shares of the angle in the scatter, and totals for each, at which the surface is evaluated.
const NODES: (usize, usize) = (6, 16);
/// The same where each evaluation costs sweeps over curved dwells.
const FEWER_NODES: (usize, usize) = (2, 9);
/// Times that the model is expanded anew about the solution; the first is exact but for upright dwells and steepness.
const EXPANSIONS: usize = 5;
/// Shift of the solution, relative to `g/k*`, that the expansion bears: the variances then change by twice that.
const NEAR_ENOUGH: f64 = 1e-3;

/// Everything that was decided about a run before the parameters are read off.
struct Adjusted {
    frame: Frame,
    basis: Basis,
    dwells: Vec<Dwell>,
    noise: Noise,
    exploration: Exploration,
    /// Solution with the mean weights over the surface, the Gaussians of its dwells, and that scatter.
    solution: Solution,
    sites: Vec<Site>,
    scatter: Vec<f64>,
    summary: table::ScatterPoints,
}

impl Adjusted {
    /// What a dwell's Gaussian is off the solution, over its standard deviation.
    fn standardized(&self, j: usize) -> Option<f64> {
        let site = self.sites[j];
        let off = site.pull - site.precision * dot3(self.basis.rows[j], self.solution.shift);
        (site.precision > 0.0).then(|| off / site.precision.sqrt())
    }

    /// A dwell's Gaussian as an equation of least squares.
    fn weighted_row(&self, j: usize, shift: [f64; 3]) -> WeightedRow {
        let site = self.sites[j];
        // A dwell that says nothing has no equation: an infinite deviation, held finite.
        let precision = site.precision.max(1e-12);
        let sd_lsb = precision.sqrt().recip();
        let row = self.frame.rows[j];
        let offset = site.pull / precision;
        WeightedRow {
            row: row.map(|x| x / sd_lsb),
            y: (dot3(row, self.frame.reference) + offset) / sd_lsb,
            sd_lsb,
            residual: (offset - dot3(row, shift)) / sd_lsb,
            is_bound: matches!(self.dwells[j].evidence, Evidence::Curve(_)),
            further: [0.0; MOST_TERMS],
        }
    }
}

/// Fits one run whose positions determine all three parameters, with redundancy. `offsets_lsb`: what further terms add
/// to the level of each position; empty without any.
pub(super) fn fit(
    positions: &[&Position],
    setting: &Setting<'_>,
    options: &EstimateOptions,
    offsets_lsb: &[f64],
) -> Result<Fit, EstimateError> {
    let g = setting.bench.gravity.value_m_s2;
    let k0 = setting.nominal_scale_m_s2_per_lsb;
    let to = ToParameters::Exact { gravity_m_s2: g, nominal_scale: k0 };
    let materials = Materials::of(positions, setting);
    let mut reference = start(positions, setting, offsets_lsb)?;
    let mut expansions = 0;
    let adjusted = loop {
        expansions += 1;
        let a = adjust(reference, positions, setting, options, (&materials, offsets_lsb))
            .ok_or(EstimateError::OnlyBounds)?;
        let reading = Reading { basis: &a.basis, reference, to };
        let next = reading.unknowns(a.solution.shift);
        let size = next[1].hypot(next[2]);
        let moved =
            next.iter().zip(reference).map(|(x, y)| (x - y).abs() / size).fold(0.0, f64::max);
        if moved < NEAR_ENOUGH || expansions == EXPANSIONS {
            break a;
        }
        reference = next;
    };
    let reading = Reading { basis: &adjusted.basis, reference, to };
    let free = options.weights == Weights::Angle;
    let spread = uncertainty(&adjusted, &materials, &reading, free, options.level);
    if spread.values.iter().any(|v| !v.is_finite()) {
        return Err(EstimateError::OnlyBounds);
    }
    Ok(present(positions, setting, options, &materials, &adjusted, &reading, spread))
}

/// Unknowns to expand about: unweighted least squares of the averages.
fn start(
    positions: &[&Position],
    setting: &Setting<'_>,
    offsets_lsb: &[f64],
) -> Result<[f64; 3], EstimateError> {
    let whole = |j: &usize| positions[*j].readings.censored(&setting.ends) == 0;
    let kept: Vec<usize> = (0..positions.len()).filter(whole).collect();
    let averaged: Vec<&Position> = kept.iter().map(|j| positions[*j]).collect();
    let mut eqs = equations(&averaged, setting, Weights::Equal);
    for (e, j) in eqs.iter_mut().zip(&kept) {
        e.analogue_lsb -= offsets_lsb.get(*j).copied().unwrap_or(0.0);
    }
    let fit = exact::fit(&eqs, setting, [true; 3])?;
    Ok(exact::unknowns(fit.values, setting))
}

/// What scatters, and what is believed of it beforehand.
fn components(weights: Weights, stated_rad: f64) -> Components {
    match weights {
        Weights::Equal | Weights::Stated => Components::Level,
        Weights::Angle if stated_rad > 0.0 => Components::Both(Beforehand::STATED),
        Weights::Angle => Components::Both(Beforehand::OPEN),
    }
}

/// One adjustment about a reference; `None` where the codes bound the parameters and do not determine them.
fn adjust(
    reference: [f64; 3],
    positions: &[&Position],
    setting: &Setting<'_>,
    options: &EstimateOptions,
    (materials, offsets_lsb): (&Materials, &[f64]),
) -> Option<Adjusted> {
    let stated = setting.bench.angle_uncertainty.map_or(0.0, |a| a.rad());
    let fixed = if options.weights == Weights::Stated { stated } else { 0.0 };
    let components = components(options.weights, stated);
    let mut frame = Frame::about(reference, positions, setting, fixed);
    frame.origins.iter_mut().zip(offsets_lsb).for_each(|(origin, added)| *origin += added);
    let basis = Basis::of(&frame.rows);
    let floor = smallest_variance(&frame);
    let dwells_at = |sigma: f64| -> Vec<Dwell> {
        let dwell = |(j, m): (usize, &Material)| Dwell {
            row: basis.rows[j],
            origin: frame.origins[j],
            steepness: frame.steepness[j],
            known_variance: frame.known_variances[j] + floor,
            evidence: m.evidence(sigma, materials.inflation),
        };
        materials.dwells.iter().enumerate().map(dwell).collect()
    };
    let share = match components {
        Components::Both(_) => 0.5,
        Components::Level => 0.0,
    };
    let mut noise = noise::settle(materials, share, dwells_at)?;
    let dwells = dwells_at(noise.sigma);
    let curved = dwells.iter().any(|d| matches!(d.evidence, Evidence::Curve(_)));
    let (shares, points) = if curved { FEWER_NODES } else { NODES };
    let mut surface = Surface::new(&dwells);
    let mut exploration = surface.explore(components, shares, points, noise.start)?;
    let highest = surface.highest(&exploration.summits)?;
    exploration.nodes.iter_mut().for_each(|n| n.ln_weight += noise.own_width.ln());
    let mut groups = vec![exploration.nodes.len()];
    for other in &noise.others {
        let there = dwells_at(other.sigma);
        let more = Surface::new(&there).explore(components, shares, points, Some(other.start))?;
        exploration.nodes.extend(
            more.nodes
                .into_iter()
                .map(|n| scatter::Node { ln_weight: n.ln_weight + other.width.ln(), ..n }),
        );
        groups.push(exploration.nodes.len());
    }
    if groups.len() > 1 {
        noise.spread_over(&exploration.weights_of(&groups));
    }
    let scatter =
        spread::mean_scatter(&exploration.nodes, &dwells, |n| surface.components(n.total, n.share));
    let mut sites = surface.sites().to_vec();
    let solution = integrate(&dwells, &scatter, &mut sites).filter(|s| s.settled)?;
    let is_tested = matches!(components, Components::Both(_)) && stated > 0.0;
    let as_stated = is_tested.then(|| surface.of_angles(stated)).flatten();
    let summary = table::ScatterPoints::of(&exploration, &highest, as_stated, |total, share| {
        surface.components(total, share)
    });
    Some(Adjusted { frame, basis, dwells, noise, exploration, solution, sites, scatter, summary })
}

/// Variance of readings that do not scatter at all (made by a formula): rounding, 1e-9 of the range.
fn smallest_variance(frame: &Frame) -> f64 {
    let range = frame.origins.iter().copied().fold(0.0, |m: f64, x| m.max(x.abs()));
    (1e-9 * range).powi(2)
}

/// Uncertainty over the surface, or as the residuals show it; what is not known of the noise is added.
fn uncertainty(
    a: &Adjusted,
    materials: &Materials,
    reading: &Reading<'_>,
    shape_is_free: bool,
    level: f64,
) -> Spread {
    let mut spread = spread::over_surface(&a.exploration.nodes, reading);
    let shown = shape_is_free
        .then(|| spread::from_residuals(&a.dwells, &a.sites, &a.scatter, &a.solution, reading))
        .flatten();
    if let Some((u, dof)) = shown {
        spread.covariance = spread::with_deviations(&spread.covariance, u);
        spread.dof = dof;
        spread.by_residuals = true;
    }
    if let Some(by_noise) = shift_by_noise(a, materials, reading) {
        let u: [f64; 3] =
            core::array::from_fn(|i| spread.covariance[(i, i)].sqrt().hypot(by_noise[i]));
        spread.covariance = spread::with_deviations(&spread.covariance, u);
    }
    if shown.is_none() && a.dwells.iter().any(|d| matches!(d.evidence, Evidence::Curve(_))) {
        spread.profile = profiled(a, reading, &spread, level);
    }
    spread
}

/// Intervals from the profile likelihood at the mean scatter. They reach as far as Student's factor of each parameter
/// would, so that what is not known of the scatter is in them too.
fn profiled(
    a: &Adjusted,
    reading: &Reading<'_>,
    spread: &Spread,
    level: f64,
) -> Option<[[f64; 2]; 3]> {
    let profile = Profile::new(&a.dwells, &a.scatter);
    let gradients = reading.gradients(a.solution.shift);
    let (at, _) = reading.of(&a.solution);
    let mut out = [[0.0; 2]; 3];
    for (i, interval) in out.iter_mut().enumerate() {
        let own = a.solution.covariance.quadratic(gradients[i]).sqrt();
        let reach = student_factor(level, spread.dof[i])? * spread.covariance[(i, i)].sqrt() / own;
        let [low, high] =
            profile.ends(a.solution.shift, gradients[i], &a.solution.covariance, reach)?;
        *interval = [at[i] + low, at[i] + high];
    }
    Some(out)
}

/// Half the change of the parameters over ± one standard deviation of `ln σ`, where the noise shapes the dwells.
fn shift_by_noise(a: &Adjusted, materials: &Materials, reading: &Reading<'_>) -> Option<[f64; 3]> {
    if materials.sigma_is_known || !a.noise.others.is_empty() {
        return None;
    }
    let at = |factor: f64| {
        let mut dwells = a.dwells.clone();
        for (d, m) in dwells.iter_mut().zip(&materials.dwells) {
            d.evidence = m.evidence(a.noise.sigma * factor, materials.inflation);
        }
        let mut sites = a.sites.clone();
        integrate(&dwells, &a.scatter, &mut sites).map(|s| reading.of(&s).0)
    };
    let sd = a.noise.ln_sd.min(0.5);
    let (up, down) = (at(sd.exp())?, at((-sd).exp())?);
    Some(core::array::from_fn(|i| 0.5 * (up[i] - down[i]).abs()))
}

/// The fit as every estimator gives it.
fn present(
    positions: &[&Position],
    setting: &Setting<'_>,
    options: &EstimateOptions,
    materials: &Materials,
    a: &Adjusted,
    reading: &Reading<'_>,
    spread: Spread,
) -> Fit {
    let degrees_of_freedom = positions.len().saturating_sub(3);
    let unknowns = reading.unknowns(a.solution.shift);
    let shift: [f64; 3] = core::array::from_fn(|i| unknowns[i] - a.frame.reference[i]);
    let modelled = |j: usize| a.frame.origins[j] + dot3(a.frame.rows[j], shift);
    let residuals: Vec<Residual> = positions
        .iter()
        .enumerate()
        .map(|(j, p)| Residual {
            position: j,
            angle_deg: p.angle.deg(),
            lsb: a.dwells[j].evidence.contradiction(modelled(j)),
            standardized: a.standardized(j),
        })
        .collect();
    let weighted_rows = (0..positions.len()).map(|j| a.weighted_row(j, shift)).collect();
    let squares: f64 = residuals.iter().map(|r| r.lsb * r.lsb).sum();
    Fit {
        values: spread.values,
        covariance: Some(spread.covariance),
        degrees_of_freedom,
        dof: spread.dof,
        profile: spread.profile.map(|ends| ProfileIntervals { level: options.level, ends }),
        residual_std_lsb: Some((squares / degrees_of_freedom as f64).sqrt()),
        against_stated: a.summary.against_stated(setting, unknowns),
        residuals,
        weighted_rows,
        to_parameters: reading.to,
        scatter: Some(table::scatter(a, materials, unknowns, options.level)),
        sized_by_residuals: spread.by_residuals,
    }
}
