//! Findings: done, but know this.

/// What a finding does to the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The result stands, with a reservation.
    Warning,
    /// Something is missing: the calibration cannot be judged yet.
    Missing,
    /// The data contradict the model: no coefficients.
    Reject,
}

/// One thing worth knowing about an experiment.
///
/// Nothing is printed and then lost: every finding stands in the passport and every renderer shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What kind it is: stable id, title, severity.
    pub kind: FindingKind,
    /// Where: a run, a dwell, a parameter; empty for the whole experiment.
    pub place: String,
    /// What was observed, with unit.
    pub observed: String,
    /// What it was held against, with unit.
    pub limit: String,
    /// What to do about it.
    pub remedy: String,
}

impl Finding {
    /// Stable id, severity and title in one line, for people.
    #[must_use]
    pub fn headline(&self) -> String {
        let place =
            if self.place.is_empty() { String::new() } else { format!(" ({})", self.place) };
        format!("{}{place}", self.kind.title())
    }
}

macro_rules! finding_kinds {
    ($($(#[doc = $doc:literal])* $name:ident = $id:literal, $severity:ident, $title:literal;)*) => {
        /// Every kind of finding, with its stable id. Ids are never reused.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum FindingKind {
            $($(#[doc = $doc])* $name,)*
        }

        impl FindingKind {
            /// All kinds, in the order of their ids.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// The stable id.
            #[must_use]
            pub const fn id(self) -> &'static str {
                match self { $(Self::$name => $id,)* }
            }

            /// What it does to the verdict.
            #[must_use]
            pub const fn severity(self) -> Severity {
                match self { $(Self::$name => Severity::$severity,)* }
            }

            /// In a few words.
            #[must_use]
            pub const fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)* }
            }
        }
    };
}

finding_kinds! {
    /// The run was measured against the sign of the axis.
    SignReversed = "T0101", Reject, "the run is measured backwards in sign";
    /// The scale found is about 9.8 times the nominal one, or a tenth of it.
    UnitsMixedUp = "T0102", Reject, "units mixed up: the scale is off by about g";
    /// The scale found has nothing to do with the nominal one.
    ScaleImplausible = "T0103", Reject, "the scale factor found is not this sensor's";
    /// A bias beyond 1 g.
    BiasImpossible = "T0104", Reject, "the bias is physically impossible";
    /// A misalignment no seat can have.
    MisalignmentImpossible = "T0105", Reject, "the misalignment is no mounting error";
    /// Unusual, not impossible.
    Unusual = "T0106", Warning, "an unusual value for an accelerometer";
    /// The code stays while the angle moves.
    StuckConverter = "T0107", Reject, "the converter is stuck";
    /// All dwells stand at the converter's end.
    SaturatedThroughout = "T0108", Reject, "saturated throughout";
    /// Some dwells touch the converter's end.
    SaturatedDwell = "T0109", Warning, "a dwell touches the converter's end";
    /// The positions scatter far beyond any table.
    ScatterHopeless = "T0110", Reject, "the readings do not follow the angles";
    /// Left-over structure: quadratic.
    QuadraticResidual = "T0111", Reject, "a quadratic is left over in the residuals";
    /// Left-over structure: cubic.
    CubicResidual = "T0112", Reject, "a cubic is left over in the residuals";
    /// Left-over structure, real but small.
    SmallStructure = "T0113", Warning, "a small curvature is left over in the residuals";
    /// The runs are copies of one another.
    RunsIdentical = "T0115", Reject, "two runs are copies of one another";
    /// The estimate still moved at the end of the run.
    NotSettled = "T0116", Warning, "the estimate did not settle";
    /// The iteration found no fixed point.
    NotConverged = "T0117", Reject, "the adjustment did not converge";
    /// The codes of a two's complement converter, read without their sign.
    CodesWrap = "T0118", Reject, "the codes wrap: signed words read as unsigned";
    /// One angle contradicts the others and looks like a slip of the pen.
    MistypedAngle = "T0119", Reject, "an angle is mistyped";
    /// The logger filled the end of the record with zeros.
    ZeroRows = "T0120", Reject, "zero rows at the end of a record";
    /// One position contradicts the others, and no slip of the pen explains it.
    DwellDoesNotFit = "T0121", Warning, "a dwell does not fit the others";
    /// The reading drifts through a dwell.
    DwellDrifts = "T0122", Warning, "a dwell drifts: table or sensor had not settled";
    /// The reading jumps within a dwell.
    DwellTwoLevels = "T0123", Warning, "a dwell has two levels: table or sensor moved";
    /// Single samples far from the rest of their dwell.
    OutlyingSamples = "T0124", Warning, "samples far from the rest of their dwell";
    /// Outside the limits of the catalogue's entry.
    OutsideTypeLimits = "T0125", Warning, "outside the limits of the sensor's type";
    /// The recorded time steps back.
    TimeBackwards = "T0126", Warning, "time runs backwards";
    /// The recorded times contradict the stated rate.
    RateDisagrees = "T0127", Warning, "the recorded rate is not the stated one";
    /// Samples are missing between those recorded.
    MissingSamples = "T0128", Warning, "samples are missing in a dwell";
    /// The same time twice.
    RepeatedSamples = "T0129", Warning, "samples with the same time";
    /// Real numbers where the nominal scale is one per LSB.
    UnitIsNotTheScales = "T0130", Reject, "the readings are not in the unit of the nominal scale";
    /// A position that the others leave out of themselves.
    DoesNotBelong = "T0131", Warning, "a position does not belong to its run";
    /// The user left positions out.
    LeftOutByUser = "T0132", Warning, "positions were left out on request";
    /// The user left out more than is credible.
    TooManyLeftOut = "T0133", Missing, "too many positions were left out";
    /// Too few distinct angles for the parameters.
    RankDeficient = "T0201", Missing, "the positions do not determine all parameters";
    /// As many distinct angles as parameters, no repeats.
    NoRedundancy = "T0202", Missing, "no redundancy: uncertainty cannot be estimated";
    /// As many distinct angles as parameters, with repeats.
    NoLackOfFitTest = "T0203", Warning, "no lack-of-fit test is possible";
    /// The expanded uncertainty exceeds its target.
    Undetermined = "T0204", Missing, "a parameter is undetermined";
    /// Strongly correlated, still usable.
    IllConditioned = "T0205", Warning, "two parameters are hard to tell apart";
    /// One run only.
    OneRun = "T0206", Missing, "one run: reproducibility is not shown";
    /// No runs at all.
    NoRuns = "T0207", Missing, "there is no run on the table";
    /// The intervals of the runs have no point in common.
    EmptyIntersection = "T0208", Warning, "the runs' intervals have no point in common";
    /// Two runs: intervals are wide.
    FewRuns = "T0209", Note, "few runs: the intervals are wide";
    /// Every run reaches the target, the pooled value does not.
    RunsTooFew = "T0210", Missing, "more runs are needed";
    /// The same errors in every run: the mean of runs does not average them out.
    ErrorsRepeat = "T0211", Warning, "the positions' errors repeat from run to run";
    /// Cochran's Q is significant.
    RunsDiffer = "T0212", Note, "the runs differ beyond their own uncertainties";
    /// Runs in both orientations of a mounting.
    ReversalSeparates = "T0213", Note, "reversal tells the table's zero from the misalignment";
    /// A reversed run without its counterpart.
    ReversalAlone = "T0214", Note, "reversed runs without a normal one in their mounting";
    /// Table better or worse than stated.
    TableWorse = "T0301", Warning, "the positions scatter more than the stated angle uncertainty";
    /// Table better than stated.
    TableBetter = "T0302", Note, "the positions scatter less than the stated angle uncertainty";
    /// Sign rule near zero.
    NearCodeZero = "T0303", Note, "dwells near code zero of a truncating converter";
    /// One code in a whole dwell.
    OneCodeDwell = "T0304", Note, "dwells that show a single code";
    /// Noise below the dither limit.
    LittleDither = "T0305", Warning, "too little noise to dither the converter";
    /// Gravity without uncertainty.
    GravityExact = "T0306", Note, "gravity is taken as exact";
    /// Standard gravity used as local gravity.
    StandardGravity = "T0307", Warning, "standard gravity is a unit, not the local gravity";
    /// Up/down pair not tied to a run.
    PairForScaleOnly = "T0308", Note, "the up/down dwells give the nominal scale only";
    /// Up/down scale disagrees with the stated one.
    NominalScaleDisagrees = "T0309", Warning, "the stated nominal scale disagrees with the up/down dwells";
    /// Temperature has an effect.
    TemperatureEffect = "T0310", Warning, "temperature has an effect";
    /// Signal level has an effect.
    SignalLevelEffect = "T0311", Warning, "the error depends on the signal level";
    /// The budget is not complete.
    BudgetIncomplete = "T0312", Note, "systematic errors of the table are not in the uncertainty";
    /// No angle uncertainty stated.
    NoAngleUncertainty = "T0313", Note, "no angle uncertainty is stated";
    /// Columns that were not used.
    IgnoredColumns = "T0314", Note, "columns that were not used";
    /// Compensation does not help on held-out runs.
    CompensationWorse = "T0315", Warning, "compensation does not reduce the error on other runs";
    /// Noise within dwells is not white.
    SlowNoise = "T0316", Note, "noise within dwells is not white";
    /// Rows without a reading.
    RowsWithoutReading = "T0317", Warning, "rows without a reading were left out";
    /// Start or end of dwells left out.
    SettlingLeftOut = "T0318", Note, "settling was left out";
    /// Dwells cut out of a continuous record.
    DwellsCutOut = "T0319", Note, "dwells were cut out of a continuous record";
    /// Dwells beyond the stated range of the table.
    AngleOutsideRange = "T0320", Warning, "dwells outside the table's stated range";
    /// A further term entered by itself.
    TermEntered = "T0321", Warning, "a further term was entered";
    /// A further term was named that the plan cannot bear.
    TermNotIdentifiable = "T0322", Missing, "the positions do not determine a further term";
    /// A term on temperature was named, and temperatures are missing.
    TermNeedsTemperature = "T0323", Missing, "a term on temperature needs temperatures";
    /// Defaults make up a good part of an uncertainty.
    BudgetAssumed = "T0328", Note, "a good part of the uncertainty is assumed";
    /// Monte Carlo does not confirm an interval.
    IntervalsDiffer = "T0329", Note, "Monte Carlo gives another interval";
    /// The tolerance is less than a few expanded uncertainties wide.
    LowUncertaintyRatio = "T0401", Warning, "the uncertainty is large against the tolerance";
    /// Guard bands of both sides meet.
    NothingCouldPass = "T0402", Warning, "the guard bands leave no room to pass";
}

impl FindingKind {
    /// The kind with an id, in any case and with or without the leading `T0`: `T0205`, `t205`, `205`.
    ///
    /// ```
    /// use tumble_core::FindingKind;
    /// assert_eq!(FindingKind::from_id("t205"), Some(FindingKind::IllConditioned));
    /// assert_eq!(FindingKind::from_id("T9999"), None);
    /// ```
    #[must_use]
    pub fn from_id(text: &str) -> Option<Self> {
        let number = |id: &str| {
            let digits = id.trim_start_matches(['T', 't']);
            (id.len() - digits.len() <= 1 && digits.bytes().all(|b| b.is_ascii_digit()))
                .then(|| digits.parse::<u16>().ok())
                .flatten()
        };
        let wanted = number(text.trim())?;
        Self::ALL.iter().copied().find(|k| number(k.id()) == Some(wanted))
    }
}

impl FindingKind {
    /// Kinds near a text that is no id: the three with the nearest numbers, or those with the word in their titles.
    #[must_use]
    pub fn nearest(text: &str) -> Vec<Self> {
        let text = text.trim().to_lowercase();
        let number: Option<u32> = text.trim_start_matches('t').parse().ok();
        match number {
            Some(wanted) => {
                let distance = |k: &Self| {
                    k.id()
                        .trim_start_matches('T')
                        .parse()
                        .map_or(u32::MAX, |n: u32| n.abs_diff(wanted))
                };
                let mut all = Self::ALL.to_vec();
                all.sort_by_key(distance);
                all.truncate(3);
                all
            }
            None if text.chars().count() > 2 => Self::ALL
                .iter()
                .copied()
                .filter(|k| k.title().to_lowercase().contains(&text))
                .collect(),
            None => Vec::new(),
        }
    }
}

impl Severity {
    /// Name in the passport.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Missing => "missing",
            Self::Reject => "reject",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_found_as_people_type_them() {
        for typed in ["T0123", "t0123", "t123", "123", "0123", " T123 "] {
            assert_eq!(FindingKind::from_id(typed), Some(FindingKind::DwellTwoLevels), "{typed}");
        }
        for wrong in ["", "T", "TT0123", "12x", "-123", "T0199", "99999999", "T0123a"] {
            assert_eq!(FindingKind::from_id(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn near_ids_by_number_or_word() {
        let ids = |text| FindingKind::nearest(text).iter().map(|k| k.id()).collect::<Vec<_>>();
        assert_eq!(ids("T0131")[0], "T0131");
        assert_eq!(ids("t9999").len(), 3);
        assert_eq!(ids("gravity"), ["T0306", "T0307"]);
        assert!(ids("").is_empty() && ids("zz").is_empty());
    }

    #[test]
    fn ids_are_unique_and_ascending() {
        let ids: Vec<_> = FindingKind::ALL.iter().map(|k| k.id()).collect();
        assert!(ids.windows(2).all(|w| w[0] < w[1]), "{ids:?}");
    }
}
