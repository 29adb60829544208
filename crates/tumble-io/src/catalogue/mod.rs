//! The catalogue of sensor types: what data sheets say, with where it comes from and how well it is known.
//!
//! Embedded: `catalogue.toml` of this crate. Users add theirs: `catalogue.toml` in an experiment folder, or a file
//! named with `--catalogue`. The format is written in `docs/catalogue.md`.

mod file;
mod json;

use std::path::Path;
use std::sync::LazyLock;

use tumble_core::{Mark, SensorMode, SensorType};

use crate::error::{Place, Problem, ReadError};
use crate::folder::FileDigest;

/// Name of a user's catalogue in an experiment folder.
pub(crate) const CATALOGUE_FILE: &str = "catalogue.toml";
/// What the embedded catalogue is called where something was held against it.
const BUILT_IN: &str = "built-in";
/// A catalogue of all sensors ever sold has not as many bytes.
const LARGEST: u64 = 4 << 20;

/// Types of sensors and converters, with names to find them by.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Catalogue {
    sensors: Vec<CatalogueEntry>,
    converters: Vec<Converter>,
}

/// One type of sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct CatalogueEntry {
    /// Sensitivities and limits, as the core judges by them.
    pub sensor_type: SensorType,
    /// Other names: order codes, boards.
    pub aliases: Vec<String>,
    /// Who makes it.
    pub maker: String,
    /// Anything else worth knowing.
    pub note: String,
}

impl CatalogueEntry {
    /// Model.
    #[must_use]
    pub fn model(&self) -> &str {
        &self.sensor_type.model
    }

    /// Ranges, supplies or settings, at least one. The nominal scale of a digital one:
    /// [`SensorMode::nominal_scale_m_s2_per_lsb`].
    #[must_use]
    pub fn modes(&self) -> &[SensorMode] {
        &self.sensor_type.modes
    }
}

/// One type of converter, for information.
#[derive(Debug, Clone, PartialEq)]
pub struct Converter {
    /// Model.
    pub model: String,
    /// Other names.
    pub aliases: Vec<String>,
    /// Who makes it.
    pub maker: String,
    /// Where the numbers come from.
    pub source: String,
    /// Which catalogue it stands in.
    pub catalogue: String,
    /// Anything else worth knowing.
    pub note: String,
    /// Own reference, V; `None`: not known, or the supply.
    pub reference_v: Option<f64>,
    /// Whether the supply is the reference.
    pub ratiometric: bool,
    /// How well the reference and the gains are known.
    pub mark: Mark,
    /// Gains before the converter.
    pub gains: Vec<f64>,
    /// Rates with their codes.
    pub modes: Vec<ConverterMode>,
}

/// A rate of a converter with its codes.
#[derive(Debug, Clone, PartialEq)]
pub struct ConverterMode {
    /// Samples per second.
    pub rate_hz: f64,
    /// Bits.
    pub bits: u32,
    /// Lowest code: `min_code` of experiment.toml.
    pub min_code: i32,
    /// Highest code.
    pub max_code: i32,
    /// How well they are known.
    pub mark: Mark,
}

impl ConverterMode {
    /// Volts per LSB at a gain: reference over gain and half the codes; `None` without a known reference.
    ///
    /// ```
    /// use tumble_io::Catalogue;
    /// let ads = Catalogue::builtin().find_converter("ads1110").unwrap();
    /// let finest = ads.modes[0].volt_per_lsb(ads, 1.0).unwrap();
    /// assert!((finest - 62.5e-6).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn volt_per_lsb(&self, of: &Converter, gain: f64) -> Option<f64> {
        let reference_v = of.reference_v?;
        Some(reference_v / (gain * -f64::from(self.min_code))).filter(|v| v.is_finite() && *v > 0.0)
    }
}

/// A user's catalogue with what the passport wants to know about it.
#[derive(Debug, Clone, PartialEq)]
pub struct UserCatalogue {
    /// Its entries.
    pub catalogue: Catalogue,
    /// Its digest, under the name that the passport gives it.
    pub input: FileDigest,
}

/// The embedded catalogue. That it parses is held by a test of this crate; were it broken, it would be empty.
static EMBEDDED: LazyLock<Catalogue> = LazyLock::new(|| embedded().unwrap_or_default());

fn embedded() -> Result<Catalogue, ReadError> {
    file::parse(include_str!("../../catalogue.toml"), BUILT_IN)
}

impl Catalogue {
    /// The catalogue that comes with Tumble.
    ///
    /// ```
    /// use tumble_io::Catalogue;
    /// let entry = Catalogue::builtin().find("mpu6050").unwrap();
    /// assert_eq!(entry.model(), "MPU-6050");
    /// let k0 = entry.modes()[0].nominal_scale_m_s2_per_lsb().unwrap();
    /// assert!((k0 - 9.80665 / 16_384.0).abs() < 1e-12);
    /// assert!(Catalogue::builtin().find("my own board").is_none());
    /// ```
    #[must_use]
    pub fn builtin() -> &'static Self {
        &EMBEDDED
    }

    /// Parses a user's catalogue.
    ///
    /// **Errors** [`ReadError`] with line and column: unknown keys with the nearest known one, numbers that are not
    /// possible, names that occur twice.
    pub fn parse(text: &str, shown_as: &str) -> Result<Self, ReadError> {
        file::parse(text, shown_as)
    }

    /// Reads a user's catalogue, named with `--catalogue`.
    pub fn read(path: &Path) -> Result<UserCatalogue, ReadError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self::read_as(path, &path.display().to_string(), &format!("{name} (--catalogue)"))
    }

    /// Reads a file; errors name it `shown_as`, the passport `recorded_as`, so that the same inputs make the same
    /// passport wherever they lie.
    pub(crate) fn read_as(
        path: &Path,
        shown_as: &str,
        recorded_as: &str,
    ) -> Result<UserCatalogue, ReadError> {
        use std::io::Read as _;
        let fail = |problem| ReadError { place: Place::file(shown_as), problem };
        let mut bytes = Vec::new();
        std::fs::File::open(path)
            .and_then(|f| f.take(LARGEST + 1).read_to_end(&mut bytes))
            .map_err(|e| fail(Problem::Io(e)))?;
        if bytes.len() as u64 > LARGEST {
            let seen = "more than 4 MiB";
            return Err(fail(Problem::Format { seen, remedy: "name a catalogue in TOML" }));
        }
        let text = std::str::from_utf8(&bytes).map_err(|_| {
            fail(Problem::Format { seen: "not UTF-8 text", remedy: "save the file as UTF-8" })
        })?;
        let mut catalogue = file::parse(text, shown_as)?;
        for entry in &mut catalogue.sensors {
            recorded_as.clone_into(&mut entry.sensor_type.catalogue);
        }
        for converter in &mut catalogue.converters {
            recorded_as.clone_into(&mut converter.catalogue);
        }
        let input =
            FileDigest { file: recorded_as.to_owned(), sha256: crate::digest::sha256(&bytes) };
        Ok(UserCatalogue { catalogue, input })
    }

    /// This catalogue with another's entries over it: they come first and replace entries of the same model whole.
    #[must_use]
    pub fn with(&self, over: &Self) -> Self {
        let replaces = |model: &str| {
            let name = normalized(model);
            over.sensors.iter().any(|e| normalized(e.model()) == name)
                || over.converters.iter().any(|c| normalized(&c.model) == name)
        };
        let sensors = self.sensors.iter().filter(|e| !replaces(e.model()));
        let converters = self.converters.iter().filter(|c| !replaces(&c.model));
        Self {
            sensors: over.sensors.iter().chain(sensors).cloned().collect(),
            converters: over.converters.iter().chain(converters).cloned().collect(),
        }
    }

    /// The sensor of a name: model or alias, without regard to case and punctuation. Models go before aliases, and
    /// later catalogues before earlier ones.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&CatalogueEntry> {
        let wanted = Some(normalized(name)).filter(|n| !n.is_empty())?;
        self.sensors.iter().find(|e| normalized(e.model()) == wanted).or_else(|| {
            self.sensors.iter().find(|e| e.aliases.iter().any(|a| normalized(a) == wanted))
        })
    }

    /// The converter of a name, found the same way.
    #[must_use]
    pub fn find_converter(&self, name: &str) -> Option<&Converter> {
        let wanted = Some(normalized(name)).filter(|n| !n.is_empty())?;
        self.converters.iter().find(|c| normalized(&c.model) == wanted).or_else(|| {
            self.converters.iter().find(|c| c.aliases.iter().any(|a| normalized(a) == wanted))
        })
    }

    /// All sensors.
    #[must_use]
    pub fn sensors(&self) -> &[CatalogueEntry] {
        &self.sensors
    }

    /// All converters.
    #[must_use]
    pub fn converters(&self) -> &[Converter] {
        &self.converters
    }

    /// Models that look like a name, best first.
    #[must_use]
    pub fn nearest(&self, name: &str) -> Vec<&str> {
        /// Fewer alike than this is no slip of the pen.
        const ALIKE: f64 = 0.75;
        let wanted = normalized(name);
        let sensors = self.sensors.iter().map(|e| (e.model(), &e.aliases));
        let converters = self.converters.iter().map(|c| (c.model.as_str(), &c.aliases));
        let mut alike: Vec<(f64, &str)> = sensors
            .chain(converters)
            .map(|(model, aliases)| {
                let names = aliases.iter().map(String::as_str).chain([model]);
                let similar = names.map(|n| strsim::jaro_winkler(&wanted, &normalized(n)));
                (similar.fold(0.0, f64::max), model)
            })
            .filter(|(similar, _)| *similar > ALIKE)
            .collect();
        alike.sort_by(|a, b| b.0.total_cmp(&a.0));
        alike.into_iter().take(3).map(|(_, model)| model).collect()
    }
}

/// Letters and digits in lower case: `MPU-6050` and `mpu6050` are one name.
fn normalized(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tumble_core::{LimitOf, SensitivityUnit};

    #[test]
    fn the_embedded_catalogue_parses_and_every_entry_is_whole() {
        let catalogue = embedded().unwrap();
        let models: Vec<&str> = catalogue.sensors.iter().map(CatalogueEntry::model).collect();
        for model in [
            "ADXL203",
            "ADXL355",
            "ADXL345",
            "LIS3DSH",
            "MPU-6050",
            "SCL3300",
            "SCA3300",
            "LIS344ALH",
            "ADXL350",
        ] {
            assert!(models.contains(&model), "{model} is not in {models:?}");
        }
        for e in &catalogue.sensors {
            let t = &e.sensor_type;
            assert!(t.source.len() > 20 && !e.maker.is_empty(), "{}: source and maker", t.model);
            assert!(!t.modes.is_empty() && !t.limits.is_empty(), "{}", t.model);
            assert_eq!(t.catalogue, BUILT_IN);
            let text = format!("{}{}{}{:?}", t.source, e.note, e.maker, t);
            assert!(text.is_ascii(), "{}: {text}", t.model);
        }
        for c in &catalogue.converters {
            assert!(c.source.len() > 20 && c.modes.len() == 4, "{}", c.model);
        }
    }

    /// Numbers of the notes with the mark that they have there: none may be promoted by a slip of the pen.
    #[test]
    fn marks_are_those_of_the_notes() {
        let catalogue = embedded().unwrap();
        let (v, p, r) = (Mark::Verified, Mark::Partly, Mark::Recalled);
        for (model, sensitivity, tolerance) in [
            ("ADXL203", (1000.0, v), Some((0.04, r))),
            ("ADXL355", (256_000.0, r), Some((0.08, r))),
            ("ADXL345", (256.0, v), Some((0.1016, v))),
            ("LIS3DSH", (16_666.67, r), None),
            ("MPU-6050", (16_384.0, v), Some((0.03, v))),
            ("SCL3300", (6000.0, p), None),
            ("SCA3300", (2700.0, p), None),
            ("LIS344ALH", (660.0, v), Some((0.05, v))),
            ("ADXL350", (512.0, v), Some((0.076, v))),
        ] {
            let mode = &catalogue.find(model).unwrap().modes()[0];
            assert_eq!((mode.sensitivity, mode.mark), sensitivity, "{model}");
            assert_eq!(mode.tolerance, tolerance, "{model}");
        }
        use LimitOf::{CrossAxis, NoiseDensity, Nonlinearity, ZeroG, ZeroGTempco};
        for (model, of, axis, typical, maximum, mark) in [
            ("ADXL203", ZeroG, 'X', Some(25.0), Some(100.0), r),
            ("ADXL203", ZeroGTempco, 'Y', Some(0.1), Some(0.8), v),
            ("ADXL203", NoiseDensity, 'X', Some(110.0), None, v),
            ("ADXL203", Nonlinearity, 'X', Some(0.2), Some(1.25), r),
            ("ADXL203", CrossAxis, 'X', Some(1.5), Some(3.0), r),
            ("ADXL355", ZeroG, 'X', Some(25.0), Some(75.0), r),
            ("ADXL355", NoiseDensity, 'X', Some(22.5), None, p),
            ("ADXL345", ZeroG, 'Y', Some(35.0), Some(150.0), r),
            ("ADXL345", ZeroG, 'Z', Some(40.0), Some(250.0), r),
            ("ADXL345", ZeroGTempco, 'Z', Some(1.2), None, r),
            ("LIS3DSH", ZeroG, 'X', Some(40.0), None, r),
            ("MPU-6050", ZeroG, 'X', Some(50.0), None, v),
            ("MPU-6050", ZeroG, 'Z', Some(80.0), None, v),
            ("MPU-6050", NoiseDensity, 'X', Some(400.0), None, v),
            ("SCA3300", NoiseDensity, 'X', Some(37.0), None, v),
            ("SCL3300", ZeroG, 'X', Some(20.0), None, r),
            ("LIS344ALH", ZeroGTempco, 'X', Some(0.4), None, v),
            ("LIS344ALH", NoiseDensity, 'X', Some(50.0), None, v),
            ("ADXL350", ZeroG, 'X', None, Some(150.0), v),
            ("ADXL350", ZeroG, 'Z', None, Some(250.0), v),
            ("ADXL350", ZeroGTempco, 'Z', None, Some(0.49), v),
        ] {
            let t = &catalogue.find(model).unwrap().sensor_type;
            let first = t.modes[0].name.as_str();
            let limit = t.limits_for(of, Some(axis), Some(first)).next().unwrap();
            let found = (limit.typical, limit.maximum, limit.mark);
            assert_eq!(found, (typical, maximum, mark), "{model} {} {axis}", of.name());
        }
    }

    #[test]
    fn names_are_found_however_they_are_written() {
        let catalogue = Catalogue::builtin();
        for (name, model) in [
            ("ADXL203", Some("ADXL203")),
            ("adxl 203", Some("ADXL203")),
            ("ADXL203CE", Some("ADXL203")),
            ("mpu6050", Some("MPU-6050")),
            ("MPU_6050", Some("MPU-6050")),
            ("ADXL203 on my board", None),
            ("", None),
            ("--", None),
        ] {
            assert_eq!(catalogue.find(name).map(CatalogueEntry::model), model, "{name}");
        }
        assert_eq!(catalogue.nearest("ADXL204")[0], "ADXL203");
        assert_eq!(catalogue.nearest("flux capacitor"), Vec::<&str>::new());
    }

    #[test]
    fn a_users_entry_replaces_the_built_in_one_whole() {
        let own = "[[sensor]]\nmodel = \"adxl-203\"\naliases = [\"board 7\"]\nsource = \"own\"\n\
                   [[sensor.mode]]\nname = \"5 V\"\nsensitivity = 500\nunit = \"mV/g\"\n";
        let own = Catalogue::parse(own, "mine.toml").unwrap();
        let both = Catalogue::builtin().with(&own);
        let entry = both.find("ADXL203").unwrap();
        assert_eq!((entry.modes()[0].sensitivity, entry.sensor_type.limits.len()), (500.0, 0));
        assert_eq!(entry.modes()[0].unit, SensitivityUnit::MillivoltPerG);
        // What nobody marked is not verified.
        assert_eq!(entry.modes()[0].mark, Mark::Recalled);
        assert_eq!(both.find("Board-7").unwrap().model(), "adxl-203");
        assert_eq!(both.sensors().len(), Catalogue::builtin().sensors().len());
        assert!(both.find("ADXL345").is_some() && both.find_converter("ADS1110").is_some());
    }

    #[test]
    fn refusals_name_line_column_and_cure() {
        let head = "[[sensor]]\nmodel = \"A\"\nsource = \"own\"\n";
        let mode = "[[sensor.mode]]\nname = \"m\"\nsensitivity = 1000\nunit = \"mV/g\"\n";
        let limit = "[[sensor.limit]]\nof = \"zero-g\"\nunit = \"mg\"\n";
        for (text, words) in [
            (format!("{head}alias = 1\n"), ["line 4, column 1", "`aliases`"]),
            (
                format!("{head}{mode}tolerance_per = 4\n"),
                ["line 8, column 1", "`tolerance_percent`"],
            ),
            (format!("{head}{mode}{limit}maxium = 4\n"), ["line 11", "`maximum`"]),
            (head.to_owned(), ["line 2", "[[sensor.mode]]"]),
            (format!("{head}{}", mode.replace("1000", "-1")), ["line 6, column 15", "positive"]),
            (format!("{head}{}", mode.replace("1000", "nan")), ["line 6", "positive"]),
            (format!("{head}{}", mode.replace("mV/g", "V/g")), ["line 7", "LSB/g"]),
            (format!("{head}{mode}tolerance_percent = 100\n"), ["line 8", "less than 100"]),
            (format!("{head}{mode}mark = \"sure\"\n"), ["line 8", "verified"]),
            (format!("{head}{mode}{mode}"), ["line 9", "no other mode"]),
            (format!("{head}{mode}{limit}"), ["line 9", "typical"]),
            (format!("{head}{mode}{limit}typical = 3\nmaximum = 2\n"), ["line 12", "no less"]),
            (format!("{head}{mode}{limit}typical = inf\n"), ["line 11", "positive"]),
            (
                format!("{head}{mode}{}typical = 3\n", limit.replace("\"mg\"", "\"g\"")),
                ["line 10", "\"mg\""],
            ),
            (format!("{head}{mode}{limit}typical = 3\naxes = \"xy\"\n"), ["line 12", "XY"]),
            (format!("{head}{mode}{limit}typical = 3\nmode = \"n\"\n"), ["line 12", "sensor.mode"]),
            (
                format!("{head}{mode}{}", limit.replace("zero-g", "zero")),
                ["line 9", "zero-g tempco"],
            ),
            (format!("{head}{mode}{head}{mode}"), ["line 9", "no other entry"]),
            (head.replace("\"own\"", "\"\"") + mode, ["line 3", "come from"]),
            (head.replace("\"A\"", "\"-\"") + mode, ["line 2", "letters"]),
            ("format = 2\n".to_owned(), ["line 1", "newer"]),
        ] {
            let error = Catalogue::parse(&text, "mine.toml").unwrap_err().to_string();
            let whole = error.starts_with("mine.toml, ") && words.iter().all(|w| error.contains(w));
            assert!(whole, "{words:?} in `{error}` of\n{text}");
        }
    }
}
