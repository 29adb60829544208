//! A `tumble-noise/1` document read back: what planning takes from it.

use std::path::Path;

use super::{NoiseDocument, SCHEMA};
use crate::error::{Place, Problem, ReadError};
use crate::source;

/// Longest document, bytes. One of every averaging time of a million readings has 90 MB; nobody plans with that.
const LONGEST: u64 = 128 << 20;

/// The noise of a sensor at rest in SI, as a plan takes it.
///
/// **Model** `σ²(τ) = 3Q²/τ² + N²/τ + (2 ln2/π) B² + K² τ/3 + R² τ²/2`, with the symbols of the fields.
/// **Uncertainty** none is carried; it stands in [`NoiseDocument::fit`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownNoise {
    /// Readings a second.
    pub rate_hz: f64,
    /// Q, m/s: white noise of a velocity.
    pub quantization_m_s: f64,
    /// N, m/s²·√s: white noise of the readings. The one-sided density is √2 N. It holds the converter's rounding
    /// ([`KnownNoise::rounding_m_s2_rts`]).
    pub white_m_s2_rts: f64,
    /// B, m/s²: flicker. The bottom of the curve is 0.664 B.
    pub flicker_m_s2: f64,
    /// K, m/s²/√s: random walk of the bias.
    pub walk_m_s2_per_rts: f64,
    /// R, m/s³: ramp of the bias.
    pub ramp_m_s3: f64,
    /// Step of the converter, m/s²; absent where it could not be seen.
    pub lsb_m_s2: Option<f64>,
    /// The N that rounding to that step alone makes, m/s²·√s.
    pub rounding_m_s2_rts: Option<f64>,
    /// Whether noise spreads the readings over steps; where it does not, the coefficients are the converter's.
    pub dithered: Option<bool>,
}

/// Reads what `tumble noise --json` printed, or `noise.json` of its `--out`.
///
/// **Errors** [`ReadError`] where the file cannot be read, or is no document of that kind.
pub fn read_document(path: &Path) -> Result<NoiseDocument, ReadError> {
    let shown_as = path.display().to_string();
    let place = Place::file(shown_as.as_str());
    if path.is_dir() {
        let remedy = "name the noise.json in it";
        return Err(ReadError { place, problem: Problem::Format { seen: "a folder", remedy } });
    }
    let bytes = source::read_document(path, &shown_as, LONGEST)?;
    from_json(&bytes, &place)
}

/// A document of major version 1.
pub(crate) fn from_json(bytes: &[u8], place: &Place) -> Result<NoiseDocument, ReadError> {
    #[derive(serde::Deserialize)]
    struct Head {
        schema: String,
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let json = |e: serde_json::Error| {
        let place = if e.is_data() && e.line() == 0 {
            place.clone()
        } else {
            Place::line(place.file.as_str(), e.line() as u64)
        };
        let what = format!("no document of tumble noise ({e})");
        let remedy = "write one with `tumble noise FILE --scale M/S2 --json > noise.json`";
        ReadError { place, problem: Problem::Document { what, remedy } }
    };
    let head: Head = serde_json::from_slice(bytes).map_err(json)?;
    if head.schema != SCHEMA {
        let what = format!("a document of the kind `{}`, not `{SCHEMA}`", head.schema);
        let remedy = "name what `tumble noise FILE --scale M/S2 --json` printed";
        return Err(ReadError {
            place: place.clone(),
            problem: Problem::Document { what, remedy },
        });
    }
    serde_json::from_slice(bytes).map_err(json)
}

impl NoiseDocument {
    /// The coefficients in SI, with the rate and the converter's step.
    ///
    /// **Errors** [`ReadError`], at the file `shown_as`: results that are not in m/s², no coefficients, or numbers that
    /// are no rate and no sizes.
    pub fn known(&self, shown_as: &str) -> Result<KnownNoise, ReadError> {
        let fail = |what: String, remedy| ReadError {
            place: Place::file(shown_as),
            problem: Problem::Document { what, remedy },
        };
        if self.unit != "m/s2" {
            return Err(fail(
                format!("the results are in {}, not in m/s²", self.unit),
                "run `tumble noise` again with --scale M/S2 (1 where the readings are m/s²), --passport or --sensor",
            ));
        }
        let Some(fit) = &self.fit else {
            return Err(fail(
                "no coefficients: the record was too short or held no noise".into(),
                "take a longer record at rest, or give the noise by figures",
            ));
        };
        let size = |symbol: &str| {
            let found = fit.coefficients.iter().find(|c| c.symbol == symbol);
            found.map(|c| c.value).filter(|v| v.is_finite() && *v >= 0.0).ok_or_else(|| {
                fail(
                    format!("no coefficient {symbol} of zero or more"),
                    "write the document anew with `tumble noise`",
                )
            })
        };
        let positive = |name: &str, v: f64| {
            if v.is_finite() && v > 0.0 {
                return Ok(v);
            }
            Err(fail(
                format!("{name} = {v} is not possible"),
                "write the document anew with `tumble noise`",
            ))
        };
        let converter = self.converter.as_ref();
        Ok(KnownNoise {
            rate_hz: positive("input.rate_hz", self.input.rate_hz)?,
            quantization_m_s: size("Q")?,
            white_m_s2_rts: size("N")?,
            flicker_m_s2: size("B")?,
            walk_m_s2_per_rts: size("K")?,
            ramp_m_s3: size("R")?,
            lsb_m_s2: converter.map(|c| positive("converter.step", c.step)).transpose()?,
            rounding_m_s2_rts: converter.map(|c| positive("converter.n", c.n)).transpose()?,
            dithered: converter.map(|c| c.dithered),
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.
mod tests {
    use super::*;
    use crate::noise::{NoiseSettings, Scale, analyse};
    use tumble_core::noise::{Spacing, Times};

    /// Whole readings with some white noise.
    fn record() -> String {
        let mut state = 7u64;
        let mut uniform = move || {
            state = 16_807 * state % 2_147_483_647;
            state as f64 / 2_147_483_647.0
        };
        (0..4096)
            .map(|_| {
                let sum: f64 = (0..12).map(|_| uniform()).sum();
                format!("{}\n", (500.0 + 5.0 * (sum - 6.0)).round())
            })
            .collect()
    }

    /// The document of the record, by the file it was written to.
    fn written(scale: Option<f64>) -> (tempfile::TempDir, std::path::PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("still.txt");
        std::fs::write(&path, record()).unwrap();
        let settings = NoiseSettings {
            column: None,
            rate_hz: Some(50.0),
            time: None,
            time_unit: None,
            scale: scale.map(|s| Scale { m_s2_per_unit: s, source: "as given".into() }),
            deviations: Vec::new(),
            times: Times::Spaced(Spacing::Octave),
            level: 0.683,
        };
        let document = analyse(&path, &settings, &()).unwrap();
        let path = dir.path().join("noise.json");
        std::fs::write(&path, document.to_json().unwrap()).unwrap();
        (dir, path)
    }

    #[test]
    fn a_plan_gets_its_figures_in_si() {
        const SCALE: f64 = 0.01;
        let (_dir, path) = written(Some(SCALE));
        let document = read_document(&path).unwrap();
        let known = document.known("noise.json").unwrap();
        assert_eq!(known.rate_hz, 50.0);
        assert_eq!(known.lsb_m_s2, Some(SCALE));
        assert_eq!(known.dithered, Some(true));
        // 5 LSB a reading, and rounding: N = s √τ0, within what 4096 readings show.
        let expected = SCALE * (25.0f64 + 1.0 / 12.0).sqrt() / 50f64.sqrt();
        assert!((known.white_m_s2_rts / expected - 1.0).abs() < 0.05, "{known:?} {expected}");
        let rounding = SCALE / 12f64.sqrt() / 50f64.sqrt();
        assert!((known.rounding_m_s2_rts.unwrap() / rounding - 1.0).abs() < 1e-12);
        assert!(known.flicker_m_s2 < 0.1 * expected && known.ramp_m_s3 < 1e-4, "{known:?}");
        let value = |i: usize| document.fit.as_ref().unwrap().coefficients[i].value;
        let all = [
            known.quantization_m_s,
            known.white_m_s2_rts,
            known.flicker_m_s2,
            known.walk_m_s2_per_rts,
            known.ramp_m_s3,
        ];
        assert_eq!(all, std::array::from_fn(value));
    }

    #[test]
    fn what_is_no_noise_in_si_is_refused_with_a_remedy() {
        let (_dir, path) = written(None);
        let e = read_document(&path).unwrap().known("noise.json").unwrap_err().to_string();
        assert!(e.contains("noise.json: the results are in LSB") && e.contains("--scale"), "{e}");
        let (dir, path) = written(Some(1.0));
        let good = std::fs::read_to_string(&path).unwrap();
        let mut document = read_document(&path).unwrap();
        document.fit = None;
        assert!(document.known("x").unwrap_err().to_string().contains("longer record"));
        let cases = [
            (good.replace(SCHEMA, "tumble-noise/2"), "`tumble-noise/2`"),
            (good.replace(SCHEMA, "tumble-passport/1"), "`tumble-passport/1`"),
            (good[..good.len() / 2].to_owned(), "line "),
            ("50\n51\n".into(), "line 1"),
            (String::new(), "tumble noise FILE"),
        ];
        for (text, says) in cases {
            std::fs::write(&path, text).unwrap();
            let e = read_document(&path).unwrap_err().to_string();
            assert!(e.contains(says) && e.contains("tumble noise FILE"), "{e}");
        }
        for (from, to) in
            [("\"rate_hz\": 50.0", "\"rate_hz\": 0.0"), ("\"symbol\": \"K\"", "\"symbol\": \"k\"")]
        {
            assert!(good.contains(from), "{from}");
            std::fs::write(&path, good.replace(from, to)).unwrap();
            let e = read_document(&path).unwrap().known("x").unwrap_err().to_string();
            assert!(e.contains("anew"), "{e}");
        }
        assert!(read_document(dir.path()).unwrap_err().to_string().contains("noise.json in it"));
        let e = read_document(&dir.path().join("nose.json")).unwrap_err().to_string();
        assert!(e.contains("nose.json"), "{e}");
    }
}
