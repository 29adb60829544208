//! Dwells typed as ±90° that the run says were no such thing.

use super::dwell_fit::DwellFit;
use super::misfit::correct;
use crate::{Bench, Finding, FindingKind, Position, Quantizer};

/// Standard deviations of the lean, and of the run's own prediction, that are allowed.
const ALLOWED: f64 = 8.0;
/// Least lean that is allowed, rad (5°): a body stood on its end by eye.
const LEAST_LEAN_RAD: f64 = 0.087;

/// Upright dwells that read the other end, or what a table angle reads: up for down, or 90 typed for 9.
///
/// They take no part in the fit that they are held against: the run's dwells on the table.
pub(super) fn upright(
    fit: &DwellFit,
    positions: &[&Position],
    quantizer: Quantizer,
    bench: &Bench,
) -> Vec<(usize, Finding)> {
    positions
        .iter()
        .enumerate()
        .filter_map(|(i, p)| Some((i, misread(fit, p, quantizer, bench)?)))
        .collect()
}

fn misread(fit: &DwellFit, p: &Position, quantizer: Quantizer, bench: &Bench) -> Option<Finding> {
    let sign = p.seat.vertical_sign()?;
    let level = quantizer.analogue_lsb(p.readings.mean()?);
    let (alpha, amplitude) = fit.ends();
    let lean = (ALLOWED * bench.vertical_lean.rad()).max(LEAST_LEAN_RAD);
    let step = if quantizer == Quantizer::None { 0.0 } else { 1.0 };
    let (_, deviation) = fit.expected_lsb(p.angle.rad());
    let allowed = amplitude * (1.0 - lean.cos()) + ALLOWED * deviation + step;
    let off = level - (alpha + sign * amplitude);
    if off.abs() <= allowed {
        return None;
    }
    let limit = format!("{allowed:.1} LSB");
    let swapped = (level - (alpha - sign * amplitude)).abs() <= allowed;
    let typed = p.record.dial.as_ref().map_or("±90", |d| d.typed.as_str());
    Some(if swapped && 2.0 * allowed < amplitude {
        let other = if sign > 0.0 { "down" } else { "up" };
        Finding {
            kind: FindingKind::MistypedAngle,
            place: p.place.clone(),
            observed: format!("{typed}° is typed where the axis points {other}: the sign"),
            limit,
            remedy: format!(
                "if the axis pointed {other}, {}; else measure the dwell again",
                correct(p, "the sign of the angle")
            ),
        }
    } else {
        Finding {
            kind: FindingKind::DwellDoesNotFit,
            place: p.place.clone(),
            observed: match fit.angle_of(level) {
                Some((angle, _)) => format!(
                    "{off:+.1} LSB off, as if it stood on the table at {:.1}°",
                    angle.to_degrees()
                ),
                None => format!("{off:+.1} LSB off the end that the run gives"),
            },
            limit,
            remedy: format!(
                "{} if it is none of an upright dwell; else stand the body upright and measure again",
                correct(p, "the angle")
            ),
        }
    })
}
