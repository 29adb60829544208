//! What each finding means, why it matters and what to do next: the text behind `tumble explain`.
//!
//! Thresholds come from the constants that judge, so that a text cannot say another number than the code.

mod bench;
mod conformity;
mod outlier;
mod plan;
mod record;
mod runs;
mod terms;
mod values;

use crate::assess::for_want_of_runs;
use crate::{FindingKind, Severity};

/// A kind of finding, explained to the person at the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// What was seen, and how it is decided.
    pub means: String,
    /// Why it matters for the numbers.
    pub why: String,
    /// What to do next: the line to write, or what to measure.
    pub todo: String,
    /// Where the rule comes from.
    pub source: String,
}

impl Explanation {
    fn new(
        means: impl Into<String>,
        why: impl Into<String>,
        todo: impl Into<String>,
        source: impl Into<String>,
    ) -> Self {
        Self { means: means.into(), why: why.into(), todo: todo.into(), source: source.into() }
    }
}

impl FindingKind {
    /// The explanation of this kind. A kind without one does not compile.
    #[must_use]
    pub fn explanation(self) -> Explanation {
        use FindingKind as K;
        match self {
            K::SignReversed => values::sign_reversed(),
            K::UnitsMixedUp => values::units_mixed_up(),
            K::ScaleImplausible => values::scale_implausible(),
            K::BiasImpossible => values::bias_impossible(),
            K::MisalignmentImpossible => values::misalignment_impossible(),
            K::Unusual => values::unusual(),
            K::StuckConverter => values::stuck_converter(),
            K::SaturatedThroughout => values::saturated_throughout(),
            K::SaturatedDwell => values::saturated_dwell(),
            K::ScatterHopeless => values::scatter_hopeless(),
            K::QuadraticResidual => values::quadratic_residual(),
            K::CubicResidual => values::cubic_residual(),
            K::SmallStructure => values::small_structure(),
            K::RunsIdentical => values::runs_identical(),
            K::NotSettled => values::not_settled(),
            K::NotConverged => values::not_converged(),
            K::CodesWrap => record::codes_wrap(),
            K::MistypedAngle => record::mistyped_angle(),
            K::ZeroRows => record::zero_rows(),
            K::DwellDoesNotFit => record::dwell_does_not_fit(),
            K::DwellDrifts => record::dwell_drifts(),
            K::DwellTwoLevels => record::dwell_two_levels(),
            K::OutlyingSamples => record::outlying_samples(),
            K::OutsideTypeLimits => record::outside_type_limits(),
            K::TimeBackwards => record::time_backwards(),
            K::RateDisagrees => record::rate_disagrees(),
            K::MissingSamples => record::missing_samples(),
            K::RepeatedSamples => record::repeated_samples(),
            K::UnitIsNotTheScales => record::unit_is_not_the_scales(),
            K::DoesNotBelong => outlier::does_not_belong(),
            K::LeftOutByUser => outlier::left_out_by_user(),
            K::TooManyLeftOut => outlier::too_many_left_out(),
            K::RankDeficient => plan::rank_deficient(),
            K::NoRedundancy => plan::no_redundancy(),
            K::NoLackOfFitTest => plan::no_lack_of_fit_test(),
            K::Undetermined => plan::undetermined(),
            K::IllConditioned => plan::ill_conditioned(),
            K::OneRun => plan::one_run(),
            K::NoRuns => plan::no_runs(),
            K::EmptyIntersection => plan::empty_intersection(),
            K::FewRuns => plan::few_runs(),
            K::RunsTooFew => plan::runs_too_few(),
            K::ErrorsRepeat => plan::errors_repeat(),
            K::RunsDiffer => runs::runs_differ(),
            K::ReversalSeparates => runs::reversal_separates(),
            K::ReversalAlone => runs::reversal_alone(),
            K::TableWorse => bench::table_worse(),
            K::TableBetter => bench::table_better(),
            K::NearCodeZero => bench::near_code_zero(),
            K::OneCodeDwell => bench::one_code_dwell(),
            K::LittleDither => bench::little_dither(),
            K::GravityExact => bench::gravity_exact(),
            K::StandardGravity => bench::standard_gravity(),
            K::PairForScaleOnly => bench::pair_for_scale_only(),
            K::NominalScaleDisagrees => bench::nominal_scale_disagrees(),
            K::TemperatureEffect => bench::temperature_effect(),
            K::SignalLevelEffect => bench::signal_level_effect(),
            K::BudgetIncomplete => bench::budget_incomplete(),
            K::BudgetAssumed => bench::budget_assumed(),
            K::IntervalsDiffer => bench::intervals_differ(),
            K::NoAngleUncertainty => bench::no_angle_uncertainty(),
            K::IgnoredColumns => record::ignored_columns(),
            K::CompensationWorse => bench::compensation_worse(),
            K::SlowNoise => bench::slow_noise(),
            K::RowsWithoutReading => record::rows_without_reading(),
            K::SettlingLeftOut => record::settling_left_out(),
            K::DwellsCutOut => record::dwells_cut_out(),
            K::AngleOutsideRange => bench::angle_outside_range(),
            K::TermEntered => terms::term_entered(),
            K::TermNotIdentifiable => terms::term_not_identifiable(),
            K::TermNeedsTemperature => terms::term_needs_temperature(),
            K::LowUncertaintyRatio => conformity::low_uncertainty_ratio(),
            K::NothingCouldPass => conformity::nothing_could_pass(),
        }
    }

    /// What this kind does to the verdict, in words.
    #[must_use]
    pub fn consequence(self) -> &'static str {
        match self.severity() {
            Severity::Reject => "Rejected: a report of why, and no coefficients. Exit code 1.",
            Severity::Missing if for_want_of_runs(self) => {
                "Indeterminate until there are more runs. The coefficients are given, marked as not reproduced; \
                 `tumble compensate` wants `--unproven` for them. Exit code 4."
            }
            Severity::Missing => {
                "Indeterminate: no coefficients until what is missing is there. Exit code 4."
            }
            Severity::Warning => {
                "None: the result stands with this reservation. With `--strict` the exit code is 3."
            }
            Severity::Note => "None.",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_a_few_whole_sentences() {
        for kind in FindingKind::ALL {
            let e = kind.explanation();
            for (name, text) in [("means", &e.means), ("why", &e.why), ("todo", &e.todo)] {
                let id = kind.id();
                let stops = text.matches(". ").count() + text.matches(".)").count();
                assert!(text.ends_with('.') && text.len() > 25, "{id} {name}: {text}");
                assert!(stops < 5, "{id} {name} is too long: {text}");
                assert!(text.len() < 620, "{id} {name} is too long: {text}");
                assert!(!text.contains("  ") && text == text.trim(), "{id} {name}: {text}");
                // Numbers are there to be copied.
                assert!(!text.contains('−'), "{id} {name}: {text}");
            }
            assert!(!e.source.is_empty() && !e.source.ends_with('.'), "{}", kind.id());
        }
    }

    #[test]
    fn no_two_kinds_share_a_text() {
        let mut seen = std::collections::BTreeSet::new();
        for kind in FindingKind::ALL {
            let e = kind.explanation();
            assert!(seen.insert(e.means), "{}", kind.id());
            assert!(seen.insert(e.todo), "{}", kind.id());
        }
    }

    #[test]
    fn texts_carry_the_thresholds_that_judge() {
        let means = |k: FindingKind| k.explanation().means;
        assert!(means(FindingKind::StuckConverter).contains("2 LSB"));
        assert!(means(FindingKind::IllConditioned).contains("30"));
        assert!(means(FindingKind::Undetermined).contains("0.03 m/s², 3 mrad and 0.2 %"));
        assert!(means(FindingKind::ScaleImplausible).contains("50 %"));
        assert!(means(FindingKind::LittleDither).contains("0.45 LSB"));
    }

    #[test]
    fn the_consequence_follows_from_the_severity() {
        assert!(FindingKind::StuckConverter.consequence().contains("no coefficients"));
        assert!(FindingKind::OneRun.consequence().contains("--unproven"));
        assert!(!FindingKind::NoRuns.consequence().contains("--unproven"));
        assert_eq!(FindingKind::SlowNoise.consequence(), "None.");
    }
}
