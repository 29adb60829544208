//! Passports to render, made by the pipeline itself, and a strict reader of markup.

#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.
#![allow(dead_code)] // Each test file uses its part.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde_json::Value;
use tumble_core::simulate::{Preset, Truth};
use tumble_io::{CertifyOptions, Existing, SimulationOptions, certify, write_simulation};
use tumble_report::Passport;

fn simulated(name: &str, truth: &Truth, change: impl Fn(&str) -> String) -> Passport {
    let folder =
        PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
    let options = SimulationOptions {
        model: "ADXL203".into(),
        serial: "3".into(),
        gzip: false,
        averaged: true,
        stated_angle_uncertainty_arcmin: 0.55,
        scale_pair: false,
        existing: Existing::Replace,
    };
    write_simulation(truth, &options, &folder, &|| false).unwrap();
    let file = folder.join("experiment.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, change(&text)).unwrap();
    let passport = certify(&folder, &CertifyOptions::default()).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    passport
}

/// Five runs in one mounting: accepted.
pub fn accepted() -> Passport {
    // Tests of one file run at the same time and would write the same folder.
    static ONCE: LazyLock<Passport> =
        LazyLock::new(|| simulated("accepted", &Preset::Paper3.truth(), str::to_owned));
    ONCE.clone()
}

/// Five runs, three in one mounting and two in another.
pub fn two_mountings() -> Passport {
    simulated("mountings", &Preset::Paper2.truth(), |text| {
        let (first, second) = text.split_at(text.match_indices("[[run]]").nth(3).unwrap().0);
        format!("{first}{}", second.replace("mounting = \"A\"", "mounting = \"B\""))
    })
}

/// A nonlinearity that the model does not have: rejected.
pub fn rejected() -> Passport {
    let angles_deg = (-13..=13).map(|i| 5.0 * f64::from(i)).collect();
    let truth = Truth { k3_per_m2_s4: 3e-5, angles_deg, ..Preset::Paper3.truth() };
    simulated("rejected", &truth, str::to_owned)
}

/// One run: indeterminate, with a result.
pub fn one_run() -> Passport {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/reference/full-range-unit1");
    certify(&folder, &CertifyOptions::default()).unwrap()
}

/// Nothing measured: indeterminate, without a result.
pub fn least() -> Passport {
    Passport::from_json(include_str!("../data/least.json")).unwrap()
}

/// Limits of everything: a bias that fails, a misalignment with one side open, a rule that answers with conditions.
pub fn held_against_limits() -> Passport {
    const SPEC: &str = "[spec]\nspecification = \"data sheet\"\nbias_limits_mg = [500, 600]\n\
                misalignment_limits_arcmin = [-inf, 60]\nscale_error_limits_percent = 50\n\
                scale_factor_limits = [0.001, 0.1]\ndecision_rule = \"non-binary\"\n\
                prior_scale_error = [0.0, 0.2]\n";
    static ONCE: LazyLock<Passport> = LazyLock::new(|| {
        simulated("limits", &Preset::Paper3.truth(), |text| format!("{text}\n{SPEC}"))
    });
    ONCE.clone()
}

/// One of each kind.
pub fn all() -> Vec<Passport> {
    vec![accepted(), two_mountings(), rejected(), one_run(), least(), held_against_limits()]
}

/// Changes every leaf of a passport; `path` is the name of the nearest field.
pub fn changed(passport: &Passport, change: &mut impl FnMut(&str, &mut Value)) -> Passport {
    fn walk(field: &str, tree: &mut Value, change: &mut impl FnMut(&str, &mut Value)) {
        match tree {
            Value::Array(items) => items.iter_mut().for_each(|i| walk(field, i, change)),
            Value::Object(fields) => fields.iter_mut().for_each(|(k, v)| walk(k, v, change)),
            leaf => change(field, leaf),
        }
    }
    let mut tree = serde_json::to_value(passport).unwrap();
    walk("", &mut tree, change);
    serde_json::from_value(tree).unwrap()
}

/// Elements that the renderers use; anything else would come from a text.
const ELEMENTS: &[&str] = &[
    "svg",
    "title",
    "desc",
    "style",
    "rect",
    "line",
    "path",
    "text",
    "g",
    "clipPath",
    "html",
    "head",
    "meta",
    "body",
    "header",
    "main",
    "section",
    "h1",
    "h2",
    "h3",
    "p",
    "b",
    "br",
    "dl",
    "dt",
    "dd",
    "div",
    "span",
    "ul",
    "li",
    "table",
    "caption",
    "thead",
    "tbody",
    "tr",
    "th",
    "td",
    "figure",
    "figcaption",
    "code",
];

/// Elements without an end in HTML.
const VOID: &[&str] = &["meta", "br"];

/// Checks that the text is one well-formed document: balanced known elements, quoted attributes without handlers,
/// entities, no control characters. XML, or HTML with its doctype and void elements.
pub fn check_markup(text: &str) -> Result<(), String> {
    if let Some(c) = text.chars().find(|c| c.is_control() && *c != '\n') {
        return Err(format!("control character {c:?}"));
    }
    let is_html = text.starts_with("<!DOCTYPE html>");
    let mut rest = text.strip_prefix("<!DOCTYPE html>").unwrap_or(text);
    let mut open: Vec<&str> = Vec::new();
    let mut documents = 0;
    while !rest.is_empty() {
        let Some(at) = rest.find('<') else {
            check_entities(rest)?;
            if !rest.trim().is_empty() {
                return Err(format!("text behind the end: {rest:.60}"));
            }
            break;
        };
        // A style sheet is raw text in HTML: it must not need escaping in either reading.
        check_entities(&rest[..at])?;
        let end = rest[at..].find('>').ok_or("a tag without end")? + at;
        let tag = &rest[at + 1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name) {
                return Err(format!("</{name}> closes nothing"));
            }
            continue;
        }
        let (name, attributes) = tag.split_once([' ', '\n']).unwrap_or((tag, ""));
        if !ELEMENTS.contains(&name) {
            return Err(format!("<{name:.40}> is not ours"));
        }
        check_attributes(attributes)?;
        documents += usize::from(open.is_empty());
        if !(is_html && VOID.contains(&name)) {
            open.push(name);
        }
    }
    match (open.is_empty(), documents) {
        (true, 1) => Ok(()),
        _ => Err(format!("{documents} roots, left open: {open:?}")),
    }
}

fn check_entities(text: &str) -> Result<(), String> {
    for (at, _) in text.match_indices('&') {
        let tail = &text[at..];
        if !["&amp;", "&lt;", "&gt;", "&quot;"].iter().any(|e| tail.starts_with(e)) {
            return Err(format!("a bare ampersand: {tail:.20}"));
        }
    }
    if text.contains('>') && !text.contains('{') {
        return Err(format!("a bare >: {text:.60}"));
    }
    Ok(())
}

fn check_attributes(mut text: &str) -> Result<(), String> {
    while !text.trim_start().is_empty() {
        let (name, tail) =
            text.trim_start().split_once("=\"").ok_or(format!("attributes: {text:.60}"))?;
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || "-:".contains(c))
            || name.starts_with("on")
        {
            return Err(format!("attribute {name:.40}"));
        }
        let (value, after) = tail.split_once('"').ok_or("an attribute without end")?;
        check_entities(value)?;
        if value.contains("javascript:") || (value.contains("//") && name != "xmlns") {
            return Err(format!("{name} leads outside: {value:.60}"));
        }
        text = after;
    }
    Ok(())
}
