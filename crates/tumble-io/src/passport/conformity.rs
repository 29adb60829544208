//! The decision on the unit in the passport: names and shapes, no arithmetic.

use tumble_core::assess::{Conformity, QuantityConformity};
use tumble_core::decision::Limits;

use super::types as wire;

pub(super) fn conformity(
    c: &Conformity,
    specification: Option<&str>,
    level: f64,
) -> wire::Conformity {
    let status = c.status.name().to_owned();
    if c.quantities.is_empty() {
        return wire::Conformity { status, reason: c.reason.clone(), ..Default::default() };
    }
    wire::Conformity {
        status,
        reason: None,
        specification: specification.map(str::to_owned),
        rule: Some(c.rule.name().into()),
        guard_band: Some(c.rule.guard_multiple()),
        level: Some(level),
        statement: c.statement.clone(),
        parameters: c.quantities.iter().map(quantity).collect(),
    }
}

fn quantity(q: &QuantityConformity) -> wire::ParameterConformity {
    let ends = |l: Limits| [l.lower(), l.upper()];
    wire::ParameterConformity {
        parameter: q.quantity.name().into(),
        mounting: q.mounting.clone(),
        unit: q.quantity.unit().into(),
        value: q.belief.value,
        standard_uncertainty: q.belief.standard_uncertainty,
        expanded_uncertainty: q.expanded_uncertainty,
        degrees_of_freedom: Some(q.belief.degrees_of_freedom).filter(|v| v.is_finite()),
        limits: ends(q.limits),
        acceptance_limits: q.acceptance.map(ends),
        status: q.status.name().into(),
        probability_of_conformity: q.probability.conforms,
        risk: q.risk(),
        distribution: q.belief.distribution().name().into(),
        worst_case_risk: wire::WorstCaseRisk {
            consumer: q.worst_case.consumer,
            producer: q.worst_case.producer,
            conditional: q.worst_case.conditional,
        },
        test_uncertainty_ratio: q.test_uncertainty_ratio.filter(|v| v.is_finite()),
        production: q.production.map(|(production, risk)| wire::Production {
            mean: production.mean(),
            standard_deviation: production.standard_deviation(),
            global_consumer_risk: risk.consumer,
            global_producer_risk: risk.producer,
        }),
    }
}
