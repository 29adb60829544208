//! Rows of zeros that a logger left at the end of a record.

use super::dwell_fit::{DwellFit, points};
use super::outlying::{outlying, usual_spread};
use crate::{Code, CodeHistogram, Finding, FindingKind, Position, Quantizer, Readings};

/// Standard deviations of the other dwells from which zero does not fit.
pub(crate) const DOES_NOT_FIT: f64 = 6.0;
/// And so many LSB.
pub(crate) const DOES_NOT_FIT_LSB: f64 = 2.0;
/// Zeros that close a dwell from which on they are a filled record, not a spike.
const CLOSING: u64 = 3;

/// The dwell that zero rows spoil, by its index, and the finding. An honest last dwell at 0° may read zero: only
/// zeros that do not fit the others count.
pub(super) fn zero_rows(positions: &[&Position], quantizer: Quantizer) -> Option<(usize, Finding)> {
    let usual = usual_spread(positions);
    let (index, zeros) = positions.iter().enumerate().rev().find_map(|(i, p)| {
        let tail = zero_tail(p, usual);
        let whole = || whole_dwell(positions, i, quantizer);
        tail.or_else(whole).map(|zeros| (i, zeros))
    })?;
    let p = positions[index];
    let at = p.record.zero_rows.map_or_else(String::new, |(_, line)| {
        let file =
            if p.record.file.is_empty() { String::new() } else { format!(" of {}", p.record.file) };
        format!(" from line {line}{file} on")
    });
    let finding = Finding {
        kind: FindingKind::ZeroRows,
        place: p.place.clone(),
        observed: format!("{zeros} rows hold nothing but zeros at the end of the record{at}"),
        limit: "readings that fit the other dwells".into(),
        remedy: format!("the logger filled the record up: take the rows{at} out of the file"),
    };
    Some((index, finding))
}

/// Zeros at the end of a dwell that reads something else.
fn zero_tail(p: &Position, usual: f64) -> Option<u64> {
    let Readings::Codes { histogram, .. } = &p.readings else { return None };
    let zeros = histogram.bins().find(|(c, _)| *c == Code(0)).map(|(_, k)| k)?;
    let (far, known) = match p.record.zero_rows {
        Some((rows, _)) => (rows.min(zeros), true),
        None => (zeros.min(p.record.closing_repeats), false),
    };
    // Without a word of the reader all zeros of the dwell must be the ones that close it.
    if far == 0 || (!known && (far < CLOSING || far < zeros)) {
        return None;
    }
    // However many zeros there are: held against what else the dwell reads, and one of them is enough.
    let mut rest = CodeHistogram::default();
    histogram.bins().filter(|(c, _)| *c != Code(0)).for_each(|(c, k)| rest.record_many(c, k));
    rest.record(Code(0));
    outlying(&rest, usual)
        .is_some_and(|o| o.codes.iter().any(|(c, _)| *c == Code(0)))
        .then_some(far)
}

/// A last dwell of zeros alone that the others do not expect.
fn whole_dwell(positions: &[&Position], index: usize, quantizer: Quantizer) -> Option<u64> {
    let p = positions[index];
    let (rows, _) = p.record.zero_rows?;
    let all_zero = p.readings.mean() == Some(0.0) && p.readings.std().unwrap_or(0.0) == 0.0;
    if !all_zero {
        return None;
    }
    let others: Vec<&Position> =
        positions.iter().enumerate().filter(|(i, _)| *i != index).map(|(_, p)| *p).collect();
    let fit = DwellFit::of(points(&others, quantizer))?;
    let (expected, deviation) = fit.expected_lsb(p.angle.rad());
    let step = if quantizer == Quantizer::None { 0.0 } else { DOES_NOT_FIT_LSB };
    (expected.abs() > step + DOES_NOT_FIT * deviation).then_some(rows)
}
