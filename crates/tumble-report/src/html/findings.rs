//! The findings: everything noteworthy, worst first, severities in words.

use maud::{Markup, html};

use super::{Page, section};
use crate::merge::merged;
use crate::standing::severity_word;
use crate::words::{as_sentence, one_line, shortened};

/// Columns with the part of the width that suits their texts.
const COLUMNS: [(&str, &str); 6] = [
    ("Id", "c-id"),
    ("Severity", "c-severity"),
    ("Finding, where", "c-finding"),
    ("Observed", "c-observed"),
    ("Limit", "c-limit"),
    ("What to do", "c-todo"),
];

pub(super) fn findings(page: &Page<'_>) -> Markup {
    let findings = merged(&page.passport.findings);
    let body = html! {
        @if findings.is_empty() {
            p { "Nothing was found that is worth knowing." }
        } @else {
            div .scroll {
                table .fixed {
                    thead { tr {
                        @for (heading, class) in COLUMNS { th scope="col" class=(class) { (heading) } }
                    } }
                    tbody {
                        @for m in &findings {
                            @let f = m.finding;
                            tr {
                                th scope="row" { (shortened(&f.id, 12)) }
                                td class=(class(&f.severity)) { (shortened(severity_word(&f.severity), 12)) }
                                td {
                                    (as_sentence(&f.title))
                                    @let places = m.places();
                                    @if !places.is_empty() { br; span .small { (places) } }
                                }
                                td { @for o in m.observed() { div { (o) } } }
                                td { (one_line(&f.limit)) }
                                td { (as_sentence(&f.todo)) }
                            }
                        }
                    }
                }
            }
        }
    };
    section("Findings", &body)
}

/// Class of a known severity; text of a passport never becomes a class.
fn class(severity: &str) -> &'static str {
    match severity {
        "reject" => "sev reject",
        "missing" => "sev missing",
        "warning" => "sev warning",
        _ => "sev note",
    }
}
