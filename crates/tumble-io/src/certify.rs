//! The one pipeline: read, judge, make the passport.

use std::path::Path;

use tumble_core::assess::{AssessError, LeftOut, assess_without};
use tumble_core::estimate::EstimateOptions;

use crate::catalogue::UserCatalogue;
use crate::error::ReadError;
use crate::folder::read_experiment_with;
use crate::passport::{self, Passport};
use crate::source::Watch;

/// Options of [`certify`].
#[derive(Debug, Clone, Default)]
pub struct CertifyOptions {
    /// Estimation.
    pub estimate: EstimateOptions,
    /// Number of the certificate; else the folder's.
    pub id: Option<String>,
    /// Day of issue; else the folder's.
    pub issued: Option<String>,
    /// Types of sensors over the folder's and the built-in ones.
    pub catalogue: Option<UserCatalogue>,
    /// Positions that are left out of the adjustment, beside those that the folder leaves out.
    pub left_out: Vec<LeftOut>,
}

/// An experiment that could not be certified: nothing was judged.
#[derive(Debug)]
pub enum CertifyError {
    /// Could not be read.
    Read(ReadError),
    /// Could not be judged.
    Assess(AssessError),
    /// Numbers of the result left the range of numbers: no passport could be read again.
    NotFinite,
}

impl std::fmt::Display for CertifyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Read(e) => e.fmt(f),
            Self::Assess(e) => e.fmt(f),
            Self::NotFinite => f.write_str(
                "the result holds numbers without bounds; no bench gives such input: look at nominal_scale, mean codes \
                 and temperatures (`tumble check` shows what was read)",
            ),
        }
    }
}

impl std::error::Error for CertifyError {}

/// Reads an experiment folder, judges it and makes its passport. Rejected and indeterminate experiments get a
/// passport too; it says why.
pub fn certify(folder: &Path, options: &CertifyOptions) -> Result<Passport, CertifyError> {
    certify_watched(folder, options, &())
}

/// [`certify`], telling how far the reading of files has come.
pub fn certify_watched(
    folder: &Path,
    options: &CertifyOptions,
    watch: &dyn Watch,
) -> Result<Passport, CertifyError> {
    let mut read = read_experiment_with(folder, options.catalogue.as_ref(), watch)
        .map_err(CertifyError::Read)?;
    read.left_out.extend(options.left_out.iter().cloned());
    read.left_out.sort();
    read.left_out.dedup();
    let mut assessment = assess_without(&read.experiment, &options.estimate, &read.left_out)
        .map_err(CertifyError::Assess)?;
    assessment.findings.extend(read.findings.iter().cloned());
    let passport = passport::build(
        &read,
        &assessment,
        &options.estimate,
        options.id.as_deref(),
        options.issued.as_deref(),
    );
    if passport.is_finite() { Ok(passport) } else { Err(CertifyError::NotFinite) }
}
