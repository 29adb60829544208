//! Passports of every kind, whatever their texts and numbers are: every renderer stays well-formed and finite.

mod common;

use std::sync::LazyLock;

use proptest::prelude::*;
use serde_json::{Number, Value};
use tumble_report::{Passport, figures, html, summary};

static PASSPORTS: LazyLock<Vec<Passport>> = LazyLock::new(common::all);

/// Fields whose texts steer the rendering: half of the cases keep them, so that all sections are reached.
const STEERING: &[&str] =
    &["schema", "verdict", "severity", "quantizer_offset", "mounting", "name", "between", "unit"];

fn hostile() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("</script><script>alert(1)</script>".to_owned()),
        Just("\"><svg onload=alert(1)>".to_owned()),
        Just("</style></title></desc><img src=x onerror=alert(1)>".to_owned()),
        Just("\u{1b}[2J\u{1b}]0;title\u{7}".to_owned()),
        Just("=cmd|' /C calc'!A0".to_owned()),
        Just("a & b < c > d \" e ' f &amp; &#x41;".to_owned()),
        Just("\u{202e}fdp.exe\u{2066}x\u{2069}".to_owned()),
        Just("nul\0 bell\u{7} del\u{7f} c1\u{9b}2J".to_owned()),
        Just("line\nline\r\nACCEPTED".to_owned()),
        Just("]]><!-- --><?php \u{ffff}\u{fffe}".to_owned()),
        Just("* { display: none } @import url(http://x/) \\".to_owned()),
        Just("x".repeat(5000)),
        Just("加速度計".repeat(200)),
        Just(String::new()),
        ".{0,80}",
        proptest::collection::vec(any::<char>(), 0..40).prop_map(String::from_iter),
    ]
}

fn awkward_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(-0.0),
        Just(f64::MAX),
        Just(f64::MIN),
        Just(f64::MIN_POSITIVE),
        Just(5e-324),
        Just(1e200),
        Just(-1e16),
        -1.0..1.0f64,
        any::<f64>().prop_filter("JSON has no others", |v| v.is_finite()),
    ]
}

fn check_all(passport: &Passport) -> Result<(), String> {
    let page = html(passport);
    common::check_markup(&page).map_err(|e| format!("html: {e}"))?;
    if page.contains("<script") || page.contains("http-equiv=\"refresh\"") {
        return Err("html: script or refresh".into());
    }
    for f in figures(passport) {
        common::check_markup(&f.svg).map_err(|e| format!("{}: {e}", f.name))?;
        let body = f.svg.split("</style>").nth(1).unwrap_or_default();
        let geometry = body.split('<').filter(|t| !t.starts_with("text"));
        for tag in geometry {
            let tag = tag.split('>').next().unwrap_or_default();
            if tag.contains("NaN")
                || tag.contains("inf\"")
                || tag.contains("inf ")
                || tag.contains('–')
            {
                return Err(format!("{}: {tag}", f.name));
            }
        }
    }
    let text = summary(passport);
    if let Some(c) = text.chars().find(|c| c.is_control() && *c != '\n') {
        return Err(format!("summary: {c:?}"));
    }
    if text.contains(['\u{202e}', '\u{2066}', '\u{2069}']) {
        return Err("summary: bidirectional override".into());
    }
    Ok(())
}

#[test]
fn our_own_passports_pass() {
    for p in PASSPORTS.iter() {
        check_all(p).unwrap();
    }
}

#[test]
fn the_reader_of_markup_is_strict() {
    for bad in [
        "<svg><p></svg>",
        "<svg>a & b</svg>",
        "<svg><script></script></svg>",
        "<svg onload=\"x\"></svg>",
        "<svg class=x></svg>",
        "<svg></svg><svg></svg>",
        "<svg>\u{1b}</svg>",
        "<svg class=\"http://elsewhere\"></svg>",
    ] {
        assert!(common::check_markup(bad).is_err(), "{bad}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn one_text_everywhere(which in 0..6usize, text in hostile(), keep in any::<bool>()) {
        let passport = common::changed(&PASSPORTS[which], &mut |field, leaf| {
            if leaf.is_string() && !(keep && STEERING.contains(&field)) {
                *leaf = Value::String(text.clone());
            }
        });
        prop_assert_eq!(check_all(&passport), Ok(()));
    }

    #[test]
    fn a_text_of_its_own_in_every_field(
        which in 0..6usize,
        texts in proptest::collection::vec(hostile(), 24),
        keep in any::<bool>(),
    ) {
        let mut next = texts.iter().cycle();
        let passport = common::changed(&PASSPORTS[which], &mut |field, leaf| {
            if leaf.is_string() && !(keep && STEERING.contains(&field)) {
                *leaf = Value::String(next.next().cloned().unwrap_or_default());
            }
        });
        prop_assert_eq!(check_all(&passport), Ok(()));
    }

    #[test]
    fn awkward_numbers(
        which in 0..6usize,
        numbers in proptest::collection::vec(awkward_number(), 37),
        every in 1..40usize,
    ) {
        let (mut next, mut count) = (numbers.iter().cycle(), 0);
        let passport = common::changed(&PASSPORTS[which], &mut |_, leaf| {
            if leaf.is_f64() {
                count += 1;
                if count % every == 0 {
                    *leaf = Number::from_f64(*next.next().unwrap_or(&0.0)).map_or(Value::Null, Value::Number);
                }
            }
        });
        prop_assert_eq!(check_all(&passport), Ok(()));
    }
}
