//! From an experiment to a judged result: every stage once, in order.

mod budget;
mod conformity;
mod drawn;
mod error_level;
mod influence;
mod outliers;
mod pair;
mod pool;
mod repeat;
mod result;
mod run;
mod terms;
mod units;
mod verdict;

pub use budget::BudgetLine;
pub use conformity::{Conformity, QuantityConformity, conformity};
pub use drawn::Drawn;
pub use error_level::{ErrorLevel, RunErrorLevel, error_level};
pub use influence::{Influence, InfluenceTest, influence};
pub use outliers::{Change, LeftOut, Outlier, Outliers, WithAndWithout};
pub use pair::{SharedPair, shared_pair};
pub use pool::{
    BetweenRuns, Interval, PooledParameter, PooledRuns, in_lsb, pool, pool_runs, scale_factor,
};
pub use repeat::repeated_share;
pub use result::{CompensationResult, compensation_result};
pub use terms::{CompensationTerms, PooledTerm, Terms, TriedTerm};
pub use verdict::{Verdict, may_carry_result, verdict};

pub(crate) use conformity::LOW_TEST_UNCERTAINTY_RATIO;
pub(crate) use influence::SIGNIFICANCE as INFLUENCE_SIGNIFICANCE;
pub(crate) use outliers::LEAVABLE_SHARE;
pub(crate) use repeat::LIMIT as REPEAT_LIMIT;
pub(crate) use terms::{
    DEFAULT_K2_UG_G2 as PLAUSIBLE_K2_UG_G2, FAMILY_LEVEL as TERMS_FAMILY_LEVEL,
};
pub(crate) use verdict::for_want_of_runs;

use outliers::Material;
use run::{With, adjusted_runs, assess_run, bounded_by_data};

use crate::estimate::{Estimate, EstimateOptions, Method, Residual, Setting, TermSet, Weights};
use crate::judge::{self, Structure};
use crate::nominal::{NominalScale, NominalScaleError, nominal_scale};
use crate::systematic::{Inputs, SystematicEffect};
use crate::{
    Experiment, Finding, FindingKind, GravitySource, Orientation, PairUse, Position, Run,
    STANDARD_GRAVITY_M_S2, Severity,
};

/// Everything that is known about an experiment after it was judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// `k0`.
    pub nominal_scale: NominalScale,
    /// Runs in the order of the experiment; with `[scale]` and no run, the up/down dwells stand as one.
    pub runs: Vec<RunAssessment>,
    /// Runs together, a parameter (and mounting) each.
    pub pooled: Vec<PooledParameter>,
    /// `ε`: zero and level of the table, where reversal tells them from what turns with the body.
    pub table_zero: Option<PooledParameter>,
    /// An up/down pair that entered the joint adjustment.
    pub shared_pair: Option<SharedPair>,
    /// Curvature left over.
    pub structure: Option<Structure>,
    /// Further terms: what was tried, what was entered.
    pub terms: Terms,
    /// Temperature and signal level.
    pub influence: Influence,
    /// Positions that do not belong, and those that the user left out.
    pub outliers: Outliers,
    /// Before and after compensation.
    pub error_level: Option<ErrorLevel>,
    /// Uncertainty that does not show in the scatter.
    pub budget: Vec<BudgetLine>,
    /// The pooled values drawn by Monte Carlo; empty where no result may be given, or none was asked for.
    pub drawn: Vec<Drawn>,
    /// Coefficients; present when the verdict allows.
    pub compensation: Option<CompensationResult>,
    /// The unit against its specification.
    pub conformity: Conformity,
    /// Everything noteworthy, worst first.
    pub findings: Vec<Finding>,
    /// The verdict on the calibration.
    pub verdict: Verdict,
}

/// One run after estimation.
#[derive(Debug, Clone, PartialEq)]
pub struct RunAssessment {
    /// Name of the run.
    pub name: String,
    /// Its mounting.
    pub mounting: String,
    /// Which way the body was turned.
    pub orientation: Orientation,
    /// Absent when nothing could be adjusted.
    pub estimate: Option<Estimate>,
    /// Mean readings of the positions that were used, LSB, in measured order; `None` where codes stood at the
    /// converter's end.
    pub mean_codes: Vec<Option<f64>>,
    /// Mean temperatures of those positions.
    pub temperatures_degc: Vec<Option<f64>>,
    /// Standard deviation of single readings within dwells, pooled, LSB.
    pub reading_std_lsb: Option<f64>,
    /// What each systematic error does to this run's parameters; absent below full rank.
    pub effects: Option<Vec<SystematicEffect>>,
}

impl RunAssessment {
    /// Mounting and orientation, for people: `A`, `A reversed`.
    #[must_use]
    pub fn seating(&self) -> String {
        self.orientation.seating(&self.mounting)
    }

    /// Residuals of the run; empty when nothing could be adjusted.
    #[must_use]
    pub fn residuals(&self) -> &[Residual] {
        self.estimate.as_ref().map_or(&[], |e| &e.residuals)
    }
}

/// An experiment that could not be judged at all.
#[derive(Debug, Clone, PartialEq)]
pub enum AssessError {
    /// Without `k0` there is no scale error.
    NominalScale(NominalScaleError),
    /// [`Weights::Stated`] without a stated angle uncertainty.
    NothingStated,
    /// Positions are to be left out of a run that is not there.
    NoSuchRun {
        /// As it was asked for.
        run: String,
        /// Names of the runs.
        known: Vec<String>,
    },
    /// A position is to be left out that is not there.
    NoSuchPosition {
        /// As it was asked for.
        asked: LeftOut,
        /// Positions of that run.
        positions: usize,
    },
}

impl std::fmt::Display for AssessError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NominalScale(e) => e.fmt(f),
            Self::NothingStated => f.write_str(
                "--weights stated takes the angle uncertainty as known, and none is stated: give \
                 angle_uncertainty_arcmin in [bench], or leave --weights out",
            ),
            Self::NoSuchRun { run, known } => write!(
                f,
                "no run is named `{run}`, of which positions are to be left out; the runs are {}",
                known.join(", ")
            ),
            Self::NoSuchPosition { asked, positions } => write!(
                f,
                "{} has no position {} to leave out: its positions are 1 to {positions}, in measured order",
                asked.run, asked.position
            ),
        }
    }
}

impl std::error::Error for AssessError {}

/// Judges an experiment: estimates every run, puts the runs together, and says what may be believed.
///
/// **Errors** [`AssessError`] only where nothing can be judged (no nominal scale). Degenerate data are verdicts,
/// not errors.
///
/// **Source** method sections 3–7, 9, 12.
pub fn assess(
    experiment: &Experiment,
    options: &EstimateOptions,
) -> Result<Assessment, AssessError> {
    assess_without(experiment, options, &[])
}

/// [`assess`], with positions left out of the adjustment as the user decided; findings and result say so.
///
/// **Errors** [`AssessError::NoSuchRun`], [`AssessError::NoSuchPosition`] for what is not there to be left out.
pub fn assess_without(
    experiment: &Experiment,
    options: &EstimateOptions,
    left_out: &[LeftOut],
) -> Result<Assessment, AssessError> {
    outliers::all_there(experiment, left_out)?;
    if options.weights == Weights::Stated && experiment.bench.angle_uncertainty.is_none() {
        return Err(AssessError::NothingStated);
    }
    let (k0, mut findings) = nominal_scale(experiment).map_err(AssessError::NominalScale)?;
    findings.extend(gravity_findings(experiment));
    findings.extend(judge::identical_runs(&experiment.runs));
    findings.extend(pair_findings(experiment));

    let setting = Setting {
        bench: &experiment.bench,
        quantizer: experiment.output.quantizer,
        ends: experiment.output.ends,
        nominal_scale_m_s2_per_lsb: k0.value_m_s2_per_lsb,
    };
    let inputs = Inputs::of(experiment, k0.value_m_s2_per_lsb);
    let adjusted = adjusted_runs(experiment);
    let reference_degc = terms::reference_temperature(experiment);
    let (mut runs, materials, terms) = {
        let with = With { options, inputs: &inputs, set: TermSet::EMPTY, reference_degc };
        let known = (experiment, &setting, &adjusted[..], left_out);
        estimated(known, with, &mut findings)
    };
    runs.iter_mut().for_each(|r| bounded_by_data(r, &terms));
    findings.extend(terms::term_findings(&terms, experiment.bench.gravity.value_m_s2));
    judge::some_runs_reversed(&mut findings, &experiment.runs);

    let shared_pair = match options.method {
        // It knows the pair for k0 alone.
        Method::Paper => None,
        _ => shared_pair(experiment, &setting, &runs),
    };
    let mut together = pool_runs(&runs, shared_pair.as_ref(), options.level);
    let common = budget::common(&together, &runs);
    let whole = budget::complete(&mut together, &common, options.level);
    let pooled = together.parameters.clone();
    let contradicted = findings.iter().any(|f| f.kind.severity() == Severity::Reject);
    findings.extend(judge::reproducible(&experiment.runs, &pooled));
    findings.extend(judge::runs_differ(&pooled));
    findings.extend(judge::reversal(&runs, &together));
    if !contradicted {
        findings.extend(judge::determined_result(
            &pooled,
            &runs,
            &experiment.targets,
            options.level,
        ));
    }
    findings.extend(repeated_share(&runs).map(repeat::finding));
    let structure = structure_findings(&runs, &mut findings);
    terms::explain_structure(&mut findings, &terms);
    let mut influence = influence(&runs, k0.value_m_s2_per_lsb, options.level);
    findings.extend(influence.findings());
    influence.take_entered(&terms, options.level);
    if !contradicted {
        findings.extend(judge::type_limits(&judge::Judged {
            experiment,
            nominal_scale_m_s2_per_lsb: k0.value_m_s2_per_lsb,
            runs: &runs,
            pooled: &pooled,
            influence: &influence,
        }));
    }
    let pair = shared_pair.as_ref();
    let entered = outliers::Fitted { options, set: terms.entered, reference_degc, pair };
    let judged = (&setting, entered);
    let outliers = outliers::judge(&materials, &runs, &pooled, judged, &mut findings);
    let error_level = error_level(&runs, &setting);
    findings.extend(error_level.iter().filter_map(ErrorLevel::finding));
    let budget = budget::lines(&together, &common);
    findings.extend(judge::assumed(&budget));
    let drawn = match may_carry_result(&findings) {
        true => drawn::draw(&together, &common, options.level, options.monte_carlo_digits),
        false => Vec::new(),
    };
    findings.extend(judge::intervals_differ(&drawn));

    let verdict = verdict(&findings);
    let compensation = may_carry_result(&findings)
        .then(|| {
            let quantizer = experiment.output.quantizer;
            let scale = k0.value_m_s2_per_lsb;
            compensation_result(&together, whole.as_ref()?, &runs, (quantizer, scale), &terms)
        })
        .flatten();
    let conformity = conformity(
        &experiment.specification,
        compensation.as_ref().map(|_| pooled.as_slice()),
        k0.value_m_s2_per_lsb,
        options.level,
        verdict,
    );
    findings.extend(conformity.findings());
    // Worst first; within a severity in the order of discovery.
    findings.sort_by_key(|f| std::cmp::Reverse(f.kind.severity()));
    Ok(Assessment {
        nominal_scale: k0,
        runs,
        pooled,
        table_zero: together.table_zero,
        shared_pair,
        structure,
        terms,
        influence,
        outliers,
        error_level,
        budget,
        drawn,
        compensation,
        conformity,
        findings,
        verdict,
    })
}

/// Experiment, setting, runs with the positions of their adjustment, and what the user left out.
type Known<'k, 'a> =
    (&'a Experiment, &'k Setting<'a>, &'a [(Run, Vec<&'a Position>)], &'k [LeftOut]);

/// All runs, with the terms that were named or that the data ask for.
fn estimated<'a>(
    (experiment, setting, adjusted, left_out): Known<'_, 'a>,
    with: With<'_>,
    findings: &mut Vec<Finding>,
) -> (Vec<RunAssessment>, Vec<Material<'a>>, Terms) {
    let With { options, reference_degc, .. } = with;
    let choosing = terms::Choosing { experiment, setting, options, reference_degc };
    // Which positions are used does not depend on the terms: those of the last pass are those of all.
    let materials = std::cell::RefCell::new(Vec::new());
    let ((runs, of_runs), terms) = choosing.choose(|set| {
        // What was found before says how a run that does not come to rest is to be taken.
        let mut findings = findings.clone();
        let before = findings.len();
        let (mut runs, mut used) = (Vec::new(), Vec::new());
        for (run, candidates) in adjusted {
            let candidates = (candidates.clone(), left_out);
            let with = With { set, ..with };
            let (assessed, material) =
                assess_run(experiment, setting, with, run, candidates, &mut findings);
            runs.push(assessed);
            used.push(material);
        }
        materials.replace(used);
        (runs, findings.split_off(before))
    });
    findings.extend(of_runs);
    (runs, materials.into_inner(), terms)
}

/// Structure in each run alone and in all together; one finding, the most telling.
fn structure_findings(runs: &[RunAssessment], findings: &mut Vec<Finding>) -> Option<Structure> {
    let full: Vec<(&str, &Estimate)> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref().map(|e| (r.name.as_str(), e)))
        .filter(|(_, e)| e.full().is_some() && e.covariance.is_some())
        .collect();
    if full.is_empty() {
        return None;
    }
    let (together, found) = judge::structure(&full, 1);
    // Errors that repeat are not independent evidence: then each run must show the structure by itself.
    let pooling_counts = repeated_share(runs).is_none();
    if full.len() > 1 && (found.is_empty() || !pooling_counts) {
        findings.extend(full.iter().flat_map(|one| judge::structure(&[*one], full.len()).1));
    } else {
        findings.extend(found);
    }
    Some(together)
}

fn gravity_findings(experiment: &Experiment) -> Vec<Finding> {
    let gravity = &experiment.bench.gravity;
    let mut findings = Vec::new();
    if gravity.source == GravitySource::StatedWithoutUncertainty {
        findings.push(Finding {
            kind: FindingKind::GravityExact,
            place: "[bench] gravity".into(),
            observed: format!("{} m/s² without an uncertainty", gravity.value_m_s2),
            limit: "a value with its standard uncertainty".into(),
            remedy: "add gravity_uncertainty, or give latitude_deg and height_m; an error of g goes one to one into the scale factor".into(),
        });
    }
    if gravity.value_m_s2 == STANDARD_GRAVITY_M_S2 {
        findings.push(Finding {
            kind: FindingKind::StandardGravity,
            place: "[bench] gravity".into(),
            observed: "9.80665 m/s²".into(),
            limit: "the local value".into(),
            remedy: "9.80665 m/s² is the unit gn; local gravity differs by up to 0.3 %: give latitude_deg and height_m".into(),
        });
    }
    if experiment.bench.angle_uncertainty.is_none() {
        findings.push(Finding {
            kind: FindingKind::NoAngleUncertainty,
            place: "[bench]".into(),
            observed: "angle_uncertainty_arcmin is absent".into(),
            limit: "the table's random setting error".into(),
            remedy: "state angle_uncertainty_arcmin: it shapes the weights; without it the dwells' own scatter does".into(),
        });
    }
    findings
}

fn pair_findings(experiment: &Experiment) -> Option<Finding> {
    let pair = experiment.vertical.as_ref()?;
    let apart = pair.run.is_none() && pair.alone == PairUse::NominalScale;
    (apart && !experiment.runs.is_empty()).then(|| Finding {
        kind: FindingKind::PairForScaleOnly,
        place: "[scale]".into(),
        observed: "up and down belong to no run".into(),
        limit: "run = \"…\"".into(),
        remedy:
            "if they were taken in a run's power-up, name it: they tell bias and misalignment apart"
                .into(),
    })
}
