//! Every renderer escapes what strangers wrote: no script, no control characters, well-formed markup.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::path::Path;

use proptest::prelude::*;
use serde_json::Value;
use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, certify};
use tumble_report::{figures, html, summary};

/// A real passport with a result (one run: indeterminate, with coefficients).
fn passport() -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/reference/raw-floor");
    serde_json::to_value(certify(&folder, &CertifyOptions::default()).unwrap()).unwrap()
}

/// Puts hostile text into every string of a passport but those that the renderers branch on.
fn poisoned(value: &mut Value, key: &str, text: &str) {
    match value {
        Value::String(s) if !matches!(key, "schema" | "verdict" | "severity") => {
            *s = text.to_owned()
        }
        Value::Array(items) => items.iter_mut().for_each(|v| poisoned(v, key, text)),
        Value::Object(map) => map.iter_mut().for_each(|(k, v)| poisoned(v, k, text)),
        _ => {}
    }
}

fn hostile() -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        Just("</script><script>alert(1)</script>".to_owned()),
        Just("\"><svg onload=alert(1)>".to_owned()),
        Just("</title></style></svg>]]>-->".to_owned()),
        Just("\u{1b}[2J\u{1b}]0;owned\u{7}".to_owned()),
        Just("=cmd|' /C calc'!A0".to_owned()),
        Just("\u{202e}gnp.exe\u{2066}\0\u{85}\u{feff}".to_owned()),
        Just("&amp;&#x3c;<!--'\"`\n\r\n\t".to_owned()),
        Just("x".repeat(3000)),
        any::<String>(),
    ];
    prop::collection::vec(piece, 0..4).prop_map(|p| p.concat())
}

/// Names of elements, checked to be balanced; attributes must be quoted and closed.
fn elements(markup: &str, void: &[&str]) -> Vec<String> {
    let (mut open, mut seen) = (Vec::new(), Vec::new());
    let mut rest = markup;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let end = end_of_tag(rest);
        let tag = &rest[..end];
        rest = &rest[end + 1..];
        if tag.starts_with('!') {
            continue;
        }
        let name: String =
            tag.trim_start_matches('/').chars().take_while(|c| c.is_ascii_alphanumeric()).collect();
        assert!(!name.is_empty(), "a stray < before {:?}", &tag[..tag.len().min(40)]);
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "unbalanced");
        } else if !void.contains(&name.as_str()) && !tag.ends_with('/') {
            open.push(name.clone());
            // The text of a style is not markup.
            if name == "style" {
                rest = &rest[rest.find("</style>").unwrap()..];
            }
        }
        seen.push(name);
    }
    assert!(open.is_empty(), "never closed: {open:?}");
    seen
}

/// The `>` that ends a tag, outside of quotes.
fn end_of_tag(rest: &str) -> usize {
    let mut quoted = false;
    for (i, c) in rest.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '>' if !quoted => return i,
            _ => {}
        }
    }
    panic!("a tag without an end: {:?}", rest.chars().take(60).collect::<String>());
}

fn harmless(p: &Passport) {
    let bad = |c: char| {
        (c.is_control() && c != '\n')
            || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let page = html(p);
    let text = summary(p);
    assert!(!text.contains(bad), "{text:?}");
    assert!(!page.contains(bad) && !page.contains("<script") && !page.contains("NaN"));
    let allowed_svg = [
        "svg", "title", "desc", "style", "rect", "g", "line", "path", "polyline", "circle",
        "polygon", "text", "tspan", "clipPath", "defs", "use",
    ];
    let names = elements(&page, &["meta", "link", "br", "hr", "img", "wbr", "col"]);
    assert!(names.iter().all(|n| n != "script" && n != "iframe" && n != "object"));
    for figure in figures(p) {
        assert!(
            !figure.svg.contains(bad)
                && !figure.svg.contains("NaN")
                && !figure.svg.contains("inf\"")
        );
        for name in elements(&figure.svg, &[]) {
            assert!(allowed_svg.contains(&name.as_str()), "{}: <{name}>", figure.name);
        }
    }
    // No handler can come from text: every attribute is one of ours.
    assert!(
        !page.contains(" onload=") || page.contains("&lt;svg onload="),
        "a handler in the page"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn hostile_text_stays_text(text in hostile(), verdict in 0..3usize) {
        let mut value = passport();
        poisoned(&mut value, "", &text);
        value["verdict"] = ["accepted", "rejected", "indeterminate"][verdict].into();
        if verdict == 1 {
            value.as_object_mut().unwrap().remove("result");
            value.as_object_mut().unwrap().remove("compensation");
        }
        harmless(&serde_json::from_value(value).unwrap());
    }
}

#[test]
fn a_healthy_passport_passes_the_same_checks_and_a_raw_tag_would_not() {
    harmless(&serde_json::from_value(passport()).unwrap());
    assert!(std::panic::catch_unwind(|| elements("<p>a < b</p>", &[])).is_err());
    assert!(std::panic::catch_unwind(|| elements("<p><b></p>", &[])).is_err());
}

#[test]
fn a_rejected_passport_shows_no_coefficients_anywhere() {
    let mut value = passport();
    value["verdict"] = "rejected".into();
    // Even a forged passport that still carries them.
    let p: Passport = serde_json::from_value(value).unwrap();
    let scale = format!("{:.5}", p.compensation.as_ref().unwrap().scale_factor * 1e3);
    let (page, text) = (html(&p), summary(&p));
    assert!(text.starts_with("REJECTED"));
    for shown in [&page, &text] {
        assert!(
            !shown.contains("How to apply it") && !shown.contains(&scale[..6]),
            "coefficients on a rejected page"
        );
    }
    assert!(figures(&p).iter().all(|f| f.name == "residuals"));
}
