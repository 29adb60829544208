//! The style that every figure carries, for light and dark ground.

use std::fmt::Write as _;

/// Series colours on light and on dark ground: the hues of Okabe and Ito, darkened or lightened until each has a
/// contrast of 3 : 1 or more with its ground.
const SERIES: [(&str, &str); 6] = [
    ("#0072b2", "#56b4e9"),
    ("#b03a00", "#e8803c"),
    ("#00805c", "#2fc49a"),
    ("#a8477f", "#dc9cc0"),
    ("#b08400", "#e6b422"),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Smallest difference (CIE 1976 ΔE*ab) of two series for any reader. 2.3 is just noticeable side by side.
    const SMALLEST_DIFFERENCE: f64 = 9.0;

    /// Linear RGB as seen with full protan, deutan and tritan deficiency (Machado, Oliveira, Fernandes 2009).
    const VISIONS: [(&str, [[f64; 3]; 3]); 4] = [
        ("all cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "protan",
            [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
        ),
        (
            "deutan",
            [
                [0.367_322, 0.860_646, -0.227_968],
                [0.280_085, 0.672_501, 0.047_413],
                [-0.011_820, 0.042_940, 0.968_881],
            ],
        ),
        (
            "tritan",
            [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
        ),
    ];

    fn times(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
        m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
    }

    fn linear(hex: &str) -> [f64; 3] {
        [1, 3, 5].map(|i| {
            let c = f64::from(u8::from_str_radix(&hex[i..i + 2], 16).unwrap()) / 255.0;
            if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        })
    }

    fn lab(rgb: [f64; 3]) -> [f64; 3] {
        let to_xyz =
            [[0.412_4, 0.357_6, 0.180_5], [0.212_6, 0.715_2, 0.072_2], [0.019_3, 0.119_2, 0.950_5]];
        let xyz = times(&to_xyz, rgb.map(|c| c.clamp(0.0, 1.0)));
        let f = |v: f64, white: f64| {
            let t = v / white;
            if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 }
        };
        let [x, y, z] = [f(xyz[0], 0.950_5), f(xyz[1], 1.0), f(xyz[2], 1.089)];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// Colour is never alone (runs have markers, bars a fixed order and their numbers), and still no two series
    /// look alike to readers who miss a kind of cone.
    #[test]
    fn series_differ_for_every_kind_of_colour_vision() {
        for ground in [SERIES.map(|s| s.0), SERIES.map(|s| s.1)] {
            for (vision, matrix) in VISIONS {
                let seen = ground.map(|hex| lab(times(&matrix, linear(hex))));
                for i in 0..COLOURS {
                    for j in 0..i {
                        let d =
                            (0..3).map(|k| (seen[i][k] - seen[j][k]).powi(2)).sum::<f64>().sqrt();
                        assert!(
                            d > SMALLEST_DIFFERENCE,
                            "{vision}: {} and {}: {d:.1}",
                            ground[i],
                            ground[j]
                        );
                    }
                }
            }
        }
    }
}
