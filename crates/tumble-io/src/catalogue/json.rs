//! The catalogue as JSON, for programs.

use serde_json::{Value, json};
use tumble_core::{SensorMode, TypeLimit};

use super::{Catalogue, CatalogueEntry, Converter};

impl Catalogue {
    /// All entries, indented, with a final newline.
    #[must_use]
    pub fn to_json(&self) -> String {
        let sensors: Vec<Value> = self.sensors.iter().map(sensor).collect();
        let converters: Vec<Value> = self.converters.iter().map(converter).collect();
        text(&json!({"sensors": sensors, "converters": converters}))
    }
}

impl CatalogueEntry {
    /// The entry, indented, with a final newline.
    #[must_use]
    pub fn to_json(&self) -> String {
        text(&sensor(self))
    }
}

impl Converter {
    /// The entry, indented, with a final newline.
    #[must_use]
    pub fn to_json(&self) -> String {
        text(&converter(self))
    }
}

fn text(value: &Value) -> String {
    format!("{value:#}\n")
}

fn sensor(e: &CatalogueEntry) -> Value {
    let t = &e.sensor_type;
    json!({
        "model": t.model,
        "aliases": e.aliases,
        "maker": e.maker,
        "source": t.source,
        "catalogue": t.catalogue,
        "note": e.note,
        "ratiometric": t.ratiometric,
        "modes": t.modes.iter().map(mode).collect::<Vec<_>>(),
        "limits": t.limits.iter().map(limit).collect::<Vec<_>>(),
    })
}

fn mode(m: &SensorMode) -> Value {
    json!({
        "name": m.name,
        "range_g": m.range_gn,
        "sensitivity": m.sensitivity,
        "unit": m.unit.name(),
        "mark": m.mark.name(),
        "tolerance": m.tolerance.map(|(t, _)| t),
        "tolerance_mark": m.tolerance.map(|(_, mark)| mark.name()),
        "nominal_scale_m_s2_per_lsb": m.nominal_scale_m_s2_per_lsb(),
    })
}

fn limit(l: &TypeLimit) -> Value {
    json!({
        "of": l.of.name(),
        "unit": l.of.unit(),
        "axes": l.axes,
        "mode": l.mode,
        "typical": l.typical,
        "maximum": l.maximum,
        "mark": l.mark.name(),
        "note": l.note,
    })
}

fn converter(c: &Converter) -> Value {
    let modes: Vec<Value> = c
        .modes
        .iter()
        .map(|m| {
            json!({
                "rate_hz": m.rate_hz,
                "bits": m.bits,
                "min_code": m.min_code,
                "max_code": m.max_code,
                "mark": m.mark.name(),
                "volt_per_lsb": m.volt_per_lsb(c, 1.0),
            })
        })
        .collect();
    json!({
        "model": c.model,
        "aliases": c.aliases,
        "maker": c.maker,
        "source": c.source,
        "catalogue": c.catalogue,
        "note": c.note,
        "reference_v": c.reference_v,
        "ratiometric": c.ratiometric,
        "mark": c.mark.name(),
        "gains": c.gains,
        "modes": modes,
    })
}
