//! The style that every figure carries, for light and dark ground.

use std::fmt::Write as _;

/// Series colours on light and on dark ground: the hues of Okabe and Ito, darkened or lightened until each has a
/// contrast of 3 : 1 or more with its ground.
const SERIES: [(&str, &str); 6] = [
    ("#0072b2", "#56b4e9"),
    ("#c24e00", "#e8803c"),
    ("#00805c", "#2fc49a"),
    ("#a8477f", "#dc9cc0"),
    ("#8f6a00", "#e6b422"),
    ("#4d4d4d", "#c8c8c8"),
];

/// Number of colours before they repeat (with another marker).
pub(super) const COLOURS: usize = SERIES.len();

/// Shapes and text, the same on any ground.
const FIXED: [(&str, &str); 14] = [
    ("text", "font:11px system-ui,-apple-system,'Segoe UI','Helvetica Neue',Arial,sans-serif"),
    (".name", "font-size:12px"),
    (".panel", "font-size:12.5px;font-weight:600"),
    (".middle", "text-anchor:middle"),
    (".end", "text-anchor:end"),
    (".line", "fill:none;stroke:currentColor;stroke-width:1.4;stroke-linejoin:round"),
    (".bar", "fill:none;stroke:currentColor;stroke-width:1.8"),
    (".dot", "fill:currentColor;stroke-width:.7"),
    (".solid", "fill:currentColor"),
    (".band", "fill:currentColor;fill-opacity:.15;stroke:none"),
    (".edge", "fill:none;stroke:currentColor;stroke-width:1;stroke-dasharray:4 3"),
    (".axis,.zero", "fill:none;stroke-width:1"),
    (".grid", "fill:none;stroke-width:.6"),
    (".dashed", "stroke-dasharray:5 3"),
];

/// Colours of one ground.
struct Ground {
    paper: &'static str,
    ink: &'static str,
    muted: &'static str,
    grid: &'static str,
    series: [&'static str; COLOURS],
}

/// Rules of one figure. Every selector begins with the figure's own class, because a style inside an inlined SVG
/// holds for the whole page. No variables: plain SVG renderers do not know them. On paper always light.
pub(super) fn style(scope: &str) -> String {
    let light = Ground {
        paper: "#ffffff",
        ink: "#1b1f23",
        muted: "#4a525a",
        grid: "#dfe3e6",
        series: SERIES.map(|pair| pair.0),
    };
    let dark = Ground {
        paper: "#15191d",
        ink: "#e8eaed",
        muted: "#aab4bd",
        grid: "#2d343b",
        series: SERIES.map(|pair| pair.1),
    };
    let mut out = String::new();
    for (selectors, body) in FIXED {
        rule(&mut out, scope, selectors, body);
    }
    colours(&mut out, scope, &light);
    out.push_str("@media screen and (prefers-color-scheme:dark){");
    colours(&mut out, scope, &dark);
    out.push('}');
    out
}

fn colours(out: &mut String, scope: &str, ground: &Ground) {
    let Ground { paper, ink, muted, grid, series } = ground;
    rule(out, scope, ".ground", &format!("fill:{paper}"));
    rule(out, scope, ".dot", &format!("stroke:{paper}"));
    rule(out, scope, "text", &format!("fill:{ink}"));
    rule(out, scope, ".tick,.quiet", &format!("fill:{muted}"));
    rule(out, scope, ".axis", &format!("stroke:{muted}"));
    rule(out, scope, ".zero", &format!("stroke:{ink}"));
    rule(out, scope, ".grid", &format!("stroke:{grid}"));
    rule(out, scope, ".ink", &format!("color:{ink}"));
    for (i, colour) in series.iter().enumerate() {
        rule(out, scope, &format!(".s{i}"), &format!("color:{colour}"));
    }
}

fn rule(out: &mut String, scope: &str, selectors: &str, body: &str) {
    let scoped: Vec<String> = selectors.split(',').map(|s| format!(".{scope} {s}")).collect();
    // Writing into a String cannot fail.
    let _ = write!(out, "{}{{{body}}}", scoped.join(","));
}
