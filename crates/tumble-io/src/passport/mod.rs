//! The passport's wire format, `tumble-passport/1`.
//!
//! Within `/1` fields are only added; readers ignore what they do not know. The published JSON Schema is
//! `docs/passport.schema.json`. Numbers are SI unless a name says otherwise; `null` stands for what could not be
//! determined, and for infinite degrees of freedom.

mod build;
mod conformity;
mod outliers;
mod terms;
mod types;

use std::io::Read as _;
use std::path::Path;

pub use build::build;
pub(crate) use build::quantizer_name;
pub use types::*;

/// Name and major version of the format.
pub const SCHEMA: &str = "tumble-passport/1";

/// Longest passport, bytes. One of ten thousand dwells has 10 MB.
pub const LONGEST: u64 = 32 << 20;

impl Passport {
    /// Reads a passport's file. It may be a pipe; no more than [`LONGEST`] bytes of it are read.
    ///
    /// **Errors** [`PassportError`].
    pub fn read(path: &Path) -> Result<Self, PassportError> {
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path)
            .map_err(|e| PassportError::Io(crate::advice::with_similar_names(e, path)))?;
        file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(PassportError::Io)?;
        if bytes.len() as u64 > LONGEST {
            return Err(PassportError::TooLong);
        }
        Self::from_json(std::str::from_utf8(&bytes).map_err(|_| PassportError::Encoding)?)
    }

    /// Reads a passport of major version 1.
    ///
    /// **Errors** [`PassportError`].
    pub fn from_json(text: &str) -> Result<Self, PassportError> {
        #[derive(serde::Deserialize)]
        struct Head {
            schema: String,
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let head: Head = serde_json::from_str(text).map_err(PassportError::Json)?;
        if head.schema != SCHEMA {
            return Err(PassportError::Schema { seen: head.schema });
        }
        serde_json::from_str(text).map_err(PassportError::Json)
    }

    /// Whether all numbers are numbers: JSON has `null` for others, and it does not read again.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let json = serde_json::to_string(self);
        json.is_ok_and(|text| serde_json::from_str::<Self>(&text).is_ok_and(|read| read == *self))
    }

    /// Writes it, indented, with a final newline. The same passport gives the same bytes.
    pub fn to_json(&self) -> Result<String, PassportError> {
        let mut text = serde_json::to_string_pretty(self).map_err(PassportError::Json)?;
        text.push('\n');
        Ok(text)
    }
}

/// A passport that cannot be read.
#[derive(Debug)]
pub enum PassportError {
    /// The operating system refused.
    Io(std::io::Error),
    /// More bytes than a passport may have.
    TooLong,
    /// Not UTF-8.
    Encoding,
    /// Not JSON, or a field is of the wrong type.
    Json(serde_json::Error),
    /// Another schema or major version.
    Schema {
        /// What the file says.
        seen: String,
    },
}

impl std::fmt::Display for PassportError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(e) => f.write_str(&crate::advice(e)),
            Self::TooLong => write!(
                f,
                "more than {} MiB; no passport is that long: name the passport.json that `tumble certify --out` wrote",
                LONGEST >> 20
            ),
            Self::Encoding => f.write_str(
                "not UTF-8 text; name the passport.json that `tumble certify --out` wrote",
            ),
            Self::Json(e) => write!(
                f,
                "not a passport ({}); give the passport.json that `tumble certify FOLDER --out DIR` wrote",
                crate::error::visible(&e.to_string())
            ),
            Self::Schema { seen } => write!(
                f,
                "schema `{}` is not `{SCHEMA}`; use the version of tumble that wrote it",
                crate::error::visible(seen)
            ),
        }
    }
}

impl std::error::Error for PassportError {}
