//! The page's style sheet.

use std::fmt::Write as _;

use crate::standing::Standing;

/// Screen and paper.
const SHEET: &str = r#"
:root{--paper:#fff;--ink:#1b1f23;--muted:#4a525a;--rule:#c9cfd4;--soft:#f3f5f6;--link:#0072b2;
--good:#00694a;--bad:#a81e1e;--open:#8a5300;--good-soft:#e7f4ef;--bad-soft:#fbeaea;--open-soft:#fcf3e2}
@media screen and (prefers-color-scheme:dark){:root{--paper:#15191d;--ink:#e8eaed;--muted:#aab4bd;--rule:#3b444d;
--soft:#1d2328;--link:#56b4e9;--good:#4fd1a5;--bad:#ff8f8a;--open:#efb649;--good-soft:#12291f;--bad-soft:#331919;
--open-soft:#2e2410}}
*{box-sizing:border-box}
html{background:var(--paper);color:var(--ink);-webkit-text-size-adjust:100%}
body{max-width:60rem;margin:0 auto;padding:1.5rem 1.25rem 3rem;
font:15px/1.5 system-ui,-apple-system,"Segoe UI","Helvetica Neue",Arial,sans-serif;overflow-wrap:anywhere}
h1{font-size:1.75rem;line-height:1.2;margin:0}
h2{font-size:1.15rem;line-height:1.3;margin:2.2rem 0 .6rem;padding-top:.5rem;border-top:1px solid var(--rule)}
h3{font-size:1rem;margin:1.2rem 0 .4rem}
p{margin:.5rem 0;max-width:48rem}
.lead{color:var(--muted);margin:.2rem 0 1.2rem}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1.25rem;margin:.5rem 0}
dt{color:var(--muted)}dd{margin:0}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:0 2.5rem;align-items:start}
.banner{border:2px solid currentColor;padding:.8rem 1.1rem;margin:1.4rem 0}
.banner>*{color:var(--ink)}
.banner .verdict{font-size:1.25rem;font-weight:700;color:inherit;margin:0;max-width:none}
.banner .loud{font-size:2.1rem;line-height:1.15;font-weight:800;color:inherit;margin:.5rem 0;max-width:none}
.banner>:last-child{margin-bottom:0}
.banner h3{margin:.8rem 0 .2rem}.banner ul{margin:.2rem 0;padding-left:1.2rem}.banner li{margin:.35rem 0}
.accepted{color:var(--good);background:var(--good-soft)}
.rejected{color:var(--bad);background:var(--bad-soft)}
.open{color:var(--open);background:var(--open-soft)}
.scroll{overflow-x:auto;margin:.6rem 0}
table{border-collapse:collapse;width:100%;font-size:.88rem;line-height:1.4}
caption{text-align:left;color:var(--muted);padding:0 0 .35rem;font-size:.88rem}
th,td{padding:.28rem .8rem .28rem 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
th:last-child,td:last-child{padding-right:0}
thead th{border-bottom:1.5px solid var(--muted);vertical-align:bottom;font-weight:600;overflow-wrap:normal}
tbody th{font-weight:600;white-space:nowrap}
.files th{white-space:normal}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.q{white-space:nowrap}
.n+.q,.n+td{padding-left:.5rem}
.fixed{table-layout:fixed;min-width:44rem}
.c-id{width:8%}.c-severity{width:10%}.c-finding{width:20%}.c-observed{width:22%}.c-limit{width:15%}.c-todo{width:25%}
.main td,.main th{font-size:1rem}
.main .value{font-weight:700}
.narrow{width:auto;min-width:24rem}
.formula{font-size:1.1rem;margin:.7rem 0;padding:.6rem .9rem;background:var(--soft);border-left:3px solid var(--muted);
max-width:none}
.formula span{display:block}
code,.digest{font-family:ui-monospace,"SFMono-Regular",Menlo,Consolas,"DejaVu Sans Mono",monospace;font-size:.86em}
.digest{word-break:break-all}
figure{margin:1.4rem 0}
figure svg{display:block;width:100%;height:auto;max-width:760px}
figcaption{font-size:.88rem;color:var(--muted);max-width:48rem;margin-top:.4rem}
figcaption b{color:var(--ink)}
.sev{font-weight:700;white-space:nowrap}
.reject{color:var(--bad)}.missing,.warning{color:var(--open)}.note{color:var(--muted)}
.small{font-size:.88rem;color:var(--muted)}
@media (max-width:44rem){.pair{grid-template-columns:1fr}.banner .loud{font-size:1.6rem}}
@media print{
html{-webkit-print-color-adjust:exact;print-color-adjust:exact}
body{max-width:none;padding:0;font-size:9.5pt;line-height:1.4}
h1{font-size:17pt}h2{font-size:11.5pt;margin:14pt 0 4pt;padding-top:4pt}h3{font-size:10pt}
.banner .verdict{font-size:12pt}.banner .loud{font-size:20pt}
table{font-size:8.2pt}.main td,.main th{font-size:8.8pt}
th,td{padding:2pt 6pt 2pt 0}
.scroll{overflow:visible}
.digest{font-size:7pt}
h2,h3{break-after:avoid}
figure,.banner,.formula,dl,tr,.whole{break-inside:avoid}
figure svg{max-width:138mm;max-height:150mm}
figure{margin:8pt 0}
.fixed{min-width:0}
figcaption,.small,caption{font-size:8.2pt}
thead{display:table-header-group}
p{orphans:3;widows:3}
}
"#;

/// The style sheet, with sensor and number in the margins of every printed page.
pub(super) fn style(standing: Standing, subject: &str, id: &str) -> String {
    let mut margin =
        String::from(if standing.has_coefficients() { "Calibration passport" } else { "Report" });
    for part in [subject, id] {
        if !part.is_empty() {
            margin.push_str(" · ");
            margin.push_str(part);
        }
    }
    format!(
        "{SHEET}@page{{size:A4;margin:16mm 15mm 18mm;\
         @bottom-left{{content:\"{}\";font:7.5pt sans-serif;color:#4a525a;width:80%;vertical-align:top;padding-top:3mm}}\
         @bottom-right{{content:\"page \" counter(page) \" of \" counter(pages);font:7.5pt sans-serif;color:#4a525a;\
         vertical-align:top;padding-top:3mm}}}}",
        css_string(&margin)
    )
}

/// Text for a CSS string: everything but plain letters and digits as an escape, so that no text can end the string
/// or the style element.
fn css_string(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        if c.is_ascii_alphanumeric() || c == ' ' {
            out.push(c);
        } else {
            // Writing into a String cannot fail.
            let _ = write!(out, "\\{:x} ", u32::from(c));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::css_string;

    #[test]
    fn nothing_ends_the_string() {
        assert_eq!(css_string("a\"</style>"), "a\\22 \\3c \\2f style\\3e ");
    }
}
