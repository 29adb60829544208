//! Conformity: the unit against its specification. It never touches the verdict, which judges the calibration.

use super::{PooledParameter, Verdict, scale_factor};
use crate::decision::{
    Belief, ConformityProbability, GlobalRisk, Limits, Production, Quantity, Requirement, Rule,
    Specification, Status, WorstCase, global_risk,
};
use crate::{Finding, FindingKind};

/// Test uncertainty ratio below which a decision says more about the measurement than about the unit.
///
/// **Source** a choice: at 3 a guard band of one `U` on both sides takes a third of the tolerance. Ratios of 3 to 10 are
/// usual demands on measurements for conformity; JCGM 106 calls the ratio the measurement capability index.
pub(crate) const LOW_TEST_UNCERTAINTY_RATIO: f64 = 3.0;

/// One quantity against its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantityConformity {
    /// Which quantity.
    pub quantity: Quantity,
    /// Set for misalignments when there are several mountings.
    pub mounting: Option<String>,
    /// What is known of it.
    pub belief: Belief,
    /// `U`, at the level of the result.
    pub expanded_uncertainty: f64,
    /// What it has to keep.
    pub limits: Limits,
    /// What the rule accepts; `None` where the guard bands leave nothing.
    pub acceptance: Option<Limits>,
    /// The decision.
    pub status: Status,
    /// Probability that it conforms, and that it does not.
    pub probability: ConformityProbability,
    /// The largest risks of the rule with this uncertainty.
    pub worst_case: WorstCase,
    /// Tolerance over `2U`; `None` for one-sided limits or a value without uncertainty.
    pub test_uncertainty_ratio: Option<f64>,
    /// What is known of the production, and the share of wrong decisions over it.
    pub production: Option<(Production, GlobalRisk)>,
}

impl QuantityConformity {
    /// Probability that the decision is wrong: `1 − p_c` where the value was accepted, `p_c` where it was rejected.
    #[must_use]
    pub fn risk(&self) -> Option<f64> {
        self.status.accepted().map(|accepted| match accepted {
            true => self.probability.fails,
            false => self.probability.conforms,
        })
    }

    fn name(&self) -> String {
        let words = self.quantity.name().replace('_', " ");
        self.mounting.as_ref().map_or(words.clone(), |m| format!("{words} (mounting {m})"))
    }
}

/// The unit against its specification.
#[derive(Debug, Clone, PartialEq)]
pub struct Conformity {
    /// Worst of the quantities.
    pub status: Status,
    /// The rule that decided.
    pub rule: Rule,
    /// Why limits that are given were not assessed; `None` where they were, or where there are none.
    pub reason: Option<String>,
    /// Quantities with limits, in order.
    pub quantities: Vec<QuantityConformity>,
    /// Which results, which specification, which rule and its risk, in words; below 500 characters.
    pub statement: Option<String>,
}

impl Conformity {
    /// Nothing was assessed, and why.
    fn not_assessed(rule: Rule, reason: Option<&str>) -> Self {
        Self {
            status: Status::NotAssessed,
            rule,
            reason: reason.map(str::to_owned),
            quantities: Vec::new(),
            statement: None,
        }
    }

    /// What the decision leaves to know.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        self.quantities.iter().filter_map(|q| uncertainty_finding(q, self.rule)).collect()
    }
}

/// Judges the unit against its specification.
///
/// `pooled` is the result; `None` where the verdict allows none, and then nothing is assessed. The value judged is the
/// mean over the power-ups, not the next one.
///
/// **Source** JCGM 106:2012; ILAC-G8:09/2019; the statement has what ISO/IEC 17025:2017, 7.8.6 asks for.
#[must_use]
pub fn conformity(
    specification: &Specification,
    pooled: Option<&[PooledParameter]>,
    nominal_scale_m_s2_per_lsb: f64,
    level: f64,
    verdict: Verdict,
) -> Conformity {
    let rule = specification.rule;
    if specification.requirements().next().is_none() {
        return Conformity::not_assessed(rule, None);
    }
    let Some(pooled) = pooled else {
        let reason = match verdict {
            Verdict::Rejected => "the calibration is rejected, so there is no value to judge",
            _ => "the calibration has no result yet: see what is missing",
        };
        return Conformity::not_assessed(rule, Some(reason));
    };
    let mut quantities = Vec::new();
    for (quantity, requirement) in specification.requirements() {
        for value in values(quantity, pooled, nominal_scale_m_s2_per_lsb) {
            quantities.push(decide(rule, quantity, requirement, &value));
        }
    }
    let Some(status) = quantities.iter().map(|q| q.status).max() else {
        return Conformity::not_assessed(
            rule,
            Some("the result has no value of what the limits are for"),
        );
    };
    let statement = statement(specification, &quantities, status, level, verdict);
    Conformity { status, rule, reason: None, quantities, statement: Some(statement) }
}

/// The values of a quantity: one, or a misalignment for each mounting.
fn values(
    quantity: Quantity,
    pooled: &[PooledParameter],
    nominal_scale: f64,
) -> Vec<PooledParameter> {
    let of = |parameter| pooled.iter().filter(move |p| p.parameter == parameter);
    match quantity {
        Quantity::Parameter(parameter) => of(parameter).cloned().collect(),
        Quantity::ScaleFactor => of(crate::estimate::Parameter::ScaleError)
            .map(|p| scale_factor(p, nominal_scale))
            .collect(),
    }
}

fn decide(
    rule: Rule,
    quantity: Quantity,
    requirement: &Requirement,
    value: &PooledParameter,
) -> QuantityConformity {
    let limits = requirement.limits;
    let u = value.expanded_uncertainty;
    let belief = Belief {
        value: value.value,
        standard_uncertainty: value.standard_uncertainty,
        degrees_of_freedom: value.degrees_of_freedom,
    };
    let acceptance = rule.acceptance(limits, u);
    QuantityConformity {
        quantity,
        mounting: value.mounting.clone(),
        belief,
        expanded_uncertainty: u,
        limits,
        acceptance,
        status: rule.decide(limits, value.value, u),
        probability: belief.conformity(limits),
        worst_case: rule.worst_case(limits, &belief, u),
        test_uncertainty_ratio: limits.width().filter(|_| u > 0.0).map(|t| t / (2.0 * u)),
        production: requirement.production.map(|production| {
            (production, global_risk(limits, acceptance, production, belief.standard_uncertainty))
        }),
    }
}

fn uncertainty_finding(q: &QuantityConformity, rule: Rule) -> Option<Finding> {
    let ratio = q.test_uncertainty_ratio?;
    let place = format!("[spec] limits of {}", q.name());
    if q.acceptance.is_none() {
        return Some(Finding {
            kind: FindingKind::NothingCouldPass,
            place,
            observed: format!(
                "a guard band of {} U on both sides, and a tolerance of {} U",
                rule.guard_multiple(),
                significant(2.0 * ratio, 3)
            ),
            limit: "room between the acceptance limits".into(),
            remedy: "lower the uncertainty (more runs, a better table), widen the limits, or agree another rule with the customer: decision_rule = \"non-binary\" answers with a condition".into(),
        });
    }
    (ratio < LOW_TEST_UNCERTAINTY_RATIO).then(|| Finding {
        kind: FindingKind::LowUncertaintyRatio,
        place,
        observed: format!("tolerance / 2U = {}", significant(ratio, 3)),
        limit: format!("at least {LOW_TEST_UNCERTAINTY_RATIO}"),
        remedy: "lower the uncertainty (more runs, a better table, up/down dwells) before relying on this decision".into(),
    })
}

/// What ISO/IEC 17025 7.8.6 asks for: to which results it applies, which specification, which rule, and its risk.
fn statement(
    specification: &Specification,
    quantities: &[QuantityConformity],
    status: Status,
    level: f64,
    verdict: Verdict,
) -> String {
    let document = specification.name.as_deref().unwrap_or("the limits of [spec]");
    let mut text = format!(
        "{} against {document}: {}, mean over power-ups. {}",
        in_words(status),
        listed(quantities),
        rule_in_words(specification.rule, level)
    );
    let largest = |of: &dyn Fn(&QuantityConformity) -> Option<f64>| {
        quantities.iter().filter_map(of).reduce(f64::max).map(percent)
    };
    if let Some(consumer) = largest(&|q| q.worst_case.consumer) {
        text.push_str(&format!(
            " Largest risk of the rule: {consumer} that a passed value does not conform"
        ));
        if let Some(conditional) = largest(&|q| q.worst_case.conditional) {
            text.push_str(&format!(", {conditional} that a conditional answer is wrong"));
        }
        text.push('.');
    }
    if let Some(own) = largest(&QuantityConformity::risk) {
        text.push_str(&format!(" Largest risk of these decisions: {own}."));
    }
    if verdict == Verdict::Indeterminate {
        text.push_str(" The spread between power-ups is not all in U: true of these runs only.");
    }
    text
}

/// `bias, misalignment in 2 mountings and scale error`.
fn listed(quantities: &[QuantityConformity]) -> String {
    let mut names: Vec<String> = Vec::new();
    for quantity in Quantity::ALL {
        let words = quantity.name().replace('_', " ");
        match quantities.iter().filter(|q| q.quantity == quantity).count() {
            0 => {}
            1 => names.push(words),
            n => names.push(format!("{words} in {n} mountings")),
        }
    }
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

fn in_words(status: Status) -> &'static str {
    match status {
        Status::Pass => "Pass",
        Status::ConditionalPass => "Conditional pass",
        Status::NotAssessed => "Not decided",
        Status::ConditionalFail => "Conditional fail",
        Status::Fail => "Fail",
    }
}

fn rule_in_words(rule: Rule, level: f64) -> String {
    let name = match rule {
        Rule::Simple => {
            return "Decision rule: simple acceptance (ILAC-G8:09/2019, JCGM 106), no guard band."
                .into();
        }
        Rule::Guarded(_) => "guarded acceptance",
        Rule::NonBinary(_) => "non-binary",
    };
    format!(
        "Decision rule: {name} (ILAC-G8:09/2019, JCGM 106), guard band w = {} U, U at {} %.",
        significant(rule.guard_multiple(), 3),
        significant(100.0 * level, 5)
    )
}

/// A probability for people: three digits, per cent; below a millionth as a power of ten.
fn percent(p: f64) -> String {
    if p > 0.0 && p < 1e-6 {
        return format!("{p:.0e}");
    }
    format!("{} %", significant(100.0 * p, 3))
}

/// Some significant digits, without zeros that say nothing.
fn significant(v: f64, digits: u32) -> String {
    let last = f64::from(digits) - 1.0 - v.abs().max(1e-9).log10().floor();
    let places = last.clamp(0.0, 12.0) as usize;
    let text = format!("{v:.places$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_in_words() {
        for (p, text) in [
            (0.5, "50 %"),
            (0.95, "95 %"),
            (0.025, "2.5 %"),
            (0.048_457, "4.85 %"),
            (0.001_349_9, "0.135 %"),
            (9.87e-10, "1e-9"),
            (0.0, "0 %"),
            (1.0, "100 %"),
        ] {
            assert_eq!(percent(p), text);
        }
    }
}
