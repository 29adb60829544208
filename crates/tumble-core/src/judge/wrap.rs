//! Signed words read as unsigned: the codes wrap.

use crate::linalg::Triangular;
use crate::{Finding, FindingKind, Position, Readings, Seat};

/// Widths of words, bits.
const WIDTHS: std::ops::RangeInclusive<u32> = 8..=32;
/// How much better the run must follow its angles with the sign put back.
pub(crate) const BETTER: f64 = 10.0;
/// Scatter with the sign put back, over the amplitude, that is still a run on a table (1°).
const FOLLOWS: f64 = 0.0175;
/// Fewest dwells that show whether a run follows its angles.
const FEWEST: usize = 5;

/// A run that follows its angles only when the upper half of the words is taken as negative.
pub(super) fn codes_wrap(run: &str, positions: &[&Position]) -> Option<Finding> {
    let extents: Vec<(f64, f64)> = positions.iter().filter_map(|p| extent(&p.readings)).collect();
    let lowest = extents.iter().map(|e| e.0).fold(f64::INFINITY, f64::min);
    let highest = extents.iter().map(|e| e.1).fold(f64::NEG_INFINITY, f64::max);
    let bits = WIDTHS.clone().find(|n| highest < words(*n))?;
    // An average of a dwell that straddles zero lies anywhere: the ends are no more than a hint there.
    if lowest < 0.0 || highest < 0.5 * words(bits) {
        return None;
    }
    let table: Vec<&Position> =
        positions.iter().copied().filter(|p| p.seat == Seat::Table).collect();
    let straddles =
        |p: &&&Position| extent(&p.readings).is_some_and(|(lo, hi)| hi - lo > 0.5 * words(bits));
    let first = table
        .windows(2)
        .find(|w| {
            (mean(w[0], None) >= 0.5 * words(bits)) != (mean(w[1], None) >= 0.5 * words(bits))
        })
        .map(|w| w[1])
        .or_else(|| table.iter().find(straddles).copied())?;
    let as_read = follows(&table, None)?;
    let put_back = follows(&table, Some(bits))?;
    (put_back.0 * BETTER < as_read.0 && put_back.0 < FOLLOWS * put_back.1).then(|| Finding {
        kind: FindingKind::CodesWrap,
        place: first.place.clone(),
        observed: format!(
            "codes of {run} jump by 2^{bits} where the angle passes zero; with {bits}-bit words taken as signed the positions scatter by {:.2} LSB instead of {:.0}",
            put_back.0, as_read.0
        ),
        limit: "codes that follow the angle".into(),
        remedy: format!("set code_bits = {bits} in [csv]: negative words are read with their sign"),
    })
}

fn words(bits: u32) -> f64 {
    2f64.powi(bits as i32)
}

fn extent(readings: &Readings) -> Option<(f64, f64)> {
    match readings {
        Readings::Codes { histogram, .. } => {
            histogram.extent().map(|(lo, hi)| (f64::from(lo.0), f64::from(hi.0)))
        }
        Readings::Averaged { mean, .. } => Some((*mean, *mean)),
        Readings::Values { .. } => None,
    }
}

/// Mean with the upper half of the words taken as negative.
fn mean(p: &Position, bits: Option<u32>) -> f64 {
    let signed = |code: f64| match bits {
        Some(n) if code >= 0.5 * words(n) => code - words(n),
        _ => code,
    };
    match &p.readings {
        Readings::Codes { histogram, .. } => {
            let sum: f64 = histogram.bins().map(|(c, k)| k as f64 * signed(f64::from(c.0))).sum();
            sum / histogram.samples().max(1) as f64
        }
        other => signed(other.mean().unwrap_or(0.0)),
    }
}

/// Scatter around the exact form, LSB, and its amplitude. An average of words on both sides of zero is lost: one
/// dwell in ten may be off.
fn follows(table: &[&Position], bits: Option<u32>) -> Option<(f64, f64)> {
    let mut rows: Vec<([f64; 3], f64)> =
        table.iter().map(|p| ([1.0, p.angle.sin(), p.angle.cos()], mean(p, bits))).collect();
    let averaged = table.iter().any(|p| matches!(p.readings, Readings::Averaged { .. }));
    let spare = if averaged { table.len() / 10 } else { 0 };
    for left in (0..=spare).rev() {
        if rows.len() < FEWEST {
            return None;
        }
        let mut triangle = Triangular::new(3);
        rows.iter().for_each(|(row, y)| triangle.push(row, *y));
        let b = triangle.solve().ok()?;
        let residual = |(row, y): &([f64; 3], f64)| {
            (y - row.iter().zip(&b).map(|(x, v)| x * v).sum::<f64>()).abs()
        };
        if left == 0 {
            let dof = (rows.len() - 3) as f64;
            let squares: f64 = rows.iter().map(|r| residual(r).powi(2)).sum();
            return Some(((squares / dof).sqrt(), b[1].hypot(b[2])));
        }
        let worst =
            (0..rows.len()).max_by(|i, j| residual(&rows[*i]).total_cmp(&residual(&rows[*j])))?;
        rows.remove(worst);
    }
    None
}
