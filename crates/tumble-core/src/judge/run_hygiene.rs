//! All of a run's hygiene in order: what one finding explains, the next does not name again.

use super::{dwell_fit, misfit, motion, outlying, recorded, stuck_bit, upright, wrap, zero_rows};
use crate::{Bench, Finding, FindingKind, Output, Position, Readings};

/// What the data of a run show.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Hygiene {
    /// One finding a kind and run, or a dwell.
    pub findings: Vec<Finding>,
    /// What was noticed at single dwells, by their index in measured order.
    pub noticed: Vec<(usize, FindingKind)>,
}

/// Looks at the data of a run before anything is believed of them.
///
/// `dwells` are all of the run, in measured order; `earlier` what was found of the same run already.
///
/// **Model** in this order: words without their sign; bits that never change; zero rows; dwells that moved; single samples far out; dwells that
/// do not fit the others (leave-out fit of `1, sinφ, cosφ` to the means); times, rows and range of the record. What one
/// of them explains, the next does not name again.
///
/// **Source** method section 5.
#[must_use]
pub fn data_hygiene(
    run: &str,
    dwells: &[&Position],
    output: &Output,
    bench: &Bench,
    earlier: &[Finding],
) -> Hygiene {
    let mut findings = recorded::recorded(run, dwells, output, bench);
    let all: Vec<usize> = (0..dwells.len())
        .filter(|i| dwells[*i].readings.samples() > 0 && usable(dwells[*i], output))
        .collect();
    let read: Vec<&Position> = all.iter().map(|i| dwells[*i]).collect();
    if let Some(wraps) = wrap::codes_wrap(run, &read) {
        // Means of wrapped codes mean nothing.
        findings.push(wraps);
        return Hygiene { findings, noticed: Vec::new() };
    }
    findings.extend(stuck_bit::stuck_bit(run, &read, output));
    // Indices into `read`, with what was noticed there.
    let mut noticed: Vec<(usize, FindingKind)> = Vec::new();
    let named =
        |noticed: &[(usize, FindingKind)]| -> Vec<usize> { noticed.iter().map(|n| n.0).collect() };
    if let Some((index, zeros)) = zero_rows::zero_rows(&read, output.quantizer) {
        noticed.push((index, zeros.kind));
        findings.push(zeros);
    }
    // What stands at the converter's end has no mean.
    let whole = |i: &usize| read[*i].readings.censored(&output.ends) == 0;
    let zeroed = named(&noticed);
    let fitted: Vec<usize> =
        (0..read.len()).filter(|i| !zeroed.contains(i)).filter(whole).collect();
    let (moved, moving) = motion::moved(run, &read, output, &zeroed);
    noticed.extend(moving);
    let (wild, outlying) = outlying::outlying_samples(run, &read, output, &named(&noticed));
    noticed.extend(outlying.into_iter().map(|i| (i, FindingKind::OutlyingSamples)));
    let sticks = earlier.iter().any(|f| f.kind == FindingKind::StuckConverter);
    let rest: Vec<&Position> = fitted.iter().map(|i| read[*i]).collect();
    let fit = dwell_fit::DwellFit::of(dwell_fit::points(&rest, output.quantizer));
    if let Some(fit) = fit.filter(|_| !sticks) {
        // A movement or wild samples explain a mean that does not fit; an angle that does is named all the same.
        let so_far = named(&noticed);
        let explained = |(i, f): &(usize, Finding)| {
            f.kind == FindingKind::DwellDoesNotFit && so_far.contains(&fitted[*i])
        };
        let misfits = misfit::misfits(&fit, &rest).into_iter().filter(|m| !explained(m));
        let upright = upright::upright(&fit, &rest, output.quantizer, bench);
        for (i, finding) in misfits.chain(upright) {
            noticed.push((fitted[i], finding.kind));
            findings.push(finding);
        }
    }
    findings.extend(moved);
    findings.extend(wild);
    noticed.iter_mut().for_each(|n| n.0 = all[n.0]);
    Hygiene { findings, noticed }
}

/// Averages at the converter's end are none; codes there are judged by the others of their dwell.
fn usable(p: &Position, output: &Output) -> bool {
    match p.readings {
        Readings::Averaged { .. } => p.readings.censored(&output.ends) == 0,
        _ => 2 * p.readings.censored(&output.ends) < p.readings.samples(),
    }
}
