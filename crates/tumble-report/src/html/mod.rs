//! The self-contained page: no script, nothing from outside, light and dark, A4.

mod apply;
mod conformity;
mod evidence;
mod findings;
mod front;
mod head;
mod note;
mod outliers;
mod parts;
mod provenance;
mod result;
mod scatter;
mod style;
mod terms;

pub(crate) use head::head;
use maud::{DOCTYPE, Markup, html};
use tumble_io::passport::Passport;

use crate::standing::Standing;
use crate::units::Units;
use crate::words::shortened;

/// What every section needs.
struct Page<'p> {
    passport: &'p Passport,
    standing: Standing,
    units: Units,
}

/// The passport as one self-contained page.
///
/// No script and no external resource; a content security policy in the page forbids both. Light and dark follow the
/// reader's preference, print is always light on A4 with sensor and number on every page.
///
/// A rejected experiment gets a report of why, without coefficients; one that lacks something, a report of
/// what is missing.
#[must_use]
pub fn html(passport: &Passport) -> String {
    let passport = &crate::sanitized(passport);
    let page = Page { passport, standing: Standing::of(passport), units: Units::of(passport) };
    let sensor = &passport.sensor;
    let subject = format!(
        "{} {} {}",
        shortened(&sensor.model, 40),
        shortened(&sensor.serial, 40),
        shortened(&sensor.axis, 10)
    );
    let title = format!("{} – {subject}", page.standing.heading());
    html! {
        (DOCTYPE)
        html lang="en" {
            // Numbers of the page go into margin boxes; the text is escaped for CSS.
            (head(&title, "light dark", &style::style(page.standing, &subject, &shortened(&passport.id, 60))))
            body {
                (front::front(&page))
                main {
                    (result::result(&page))
                    (conformity::conformity(&page))
                    (apply::apply(&page))
                    (evidence::figures(&page))
                    (evidence::error_level(&page))
                    (terms::terms(&page))
                    (evidence::influence(&page))
                    (evidence::budget(&page))
                    (evidence::runs(&page))
                    (scatter::section_of(&page))
                    (outliers::section_of(&page))
                    (findings::findings(&page))
                    (provenance::provenance(&page))
                    (note::note(&page))
                }
            }
        }
    }
    .into_string()
}

/// The style sheet of a page that is no passport.
pub(crate) fn report_style(subject: &str) -> String {
    style::style(Standing::Unknown, subject, "")
}

/// A section with its heading; nothing at all where the body is empty.
fn section(heading: &str, body: &Markup) -> Markup {
    html! {
        @if !body.0.is_empty() {
            section {
                h2 { (heading) }
                (body)
            }
        }
    }
}
