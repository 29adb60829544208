//! A first look at dwells, before anything is judged: which line their means follow, and what each of them shows.
//!
//! It proposes scale, sign and zero of a record that nobody described yet, and fills the table of `tumble check`. It has
//! no uncertainty and decides nothing: estimates come from [`crate::estimate`].

use crate::linalg::{RANK_CONDITION_LIMIT, Triangular};
use crate::{Angle, ConverterEnds, Position, Quantizer, Readings};

/// The line that dwell means follow.
///
/// **Model** `N* = offset + amplitude · sin(φ + phase)`, ordinary least squares on (1, sinφ, cosφ); upright dwells count as
/// ±90°. With two angles only, `phase` is taken as zero.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstLook {
    /// Reading of 1 g, in the unit of the readings; always positive.
    pub amplitude: f64,
    /// Reading of 0 g.
    pub offset: f64,
    /// Where the angle would have to begin: near 0 for a dial as expected, near ±180° for a reversed one.
    pub phase: Angle,
    /// Root mean square of what is left over, divided by the degrees of freedom; `None` without any.
    pub residual_rms: Option<f64>,
    /// Mean minus line, a dwell each.
    pub residuals: Vec<f64>,
}

impl FirstLook {
    /// The scale factor that these dwells propose, m/s² per unit of the readings.
    #[must_use]
    pub fn scale_m_s2(&self, gravity_m_s2: f64) -> f64 {
        gravity_m_s2 / self.amplitude
    }

    /// How much of the reading follows the sine of the angle as it is written, with its sign; 1 for all of it.
    #[must_use]
    pub fn along_sine(&self) -> f64 {
        self.phase.cos()
    }

    /// What is left over, relative to the reading of 1 g.
    #[must_use]
    pub fn relative_rms(&self) -> Option<f64> {
        self.residual_rms.map(|r| r / self.amplitude)
    }
}

/// Looks at the dwells of a run. `None` where there is nothing to draw a line through.
///
/// ```
/// use tumble_core::{Angle, Position, Quantizer, Readings, Record, Seat, first_look};
/// let at = |deg: f64, mean: f64| Position {
///     angle: Angle::from_deg(deg),
///     seat: Seat::Table,
///     readings: Readings::Averaged { mean, samples: 100, std: None },
///     temperature_degc: None,
///     place: String::new(),
///     record: Record::default(),
/// };
/// let run = [at(-30.0, -488.0), at(0.0, 12.0), at(30.0, 512.0), at(10.0, 185.648)];
/// let look = first_look(&run.iter().collect::<Vec<_>>(), Quantizer::Round).unwrap();
/// assert!((look.amplitude - 1000.0).abs() < 0.01 && (look.offset - 12.0).abs() < 0.01);
/// assert!(look.phase.deg().abs() < 0.01);
/// ```
#[must_use]
pub fn first_look(positions: &[&Position], quantizer: Quantizer) -> Option<FirstLook> {
    let rows: Vec<([f64; 3], f64)> = positions
        .iter()
        .filter_map(|p| {
            let (sin, cos) = match p.seat.vertical_sign() {
                Some(sign) => (sign, 0.0),
                None => (p.angle.sin(), p.angle.cos()),
            };
            p.readings.mean().map(|m| ([1.0, sin, cos], quantizer.analogue_lsb(m)))
        })
        .collect();
    let fitted = |columns: usize| {
        let mut triangle = Triangular::new(columns);
        rows.iter().for_each(|(row, y)| triangle.push(&row[..columns], *y));
        let sound = rows.len() >= columns && triangle.condition() <= RANK_CONDITION_LIMIT;
        sound.then(|| triangle.solve().ok()).flatten()
    };
    let (offset, sine, cosine, columns) = match fitted(3) {
        Some(b) => (b[0], b[1], b[2], 3),
        None => fitted(2).map(|b| (b[0], b[1], 0.0, 2))?,
    };
    let residuals: Vec<f64> =
        rows.iter().map(|(r, y)| y - offset - sine * r[1] - cosine * r[2]).collect();
    let freedom = rows.len() - columns;
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    Some(FirstLook {
        amplitude: sine.hypot(cosine),
        offset,
        phase: Angle::from_rad(cosine.atan2(sine)),
        residual_rms: (freedom > 0).then(|| (squares / freedom as f64).sqrt()),
        residuals,
    })
}

/// What one dwell shows, without a verdict on the calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct DwellFacts {
    /// Samples that count.
    pub samples: u64,
    /// From first to last sample, s; by the recorded times, else by the stated rate.
    pub duration_s: Option<f64>,
    /// Samples per second, as recorded.
    pub rate_hz: Option<f64>,
    /// Samples missing between those recorded.
    pub missing: u64,
    /// Mean reading.
    pub mean: Option<f64>,
    /// Standard deviation of single readings (n − 1).
    pub std: Option<f64>,
    /// Lowest and highest code.
    pub extent: Option<(i32, i32)>,
    /// Samples at the converter's ends.
    pub at_ends: u64,
    /// Mean temperature.
    pub temperature_degc: Option<f64>,
}

/// Facts of one dwell.
#[must_use]
pub fn dwell_facts(position: &Position, ends: &ConverterEnds, rate_hz: Option<f64>) -> DwellFacts {
    let readings = &position.readings;
    let timing = position.record.timing.as_ref();
    let samples = readings.samples();
    DwellFacts {
        samples,
        duration_s: timing
            .and_then(crate::Timing::span_s)
            .or_else(|| rate_hz.map(|rate| samples as f64 / rate)),
        rate_hz: timing.and_then(crate::Timing::rate_hz),
        missing: timing.map_or(0, crate::Timing::missing),
        mean: readings.mean(),
        std: readings.std(),
        extent: match readings {
            Readings::Codes { histogram, .. } => histogram.extent().map(|(lo, hi)| (lo.0, hi.0)),
            _ => None,
        },
        at_ends: readings.censored(ends),
        temperature_degc: position.temperature_degc,
    }
}
