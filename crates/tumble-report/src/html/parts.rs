//! Small parts of the page: numbers in print, definition lists, tables that scroll.

use maud::{Markup, html};

use crate::numbers::{NONE, fixed, significant, typographic};

/// A number alone, to some significant digits.
pub(super) fn number(v: f64, digits: i32) -> String {
    typographic(&significant(v, digits))
}

/// A number that may be missing.
pub(super) fn maybe(v: Option<f64>, digits: i32) -> String {
    v.map_or_else(|| NONE.to_owned(), |v| number(v, digits))
}

/// Degrees of freedom: one decimal below 100, infinite where absent.
pub(super) fn degrees_of_freedom(v: Option<f64>) -> String {
    match v {
        None => "∞".into(),
        Some(v) if v >= 1e6 => "> 10⁶".into(),
        Some(v) => {
            let text = fixed(v, if v < 100.0 { 1 } else { 0 });
            text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
        }
    }
}

/// A number as a file states it: at most twelve digits, without zeros that say nothing.
pub(super) fn stated(v: f64) -> String {
    let text = significant(v, 12);
    let short = match text.rsplit_once('e') {
        None if text.contains('.') => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        Some((m, e)) if m.contains('.') => {
            format!("{}e{e}", m.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    };
    typographic(&short)
}

/// A definition list; entries without a text are left out.
pub(super) fn definitions(entries: &[(&str, String)]) -> Markup {
    html! {
        dl {
            @for (name, text) in entries.iter().filter(|(_, t)| !t.is_empty()) {
                dt { (name) }
                dd { (text) }
            }
        }
    }
}

/// A column of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    heading: &'static str,
    class: Option<&'static str>,
}

/// A column of text.
pub(super) const fn text(heading: &'static str) -> Column {
    Column { heading, class: None }
}

/// A column of numbers.
pub(super) const fn numbers(heading: &'static str) -> Column {
    Column { heading, class: Some("n") }
}

/// A column of short texts that stay on one line.
pub(super) const fn units(heading: &'static str) -> Column {
    Column { heading, class: Some("q") }
}

/// Tables up to this many rows are kept on one printed page.
const WHOLE: usize = 14;

/// A table; the first column heads its row.
pub(super) fn table(
    class: &str,
    caption: &str,
    columns: &[Column],
    rows: &[Vec<String>],
) -> Markup {
    html! {
        div .scroll {
            table class={ (class) @if rows.len() <= WHOLE { " whole" } } {
                @if !caption.is_empty() { caption { (caption) } }
                thead { tr {
                    @for c in columns { th scope="col" class=[c.class] { (c.heading) } }
                } }
                tbody {
                    @for row in rows { tr {
                        @for (i, (cell, c)) in row.iter().zip(columns).enumerate() {
                            @if i == 0 { th scope="row" { (cell) } }
                            @else { td class=[c.class] { (cell) } }
                        }
                    } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stated_numbers_have_no_empty_digits() {
        assert_eq!(stated(9.81), "9.81");
        assert_eq!(stated(0.007_69), "0.00769");
        assert_eq!(stated(-2048.0), "−2048");
        assert_eq!(stated(1e-7), "1×10⁻⁷");
        assert_eq!(stated(0.0), "0");
    }

    #[test]
    fn degrees_of_freedom_in_print() {
        assert_eq!(degrees_of_freedom(None), "∞");
        assert_eq!(degrees_of_freedom(Some(4.0)), "4");
        assert_eq!(degrees_of_freedom(Some(4.13)), "4.1");
        assert_eq!(degrees_of_freedom(Some(57.0)), "57");
        assert_eq!(degrees_of_freedom(Some(1234.56)), "1235");
    }
}
