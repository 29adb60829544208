//! What each systematic error adds to the readings, position by position.

use super::Quantity;
use crate::estimate::{Estimate, Setting};
use crate::{Angle, Position, Seat};

/// One position as a systematic error sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Site {
    /// Table angle, rad.
    angle_rad: f64,
    /// Acceleration along the axis, m/s²: `g sin(φ+Δφ)`, upright `±g`.
    acceleration_m_s2: f64,
    /// `g cos(φ+Δφ)` on the table, zero upright: m/s² per rad of the table.
    slope_m_s2: f64,
    /// +1 on the table where table angle and dial count alike, −1 where sign or orientation turn them round; zero upright.
    table: f64,
    /// Temperature above the run's mean, K.
    warmth_k: f64,
    /// Reading scaled to −1…1 over the run's range.
    within_range: f64,
}

/// The positions of one run at its estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct Sites {
    sites: Vec<Site>,
    /// `k*`, m/s² per LSB.
    scale_m_s2_per_lsb: f64,
    gravity_m_s2: f64,
}

/// A position that is still to be measured, of a sensor without errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planned {
    /// Table angle.
    pub angle: Angle,
    /// On the table or stood upright.
    pub seat: Seat,
    /// Temperature above the run's mean, K.
    pub warmth_k: f64,
}

impl Sites {
    /// `positions` are those of the estimate, in measured order. `None` without full rank.
    #[must_use]
    pub fn of(
        estimate: &Estimate,
        positions: &[&Position],
        setting: &Setting<'_>,
        temperature_spread_k: f64,
    ) -> Option<Self> {
        let [bias, misalignment, scale_error] = estimate.full()?;
        let g = setting.bench.gravity.value_m_s2;
        let scale_m_s2_per_lsb = setting.nominal_scale_m_s2_per_lsb * (1.0 + scale_error);
        let warmth = warmth(positions, temperature_spread_k);
        let sites = positions
            .iter()
            .zip(warmth)
            .map(|(p, warmth_k)| {
                let planned = Planned { angle: p.angle, seat: p.seat, warmth_k };
                let direction = p.record.dial.as_ref().map_or(1.0, |d| d.direction);
                planned.site(misalignment, direction, g)
            })
            .collect();
        Some(Self::new(sites, bias, scale_m_s2_per_lsb, g))
    }

    /// Positions of a run to come, the dial counting in `direction` (±1) as the body does.
    #[must_use]
    pub fn planned(
        positions: &[Planned],
        direction: f64,
        gravity_m_s2: f64,
        scale_m_s2_per_lsb: f64,
    ) -> Self {
        let site = |p: &Planned| p.site(0.0, direction, gravity_m_s2);
        Self::new(positions.iter().map(site).collect(), 0.0, scale_m_s2_per_lsb, gravity_m_s2)
    }

    fn new(
        mut sites: Vec<Site>,
        bias_m_s2: f64,
        scale_m_s2_per_lsb: f64,
        gravity_m_s2: f64,
    ) -> Self {
        for s in &mut sites {
            s.within_range = (s.acceleration_m_s2 + bias_m_s2) / scale_m_s2_per_lsb;
        }
        to_unit_range(&mut sites);
        Self { sites, scale_m_s2_per_lsb, gravity_m_s2 }
    }
}

impl Planned {
    /// As a systematic error sees it; its place in the range is still to be set.
    fn site(self, misalignment_rad: f64, direction: f64, g: f64) -> Site {
        let (sin, cos) = (self.angle.rad() + misalignment_rad).sin_cos();
        let (acceleration_m_s2, slope_m_s2, table) = match self.seat {
            Seat::Table => (g * sin, g * cos, direction),
            Seat::Up => (g, 0.0, 0.0),
            Seat::Down => (-g, 0.0, 0.0),
        };
        Site {
            angle_rad: self.angle.rad(),
            acceleration_m_s2,
            slope_m_s2,
            table,
            warmth_k: self.warmth_k,
            within_range: 0.0,
        }
    }
}

/// Scales `within_range` to −1…1; readings that are all alike to zero.
fn to_unit_range(sites: &mut [Site]) {
    let all = || sites.iter().map(|s| s.within_range);
    let (low, high) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let half = 0.5 * (high - low);
    let middle = 0.5 * (high + low);
    for s in sites {
        s.within_range = if half > 0.0 { (s.within_range - middle) / half } else { 0.0 };
    }
}

/// Temperatures above their mean, K: as recorded with every dwell, else a rise of `spread` that is linear in the order of
/// measurement. One temperature for a whole run is no record of how it changed.
fn warmth(positions: &[&Position], spread_k: f64) -> Vec<f64> {
    let recorded: Vec<f64> = positions.iter().filter_map(|p| p.temperature_degc).collect();
    let varies = recorded.iter().any(|t| (t - recorded[0]).abs() > 0.0);
    match crate::stats::mean(&recorded) {
        Some(mean) if varies && recorded.len() == positions.len() => {
            recorded.iter().map(|t| t - mean).collect()
        }
        _ => {
            let last = positions.len().saturating_sub(1).max(1) as f64;
            (0..positions.len()).map(|j| spread_k * (j as f64 / last - 0.5)).collect()
        }
    }
}

/// What a unit of a quantity adds to the readings of a run, LSB, to first order.
///
/// `None` for what is no pattern of readings: gravity and the reference change the scale of everything, rounding is
/// another at each angle.
///
/// **Model** (`k*` per LSB, `d` = ±1 the sense of the dial; dwells stood upright know nothing of the table)
/// dial scale `g cos(φ+Δφ) φ`, eccentricity `g cos(φ+Δφ) sin φ` and `d g cos(φ+Δφ)(cos φ − 1)`, zero `d g cos(φ+Δφ)`,
/// tilt times lean `d g`, cosine of both `−g sin(φ+Δφ)`, converter `T2(t)` and `T3(t)` of the reading's place `t` in the range,
/// K2 `a²`, K3 `a³`, temperature `T − T̄` and `a (T − T̄)`.
#[must_use]
pub fn pattern(quantity: Quantity, sites: &Sites) -> Option<Vec<f64>> {
    let g = sites.gravity_m_s2;
    let in_m_s2 = |f: fn(&Site) -> f64| {
        Some(sites.sites.iter().map(|s| f(s) / sites.scale_m_s2_per_lsb).collect())
    };
    let in_lsb = |f: fn(f64) -> f64| Some(sites.sites.iter().map(|s| f(s.within_range)).collect());
    match quantity {
        Quantity::Gravity | Quantity::Reference | Quantity::Resolution => None,
        Quantity::DialScale => in_m_s2(|s| s.slope_m_s2 * s.angle_rad),
        Quantity::EccentricitySine => in_m_s2(|s| s.slope_m_s2 * s.angle_rad.sin()),
        Quantity::EccentricityCosine => {
            in_m_s2(|s| s.slope_m_s2 * s.table * (s.angle_rad.cos() - 1.0))
        }
        Quantity::DialZero => in_m_s2(|s| s.slope_m_s2 * s.table),
        Quantity::TiltTimesLean => {
            Some(sites.sites.iter().map(|s| g * s.table / sites.scale_m_s2_per_lsb).collect())
        }
        Quantity::TiltAndLeanCosine => in_m_s2(|s| -s.acceleration_m_s2 * s.table.abs()),
        Quantity::ConverterBow => in_lsb(|t| 2.0 * t * t - 1.0),
        Quantity::ConverterS => in_lsb(|t| t * (4.0 * t * t - 3.0)),
        Quantity::Quadratic => in_m_s2(|s| s.acceleration_m_s2.powi(2)),
        Quantity::Cubic => in_m_s2(|s| s.acceleration_m_s2.powi(3)),
        Quantity::BiasTempco => in_m_s2(|s| s.warmth_k),
        Quantity::ScaleTempco => in_m_s2(|s| s.warmth_k * s.acceleration_m_s2),
    }
}
