//! The findings: everything noteworthy, worst first, severities in words.

use maud::{Markup, html};

use super::{Page, section};
use crate::standing::severity_word;
use crate::words::{as_sentence, one_line, shortened};

pub(super) fn findings(page: &Page<'_>) -> Markup {
    let findings = &page.passport.findings;
    let body = html! {
        @if findings.is_empty() {
            p { "Nothing was found that is worth knowing." }
        } @else {
            div .scroll {
                table {
                    thead { tr {
                        th scope="col" { "Id" }
                        th scope="col" { "Severity" }
                        th scope="col" { "Finding" }
                        th scope="col" { "Observed" }
                        th scope="col" { "Limit" }
                        th scope="col" { "What to do" }
                    } }
                    tbody {
                        @for f in findings {
                            tr {
                                th scope="row" .q { (shortened(&f.id, 12)) }
                                td class=(class(&f.severity)) { (shortened(severity_word(&f.severity), 16)) }
                                td {
                                    (as_sentence(&f.title))
                                    @if !f.place.is_empty() { br; span .small { (one_line(&f.place)) } }
                                }
                                td { (one_line(&f.observed)) }
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
