//! Data hygiene before any estimation: saturated dwells, a stuck converter.

use crate::{Bench, Code, Finding, FindingKind, Output, Position, Readings, Run};

/// Movement of the angle, in LSB's worth, during which a converter must not keep its code.
pub(crate) const STUCK_LIMIT_LSB: f64 = 2.0;

/// What is done with dwells that touch the converter's ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Censored {
    /// Averages know nothing of half-lines: the whole dwell is left out.
    LeftOut,
    /// Raw codes at an end are bounds for the likelihood.
    Kept,
}

/// Positions that can be used, and what was noticed while choosing them.
#[derive(Debug, Clone, PartialEq)]
pub struct Usable<'a> {
    /// In measured order.
    pub positions: Vec<&'a Position>,
    /// What was noticed.
    pub findings: Vec<Finding>,
}

/// Chooses the dwells that an estimator can use, and looks for a converter that sticks.
#[must_use]
pub fn usable_positions<'a>(
    run: &Run,
    candidates: Vec<&'a Position>,
    output: &Output,
    bench: &Bench,
    nominal_scale_m_s2_per_lsb: f64,
    handling: Censored,
) -> Usable<'a> {
    let mut findings = Vec::new();
    let total = candidates.len();
    let all = candidates.clone();
    let (mut positions, censored): (Vec<_>, Vec<_>) =
        candidates.into_iter().partition(|p| p.readings.censored(&output.ends) == 0);
    let kept = handling == Censored::Kept;
    let ends = format!(
        "codes strictly inside {} … {}",
        end_text(output.ends.min_code),
        end_text(output.ends.max_code)
    );
    if positions.is_empty() && total > 0 {
        findings.push(Finding {
            kind: FindingKind::SaturatedThroughout,
            place: run.name.clone(),
            observed: format!("all {total} dwells at the converter's end"),
            limit: ends,
            remedy:
                "lower the gain or choose a range of the sensor that covers ±1 g, and measure again"
                    .into(),
        });
    } else if let Some(first) = censored.first() {
        findings.push(Finding {
            kind: FindingKind::SaturatedDwell,
            place: first.place.clone(),
            observed: format!(
                "{} of {total} dwells hold codes at the converter's end; {}",
                censored.len(),
                if kept { "used as bounds" } else { "left out" }
            ),
            limit: ends,
            remedy: "keep the angles inside the converter's range, or lower the gain".into(),
        });
    }
    let full_scale = bench.gravity.value_m_s2 / nominal_scale_m_s2_per_lsb;
    if let Some(finding) = stuck(run, &positions, full_scale) {
        findings.push(finding);
    }
    if kept {
        // An average at an end says how little it knows: nothing.
        positions = all
            .into_iter()
            .filter(|p| {
                p.readings.censored(&output.ends) == 0
                    || matches!(p.readings, Readings::Codes { .. })
            })
            .collect();
    }
    Usable { positions, findings }
}

fn end_text(end: Option<Code>) -> String {
    end.map_or_else(|| "(not stated)".into(), |c| c.0.to_string())
}

/// A code (or an exact mean) that stays while the angle moved by more than two LSB's worth.
fn stuck(run: &Run, positions: &[&Position], full_scale_lsb: f64) -> Option<Finding> {
    let level = |p: &Position| p.seat.vertical_sign().unwrap_or_else(|| p.angle.sin());
    let same = |a: &Position, b: &Position| match (a.readings.only_code(), b.readings.only_code()) {
        (Some(x), Some(y)) => x == y,
        // Real noise never repeats a mean and a scatter of many samples to the last digit.
        _ => {
            a.readings.samples() > 1
                && a.readings.mean() == b.readings.mean()
                && a.readings.std() == b.readings.std()
        }
    };
    let moved = |a: &Position, b: &Position| ((level(a) - level(b)) * full_scale_lsb).abs();
    let mut stuck_pairs =
        positions.windows(2).filter(|w| same(w[0], w[1]) && moved(w[0], w[1]) > STUCK_LIMIT_LSB);
    let first = stuck_pairs.next()?;
    let more = stuck_pairs.count();
    Some(Finding {
        kind: FindingKind::StuckConverter,
        place: first[1].place.clone(),
        observed: format!(
            "the reading stays at {} while the angle moves by {:.1} LSB's worth (seen {} times in {})",
            first[0].readings.mean().unwrap_or_default(),
            moved(first[0], first[1]),
            more + 1,
            run.name
        ),
        limit: format!("{STUCK_LIMIT_LSB} LSB's worth"),
        remedy:
            "check that the logger reads fresh samples and that the converter runs; measure again"
                .into(),
    })
}
