//! What a passport may show: the verdict in words, and whether there are coefficients.

use tumble_io::passport::{Compensation, Passport, ResultSection};

/// The verdict together with what it allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    Accepted,
    /// Indeterminate with a result: for want of runs alone.
    Unproven {
        one_run: bool,
    },
    /// Indeterminate without a result.
    Incomplete,
    Rejected,
    /// A verdict that this version does not know.
    Unknown,
}

impl Standing {
    pub fn of(passport: &Passport) -> Self {
        match (passport.verdict.as_str(), &passport.result) {
            ("accepted", _) => Self::Accepted,
            ("rejected", _) => Self::Rejected,
            ("indeterminate", Some(_)) => Self::Unproven { one_run: passport.runs.len() <= 1 },
            ("indeterminate", None) => Self::Incomplete,
            _ => Self::Unknown,
        }
    }

    /// One word, in capitals.
    pub fn word(self) -> &'static str {
        match self {
            Self::Accepted => "ACCEPTED",
            Self::Unproven { .. } | Self::Incomplete => "INDETERMINATE",
            Self::Rejected => "REJECTED",
            Self::Unknown => "UNKNOWN VERDICT",
        }
    }

    /// What the word means for the user.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Accepted => "the calibration deserves belief.",
            Self::Unproven { one_run: true } => {
                "one run only: the numbers hold for this run; the next power-up may differ."
            }
            Self::Unproven { one_run: false } => {
                "more runs are needed: reproducibility is not shown to the accuracy that was asked for."
            }
            Self::Incomplete => "something is missing: there are no coefficients yet.",
            Self::Rejected => "the data contradict the model: there are no coefficients.",
            Self::Unknown => "this version cannot judge it: no coefficients are shown.",
        }
    }

    /// A statement that must not be overlooked, in large letters.
    pub fn loud(self) -> Option<&'static str> {
        match self {
            Self::Unproven { one_run: true } => Some("One run: reproducibility not shown"),
            Self::Unproven { one_run: false } => Some("Too few runs: reproducibility not shown"),
            _ => None,
        }
    }

    /// Whether coefficients may be given.
    pub fn has_coefficients(self) -> bool {
        matches!(self, Self::Accepted | Self::Unproven { .. })
    }

    /// Whether the runs' own estimates may be shown, as evidence. On a rejected page they would pass for
    /// coefficients.
    pub fn has_estimates(self) -> bool {
        !matches!(self, Self::Rejected | Self::Unknown)
    }

    /// What the page is, in a sentence.
    pub fn what_it_is(self) -> &'static str {
        if self.has_coefficients() {
            "Calibration passport, not an accredited certificate."
        } else {
            "Neither a calibration passport nor an accredited certificate: it holds no coefficients."
        }
    }

    /// Heading of the page.
    pub fn heading(self) -> &'static str {
        match self {
            Self::Accepted | Self::Unproven { .. } => "Calibration passport",
            Self::Rejected | Self::Unknown => "Report: why there is no calibration passport",
            Self::Incomplete => "Report: what the calibration passport still needs",
        }
    }
}

/// The result, where it may be shown.
pub(crate) fn result(passport: &Passport) -> Option<&ResultSection> {
    passport.result.as_ref().filter(|_| Standing::of(passport).has_coefficients())
}

/// Coefficients for use, where they may be shown.
pub(crate) fn compensation(passport: &Passport) -> Option<&Compensation> {
    passport.compensation.as_ref().filter(|_| Standing::of(passport).has_coefficients())
}

/// Findings of one severity, as the renderers show them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Group {
    /// Name in the passport.
    pub severity: &'static str,
    /// Heading in words.
    pub heading: &'static str,
    /// One of them in a word.
    pub word: &'static str,
}

/// All severities, worst first.
pub(crate) const GROUPS: [Group; 4] = [
    Group { severity: "reject", heading: "Reasons for the rejection", word: "rejects" },
    Group { severity: "missing", heading: "What is missing", word: "missing" },
    Group { severity: "warning", heading: "Warnings", word: "warning" },
    Group { severity: "note", heading: "Notes", word: "note" },
];

/// The word for a severity; unknown ones as they are.
pub(crate) fn severity_word(severity: &str) -> &str {
    GROUPS.iter().find(|g| g.severity == severity).map_or(severity, |g| g.word)
}

/// Reasons or missing facts that no finding carries (passports of other programs).
pub(crate) fn bare_sentences<'p>(passport: &'p Passport, severity: &str) -> &'p [String] {
    if passport.findings.iter().any(|f| f.severity == severity) {
        return &[];
    }
    match severity {
        "reject" => &passport.reasons,
        "missing" => &passport.missing,
        _ => &[],
    }
}
