//! What `tumble check` and `tumble init` print: tables and a small figure in plain characters, 80 columns.

use std::fmt::Write as _;

use tumble_io::{Check, CheckedDwell, CheckedRun, InitDraft};

use crate::characters::Span;
use crate::numbers::significant;
use crate::sanitize::clean_text as plain;
use crate::summary::sensor;
use crate::words::{counted, shortened, wrapped};

const WIDTH: usize = 80;
/// Dwells of a run that are listed one by one.
const LISTED: usize = 400;

/// The table of an experiment.
#[must_use]
pub fn check_table(check: &Check) -> String {
    let mut out = String::new();
    let [model, serial, axis] = &check.sensor;
    let [model, serial, axis] = [plain(model), plain(serial), plain(axis)];
    let _ = writeln!(out, "sensor   {}", sensor([&model, &serial, &axis]));
    let ends = match check.ends {
        [None, None] => String::new(),
        [lo, hi] => format!(
            ", ends {} and {}",
            lo.map_or("open".into(), |c| c.to_string()),
            hi.map_or("open".into(), |c| c.to_string())
        ),
    };
    let _ = writeln!(
        out,
        "output   quantizer {}, unit {}{ends}",
        check.quantizer,
        shortened(&plain(&check.unit), 12)
    );
    let _ = writeln!(
        out,
        "gravity  {} m/s2, standard uncertainty {}",
        significant(check.gravity_m_s2, 6),
        significant(check.gravity_uncertainty_m_s2, 2)
    );
    for run in &check.runs {
        out.push('\n');
        table(&mut out, run, &check.unit);
    }
    if !check.remarks.is_empty() {
        out.push('\n');
        check.remarks.iter().for_each(|r| out.push_str(&wrapped("note     ", &plain(r), 9, WIDTH)));
    }
    out.push_str("\nNothing was judged: tumble certify does that.\n");
    out
}

fn table(out: &mut String, run: &CheckedRun, unit: &str) {
    let _ = writeln!(
        out,
        "{} (mounting {}): {}",
        shortened(&plain(&run.name), 40),
        shortened(&plain(&run.mounting), 16),
        counted(run.dwells.len(), "dwell")
    );
    let unit = shortened(&plain(unit), 8);
    if let (Some(offset), Some(amplitude)) = (run.offset, run.amplitude) {
        let _ = writeln!(
            out,
            "  a plain line through them: 0 g reads {} {unit}, 1 g reads {} {unit} more",
            significant(offset, 5),
            significant(amplitude, 5)
        );
    }
    let extent = run.dwells.iter().filter_map(|d| d.extent).fold(None, |all, [lo, hi]| {
        Some(all.map_or([lo, hi], |[a, b]: [i32; 2]| [a.min(lo), b.max(hi)]))
    });
    if let Some([lo, hi]) = extent {
        let _ = writeln!(out, "  codes from {lo} to {hi}");
    }
    let _ = writeln!(
        out,
        "{:>3} {:>9} {:>7} {:>7} {:>4} {:>10} {:>8} {:>6} {:>8}  state",
        "#", "angle/deg", "samples", "rate/Hz", "gaps", "mean", "noise", "T/degC", "off line"
    );
    for (i, d) in run.dwells.iter().enumerate().take(LISTED) {
        row(out, i + 1, d);
    }
    if run.dwells.len() > LISTED {
        let _ = writeln!(out, "  ... and {} more", run.dwells.len() - LISTED);
    }
    let without: u64 = run.dwells.iter().map(|d| d.without_reading).sum();
    let left_out: u64 = run.dwells.iter().map(|d| d.left_out[0] + d.left_out[1]).sum();
    if without > 0 {
        let _ = writeln!(out, "  {without} rows without a reading were left out");
    }
    if left_out > 0 {
        let _ = writeln!(out, "  {left_out} samples were left out as settling or motion");
    }
    figure(out, run, &unit);
}

fn row(out: &mut String, number: usize, d: &CheckedDwell) {
    let or_dash =
        |v: Option<f64>, digits: i32| v.map_or("-".to_owned(), |v| significant(v, digits));
    let fixed =
        |v: Option<f64>, decimals: usize| v.map_or("-".to_owned(), |v| format!("{v:.decimals$}"));
    let _ = writeln!(
        out,
        "{number:>3} {:>9.4} {:>7} {:>7} {:>4} {:>10} {:>8} {:>6} {:>8}  {}",
        d.angle_deg,
        d.samples,
        or_dash(d.rate_hz, 4),
        d.missing,
        or_dash(d.mean, 7),
        or_dash(d.std, 3),
        fixed(d.temperature_degc, 1),
        or_dash(d.off, 2),
        d.state
    );
}

/// Mean readings against the angle, in characters.
fn figure(out: &mut String, run: &CheckedRun, unit: &str) {
    const COLUMNS: usize = 61;
    const ROWS: usize = 11;
    let points: Vec<(f64, f64)> =
        run.dwells.iter().filter_map(|d| d.mean.map(|m| (d.angle_deg, m))).collect();
    let Some(Span { x: (left, right), y: (low, high) }) = Span::of(&points) else { return };
    let mut grid = vec![vec![' '; COLUMNS]; ROWS];
    let place = |v: f64, from: f64, to: f64, cells: usize| {
        (((v - from) / (to - from)) * (cells - 1) as f64).round().clamp(0.0, (cells - 1) as f64)
            as usize
    };
    for (x, y) in &points {
        grid[ROWS - 1 - place(*y, low, high, ROWS)][place(*x, left, right, COLUMNS)] = '*';
    }
    let _ = writeln!(out, "\n  mean reading, {unit}, against the angle");
    for (i, line) in grid.iter().enumerate() {
        let label = match i {
            0 => significant(high, 4),
            i if i == ROWS - 1 => significant(low, 4),
            _ => String::new(),
        };
        let text: String = line.iter().collect();
        let _ = writeln!(out, "  {label:>10} |{}", text.trim_end());
    }
    let _ = writeln!(out, "  {:>10} +{}", "", "-".repeat(COLUMNS));
    let (from, to) = (format!("{left:.1} deg"), format!("{right:.1} deg"));
    let gap = COLUMNS.saturating_sub(from.len() + to.len());
    let _ = writeln!(out, "  {:>10}  {from}{}{to}", "", " ".repeat(gap));
}

/// What `tumble init` found, assumed and misses.
#[must_use]
pub fn init_summary(draft: &InitDraft) -> String {
    let mut out = String::new();
    if let Ok(read) = &draft.read {
        let dwells: usize = read.experiment.runs.iter().map(|r| r.positions.len()).sum();
        let samples: u64 = read
            .experiment
            .runs
            .iter()
            .flat_map(|r| &r.positions)
            .map(|p| p.readings.samples())
            .sum();
        if dwells > 0 {
            let _ = writeln!(
                out,
                "Read {}, {}, {samples} samples.",
                counted(read.experiment.runs.len(), "run"),
                counted(dwells, "dwell")
            );
        }
        if read.experiment.vertical.is_some() {
            out.push_str("Read a pair with the axis up and down.\n");
        }
    }
    let mut group = |heading: &str, items: &[tumble_io::Assumed]| {
        let worth: Vec<_> = items
            .iter()
            .filter(|a| heading != "Seen" || !a.why.is_empty() && a.value != "\"\"")
            .collect();
        if worth.is_empty() {
            return;
        }
        let _ = writeln!(out, "\n{heading}");
        for a in worth {
            let value = if a.value.contains('\n') {
                "[...]".into()
            } else {
                shortened(&plain(&a.value), 40)
            };
            let why = if a.why.is_empty() { String::new() } else { format!(": {}", plain(&a.why)) };
            out.push_str(&wrapped("  ", &format!("{} = {value}{why}", a.key), 6, WIDTH));
        }
    };
    group("Seen", &draft.seen);
    group("Assumed (look through it)", &draft.assumed);
    if !draft.missing.is_empty() {
        out.push_str("\nMissing\n");
        draft.missing.iter().for_each(|m| out.push_str(&wrapped("  * ", &plain(m), 4, WIDTH)));
    }
    if let Err(e) = &draft.read {
        out.push_str("\nNot yet readable\n");
        out.push_str(&wrapped("  ", &plain(&e.to_string()), 4, WIDTH));
    }
    out
}
