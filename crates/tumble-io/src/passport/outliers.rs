//! Positions that do not belong, as the passport has them.

use tumble_core::assess::{Change, LeftOut, Outlier, WithAndWithout};

use super::types as wire;

fn per_parameter(
    changes: &Option<[Change; 3]>,
    of: impl Fn(&Change) -> Option<f64>,
) -> Option<wire::PerParameter> {
    let [bias, misalignment, scale_error] = changes.as_ref()?.each_ref().map(of);
    Some(wire::PerParameter { bias, misalignment, scale_error })
}

pub(super) fn outlier(o: &Outlier) -> wire::Outlier {
    wire::Outlier {
        run: o.run.clone(),
        position: o.position,
        angle_deg: o.angle_deg,
        residual_lsb: o.belonging.map(|b| b.residual_lsb),
        studentized: o.belonging.map(|b| b.studentized),
        p_value: o.p_value,
        named_by: o.named_by.map(|k| k.id().to_owned()),
        left_out: o.left_out,
        effect: per_parameter(&o.effect, |c| Some(c.change)),
        effect_over_u: per_parameter(&o.effect, |c| c.over_u),
        uncertainty_ratio: per_parameter(&o.effect, |c| c.uncertainty_ratio),
        pooled_effect: per_parameter(&o.pooled_effect, |c| Some(c.change)),
        pooled_effect_over_u: per_parameter(&o.pooled_effect, |c| c.over_u),
    }
}

pub(super) fn comparison(c: &WithAndWithout) -> wire::LeftOutComparison {
    let of = |(value, expanded_uncertainty): (f64, f64)| wire::ValueAndUncertainty {
        value,
        expanded_uncertainty,
    };
    wire::LeftOutComparison {
        parameter: c.parameter.name().into(),
        mounting: c.mounting.clone(),
        with: of(c.with),
        without: of(c.without),
    }
}

/// One entry a run; the list is sorted.
pub(super) fn left_out(all: &[LeftOut]) -> Vec<wire::LeftOut> {
    all.chunk_by(|a, b| a.run == b.run)
        .filter_map(|of_run| {
            let run = of_run.first()?.run.clone();
            Some(wire::LeftOut { run, positions: of_run.iter().map(|l| l.position).collect() })
        })
        .collect()
}
