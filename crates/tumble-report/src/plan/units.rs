//! Sizes of a plan in the units in which people think of them.

use tumble_core::STANDARD_GRAVITY_M_S2;

use crate::numbers::significant;

/// Factor and unit by a term's name.
pub(super) fn scale(term: &str) -> (f64, &'static str) {
    let gn = STANDARD_GRAVITY_M_S2;
    match term {
        "bias" => (1e3, "mm/s2"),
        "misalignment" => (1e3, "mrad"),
        "scale" => (1e6, "ppm"),
        "k2" => (1e6 * gn, "ug/g2"),
        "k3" => (1e6 * gn * gn, "ug/g3"),
        "temp-bias" => (1e3, "mm/s2/K"),
        "temp-scale" => (1e6, "ppm/K"),
        _ => (1.0, ""),
    }
}

/// The number alone.
pub(super) fn number(term: &str, v: f64) -> String {
    let scaled = v * scale(term).0;
    // Long runs of zeros help nobody: a tenth of the last place that anybody reads.
    if scaled != 0.0 && scaled.abs() < 1e-4 { "0".into() } else { significant(scaled, 2) }
}

/// With its unit.
pub(super) fn shown(term: &str, v: f64) -> String {
    format!("{} {}", number(term, v), scale(term).1)
}

/// Name for people, short enough for a column.
pub(super) fn name(term: &str) -> &str {
    match term {
        "scale" => "scale error",
        "k2" => "K2",
        "k3" => "K3",
        "temp-bias" => "bias/K",
        "temp-scale" => "scale/K",
        other => other,
    }
}
