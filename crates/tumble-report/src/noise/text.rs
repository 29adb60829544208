//! What `tumble noise` prints: tables and a small figure in plain characters, 80 columns.

use std::fmt::Write as _;

use tumble_io::noise::{CurveEntry, NoiseDocument};

use super::{deviation_name, duration, short_name, stated, with_interval};
use crate::characters::Span;
use crate::numbers::{p_value, significant};
use crate::sanitize::clean_text as plain;
use crate::words::wrapped;

const WIDTH: usize = 80;
/// Averaging times that are listed; all of them stand in the JSON.
const LISTED: usize = 60;

/// The noise of a record for the terminal.
#[must_use]
pub fn noise_table(d: &NoiseDocument) -> String {
    let mut out = String::new();
    head(&mut out, d);
    for curve in &d.curves {
        table(&mut out, d, curve);
    }
    if let Some(curve) = d.curves.first() {
        figure(&mut out, d, curve);
    }
    coefficients(&mut out, d);
    if let Some(c) = &d.converter {
        let step = stated(c.step);
        let noise = significant(c.noise_in_steps, 3);
        let text = match c.dithered {
            true => format!(
                "step {step} {u}. The noise is {noise} steps a reading, which spreads the readings over steps: rounding is \
                 white noise of {} {u} a reading (step/sqrt(12)), N = {} {u} rts, part of the N above.",
                significant(c.of_a_reading, 3),
                significant(c.n, 3),
                u = d.unit
            ),
            false => format!(
                "step {step} {u}. The noise is {noise} steps a reading: too little, averages follow the steps.",
                u = d.unit
            ),
        };
        out.push_str(&wrapped("converter  ", &text, 11, WIDTH));
    }
    if let Some(best) = &d.dwell {
        let text = format!(
            "{}: deviation {} {u}, the least is {} {u} at {}. It is {}.",
            duration(best.tau_s),
            significant(best.deviation, 3),
            significant(best.least, 3),
            duration(best.least_tau_s),
            // "the shortest …" and "the deviation still …" both read on.
            if best.why.starts_with("the shortest") {
                best.why.clone()
            } else {
                format!("open: {}", best.why)
            },
            u = d.unit
        );
        out.push_str(&wrapped("best dwell ", &text, 11, WIDTH));
    }
    for remark in &d.remarks {
        out.push_str(&wrapped("note       ", &plain(remark), 11, WIDTH));
    }
    out
}

fn head(out: &mut String, d: &NoiseDocument) {
    let i = &d.input;
    let length = i.readings as f64 / i.rate_hz;
    let from = match &i.time_column {
        Some(column) => {
            let column = crate::words::shortened(&plain(column), 30);
            // A file without names has `column 1`.
            format!("from column {}", column.strip_prefix("column ").unwrap_or(&column))
        }
        None => "as given".to_owned(),
    };
    let text = format!(
        "{}: {} readings at {} Hz ({from}), {}",
        short_name(&i.file),
        i.readings,
        stated(i.rate_hz),
        duration(length)
    );
    out.push_str(&wrapped("record     ", &text, 11, WIDTH));
    let text = format!(
        "mean {} {u}, standard deviation {} {u}; read from {} to {}",
        significant(d.mean, 6),
        significant(d.standard_deviation, 3),
        stated(d.extremes[0]),
        stated(d.extremes[1]),
        u = d.unit
    );
    out.push_str(&wrapped("readings   ", &text, 11, WIDTH));
    let text = match &d.scale {
        Some(s) => format!("{} m/s2 a unit, {}", stated(s.m_s2_per_unit), plain(&s.source)),
        None => format!(
            "none: results are in {}; --scale turns them into m/s2",
            if d.unit == "LSB" { "LSB" } else { "the unit of the readings" }
        ),
    };
    out.push_str(&wrapped("scale      ", &text, 11, WIDTH));
}

fn table(out: &mut String, d: &NoiseDocument, curve: &CurveEntry) {
    let _ = writeln!(
        out,
        "\n{} ({}), {}; band of {} %",
        deviation_name(&curve.deviation),
        curve.deviation,
        d.unit,
        stated(100.0 * d.level)
    );
    let _ = writeln!(
        out,
        "{:>9} {:>9} {:>10} {:>10} {:>10} {:>8}  kind of noise",
        "tau/s", "m", "deviation", "low", "high", "edf"
    );
    let step = curve.points.len().div_ceil(LISTED).max(1);
    for p in curve.points.iter().step_by(step) {
        let band = |k: usize| p.band.map_or("-".to_owned(), |b| significant(b[k], 4));
        let kind = p.kind.as_deref().unwrap_or("-");
        // For lines of 80 columns.
        let kind = match kind.split(" (").next().unwrap_or(kind) {
            "flicker of the velocity" => "flicker velocity",
            short => short,
        };
        let _ = writeln!(
            out,
            "{:>9} {:>9} {:>10} {:>10} {:>10} {:>8}  {}",
            significant(p.tau_s, 5),
            p.factor,
            significant(p.deviation, 4),
            band(0),
            band(1),
            p.edf.map_or("-".to_owned(), |e| if e < 1e5 {
                format!("{e:.1}")
            } else {
                significant(e, 3)
            }),
            if p.kind_is_carried { "as above" } else { kind }
        );
    }
    if step > 1 {
        let _ = writeln!(out, "  one time in {step} is listed; --json has all");
    }
}

/// Deviation against time, both logarithmic.
fn figure(out: &mut String, d: &NoiseDocument, curve: &CurveEntry) {
    const COLUMNS: usize = 61;
    const ROWS: usize = 15;
    let points: Vec<(f64, f64)> = curve
        .points
        .iter()
        .filter(|p| p.deviation > 0.0)
        .map(|p| (p.tau_s.log10(), p.deviation.log10()))
        .collect();
    let Some(Span { x: (left, right), y: (low, high) }) = Span::of(&points) else { return };
    let mut grid = vec![vec![' '; COLUMNS]; ROWS];
    let place = |v: f64, from: f64, to: f64, cells: usize| {
        let part = ((v - from) / (to - from) * (cells - 1) as f64).round();
        (0.0..cells as f64).contains(&part).then_some(part as usize)
    };
    let mut put = |x: f64, y: f64, mark: char| {
        if let (Some(x), Some(y)) = (place(x, left, right, COLUMNS), place(y, low, high, ROWS)) {
            grid[ROWS - 1 - y][x] = mark;
        }
    };
    for m in d.fit.iter().flat_map(|f| &f.curve).filter(|m| m.deviation > 0.0) {
        put(m.tau_s.log10(), m.deviation.log10(), '.');
    }
    points.iter().for_each(|(x, y)| put(*x, *y, '*'));
    if let Some(best) = &d.dwell {
        put(best.tau_s.log10(), best.deviation.log10(), 'O');
    }
    let _ = writeln!(
        out,
        "\n  {}, {}: * measured, . fitted, O best dwell",
        deviation_name(&curve.deviation),
        d.unit
    );
    for (i, line) in grid.iter().enumerate() {
        let label = match i {
            0 => significant(10f64.powf(high), 3),
            i if i == ROWS - 1 => significant(10f64.powf(low), 3),
            _ => String::new(),
        };
        let text: String = line.iter().collect();
        let _ = writeln!(out, "  {label:>10} |{}", text.trim_end());
    }
    let _ = writeln!(out, "  {:>10} +{}", "", "-".repeat(COLUMNS));
    let text = |v: f64| format!("{} s", significant(10f64.powf(v), 3));
    let (from, to) = (text(left), text(right));
    let gap = COLUMNS.saturating_sub(from.len() + to.len());
    let _ = writeln!(out, "  {:>10}  {from}{}{to}\n", "", " ".repeat(gap));
}

fn coefficients(out: &mut String, d: &NoiseDocument) {
    let Some(fit) = &d.fit else { return };
    let _ = writeln!(
        out,
        "coefficients, intervals of {} % (chi2 {}, {} degrees of freedom{})",
        stated(100.0 * fit.level),
        significant(fit.chi_squared, 3),
        fit.degrees_of_freedom,
        fit.p.map_or(String::new(), |p| format!(", p {}", p_value(p)))
    );
    for c in &fit.coefficients {
        let value = with_interval(c.value, &c.unit, c.interval);
        out.push_str(&wrapped(
            &format!("  {}  ", c.symbol),
            &format!("{}: {value}", c.name),
            5,
            WIDTH,
        ));
        for s in c.sheet.iter().filter(|_| c.value > 0.0) {
            let meaning =
                if s.meaning.is_empty() { String::new() } else { format!(": {}", s.meaning) };
            let text = format!("= {}{meaning}", with_interval(s.value, &s.unit, s.interval));
            out.push_str(&wrapped("       ", &text, 9, WIDTH));
        }
    }
    // Three roots that plain characters do not have.
    out.push_str("  rts, rth, rtHz: the square root of s, h, Hz\n\n");
}
