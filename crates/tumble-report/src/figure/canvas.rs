//! The SVG document around a figure: size, words for screen readers, style for light and dark.

use maud::{Markup, PreEscaped, html};

use super::style::style;

/// Width of all figures; heights differ.
pub(crate) const WIDTH: f64 = 760.0;

/// A coordinate: two decimals.
pub(crate) fn c(v: f64) -> String {
    crate::numbers::fixed(if v.is_finite() { v } else { 0.0 }, 2)
}

/// Text at a place; `class` says size and anchor.
pub(crate) fn label(x: f64, y: f64, class: &str, text: &str) -> Markup {
    html! { text class=(class) x=(c(x)) y=(c(y)) { (text) } }
}

/// The whole document.
pub(crate) fn document(
    name: &str,
    title: &str,
    description: &str,
    height: f64,
    body: &Markup,
) -> String {
    let scope = format!("tumble-{name}");
    html! {
        svg xmlns="http://www.w3.org/2000/svg" class=(scope) role="img"
            width=(c(WIDTH)) height=(c(height)) viewBox={ "0 0 " (c(WIDTH)) " " (c(height)) }
            aria-labelledby={ (scope) "-title " (scope) "-desc" } {
            title id={ (scope) "-title" } { (title) }
            desc id={ (scope) "-desc" } { (description) }
            style { (PreEscaped(style(&scope))) }
            rect .ground x="0" y="0" width=(c(WIDTH)) height=(c(height)) {}
            (body)
        }
    }
    .into_string()
}
