//! The checklist of the operator: one page a run, A4, a row a dwell, legible at arm's length.

use maud::{DOCTYPE, Markup, html};
use tumble_io::{PlanDocument, PlannedPosition};

use super::{clock, degrees, duration};
use crate::html::head;
use crate::numbers::typographic;
use crate::sanitize::clean_text;

const SHEET: &str = r#"
@page{size:A4;margin:12mm 14mm}
*{box-sizing:border-box}
html{background:#fff;color:#000}
body{max-width:182mm;margin:0 auto;padding:4mm;font:11pt/1.35 system-ui,"Segoe UI","Helvetica Neue",Arial,sans-serif}
h1{font-size:16pt;margin:0}
h2{font-size:13pt;margin:0 0 2mm}
p{margin:1.5mm 0}
ol{margin:1mm 0;padding-left:6mm}
.run{break-before:page}
.head{display:flex;justify-content:space-between;align-items:baseline;border-bottom:.6mm solid #000;padding-bottom:1.5mm}
.fields{display:grid;grid-template-columns:repeat(3,1fr);gap:3mm 6mm;margin:3mm 0}
.fields span{border-bottom:.25mm solid #000;min-height:7mm;font-size:9pt;color:#333}
table{border-collapse:collapse;width:100%}
thead{display:table-header-group}
tr{break-inside:avoid}
th.w{text-align:left}
th{font-size:9pt;text-align:left;font-weight:600;border-bottom:.4mm solid #000;padding:1mm 2mm}
td{border-bottom:.2mm solid #999;padding:.5mm 2mm;vertical-align:middle;height:7.6mm}
.n,.t{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums;color:#333;width:14mm}
.a{text-align:right;font-size:17pt;font-weight:700;font-variant-numeric:tabular-nums;width:34mm;white-space:nowrap;line-height:1}
th.again{font-weight:400;color:#333;border:0;padding:0 2mm}
th.a{font-size:9pt;font-weight:600}
.box{width:10mm}.box i{display:block;width:5.5mm;height:5.5mm;border:.5mm solid #000}
.do{font-size:9.5pt}
.act td{background:#eee;font-weight:600;-webkit-print-color-adjust:exact;print-color-adjust:exact}
.w{width:38mm}
.small{font-size:9pt;color:#333}
@media print{body{padding:0;max-width:none}}
"#;

/// The checklist of a plan as one self-contained page to print.
///
/// No script and nothing from outside. Every dwell is a row with a box to tick, its angle in large type, when to be there, and
/// what to do before it; every run starts on a sheet of its own.
#[must_use]
pub fn plan_checklist(d: &PlanDocument) -> String {
    let sensor = clean_text(&d.sensor);
    let title =
        if sensor.is_empty() { "Checklist".to_owned() } else { format!("Checklist – {sensor}") };
    html! {
        (DOCTYPE)
        html lang="en" {
            // For paper: black on white.
            (head(&title, "light", SHEET))
            body {
                (front(d, &sensor))
                @for run in 1..=d.runs { (sheet(d, &sensor, run)) }
            }
        }
    }
    .into_string()
}

/// What to do, once.
fn front(d: &PlanDocument, sensor: &str) -> Markup {
    html! {
        section {
            div .head { h1 { "How to measure" } span { (sensor) } }
            p {
                (d.runs) " runs of " (d.positions.len()) " dwells, " (duration(d.total_s)) " in all. Each run: one power-up, one mounting."
            }
            ol {
                li { "Mount the sensor, power it up, and wait " (duration(d.restart_s)) "." }
                @if d.updown {
                    li { "Stand the body upright: axis up for the first dwell, axis down for the second. Then fix it on the table and do not touch its seat again in this run." }
                }
                li { "Set the angle of the row on the dial. Always come to it from the same side." }
                li { "Wait " (duration(d.settle_s)) " without touching the table." }
                li { "Read for " (duration(d.dwell_s)) ". Write down the angle that the dial shows if it is another one. Tick the box." }
                li { "Keep to the order: it keeps drift out of the result. A dwell that went wrong is repeated at once and noted." }
                li { "After the last row, power the sensor down. The next run starts with a new power-up." }
                @if d.remounting {
                    li { b { "For every second run turn the body by 180° on the platform" } ": orientation = \"reversed\" in experiment.toml." }
                }
            }
            p .small {
                "Rows marked “test” are there to find out whether the sensor is straight: they matter as much as all others. "
                "Times count from power-up; being late is no harm, being early is."
            }
        }
    }
}

fn sheet(d: &PlanDocument, sensor: &str, run: u32) -> Markup {
    let turned = d.remounting && run.is_multiple_of(2);
    html! {
        section .run {
            div .head {
                h2 { "Run " (run) " of " (d.runs) @if turned { " – body turned by 180°" } }
                span { (sensor) }
            }
            div .fields {
                span { "Date, start" } span { "Operator" } span { "Serial number" }
                span { "Temperature at start" } span { "Temperature at end" } span { "File" }
            }
            table {
                // Repeated at the top of a second sheet, which would else belong to no run.
                thead { tr { th .again colspan="6" { "Run " (run) " of " (d.runs) @if !sensor.is_empty() { " · " (sensor) } } } tr {
                    th .box {} th .n { "No." } th .a { "Angle" } th .t { "Read at" } th { "Before" } th .w { "Note" }
                } }
                tbody {
                    tr .act { td colspan="6" { "Power up, wait " (duration(d.restart_s)) "." } }
                    @for (i, p) in d.positions.iter().enumerate() {
                        @if i > 0 && d.positions[i - 1].upright && !p.upright {
                            tr .act { td colspan="6" { "Fix the body on the table. Do not touch its seat again in this run." } }
                        }
                        (dwell(d, p))
                    }
                    tr .act { td colspan="6" { "Power down." } }
                }
            }
        }
    }
}

fn dwell(d: &PlanDocument, p: &PlannedPosition) -> Markup {
    let wait = duration(d.settle_s);
    html! {
        tr {
            td .box { i {} }
            td .n { (p.number) }
            td .a {
                @if p.upright { @if p.angle_deg > 0.0 { "axis UP" } @else { "axis DOWN" } }
                @else { (signed(p.angle_deg)) "°" }
            }
            td .t { (clock(p.start_s)) }
            td .do {
                @if p.upright { "stand upright, wait " (wait) }
                @else if p.set_anew { "turn away and set it anew, wait " (wait) }
                @else { "set, wait " (wait) }
                @if p.spare { " · test" }
            }
            td .w {}
        }
    }
}

/// With its sign, so that nobody turns the wrong way.
fn signed(deg: f64) -> String {
    let text = degrees(deg);
    typographic(&if deg > 0.0 { format!("+{text}") } else { text })
}
