//! What the record shows beside its readings: times, rows that were left out, angles beyond the table.

use crate::{Bench, Finding, FindingKind, Output, Position, Record, Seat, Timing};

/// Relative difference of rates that is worth a warning: crystals keep to 1e-4, RC oscillators in sensors to 5 %.
pub(crate) const RATE_LIMIT: f64 = 0.05;
/// Fewest steps that tell a rate.
const FEWEST_STEPS: u64 = 10;
/// Samples missing in a dwell that are worth a warning.
pub(crate) const MISSING_SAMPLES: u64 = 3;
/// The same as a share of the dwell.
pub(crate) const MISSING_SHARE: f64 = 0.01;
/// Degrees beyond the table's range that are worth a warning: a stop is not set finer.
pub(crate) const RANGE_LIMIT_DEG: f64 = 0.5;

/// Dwells of a run of which something is true.
struct Hits<'a> {
    run: &'a str,
    of: usize,
    found: Vec<(&'a Position, u64)>,
}

impl<'a> Hits<'a> {
    /// Dwells whose count is not zero.
    fn of(run: &'a str, positions: &[&'a Position], count: impl Fn(&'a Position) -> u64) -> Self {
        let found = positions.iter().map(|p| (*p, count(p))).filter(|(_, k)| *k > 0).collect();
        Self { run, of: positions.len(), found }
    }

    fn total(&self) -> u64 {
        self.found.iter().map(|(_, k)| k).sum()
    }

    /// One finding a run: the first place, and how many.
    fn finding(
        self,
        kind: FindingKind,
        line: impl Fn(&Record) -> Option<u64>,
        observed: impl Fn(&Position, u64) -> String,
        limit: String,
        remedy: &str,
    ) -> Option<Finding> {
        let (first, _) = self.found.first()?;
        let at = line(&first.record).map_or_else(String::new, |l| {
            let file = &first.record.file;
            if file.is_empty() {
                format!(", first in line {l}")
            } else {
                format!(", first in line {l} of {file}")
            }
        });
        Some(Finding {
            kind,
            place: first.place.clone(),
            observed: format!(
                "{}{at} ({} of {} dwells of {})",
                observed(first, self.total()),
                self.found.len(),
                self.of,
                self.run
            ),
            limit,
            remedy: remedy.to_owned(),
        })
    }
}

fn timing(p: &Position) -> Option<&Timing> {
    p.record.timing.as_ref()
}

/// Times, rows and range of a run, one finding a kind.
pub(super) fn recorded(
    run: &str,
    positions: &[&Position],
    output: &Output,
    bench: &Bench,
) -> Vec<Finding> {
    [
        backwards(run, positions),
        rate(run, positions, output),
        missing(run, positions, output),
        repeated(run, positions),
        without_reading(run, positions),
        left_out(run, positions),
        outside(run, positions, bench),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn backwards(run: &str, positions: &[&Position]) -> Option<Finding> {
    Hits::of(run, positions, |p| timing(p).map_or(0, |t| t.backwards)).finding(
        FindingKind::TimeBackwards,
        |r| r.timing.as_ref().and_then(|t| t.backwards_line),
        |_, total| format!("time steps back {total} times"),
        "times that rise".into(),
        "check that the rows stand in the order of measurement and that the clock was not set meanwhile; sort them, or write files of their own",
    )
}

/// A rate is wrong when the whole dwell and the typical step both say so: gaps spoil the first, coarse or jittering
/// times the second.
fn disagrees(t: &Timing, stated_hz: f64) -> bool {
    let off = |rate: f64| (rate / stated_hz - 1.0).abs() > RATE_LIMIT;
    if t.backwards > 0 || t.samples <= FEWEST_STEPS {
        return false;
    }
    let overall = t.span_s().filter(|s| *s > 0.0).map(|s| (t.samples - 1) as f64 / s);
    let typical = t.typical_step_s().filter(|s| *s > 0.0).map(|s| 1.0 / s);
    overall.is_some_and(off) && typical.is_some_and(off)
}

fn rate(run: &str, positions: &[&Position], output: &Output) -> Option<Finding> {
    let stated = output.rate_hz.filter(|r| *r > 0.0)?;
    Hits::of(run, positions, |p| u64::from(timing(p).is_some_and(|t| disagrees(t, stated))))
        .finding(
            FindingKind::RateDisagrees,
            |_| None,
            |p, _| {
                let hz = timing(p).and_then(Timing::typical_step_s).map_or(0.0, f64::recip);
                format!("{hz:.2} samples per second recorded, rate_hz = {stated} stated")
            },
            format!("{:.0} %", RATE_LIMIT * 100.0),
            "set rate_hz in [output] to the recorded rate, or check the unit of the time column: it must be seconds",
        )
}

fn missing(run: &str, positions: &[&Position], output: &Output) -> Option<Finding> {
    let count = |p: &Position| {
        let lost = timing(p).map_or(0, |t| t.lost(output.rate_hz));
        let share = MISSING_SHARE * p.readings.samples() as f64;
        if lost >= MISSING_SAMPLES || lost as f64 > share { lost } else { 0 }
    };
    Hits::of(run, positions, count).finding(
        FindingKind::MissingSamples,
        |r| r.timing.as_ref().and_then(|t| t.longest_step_line),
        |_, total| format!("{total} samples are missing between those recorded"),
        format!("{MISSING_SAMPLES} samples, or {:.0} % of a dwell", MISSING_SHARE * 100.0),
        "the logger lost samples: check the line and its buffer; the mean stands, its noise is taken from the samples that are there",
    )
}

fn repeated(run: &str, positions: &[&Position]) -> Option<Finding> {
    Hits::of(run, positions, |p| timing(p).map_or(0, |t| t.repeated)).finding(
        FindingKind::RepeatedSamples,
        |r| r.timing.as_ref().and_then(|t| t.repeated_line),
        |_, total| format!("{total} samples have the time of the one before"),
        "a time of its own for each sample".into(),
        "take rows that were written twice out of the file; if the times are only coarse, record more decimals",
    )
}

fn without_reading(run: &str, positions: &[&Position]) -> Option<Finding> {
    let rows: u64 = positions.iter().map(|p| p.record.rows).sum();
    Hits::of(run, positions, |p| p.record.without_reading).finding(
        FindingKind::RowsWithoutReading,
        |_| None,
        |_, total| format!("{total} of {rows} rows hold no reading and were left out"),
        "a reading in every row".into(),
        "check the logger: an empty field or NaN is a missed read; the other rows were used",
    )
}

fn left_out(run: &str, positions: &[&Position]) -> Option<Finding> {
    let [start, end] = [0, 1].map(|i| positions.iter().map(|p| p.record.left_out[i]).sum::<u64>());
    Hits::of(run, positions, |p| p.record.left_out.iter().sum()).finding(
        FindingKind::SettlingLeftOut,
        |_| None,
        |_, _| format!("{start} samples at the start and {end} at the end of dwells were left out"),
        "stated in the experiment".into(),
        "nothing to do when it was meant; discard_s in [[run]] says how much",
    )
}

fn outside(run: &str, positions: &[&Position], bench: &Bench) -> Option<Finding> {
    let (lo, hi) = bench.range.map(|(lo, hi)| (lo.deg(), hi.deg()))?;
    let beyond = |p: &Position| {
        let deg = p.angle.deg();
        p.seat == Seat::Table && (deg < lo - RANGE_LIMIT_DEG || deg > hi + RANGE_LIMIT_DEG)
    };
    Hits::of(run, positions, |p| u64::from(beyond(p))).finding(
        FindingKind::AngleOutsideRange,
        |r| r.line,
        |p, _| format!("{:.2}° on the table", p.angle.deg()),
        format!("{lo}° … {hi}°, and {RANGE_LIMIT_DEG}° more"),
        "check the angle, its sign and angle_zero_deg; if the table reaches it, widen angle_range_deg in [bench]",
    )
}
