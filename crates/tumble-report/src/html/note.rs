//! The closing note: what the uncertainty holds, and what it does not.

use maud::{Markup, html};

use super::{Page, section};
use crate::standing::Standing;
use crate::words::one_line;

pub(super) fn note(page: &Page<'_>) -> Markup {
    let p = page.passport;
    let body = match page.standing {
        Standing::Accepted | Standing::Unproven { .. } => {
            let mut holds: Vec<String> = Vec::new();
            for line in p.budget.iter().filter(|l| l.contribution > 0.0) {
                let quantity = one_line(&line.quantity);
                if !holds.contains(&quantity) {
                    holds.push(quantity);
                }
            }
            html! {
                p {
                    "The expanded uncertainty U states an interval value ± U that is expected to hold the true value of the "
                    "parameter with a probability of " (crate::summary::level(p)) " (JCGM 100). It holds: "
                    @if holds.is_empty() { "the scatter of the readings" } @else { (listed(&holds)) }
                    "; nothing else. Ageing, transport, and temperatures outside the range that was measured are not in it. What \
                     the budget calls a default was assumed, not measured."
                }
                p {
                    "The values hold for this sensor and axis, in the mounting and under the conditions stated. The misalignment \
                     belongs to the mounting, not to the sensor alone."
                }
            }
        }
        Standing::Incomplete => html! {
            p {
                "Nothing on this page may be used to correct readings. Supply what is missing, measure again if need be, and \
                 certify anew."
            }
        },
        Standing::Rejected | Standing::Unknown => html! {
            p {
                "Nothing on this page may be used to correct readings. The figures and numbers are there to find the cause. \
                 Remove it, measure again, and certify anew."
            }
        },
    };
    section("What this page says, and what it does not", &body)
}

/// `a`, `a and b`, `a, b and c`.
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
