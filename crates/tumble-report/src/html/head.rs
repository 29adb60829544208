//! The head that every page has: nothing from outside, no script.

use maud::{Markup, PreEscaped, html};

/// With a title, the colour schemes that the page is made for, and its style sheet, which must be safe as it stands.
pub(crate) fn head(title: &str, schemes: &str, style: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content=(schemes);
            title { (title) }
            style { (PreEscaped(style)) }
        }
    }
}
