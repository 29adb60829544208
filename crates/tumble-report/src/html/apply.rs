//! How to use the coefficients: the formula with its numbers, a worked example, the range, the command.

use maud::{Markup, html};
use tumble_io::passport::{Compensation, Passport};

use super::parts::{number, stated};
use super::{Page, section};
use crate::numbers::{fixed, plain, typographic};
use crate::standing::{self, Standing};
use crate::words::{offset, one_line};

pub(super) fn apply(page: &Page<'_>) -> Markup {
    let Some(c) = standing::compensation(page.passport) else { return html! {} };
    let (k, bias) = coefficients(page.passport, c);
    let unit = &page.units.reading;
    let [lo, hi] = c.valid_range_lsb;
    let one = |v: f64| typographic(&fixed(v, 1));
    let c_of_n = match c.quantizer_offset.as_str() {
        "half_sign" => Some(if c.example.code > 0 {
            "0.5"
        } else if c.example.code < 0 {
            "−0.5"
        } else {
            "0"
        }),
        "half" => Some("0.5"),
        "none" => Some("0"),
        _ => None,
    };
    // A number behind a sign goes into brackets when it has one of its own.
    let bracketed = |t: &str| if t.starts_with('−') { format!("({t})") } else { t.to_owned() };
    let body = html! {
        p .formula {
            span { "a = k* · (N + c(N)) − Δa" }
            span { "a = " (k) " · (N + c(N)) − " (bracketed(&bias)) "  m/s²" }
        }
        p {
            "N is one reading in " (unit) ", a the acceleration along the axis in m/s². c(N) gives back what the converter cuts \
             off: " (one_line(offset(&c.quantizer_offset))) ". Apply it to each reading, then average."
        }
        @if let Some(c_of_n) = c_of_n {
            @let code = typographic(&c.example.code.to_string());
            p {
                "Worked number: N = " (code) " gives a = " (k) " · (" (code) " + " (bracketed(c_of_n)) ") − " (bracketed(&bias))
                " = " b { (typographic(&fixed(c.example.acceleration_m_s2, 5))) " m/s²" } "."
            }
        }
        p {
            "Valid from N = " (one(lo)) " to N = " (one(hi)) " " (unit) ", the range that was measured"
            @if let Some([lo, hi]) = page.passport.validity.temperature_degc {
                ", at " (number(lo, 3)) " °C to " (number(hi, 3)) " °C"
            }
            ". "
            @if let Some(s) = c.reading_std_lsb {
                "A single reading scatters by " (number(s, 2)) " " (unit) " (standard deviation within a dwell); that comes on \
                 top of the uncertainty of the coefficients."
            }
        }
        p {
            "Or: " code {
                "tumble compensate passport.json"
                @if matches!(page.standing, Standing::Unproven { .. }) { " --unproven" }
            }
            @if matches!(page.standing, Standing::Unproven { .. }) {
                ". Without " code { "--unproven" } " the command refuses, because reproducibility is not shown"
            }
            "."
        }
    };
    section("How to apply it", &body)
}

/// Scale factor and bias with two digits more than their uncertainty has, so that rounding does no harm.
fn coefficients(p: &Passport, c: &Compensation) -> (String, String) {
    let result = p.result.as_ref();
    let shown = |v: f64, u: Option<f64>| {
        // Without a usable uncertainty: all digits that a table would hold.
        u.and_then(|u| plain(v, u / 100.0)).map_or_else(|| stated(v), |text| typographic(&text))
    };
    (
        shown(c.scale_factor, result.and_then(|r| r.scale_factor.standard_uncertainty)),
        shown(c.bias, result.and_then(|r| r.bias.standard_uncertainty)),
    )
}
