//! Where it comes from: input files with digests, options, software.

use maud::{Markup, html};

use super::parts::{definitions, number, stated};
use super::{Page, section};
use crate::words::one_line;

pub(super) fn provenance(page: &Page<'_>) -> Markup {
    let p = page.passport;
    let o = &p.options;
    let bias = &page.units.bias;
    let misalignment = &page.units.misalignment;
    let scale = &page.units.scale_error;
    let targets = format!(
        "bias {} {}, misalignment {} {}, scale error {} {}",
        number(bias.of(o.targets.bias_m_s2), 3),
        bias.name,
        number(misalignment.of(o.targets.misalignment_rad), 3),
        misalignment.name,
        number(scale.of(o.targets.scale_error), 3),
        scale.name,
    );
    let weights = match (o.method.as_str(), o.weights.as_str()) {
        ("likelihood", "angle") => "scatter of angles and levels, both from the data",
        ("likelihood", "equal") => "the same scatter at all angles, from the data",
        ("likelihood", "stated") => "the stated angle uncertainty, and what scatters beyond it",
        (_, "angle") => "by the stated angle uncertainty",
        (_, other) => other,
    };
    let body = html! {
        @if !p.inputs.is_empty() {
            div .scroll {
                table .files {
                    thead { tr { th scope="col" { "File" } th scope="col" { "SHA-256" } } }
                    tbody {
                        @for i in &p.inputs {
                            tr {
                                th scope="row" { (one_line(&i.file)) }
                                td .digest { (one_line(&i.sha256)) }
                            }
                        }
                    }
                }
            }
        }
        (definitions(&[
            ("Method", one_line(&o.method)),
            ("Weights", one_line(weights)),
            ("Level", crate::summary::level(p)),
            ("Targets for U", targets),
            ("Lean of up/down dwells", format!("standard uncertainty {} arcmin", stated(p.bench.updown_lean_arcmin))),
            ("Software", one_line(&format!("{} {} ({})", p.software.name, p.software.version, p.software.target))),
            ("Format", one_line(&p.schema)),
        ]))
        p .small {
            "The same version on the same target, with these files and options, gives the same passport byte for byte: run "
            code { "tumble certify" } " on them again."
        }
    };
    section("Inputs, options and software", &body)
}
