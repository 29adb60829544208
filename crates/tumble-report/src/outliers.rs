//! Positions that do not belong, for the terminal.

use std::fmt::Write as _;

use tumble_io::passport::{Outlier, Passport, PerParameter};

use crate::numbers::{fixed, p_value, significant};
use crate::words::shortened;

/// Lines of the terminal's table.
const MOST: usize = 12;

/// Three changes in expanded uncertainties, `+0.3 / -0.1 / +1.2`.
pub(crate) fn three(t: &PerParameter) -> String {
    let one = |v: Option<f64>| match v {
        None => "?".to_owned(),
        Some(v) if v > 0.0 => format!("+{}", fixed(v, 2)),
        Some(v) => fixed(v, 2),
    };
    [t.bias, t.misalignment, t.scale_error].map(one).join(" / ")
}

/// The table of positions that do not belong or were left out; nothing where there are none.
pub(crate) fn table(out: &mut String, p: &Passport) {
    if p.outliers.is_empty() {
        return;
    }
    out.push_str(
        "\nPositions that do not belong, or were left out (change in U: bias/misal./scale)\n",
    );
    let unit = shortened(&crate::units::Units::of(p).reading, 6);
    for o in p.outliers.iter().take(MOST) {
        let _ = writeln!(out, "  {}", line(o, &unit));
    }
    if p.outliers.len() > MOST {
        let _ = writeln!(out, "  and {} more", p.outliers.len() - MOST);
    }
}

fn line(o: &Outlier, unit: &str) -> String {
    let off = o.residual_lsb.map_or_else(|| "?".into(), |v| significant(v, 3));
    let p =
        o.p_value.map_or_else(|| "?".into(), |p| p_value(p).trim_start_matches("= ").to_owned());
    let effect = o.effect_over_u.as_ref().map_or_else(|| "?".into(), three);
    let place = format!("{}:{}", shortened(&o.run, 12), o.position);
    let kept = if o.left_out { "left out" } else { "kept" };
    format!("{place:<16}{off:>8} {unit}  p {p:<8} {effect:<24} {kept}")
}
