//! `catalogue.toml`: its keys, and nothing but its keys; every number checked, every refusal with its place.

use serde::Deserialize;
use toml::Spanned;
use tumble_core::{LimitOf, Mark, SensitivityUnit, SensorMode, SensorType, TypeLimit};

use super::{Catalogue, CatalogueEntry, Converter, ConverterMode, normalized};
use crate::error::{Problem, ReadError};
use crate::toml_text::{from_toml, place, without_mark};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CatalogueFile {
    format: Option<Spanned<u32>>,
    #[serde(default)]
    sensor: Vec<SensorTable>,
    #[serde(default)]
    converter: Vec<ConverterTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SensorTable {
    model: Spanned<String>,
    #[serde(default)]
    aliases: Vec<Spanned<String>>,
    #[serde(default)]
    maker: String,
    source: Spanned<String>,
    #[serde(default)]
    note: String,
    #[serde(default)]
    ratiometric: bool,
    #[serde(default)]
    mode: Vec<ModeTable>,
    #[serde(default)]
    limit: Vec<LimitTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ModeTable {
    name: Spanned<String>,
    range_g: Option<Spanned<f64>>,
    sensitivity: Spanned<f64>,
    unit: SensitivityName,
    #[serde(default)]
    mark: MarkName,
    tolerance_percent: Option<Spanned<f64>>,
    #[serde(default)]
    tolerance_mark: MarkName,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitTable {
    of: Spanned<LimitName>,
    unit: Spanned<String>,
    axes: Option<Spanned<String>>,
    mode: Option<Spanned<String>>,
    typical: Option<Spanned<f64>>,
    maximum: Option<Spanned<f64>>,
    #[serde(default)]
    mark: MarkName,
    #[serde(default)]
    note: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ConverterTable {
    model: Spanned<String>,
    #[serde(default)]
    aliases: Vec<Spanned<String>>,
    #[serde(default)]
    maker: String,
    source: Spanned<String>,
    #[serde(default)]
    note: String,
    reference_v: Option<Spanned<f64>>,
    #[serde(default)]
    ratiometric: bool,
    #[serde(default)]
    mark: MarkName,
    #[serde(default)]
    gains: Vec<Spanned<f64>>,
    #[serde(default)]
    mode: Vec<ConverterModeTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ConverterModeTable {
    rate_hz: Spanned<f64>,
    bits: Spanned<u32>,
    min_code: i32,
    max_code: Spanned<i32>,
    #[serde(default)]
    mark: MarkName,
}

/// What nobody checked is recalled.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum MarkName {
    #[default]
    Recalled,
    Partly,
    Verified,
}

impl From<MarkName> for Mark {
    fn from(name: MarkName) -> Self {
        match name {
            MarkName::Recalled => Self::Recalled,
            MarkName::Partly => Self::Partly,
            MarkName::Verified => Self::Verified,
        }
    }
}

#[derive(Debug, Clone, Copy, Deserialize)]
enum SensitivityName {
    #[serde(rename = "LSB/g")]
    Lsb,
    #[serde(rename = "mV/g")]
    Millivolt,
}

#[derive(Debug, Clone, Copy, Deserialize)]
enum LimitName {
    #[serde(rename = "zero-g")]
    ZeroG,
    #[serde(rename = "zero-g tempco")]
    ZeroGTempco,
    #[serde(rename = "scale tempco")]
    ScaleTempco,
    #[serde(rename = "noise density")]
    NoiseDensity,
    #[serde(rename = "nonlinearity")]
    Nonlinearity,
    #[serde(rename = "cross-axis")]
    CrossAxis,
    #[serde(rename = "alignment")]
    Alignment,
    #[serde(rename = "resolution")]
    Resolution,
}

impl From<LimitName> for LimitOf {
    fn from(name: LimitName) -> Self {
        match name {
            LimitName::ZeroG => Self::ZeroG,
            LimitName::ZeroGTempco => Self::ZeroGTempco,
            LimitName::ScaleTempco => Self::ScaleTempco,
            LimitName::NoiseDensity => Self::NoiseDensity,
            LimitName::Nonlinearity => Self::Nonlinearity,
            LimitName::CrossAxis => Self::CrossAxis,
            LimitName::Alignment => Self::Alignment,
            LimitName::Resolution => Self::Resolution,
        }
    }
}

/// Parses a catalogue. `shown_as` names it in errors and in what was held against it.
pub(super) fn parse(text: &str, shown_as: &str) -> Result<Catalogue, ReadError> {
    let file: CatalogueFile = from_toml(text, shown_as)?;
    let reader = Reader { text: without_mark(text), shown_as };
    if let Some(format) = file.format.filter(|f| *f.get_ref() != 1) {
        return Err(reader.refused("format", &format, "1: this is a file of a newer version"));
    }
    let mut catalogue = Catalogue::default();
    for table in file.sensor {
        reader.new_name(&catalogue, "[[sensor]] model", &table.model)?;
        for alias in &table.aliases {
            reader.new_name(&catalogue, "[[sensor]] aliases", alias)?;
        }
        catalogue.sensors.push(reader.sensor(table)?);
    }
    for table in file.converter {
        reader.new_name(&catalogue, "[[converter]] model", &table.model)?;
        for alias in &table.aliases {
            reader.new_name(&catalogue, "[[converter]] aliases", alias)?;
        }
        catalogue.converters.push(reader.converter(table)?);
    }
    Ok(catalogue)
}

struct Reader<'a> {
    text: &'a str,
    shown_as: &'a str,
}

impl Reader<'_> {
    fn refused<T: ToString>(&self, key: &str, given: &Spanned<T>, expected: &str) -> ReadError {
        ReadError {
            place: place(self.text, self.shown_as, given.span().start),
            problem: Problem::Value {
                key: key.to_owned(),
                given: given.get_ref().to_string(),
                expected: expected.to_owned(),
            },
        }
    }

    /// Names are found without regard to case and punctuation, and only once in a file.
    fn new_name(
        &self,
        so_far: &Catalogue,
        key: &str,
        name: &Spanned<String>,
    ) -> Result<(), ReadError> {
        if normalized(name.get_ref()).is_empty() {
            return Err(self.refused(key, name, "a name with letters or digits"));
        }
        match so_far.find(name.get_ref()).is_some()
            || so_far.find_converter(name.get_ref()).is_some()
        {
            true => Err(self.refused(key, name, "a name that no other entry of this file has")),
            false => Ok(()),
        }
    }

    fn positive(&self, key: &str, given: &Spanned<f64>) -> Result<f64, ReadError> {
        match *given.get_ref() {
            v if v.is_finite() && v > 0.0 => Ok(v),
            _ => Err(self.refused(key, given, "a positive number")),
        }
    }

    fn optional(&self, key: &str, given: Option<&Spanned<f64>>) -> Result<Option<f64>, ReadError> {
        given.map(|g| self.positive(key, g)).transpose()
    }

    fn filled(&self, key: &str, given: &Spanned<String>) -> Result<String, ReadError> {
        match given.get_ref().trim() {
            "" => Err(self.refused(key, given, "where the numbers come from")),
            text => Ok(text.to_owned()),
        }
    }

    fn sensor(&self, table: SensorTable) -> Result<CatalogueEntry, ReadError> {
        let mut modes: Vec<SensorMode> = Vec::new();
        for mode in &table.mode {
            if modes.iter().any(|m| m.name == *mode.name.get_ref()) {
                let expected = "a name that no other mode of this sensor has";
                return Err(self.refused("[[sensor.mode]] name", &mode.name, expected));
            }
            modes.push(self.mode(mode)?);
        }
        if modes.is_empty() {
            let expected = "at least one [[sensor.mode]] with name, sensitivity and unit below it";
            return Err(self.refused("[[sensor]] model", &table.model, expected));
        }
        let limits = table.limit.iter().map(|l| self.limit(l, &modes)).collect::<Result<_, _>>()?;
        Ok(CatalogueEntry {
            sensor_type: SensorType {
                model: table.model.get_ref().clone(),
                source: self.filled("[[sensor]] source", &table.source)?,
                catalogue: self.shown_as.to_owned(),
                ratiometric: table.ratiometric,
                modes,
                limits,
            },
            aliases: table.aliases.into_iter().map(Spanned::into_inner).collect(),
            maker: table.maker,
            note: table.note,
        })
    }

    fn mode(&self, table: &ModeTable) -> Result<SensorMode, ReadError> {
        let percent =
            self.optional("[[sensor.mode]] tolerance_percent", table.tolerance_percent.as_ref())?;
        if let Some(given) = table.tolerance_percent.as_ref().filter(|p| *p.get_ref() >= 100.0) {
            let expected = "per cent of the sensitivity, less than 100";
            return Err(self.refused("[[sensor.mode]] tolerance_percent", given, expected));
        }
        Ok(SensorMode {
            name: table.name.get_ref().clone(),
            range_gn: self.optional("[[sensor.mode]] range_g", table.range_g.as_ref())?,
            sensitivity: self.positive("[[sensor.mode]] sensitivity", &table.sensitivity)?,
            unit: match table.unit {
                SensitivityName::Lsb => SensitivityUnit::LsbPerG,
                SensitivityName::Millivolt => SensitivityUnit::MillivoltPerG,
            },
            mark: table.mark.into(),
            tolerance: percent.map(|p| (p / 100.0, table.tolerance_mark.into())),
        })
    }

    fn limit(&self, table: &LimitTable, modes: &[SensorMode]) -> Result<TypeLimit, ReadError> {
        let of = LimitOf::from(*table.of.get_ref());
        let key = |name: &str| format!("[[sensor.limit]] {name} of `{}`", of.name());
        if table.unit.get_ref() != of.unit() {
            let expected = format!("\"{}\"; convert the number where it is another", of.unit());
            return Err(self.refused(&key("unit"), &table.unit, &expected));
        }
        if let Some(axes) = table.axes.as_ref().filter(|a| {
            a.get_ref().is_empty() || a.get_ref().chars().any(|c| !matches!(c, 'X' | 'Y' | 'Z'))
        }) {
            let expected = "letters of X, Y and Z, for instance \"XY\"; leave it out for all axes";
            return Err(self.refused(&key("axes"), axes, expected));
        }
        if let Some(mode) =
            table.mode.as_ref().filter(|m| modes.iter().all(|k| k.name != *m.get_ref()))
        {
            let expected = "the name of a [[sensor.mode]] of this sensor";
            return Err(self.refused(&key("mode"), mode, expected));
        }
        let typical = self.optional(&key("typical"), table.typical.as_ref())?;
        let maximum = self.optional(&key("maximum"), table.maximum.as_ref())?;
        match (typical, maximum, &table.maximum) {
            (None, None, _) => Err(ReadError {
                place: place(self.text, self.shown_as, table.of.span().start),
                problem: Problem::MissingKey {
                    key: "[[sensor.limit]] typical or maximum",
                    example: "typical = 25.0, maximum = 75.0, or both",
                },
            }),
            (Some(typical), Some(maximum), Some(given)) if typical > maximum => {
                Err(self.refused(&key("maximum"), given, "no less than typical"))
            }
            _ => Ok(TypeLimit {
                of,
                axes: table.axes.as_ref().map(|a| a.get_ref().clone()),
                mode: table.mode.as_ref().map(|m| m.get_ref().clone()),
                typical,
                maximum,
                mark: table.mark.into(),
                note: table.note.clone(),
            }),
        }
    }

    fn converter(&self, table: ConverterTable) -> Result<Converter, ReadError> {
        let reference_v = self.optional("[[converter]] reference_v", table.reference_v.as_ref())?;
        let gains = table
            .gains
            .iter()
            .map(|g| self.positive("[[converter]] gains", g))
            .collect::<Result<_, _>>()?;
        let mut modes = Vec::new();
        for mode in &table.mode {
            if !(1..=32).contains(mode.bits.get_ref()) {
                return Err(self.refused("[[converter.mode]] bits", &mode.bits, "1 to 32 bits"));
            }
            if *mode.max_code.get_ref() <= mode.min_code {
                let expected = "more than min_code";
                return Err(self.refused("[[converter.mode]] max_code", &mode.max_code, expected));
            }
            modes.push(ConverterMode {
                rate_hz: self.positive("[[converter.mode]] rate_hz", &mode.rate_hz)?,
                bits: *mode.bits.get_ref(),
                min_code: mode.min_code,
                max_code: *mode.max_code.get_ref(),
                mark: mode.mark.into(),
            });
        }
        Ok(Converter {
            model: table.model.get_ref().clone(),
            aliases: table.aliases.into_iter().map(Spanned::into_inner).collect(),
            maker: table.maker,
            source: self.filled("[[converter]] source", &table.source)?,
            catalogue: self.shown_as.to_owned(),
            note: table.note,
            reference_v,
            ratiometric: table.ratiometric,
            mark: table.mark.into(),
            gains,
            modes,
        })
    }
}
