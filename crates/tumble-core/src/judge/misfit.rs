//! Single dwells that contradict the others: a mistyped angle, or a dwell that does not fit.

use super::dwell_fit::DwellFit;
use super::slip::{decimals, explain};
use crate::stats::student_factor;
use crate::{Dial, Finding, FindingKind, Position};

/// Level at which an explained number must fit: a few σ, more with few dwells.
const EXPLAINED_LEVEL: f64 = 0.999;
/// Numbers typed before and after that a slip may have copied.
const NEIGHBOURS: usize = 2;

/// One finding a dwell that does not fit, with its index, and with the angle that would fit, where there is one.
pub(super) fn misfits(fit: &DwellFit, positions: &[&Position]) -> Vec<(usize, Finding)> {
    fit.alone()
        .into_iter()
        .filter_map(|(point, in_time)| {
            let finding = misfit(fit, positions, point, in_time)?;
            Some((fit.points[point].index, finding))
        })
        .collect()
}

/// A dwell that its neighbours in time go along with may have drifted: only a telling slip is named there.
fn misfit(fit: &DwellFit, positions: &[&Position], point: usize, in_time: bool) -> Option<Finding> {
    let p = &fit.points[point];
    let position = positions.get(p.index)?;
    let off_lsb = fit.residual_lsb(point);
    let (_, deviation) = fit.expected_lsb(p.angle_rad);
    let fits = Fits::of(fit, position, point);
    let limit = format!(
        "{deviation:.2} LSB, as the {} other dwells scatter",
        fit.points.len() - fit.wrong.len()
    );
    let neighbours = typed_around(fit, positions, point);
    let slip = fits.as_ref().and_then(|f| {
        let [before, after] = &neighbours;
        explain(&f.dial.typed, f.dial.value, [before, after], f.value, f.tolerance)
            .map(|(slip, meant)| (f, slip, meant))
    });
    if !in_time && !slip.as_ref().is_some_and(|(_, slip, _)| slip.is_telling()) {
        return None;
    }
    Some(match slip {
        Some((f, slip, meant)) => Finding {
            kind: FindingKind::MistypedAngle,
            place: position.place.clone(),
            observed: format!(
                "{} is typed where the readings fit {} ({}: {})",
                f.with_unit(&f.dial.typed),
                f.with_unit(&f.digits()),
                slip.words(),
                f.with_unit(&meant.to_string()),
            ),
            limit,
            remedy: format!(
                "if the table stood at {}, {}; else measure the dwell again",
                f.with_unit(&meant.to_string()),
                correct(position, "the angle"),
            ),
        },
        None => Finding {
            kind: FindingKind::DwellDoesNotFit,
            place: position.place.clone(),
            observed: match &fits {
                Some(f) => format!(
                    "{off_lsb:+.1} LSB off, as if the table stood at {} ({:+.2}°)",
                    f.with_unit(&f.digits()),
                    f.off_deg
                ),
                None => format!("{off_lsb:+.1} LSB off, more than any angle explains"),
            },
            limit,
            remedy: "measure the dwell again; if it was disturbed, or its angle was not set, take its rows out of the file".into(),
        },
    })
}

/// "correct …", with the line where it stands.
pub(super) fn correct(position: &Position, what: &str) -> String {
    let record = &position.record;
    match record.line {
        Some(line) if record.file.is_empty() => format!("correct {what} in line {line}"),
        Some(line) => format!("correct {what} in line {line} of {}", record.file),
        None => format!("correct {what}"),
    }
}

/// The dial's number that fits a dwell.
struct Fits<'a> {
    dial: &'a Dial,
    value: f64,
    tolerance: f64,
    off_deg: f64,
}

impl<'a> Fits<'a> {
    fn of(fit: &DwellFit, position: &'a Position, point: usize) -> Option<Self> {
        let p = &fit.points[point];
        let dial = position.record.dial.as_ref()?;
        let (angle_rad, slope) = fit.angle_of(p.level_lsb)?;
        let (_, deviation) = fit.expected_lsb(angle_rad);
        let factor = student_factor(EXPLAINED_LEVEL, fit.degrees_of_freedom)?;
        let spread = deviation.hypot(p.excess_lsb2.sqrt());
        let tolerance_deg = ((factor * spread + p.allowance_lsb) / slope).to_degrees();
        let off_deg = (angle_rad - p.angle_rad).to_degrees();
        let per_unit = dial.unit_deg * dial.direction;
        Some(Self {
            dial,
            value: dial.value + off_deg / per_unit,
            tolerance: tolerance_deg / dial.unit_deg.abs(),
            off_deg,
        })
    }

    /// One decimal more than was typed.
    fn digits(&self) -> String {
        format!("{:.*}", decimals(&self.dial.typed) + 1, self.value)
    }

    fn with_unit(&self, number: &str) -> String {
        match self.dial.unit_deg {
            1.0 => format!("{number}°"),
            0.9 => format!("{number} gon"),
            _ => format!("{number} (dial)"),
        }
    }
}

/// Numbers typed before and after a dwell, the nearest first.
fn typed_around(fit: &DwellFit, positions: &[&Position], point: usize) -> [Vec<f64>; 2] {
    let typed = |i: &usize| {
        let position = positions.get(fit.points[*i].index)?;
        position.record.dial.as_ref().map(|d| d.value)
    };
    let before = (0..point).rev().take(NEIGHBOURS).filter_map(|i| typed(&i)).collect();
    let after = (point + 1..fit.points.len()).take(NEIGHBOURS).filter_map(|i| typed(&i)).collect();
    [before, after]
}
